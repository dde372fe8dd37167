//! Trajectories of preset `hypersim` against those that Hypersim's own program made. Skipped where its results are not available.

#[allow(dead_code, reason = "each test uses a part of it")]
#[path = "../../bench/src/explore/room.rs"]
mod room;

use enfilade_explore::{PlanConfig, Preset, plan, view_stats};
use enfilade_geometry::Bvh;
use enfilade_scene::{Intrinsics, Pose, Quiet};
use room::{ROOMS, Room, folder};

fn rooms() -> Vec<Room> {
    let Some(folder) = folder() else {
        println!("skipped: no results of Hypersim's programs; ENFILADE_GOLDEN or ENFILADE_SCENES says where they are");
        return Vec::new();
    };
    ROOMS.into_iter().map(|name| Room::read(&folder, name)).collect()
}

#[test]
fn stored_poses_get_the_scores_of_the_program() {
    for room in rooms() {
        let bvh = Bvh::new(&room.world.corners, &|_| false);
        let intrinsics = Intrinsics::from_fov_x(256, 192, std::f64::consts::FRAC_PI_3);
        let (mut views, mut off) = (0, 0);
        for walk in &room.walks {
            for (i, position) in walk.positions.iter().enumerate() {
                let pose = Pose { frame: 0, position: *position, look_at: *position, world_from_camera: walk.orientations[i] };
                let stats = view_stats(&room.world, &bvh, &intrinsics, &pose);
                let triangles = f64::from(stats.triangles + u32::from(stats.hits < stats.pixels));
                assert!((1.0 - stats.void_share() - walk.valid_share[i]).abs() < 1e-4, "{} frame {i}", room.name);
                // A ray along an edge meets one triangle or the other.
                assert!((triangles - walk.triangles[i]).abs() <= 3.0, "{} frame {i}: {triangles}, {}", room.name, walk.triangles[i]);
                views += 1;
                off += usize::from(triangles != walk.triangles[i]);
            }
        }
        assert!(off * 5 < views, "{off} of {views} views differ");
    }
}

#[test]
fn the_walk_goes_where_the_programs_walk_went() {
    for room in rooms() {
        let bvh = Bvh::new(&room.world.corners, &|_| false);
        let space = room.free_space();
        let config = PlanConfig { preset: Preset::Hypersim, ..PlanConfig::default() };
        for (index, (start, walk)) in room.starts.iter().zip(&room.walks).enumerate() {
            let trajectory = plan(&room.world, &bvh, &space, start, index as u32, &config, &Quiet).unwrap().trajectory;
            assert_eq!(trajectory.poses.len(), walk.positions.len());
            let same = |i: &usize| {
                let turned = (trajectory.poses[*i].world_from_camera - walk.orientations[*i]).to_cols_array();
                trajectory.poses[*i].position.distance(walk.positions[*i]) < 1e-9 && turned.iter().all(|v| v.abs() < 1e-5)
            };
            let reached = (0..walk.positions.len()).take_while(same).count();
            assert_eq!(reached, walk.positions.len(), "{} {}: the walks part at frame {reached}", room.name, start.name);
        }
    }
}
