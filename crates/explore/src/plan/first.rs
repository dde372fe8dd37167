//! The first pose of a trajectory: the start camera's, moved or turned only where it cannot be.

use super::Mode;
use super::rules::{Rules, pitch_rad};
use crate::ExploreError;
use crate::view::TestImage;
use enfilade_math::{DVec3, Ray, warp};
use enfilade_scene::{Cx, Pose, StartCamera, Warning};

/// A start camera may be moved this far, and where a height above the floor is asked for, as far up or down as that takes.
const MOVE_M: f64 = 1.0;

/// A start camera in a voxel that a surface touches is in free space if it sees a free voxel this near, in voxels: carving moves it no
/// farther.
const OUT_OF_VOXEL: f64 = 8.0;

/// The nearest target of a start camera, in voxels.
const NEAREST_TARGET_VOXELS: f64 = 0.25;

/// Directions and rolls that differ by less, as a share and in radians, are the same.
const SAME_DIRECTION: f64 = 1e-6;

/// Pose 0 of the trajectory that begins at `start`: its own, if that may be, and else the nearest one that may.
pub(super) fn pose(rules: &Rules, start: &StartCamera, image: &TestImage, cx: &dyn Cx) -> Result<Pose, ExploreError> {
    if may_be_kept(rules, start) { kept(rules, start, image, cx) } else { mended(rules, start, image, cx) }
}

/// Whether frame 0 is the start camera's pose: it is in free space, and satisfies the configured height, pitch and roll. A video needs room
/// to move, so it begins where there is some.
fn may_be_kept(rules: &Rules, start: &StartCamera) -> bool {
    let (position, axes) = (start.position, start.world_from_camera);
    let sees_free = |p: &DVec3| rules.is_free(*p) && rules.sees(position, *p);
    let is_free =
        || rules.is_free(position) || (rules.is_occupied(position) && around(position, out_of_voxel_m(rules)).any(|p| sees_free(&p)));
    let ahead = -axes.z_axis;
    let is_tilted =
        (rules.tilted(ahead) - ahead).length() > SAME_DIRECTION || (rules.config.level && roll_rad(start).abs() > SAME_DIRECTION);
    !matches!(rules.config.mode, Mode::Video(_)) && !is_tilted && rules.is_at_height(position) && is_free()
}

/// The start camera's pose. Its target is on the optical axis, as far as free space reaches before the first surface. When there is no such
/// point, the one nearest to the image centre is used, from which the targets of a walk continue.
fn kept(rules: &Rules, start: &StartCamera, image: &TestImage, cx: &dyn Cx) -> Result<Pose, ExploreError> {
    let (position, axes) = (start.position, start.world_from_camera);
    let pose = |look_at| Pose { frame: 0, position, look_at, world_from_camera: axes };
    let nearest_m = NEAREST_TARGET_VOXELS * rules.space.tree.resolution_m();
    if let Some(look_at) = rules.farthest(position, -axes.z_axis, nearest_m) {
        return Ok(pose(look_at));
    }
    let beside = || image.center_first().into_iter().find_map(|d| rules.target(position, axes * d));
    let look_at = beside().or_else(|| rules.target(position, longest_view(rules, position)));
    let look_at = look_at.ok_or_else(|| nothing_to_look_at(rules, start, position))?;
    let angle = (look_at - position).angle_between(-axes.z_axis).to_degrees();
    let message = format!("has no free space along its view; its look-at point is {angle:.0} degrees beside it");
    cx.warn(Warning { place: format!("camera {:?}", start.name), message });
    Ok(pose(look_at))
}

fn roll_rad(start: &StartCamera) -> f64 {
    start.world_from_camera.x_axis.z.atan2(start.world_from_camera.y_axis.z)
}

fn out_of_voxel_m(rules: &Rules) -> f64 {
    OUT_OF_VOXEL * rules.space.tree.resolution_m()
}

fn nothing_to_look_at(rules: &Rules, start: &StartCamera, position: DVec3) -> ExploreError {
    ExploreError::NothingToLookAt { name: start.name.clone(), position, distance_m: rules.config.min_look_distance_m }
}

