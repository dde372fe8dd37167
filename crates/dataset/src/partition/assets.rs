//! Assets that occur in several scenes: the same mesh wherever it is placed, and the same texture.
//!
//! What is learned of an asset on one side of a partition is not a surprise on the other.

use super::files::Side;
use enfilade_geometry::Mesh;
use enfilade_math::DVec3;
use enfilade_scene::{Image, Pixels, Scene};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Simpler meshes are boxes and boards that are alike by chance.
const LEAST_TRIANGLES: usize = 100;
/// Smaller textures are plain colours.
const LEAST_TEXELS: usize = 32 * 32;
/// Largest difference of shapes that count as the same; float32 vertices that were placed anew differ less.
const SAME_SHAPE: f64 = 1e-4;

/// The assets of a scene, in a form that can be compared.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneAssets {
    /// Each mesh that is large enough to be identified, named after the first part that uses it.
    pub meshes: Vec<MeshAsset>,
    /// Each texture that is large enough to be identified.
    pub images: Vec<ImageAsset>,
}

/// A mesh up to placement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshAsset {
    /// Name of the first part that has it.
    pub part: String,
    /// Number of triangles.
    pub triangles: usize,
    /// BLAKE3 of how its triangles are joined, which no placement changes.
    pub topology: String,
    /// Descriptor that is invariant to rotation, translation and uniform scale. Of the vertices' distances from their mean, in units of the
    /// root mean square: the means of the first, third and fourth powers, and the mean change from one vertex to the next.
    pub shape: [f64; 4],
}

/// A texture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageAsset {
    /// Source of the texture.
    pub name: String,
    /// BLAKE3 of its size and texels.
    pub content: String,
}

/// An asset that several scenes have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SharedAsset {
    /// `mesh` or `texture`.
    pub kind: String,
    /// Name of the asset in the first of the scenes.
    pub name: String,
    /// The scenes that have it, by side.
    pub scenes: BTreeMap<String, BTreeSet<String>>,
    /// True when they are on several sides.
    pub leaks: bool,
}

impl SceneAssets {
    /// The assets of a scene.
    pub fn of(scene: &Scene) -> Self {
        let mut seen = BTreeSet::new();
        let meshes = scene.parts.iter().filter(|part| seen.insert(part.mesh)).filter_map(|part| {
            let mesh = &scene.meshes[part.mesh as usize];
            (mesh.triangles.len() >= LEAST_TRIANGLES).then(|| MeshAsset {
                part: part.name.clone(),
                triangles: mesh.triangles.len(),
                topology: topology_of(mesh),
                shape: shape_of(mesh),
            })
        });
        let large = |image: &&Arc<Image>| image.width as usize * image.height as usize >= LEAST_TEXELS;
        let images = scene.images.iter().filter(large).map(|image| ImageAsset { name: image.name.clone(), content: content_of(image) });
        Self { meshes: meshes.collect(), images: images.collect() }
    }
}

fn topology_of(mesh: &Mesh) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(mesh.positions.len() as u64).to_le_bytes());
    for corner in mesh.triangles.iter().flatten() {
        hasher.update(&corner.to_le_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// See [`MeshAsset::shape`].
fn shape_of(mesh: &Mesh) -> [f64; 4] {
    let count = mesh.positions.len().max(1) as f64;
    let mean = mesh.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / count;
    let distances: Vec<f64> = mesh.positions.iter().map(|p| p.as_dvec3().distance(mean)).collect();
    let unit = (distances.iter().map(|d| d * d).sum::<f64>() / count).sqrt().max(f64::MIN_POSITIVE);
    let power = |n: i32| distances.iter().map(|d| (d / unit).powi(n)).sum::<f64>() / count;
    let change = distances.windows(2).map(|pair| (pair[1] - pair[0]).abs() / unit).sum::<f64>() / count;
    [power(1), power(3), power(4), change]
}

fn content_of(image: &Image) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&image.width.to_le_bytes());
    hasher.update(&image.height.to_le_bytes());
    match &image.pixels {
        Pixels::Rgba8 { texels, .. } => {
            hasher.update(texels.as_flattened());
        }
        Pixels::RgbF32(texels) => {
            for value in texels.as_flattened() {
                hasher.update(&value.to_le_bytes());
            }
        }
    }
    hasher.finalize().to_hex().to_string()
}

