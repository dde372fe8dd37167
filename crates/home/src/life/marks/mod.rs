//! Wear: marks that hands, shoes, cups and dust leave on walls, floors, tables, fronts and screens.
//!
//! A mark is a film that lies 0.3 mm before its surface and covers it partly; it is a part of the object that it is on. The table gives
//! what each kind is like.

mod places;

use super::stage::Stage;
use super::table::interpolated;
use enfilade_furniture::object_of;
use enfilade_geometry::Mesh;
use enfilade_math::{Rgb, Rng, Vec2, hash_text};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Part, ScalarParam, TextureRef, Wrap};
use enfilade_textures::{Mark, mark};
use places::places;

/// Pictures of each kind, of which marks take one.
const PICTURES: usize = 3;

/// Where marks are.
#[derive(Clone, Copy, Debug)]
enum On {
    /// On walls between two heights, for each 10 m of wall.
    Walls([f32; 2]),
    /// On walls at a height, beside doors.
    Doors([f32; 2]),
    /// On the floor, for each 10 m².
    Floor,
    /// On top of pieces of these families, for each piece.
    Tops(&'static [&'static str]),
    /// On parts that are screens or panes before something, for each.
    Screens,
}

/// A kind of mark.
struct Row {
    kind: Mark,
    on: On,
    /// Least and greatest width and height, metres.
    size: [[f32; 2]; 2],
    /// Colour, linear reflectance.
    color: Rgb,
    /// Share that it covers where it is strongest: at ½ and at 1.
    strength: [f32; 2],
    /// Expected number at ½ and at 1.
    expected: [f32; 2],
    /// Roughness of a glossy film; a rough diffuse one where it is none.
    gloss: Option<f32>,
}

const TABLES: &[&str] = &[
    "dining_table",
    "long_table",
    "coffee_table",
    "side_table",
    "desk",
    "student_desk",
    "conference_table",
    "bistro_table",
    "nightstand",
    "worktop",
    "counter",
    "workbench",
    "play_table",
];
const SHELVES: &[&str] = &["sideboard", "dresser", "tv_bench", "console", "shoe_cabinet", "cube_shelf", "filing_cabinet", "office_cabinet"];
const DIRT: Rgb = Rgb::new(0.075, 0.06, 0.045);
const RUBBER: Rgb = Rgb::new(0.03, 0.028, 0.027);

static ROWS: [Row; 12] = [
    Row {
        kind: Mark::Scuffs,
        on: On::Walls([0.1, 0.42]),
        size: [[0.12, 0.5], [0.04, 0.14]],
        color: RUBBER,
        strength: [0.28, 0.6],
        expected: [2.2, 7.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Walls([0.7, 1.5]),
        size: [[0.08, 0.3], [0.08, 0.3]],
        color: DIRT,
        strength: [0.08, 0.2],
        expected: [1.4, 5.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Doors([0.8, 1.3]),
        size: [[0.1, 0.22], [0.15, 0.4]],
        color: DIRT,
        strength: [0.12, 0.28],
        expected: [0.7, 1.7],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.5, 2.0]),
        size: [[0.2, 0.7], [0.15, 0.5]],
        color: Rgb::new(0.8, 0.79, 0.76),
        strength: [0.05, 0.12],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.4, 2.1]),
        size: [[0.3, 0.9], [0.3, 0.9]],
        color: Rgb::new(0.3, 0.27, 0.23),
        strength: [0.03, 0.08],
        expected: [0.8, 2.4],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Floor,
        size: [[0.3, 1.1], [0.3, 1.1]],
        color: DIRT,
        strength: [0.07, 0.18],
        expected: [1.6, 4.0],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Floor,
        size: [[0.06, 0.22], [0.06, 0.22]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Scratches,
        on: On::Floor,
        size: [[0.3, 0.8], [0.3, 0.8]],
        color: Rgb::new(0.35, 0.32, 0.28),
        strength: [0.12, 0.35],
        expected: [0.8, 2.4],
        gloss: Some(0.35),
    },
    Row {
        kind: Mark::Rings,
        on: On::Tops(TABLES),
        size: [[0.15, 0.19], [0.15, 0.19]],
        color: Rgb::new(0.12, 0.07, 0.035),
        strength: [0.16, 0.4],
        expected: [0.5, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Tops(TABLES),
        size: [[0.04, 0.16], [0.04, 0.16]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.4, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Dust,
        on: On::Tops(SHELVES),
        size: [[0.3, 0.9], [0.15, 0.35]],
        color: Rgb::new(0.42, 0.4, 0.37),
        strength: [0.07, 0.2],
        expected: [0.8, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Fingers,
        on: On::Screens,
        size: [[0.2, 0.4], [0.2, 0.4]],
        color: Rgb::new(0.3, 0.3, 0.3),
        strength: [0.03, 0.09],
        expected: [0.6, 1.5],
        gloss: Some(0.3),
    },
];

/// Wears the surfaces of a home.
pub fn wear(stage: &mut Stage, rng: &Rng, lived_in: f32) {
    for (number, row) in ROWS.iter().enumerate() {
        let mut rng = rng.fork(number as u64).fork(hash_text("mark"));
        let materials: Vec<u32> = (0..PICTURES).map(|_| material(stage, row, interpolated(lived_in, row.strength), &mut rng)).collect();
        let rate = interpolated(lived_in, row.expected);
        for (part, place) in places(stage, row, rate, &rng) {
            let mesh = film(place.half);
            let number = stage.home.scene.meshes.len() as u32;
            stage.home.scene.meshes.push(mesh.into());
            let own = &stage.home.scene.parts[part];
            let name = format!("{}/mark_{}", object_of(&own.name), stage.home.scene.parts.len());
            let material = materials[rng.below(materials.len())];
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
