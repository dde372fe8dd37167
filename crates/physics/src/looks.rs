//! What is seen: meshes, colours, and pictures as PNG.
//!
//! A mesh is written once for every size and direction in which it stands, and once for each transform of texture coordinates. A material has the
//! colour of its body and its picture; roughness, bumps, glass and light of its own are left out, and glass is a tenth opaque.

use crate::files::numbers;
use enfilade_math::{DAffine3, DVec3, Vec2, srgb_from_linear};
use enfilade_scene::{Bsdf, ColorParam, Image, Material, Pixels, PngEffort, Scene, smallest_png};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Opacity of glass.
const GLASS: f64 = 0.1;
/// Share of light through a surface from which it counts as glass.
const CLEAR: f32 = 0.5;

/// Meshes and materials of a model.
#[derive(Clone, Debug, Default)]
pub struct Looks {
    /// The meshes.
    pub meshes: Vec<Surface>,
    /// The materials.
    pub materials: Vec<Look>,
    /// Names and contents of PNG files.
    pub pictures: Vec<(String, Vec<u8>)>,
}

/// A mesh. Lists of what it lacks are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Metres.
    pub points: Vec<DVec3>,
    /// Unit length, one for each point.
    pub normals: Vec<DVec3>,
    /// Texture coordinates, v up, one for each point.
    pub coordinates: Vec<[f64; 2]>,
    /// Indices of points, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A part of the scene as it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visual {
    /// Index into the model's meshes.
    pub mesh: usize,
    /// Index into the model's materials.
    pub material: usize,
    /// Where the mesh's origin is, relative to the body's.
    pub place: DVec3,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Unique among the materials.
    pub name: String,
    /// Colour, sRGB, and opacity, 0 to 1.
    pub rgba: [f64; 4],
    /// Index into the pictures, whose colour is multiplied by `rgba`.
    pub picture: Option<usize>,
}

/// The looks of a scene, and for each part its mesh, material and place in the world.
pub(crate) fn of(scene: &Scene, notes: &mut Vec<String>) -> (Looks, Vec<Visual>) {
    let mut looks = Looks::default();
    let mut pictures: BTreeMap<u32, usize> = BTreeMap::new();
    for (index, material) in scene.materials.iter().enumerate() {
        let (color, opacity) = body(material);
        let picture = color.texture.map(|texture| {
            *pictures.entry(texture.image).or_insert_with(|| {
                looks.pictures.push((format!("picture_{}.png", texture.image), png(&scene.images[texture.image as usize])));
                looks.pictures.len() - 1
            })
        });
        let [r, g, b] = color.factor.to_array().map(|v| f64::from(srgb_from_linear(v.clamp(0.0, 1.0))));
        looks.materials.push(Look { name: format!("material_{index}"), rgba: [r, g, b, opacity], picture });
    }
    let mut known = BTreeMap::new();
    let visuals = scene.parts.iter().map(|part| {
        let transform = body(&scene.materials[part.material as usize]).0.texture.map(|texture| texture.uv_transform);
        let key = (
            part.mesh,
            part.world_from_mesh.matrix3.to_cols_array().map(f64::to_bits),
            transform.map(|t| t.map(|row| row.map(f32::to_bits))),
        );
        let mesh = *known.entry(key).or_insert_with(|| {
            looks.meshes.push(surface(scene, part.mesh, &part.world_from_mesh, transform));
            looks.meshes.len() - 1
        });
        Visual { mesh, material: part.material as usize, place: part.world_from_mesh.translation }
    });
    let visuals = visuals.collect();
    if !scene.lights.is_empty() || scene.environment.is_some() {
        notes.push("lights and surroundings are left out: simulators light the scene themselves".into());
    }
    (looks, visuals)
}

