//! Packages of scenes that were made from another one, which lies beside them.
//!
//! Layout: the magic line, which ends in ` changes`, the hash of the body, the body: the hash of the other package, for each mesh and each
//! picture its number among those of the other package followed by its own, and the scene with its own meshes and pictures alone; in packages
//! of scenes with bodies these follow.

use super::encoding::{CHANGES, Kind, PackageError, bodies, decoded, encoded, headed, split, split_head, take_bodies, whole};
use crate::Scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The body of such a package.
#[derive(Serialize, Deserialize)]
pub(super) struct Changes {
    /// Hash of the other package.
    first: [u8; 32],
    /// Numbers of meshes.
    meshes: Vec<u32>,
    /// Numbers of pictures.
    images: Vec<u32>,
    /// The scene with what is its own.
    own: Scene,
}

/// The package of `scene` for a folder in which the package of `first` lies as [`super::FIRST_PACKAGE`]. Meshes and pictures that both
/// scenes share are left out; if they share none, the package is that of [`super::to_bytes`]. `first_package` are the bytes that `first`
/// was read from, or the beginning of them.
///
/// # Errors
/// When `first_package` is not a package by itself.
pub fn to_bytes_beside(scene: &Scene, first: &Scene, first_package: &[u8]) -> Result<Vec<u8>, PackageError> {
    let (kind, rest) = split_head(first_package)?;
    let hash = rest.first_chunk::<32>().filter(|_| !kind.lacks).ok_or(PackageError::Checksum)?;
    let (meshes, own_meshes) = divided(&scene.meshes, &first.meshes);
    let (images, own_images) = divided(&scene.images, &first.images);
    if (own_meshes.len(), own_images.len()) == (scene.meshes.len(), scene.images.len()) {
        return Ok(whole(scene, None));
    }
    let own = Scene {
        meshes: own_meshes,
        images: own_images,
        parts: scene.parts.clone(),
        objects: scene.objects.clone(),
        materials: scene.materials.clone(),
        lights: scene.lights.clone(),
        environment: scene.environment.clone(),
        cameras: scene.cameras.clone(),
        bodies: Vec::new(),
    };
    let changes = encoded(&Changes { first: *hash, meshes, images, own });
    Ok(headed(CHANGES, scene, &[changes, bodies(scene)].concat()))
}

/// Numbers of things among those of another scene followed by those that it does not have, and the latter.
fn divided<T>(all: &[Arc<T>], first: &[Arc<T>]) -> (Vec<u32>, Vec<Arc<T>>) {
    let known: BTreeMap<*const T, u32> = first.iter().zip(0..).map(|(thing, at)| (Arc::as_ptr(thing), at)).collect();
    let mut own = Vec::new();
    let number = |thing: &Arc<T>| {
        known.get(&Arc::as_ptr(thing)).copied().unwrap_or_else(|| {
            own.push(thing.clone());
            (first.len() + own.len() - 1) as u32
        })
    };
    (all.iter().map(number).collect(), own)
}

impl Changes {
    /// Takes the bodies, which follow.
    pub(super) fn take_bodies(&mut self, kind: Kind, rest: &[u8]) -> Result<(), PackageError> {
        (self.own.bodies, _) = take_bodies(kind, rest)?;
        Ok(())
    }

    /// The scene, with what the package `first` has.
    pub(super) fn applied(self, first: &[u8]) -> Result<Scene, PackageError> {
        let told = |problem: String| PackageError::First { problem };
        let (kind, hash, body) = split(first).map_err(|error| told(format!("in which {error}")))?;
        if kind.lacks || hash != self.first {
            return Err(told("which is not the package that it was made with".into()));
        }
        let (first, _) = decoded(kind, body)?;
        let Self { meshes, images, own, .. } = self;
        let meshes = joined("mesh", &meshes, first.meshes, &own.meshes)?;
        let images = joined("picture", &images, first.images, &own.images)?;
        Ok(Scene { meshes, images, ..own })
    }
}

