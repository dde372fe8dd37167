//! Photos: views as people take them of a room.
//!
//! The camera's height and pitch are drawn from the distributions of photographs, and of many such views those are taken that are composed
//! as photographs are: from some distance, with things in view and the corner of a room rather than a wall.

use super::composition::Composer;
use super::places::Places;
use super::planner::{Draft, Planner};
use super::report::Fault;
use super::rules::turned_rad;
use super::stills::reachable;
use super::{PhotosConfig, TargetObject};
use crate::ExploreError;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Views drawn for each candidate wanted, to be compared by coarse looks.
const DRAWS_PER_CANDIDATE: usize = 10;

/// Heights and pitches farther from the mean than this are not drawn, in standard deviations.
const FARTHEST: f64 = 2.5;

/// Photographs from places that the start camera's place sees. Each is chosen among many views in proportion to the likelihood of its
/// composition among photographs. The first one is the start camera's.
pub(super) fn photos(
    planner: &Planner,
    first: Pose,
    photos: &PhotosConfig,
    things: &[TargetObject],
    rng: &Rng,
) -> Result<Draft, ExploreError> {
    let frames = planner.config.frames as usize;
    let places = reachable(planner, first.position, |origin, place| planner.rules.sees(origin, place))?;
    let composer = Composer::new(planner.world, things);
    let fault = |pose: &Pose| {
        let void = || planner.gates.is_void(&planner.views(&[*pose])[0]).then_some(Fault::Void);
        planner.gates.fault(pose, None).or_else(void)
    };
    let mut draft = Draft { poses: vec![first], views: planner.views(&[first]), ..Draft::default() };
    for frame in 1..frames {
        planner.progress(frame, frames);
        let mut rng = rng.fork(frame as u64);
        let drawn = drawn(planner, &places, photos, draft.poses.len() as u32, &mut rng);
        let apart: Vec<Pose> = drawn.into_iter().filter(|pose| draft.poses.iter().all(|other| is_apart(photos, pose, other))).collect();
        let likelihood = |pose: &Pose| composer.likelihood(planner.gates.glancer, pose, &planner.gates.glancer.look(pose));
        let scores: Vec<f64> = apart.par_iter().map(likelihood).collect();
        if let Some(chosen) = planner.draw(&apart, scores, fault, &mut draft.rejected, &mut rng) {
            draft.views.extend(planner.views(&apart[chosen..=chosen]));
            draft.poses.push(apart[chosen]);
        }
    }
    planner.progress(frames, frames);
    let found = draft.poses.len();
    if found < frames {
        let (distance, angle) = (photos.min_distance_m, photos.min_angle_deg);
        planner.warn(format!(
            "{found} of {frames} photos were found: no more views are {distance} m or {angle} degrees from the others; lower min_distance_m or \
             min_angle_deg"
        ));
    }
    Ok(draft)
}

/// Views at random places and in random directions that keep the rules.
fn drawn(planner: &Planner, places: &Places, photos: &PhotosConfig, frame: u32, rng: &mut Rng) -> Vec<Pose> {
    let draw = |_| {
        let place = places.points[rng.below(places.points.len())];
        let height_m = normal(photos.height_m, rng);
        let pitch = normal(photos.pitch_deg, rng).to_radians();
        (place, height_m, pitch, TAU * rng.next_f64(), planner.rules.draw_roll_rad(rng))
    };
    let draws: Vec<(DVec3, f64, f64, f64, f64)> = (0..DRAWS_PER_CANDIDATE * planner.config.candidates as usize).map(draw).collect();
    let pose = |&(place, height_m, pitch, heading, roll): &(DVec3, f64, f64, f64, f64)| {
        let floor = place.z - planner.rules.height_m(place)?;
        let position = DVec3::new(place.x, place.y, floor + height_m);
        if !planner.rules.is_position(position) || !planner.rules.sees(place, position) {
            return None;
        }
        let direction = DVec3::new(pitch.cos() * heading.cos(), pitch.cos() * heading.sin(), pitch.sin());
        planner.rules.toward(frame, position, planner.rules.tilted(direction), roll)
    };
    draws.par_iter().filter_map(pose).collect()
}

/// A number of a normal distribution with this mean and standard deviation, without its tails.
fn normal([mean, deviation]: [f64; 2], rng: &mut Rng) -> f64 {
    mean + deviation * rng.normal().clamp(-FARTHEST, FARTHEST)
}

/// Whether two photos are from different places, or look in different directions.
fn is_apart(photos: &PhotosConfig, a: &Pose, b: &Pose) -> bool {
    a.position.distance(b.position) >= photos.min_distance_m || turned_rad(a, b) >= photos.min_angle_deg.to_radians()
}
