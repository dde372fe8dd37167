//! `make flow`: where the surfaces of frames are in others.

use super::frames::{cameras, package};
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, FramePair, counted, read_pairs};
use enfilade_multiview::{Filmed, write_flow};
use enfilade_scene::Cx;

/// Writes flow between the frames of a list, by steps, or from one frame to another.
pub fn flow(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    if args.flow.between.is_some() && scenes.len() > 1 {
        return Err(Problem::new("the dataset has several scenes", format!("name one with --scene: {}", scenes.join(", "))));
    }
    let cameras = cameras(dataset, &scenes, args.chosen.camera.as_deref())?;
    let listed = listed(args, dataset)?;
    for scene in &scenes {
        let filmed = Filmed::read(dataset, scene, cameras.as_deref(), cx)?;
        let pairs = chosen(args, &listed, scene, &filmed)?;
        if pairs.is_empty() {
            continue;
        }
        let package = package(dataset, scene, &filmed, cx)?;
        write_flow(&filmed, &package, &pairs, cx)?;
        lines.push(format!("{scene}: flow of {}", counted(pairs.len(), "pair")));
    }
    if lines.is_empty() {
        return Err(Problem::of_data("no pair of existing frames was selected", "choose others, or render them: enfilade run"));
    }
    lines.push("see  _detail/CAMERA/pairs of each scene".into());
    Ok(())
}

/// The pairs of the list, unless the frames are chosen in another way.
fn listed(args: &MakeArgs, dataset: &Dataset) -> Result<Vec<FramePair>, Problem> {
    if args.flow.step.is_some() || args.flow.between.is_some() {
        return Ok(Vec::new());
    }
    let list = args.list.pairs.clone().unwrap_or_else(|| dataset.layout().pairs());
    if args.list.pairs.is_none() && !list.is_file() {
        let help = format!("list pairs first: enfilade make {} pairs; or give --step or --between", args.dataset.display());
        return Err(Problem::new(format!("flow follows a list of view pairs, but {} does not exist", list.display()), help));
    }
    Ok(read_pairs(&list)?)
}

/// The pairs of a scene that are asked for.
fn chosen(args: &MakeArgs, listed: &[FramePair], scene: &str, filmed: &Filmed<'_>) -> Result<Vec<[usize; 2]>, Problem> {
    if let Some(step) = args.flow.step {
        return Ok(filmed.steps(step));
    }
    let find = |(camera, number): &(String, u32)| {
        filmed.find(camera, *number).ok_or_else(|| {
            let message = format!("{scene} has no finished frame {camera}/{number} among those chosen");
            Problem::new(message, "`enfilade make OUT pairs` lists pairs of frames that are there")
        })
    };
    if let Some(between) = &args.flow.between {
        return Ok(vec![[find(&between[0])?, find(&between[1])?]]);
    }
    let mut pairs = Vec::new();
    for pair in listed.iter().filter(|pair| pair.scene == *scene) {
        let (first, second) = (find(&pair.first)?, find(&pair.second)?);
        pairs.extend([[first, second], [second, first]]);
    }
    Ok(pairs)
}
