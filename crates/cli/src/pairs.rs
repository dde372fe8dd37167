//! `pairs`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::{FramesArg, PairsArgs};
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::{ChosenFrames, Dataset, HiddenBy, counted, write_pairs};
use enfilade_multiview::{CovisibilityConfig, Filmed, PairFilter, ScenePackage, choose_pairs, covisibility};
use enfilade_scene::Cx;

/// `pairs`: which frames see the same surfaces.
pub fn pairs(args: &PairsArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let cameras = cameras(&dataset, &scenes, args.camera.as_deref())?;
    let config = CovisibilityConfig { grid_pixels: args.pixels };
    let filter = PairFilter {
        overlap: args.overlap.unwrap_or(PairFilter::default().overlap),
        baseline_m: [args.min_baseline, args.max_baseline],
        angle_deg: [args.min_angle, args.max_angle],
    };
    let (mut chosen, mut lines, mut frames) = (Vec::new(), Vec::new(), 0);
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "pairs");
        for scene in &scenes {
            let filmed = Filmed::read(&dataset, scene, cameras.as_deref(), &cx)?;
            if filmed.is_empty() {
                continue;
            }
            let package = ScenePackage::read(&filmed, &cx)?;
            let found = covisibility(&filmed, package.as_ref(), config, &cx)?;
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
    }
    if frames == 0 {
        let problem = format!("no camera that was chosen has frames in {}", args.dataset.display());
        return Err(Problem::of_data(problem, "make them with `enfilade run`, which also reports what failed"));
    }
    let list = args.output.clone().unwrap_or_else(|| dataset.layout().pairs());
    write_pairs(&list, &chosen)?;
    lines.iter().for_each(|line| say(line));
    say(&format!("see  {}", list.display()));
    Ok(Verdict::Done)
}

/// The names of the cameras that a pattern means; `None` for all.
pub fn cameras(dataset: &Dataset, scenes: &[String], pattern: Option<&str>) -> Result<Option<Vec<String>>, Problem> {
    let Some(pattern) = pattern else { return Ok(None) };
    Ok(Some(enfilade_pipeline::select("camera", &dataset.camera_names(scenes)?, Some(pattern))?))
}

/// The frames that `--scene`, `--camera` and `--frames` mean.
pub fn chosen_frames(dataset: &Dataset, args: &FramesArg) -> Result<ChosenFrames, Problem> {
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let cameras = cameras(dataset, &scenes, args.camera.as_deref())?;
    Ok(ChosenFrames { scenes, cameras, frames: args.frames.clone() })
}

/// What to say where these mean no frame that is there.
pub fn nothing_chosen() -> Problem {
    Problem::of_data("no frame that is there was chosen", "choose others, or render them: enfilade run")
}

/// Calls `work` for every scene of which frames are chosen, with what was filmed, these frames and the scene itself.
pub fn each_filmed(
    dataset: &Dataset,
    chosen: &ChosenFrames,
    cx: &dyn Cx,
    mut work: impl FnMut(&str, &Filmed<'_>, &[usize], &ScenePackage) -> Result<(), Problem>,
) -> Result<(), Problem> {
    for scene in &chosen.scenes {
        let filmed = Filmed::read(dataset, scene, chosen.cameras.as_deref(), cx)?;
        let frames = filmed.numbered(chosen.frames.as_ref());
        if !frames.is_empty() {
            work(scene, &filmed, &frames, &package(dataset, scene, &filmed, cx)?)?;
        }
    }
    Ok(())
}

/// The scene that was filmed, for verbs that cannot do without.
///
/// # Errors
/// When it is not there, or is another one than the frames were rendered from.
pub fn package(dataset: &Dataset, scene: &str, filmed: &Filmed<'_>, cx: &dyn Cx) -> Result<ScenePackage, Problem> {
    ScenePackage::read(filmed, cx)?.ok_or_else(|| {
        let message =
            format!("{} is not the scene that {scene} was rendered from, or not there", dataset.layout().scene_package(scene).display());
        Problem::of_data(message, "rays need it: use the dataset where `enfilade run` made it, and run it again where it is out of date")
    })
}
