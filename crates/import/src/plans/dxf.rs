//! DXF drawings, as text: closed polylines are rooms, texts within them say what they are for.
//!
//! Pairs of a group code and a value (Autodesk's DXF Reference). Read are `LWPOLYLINE` and `POLYLINE` with their `VERTEX` entities, whose
//! bulges are arcs, `CIRCLE`, `LINE`, `TEXT` and `MTEXT` in the section `ENTITIES`, and the unit `$INSUNITS`. A polyline or line on a layer
//! whose name contains "door", "window" or "passage" is an opening as long as it is; polylines that are open are left out. A room without a
//! text is called as its layer.

use super::curves::{Arc, NEAR_M, flattened};
use super::loops::{around, contains};
use super::source::Source;
use crate::ImportError;
use enfilade_math::DVec2;
use enfilade_scene::{DrawnPlan, DrawnRoom, OpeningKind};

/// Metres of the units of `$INSUNITS`, by its number; others are taken for metres.
const UNITS: [(i64, f64); 5] = [(1, 0.0254), (2, 0.3048), (4, 0.001), (5, 0.01), (6, 1.0)];
/// First words of binary files.
const BINARY: &str = "AutoCAD Binary DXF";

/// Whether a text is a DXF drawing.
pub(super) fn is(text: &str) -> bool {
    let mut lines = text.lines().map(str::trim);
    let first = lines.find(|line| !line.is_empty()).is_some_and(|line| line.parse::<i64>().is_ok());
    text.starts_with(BINARY) || first && text.lines().any(|line| line.trim() == "ENTITIES")
}

/// A pair of code and value, and the number of its line.
type Pair<'t> = (i64, &'t str, usize);

#[derive(Default)]
struct Entity<'t> {
    kind: &'t str,
    layer: &'t str,
    points: Vec<DVec2>,
    /// Bulges of the pieces that begin at points, by the points' numbers.
    bulges: Vec<(usize, f64)>,
    /// The other end of a line.
    end: DVec2,
    /// Of a circle.
    radius: f64,
    is_closed: bool,
    text: String,
}

impl Entity<'_> {
    /// The corners in metres, those of arcs too.
    fn corners(&self, unit: f64) -> Vec<DVec2> {
        let points: Vec<DVec2> = self.points.iter().map(|p| *p * unit).collect();
        match (self.kind, &points[..]) {
            ("LINE", _) => points.into_iter().chain([self.end * unit]).collect(),
            ("CIRCLE", &[center, ..]) => Arc::whole(center, DVec2::splat(self.radius * unit)).corners(NEAR_M),
            ("LWPOLYLINE" | "POLYLINE", _) if !self.bulges.is_empty() => self.bent(&points),
            _ => points,
        }
    }

    fn bent(&self, points: &[DVec2]) -> Vec<DVec2> {
        let mut corners = Vec::new();
        for (i, &from) in points.iter().enumerate() {
            corners.push(from);
            let Some(&to) = points.get(i + 1).or(points.first().filter(|_| self.is_closed)) else { continue };
            let bulge = self.bulges.binary_search_by_key(&i, |(at, _)| *at).map_or(0.0, |found| self.bulges[found].1);
            if let Some(arc) = Arc::of_bulge([from, to], bulge) {
                let pieces = flattened(&|t| arc.at(t), NEAR_M);
                corners.extend(&pieces[..pieces.len() - 1]);
            }
        }
        corners
    }
}

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    if source.text.starts_with(BINARY) {
        return Err(source.error("its beginning", "it is binary DXF, expected DXF as text: save it as ASCII DXF"));
    }
    let pairs = pairs(source)?;
    let mut plan = DrawnPlan::default();
    let unit = unit(&pairs, &mut plan.notes);
    let entities = entities(source, &pairs)?;
    let opening = |layer: &str| {
        let layer = layer.to_lowercase();
        let kinds = [("door", OpeningKind::Door), ("window", OpeningKind::Window), ("passage", OpeningKind::Passage)];
        kinds.into_iter().find(|(part, _)| layer.contains(part)).map(|(_, kind)| kind)
    };
    let (mut open, mut lines) = (0, 0);
    for entity in &entities {
        let points = entity.corners(unit);
        match (opening(entity.layer), entity.kind) {
            (_, "TEXT" | "MTEXT") => {}
            (Some(kind), _) => plan.openings.extend(around(kind, &points, None)),
            (None, "LINE") => lines += 1,
            (None, _) if entity.kind != "CIRCLE" && !entity.is_closed && points.first() != points.last() => open += 1,
            (None, _) => {
                let texts = entities.iter().filter(|other| matches!(other.kind, "TEXT" | "MTEXT"));
                let text =
                    texts.filter(|text| text.points.first().is_some_and(|at| contains(&points, *at * unit))).map(|text| text.text.trim());
                let word = text.into_iter().find(|text| text.chars().any(char::is_alphabetic)).unwrap_or(entity.layer);
                let name = format!("{word} ({})", plan.rooms.len());
                plan.rooms.push(DrawnRoom { name, kind: word.into(), polygon: points, height_m: None });
            }
        }
    }
    if lines > 0 && plan.rooms.is_empty() {
        plan.notes.push(format!("{lines} single lines are no outlines: draw a closed polyline around each room (BOUNDARY)"));
    }
    if open > 0 {
        plan.notes.push(format!("{open} polylines are not closed and on no layer of doors or windows; they are left out"));
    }
    Ok(plan)
}