/// The things of these numbers.
fn joined<T>(what: &str, numbers: &[u32], mut all: Vec<Arc<T>>, own: &[Arc<T>]) -> Result<Vec<Arc<T>>, PackageError> {
    all.extend_from_slice(own);
    let found = |number: &u32| {
        let there = all.get(*number as usize).cloned();
        there.ok_or_else(|| PackageError::Decode(format!("{what} {number} of {}", all.len())))
    };
    numbers.iter().map(found).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{from_bytes, from_bytes_beside, is_current_package, to_bytes};
    use super::*;
    use crate::{Body, BodyMotion, Image, Material, Part, Pixels};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec3};

    fn mesh(size: f32) -> Arc<Mesh> {
        Mesh { positions: vec![Vec3::ZERO, Vec3::X * size, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }.into()
    }

    fn image(value: f32) -> Arc<Image> {
        Image { name: "i".into(), width: 40, height: 40, pixels: Pixels::RgbF32(vec![[value; 3]; 1600]) }.into()
    }

    fn first() -> Scene {
        let part = |name: &str, mesh| Part { name: name.into(), object: None, mesh, material: 0, world_from_mesh: DAffine3::IDENTITY };
        Scene {
            meshes: vec![mesh(1.0), mesh(2.0)],
            parts: vec![part("a", 0), part("b", 1)],
            materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
            images: vec![image(1.0), image(2.0)],
            ..Scene::default()
        }
    }

    /// Without the first picture and mesh, with others, the old ones in other places.
    fn varied(first: &Scene) -> Scene {
        let mut scene = first.clone();
        scene.meshes = vec![mesh(3.0), first.meshes[1].clone()];
        scene.images = vec![first.images[1].clone(), image(3.0)];
        scene.materials[0].name = "blue".into();
        scene
    }

    #[test]
    fn what_two_scenes_share_is_stored_once_and_comes_back() {
        let first = first();
        let (whole, scene) = (to_bytes(&first), varied(&first));
        let bytes = to_bytes_beside(&scene, &first, &whole).unwrap();
        assert!(is_current_package(&bytes) && bytes.starts_with(b"enfilade scene 4 changes\n"));
        // A picture of 1600 texels of 12 bytes is its own, the other one is not there.
        assert!(bytes.len() > 19_200 && bytes.len() < 20_200, "{}", bytes.len());
        let read = |name: &str| if name == "first.scene" { Ok(whole.clone()) } else { Err("?") };
        assert_eq!(from_bytes_beside(&bytes, read).unwrap(), (scene.clone(), None));
        let (lights, cameras) = (Vec::new(), Vec::new());
        let body = Body { name: "a".into(), parent: None, parts: vec![0], lights, cameras, limits: None, motion: BodyMotion::rest() };
        let moving = Scene { bodies: vec![body], ..scene.clone() };
        let of_moving = to_bytes_beside(&moving, &first, &whole).unwrap();
        assert!(of_moving.starts_with(b"enfilade scene 6 changes\n"));
        assert_eq!(from_bytes_beside(&of_moving, read).unwrap(), (moving, None));
        // Equal bytes however often, and a package by itself where nothing is shared.
        assert_eq!(to_bytes_beside(&scene, &first, &whole).unwrap(), bytes);
        assert_eq!(to_bytes_beside(&self::first(), &first, &whole).unwrap(), whole);
        assert_eq!(from_bytes_beside(&whole, |_| Err("unread")).unwrap().0, first);
    }

    #[test]
    fn a_package_that_is_missing_or_another_one_is_told() {
        let first = first();
        let whole = to_bytes(&first);
        let bytes = to_bytes_beside(&varied(&first), &first, &whole).unwrap();
        let told = |read: Result<Vec<u8>, &str>| from_bytes_beside(&bytes, |_| read).unwrap_err().to_string();
        let other = to_bytes(&varied(&first));
        for (read, expected) in [
            (Err("which is missing"), "only what differs from first.scene beside it, which is missing; keep both files in one folder"),
            (Ok(other), "which is not the package that it was made with"),
            (Ok(bytes.clone()), "which is not the package that it was made with"),
            (Ok(whole[..90].to_vec()), "in which the package is damaged or cut short"),
        ] {
            let message = told(read);
            assert!(message.contains(expected), "{message}");
        }
        assert!(from_bytes(&bytes).unwrap_err().to_string().contains("which is not at hand here"));
        assert!(matches!(from_bytes(&bytes[..bytes.len() - 1]), Err(PackageError::Checksum)));
        assert!(matches!(to_bytes_beside(&first, &first, &bytes), Err(PackageError::Checksum)));
    }
}
