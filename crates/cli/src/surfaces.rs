//! `surfaces`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::SurfacesArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{cameras, package};
use crate::progress::Progress;
use enfilade_dataset::counted;
use enfilade_multiview::{Filmed, write_surfaces};

/// `surfaces`: what lies along the rays of the frames.
pub fn surfaces(args: &SurfacesArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let cameras = cameras(&dataset, &scenes, args.chosen.camera.as_deref())?;
    let mut lines = Vec::new();
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "surfaces");
        for scene in &scenes {
            let filmed = Filmed::read(&dataset, scene, cameras.as_deref(), &cx)?;
            let frames = filmed.numbered(args.chosen.frames.as_ref());
            if frames.is_empty() {
                continue;
            }
            let package = package(&dataset, scene, &filmed, &cx)?;
            write_surfaces(&filmed, &package, &frames, args.layers, &cx)?;
            lines.push(format!("{scene}: {} with up to {} surfaces per pixel", counted(frames.len(), "frame"), args.layers));
        }
    }
    if lines.is_empty() {
        return Err(Problem::of_data("no frame that is there was chosen", "choose others, or render them: enfilade run"));
    }
    lines.iter().for_each(|line| say(line));
    say("see  _detail/CAMERA/surfaces of each scene");
    Ok(Verdict::Done)
}