/// The pose near a start camera that keeps the rules, with a warning of what was changed.
///
/// The target is on the optical axis, as far as free space reaches before the first surface. When there is no such point, the view turns to
/// the one nearest to the image centre that has a target, and when the image has none, to the longest level view.
fn mended(rules: &Rules, start: &StartCamera, image: &TestImage, cx: &dyn Cx) -> Result<Pose, ExploreError> {
    let warn = |message: String| cx.warn(Warning { place: format!("camera {:?}", start.name), message });
    let position = clear_position(rules, start)?;
    if position != start.position {
        let (moved, clearance) = (position.distance(start.position), rules.config.clearance_m);
        let height = if rules.config.camera_height_m.is_some() { ", or not at the height asked for" } else { "" };
        warn(format!(
            "has less than {clearance} m to a surface or is not in free space{height}; its trajectory begins {moved:.2} m away, at \
             {position:.2}"
        ));
    }

    let axes = start.world_from_camera;
    let limit = rules.roll_limit_rad();
    let roll = roll_rad(start);
    if roll.abs() > limit + SAME_DIRECTION {
        warn(format!("rolls by {:.1} degrees; frame 0 is brought within {}", roll.to_degrees(), limit.to_degrees()));
    }
    let roll = roll.clamp(-limit, limit);

    let ahead = -axes.z_axis;
    let tilted = rules.tilted(ahead);
    if (tilted - ahead).length() > SAME_DIRECTION {
        let [found, low, high] = [pitch_rad(ahead), rules.pitch_limits_rad()[0], rules.pitch_limits_rad()[1]].map(f64::to_degrees);
        warn(format!("looks {found:.1} degrees above the horizon; frame 0 is brought within {low} and {high}"));
    }
    let toward = |direction: DVec3| rules.toward(0, position, rules.tilted(direction), roll);
    if let Some(pose) = toward(ahead) {
        return Ok(pose);
    }
    let turned = image.center_first().into_iter().find_map(|d| toward(axes * d)).or_else(|| toward(longest_view(rules, position)));
    if let Some(pose) = turned {
        let angle = (-pose.world_from_camera.z_axis).angle_between(ahead).to_degrees();
        let beside = if rules.config.stereo_baseline_m > 0.0 { ", or no room for the second camera" } else { "" };
        warn(format!("has no free space along its view{beside}, or looks straight up or down; its view is turned by {angle:.0} degrees"));
        return Ok(pose);
    }
    Err(nothing_to_look_at(rules, start, position))
}

/// The start's position, or the nearest one found that is allowed and not behind a surface; where a height above the floor is asked
/// for, each one tried is brought to it.
fn clear_position(rules: &Rules, start: &StartCamera) -> Result<DVec3, ExploreError> {
    let home = start.position;
    if rules.is_position(home) {
        return Ok(home);
    }
    let at_height = |p: DVec3| {
        let Some([min, max]) = rules.config.camera_height_m else { return Some(p) };
        let floor = p.z - rules.height_m(p)?;
        Some(DVec3::new(p.x, p.y, p.z.clamp(floor + min, floor + max)))
    };
    let allowed = |p: &DVec3| rules.is_position(*p) && rules.sees(home, *p);
    let mut tried = std::iter::once(home).chain(around(home, MOVE_M)).filter_map(at_height);
    tried.find(allowed).ok_or_else(|| ExploreError::StartBlocked {
        name: start.name.clone(),
        position: home,
        radius_m: MOVE_M,
        clearance_m: rules.config.clearance_m,
        height_m: rules.config.camera_height_m,
    })
}

/// Points on shells around another, the nearest first.
fn around(p: DVec3, radius_m: f64) -> impl Iterator<Item = DVec3> {
    const SHELLS: usize = 40;
    const DIRECTIONS: usize = 200;
    let shell =
        move |s: usize| (0..DIRECTIONS).map(move |k| p + warp::fibonacci_sphere(k, DIRECTIONS) * (radius_m * s as f64 / SHELLS as f64));
    (1..=SHELLS).flat_map(shell)
}

/// The level direction with the longest way to a surface.
fn longest_view(rules: &Rules, position: DVec3) -> DVec3 {
    const DIRECTIONS: usize = 72;
    let directions = (0..DIRECTIONS).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        DVec3::new(cos, sin, 0.0)
    });
    let length = |d: &DVec3| rules.bvh.closest(&Ray::new(position.as_vec3(), d.as_vec3())).map_or(0.0, |hit| hit.t);
    directions.fold((DVec3::X, -1.0f32), |best, d| if length(&d) > best.1 { (d, length(&d)) } else { best }).0
}
