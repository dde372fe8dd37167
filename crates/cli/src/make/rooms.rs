//! `make rooms`: rooms of scenes that came without them, and which plane of them each pixel shows.

use super::frames::chosen_frames;
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{ChosenFrames, Dataset, counted, counted_as, write_bytes};
use enfilade_label::structure::{fit_structure, labelled_triangles, write_planes};
use enfilade_scene::{Cx, Structure};
use enfilade_show::planview::structure_svg;

/// Fits rooms to labelled surfaces where a scene has none, and writes the planes of the chosen frames.
pub fn rooms(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let chosen = chosen_frames(dataset, &args.chosen)?;
    let mut any = false;
    for scene in &chosen.scenes {
        let structure = structure_of(dataset, scene)?;
        any |= structure.is_some();
        lines.push(match &structure {
            Some(structure) => {
                let frames = planes_of_frames(dataset, scene, structure, &chosen, cx)?;
                format!("{scene}: {}, planes of {}", summary(structure), counted(frames, "frame"))
            }
            None => format!("{scene}: no labelled walls and floors that enclose a room"),
        });
    }
    if !any {
        let problem = format!("no scene of {} that was chosen has rooms", args.dataset.display());
        let help =
            "label walls, floors and ceilings by NYU40's classes: `enfilade suggest` proposes a table, `enfilade annotate` opens a scene";
        return Err(Problem::of_data(problem, help));
    }
    lines.push("see  layout.json, layout.svg and metadata_planes.csv in _detail of each scene, and CAMERA/planes in it".into());
    Ok(())
}

/// The rooms that the scene came with, or else those that are fitted to its labels as they are now.
fn structure_of(dataset: &Dataset, scene: &str) -> Result<Option<Structure>, Problem> {
    if let Some(known) = dataset.read_structure(scene)?.filter(|structure| structure.fit.is_none()) {
        return Ok(Some(known));
    }
    dataset.forget_planes(scene)?;
    if dataset.mesh_files(scene).read_classes()?.is_some_and(|classes| !classes.are_nyu40()) {
        return Ok(None);
    }
    let triangles = match labelled_triangles(dataset, scene) {
        Err(error) if error.is_not_found() => return Ok(None),
        triangles => triangles?,
    };
    let Some(structure) = fit_structure(&triangles) else { return Ok(None) };
    dataset.write_structure(scene, &structure)?;
    write_bytes(&dataset.layout().structure_plan(scene), structure_svg(&structure))?;
    Ok(Some(structure))
}

/// Writes the planes of the chosen frames of a scene; gives their number.
fn planes_of_frames(dataset: &Dataset, scene: &str, structure: &Structure, chosen: &ChosenFrames, cx: &dyn Cx) -> Result<usize, Problem> {
    let mut count = 0;
    for (camera, frames) in chosen.of_scene(dataset, scene, cx)? {
        write_planes(dataset, [scene, &camera], structure, &frames, cx)?;
        count += frames.len();
    }
    Ok(count)
}

fn summary(structure: &Structure) -> String {
    let Structure { rooms, walls, openings, fit, .. } = structure;
    let counts = format!(
        "{}, {}, {}",
        counted(rooms.len(), "room"),
        counted(walls.len(), "wall face"),
        counted_as(openings.len(), "door or window", "doors and windows")
    );
    match fit {
        None => format!("{counts} as it was built"),
        Some(fit) => format!(
            "{counts}, fitted: {:.0} % of walls, floors and ceilings within 2 cm, 95 % within {:.0} cm",
            100.0 * fit.near_share,
            100.0 * fit.p95_m
        ),
    }
}
