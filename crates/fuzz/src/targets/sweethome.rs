//! Homes of Sweet Home 3D: zip archives with `Home.xml`, models and pictures.

use crate::{Run, seeds};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::Quiet;
use std::path::Path;

/// A corner with three legs.
const MODEL: &[u8] = b"mtllib tripod.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl oak\nf 1 2 3\nf 1 3 4\nf 1 4 2\n";

/// Imports an archive; other bytes as the description of a home in one that is right, since searching would never find an archive's
/// checksums.
pub fn home(folder: &Path) -> Run {
    let file = folder.join("home.sh3d");
    let picture = seeds::pictures().swap_remove(0).bytes;
    let options = ImportOptions { allow_missing_textures: true, allow_missing_meshes: true, ..ImportOptions::default() };
    Box::new(move |bytes| {
        let archive = match bytes.starts_with(b"PK") {
            true => bytes.to_vec(),
            false => {
                let model = [("1/tripod.obj", MODEL), ("1/tripod.mtl", b"newmtl oak\nKd 0.4 0.3 0.2\n")];
                seeds::zip(&[&[("Home.xml", bytes), ("2", &picture)], &model[..]].concat())
            }
        };
        std::fs::write(&file, archive).expect("a folder that can be written");
        if let Ok(imported) = load(&file, &options, &Quiet) {
            imported.scene.validate().expect("an imported scene is valid");
        }
    })
}
