//! Wear: marks that hands, shoes, cups and dust leave on walls, floors, tables, fronts and screens.
//!
//! A mark is a film that lies 0.3 mm before its surface and covers it partly; it is a part of the object that it is on. The table gives
//! what each kind is like.

mod place;
mod places;
mod soft;
mod table;

use super::stage::Stage;
use super::table::interpolated;
use enfilade_furniture::object_of;
use enfilade_geometry::Mesh;
use enfilade_math::{Rgb, Rng, Vec2, hash_text};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Part, ScalarParam, TextureRef, Wrap};
use enfilade_textures::mark;
use places::places;
use table::{ROWS, Row};

/// Pictures of each kind, of which marks take one.
const PICTURES: usize = 3;

/// Wears the surfaces of a home.
pub fn wear(stage: &mut Stage, rng: &Rng, lived_in: f32) {
    for (number, row) in ROWS.iter().enumerate() {
        let mut rng = rng.fork(number as u64).fork(hash_text("mark"));
        // Each is made when the first mark takes it.
        let looks: [Rng; PICTURES] = std::array::from_fn(|k| rng.fork(k as u64));
        let mut materials = [None; PICTURES];
        let rate = interpolated(lived_in, row.expected);
        for (part, place) in places(stage, row, rate, &rng) {
            let mesh = place.film.unwrap_or_else(|| film(place.half));
            let number = stage.home.scene.meshes.len() as u32;
            stage.home.scene.meshes.push(mesh.into());
            let look = rng.below(PICTURES);
            let strength = interpolated(lived_in, row.strength);
            let material = *materials[look].get_or_insert_with(|| material(stage, row, strength, &mut looks[look].clone()));
            let own = &stage.home.scene.parts[part];
            let name = format!("{}/mark_{}", object_of(&own.name), stage.home.scene.parts.len());
            let added = Part { name, mesh: number, material, world_from_mesh: place.pose, ..own.clone() };
            let label = stage.home.labels.parts[part];
            stage.home.scene.parts.push(added);
            stage.home.labels.parts.push(label);
        }
    }
}

/// A rectangle that faces +z, its texture over the unit square.
fn film(half: Vec2) -> Mesh {
    let corners = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0)];
    let positions = corners.map(|c| ((2.0 * c - 1.0) * half).extend(0.0)).to_vec();
    Mesh { positions, uvs: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

fn material(stage: &mut Stage, row: &Row, strength: f32, rng: &mut Rng) -> u32 {
    let scene = &mut stage.home.scene;
    let name = "mark";
    scene.images.push(mark(name, row.kind, row.color, rng.next_u64() as u32).into());
    let texture = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(scene.images.len() as u32 - 1) };
    let color = ColorParam { factor: Rgb::WHITE, texture: Some(texture) };
    let bsdf = match row.gloss {
        Some(alpha) => Bsdf::Plastic { diffuse: color, eta: 1.5, alpha: alpha.into(), specular: Rgb::WHITE.into(), nonlinear: false },
        None => Bsdf::RoughDiffuse { reflectance: color, roughness: 0.4.into() },
    };
    let opacity = ScalarParam { factor: strength, texture: Some((texture, 3)) };
    scene.materials.push(Material { alpha: Alpha::Blend { opacity }, ..Material::new(name, bsdf) });
    scene.materials.len() as u32 - 1
}
