//! `ingest`: real data sets in the layouts that training reads.

use crate::args::{IngestArgs, IngestVerb, Pix3dArgs};
use crate::outcome::{Problem, Verdict, say};
use enfilade_dataset::{DatasetError, write_bytes};
use enfilade_pipeline::refuse_overwriting;
use enfilade_shapes::{Document, MISMATCHED, ingest_pix3d};
use std::path::{Path, PathBuf};

/// `ingest`.
pub fn ingest(args: &IngestArgs) -> Result<Verdict, Problem> {
    match &args.verb {
        IngestVerb::Pix3d(args) => pix3d(args),
    }
}

fn pix3d(args: &Pix3dArgs) -> Result<Verdict, Problem> {
    let found = ingest_pix3d(&args.root, args.split.as_deref()).map_err(|error| Problem::found(&error))?;
    refuse_overwriting(&args.output, &inputs(args, &found.document))?;
    let write = |error: DatasetError| Problem::new(error.to_string(), "choose another file");
    let is_file = args.output.symlink_metadata().map_or(true, |found| found.is_file());
    // Devices, pipes and links are written to, and not replaced by a file.
    let written = if is_file { write_bytes(&args.output, found.document.to_json()) } else { write_to(&args.output, &found.document) };
    written.map_err(write)?;
    let (images, output) = (found.document.images.len(), args.output.display());
    say(&format!("{output}: images with one object each: {images}; paths begin at {}", args.root.display()));
    if found.mismatched > 0 {
        say(&format!("left out, since their masks are of other images: {} of {}", found.mismatched, MISMATCHED.join(", ")));
    }
    if found.outside_split > 0 {
        say(&format!("left out, since the split does not name them: {}", found.outside_split));
    }
    Ok(Verdict::Done)
}

fn write_to(output: &Path, document: &Document) -> Result<(), DatasetError> {
    std::fs::write(output, document.to_json()).map_err(|source| DatasetError::Io { action: "write", path: output.into(), source })
}

/// The files that the document is made from: those of Pix3D that it names, and the split.
fn inputs(args: &Pix3dArgs, document: &Document) -> Vec<PathBuf> {
    let images = document.images.iter().map(|image| &image.file_name);
    let others = document.annotations.iter().flat_map(|object| [&object.segmentation, &object.model, &object.voxel]);
    let named = images.chain(others).map(|name| args.root.join(name));
    [args.root.join("pix3d.json")].into_iter().chain(args.split.clone()).chain(named).collect()
}
