//! Video: a smooth path at bounded speed.
//!
//! The position follows a spline near the corners of a [`tour`], refined until every point of it has room around it. The view turns
//! between directions worth seeing, by headings that always have free space before them. The pose is then a smooth function of one parameter, and what remains is when to be where: as early as the bounds on speed, turning and
//! acceleration allow. Slowing down changes no pose, so the bounds hold by construction; they are measured on the result all the same.

use super::headings::{HEADINGS, Headings, direction};
use super::rules::{pitch_rad, posed, turned_rad};
use super::spline::NearSpline;
use super::stills::candidates;
use super::timing::Schedule;
use super::tour::{Tour, no_way, tour};
use super::{Draft, Planner, VideoConfig};
use crate::ExploreError;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Pose;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Distances of control points that are tried, metres, until the spline has room.
const SPACINGS_M: [f64; 5] = [0.4, 0.2, 0.1, 0.05, 0.025];

/// Poses looked at between two control points.
const SUBSTEPS: usize = 16;

/// Times that headings are chosen anew, without those that turned out to look at nothing.
const REPAIRS: usize = 40;

/// A smooth path of `frames` frames from near `first` on.
pub(super) fn video(planner: &Planner, first: Pose, video: &VideoConfig, rng: &Rng) -> Result<Draft, ExploreError> {
    let frames = planner.config.frames as usize;
    let duration_s = (frames.max(2) - 1) as f64 / video.fps;
    let tour = tour(planner, first.position, video.max_speed_m_s * duration_s, video, &mut rng.fork(0))?;
    let moved = tour.corners[0].distance(first.position);
    if moved > planner.rules.space.tree.resolution_m() {
        planner.warn(format!("begins {moved:.2} m away from its start, where there is room to move"));
    }
    let mut draft = Draft::default();
    let path = Path::along(planner, &tour, video)?;
    let wishes = wishes(planner, &first, &path, &mut draft, rng);
    let shot = Shot::new(planner, path, &wishes, video)?;
    draft.poses = shot.film(planner, frames, video)?;
    planner.progress(frames, frames);
    Ok(draft)
}

/// Where the camera goes.
struct Path {
    spline: NearSpline,
    spacing_m: f64,
    /// Parameters of the spline near the waypoints, ascending.
    waypoints: Vec<f64>,
}

impl Path {
    /// The smoothest spline along the tour that has room everywhere.
    fn along(planner: &Planner, tour: &Tour, video: &VideoConfig) -> Result<Self, ExploreError> {
        let mut blocked = tour.corners[0];
        for spacing_m in SPACINGS_M {
            let path = Self::sampled(tour, spacing_m.min(0.5 * video.waypoint_distance_m));
            match path.blocked(planner) {
                None => return Ok(path),
                Some(p) => blocked = p,
            }
        }
        Err(no_way(planner, blocked, "no smooth path passes here; lower clearance_m, or camera_height_m is too narrow"))
    }

    /// Control points evenly spaced along the tour.
    fn sampled(tour: &Tour, spacing_m: f64) -> Self {
        let (mut points, mut waypoints, mut walked) = (vec![tour.corners[0]], Vec::new(), 0.0);
        let mut is_waypoint = tour.waypoints.iter().copied().peekable();
        for (i, corner) in tour.corners.iter().enumerate() {
            if i > 0 {
                let (from, length) = (tour.corners[i - 1], corner.distance(tour.corners[i - 1]));
                while points.len() as f64 * spacing_m <= walked + length {
                    points.push(from.lerp(*corner, ((points.len() as f64 * spacing_m - walked) / length).clamp(0.0, 1.0)));
                }
                walked += length;
            }
            if is_waypoint.next_if_eq(&i).is_some() {
                waypoints.push(walked / spacing_m);
            }
        }
        let end = (points.len() - 1) as f64;
        waypoints.iter_mut().for_each(|u| *u = u.min(end));
        Self { spline: NearSpline::new(points), spacing_m, waypoints }
    }

    /// A point of the spline without room.
    fn blocked(&self, planner: &Planner) -> Option<DVec3> {
        let steps = self.spline.end() as usize * SUBSTEPS;
        let at = |k: usize| self.spline.at(k as f64 / SUBSTEPS as f64);
        let is_blocked = |k: usize| !planner.rules.is_clear_way(at(k), at((k + 1).min(steps))) || !planner.rules.is_at_height(at(k));
        (0..=steps).into_par_iter().find_first(|k| is_blocked(*k)).map(at)
    }
}

/// A view worth seeing, and where on the path.
struct Wish {
    u: f64,
    heading_rad: f64,
    pitch_rad: f64,
    roll_rad: f64,
}

/// The start camera's view, and one at each waypoint drawn among candidates in proportion to their score.
fn wishes(planner: &Planner, first: &Pose, path: &Path, draft: &mut Draft, rng: &Rng) -> Vec<Wish> {
    let wish = |u: f64, pose: &Pose| {
        let ahead = -pose.world_from_camera.z_axis;
        Wish { u, heading_rad: ahead.y.atan2(ahead.x), pitch_rad: pitch_rad(ahead), roll_rad: pose.roll_rad() }
    };
    let mut wishes = vec![wish(0.0, first)];
    for (k, &u) in path.waypoints.iter().enumerate().filter(|(_, u)| **u > 0.0) {
        planner.progress(k, path.waypoints.len());
        let mut rng = rng.fork(k as u64 + 1);
        let candidates = candidates(planner, 0, path.spline.at(u), &mut rng);
        let views = planner.views(&candidates);
        wishes.extend(planner.choose(&candidates, &views, None, &mut draft.rejected, &mut rng).map(|i| wish(u, &candidates[i])));
    }
    wishes
}

