//! Poses made by hand: read from a table, every frame between them interpolated.

use super::planner::Planner;
use super::rules::posed;
use crate::ExploreError;
use enfilade_math::{DVec3, NaturalSpline, Ray};
use enfilade_scene::{GIT_LFS_POINTER, Pose, is_git_lfs_pointer};
use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer};
use std::f64::consts::{PI, TAU};

/// Ways between frames that cross a surface are named up to this many.
const CROSSINGS_NAMED: usize = 12;

/// More frames than this have no number of four digits.
const MAX_FRAMES: u32 = 10_000;

/// A pose made by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Frame number.
    pub frame: u32,
    /// Camera centre, metres.
    pub position: DVec3,
    /// A point in the middle of the picture, metres.
    pub look_at: DVec3,
    /// Angle between the image's x axis and the horizon.
    pub roll_rad: f64,
}

/// A row of the file, before it is checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    #[serde(deserialize_with = "whole")]
    frame: u32,
    position: [f64; 3],
    look_at: [f64; 3],
    roll_deg: Option<f64>,
    up: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlatRow {
    #[serde(deserialize_with = "whole")]
    frame: u32,
    position_x: f64,
    position_y: f64,
    position_z: f64,
    look_at_x: f64,
    look_at_y: f64,
    look_at_z: f64,
    roll_deg: Option<f64>,
    up_x: Option<f64>,
    up_y: Option<f64>,
    up_z: Option<f64>,
}

/// A whole number, which pandas may write as `3.0`.
fn whole<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let number = f64::deserialize(deserializer)?;
    let is_whole = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    if is_whole { Ok(number as u32) } else { Err(D::Error::invalid_value(Unexpected::Float(number), &"a whole number from 0")) }
}

/// Reads poses made by hand from the text of `file`, whose name ends in `.json` or `.csv`.
///
/// JSON is an array of `{"frame": 0, "position": [x, y, z], "look_at": [x, y, z]}`; CSV has the columns `frame`, `position_x`,
/// `position_y`, `position_z`, `look_at_x`, `look_at_y`, `look_at_z`, separated by commas, semicolons or tabs. Metres, z up. Optional are
/// `roll_deg`, or `up` (`up_x`, `up_y`, `up_z`) for a vector that shall be upright in the picture. Frames ascend from 0; those left out are
/// interpolated. Empty rows, columns without a name and a byte order mark are skipped, and names of columns may be in any case.
///
/// # Errors
/// [`ExploreError::Keyframes`] with the row, what was found there, and what was expected.
///
/// # Examples
///
/// ```
/// use enfilade_explore::parse_keyframes;
/// use enfilade_math::DVec3;
///
/// let table = "frame, position_x, position_y, position_z, look_at_x, look_at_y, look_at_z\n\
///              0, 1, 1, 1.6, 3, 1, 1.6\n\
///              24, 2, 1, 1.6, 3, 2, 1.6\n";
/// let keyframes = parse_keyframes("walk.csv", table).unwrap();
/// assert_eq!((keyframes[1].frame, keyframes[1].position), (24, DVec3::new(2.0, 1.0, 1.6)));
///
/// let above = r#"[{"frame": 0, "position": [1, 1, 1], "look_at": [1, 1, 0]}]"#;
/// assert!(parse_keyframes("down.json", above).unwrap_err().to_string().starts_with("down.json, pose 1: found a view from"));
/// ```
pub fn parse_keyframes(file: &str, text: &str) -> Result<Vec<Keyframe>, ExploreError> {
    let text = text.trim_start_matches('\u{feff}');
    if is_git_lfs_pointer(text.as_bytes()) {
        return Err(wrong(file, 1, GIT_LFS_POINTER.into(), "poses"));
    }
    let rows = if file.to_lowercase().ends_with(".json") { json_rows(file, text)? } else { csv_rows(file, text)? };
    let mut keyframes: Vec<Keyframe> = Vec::with_capacity(rows.len());
    for (i, row) in rows.into_iter().enumerate() {
        let keyframe = keyframe(&row).map_err(|(found, expected)| wrong(file, i + 1, found, expected))?;
        let in_order = keyframes.last().map_or(row.frame == 0, |last| row.frame > last.frame) && row.frame < MAX_FRAMES;
        if !in_order {
            return Err(wrong(file, i + 1, format!("frame {}", row.frame), "frames that ascend from 0 and stay below 10000"));
        }
        keyframes.push(keyframe);
    }
    if keyframes.is_empty() { Err(wrong(file, 1, "the end of the file".into(), "a pose")) } else { Ok(keyframes) }
}

