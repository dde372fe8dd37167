//! `ingest`: real data sets in the layouts that training reads.

use crate::args::{IngestArgs, IngestVerb, Pix3dArgs};
use crate::outcome::{Problem, Verdict, say};
use enfilade_shapes::{MISMATCHED, ingest_pix3d};

/// `ingest`.
pub fn ingest(args: &IngestArgs) -> Result<Verdict, Problem> {
    match &args.verb {
        IngestVerb::Pix3d(args) => pix3d(args),
    }
}

fn pix3d(args: &Pix3dArgs) -> Result<Verdict, Problem> {
    let found = ingest_pix3d(&args.root, args.split.as_deref()).map_err(|error| Problem::found(&error))?;
    let write = |error: std::io::Error| Problem::new(format!("cannot write {}: {error}", args.output.display()), "choose another file");
    std::fs::write(&args.output, found.document.to_json()).map_err(write)?;
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
