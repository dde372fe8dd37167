//! Rules that every trajectory keeps, on analytic rooms.

mod gates;
mod keyframes;
mod modes;
mod objects;
mod photos;
mod supplement;
mod walk;

use super::*;
use crate::testroom::{Room, furnished_room};
use crate::{CarveConfig, Saliency, carve};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Heard, Intrinsics, Quiet, Trajectory};

fn camera(position: DVec3, look_at: DVec3, up: DVec3) -> StartCamera {
    let pose = Pose::look_at(0, position, look_at, up).unwrap();
    StartCamera { name: "start".into(), position, world_from_camera: pose.world_from_camera, fov_x_rad: 1.0, aspect: 4.0 / 3.0 }
}

/// The trajectory alone.
fn trajectory(
    room: &Room,
    space: &FreeSpace,
    start: &StartCamera,
    index: u32,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Trajectory, ExploreError> {
    plan(&room.world, &room.bvh, space, start, index, config, cx).map(|planned| planned.trajectory)
}

fn start() -> StartCamera {
    camera(DVec3::new(3.0, 2.5, 1.5), DVec3::new(3.0, 4.0, 1.2), DVec3::Z)
}

fn carved(room: &Room) -> FreeSpace {
    let config = CarveConfig { rays: 40_000, ..CarveConfig::default() };
    carve(&room.world, &room.bvh, &[start().position], &config, &Quiet).unwrap()
}

fn carved_with_outside(room: &Room) -> FreeSpace {
    let config = CarveConfig { rays: 40_000, keep_outside: true, ..CarveConfig::default() };
    carve(&room.world, &room.bvh, &[start().position], &config, &Quiet).unwrap()
}

fn quick() -> PlanConfig {
    PlanConfig { frames: 30, queries: 300, test_width: 48, test_height: 36, ..PlanConfig::default() }
}

/// A planner for tests of parts of modes.
fn with_planner<T>(room: &Room, space: &FreeSpace, config: &PlanConfig, test: impl FnOnce(&Planner) -> T) -> T {
    let rules = Rules::new(&room.bvh, space, config);
    let glancer = Glancer::new(&rules, &room.world);
    let gates = Gates::new(&glancer, config, &room.world, &start(), &Quiet);
    test(&Planner::new(&rules, &gates, &room.world, "cam_00", &Quiet))
}

/// Every mode that finds poses, small.
fn modes() -> [Mode; 5] {
    let coverage = CoverageConfig { poses: 150, samples: 1000, views: 2, ..CoverageConfig::default() };
    [
        Mode::default(),
        Mode::Video(VideoConfig::default()),
        Mode::Stills(StillsConfig { min_distance_m: 0.5, ..StillsConfig::default() }),
        Mode::Photos(PhotosConfig { min_distance_m: 0.2, ..PhotosConfig::default() }),
        Mode::Coverage(coverage),
    ]
}

/// The rules of a single pose, checked by brute force.
fn assert_keeps_rules(room: &Room, space: &FreeSpace, config: &PlanConfig, pose: &Pose) {
    let (r, frame) = (pose.world_from_camera, pose.frame);
    let error = (r * r.transpose() - DMat3::IDENTITY).to_cols_array().iter().fold(0.0f64, |m, v| m.max(v.abs()));
    assert!(error < 1e-12 && (r.determinant() - 1.0).abs() < 1e-12, "frame {frame}: axes");
    assert!((-r.z_axis - (pose.look_at - pose.position).normalize()).length() < 1e-12, "frame {frame}: look-at off the axis");
    assert!(pose.roll_rad().abs() <= config.roll_limit_deg.to_radians() + 1e-9, "frame {frame}: roll {}", pose.roll_rad());
    assert!(pose.position.distance(pose.look_at) >= config.min_look_distance_m * (1.0 - 1e-9), "frame {frame}: target too near");
    let clearance = room.distance_m(pose.position);
    assert!(clearance >= config.clearance_m, "frame {frame}: {clearance} m to a surface");
    for p in [pose.position, pose.look_at] {
        assert_eq!(space.tree.state(p), enfilade_geometry::Voxel::Free, "frame {frame}");
    }
    assert!(seen(room, pose.position, pose.look_at), "frame {frame}: target hidden");
}

/// Nothing between two points.
fn seen(room: &Room, a: DVec3, b: DVec3) -> bool {
    let mut ray = enfilade_math::Ray::new(a.as_vec3(), (b - a).normalize().as_vec3());
    ray.t_max = a.distance(b) as f32;
    !room.bvh.occluded(&ray)
}

#[test]
fn distances_are_those_of_brute_force() {
    let room = furnished_room();
    let surfaces = enfilade_geometry::Surfaces::new(&room.world.corners);
    let mut rng = Rng::new(3);
    for _ in 0..300 {
        let p = DVec3::new(7.0 * rng.next_f64() - 0.5, 6.0 * rng.next_f64() - 0.5, 3.0 * rng.next_f64() - 0.2);
        let (found, expected) = (surfaces.distance_m(p).unwrap(), room.distance_m(p));
        assert!((found - expected).abs() < 1e-9, "{p}: {found}, {expected} by brute force");
    }
    assert_eq!(enfilade_geometry::Surfaces::new(&[]).distance_m(DVec3::ZERO), None);
}
