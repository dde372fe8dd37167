//! Libraries of models that replace the furniture of homes.

use crate::{Run, seeds};
use enfilade_pipeline::read_library;
use enfilade_scene::Quiet;
use std::path::Path;

/// Reads an archive as a catalogue; other bytes as what a catalogue lists, and as the table beside one that is right. Searching would
/// never find the checksums of an archive.
pub fn library(folder: &Path) -> Run {
    let (own, good) = (folder.join("own"), folder.join("good"));
    for folder in [&own, &good] {
        std::fs::create_dir(folder).expect("a folder that can be written");
    }
    let catalogue = seeds::catalogues().swap_remove(0).bytes;
    std::fs::write(good.join("good.sh3f"), seeds::archive(&catalogue)).expect("a folder that can be written");
    Box::new(move |bytes| {
        let is_archive = bytes.starts_with(b"PK");
        let archive = if is_archive { bytes.to_vec() } else { seeds::archive(bytes) };
        std::fs::write(own.join("own.sh3f"), archive).expect("a folder that can be written");
        drop(read_library(&own, &Quiet));
        if !is_archive {
            std::fs::write(good.join("assets.toml"), bytes).expect("a folder that can be written");
            drop(read_library(&good, &Quiet));
        }
    })
}
