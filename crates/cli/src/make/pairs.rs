//! `make pairs`: which frames see the same surfaces.

use super::frames::cameras;
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, HiddenBy, counted, write_pairs};
use enfilade_multiview::{CovisibilityConfig, Filmed, PairFilter, ScenePackage, choose_pairs, covisibility};
use enfilade_scene::Cx;

/// Measures how much of each other frames see, and lists the pairs that are chosen.
pub fn pairs(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let cameras = cameras(dataset, &scenes, args.chosen.camera.as_deref())?;
    let config = CovisibilityConfig { grid_pixels: args.pairs.pixels.unwrap_or(CovisibilityConfig::default().grid_pixels) };
    let filter = filter(args);
    let (mut chosen, mut frames) = (Vec::new(), 0);
    for scene in &scenes {
        let filmed = Filmed::read(dataset, scene, cameras.as_deref(), cx)?;
        if filmed.is_empty() {
            continue;
        }
        let package = ScenePackage::read(&filmed, cx)?;
        let found = covisibility(&filmed, package.as_ref(), config, cx)?;
        dataset.write_covisibility(scene, &found)?;
        let rows = choose_pairs(&filmed, &found, &filter);
        let hidden = match found.hidden_by {
            HiddenBy::Scene => "",
            HiddenBy::Distances => "; what is hidden was decided by the frames' distances only, since the scene package is missing",
        };
        let n = filmed.len();
        lines.push(format!("{scene}: {}, {} of {} pairs{hidden}", counted(n, "frame"), rows.len(), n * (n - 1) / 2));
        frames += n;
        chosen.extend(rows);
    }
    if frames == 0 {
        let problem = format!("no camera that was chosen has frames in {}", args.dataset.display());
        return Err(Problem::of_data(problem, "make them with `enfilade run`, which also reports what failed"));
    }
    let list = args.list.pairs.clone().unwrap_or_else(|| dataset.layout().pairs());
    write_pairs(&list, &chosen)?;
    lines.push(format!("see  {}", list.display()));
    Ok(())
}

/// The pairs that `--overlap`, `--baseline` and `--angle` leave.
fn filter(args: &MakeArgs) -> PairFilter {
    let any = PairFilter::default();
    PairFilter {
        overlap: args.pairs.overlap.unwrap_or(any.overlap),
        baseline_m: args.pairs.baseline.unwrap_or(any.baseline_m),
        angle_deg: args.pairs.angle.unwrap_or(any.angle_deg),
    }
}
