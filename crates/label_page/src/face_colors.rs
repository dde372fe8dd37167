//! Colours of a scene's surfaces: the colour of each face by its material, or the mean of the texture over the face where there is one.

use enfilade_math::{Rgb, Vec2, srgb_from_linear};
use enfilade_scene::{Bsdf, ColorParam, Material, Parameter, ScalarParam, Scene, TriangleSource, WorldMesh, from_bytes};
use std::path::PathBuf;

/// A face is divided into this many triangles along a side; the texture is read in the middle of each.
const SIDE: u32 = 4;
/// Colour shown for panes and solid glass, which have no colour of their own.
const GLASS: Rgb = Rgb::new(0.55, 0.68, 0.72);
/// Share of light that metals without a colour of their own reflect.
const METAL: f32 = 0.6;

/// The colours of a scene's faces, or where they come from.
pub enum FaceColors {
    /// Red, green and blue as they are shown, face by face.
    Known(Vec<[u8; 3]>),
    /// A scene package with the materials, which is read when somebody wants to see them.
    Package(PathBuf),
    /// The scene has no information about materials.
    Unknown,
}

impl FaceColors {
    /// The colours of a scene, for these triangles.
    pub fn of(scene: &Scene, faces: &[TriangleSource]) -> Self {
        let plain: Vec<Option<[u8; 3]>> =
            scene.materials.iter().map(|material| (!is_textured(material)).then(|| shown(color(scene, material, Vec2::ZERO)))).collect();
        let places: Vec<Vec2> = places().collect();
        let of_face = |face: &TriangleSource| {
            let part = &scene.parts[face.part as usize];
            let (mesh, material) = (&scene.meshes[part.mesh as usize], part.material as usize);
            plain[material].unwrap_or_else(|| {
                let uv = |vertex: u32| mesh.uvs.get(vertex as usize).copied().unwrap_or_default();
                let [a, b, c] = mesh.triangles[face.triangle as usize].map(uv);
                let at = |place: &Vec2| color(scene, &scene.materials[material], a + (b - a) * place.x + (c - a) * place.y);
                shown(places.iter().map(at).sum::<Rgb>() / places.len() as f32)
            })
        };
        Self::Known(enfilade_parallel::map(faces, of_face))
    }

    /// Three bytes for each of this number of faces.
    ///
    /// # Errors
    /// Why there are none.
    pub fn bytes(&self, faces: usize) -> Result<Vec<u8>, String> {
        match self {
            Self::Known(colors) => Ok(colors.as_flattened().to_vec()),
            Self::Unknown => Err("the scene has no materials".into()),
            Self::Package(path) => {
                let wrong = |problem: String| format!("{}: {problem}", path.display());
                let bytes = std::fs::read(path).map_err(|e| wrong(e.to_string()))?;
                let scene = from_bytes(&bytes).map_err(|e| wrong(e.to_string()))?;
                let sources = WorldMesh::new(&scene).sources;
                if sources.len() != faces {
                    return Err(wrong(format!("it has {} faces, the mesh folder {faces}", sources.len())));
                }
                Self::of(&scene, &sources).bytes(faces)
            }
        }
    }
}

/// The middles of the triangles that a face is divided into: shares of its two sides.
fn places() -> impl Iterator<Item = Vec2> {
    let upright = (0..SIDE).flat_map(|i| (0..SIDE - i).map(move |j| Vec2::new(i as f32 + 1.0 / 3.0, j as f32 + 1.0 / 3.0)));
    let turned = (0..SIDE - 1).flat_map(|i| (0..SIDE - 1 - i).map(move |j| Vec2::new(i as f32 + 2.0 / 3.0, j as f32 + 2.0 / 3.0)));
    upright.chain(turned).map(|place| place / SIDE as f32)
}

fn is_textured(material: &Material) -> bool {
    let mut found = material.emission.texture.is_some();
    material.bsdf.parameters(&mut |parameter| {
        found |= match parameter {
            Parameter::Color(color) => color.texture.is_some(),
            Parameter::Scalar(number) => number.texture.is_some(),
        }
    });
    found
}

