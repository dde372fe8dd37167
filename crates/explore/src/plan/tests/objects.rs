//! Claims about views of objects.

use super::targets::{TargetObject, Targets};
use super::*;
use crate::testroom::cuboid;
use enfilade_geometry::VisibilityBuffer;

/// A room with a table and four cubes of 20 cm: `near` and `beside` it on the table, `far` on a shelf behind a wall that leaves a passage, and
/// `hidden` in a closed chest.
fn room() -> Room {
    let dividing = cuboid(DVec3::new(4.0, -0.03, -0.03), DVec3::new(4.1, 3.9, 2.63), false);
    let cube = |x: f64, y: f64, z: f64| cuboid(DVec3::new(x, y, z), DVec3::new(x + 0.2, y + 0.2, z + 0.2), false);
    Room::from_parts(vec![
        cuboid(DVec3::splat(-0.03), DVec3::new(5.93, 4.93, 2.63), true),
        cuboid(DVec3::new(0.8, 2.0, 0.0), DVec3::new(2.0, 2.8, 0.7), false),
        cube(1.2, 2.2, 0.7),
        cube(1.5, 2.4, 0.7),
        cuboid(DVec3::new(5.2, 1.5, 0.0), DVec3::new(5.93, 2.5, 0.7), false),
        cube(5.4, 1.9, 0.7),
        cuboid(DVec3::new(3.0, 4.0, 0.0), DVec3::new(3.6, 4.6, 0.6), false),
        cube(3.2, 4.2, 0.2),
        dividing,
    ])
}

fn target(name: &str, part: u32, visible_share: f64) -> TargetObject {
    TargetObject { name: name.into(), parts: vec![part], visible_share }
}

fn config(frames: u32) -> PlanConfig {
    PlanConfig { frames, mode: Mode::Objects(ObjectsConfig::default()), test_width: 96, test_height: 72, ..quick() }
}

fn planned(objects: &[TargetObject], config: &PlanConfig, cx: &dyn Cx) -> Result<Planned, ExploreError> {
    let room = room();
    // Both sides of the wall are carved.
    let starts = [start().position, DVec3::new(5.0, 3.2, 1.5)];
    let space = carve(&room.world, &room.bvh, &starts, &CarveConfig { rays: 40_000, ..CarveConfig::default() }, &Quiet).unwrap();
    plan_objects(&room.world, &room.bvh, &space, &start(), "cam_00", 0, config, objects, &|_| true, cx)
}

#[test]
fn cameras_are_above_their_objects_and_keep_the_rules() {
    let (room, config) = (room(), config(25));
    let space = carved(&room);
    let heard = Heard::default();
    let planned = planned(&[target("near", 2, 0.5), target("beside", 3, 0.5)], &config, &heard).unwrap();
    assert_eq!((planned.trajectory.poses.len(), heard.lines().len()), (25, 0), "{:?}", heard.lines());
    let rules = PlanConfig { min_look_distance_m: 0.25, ..config };
    let middle = DVec3::new(1.45, 2.4, 0.8);
    let mut quarters = [0; 4];
    for pose in &planned.trajectory.poses {
        assert_keeps_rules(&room, &space, &rules, pose);
        let way = pose.position - middle;
        // The point looked at is up to 9 cm from the middle of a cube, and the cubes are 18 cm from their middle.
        assert!((0.5 - 0.27..=1.5 + 0.27).contains(&way.length()), "{way}");
        assert!(way.z > 0.0 && way.normalize().dot(pose.world_from_camera.z_axis) > 0.8, "{way}");
        quarters[usize::from(way.x > 0.0) + 2 * usize::from(way.y > 0.0)] += 1;
    }
    assert!(quarters.iter().all(|n| *n >= 2), "all around: {quarters:?}");
    let shown: Vec<f64> = planned.report.objects.iter().map(|one| one.visible_share).collect();
    assert!(shown.iter().all(|share| *share >= 0.5), "{shown:?}");
    assert!(planned.report.relaxed.is_empty() && planned.report.mode == "objects");
}

