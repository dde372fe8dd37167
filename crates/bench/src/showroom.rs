//! Shows variants of furniture side by side on a neutral floor before a wall, as a scene package to render:
//!
//!     cargo run --release -p enfilade-bench -- showroom bed,nightstand 4 bedroom.scene
//!
//! VARIANTS may be `FROM..TO`; `list` alone prints the names of all families with the triangles of a variant.

use enfilade_furniture::shape::{Reshape, bevelled_box};
use enfilade_furniture::{Builder, Class, FAMILIES, Family, Furniture, Materials, Palette, Place, family_named, pose};
use enfilade_home::light::LightConfig;
use enfilade_math::{DMat3, DVec3, Rgb, Rng, Vec3};
use enfilade_scene::{Environment, Light, Material, Scene, StartCamera, to_bytes};
use std::ops::Range;

/// Horizontal field of view of a long lens, which keeps proportions: 32 degrees, in radians.
const FOV_X_RAD: f32 = 0.56;
/// Width of a picture over its height.
const ASPECT: f32 = 4.0 / 3.0;
/// Height at which things hang whose room decides it.
const EYE_HEIGHT: f32 = 1.5;
/// Height at which things hang under a ceiling, metres.
const CEILING: f32 = 2.5;

struct Exhibit {
    family: Family,
    thing: Box<dyn Furniture>,
    palette: Palette,
    rng: Rng,
}

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = crate::arguments::arguments().collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["list"] => FAMILIES.iter().for_each(|f| println!("{:20} {:?} {:?} {} triangles", f.name, f.class, f.place, triangles(f))),
        [families, out] => std::fs::write(out, to_bytes(&showroom(&exhibits(families, 0..4)?)))?,
        [families, variants, out] => std::fs::write(out, to_bytes(&showroom(&exhibits(families, range(variants)?)?)))?,
        _ => return Err("usage: showroom FAMILY[,FAMILY] [VARIANTS] OUT.scene, or: showroom list".into()),
    }
    Ok(())
}

/// `4` is 0..4.
fn range(variants: &str) -> Result<Range<u64>, std::num::ParseIntError> {
    let (from, to) = variants.split_once("..").unwrap_or(("0", variants));
    Ok(from.parse()?..to.parse()?)
}

fn exhibits(families: &str, variants: Range<u64>) -> Result<Vec<Exhibit>, String> {
    let palettes = Palette::all();
    let mut all = Vec::new();
    for name in families.split(',') {
        let family = *family_named(name).ok_or_else(|| format!("no family {name:?}; `showroom list` prints all"))?;
        for k in variants.clone() {
            let mut rng = Rng::new(k);
            let thing = (family.random)(&mut rng);
            all.push(Exhibit { family, thing, palette: palettes[k as usize % palettes.len()], rng });
        }
    }
    Ok(all)
}

fn triangles(family: &Family) -> usize {
    let mut b = Builder::new(Materials::new(Palette::all()[0], LightConfig::default().lamp_light(), Rng::new(1)));
    let mut rng = Rng::new(1);
    (family.random)(&mut rng).build(&mut b, pose(0.0, 0.0, 0.0, 0.0), &mut rng);
    let scene = b.finish().0;
    scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].triangles.len()).sum()
}

fn showroom(exhibits: &[Exhibit]) -> Scene {
    let mut b = Builder::new(Materials::new(Palette::all()[0], LightConfig::default().lamp_light(), Rng::new(1)));
    let mean = exhibits.iter().map(|e| e.thing.size().x).sum::<f32>() / exhibits.len() as f32;
    let gap = 0.22 * mean;
    let width = exhibits.iter().map(|e| e.thing.size().x + gap).sum::<f32>() + gap;
    let deepest = exhibits.iter().map(|e| e.thing.size().y).fold(0.0, f32::max);
    let (mut x, mut low, mut high) = (0.5 * width - gap, f32::MAX, 0.0f32);
    for exhibit in exhibits {
        let size = exhibit.thing.size();
        let (y, z) = match exhibit.family.place {
            Place::OnWall => (0.0, EYE_HEIGHT),
            Place::Ceiling => (0.5 * deepest + 0.3, CEILING),
            Place::AgainstWall => (0.5 * size.y + 0.01, 0.0),
            Place::Free | Place::Corner | Place::OnSurface | Place::Underfoot => (0.5 * deepest + 0.05 + 0.2 * mean, 0.0),
        };
        b.enter_room(exhibit.palette, false);
        let place = pose(f64::from(x - 0.5 * size.x), f64::from(y), f64::from(z), 0.0);
        exhibit.thing.build(&mut b, place, &mut exhibit.rng.clone());
        let bounds = exhibit.family.place.bounds(size);
        (low, high) = (low.min(z + bounds.min.z), high.max(z + bounds.max.z));
        x -= size.x + gap;
    }
    b.enter_room(Palette::all()[0], false);
    shell(&mut b, width + 12.0);
    let mut scene = b.finish().0;
    light(&mut scene);
    scene.cameras.push(camera(width, [low, high], deepest));
    scene
}

/// A floor and, behind y = 0, a wall.
fn shell(b: &mut Builder, width: f32) {
    let floor = b.object("floor", Class::Floor, pose(0.0, 0.0, 0.0, 0.0));
    let slab = |size: Vec3, at: Vec3| bevelled_box(size, 0.001).moved(at);
    let grey = b.material(Material::diffuse("floor", Rgb::splat(0.3)));
    b.part(&floor, "boards", slab(Vec3::new(width, 14.0, 0.1), Vec3::new(0.0, 6.5, -0.05)), grey);
    let wall_grey = b.material(Material::diffuse("wall", Rgb::splat(0.5)));
    let wall = b.object("wall", Class::Wall, pose(0.0, 0.0, 0.0, 0.0));
    b.part(&wall, "plaster", slab(Vec3::new(width, 0.2, 5.0), Vec3::new(0.0, -0.1, 2.5)), wall_grey);
}

/// An overcast sky and a broad light from the upper left.
fn light(scene: &mut Scene) {
    scene.environment = Some(Environment::Constant { radiance: Rgb::new(0.36, 0.38, 0.42) });
    scene.lights.push(Light::Directional {
        name: "window".into(),
        direction: Vec3::new(-0.55, -0.55, -0.75).normalize(),
        irradiance: Rgb::new(1.5, 1.42, 1.3),
        angular_radius_rad: 0.12,
    });
}

/// Looks at the row of things from the front, slightly from above.
fn camera(width: f32, height: [f32; 2], deepest: f32) -> StartCamera {
    let tan = (0.5 * FOV_X_RAD).tan();
    let tall = (height[1] - height[0] + 0.35 * deepest) * ASPECT;
    let target = DVec3::new(0.0, f64::from(0.5 * deepest), f64::from(0.45 * height[1] + 0.55 * height[0]));
    let distance = f64::from(0.5 * deepest + 0.5 * width.max(1.05 * tall) / tan);
    let eye = target + distance * DVec3::new(0.2, 0.9, 0.3).normalize();
    let z = (eye - target).normalize();
    let x = DVec3::Z.cross(z).normalize();
    StartCamera {
        name: "visitor".into(),
        position: eye,
        world_from_camera: DMat3::from_cols(x, z.cross(x), z),
        fov_x_rad: f64::from(FOV_X_RAD),
        aspect: f64::from(ASPECT),
    }
}