/// Linear colour of a material: what it scatters, and what it emits in the brightness of white paper.
fn color(scene: &Scene, material: &Material, uv: Vec2) -> Rgb {
    let emitted = read(scene, &material.emission, uv) / material.emission.factor.max_component().max(1e-9);
    scattered(scene, &material.bsdf, uv) + emitted
}

fn scattered(scene: &Scene, bsdf: &Bsdf, uv: Vec2) -> Rgb {
    match bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } => read(scene, reflectance, uv),
        Bsdf::Conductor { reflectance, .. } => read(scene, reflectance, uv) * METAL,
        Bsdf::Dielectric { transmittance, .. } | Bsdf::ThinDielectric { transmittance, .. } => read(scene, transmittance, uv) * GLASS,
        Bsdf::Plastic { diffuse, .. } => read(scene, diffuse, uv),
        Bsdf::Principled(surface) => read(scene, &surface.base_color, uv),
        Bsdf::Disney(surface) => read(scene, &surface.base_color, uv),
        Bsdf::Blend { first, second, weight } => scattered(scene, first, uv).lerp(scattered(scene, second, uv), share(scene, weight, uv)),
    }
}

fn read(scene: &Scene, color: &ColorParam, uv: Vec2) -> Rgb {
    match &color.texture {
        Some(texture) => color.factor * scene.images[texture.image as usize].sample(texture, uv).0,
        None => color.factor,
    }
}

fn share(scene: &Scene, number: &ScalarParam, uv: Vec2) -> f32 {
    let Some((texture, channel)) = &number.texture else { return number.factor };
    let (rgb, alpha) = scene.images[texture.image as usize].sample(texture, uv);
    number.factor * if *channel < 3 { rgb[usize::from(*channel)] } else { alpha }
}

fn shown(color: Rgb) -> [u8; 3] {
    [0, 1, 2].map(|channel| (srgb_from_linear(color[channel].clamp(0.0, 1.0)) * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Vec3};
    use enfilade_scene::{Image, Part, Pixels, TextureRef, to_bytes};

    /// Two triangles of a square: one over the black half of a picture, one over its white half; and a red part.
    fn scene() -> Scene {
        let texels = vec![[0, 0, 0, 255], [255, 255, 255, 255]];
        let image = Image { name: "halves".into(), width: 2, height: 1, pixels: Pixels::Rgba8 { srgb: false, texels } };
        let corner = |u: f32| [Vec2::new(u, 0.0), Vec2::new(u + 0.1, 0.0), Vec2::new(u, 1.0)];
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh { positions, uvs: [corner(0.2), corner(0.7)].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() };
        let textured = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(0)) };
        let part =
            |name: &str, material: u32| Part { name: name.into(), object: None, mesh: 0, material, world_from_mesh: DAffine3::IDENTITY };
        Scene {
            meshes: vec![mesh.into()],
            images: vec![image.into()],
            materials: vec![
                Material::new("halves", Bsdf::Diffuse { reflectance: textured }),
                Material::new("red", Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() }),
            ],
            parts: vec![part("picture", 0), part("book", 1)],
            ..Scene::default()
        }
    }

    #[test]
    fn faces_have_the_mean_of_their_texture_or_the_colour_of_their_material() {
        let scene = scene();
        let sources = WorldMesh::new(&scene).sources;
        let FaceColors::Known(colors) = FaceColors::of(&scene, &sources) else { panic!("known") };
        assert!(colors[0].iter().all(|&v| v < 70) && colors[1].iter().all(|&v| v > 230), "{colors:?}");
        assert_eq!(colors[2..], [[255, 0, 0]; 2]);
        let places: Vec<Vec2> = places().collect();
        let mean = places.iter().copied().sum::<Vec2>() / places.len() as f32;
        assert!(places.len() == 16 && (mean - 1.0 / 3.0).abs().max_element() < 1e-6, "{mean}");
    }

    #[test]
    fn a_package_of_another_mesh_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.scene");
        std::fs::write(&path, to_bytes(&scene())).unwrap();
        let package = FaceColors::Package(path);
        assert_eq!(package.bytes(4).unwrap()[6..], [255, 0, 0, 255, 0, 0]);
        assert!(package.bytes(5).unwrap_err().contains("it has 4 faces, the mesh folder 5"));
        assert!(FaceColors::Unknown.bytes(4).is_err());
    }
}
