//! The scene package: a [`Scene`] as one self-contained run of bytes, pictures included.
//!
//! Layout: the magic line, the BLAKE3 hash of the body (32 bytes), the body in postcard encoding. Reading checks the hash, so
//! a truncated or altered package is told from a scene that is wrong.

use crate::{Scene, SceneError};

/// Its number rises with every change of the types in a [`Scene`]: postcard writes no names.
const MAGIC: &[u8] = b"enfilade scene 2\n";

/// Why bytes are not a scene package.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// Not the magic line.
    #[error("not a scene package of this version (expected it to begin with \"enfilade scene 2\"); import the scene again")]
    Magic,
    /// The bytes are not what was written.
    #[error("the package is damaged or cut short: its checksum does not match; import the scene again")]
    Checksum,
    /// The encoding does not fit this version's types.
    #[error("the package cannot be decoded ({0}); import the scene again with this version")]
    Decode(String),
    /// The scene inside is not valid.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// The package of `scene`. The same scene always gives the same bytes.
///
/// # Panics
/// Never: a scene is plain data and always encodes.
pub fn to_bytes(scene: &Scene) -> Vec<u8> {
    let body = postcard::to_stdvec(scene).expect("plain data encodes");
    [MAGIC, blake3::hash(&body).as_bytes(), &body].concat()
}

/// The scene in a package.
///
/// # Errors
/// When the bytes are not a whole package of this version, or the scene in it is not valid.
pub fn from_bytes(bytes: &[u8]) -> Result<Scene, PackageError> {
    let rest = bytes.strip_prefix(MAGIC).ok_or(PackageError::Magic)?;
    let (hash, body) = rest.split_at_checked(32).ok_or(PackageError::Checksum)?;
    if blake3::hash(body).as_bytes() != hash {
        return Err(PackageError::Checksum);
    }
    let scene: Scene = postcard::from_bytes(body).map_err(|e| PackageError::Decode(e.to_string()))?;
    scene.validate()?;
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, Part};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec3};

    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = Part { name: "triangle".into(), mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        Scene { meshes: vec![mesh], parts: vec![part], materials: vec![Material::diffuse("grey", Rgb::splat(0.5))], ..Scene::default() }
    }

    #[test]
    fn packages_round_trip_and_damage_is_told() {
        let bytes = to_bytes(&scene());
        assert_eq!(from_bytes(&bytes).unwrap(), scene());
        assert!(matches!(from_bytes(&bytes[..bytes.len() - 1]), Err(PackageError::Checksum)));
        assert!(matches!(from_bytes(&bytes[..20]), Err(PackageError::Checksum)));
        assert!(matches!(from_bytes(b"{}"), Err(PackageError::Magic)));
    }

    #[test]
    fn a_package_with_a_bad_scene_names_the_part() {
        let mut bad = scene();
        bad.parts[0].material = 5;
        let message = from_bytes(&to_bytes(&bad)).unwrap_err().to_string();
        assert_eq!(message, "part \"triangle\" refers to material 5, but there are only 1");
    }
}
