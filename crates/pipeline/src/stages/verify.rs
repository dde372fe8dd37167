//! `verify`: the laws that tie a scene's files together, on a card.

use super::{Inputs, Job, Outcome, Record, boxes, camera_files};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{counted, quoted, remove_if_there, write_json};
use enfilade_scene::{Light, Part, Scene};
use enfilade_verify::frame_gates::GATES;
use enfilade_verify::{LAWS, Law, VerifyReport, verify_listed_scene};

/// The scene's part of the report card, in its work folder; written also when a check does not pass.
pub(crate) const CARD: &str = "card.json";

/// Removes the cards of the scene and of the dataset before the data that they judge change.
pub(super) fn forget(job: &Job) -> Result<(), Error> {
    let layout = job.dataset.layout();
    let cards = [job.work_file(CARD)?, layout.verify_report(), layout.verify_page()];
    Ok(cards.iter().try_for_each(|path| remove_if_there(path))?)
}

pub(super) fn settings(_job: &Job) -> Hash {
    let laws = LAWS.map(|law| (law.statement, law.bound.to_bits()));
    let gates = GATES.map(|gate| (gate.measure, gate.bound.to_bits()));
    Hash::of(&(laws.as_slice(), gates.as_slice()))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = camera_files::inputs(job)?;
    inputs.extend(job.frame_records()?);
    inputs.extend(job.label_records()?);
    inputs.extend(boxes::tables(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let manifest = job.dataset.read_manifest().map_err(Error::stage)?;
    let report = verify_listed_scene(job.dataset, manifest.as_ref(), name, &job.not_judged(), cx);
    let card = job.work_file(CARD)?;
    write_json(&card, &report)?;
    if !report.passed {
        let broken: Vec<String> = report.failures().map(|law| format!("{} (at {})", law.statement, law.place)).collect();
        let message = format!("{} of {} laws do not hold: {}", broken.len(), report.laws.len(), broken.join("; "));
        let card = format!("see the card: enfilade verify {} --scene {}", quoted(job.out().display()), quoted(name));
        return Err(match cause(job, &report) {
            Some((cause, remedy)) => Error::scene(format!("{message}; {cause}"), format!("{remedy}; {card}")),
            None => Error::scene(message, card),
        });
    }
    let rejected = match report.rejected().count() {
        0 => String::new(),
        n => format!("; gates reject {n}"),
    };
    let summary = format!("all {} laws hold over {}{rejected}", report.laws.len(), counted(report.frames, "frame"));
    Ok(Outcome { summary, outputs: vec![card], ..Outcome::default() })
}

/// Why a dataset of no use probably is so, and what to do; `None` where it is of use, or wrong in another way.
fn cause(job: &Job, report: &VerifyReport) -> Option<(String, String)> {
    let broken: Vec<Law> = report.failures().map(|law| law.law).collect();
    if broken.contains(&Law::Lit) {
        return job.load_scene().ok().and_then(|scene| dark(&scene));
    }
    broken.contains(&Law::Worthwhile).then(|| {
        let page = job.dataset.layout().gates_page(&job.scene.name);
        let cause = "most cameras are inside things, outside the building or right in front of a wall, or the unit of the scene is wrong";
        let remedy =
            "place the cameras elsewhere (cameras = \"found\" looks for places), or set other limits or action = \"report\" in [gate]";
        (cause.to_string(), format!("see {}; {remedy}", page.display()))
    })
}

/// Why frames of a scene are black.
fn dark(scene: &Scene) -> Option<(String, String)> {
    let shines = |part: &Part| !scene.materials[part.material as usize].emission.factor.is_black();
    let is_distant = |light: &Light| matches!(light, Light::Directional { .. });
    let is_lit_inside = scene.parts.iter().any(shines) || !scene.lights.iter().all(is_distant);
    let (cause, remedy) = if is_lit_inside {
        (
            "its lights do not reach what the frames show: they are behind walls or in other rooms, or far too weak",
            "move or strengthen them, or hang lamps by lamps = \"ceiling\"",
        )
    } else {
        (
            "all light comes from outside, and the rooms have no opening that it could come in through",
            "hang lamps by lamps = \"ceiling\", or give the rooms windows (glass that lost its transmission is opaque: panes makes it clear)",
        )
    };
    Some((cause.into(), remedy.into()))
}