/// The assets that several scenes have, those on several sides first, then by kind and name. `side` returns the side of a scene.
pub fn shared_assets(scenes: &BTreeMap<String, SceneAssets>, side: impl Fn(&str) -> Side) -> Vec<SharedAsset> {
    let mut meshes: BTreeMap<&str, Vec<(&MeshAsset, BTreeSet<&str>)>> = BTreeMap::new();
    let mut images: BTreeMap<&str, (&ImageAsset, BTreeSet<&str>)> = BTreeMap::new();
    for (scene, assets) in scenes {
        for mesh in &assets.meshes {
            let alike = meshes.entry(&mesh.topology).or_default();
            match alike.iter_mut().find(|(other, _)| same_shape(&other.shape, &mesh.shape)) {
                Some((_, users)) => drop(users.insert(scene.as_str())),
                None => alike.push((mesh, [scene.as_str()].into())),
            }
        }
        for image in &assets.images {
            images.entry(&image.content).or_insert_with(|| (image, BTreeSet::new())).1.insert(scene.as_str());
        }
    }
    let meshes = meshes.into_values().flatten().map(|(mesh, users)| ("mesh", &mesh.part, users));
    let images = images.into_values().map(|(image, users)| ("texture", &image.name, users));
    let several = meshes.chain(images).filter(|(.., users)| users.len() > 1);
    let mut shared: Vec<SharedAsset> = several
        .map(|(kind, name, users)| {
            let mut scenes: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
            for user in users {
                scenes.entry(side(user).name().to_string()).or_default().insert(user.to_string());
            }
            SharedAsset { kind: kind.to_string(), name: name.clone(), leaks: scenes.len() > 1, scenes }
        })
        .collect();
    shared.sort_by(|a, b| (!a.leaks, &a.kind, &a.name).cmp(&(!b.leaks, &b.kind, &b.name)));
    shared
}

fn same_shape(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME_SHAPE * a.abs().max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{DAffine3, DQuat, Rgb, Rng, Vec3, place};
    use enfilade_scene::{Material, Part};

    fn scene(mesh: Mesh, image: Option<Image>) -> Scene {
        Scene {
            meshes: vec![mesh.into()],
            parts: vec![Part { name: "vase".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
            materials: vec![Material::diffuse("clay", Rgb::splat(0.5))],
            images: image.into_iter().map(Into::into).collect(),
            ..Scene::default()
        }
    }

    /// A fan of `count` triangles over random points.
    fn fan(count: u32, seed: u64) -> Mesh {
        let mut rng = Rng::new(seed);
        let positions = (0..count + 2).map(|_| Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32())).collect();
        Mesh { positions, triangles: (0..count).map(|i| [0, i + 1, i + 2]).collect(), ..Mesh::default() }
    }

    fn shared(scenes: [Scene; 2], sides: [Side; 2]) -> Vec<SharedAsset> {
        let assets = ["a", "b"].iter().zip(&scenes).map(|(name, scene)| (name.to_string(), SceneAssets::of(scene))).collect();
        shared_assets(&assets, |scene| sides[usize::from(scene == "b")])
    }

    #[test]
    fn a_mesh_is_found_again_however_it_was_placed() {
        let placed = DAffine3::from_scale_rotation_translation(DVec3::splat(2.5), DQuat::from_rotation_x(1.0), DVec3::new(9.0, -4.0, 1.0));
        let mut moved = fan(200, 1);
        moved.positions.iter_mut().for_each(|p| *p = place(&placed, *p));
        let found = shared([scene(fan(200, 1), None), scene(moved, None)], [Side::Train, Side::Test]);
        assert_eq!((found.len(), found[0].kind.as_str(), found[0].name.as_str(), found[0].leaks), (1, "mesh", "vase", true));
        assert_eq!(found[0].scenes["test"], BTreeSet::from(["b".to_string()]));
    }

    #[test]
    fn other_shapes_small_meshes_and_scenes_of_one_side_are_no_leak() {
        let sides = [Side::Train, Side::Test];
        assert_eq!(shared([scene(fan(200, 1), None), scene(fan(200, 2), None)], sides), []);
        assert_eq!(shared([scene(fan(12, 1), None), scene(fan(12, 1), None)], sides), []);
        let together = shared([scene(fan(200, 1), None), scene(fan(200, 1), None)], [Side::Val; 2]);
        assert_eq!(together.iter().map(|asset| asset.leaks).collect::<Vec<_>>(), [false]);
    }

    #[test]
    fn a_texture_is_found_again_by_its_texels_under_any_name() {
        let wood = |name: &str, last: u8| {
            let mut texels = vec![[120, 80, 40, 255]; 64 * 64];
            texels[4095][0] = last;
            Image { name: name.into(), width: 64, height: 64, pixels: Pixels::Rgba8 { srgb: true, texels } }
        };
        let found = |a: Image, b: Image| shared([scene(fan(1, 1), Some(a)), scene(fan(1, 2), Some(b))], [Side::Train, Side::Val]);
        let same = found(wood("oak.png", 1), wood("plank.jpg", 1));
        assert_eq!((same.len(), same[0].kind.as_str(), same[0].leaks), (1, "texture", true));
        assert_eq!(found(wood("oak.png", 1), wood("oak.png", 2)), []);
    }
}