#[test]
fn objects_that_no_frame_shows_together_have_their_shares() {
    let objects = [target("near", 2, 0.7), target("far", 5, 0.3)];
    let found = planned(&objects, &config(30), &Quiet).unwrap().report.objects;
    for (one, object) in found.iter().zip(&objects) {
        assert_eq!((&one.name, one.wanted_share), (&object.name, object.visible_share));
        assert!((one.visible_share - one.wanted_share).abs() <= 0.1, "{found:?}");
    }
}

#[test]
fn what_cannot_be_seen_is_named() {
    let heard = Heard::default();
    let found = planned(&[target("near", 2, 0.5), target("hidden", 7, 0.2)], &config(8), &heard).unwrap().report.objects;
    assert!(found[0].visible_share >= 0.5 && found[1].visible_share == 0.0, "{found:?}");
    let line = heard.lines().into_iter().find(|line| line.contains("fewer frames")).unwrap();
    assert!(line.contains("1 of 2 objects") && line.contains("\"hidden\" in 0 % instead of 20 %") && !line.contains("\"near\""), "{line}");
}

#[test]
fn a_tenth_of_an_object_makes_it_visible_and_what_is_beyond_the_border_counts_as_hidden() {
    let cube = || cuboid(DVec3::new(-0.5, 2.0, -0.5), DVec3::new(0.5, 3.0, 0.5), false);
    let plate = |right: f64| cuboid(DVec3::new(-2.0, 1.0, -2.0), DVec3::new(right, 1.01, 2.0), false);
    // Seen from the origin, the cube's front is from −0.25 to 0.25 at a distance of 1.
    let space = carved(&furnished_room());
    let shows = |right: f64, toward: DVec3| {
        let room = Room::from_parts(vec![plate(right), cube()]);
        let config = PlanConfig { fov_x_rad: 1.0, ..config(1) };
        with_planner(&room, &space, &config, |planner| {
            let targets = Targets::new(&room.world, &[target("cube", 1, 0.0)]).unwrap();
            let pose = Pose::look_at(0, DVec3::ZERO, toward, DVec3::Z).unwrap();
            let mut sight = planner.image.sight(&room.world);
            sight.look(&room.bvh, &planner.image, &pose);
            let mut alone = VisibilityBuffer::new(config.test_width, config.test_height);
            targets.shown(planner, &pose, &sight.buffer, &mut alone)[0]
        })
    };
    assert!(shows(-1.0, DVec3::Y), "nothing is before it");
    assert!(shows(0.17, DVec3::Y), "16 % of it are beside the plate");
    assert!(!shows(0.22, DVec3::Y), "6 % of it are beside the plate");
    assert!(!shows(0.17, DVec3::new(-0.58, 1.0, 0.0)), "most of what is beside the plate is beyond the border");
    assert!(!shows(1.0, DVec3::Y));
}

#[test]
fn plans_are_the_same_on_any_number_of_threads() {
    let plan_on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| planned(&[target("near", 2, 0.5), target("far", 5, 0.5)], &config(5), &Quiet)).unwrap()
    };
    assert_eq!(plan_on(1), plan_on(3));
}

#[test]
fn what_cannot_be_planned_says_what_to_do() {
    let refused = |objects: &[TargetObject], mode: ObjectsConfig| {
        planned(objects, &PlanConfig { mode: Mode::Objects(mode), ..config(2) }, &Quiet).unwrap_err().to_string()
    };
    assert!(refused(&[], ObjectsConfig::default()).contains("look_at = [\"sofa\"]"));
    assert!(refused(&[target("ghost", 99, 0.5)], ObjectsConfig::default()).contains("\"ghost\" has no triangles"));
    // No camera is in the room.
    let far = ObjectsConfig { radius_m: [9.0, 10.0], ..ObjectsConfig::default() };
    assert!(refused(&[target("near", 2, 0.5)], far).contains("9 to 10 m from them none is in free space"));
    for (mode, field) in [
        (ObjectsConfig { radius_m: [0.0, 1.0], ..ObjectsConfig::default() }, "radius_m"),
        (ObjectsConfig { elevation_deg: [10.0, 90.0], ..ObjectsConfig::default() }, "elevation_deg"),
        (ObjectsConfig { visible_share: 50.0, ..ObjectsConfig::default() }, "visible_share"),
    ] {
        assert!(refused(&[target("near", 2, 0.5)], mode).starts_with(field));
    }
}