fn wrong(file: &str, row: usize, found: String, expected: &'static str) -> ExploreError {
    ExploreError::Keyframes { file: file.into(), row, found, expected }
}

fn json_rows(file: &str, text: &str) -> Result<Vec<Row>, ExploreError> {
    const EXPECTED: &str = "an array of {\"frame\", \"position\", \"look_at\"} and optionally \"roll_deg\" or \"up\"";
    let values: Vec<serde_json::Value> = serde_json::from_str(text).map_err(|e| wrong(file, 1, e.to_string(), EXPECTED))?;
    let row = |(i, value)| serde_json::from_value(value).map_err(|e: serde_json::Error| wrong(file, i + 1, e.to_string(), EXPECTED));
    values.into_iter().enumerate().map(row).collect()
}

fn csv_rows(file: &str, text: &str) -> Result<Vec<Row>, ExploreError> {
    const EXPECTED: &str = "the columns frame, position_x, position_y, position_z, look_at_x, look_at_y, look_at_z and optionally \
                            roll_deg or up_x, up_y, up_z";
    let separator = separator(text);
    // Where cells are separated by semicolons, the comma is the decimal point.
    let text = if separator == b';' { text.replace(',', ".") } else { text.into() };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).delimiter(separator).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| wrong(file, 1, e.to_string(), EXPECTED))?.clone();
    // pandas writes the number of each row in a column without a name.
    let named = |record: &csv::StringRecord| -> csv::StringRecord {
        record.iter().zip(&header).filter(|(_, name)| !name.is_empty()).map(|(cell, _)| cell).collect()
    };
    let names: csv::StringRecord = named(&header).iter().map(str::to_lowercase).collect();
    let row = |(i, record): (usize, Result<csv::StringRecord, csv::Error>)| {
        let row = record.and_then(|record| named(&record).deserialize::<FlatRow>(Some(&names)));
        let row = row.map_err(|e| wrong(file, i + 1, e.to_string(), EXPECTED))?;
        let up = match (row.up_x, row.up_y, row.up_z) {
            (None, None, None) => None,
            (Some(x), Some(y), Some(z)) => Some([x, y, z]),
            _ => return Err(wrong(file, i + 1, "an up vector in part".into(), "all of up_x, up_y, up_z, or none")),
        };
        let position = [row.position_x, row.position_y, row.position_z];
        Ok(Row { frame: row.frame, position, look_at: [row.look_at_x, row.look_at_y, row.look_at_z], roll_deg: row.roll_deg, up })
    };
    let is_blank = |record: &Result<csv::StringRecord, csv::Error>| record.as_ref().is_ok_and(|r| r.iter().all(str::is_empty));
    reader.records().filter(|record| !is_blank(record)).enumerate().map(row).collect()
}

/// The separator of the names in the first line that is no comment: a comma, a semicolon or a tab.
fn separator(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    if header.contains(',') { b',' } else { [b';', b'\t'].into_iter().find(|byte| header.as_bytes().contains(byte)).unwrap_or(b',') }
}