fn pairs<'t>(source: &Source<'t>) -> Result<Vec<Pair<'t>>, ImportError> {
    let lines: Vec<&str> = source.text.lines().collect();
    let pair = |(i, pair): (usize, &[&'t str])| {
        let number = 2 * i + 1;
        let code = pair[0].trim().parse::<i64>().map_err(|_| {
            source.error(format!("line {number}"), format!("found {:?}, expected a group code, a whole number", pair[0].trim()))
        })?;
        Ok((code, pair[1].trim(), number))
    };
    lines.chunks_exact(2).enumerate().map(pair).collect()
}

/// Metres of a unit.
fn unit(pairs: &[Pair], notes: &mut Vec<String>) -> f64 {
    let stated =
        pairs.iter().position(|(code, value, _)| *code == 9 && *value == "$INSUNITS").and_then(|i| pairs.get(i + 1)?.1.parse::<i64>().ok());
    let known = stated.and_then(|stated| UNITS.iter().find(|(number, _)| *number == stated));
    if known.is_none() {
        notes.push("the drawing has no unit that is known ($INSUNITS); its lengths were taken as metres".into());
    }
    known.map_or(1.0, |(_, metres)| *metres)
}

fn entities<'t>(source: &Source, pairs: &[Pair<'t>]) -> Result<Vec<Entity<'t>>, ImportError> {
    let begin = pairs.iter().position(|(code, value, _)| *code == 2 && *value == "ENTITIES");
    let Some(begin) = begin else { return Err(source.error("its sections", "there is no section ENTITIES, which has the drawing")) };
    let mut all: Vec<Entity> = Vec::new();
    let mut is_vertex = false;
    for &(code, value, line) in pairs[begin + 1..].iter().take_while(|(code, value, _)| !(*code == 0 && *value == "ENDSEC")) {
        if code == 0 {
            is_vertex = value == "VERTEX";
            if !is_vertex && value != "SEQEND" {
                all.push(Entity { kind: value, ..Entity::default() });
            }
            continue;
        }
        let Some(entity) = all.last_mut() else { continue };
        let number = || {
            let number = value.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| source.error(format!("line {}", line + 1), format!("found {value:?}, expected a number")))
        };
        match code {
            8 if !is_vertex => entity.layer = value,
            // The point of an old polyline itself is none of its corners.
            10 if entity.kind != "POLYLINE" || is_vertex => entity.points.push(DVec2::new(number()?, 0.0)),
            20 if entity.kind != "POLYLINE" || is_vertex => {
                let y = number()?;
                entity.points.iter_mut().last().into_iter().for_each(|p| p.y = y);
            }
            11 => entity.end.x = number()?,
            21 => entity.end.y = number()?,
            40 if entity.kind == "CIRCLE" => entity.radius = number()?,
            42 if number()? != 0.0 && !entity.points.is_empty() => entity.bulges.push((entity.points.len() - 1, number()?)),
            70 if !is_vertex => entity.is_closed = value.parse::<i64>().is_ok_and(|flags| flags & 1 == 1),
            1 | 3 => entity.text.push_str(value),
            _ => {}
        }
    }
    all.retain(|entity| matches!(entity.kind, "LWPOLYLINE" | "POLYLINE" | "LINE" | "CIRCLE" | "TEXT" | "MTEXT"));
    Ok(all)
}
