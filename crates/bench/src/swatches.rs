//! Every finish as a panel with a ball or a cushion before it, as scene packages to render:
//!
//!     cargo run --release -p enfilade-bench -- swatches FOLDER [SEED]
//!
//! writes one package for each kind of finish; the seed chooses the palette.

use enfilade_furniture::shape::{Reshape, bevelled_box, leaf, pillow, sphere};
use enfilade_furniture::{Builder, Class, DecorConfig, Finish, Materials, pose};
use enfilade_home::light::LightConfig;
use enfilade_math::{DMat3, DVec3, Rgb, Rng, Vec2, Vec3};
use enfilade_scene::{Environment, Light, Material, Scene, StartCamera, to_bytes};
use std::path::Path;

/// The body in front of the panels.
#[derive(Clone, Copy, PartialEq)]
enum Body {
    Ball,
    Cushion,
    Leaf,
}

/// A sheet: its name, its last finish, the side of its panels in metres, the body in front of them.
const SHEETS: [(&str, Finish, f32, Body); 7] = [
    ("floors_and_walls", Finish::Coir, 1.7, Body::Ball),
    ("wood_and_stone", Finish::Terracotta, 0.7, Body::Ball),
    ("cloth", Finish::Felt, 0.4, Body::Cushion),
    ("leather_and_metal", Finish::Foil, 0.3, Body::Ball),
    ("glass_and_plastic", Finish::Rubber, 0.3, Body::Ball),
    ("paper_and_screens", Finish::ScreenOn(0), 1.0, Body::Ball),
    ("plants_food_lamps", Finish::OpalGlobe, 0.3, Body::Leaf),
];
const COLUMNS: usize = 5;

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = crate::arguments::arguments().collect();
    let (folder, seed) = match &arguments[..] {
        [folder] => (folder, 0),
        [folder, seed] => (folder, seed.parse()?),
        _ => return Err("usage: swatches FOLDER [SEED]".into()),
    };
    std::fs::create_dir_all(folder)?;
    let mut rest = Finish::all().peekable();
    for (name, last, side, body) in SHEETS {
        let finishes: Vec<Finish> = std::iter::from_fn(|| rest.next_if(|f| *f <= last)).flat_map(variants).collect();
        println!("{name}: {finishes:?}");
        std::fs::write(Path::new(folder).join(format!("{name}.scene")), to_bytes(&sheet(&finishes, seed, side, body)))?;
    }
    Ok(())
}

/// Finishes with a number are shown in several.
fn variants(finish: Finish) -> Vec<Finish> {
    match finish {
        Finish::BedLinen(_) => (0..4).map(Finish::BedLinen).collect(),
        Finish::Towel(_) => (0..2).map(Finish::Towel).collect(),
        Finish::Clothes(_) => (0..3).map(Finish::Clothes).collect(),
        Finish::ScreenOn(_) => (0..4).map(Finish::ScreenOn).collect(),
        Finish::Fruit(_) => (0..3).map(Finish::Fruit).collect(),
        Finish::BottleGlass(_) => (0..3).map(Finish::BottleGlass).collect(),
        other => vec![other],
    }
}

