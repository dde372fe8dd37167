//! `import` of real data sets: into the layouts that training reads.

use crate::args::ImportArgs;
use crate::outcome::{Problem, Verdict, say};
use enfilade_dataset::{DatasetError, write_bytes};
use enfilade_pipeline::refuse_overwriting;
use enfilade_shapes::{Document, MISMATCHED, ingest_pix3d};
use std::path::{Path, PathBuf};

/// The file by which the folder of Pix3D is known.
const PIX3D: &str = "pix3d.json";

/// Whether `import` was given Pix3D, and not a scene.
pub fn is_pix3d(args: &ImportArgs) -> bool {
    args.partition.is_some() || args.input.join(PIX3D).is_file()
}

/// `import` of Pix3D as it is published, to the JSON that Mesh R-CNN and the shape experiment read.
pub fn pix3d(args: &ImportArgs) -> Result<Verdict, Problem> {
    let (root, output) = (&args.input, pix3d_output(args)?);
    let found = ingest_pix3d(root, args.partition.as_deref()).map_err(|error| Problem::found(&error))?;
    refuse_overwriting(output, &inputs(args, &found.document))?;
    let write = |error: DatasetError| Problem::new(error.to_string(), "choose another file");
    let is_file = output.symlink_metadata().map_or(true, |found| found.is_file());
    // Devices, pipes and links are written to, and not replaced by a file.
    let written = if is_file { write_bytes(output, found.document.to_json()) } else { write_to(output, &found.document) };
    written.map_err(write)?;
    let (images, written) = (found.document.images.len(), output.display());
    say(&format!("{written}: images with one object each: {images}; paths begin at {}", root.display()));
    if found.mismatched > 0 {
        say(&format!("left out, since their masks are of other images: {} of {}", found.mismatched, MISMATCHED.join(", ")));
    }
    if found.outside_split > 0 {
        say(&format!("left out, since the partition does not name them: {}", found.outside_split));
    }
    Ok(Verdict::Done)
}

/// The file to write. It has no default: it may be among the images or anywhere else.
fn pix3d_output(args: &ImportArgs) -> Result<&Path, Problem> {
    let root = args.input.display();
    if let Some(flag) = args.choices.first().or_else(|| args.check.then(|| "--check".into())) {
        return Err(Problem::new(format!("{flag} is for scenes, but {root} is Pix3D"), format!("leave {flag} out")));
    }
    let name = || Problem::new("no file is named for the images of Pix3D", format!("give -o {}", args.input.join("all.json").display()));
    args.output.as_deref().ok_or_else(name)
}

fn write_to(output: &Path, document: &Document) -> Result<(), DatasetError> {
    std::fs::write(output, document.to_json()).map_err(|source| DatasetError::Io { action: "write", path: output.into(), source })
}

/// The files that the document is made from: those of Pix3D that it names, and the partition.
fn inputs(args: &ImportArgs, document: &Document) -> Vec<PathBuf> {
    let images = document.images.iter().map(|image| &image.file_name);
    let others = document.annotations.iter().flat_map(|object| [&object.segmentation, &object.model, &object.voxel]);
    let named = images.chain(others).map(|name| args.input.join(name));
    [args.input.join(PIX3D)].into_iter().chain(args.partition.clone()).chain(named).collect()
}
