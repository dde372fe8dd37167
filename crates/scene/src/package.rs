//! The scene package: a [`Scene`] as one self-contained run of bytes, pictures included and compressed without loss.
//!
//! Layout: the magic line, the BLAKE3 hash of the body (32 bytes), the body in postcard encoding: the scene; in packages of scenes with
//! bodies, which have numbers of their own, these, and the cameras on them; and, where the package has them, the labels of its parts. Reading checks the hash, so
//! a truncated or altered package is distinguished from a scene that is wrong.
//!
//! The package of a variation has only the meshes and pictures that the package it varies does not have; that one lies beside it, as
//! [`FIRST_PACKAGE`]. `changes` has its layout.
//!
//! ```
//! # use enfilade_geometry::Mesh;
//! # use enfilade_math::{DAffine3, Rgb, Vec3};
//! # use enfilade_scene::{Material, Part, Scene};
//! # let scene = Scene {
//! #     meshes: vec![Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }.into()],
//! #     materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
//! #     parts: vec![Part { name: "floor".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
//! #     ..Scene::default()
//! # };
//! let mut bytes = enfilade_scene::to_bytes(&scene);
//! assert_eq!(enfilade_scene::from_bytes(&bytes).unwrap(), scene);
//!
//! *bytes.last_mut().unwrap() ^= 1;
//! assert!(enfilade_scene::from_bytes(&bytes).unwrap_err().to_string().starts_with("the package is damaged"));
//! ```

mod changes;
mod encoding;

pub use changes::to_bytes_beside;
pub use encoding::{FIRST_PACKAGE, PACKAGE_HEAD_BYTES, PackageError};

use crate::{Labels, Scene};
use changes::Changes;
use encoding::{decoded, split, split_head, undecoded, whole};

/// The package of `scene`, without labels. The same scene always gives the same bytes.
pub fn to_bytes(scene: &Scene) -> Vec<u8> {
    whole(scene, None)
}

/// The package of `scene` with the labels of its parts.
pub fn to_bytes_with_labels(scene: &Scene, labels: &Labels) -> Vec<u8> {
    whole(scene, Some(labels))
}

/// True if the bytes begin like the packages that this program writes and reads; the first [`PACKAGE_HEAD_BYTES`] are enough.
pub fn is_current_package(head: &[u8]) -> bool {
    split_head(head).is_ok()
}

/// True if the bytes begin like the package of a scene that moves.
pub fn is_moving_package(head: &[u8]) -> bool {
    split_head(head).is_ok_and(|(kind, _)| kind.moves)
}

/// True if the bytes begin like the package of a scene with bodies, whether they move or not.
pub fn is_jointed_package(head: &[u8]) -> bool {
    split_head(head).is_ok_and(|(kind, _)| kind.bodies)
}

/// The scene in a package.
///
/// # Errors
/// When the bytes are not a whole package of this version, or the scene in it is not valid.
pub fn from_bytes(bytes: &[u8]) -> Result<Scene, PackageError> {
    Ok(from_bytes_with_labels(bytes)?.0)
}

/// The scene in a package, and the labels of its parts where the package has them.
///
/// # Errors
/// As [`from_bytes`], and when there are not as many labels as parts.
pub fn from_bytes_with_labels(bytes: &[u8]) -> Result<(Scene, Option<Labels>), PackageError> {
    from_bytes_beside(bytes, |_| Err("which is not at hand here"))
}