/// The pose of a row, or what was found in it and what was expected.
fn keyframe(row: &Row) -> Result<Keyframe, (String, &'static str)> {
    let (position, look_at) = (DVec3::from(row.position), DVec3::from(row.look_at));
    if !position.is_finite() || !look_at.is_finite() {
        return Err((format!("position {position}, look_at {look_at}"), "finite numbers"));
    }
    if posed(row.frame, position, look_at, 0.0).is_none() {
        return Err((format!("a view from {position} to {look_at}"), "two different points, not one (nearly) above the other"));
    }
    let roll_rad = match (row.roll_deg, row.up) {
        (Some(_), Some(_)) => return Err(("both a roll and an up vector".into(), "one of them")),
        (roll_deg, None) => roll_deg.unwrap_or(0.0).to_radians(),
        (None, Some(up)) => Pose::look_at(row.frame, position, look_at, DVec3::from(up)).map_or(f64::NAN, |pose| pose.roll_rad()),
    };
    if !roll_rad.is_finite() {
        return Err((format!("roll_deg {:?}, up {:?}", row.roll_deg, row.up), "a finite angle, or a vector that is not along the view"));
    }
    Ok(Keyframe { frame: row.frame, position, look_at, roll_rad })
}

/// A pose for every frame from the first to the last of `keyframes`, of which there is at least one.
pub(super) fn interpolate(keyframes: &[Keyframe], name: &str) -> Result<Vec<Pose>, ExploreError> {
    let Some(last) = keyframes.last() else {
        return Err(ExploreError::Config { field: "keyframes", found: "none".into(), expected: "at least one pose" });
    };
    let knots: Vec<f64> = keyframes.iter().map(|k| f64::from(k.frame)).collect();
    let positions = NaturalSpline::new(knots.clone(), keyframes.iter().map(|k| k.position).collect());
    let targets = NaturalSpline::new(knots.clone(), keyframes.iter().map(|k| k.look_at).collect());
    let pose = |frame: u32| {
        let at = knots.partition_point(|knot| *knot <= f64::from(frame)).saturating_sub(1);
        let exact = &keyframes[at];
        let (position, look_at) = match exact.frame == frame {
            true => (exact.position, exact.look_at),
            false => (positions.at(f64::from(frame)), targets.at(f64::from(frame))),
        };
        let roll_rad = keyframes.get(at + 1).map_or(exact.roll_rad, |next| {
            let t = f64::from(frame - exact.frame) / f64::from(next.frame - exact.frame);
            let short_way = (next.roll_rad - exact.roll_rad + PI).rem_euclid(TAU) - PI;
            exact.roll_rad + t * short_way
        });
        let problem = "it looks (nearly) straight up or down; add a keyframe that leads around that";
        posed(frame, position, look_at, roll_rad).ok_or_else(|| ExploreError::NoWay {
            trajectory: name.into(),
            position,
            problem: format!("frame {frame}, between keyframes, has no view: {problem}"),
        })
    };
    (0..=last.frame).map(pose).collect()
}

/// Warns of ways between neighbouring frames that pass through a surface.
pub(super) fn warn_of_crossings(planner: &Planner, poses: &[Pose]) {
    let crosses = |pair: &&[Pose]| {
        let (from, to) = (pair[0].position, pair[1].position);
        let Some(direction) = (to - from).try_normalize() else { return false };
        let mut ray = Ray::new(from.as_vec3(), direction.as_vec3());
        ray.t_max = from.distance(to) as f32;
        planner.rules.bvh.occluded(&ray)
    };
    let frames: Vec<String> = poses.windows(2).filter(crosses).map(|pair| pair[1].frame.to_string()).collect();
    if !frames.is_empty() {
        let more = if frames.len() > CROSSINGS_NAMED { ", …" } else { "" };
        let named = frames.iter().take(CROSSINGS_NAMED).cloned().collect::<Vec<_>>().join(", ");
        planner.warn(format!("{} ways from one frame to the next pass through a surface (those to frames {named}{more})", frames.len()));
    }
}
