//! `flow`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::FlowArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{cameras, package};
use crate::progress::Progress;
use enfilade_dataset::{FramePair, counted, read_pairs};
use enfilade_multiview::{Filmed, write_flow};

/// `flow`: where the surfaces of frames are in others.
pub fn flow(args: &FlowArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    if args.between.is_some() && scenes.len() > 1 {
        return Err(Problem::new("the dataset has several scenes", format!("name one with --scene: {}", scenes.join(", "))));
    }
    let cameras = cameras(&dataset, &scenes, args.camera.as_deref())?;
    let listed = args.pairs.as_deref().map(read_pairs).transpose()?;
    let mut lines = Vec::new();
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "flow");
        for scene in &scenes {
            let filmed = Filmed::read(&dataset, scene, cameras.as_deref(), &cx)?;
            let pairs = chosen(args, listed.as_deref(), scene, &filmed)?;
            if pairs.is_empty() {
                continue;
            }
            let package = package(&dataset, scene, &filmed, &cx)?;
            write_flow(&filmed, &package, &pairs, &cx)?;
            lines.push(format!("{scene}: flow of {}", counted(pairs.len(), "pair")));
        }
    }
    if lines.is_empty() {
        return Err(Problem::of_data("no pair of frames that are there was chosen", "choose others, or render them: enfilade run"));
    }
    lines.iter().for_each(|line| say(line));
    say("see  _detail/CAMERA/pairs of each scene");
    Ok(Verdict::Done)
}

/// The pairs of a scene that are asked for.
fn chosen(args: &FlowArgs, listed: Option<&[FramePair]>, scene: &str, filmed: &Filmed<'_>) -> Result<Vec<[usize; 2]>, Problem> {
    if let Some(step) = args.step {
        return Ok(filmed.steps(step));
    }
    let find = |(camera, number): &(String, u32)| {
        filmed.find(camera, *number).ok_or_else(|| {
            let message = format!("{scene} has no finished frame {camera}/{number} among those chosen");
            Problem::new(message, "see `enfilade pairs`, which lists pairs of frames that are there")
        })
    };
    if let Some(between) = &args.between {
        return Ok(vec![[find(&between[0])?, find(&between[1])?]]);
    }
    let mut pairs = Vec::new();
    for pair in listed.into_iter().flatten().filter(|pair| pair.scene == *scene) {
        let (first, second) = (find(&pair.first)?, find(&pair.second)?);
        pairs.extend([[first, second], [second, first]]);
    }
    Ok(pairs)
}