/// The scene in a package and its labels; `read` reads a file of the package's folder by its name, where the package needs that.
///
/// # Errors
/// As [`from_bytes_with_labels`], and when the other file cannot be read or is not the one that this package was made with. `read` says as
/// a clause why it cannot, such as "which cannot be read".
pub fn from_bytes_beside<E: ToString>(
    bytes: &[u8],
    read: impl FnOnce(&str) -> Result<Vec<u8>, E>,
) -> Result<(Scene, Option<Labels>), PackageError> {
    let (kind, _, body) = split(bytes)?;
    let (scene, labels) = if kind.lacks {
        let (mut changes, rest): (Changes, &[u8]) = postcard::take_from_bytes(body).map_err(undecoded)?;
        changes.take_bodies(kind, rest)?;
        let first = read(FIRST_PACKAGE).map_err(|problem| PackageError::First { problem: problem.to_string() })?;
        (changes.applied(&first)?, None)
    } else {
        decoded(kind, body)?
    };
    scene.validate()?;
    match labels.as_ref().map(|labels| labels.parts.len()).filter(|&labels| labels != scene.parts.len()) {
        Some(labels) => Err(PackageError::Labels { labels, parts: scene.parts.len() }),
        None => Ok((scene, labels)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, BodyMotion, BodyStates, Material, Part, PartLabel, StartCamera};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};

    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = Part { name: "triangle".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        Scene {
            meshes: vec![mesh.into()],
            parts: vec![part],
            materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
            ..Scene::default()
        }
    }

    #[test]
    fn packages_round_trip_and_damage_is_told() {
        let bytes = to_bytes(&scene());
        assert_eq!(from_bytes(&bytes).unwrap(), scene());
        assert!(matches!(from_bytes(&bytes[..bytes.len() - 1]), Err(PackageError::Checksum)));
        assert!(matches!(from_bytes(&bytes[..20]), Err(PackageError::Checksum)));
        assert!(matches!(from_bytes(b"{}"), Err(PackageError::Magic)));
        assert!(is_current_package(&bytes[..32]) && !is_current_package(b"") && !is_current_package(b"enfilade scene 4"));
    }

    #[test]
    fn packages_of_other_versions_are_told_by_their_number() {
        for (head, told) in
            [("2", "found a scene package of version 2, expected 4: it was written by an earlier enfilade"), ("14", "a newer")]
        {
            let bytes = format!("enfilade scene {head}\nwhatever follows").into_bytes();
            let message = from_bytes(&bytes).unwrap_err().to_string();
            assert!(message.contains(told) && message.ends_with("import the scene again") && !is_current_package(&bytes), "{message}");
        }
        for other in ["enfilade scene \n", "enfilade scene x\n", "enfilade scene 4"] {
            assert!(matches!(from_bytes(other.as_bytes()), Err(PackageError::Magic)), "{other}");
        }
    }

    #[test]
    fn labels_travel_with_the_scene_and_must_be_as_many_as_its_parts() {
        let labels = |n| Labels { parts: vec![PartLabel { semantic: 4, instance: 7 }; n] };
        let bytes = to_bytes_with_labels(&scene(), &labels(1));
        assert_eq!(from_bytes_with_labels(&bytes).unwrap(), (scene(), Some(labels(1))));
        assert_eq!(from_bytes(&bytes).unwrap(), scene());
        assert_eq!(from_bytes_with_labels(&to_bytes(&scene())).unwrap().1, None);
        let message = from_bytes(&to_bytes_with_labels(&scene(), &labels(2))).unwrap_err().to_string();
        assert!(message.starts_with("the package has 2 labels for 1 parts"), "{message}");
    }

    #[test]
    fn scenes_that_move_have_packages_of_their_own_and_still_ones_keep_their_bytes() {
        let still = to_bytes(&scene());
        assert!(still.starts_with(b"enfilade scene 4\n"));
        let states = BodyStates::Slide { axis: DVec3::X, distances_m: vec![0.0, 1.0] };
        let motion = BodyMotion { times_s: vec![0.0, 1.0], states };
        let (name, limits) = ("it".to_string(), Some([0.0, 1.0]));
        let body = Body { name, parent: None, parts: vec![0], lights: Vec::new(), cameras: Vec::new(), limits, motion };
        let moving = Scene { bodies: vec![body], ..scene() };
        let mut jointed = moving.clone();
        jointed.hold_still();
        let with_joints = to_bytes(&jointed);
        assert!(
            with_joints.starts_with(b"enfilade scene 6\n")
                && is_jointed_package(&with_joints[..32])
                && !is_moving_package(&with_joints[..32])
        );
        assert_eq!(from_bytes(&with_joints).unwrap(), jointed);
        let bytes = to_bytes(&moving);
        assert!(bytes.starts_with(b"enfilade scene 7\n") && is_current_package(&bytes[..32]));
        assert!(is_moving_package(&bytes[..32]) && !is_moving_package(&still[..32]));
        assert_eq!(from_bytes(&bytes).unwrap(), moving);
        let labels = Labels { parts: vec![PartLabel { semantic: 4, instance: 7 }] };
        assert_eq!(from_bytes_with_labels(&to_bytes_with_labels(&moving, &labels)).unwrap(), (moving.clone(), Some(labels.clone())));

        // Cameras that ride on bodies follow these.
        for (mut filmed, head, moves) in [(jointed, b"enfilade scene 8\n", false), (moving, b"enfilade scene 9\n", true)] {
            let (position, world_from_camera) = (DVec3::X, DMat3::IDENTITY);
            filmed.cameras = vec![StartCamera { name: "wrist".into(), position, world_from_camera, fov_x_rad: 1.0, aspect: 1.5 }];
            filmed.bodies[0].cameras = vec![0];
            let bytes = to_bytes_with_labels(&filmed, &labels);
            assert!(bytes.starts_with(head) && is_jointed_package(&bytes[..32]) && is_moving_package(&bytes[..32]) == moves);
            assert_eq!(from_bytes_with_labels(&bytes).unwrap(), (filmed, Some(labels.clone())));
        }
    }

    #[test]
    fn a_package_with_a_bad_scene_names_the_part() {
        let mut bad = scene();
        bad.parts[0].material = 5;
        let message = from_bytes(&to_bytes(&bad)).unwrap_err().to_string();
        assert_eq!(message, "part \"triangle\" refers to material 5, but there are only 1");
    }
}