/// Where the camera goes and where it looks.
struct Shot {
    path: Path,
    /// Heading, pitch and roll, radians, by the path's parameter.
    angles: NearSpline,
    look_distance_m: f64,
}

impl Shot {
    fn new(planner: &Planner, path: Path, wishes: &[Wish], video: &VideoConfig) -> Result<Self, ExploreError> {
        let n = path.spline.end() as usize + 1;
        let wanted: Vec<DVec3> = (0..n).map(|j| wanted_angles(wishes, j as f64)).collect();
        let look_distance_m = planner.config.min_look_distance_m * (1.0 + 1e-9);
        let positions: Vec<DVec3> = (0..n).map(|j| path.spline.at(j as f64)).collect();
        let mut headings = Headings::new(planner, &positions, wanted, look_distance_m);
        let turn_per_m = (video.max_turn_deg_s / video.max_speed_m_s).to_radians();
        let stride = (turn_per_m * path.spacing_m / (TAU / HEADINGS as f64)) as usize;
        let mut shot = Self { path, angles: NearSpline::new(vec![DVec3::ZERO]), look_distance_m };
        let mut blind = None;
        for _ in 0..REPAIRS {
            let Some(angles) = headings.smoothest(stride.clamp(1, HEADINGS / 4)) else { break };
            shot.angles = NearSpline::new(angles);
            let steps = (n - 1) * SUBSTEPS;
            let us: Vec<f64> =
                (0..=steps).into_par_iter().map(|k| k as f64 / SUBSTEPS as f64).filter(|u| !shot.sees(planner, *u)).collect();
            let Some(&worst) = us.first() else { return Ok(shot) };
            blind = Some(shot.path.spline.at(worst));
            for u in us {
                headings.forbid(u, shot.angles.at(u).x);
            }
        }
        let position = blind.unwrap_or_else(|| shot.path.spline.at(headings.narrowest() as f64));
        let problem = format!(
            "no view turns smoothly here with {} m of free space before it; lower min_look_distance_m",
            planner.config.min_look_distance_m
        );
        Err(no_way(planner, position, problem))
    }

    fn pose(&self, frame: u32, u: f64) -> Option<Pose> {
        let (position, angles) = (self.path.spline.at(u), self.angles.at(u));
        posed(frame, position, position + self.look_distance_m * direction(angles.x, angles.y), angles.z)
    }

    /// Whether the view at `u` keeps the rules.
    fn sees(&self, planner: &Planner, u: f64) -> bool {
        self.pose(0, u).is_some_and(|pose| {
            let target = pose.look_at;
            planner.rules.is_free(target) && planner.rules.sees(pose.position, target) && planner.rules.has_room_beside(&pose)
        })
    }

    /// Frames at even times, as early along the path as the bounds allow.
    fn film(&self, planner: &Planner, frames: usize, video: &VideoConfig) -> Result<Vec<Pose>, ExploreError> {
        let steps = self.path.spline.end() as usize * SUBSTEPS;
        let node = |k: usize| {
            let u = k as f64 / SUBSTEPS as f64;
            self.pose(0, u).ok_or_else(|| no_way(planner, self.path.spline.at(u), "the view is nearly vertical; set pitch_limits_deg"))
        };
        let nodes: Vec<Pose> = (0..=steps).map(node).collect::<Result<_, _>>()?;
        let schedule = Schedule::earliest(&nodes, video);
        let film = |frame: u32| {
            let u = schedule.at(f64::from(frame) / video.fps) / SUBSTEPS as f64;
            let pose = self.pose(frame, u).filter(|_| self.sees(planner, u));
            pose.ok_or_else(|| no_way(planner, self.path.spline.at(u), format!("frame {frame} has no free view")))
        };
        let poses: Vec<Pose> = (0..frames as u32).map(film).collect::<Result<_, _>>()?;
        check(planner, &poses, video)?;
        Ok(poses)
    }
}

/// The bounds, measured on the frames.
fn check(planner: &Planner, poses: &[Pose], video: &VideoConfig) -> Result<(), ExploreError> {
    for pair in poses.windows(2) {
        let (speed, turn) =
            (pair[0].position.distance(pair[1].position) * video.fps, turned_rad(&pair[0], &pair[1]).to_degrees() * video.fps);
        let (frame, position) = (pair[1].frame, pair[1].position);
        if speed > video.max_speed_m_s || turn > video.max_turn_deg_s {
            return Err(no_way(planner, position, format!("frame {frame} comes at {speed:.3} m/s and {turn:.2} degrees/s")));
        }
        if !planner.rules.is_clear_way(pair[0].position, position) {
            return Err(no_way(planner, position, format!("the way to frame {frame} is not clear")));
        }
    }
    Ok(())
}

/// Heading, pitch and roll asked for at `u`: between those of the wishes before and after, the heading the short way round.
fn wanted_angles(wishes: &[Wish], u: f64) -> DVec3 {
    let next = wishes.partition_point(|wish| wish.u <= u).min(wishes.len() - 1);
    let (a, b) = (&wishes[next.saturating_sub(1)], &wishes[next]);
    let t = if b.u > a.u { ((u - a.u) / (b.u - a.u)).clamp(0.0, 1.0) } else { 1.0 };
    let short_way = (b.heading_rad - a.heading_rad + PI).rem_euclid(TAU) - PI;
    DVec3::new(a.heading_rad + t * short_way, a.pitch_rad + t * (b.pitch_rad - a.pitch_rad), a.roll_rad + t * (b.roll_rad - a.roll_rad))
}
