//! The picture of sky and surroundings that lights a home, and the sun's own light.

use super::Weather;
use super::outside::Surroundings;
use enfilade_furniture::Exposure;
use enfilade_math::{Mat3, Rgb, Vec2, Vec3};
use enfilade_scene::sky::SUN_RADIUS_RAD;
use enfilade_scene::{Environment, Image, Light, MapRows, Pixels, Scene, direction_from_uv};

/// Width of the sky's picture in pixels: a third of a degree each.
const WIDTH: u32 = 1024;
/// Directions this far behind the plane of a window, as a sine, are still painted, so that filtering at the edge meets no black.
const BEHIND: f32 = 0.03;

/// Adds the light of `weather` and of `surroundings` to `scene`; what faces away from all of `outward` stays black, unless there are
/// none. See [`super::LightConfig::illuminate`].
pub fn illuminate(scene: &mut Scene, outward: &[Vec2], weather: &Weather, surroundings: &Surroundings, exposure: Exposure) {
    let map_from_world = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y); // the map's up is y
    let world_from_map = map_from_world.transpose();
    let (width, height) = (WIDTH, WIDTH / 2);
    let texel = |i: u32| {
        let uv = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / Vec2::new(width as f32, height as f32);
        let d = world_from_map * direction_from_uv(uv);
        if !outward.is_empty() && outward.iter().all(|o| d.truncate().dot(*o) < -BEHIND) {
            return [0.0; 3];
        }
        exposure.expose(surroundings.radiance(d, weather.radiance(d))).to_array()
    };
    let texels = enfilade_parallel::map_up_to((width * height) as usize, |pixel| texel(pixel as u32));
    scene.images.push(Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels) }.into());
    let image = scene.images.len() as u32 - 1;
    scene.environment = Some(Environment::Map { image, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world });
    if !weather.sun.is_black() {
        scene.lights.push(Light::Directional {
            name: "sun".into(),
            direction: -weather.to_sun,
            irradiance: exposure.expose(weather.sun),
            angular_radius_rad: SUN_RADIUS_RAD,
        });
    }
}
