//! Video: a smooth path at bounded speed.
//!
//! The position follows a spline near a [`tour`], refined wherever a point of it has no room around it. The view turns between
//! directions worth seeing, by headings that always have free space before them. The pose is then a smooth function of one
//! parameter, and what remains is when to be where: as early as the bounds on speed, turning and acceleration allow. Slowing down
//! changes no pose, so the bounds are kept by construction; they are measured on the result all the same.

use super::VideoConfig;
use super::headings::{HEADINGS, Headings, direction};
use super::planner::{Draft, Planner};
use super::rules::{pitch_rad, posed, turned_rad};
use super::spline::NearSpline;
use super::stills::candidates;
use super::timing::Schedule;
use super::tour::{Polyline, Tour, no_way, tour};
use crate::ExploreError;
use enfilade_math::{DVec3, Rng};
use enfilade_parallel::flat_map_up_to;
use enfilade_scene::Pose;
use std::f64::consts::{PI, TAU};

/// Control points are this far apart along the tour where there is room, metres, and no closer than the second where there is little.
const WIDEST_SPACING_M: f64 = 0.4;
const CLOSEST_SPACING_M: f64 = 0.02;

/// Poses looked at between two control points.
const SUBSTEPS: usize = 16;

/// Most repeated choices of headings, each without those that turned out to have no free view.
const REPAIRS: usize = 40;

/// A smooth path of `frames` frames from near `first` on.
pub(super) fn video(planner: &Planner, first: Pose, video: &VideoConfig, rng: &Rng) -> Result<Draft, ExploreError> {
    // A tour long enough for the camera at its highest speed.
    let frames = planner.config.frames as usize;
    let duration_s = (frames.max(2) - 1) as f64 / video.fps;
    let tour = tour(planner, first.position, video.max_speed_m_s * duration_s, video, &mut rng.fork(0))?;
    let moved = tour.corners[0].distance(first.position);
    if moved > planner.rules.space.tree.resolution_m() {
        planner.warn(format!("begins {moved:.2} m away from its start, where there is room to move"));
    }

    // A smooth path along it, views worth seeing on the way, headings that lead through them, and the frames.
    let mut draft = Draft::default();
    let path = Path::along(planner, &tour)?;
    let wishes = wishes(planner, &first, &path, &mut draft, rng);
    let shot = Shot::new(planner, path, &wishes, video)?;
    draft.poses = shot.film(planner, frames, video)?;
    planner.progress(frames, frames);
    Ok(draft)
}

/// The path of the camera.
struct Path {
    spline: NearSpline,
    /// Distance along the tour of each control point, metres.
    reached_m: Vec<f64>,
    /// Parameters of the spline near the waypoints, ascending.
    waypoints: Vec<f64>,
}

impl Path {
    /// A smooth spline along the tour that has room everywhere: its control points are as close as they must be, and no closer.
    fn along(planner: &Planner, tour: &Tour) -> Result<Self, ExploreError> {
        let polyline = Polyline::new(&tour.corners);
        let n = (polyline.length_m() / WIDEST_SPACING_M).ceil().max(1.0);
        let mut reached_m: Vec<f64> = (0..=n as usize).map(|j| polyline.length_m() * j as f64 / n).collect();
        loop {
            let spline = NearSpline::new(reached_m.iter().map(|m| polyline.at(*m)).collect());
            let blocked = blocked(planner, &spline);
            let Some(&first) = blocked.first() else {
                let parameter = |corner: &usize| {
                    let m = polyline.reached_m[*corner];
                    let j = reached_m.partition_point(|r| *r <= m).clamp(1, reached_m.len() - 1) - 1;
                    (j as f64 + (m - reached_m[j]) / (reached_m[j + 1] - reached_m[j])).min(spline.end())
                };
                let waypoints = tour.waypoints.iter().map(parameter).collect();
                return Ok(Self { spline, reached_m, waypoints });
            };
            let before = reached_m.len();
            reached_m = refined(&reached_m, &blocked);
            if reached_m.len() == before {
                let problem = "no smooth path passes here; lower clearance_m or widen camera_height_m";
                return Err(no_way(planner, spline.at(first as f64), problem));
            }
        }
    }
}

/// The stretches of a spline, each from one control point to the next, that do not have room everywhere.
fn blocked(planner: &Planner, spline: &NearSpline) -> Vec<usize> {
    let at = |k: usize| spline.at((k as f64 / SUBSTEPS as f64).min(spline.end()));
    let is_blocked = |k: usize| !planner.rules.is_clear_way(at(k), at(k + 1)) || !planner.rules.is_at_height(at(k));
    let has_blocked = |stretch: usize| (stretch * SUBSTEPS..(stretch + 1) * SUBSTEPS).any(is_blocked);
    flat_map_up_to(spline.end() as usize, |stretch| has_blocked(stretch).then_some(stretch))
}

/// Control points with another one halfway wherever that changes a blocked stretch, unless they are close already.
fn refined(reached_m: &[f64], blocked: &[usize]) -> Vec<f64> {
    let last = reached_m.len() - 2;
    let mut split = vec![false; last + 1];
    for &stretch in blocked {
        split[stretch.saturating_sub(1)..=(stretch + 1).min(last)].fill(true);
    }
    let mut finer = vec![reached_m[0]];
    for (gap, split) in reached_m.windows(2).zip(split) {
        if split && gap[1] - gap[0] > CLOSEST_SPACING_M {
            finer.push(0.5 * (gap[0] + gap[1]));
        }
        finer.push(gap[1]);
    }
    finer
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

/// The path of the camera and its headings.
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
        let stride = |gap: &[f64]| ((turn_per_m * (gap[1] - gap[0]) / (TAU / HEADINGS as f64)) as usize).clamp(1, HEADINGS / 4);
        let strides: Vec<usize> = path.reached_m.windows(2).map(stride).collect();
        let mut shot = Self { path, angles: NearSpline::new(vec![DVec3::ZERO]), look_distance_m };
        let mut blind = None;
        for _ in 0..REPAIRS {
            let Some(angles) = headings.smoothest(&strides) else { break };
            shot.angles = NearSpline::new(angles);
            let steps = (n - 1) * SUBSTEPS;
            let us: Vec<f64> = flat_map_up_to(steps + 1, |k| Some(k as f64 / SUBSTEPS as f64).filter(|u| !shot.sees(planner, *u)));
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
