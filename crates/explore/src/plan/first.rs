//! The first pose of a trajectory: the start camera's, fixed where it breaks a rule.

use super::rules::{Rules, pitch_rad};
use crate::ExploreError;
use crate::view::TestImage;
use enfilade_math::{DVec3, Ray, warp};
use enfilade_scene::{Cx, Pose, StartCamera, Warning};

/// A start camera may be moved this far, and where a height above the floor is asked for, as far up or down as that takes.
const MOVE_M: f64 = 1.0;

/// Pose 0 of the trajectory that begins at `start`.
///
/// The target lies on the optical axis, as far as free space reaches before the first surface. When there is no such point, the view
/// turns to the one nearest to the image centre that has a target, and when the image has none, to the longest level view.
pub(super) fn pose(rules: &Rules, start: &StartCamera, image: &TestImage, cx: &dyn Cx) -> Result<Pose, ExploreError> {
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
    let roll = axes.x_axis.z.atan2(axes.y_axis.z);
    if roll.abs() > limit + 1e-6 {
        warn(format!("rolls by {:.1} degrees; frame 0 is brought within {}", roll.to_degrees(), limit.to_degrees()));
    }
    let roll = roll.clamp(-limit, limit);

    let ahead = -axes.z_axis;
    let tilted = rules.tilted(ahead);
    if (tilted - ahead).length() > 1e-6 {
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
    let distance_m = rules.config.min_look_distance_m;
    Err(ExploreError::NothingToLookAt { name: start.name.clone(), position, distance_m })
}

/// The start's position, or the nearest one found that is allowed and not behind a surface; where a height above the floor is asked
/// for, each one tried is brought to it.
fn clear_position(rules: &Rules, start: &StartCamera) -> Result<DVec3, ExploreError> {
    const SHELLS: usize = 40;
    const DIRECTIONS: usize = 200;
    let home = start.position;
    if rules.is_position(home) {
        return Ok(home);
    }
    let at_height = |p: DVec3| {
        let Some([min, max]) = rules.config.camera_height_m else { return Some(p) };
        let floor = p.z - rules.height_m(p)?;
        Some(DVec3::new(p.x, p.y, p.z.clamp(floor + min, floor + max)))
    };
    let shell = |s: usize| (0..DIRECTIONS).map(move |k| home + warp::fibonacci_sphere(k, DIRECTIONS) * (MOVE_M * s as f64 / SHELLS as f64));
    let allowed = |p: &DVec3| rules.is_position(*p) && rules.sees(home, *p);
    let mut tried = std::iter::once(home).chain((1..=SHELLS).flat_map(shell)).filter_map(at_height);
    tried.find(allowed).ok_or_else(|| ExploreError::StartBlocked {
        name: start.name.clone(),
        position: home,
        radius_m: MOVE_M,
        clearance_m: rules.config.clearance_m,
        height_m: rules.config.camera_height_m,
    })
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
