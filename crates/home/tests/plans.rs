//! Homes on plans that people draw: whatever their shape, they are homes.

use enfilade_furniture::assets::Library;
use enfilade_geometry::Bvh;
use enfilade_home::check::{Fault, faults};
use enfilade_home::room::Room;
use enfilade_home::{Home, HomeConfig, RoomShape, home, home_on};
use enfilade_math::{DVec2, Ray, Vec2, warp};
use enfilade_scene::{CeilingSlope, DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind, Part, Slope, WorldMesh, to_bytes};

/// Seeds of each plan, and with `cargo xtask test --all`.
const SEEDS: [u64; 2] = [2, 20];

fn plan(rooms: &[(&str, &[[f64; 2]])], openings: &[(OpeningKind, [f64; 2])]) -> DrawnPlan {
    let room = |(kind, polygon): &(&str, &[[f64; 2]])| DrawnRoom {
        name: (*kind).into(),
        kind: (*kind).into(),
        polygon: polygon.iter().map(|&p| DVec2::from(p)).collect(),
        height_m: None,
    };
    let openings = openings.iter().map(|&(kind, at)| DrawnOpening::new(kind, at.into())).collect();
    DrawnPlan { rooms: rooms.iter().map(room).collect(), openings, strict: true, ..DrawnPlan::default() }
}

/// A living room around the corner of a hall, and a bathroom.
fn l_shape() -> DrawnPlan {
    use OpeningKind::{Door, Window};
    plan(
        &[
            ("living", &[[0.0, 0.0], [6.4, 0.0], [6.4, 3.4], [3.7, 3.4], [3.7, 6.0], [0.0, 6.0]]),
            ("hall", &[[3.8, 3.5], [5.6, 3.5], [5.6, 6.0], [3.8, 6.0]]),
            ("bathroom", &[[5.7, 3.5], [8.2, 3.5], [8.2, 6.0], [5.7, 6.0]]),
        ],
        &[(Door, [4.7, 3.45]), (Door, [5.65, 4.6]), (Door, [4.7, 6.1]), (Window, [2.0, 0.0]), (Window, [0.0, 4.0]), (Window, [7.0, 6.0])],
    )
}

/// A bedroom with a bay of slanted walls, and a study.
fn bay() -> DrawnPlan {
    use OpeningKind::{Door, Window};
    plan(
        &[
            ("bedroom", &[[0.0, 0.0], [1.0, 0.0], [1.7, -0.9], [3.3, -0.9], [4.0, 0.0], [5.0, 0.0], [5.0, 3.6], [0.0, 3.6]]),
            ("study", &[[5.12, 0.0], [8.2, 0.0], [8.2, 3.6], [5.12, 3.6]]),
        ],
        &[(Door, [5.06, 3.0]), (Door, [6.5, 3.7]), (Window, [2.5, -0.9]), (Window, [6.6, 0.0])],
    )
}

/// A kitchen and a children's room in trapezoids under a turned roof.
fn trapezoid() -> DrawnPlan {
    use OpeningKind::Window;
    plan(
        &[("kitchen", &[[0.0, 0.0], [4.4, 0.6], [3.6, 4.0], [0.0, 3.4]]), ("childrens", &[[4.4, 0.6], [8.4, 1.3], [7.4, 4.9], [3.6, 4.0]])],
        &[(Window, [2.0, 0.3]), (Window, [6.4, 0.95])],
    )
}

/// A bedroom and a bathroom under two slopes that meet in a ridge, and a hall under one of them.
fn attic() -> DrawnPlan {
    use OpeningKind::{Door, Window};
    let mut attic = plan(
        &[
            ("bedroom", &[[0.0, 0.0], [4.2, 0.0], [4.2, 5.0], [0.0, 5.0]]),
            ("bathroom", &[[4.32, 0.0], [7.0, 0.0], [7.0, 2.7], [4.32, 2.7]]),
            ("hall", &[[4.32, 2.82], [7.0, 2.82], [7.0, 5.0], [4.32, 5.0]]),
        ],
        &[(Door, [4.26, 3.4]), (Door, [6.0, 2.76]), (Door, [7.1, 3.4]), (Window, [0.0, 2.5])],
    );
    for (from, to) in [([0.0, 0.0], [7.0, 0.0]), ([7.0, 5.0], [0.0, 5.0])] {
        let slope = Slope { from, to, low_z_m: 1.3, pitch_deg: 30.0 };
        attic.slopes.extend((0..3).map(|room| CeilingSlope { room, slope }));
    }
    attic
}

fn check(plan: &DrawnPlan) {
    check_all(&|config| home_on(config, &Library::default(), plan).unwrap());
}

fn check_all(make: &(dyn Fn(&HomeConfig) -> Home + Sync)) {
    let seeds: Vec<u64> = (0..enfilade_testkit::seeds(SEEDS[0], SEEDS[1])).collect();
    let removed = enfilade_parallel::map(&seeds, |&seed| {
        // Every fifth home is lived in; the others are made faster.
        let (clutter, lived_in) = if seed % 5 == 0 { (1.0, 0.5) } else { (0.1, 0.0) };
        let home = make(&HomeConfig { clutter, lived_in, ..HomeConfig::of_seed(seed) });
        let name = format!("seed {seed}");
        assert_eq!(home.scene.validate(), Ok(()), "{name}");
        assert_eq!(faults(&home), [], "{name}");
        every_thing_stands_within_a_room(&home, &name);
        no_ray_leaves(&home, &name);
        nothing_reaches_into_a_slope(&home, &name);
        home.removed
    });
    let in_walls = removed.iter().flatten().filter(|removal| matches!(&removal.fault, Fault::Meets(a, b) if is_wall(a) || is_wall(b)));
    let in_walls: Vec<String> = in_walls.map(|removal| removal.fault.to_string()).collect();
    assert_eq!(in_walls, Vec::<String>::new(), "things were placed in walls");
}

