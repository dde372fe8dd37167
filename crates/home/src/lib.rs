//! Procedural furnished homes: the embedded default input, and labelled scenes without end.
//!
//! [`living_room`] is a function of its seed alone. From the bottom up: [`shape`] makes meshes and [`texture`] pictures;
//! [`materials`] and [`palette`] say what things are made of; [`furniture`] has one file per family of things; [`room`] builds the
//! shell, [`layout`] decides what fits where, and [`builder`] names, labels and collects the parts.

pub mod builder;
mod cameras;
pub mod furniture;
pub mod layout;
mod living_room;
pub mod materials;
pub mod palette;
pub mod room;
pub mod shape;
pub mod texture;

use builder::Builder;
use enfilade_math::{Rgb, Rng, Vec2, Vec3};
use enfilade_scene::sky::Daylight;
use enfilade_scene::{Environment, Labels, Light, Scene};
use layout::Plan;
use materials::Materials;
use palette::Palette;
use serde::{Deserialize, Serialize};

/// What a home is a function of.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HomeConfig {
    /// Decides everything: sizes, colours, furniture, weather. Zero is the one on the cover.
    pub seed: u64,
}

/// A home and what its parts are called.
#[derive(Clone, Debug)]
pub struct Home {
    /// Valid by construction.
    pub scene: Scene,
    /// Every part has a class; all but walls, floor and ceiling belong to an instance.
    pub labels: Labels,
}

/// Scene radiance per kilo-candela per square metre: brings a sunny room's walls to about one.
const EXPOSURE: f32 = 1.2;

/// Luminance of the bulbs before exposure, kcd/m². A frosted 60 W bulb has about 60; lamps in daylight want a strong one.
const BULB: f32 = 110.0;

/// Width of the sky's picture.
const SKY_WIDTH: u32 = 1024;

/// A furnished living room on a sunny day with its lamps lit.
pub fn living_room(config: &HomeConfig) -> Home {
    let rng = Rng::new(config.seed);
    let default = config.seed == 0;
    let palette = Palette::choose(config.seed, &mut rng.fork(1));
    let mut plan = living_room::plan_room(default, &mut rng.fork(2));
    let mut scene = Scene::default();
    let materials = Materials::new(&mut scene, &palette, BULB * EXPOSURE, &mut rng.fork(3));
    let mut builder = Builder::new(scene, materials);
    living_room::furnish(&mut builder, &mut plan, &palette, default, &rng.fork(4));
    let (mut scene, labels) = builder.finish();
    daylight(&mut scene, &plan, default, &mut rng.fork(5));
    scene.cameras = cameras::cameras(&scene, &plan);
    Home { scene, labels }
}

/// Sky, sun and garden; the sun stands before the window.
fn daylight(scene: &mut Scene, plan: &Plan, default: bool, rng: &mut Rng) {
    let (elevation, azimuth) = if default { (0.80f32, 0.80f32) } else { (rng.range(0.65, 0.9), rng.range(-0.85, 0.85)) };
    let toward = plan.direction(Vec2::new(azimuth.sin(), azimuth.cos())) * elevation.cos();
    let day = Daylight { to_sun: Vec3::new(toward.x, toward.y, elevation.sin()).normalize(), turbidity: 7.0, ground_albedo: 0.2 };
    let (mut sky, environment, sun) = day.lights(SKY_WIDTH, EXPOSURE, scene.images.len() as u32);
    if let (Environment::Map { map_from_world, .. }, Light::Directional { irradiance, .. }) = (&environment, &sun) {
        let world_from_map = map_from_world.transpose();
        let level = *irradiance * day.to_sun.z + Rgb::new(9.0, 11.0, 14.0) * EXPOSURE;
        let outward = plan.direction(Vec2::Y).extend(0.0);
        texture::paint_surroundings(&mut sky, |d| world_from_map * d, level, outward, rng.next_u64() as u32);
    }
    scene.images.push(sky);
    scene.environment = Some(environment);
    scene.lights.push(sun);
}
