//! The first pose of a trajectory: the start camera's, mended where it breaks a rule.

use super::rules::{MIN_SLANT, Rules, posed};
use crate::ExploreError;
use crate::view::TestImage;
use enfilade_math::{DVec3, Ray, warp};
use enfilade_scene::{Cx, Pose, StartCamera, Warning};

/// A start camera may be moved this far.
const MOVE_M: f64 = 1.0;

/// The first target keeps this many voxels away from the surface behind it; the original's number.
const TARGET_MARGIN_VOXELS: f64 = 1.75;

/// Pose 0 of the trajectory that begins at `start`.
///
/// The target lies on the optical axis, as far as free space reaches before the first surface. When there is no such point, the view
/// turns to the one nearest to the image centre that has a target, and when the image has none, to the longest level view.
pub(super) fn pose(rules: &Rules, start: &StartCamera, image: &TestImage, cx: &dyn Cx) -> Result<Pose, ExploreError> {
    let warn = |message: String| cx.warn(Warning { place: format!("camera {:?}", start.name), message });
    let position = clear_position(rules, start)?;
    if position != start.position {
        let (moved, clearance) = (position.distance(start.position), rules.config.clearance_m);
        warn(format!(
            "has less than {clearance} m to a surface or is not in free space; its trajectory begins {moved:.2} m away, at {position:.2}"
        ));
    }

    let axes = start.world_from_camera;
    let limit = rules.config.roll_limit_deg.to_radians();
    let roll = axes.x_axis.z.atan2(axes.y_axis.z);
    if roll.abs() > limit + 1e-6 {
        warn(format!("rolls by {:.1} degrees; frame 0 is brought within {}", roll.to_degrees(), rules.config.roll_limit_deg));
    }
    let roll = roll.clamp(-limit, limit);

    let toward = |direction: DVec3| {
        let pose = target(rules, position, direction).and_then(|look_at| posed(0, position, look_at, roll));
        pose.filter(|pose| rules.has_room_beside(pose))
    };
    if let Some(pose) = toward(-axes.z_axis) {
        return Ok(pose);
    }
    let turned = image.center_first().into_iter().find_map(|d| toward(axes * d)).or_else(|| toward(longest_view(rules, position)));
    if let Some(pose) = turned {
        let angle = (-pose.world_from_camera.z_axis).angle_between(-axes.z_axis).to_degrees();
        let beside = if rules.config.stereo_baseline_m > 0.0 { ", or no room for the second camera" } else { "" };
        warn(format!("has no free space along its view{beside}, or looks straight up or down; its view is turned by {angle:.0} degrees"));
        return Ok(pose);
    }
    let distance_m = rules.config.min_look_distance_m;
    Err(ExploreError::NothingToLookAt { name: start.name.clone(), position, distance_m })
}

/// The start's position, or the nearest one found that is allowed and not behind a surface.
fn clear_position(rules: &Rules, start: &StartCamera) -> Result<DVec3, ExploreError> {
    const SHELLS: usize = 40;
    const DIRECTIONS: usize = 200;
    let home = start.position;
    if rules.is_position(home) {
        return Ok(home);
    }
    let shell = |s: usize| (0..DIRECTIONS).map(move |k| home + warp::fibonacci_sphere(k, DIRECTIONS) * (MOVE_M * s as f64 / SHELLS as f64));
    (1..=SHELLS).flat_map(shell).find(|p| rules.is_position(*p) && rules.sees(home, *p)).ok_or_else(|| ExploreError::StartBlocked {
        name: start.name.clone(),
        position: home,
        radius_m: MOVE_M,
        clearance_m: rules.config.clearance_m,
    })
}

/// The farthest point along a direction that is in free space and well before the first surface.
fn target(rules: &Rules, position: DVec3, direction: DVec3) -> Option<DVec3> {
    if direction.truncate().length() < MIN_SLANT {
        return None;
    }
    let voxel_m = rules.space.tree.resolution_m();
    let reach = rules.distance_m(position, direction).min(exit_m(rules, position, direction)) - TARGET_MARGIN_VOXELS * voxel_m;
    let mut distance = reach;
    while distance >= rules.config.min_look_distance_m {
        let p = position + distance * direction;
        if rules.is_free(p) && rules.sees(position, p) {
            return Some(p);
        }
        distance -= 0.25 * voxel_m;
    }
    None
}

/// Where a ray from inside leaves the box of free space.
fn exit_m(rules: &Rules, position: DVec3, direction: DVec3) -> f64 {
    let border = DVec3::select(direction.cmpgt(DVec3::ZERO), rules.space.free_max, rules.space.free_min);
    let t = (border - position) / direction;
    (0..3).filter(|a| direction[*a] != 0.0).map(|a| t[a]).fold(f64::INFINITY, f64::min)
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