#[test]
fn homes_of_varied_shape_have_no_faults() {
    check_all(&|config| home(&HomeConfig { shape: RoomShape::Varied, ..config.clone() }));
}

fn is_wall(object: &str) -> bool {
    object.starts_with("wall_") && ["_south_", "_east_", "_north_", "_west_"].iter().any(|side| object.contains(side))
}

#[test]
fn homes_around_corners_have_no_faults() {
    check(&l_shape());
}

#[test]
fn homes_with_bays_have_no_faults() {
    check(&bay());
}

#[test]
fn homes_with_slanted_walls_have_no_faults() {
    check(&trapezoid());
}

#[test]
fn homes_under_a_roof_have_no_faults() {
    check(&attic());
}

#[test]
fn the_layout_of_a_home_under_a_roof_has_its_slopes() {
    let home = home_on(&HomeConfig { clutter: 0.0, ..HomeConfig::of_seed(3) }, &Library::default(), &attic()).unwrap();
    let rooms = home.rooms();
    assert_eq!(rooms.check(), Ok(()));
    // The bathroom and the hall are under one slope each.
    assert_eq!(rooms.slopes.iter().map(|of| of.room).collect::<Vec<_>>(), [0, 0, 1, 2]);
    let south = rooms.walls.iter().filter(|wall| wall.inward == [0.0, 1.0] && wall.from[1] == 0.0);
    assert!(south.clone().count() == 2 && south.clone().all(|wall| (wall.ceiling_z_m - 1.3).abs() < 1e-6));
    let again = DrawnPlan::from(&rooms);
    assert_eq!(again.slopes, rooms.slopes);
    assert_eq!(home_on(&HomeConfig::of_seed(3), &Library::default(), &again).unwrap().rooms().slopes, rooms.slopes);
}

#[test]
fn the_same_plan_and_seed_give_the_same_bytes() {
    let made =
        || to_bytes(&home_on(&HomeConfig { clutter: 0.1, ..HomeConfig::of_seed(3) }, &Library::default(), &trapezoid()).unwrap().scene);
    assert!(made() == made());
}

/// The middle of every thing on the floor is in a room: none is in the notch of an L, or beyond a slanted wall.
fn every_thing_stands_within_a_room(home: &Home, name: &str) {
    let shell = ["wall", "floor", "ceiling", "skirting", "door", "window", "passage", "blind", "curtain"];
    for part in home.scene.parts.iter().filter(|part| !shell.iter().any(|family| part.name.starts_with(family))) {
        for p in home.scene.world_positions(part) {
            let p: Vec2 = p.truncate();
            assert!(home.plan.rooms.iter().any(|room| room.contains(p, 0.4)), "{name}: {} at {p}", part.name);
        }
        let place = part.world_from_mesh.translation.as_vec3().truncate();
        assert!(home.plan.rooms.iter().any(|room| room.contains(place, 0.3)), "{name}: {} stands at {place}", part.name);
    }
    for room in &home.plan.rooms {
        let camera = |room: &Room| home.scene.cameras.iter().any(|camera| room.contains(camera.position.as_vec3().truncate(), -0.2));
        assert!(camera(room), "{name}: no camera in {:?}", room.kind);
    }
}

/// Every thing ends below the ceiling of its room, also where that slopes.
fn nothing_reaches_into_a_slope(home: &Home, name: &str) {
    let shell = ["wall_", "floor_", "ceiling_", "window_", "door_", "passage_"];
    let is_thing = |part: &&Part| {
        let object = part.name.split('/').next().unwrap_or_default();
        !shell.iter().any(|family| object.starts_with(family)) || object.starts_with("ceiling_lamp") || object.starts_with("wall_shelf")
    };
    for part in home.scene.parts.iter().filter(is_thing) {
        for p in home.scene.world_positions(part) {
            if let Some(room) = home.plan.rooms.iter().find(|room| !room.slopes.is_empty() && room.contains(p.truncate(), 0.0)) {
                let ceiling = room.ceiling_at(p.truncate());
                // Lamps are let into the ceiling by a millimetre.
                assert!(p.z < ceiling + 0.004, "{name}: {} reaches {:.3} m, the ceiling is at {ceiling:.3} m", part.name, p.z);
            }
        }
    }
}

/// The shell is closed: no ray from a camera ends nowhere.
fn no_ray_leaves(home: &Home, name: &str) {
    let world = WorldMesh::new(&home.scene);
    let bvh = Bvh::new(&world.corners, &|_| false);
    for camera in &home.scene.cameras {
        for k in 0..2_000 {
            let ray = Ray::new(camera.position.as_vec3(), warp::sphere([(k as f32 + 0.5) / 2_000.0, (k as f32 * 0.618_034).fract()]));
            assert!(bvh.closest(&ray).is_some(), "{name}: ray {ray:?} from {} leaves the home", camera.name);
        }
    }
}
