//! The scene package (`.scene`) that `enfilade import` writes: read, checked and passed on.
//!
//! It is in metres with z up, so that other units and axes are refused. Its labels come along. The package of a variation needs the one
//! beside it.

use crate::assembly::Assembly;
use crate::{ImportError, ImportOptions, Imported, UpAxis};
use std::path::Path;

/// Reads a scene package. Units and axes are already the world's, so only the environment can be overridden.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    check_space(&file, assembly.options())?;
    let bytes = assembly.read_scene_file()?;
    let beside = |name: &str| match assembly.read(name) {
        Ok((_, bytes)) => Ok(bytes),
        Err(error) => Err(format!("which cannot be read ({error})")),
    };
    let (scene, labels) = enfilade_scene::from_bytes_beside(&bytes, beside).map_err(|source| ImportError::Package { file, source })?;
    assembly.set_labels(labels);
    assembly.finish_scene(scene)
}

/// Refuses units and axes that the package does not have: the scene would come out as if they had not been given.
fn check_space(file: &Path, options: &ImportOptions) -> Result<(), ImportError> {
    let refused = |option: &'static str, found: &str, expected: &str| {
        let problem = format!(
            "found {found}, expected {expected}: {} is a scene package, which is in metres with z up; leave the option out, or import what \
             the package was made from",
            file.display()
        );
        Err(ImportError::Option { option, problem })
    };
    match options.up_axis {
        _ if options.meters_per_unit != 1.0 => refused("meters_per_unit", &options.meters_per_unit.to_string(), "1"),
        Some(UpAxis::Z) | None => Ok(()),
        Some(other) => refused("up_axis", other.name(), "z"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec3};
    use enfilade_scene::{FIRST_PACKAGE, Material, Part, Quiet, Scene, to_bytes, to_bytes_beside};

    #[test]
    fn the_package_of_a_variation_is_read_with_the_one_beside_it() {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = Part { name: "sail".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        let of = |color: f32| Material::diffuse("cloth", Rgb::splat(color));
        let first = Scene { meshes: vec![mesh.into()], parts: vec![part], materials: vec![of(0.5)], ..Scene::default() };
        let varied = Scene { materials: vec![of(0.2)], ..first.clone() };
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("room.scene");
        std::fs::write(&file, to_bytes_beside(&varied, &first, &to_bytes(&first)).unwrap()).unwrap();
        let load = || crate::load(&file, &ImportOptions::default(), &Quiet);
        let message = load().unwrap_err().to_string();
        assert!(message.contains("only what differs from first.scene beside it, which cannot be read"), "{message}");
        std::fs::write(folder.path().join(FIRST_PACKAGE), to_bytes(&first)).unwrap();
        let imported = load().unwrap();
        assert_eq!(imported.scene, varied);
        assert_eq!(imported.inputs.len(), 2, "both are watched for changes");
    }

    #[test]
    fn units_and_axes_that_a_package_does_not_have_are_refused() {
        // The file does not exist: options are refused before it is read, and only wrong ones.
        let error = |options: &ImportOptions| crate::load(Path::new("room.scene"), options, &Quiet).unwrap_err().to_string();
        let whole = ImportOptions::default();
        let feet = error(&ImportOptions { meters_per_unit: 0.3048, ..whole.clone() });
        assert!(feet.starts_with("import option meters_per_unit: found 0.3048, expected 1: room.scene is a scene package"), "{feet}");
        let y_up = error(&ImportOptions { up_axis: Some(UpAxis::Y), ..whole.clone() });
        assert!(y_up.starts_with("import option up_axis: found y, expected z: room.scene is a scene package"), "{y_up}");
        for options in [whole.clone(), ImportOptions { meters_per_unit: 1.0, up_axis: Some(UpAxis::Z), ..whole }] {
            assert!(error(&options).starts_with("room.scene: cannot be read"), "{options:?}");
        }
    }
}