/// The colour of a material's body, and its opacity.
fn body(material: &Material) -> (ColorParam, f64) {
    match &material.bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } | Bsdf::Conductor { reflectance, .. } => (*reflectance, 1.0),
        Bsdf::Plastic { diffuse, .. } => (*diffuse, 1.0),
        Bsdf::Dielectric { transmittance, .. } | Bsdf::ThinDielectric { transmittance, .. } => (*transmittance, GLASS),
        Bsdf::Principled(p) => (p.base_color, if p.transmission.factor > CLEAR { GLASS } else { 1.0 }),
        Bsdf::Disney(p) => (p.base_color, if p.spec_trans.factor > CLEAR { GLASS } else { 1.0 }),
        Bsdf::Blend { first, second, weight } => {
            let heavier = if weight.factor < 0.5 { first } else { second };
            body(&Material { bsdf: (**heavier).clone(), ..material.clone() })
        }
    }
}

/// A picture as PNG: sRGB.
fn png(image: &Image) -> Vec<u8> {
    let texels: Vec<[u8; 4]> = match &image.pixels {
        Pixels::Rgba8 { texels, .. } => texels.iter().map(|&[r, g, b, _]| [r, g, b, 255]).collect(),
        Pixels::RgbF32(texels) => {
            let byte = |v: f32| (srgb_from_linear(v.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8;
            texels.iter().map(|&[r, g, b]| [byte(r), byte(g), byte(b), 255]).collect()
        }
    };
    smallest_png([image.width, image.height], &texels, PngEffort::Balanced)
}

/// A mesh about its own origin, with the axes of the world.
fn surface(scene: &Scene, mesh: u32, placed: &DAffine3, transform: Option<[[f32; 3]; 2]>) -> Surface {
    let mesh = &scene.meshes[mesh as usize];
    let upright = placed.matrix3.inverse().transpose();
    let moved = |uv: &Vec2| transform.map_or(uv.to_array(), |rows| rows.map(|[a, b, c]| a * uv.x + b * uv.y + c)).map(f64::from);
    Surface {
        points: mesh.positions.iter().map(|p| placed.matrix3 * p.as_dvec3()).collect(),
        normals: mesh.normals.iter().map(|n| (upright * n.as_dvec3()).try_normalize().unwrap_or(DVec3::Z)).collect(),
        coordinates: mesh.uvs.iter().map(moved).collect(),
        triangles: mesh.triangles.clone(),
    }
}

impl Looks {
    /// The meshes as OBJ files and the pictures, by their paths below `folder`.
    pub(crate) fn files(&self, folder: &str) -> impl Iterator<Item = (String, Vec<u8>)> {
        let meshes = self.meshes.iter().enumerate().map(move |(number, mesh)| (format!("{folder}/{}.obj", mesh_name(number)), mesh.obj()));
        meshes.chain(self.pictures.iter().map(move |(name, bytes)| (format!("{folder}/{name}"), bytes.clone())))
    }
}

/// The name of a mesh, by its index.
pub(crate) fn mesh_name(number: usize) -> String {
    format!("mesh_{number}")
}

impl Surface {
    /// The surface as Wavefront OBJ.
    pub(crate) fn obj(&self) -> Vec<u8> {
        let mut text = String::new();
        let mut line = |tag: &str, values: &[f64]| _ = writeln!(text, "{tag} {}", numbers(values));
        self.points.iter().for_each(|p| line("v", &p.to_array()));
        // MuJoCo refuses meshes of fewer than four vertices.
        self.points.iter().take(4usize.saturating_sub(self.points.len())).for_each(|p| line("v", &p.to_array()));
        self.coordinates.iter().for_each(|uv| line("vt", uv));
        self.normals.iter().for_each(|n| line("vn", &n.to_array()));
        let corner = |i: u32| match (self.coordinates.is_empty(), self.normals.is_empty(), i + 1) {
            (true, true, i) => format!("{i}"),
            (false, true, i) => format!("{i}/{i}"),
            (true, false, i) => format!("{i}//{i}"),
            (false, false, i) => format!("{i}/{i}/{i}"),
        };
        for triangle in &self.triangles {
            _ = writeln!(text, "f {}", triangle.map(corner).join(" "));
        }
        text.into_bytes()
    }
}
