//! Structured3D's `annotation_3d.json`: rooms by the lines of their floor planes.
//!
//! Millimetres, z up (the data set's `annotation_3d.json` as its own `visualize_3d.py` reads it). Of each semantic, `planeID` are its planes;
//! `planeLineMatrix` has the lines of each plane, `lineJunctionMatrix` the two junctions of each line. Doors and windows are where the
//! junctions of their planes are.

use super::loops::{around, loops};
use super::source::Source;
use crate::ImportError;
use crate::collections::json;
use crate::collections::structured3d::annotation::{Annotation, Semantic};
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::{DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind};

/// Millimetres in a metre.
const MILLIMETRES: f64 = 1000.0;
/// Junctions within this are one, metres.
const SAME: f64 = 0.005;

/// The ends of a plane's lines, metres.
fn lines(annotation: &Annotation, plane: usize) -> Vec<[DVec3; 2]> {
    annotation.lines(plane).map(|ends| ends.map(|end| annotation.junctions[end].coordinate / MILLIMETRES)).collect()
}

fn planes_of<'a>(annotation: &'a Annotation, semantic: &'a Semantic, kind: &'a str) -> impl Iterator<Item = usize> + 'a {
    semantic.planes.iter().copied().filter(move |&plane| annotation.planes.get(plane).is_some_and(|plane| plane.r#type == kind))
}

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let annotation: Annotation = json::parse(source.bytes, source.file, "an annotation_3d.json of Structured3D")?;
    let mut plan = DrawnPlan::default();
    for (number, semantic) in annotation.semantics.iter().enumerate() {
        match semantic.r#type.as_str() {
            "outwall" => {}
            "door" => plan.openings.extend(opening(&annotation, semantic, OpeningKind::Door)),
            "window" => plan.openings.extend(opening(&annotation, semantic, OpeningKind::Window)),
            kind => match room(&annotation, semantic, number, kind) {
                Some(room) => plan.rooms.push(room),
                None => plan.notes.push(format!("semantics[{number}], a {kind}, has no floor whose lines close; it is left out")),
            },
        }
    }
    Ok(plan)
}

fn room(annotation: &Annotation, semantic: &Semantic, number: usize, kind: &str) -> Option<DrawnRoom> {
    let flat = |lines: Vec<[DVec3; 2]>| lines.into_iter().map(|ends| ends.map(DVec3::truncate)).collect::<Vec<[DVec2; 2]>>();
    let floors: Vec<usize> = planes_of(annotation, semantic, "floor").collect();
    let found = floors.iter().flat_map(|&plane| loops(&flat(lines(annotation, plane)), SAME).0);
    let polygon = found.max_by(|a, b| super::loops::area(a).abs().total_cmp(&super::loops::area(b).abs()))?;
    let height = |kind: &str| {
        let heights =
            planes_of(annotation, semantic, kind).flat_map(|plane| lines(annotation, plane)).map(|[a, _]| a.z).collect::<Vec<f64>>();
        heights.into_iter().reduce(f64::max)
    };
    let height_m = height("ceiling").zip(height("floor")).map(|(ceiling, floor)| ceiling - floor).filter(|height| *height > 0.5);
    Some(DrawnRoom { name: format!("{kind} ({number})"), kind: kind.into(), polygon, height_m })
}

fn opening(annotation: &Annotation, semantic: &Semantic, kind: OpeningKind) -> Option<DrawnOpening> {
    let points: Vec<DVec3> = semantic.planes.iter().flat_map(|&plane| lines(annotation, plane)).flatten().collect();
    let heights = points.iter().map(|p| p.z);
    let z_m = [heights.clone().fold(f64::INFINITY, f64::min), heights.fold(f64::NEG_INFINITY, f64::max)];
    let lowest = annotation.junctions.iter().map(|junction| junction.coordinate.z / MILLIMETRES).fold(f64::INFINITY, f64::min);
    around(kind, &points.iter().map(|p| p.truncate()).collect::<Vec<_>>(), Some(z_m.map(|z| z - lowest)))
}