fn sheet(finishes: &[Finish], seed: u64, side: f32, body: Body) -> Scene {
    let decor = DecorConfig { seed, realism: 1.0 };
    let mut b = Builder::new(Materials::new(decor.palette(), LightConfig::default().lamp_light(), decor.pictures()));
    let rows = finishes.len().div_ceil(COLUMNS);
    let cell = 1.18 * side;
    for (k, &finish) in finishes.iter().enumerate() {
        // Someone who faces the wall has x to the left.
        let x = (0.5 * (COLUMNS as f32 - 1.0) - (k % COLUMNS) as f32) * cell;
        let z = (rows - 1 - k / COLUMNS) as f32 * cell + 0.62 * cell;
        let swatch = b.object("swatch", Class::OtherProp, pose(f64::from(x), 0.0, f64::from(z), 0.0));
        // The longest edge decides which way the grain runs.
        let panel = bevelled_box(Vec3::new(1.001 * side, 0.02 * side, side), 0.004 * side);
        let unit = matches!(finish, Finish::ScreenOn(_) | Finish::Screen);
        let panel = if unit { panel.uv_moved(Vec2::splat(0.5 * side)) } else { panel };
        b.part(&swatch, "panel", panel, finish);
        b.part(&swatch, "body", shown(body, side).moved(Vec3::new(-0.22 * side, 0.3 * side, -0.22 * side)), finish);
    }
    let (width, height) = (COLUMNS as f32 * cell, rows as f32 * cell + 0.24 * cell);
    stage(&mut b, width, side);
    let mut scene = b.finish().0;
    light(&mut scene);
    scene.cameras.push(camera(width, height));
    scene
}

fn shown(body: Body, side: f32) -> enfilade_geometry::Mesh {
    match body {
        Body::Ball => sphere(0.2 * side, 96),
        Body::Cushion => pillow(Vec2::splat(0.5 * side), 0.16 * side, &mut Rng::new(2)).turned(Vec3::X, -std::f32::consts::FRAC_PI_2),
        Body::Leaf => leaf(0.5 * side, 0.25 * side, 0.8).turned(Vec3::X, -1.2).moved(Vec3::new(-0.2 * side, 0.0, 0.1 * side)),
    }
}

/// A grey wall behind the swatches and a grey floor.
fn stage(b: &mut Builder, width: f32, side: f32) {
    let object = b.object("stage", Class::Wall, pose(0.0, 0.0, 0.0, 0.0));
    let grey = b.material(Material::diffuse("grey", Rgb::splat(0.22)));
    let board = |size: Vec3, at: Vec3| bevelled_box(size, 0.001).moved(at);
    b.part(&object, "wall", board(Vec3::new(4.0 * width, 0.1, 4.0 * width), Vec3::new(0.0, -0.05 - 0.02 * side, 0.5 * width)), grey);
    b.part(&object, "floor", board(Vec3::new(4.0 * width, 4.0 * width, 0.1), Vec3::new(0.0, 1.5 * width, -0.05)), grey);
    // Soft boxes, which glossy surfaces mirror.
    let lamp = b.material(Material::emitter("soft box", Rgb::splat(5.0)));
    for (k, x) in [-0.75f32, 0.9].into_iter().enumerate() {
        let soft_box = board(Vec3::new(0.22 * width, 0.01, 0.5 * width), Vec3::new(x * width, 1.1 * width, 0.7 * width));
        b.part(&object, &format!("soft_box_{}", k + 1), soft_box, lamp);
    }
}

/// Light that grazes the panels from the upper left, and a grey sky.
fn light(scene: &mut Scene) {
    scene.environment = Some(Environment::Constant { radiance: Rgb::new(0.25, 0.26, 0.28) });
    scene.lights.push(Light::Directional {
        name: "window".into(),
        direction: Vec3::new(-0.75, -0.5, -0.62).normalize(),
        irradiance: Rgb::new(2.2, 2.1, 1.95),
        angular_radius_rad: 0.04,
    });
}

fn camera(width: f32, height: f32) -> StartCamera {
    let aspect = 4.0 / 3.0;
    let fov_x_rad = 0.6f32;
    let distance = f64::from(0.5 * width.max(aspect * height) / (0.5 * fov_x_rad).tan());
    let target = DVec3::new(0.0, 0.0, f64::from(0.5 * height));
    let eye = target + distance * DVec3::new(0.05, 0.99, 0.06).normalize();
    let z = (eye - target).normalize();
    let x = DVec3::Z.cross(z).normalize();
    let world_from_camera = DMat3::from_cols(x, z.cross(x), z);
    StartCamera { name: "front".into(), position: eye, world_from_camera, fov_x_rad: f64::from(fov_x_rad), aspect: f64::from(aspect) }
}
