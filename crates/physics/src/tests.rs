//! A small room with known masses, as bodies and as files.

use crate::model::{JointKind, PhysicsError};
use crate::{mjcf, simulated, urdf, usd};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{Body, BodyMotion, BodyStates, Labels, Material, Part, PartLabel, Scene, SceneFiles, Shape};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A closed block with its lowest corner at the origin.
fn block(size: Vec3) -> Mesh {
    let corner = |i: usize| size * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

/// A room in the making: blocks with names, places, materials and labels.
#[derive(Default)]
struct Room {
    scene: Scene,
    labels: Labels,
}

impl Room {
    fn with(mut self, name: &str, material: &str, size: Vec3, at: DVec3, semantic: i16, instance: i16) -> Self {
        let number = self.scene.parts.len() as u32;
        self.scene.meshes.push(block(size).into());
        self.scene.materials.push(Material::diffuse(material, Rgb::splat(0.5)));
        let world_from_mesh = DAffine3::from_translation(at);
        self.scene.parts.push(Part { name: name.into(), object: None, mesh: number, material: number, world_from_mesh });
        self.labels.parts.push(PartLabel { semantic, instance });
        self
    }

    fn with_joint(mut self, part: u32, states: BodyStates, limits: [f64; 2]) -> Self {
        let name = self.scene.parts[part as usize].name.clone();
        let motion = BodyMotion { times_s: vec![0.0], states };
        let (lights, cameras) = (Vec::new(), Vec::new());
        self.scene.bodies.push(Body { name, parent: None, parts: vec![part], lights, cameras, limits: Some(limits), motion });
        self
    }
}

/// Writes files below a folder; the path of the main one.
fn written(folder: &Path, name: &str, files: &SceneFiles) -> PathBuf {
    for (name, bytes) in &files.beside {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let path = folder.join(name);
    std::fs::write(&path, &files.main).unwrap();
    path
}

/// What a Python program says about a file, as JSON; `None` where there is no Python that has what it needs.
fn told(program: &str, file: &Path) -> Option<Value> {
    let Some(python) = std::env::var_os("ENFILADE_PYTHON") else {
        eprintln!("{program} skipped: ENFILADE_PYTHON names no python");
        return None;
    };
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(program);
    let output = Command::new(python).arg(&program).arg(file).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(77) {
        eprintln!("{} skipped: its library is missing", program.display());
        return None;
    }
    assert!(output.status.success(), "{errors}");
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// A floor, a box that stands on it, one that hangs, a cabinet with a door and a drawer, and two cushions of which one is in the other.
fn room() -> Room {
    let hinge = BodyStates::Hinge { point: DVec3::new(2.0, 1.0, 0.0), axis: DVec3::Z, angles_rad: vec![0.0] };
    let slide = BodyStates::Slide { axis: -DVec3::Y, distances_m: vec![0.0] };
    Room::default()
        .with("floor", "oak planks", Vec3::new(6.0, 6.0, 0.1), DVec3::new(-3.0, -3.0, -0.1), 2, -1)
        .with("crate", "oak", Vec3::new(0.2, 0.3, 0.5), DVec3::ZERO, 29, 1)
        .with("lamp", "brass", Vec3::splat(0.1), DVec3::new(1.0, 0.0, 2.0), 35, 2)
        .with("cabinet", "oak", Vec3::new(0.6, 0.4, 0.8), DVec3::new(2.0, 1.05, 0.0), 3, 3)
        .with("cabinet door", "oak", Vec3::new(0.6, 0.02, 0.8), DVec3::new(2.0, 1.0, 0.0), 3, 3)
        .with("cabinet drawer", "oak", Vec3::new(0.6, 0.02, 0.1), DVec3::new(2.0, 1.0, 0.8), 3, 3)
        .with("cushion", "cushion cloth", Vec3::splat(0.4), DVec3::new(-1.0, 0.0, 0.0), 18, 4)
        .with("throw", "knitted wool", Vec3::splat(0.1), DVec3::new(-0.9, 0.1, 0.35), 40, 5)
        .with_joint(4, hinge, [-1.5, 0.0])
        .with_joint(5, slide, [0.0, 0.35])
}

#[test]
fn what_would_fall_is_fixed_to_the_free_thing_that_bears_it() {
    // Its middle is 0.1 m beyond the crate's edge.
    let Room { scene, labels } = room().with("ruler", "oak", Vec3::new(0.3, 0.02, 0.005), DVec3::new(0.15, 0.1, 0.5), 40, 6);
    let model = simulated(&scene, &labels).unwrap();
    let index = |name: &str| model.bodies.iter().position(|body| body.name == name).unwrap();
    let ruler = &model.bodies[index("ruler")];
    assert_eq!((ruler.joint.kind, ruler.parent), (JointKind::Fixed, Some(index("crate"))));
    assert_eq!(model.bodies[index("crate")].joint.kind, JointKind::Free);
    assert_eq!(model.bodies[index("lamp")].parent, None);
}

#[test]
fn a_joint_ends_before_what_is_in_the_way_and_what_lies_in_a_drawer_goes_along() {
    let (wide, open) = (Vec3::new(0.1, 0.1, 1.0), [-1.5, 0.0]);
    // The post's near side is 0.3 m before the closed door, whose edge is 0.6 m from the hinge. The pencil lies on the drawer.
    let Room { scene, labels } = room().with("post", "oak", wide, DVec3::new(2.0, 0.6, 0.0), 38, 6).with(
        "pencil",
        "oak",
        Vec3::new(0.2, 0.01, 0.01),
        DVec3::new(2.2, 1.005, 0.9001),
        40,
        7,
    );
    let model = simulated(&scene, &labels).unwrap();
    let body = |name: &str| model.bodies.iter().find(|body| body.name == name).unwrap();
    // The leaf's plane through the hinge, 0.02 m thick to one side, meets the corner (2.1, 0.7) at atan2(0.3, 0.1).
    let end = -(0.3f64).atan2(0.1);
    let limits = body("cabinet_door").joint.limits.unwrap();
    assert!((limits[0] - end).abs() < 1e-3 && limits[1] == open[1], "{limits:?} of {end}");
    let out = body("cabinet_drawer").joint.limits.unwrap();
    assert!(out[0] == 0.0 && (out[1] - 0.3).abs() < 1e-3, "{out:?}");
    let index = |name: &str| model.bodies.iter().position(|body| body.name == name).unwrap();
    assert!(!model.excluded.iter().any(|pair| pair.contains(&index("pencil"))), "{:?}", model.excluded);
    assert!(model.notes.iter().any(|note| note.contains("cabinet_door (post)")), "{:?}", model.notes);
}

#[test]
fn bodies_have_the_masses_of_their_volumes_and_the_joints_of_the_scene() {
    let Room { scene, labels } = room();
    let model = simulated(&scene, &labels).unwrap();
    let body = |name: &str| model.bodies.iter().find(|body| body.name == name).unwrap();
    let crate_mass = body("crate").moments().unwrap();
    assert!((crate_mass.mass_kg - 0.2 * 0.3 * 0.5 * 600.0).abs() < 1e-4, "{}", crate_mass.mass_kg);
    assert!((body("crate").origin + crate_mass.center).distance(DVec3::new(0.1, 0.15, 0.25)) < 1e-6);
    assert_eq!(body("crate").joint.kind, JointKind::Free);
    // What hangs in the air is fixed, and so is what bears joints.
    assert_eq!((body("lamp").joint.kind, body("cabinet").joint.kind), (JointKind::Fixed, JointKind::Fixed));
    let door = body("cabinet_door");
    assert_eq!((door.joint.kind, door.joint.limits), (JointKind::Hinge(DVec3::Z), Some([-1.5, 0.0])));
    assert!(door.origin.distance(DVec3::new(2.0, 1.0, 0.4)) < 1e-6, "{}", door.origin);
    assert_eq!(body("cabinet_drawer").joint.kind, JointKind::Slide(-DVec3::Y));
    // The throw is in the cushion: it is fixed to it, which is heavier, and comes after it.
    let index = |name: &str| model.bodies.iter().position(|body| body.name == name).unwrap();
    assert_eq!((body("throw").joint.kind, body("throw").parent), (JointKind::Fixed, Some(index("cushion"))));
    assert!(index("cushion") < index("throw"));
    assert!(model.excluded.contains(&[index("cabinet"), index("cabinet_door")]), "{:?}", model.excluded);
    assert!(model.notes.iter().any(|note| note.contains("lamp")), "{:?}", model.notes);
}

#[test]
fn an_opening_in_a_wall_stays_open() {
    // A frame: a wall of four metres with an opening of one by one in the middle, as one closed mesh would have it.
    let mut wall = Mesh::default();
    for (low, size) in [
        (Vec3::ZERO, Vec3::new(1.5, 0.2, 3.0)),
        (Vec3::new(2.5, 0.0, 0.0), Vec3::new(1.5, 0.2, 3.0)),
        (Vec3::new(1.5, 0.0, 0.0), Vec3::new(1.0, 0.2, 1.0)),
        (Vec3::new(1.5, 0.0, 2.0), Vec3::new(1.0, 0.2, 1.0)),
    ] {
        let mut part = block(size);
        part.positions.iter_mut().for_each(|p| *p += low);
        wall.append(&part);
    }
    let mut room = Room::default().with("wall", "wall paint", Vec3::ONE, DVec3::ZERO, 1, -1);
    room.scene.meshes[0] = wall.into();
    let model = simulated(&room.scene, &room.labels).unwrap();
    let inside = |p: DVec3| {
        let outside_of = |solid: &enfilade_compose::Solid| {
            solid.triangles.iter().any(|t| {
                let [a, b, c] = t.map(|i| solid.corners[i as usize]);
                (b - a).cross(c - a).dot(p - a) > 1e-9
            })
        };
        model.bodies[0].pieces.iter().any(|piece| !outside_of(&piece.solid))
    };
    assert!(inside(DVec3::new(1.499, 0.1, 1.5)) && inside(DVec3::new(2.0, 0.1, 0.999)));
    assert!(!inside(DVec3::new(1.501, 0.1, 1.5)) && !inside(DVec3::new(2.0, 0.1, 1.5)) && !inside(DVec3::new(2.499, 0.1, 1.999)));
}

/// Boards as floors of homes have them: a level field inside four bevels of 1.2 mm, open below, side by side.
fn boards(columns: u32, rows: u32) -> Mesh {
    let (size, bevel, mut mesh) = (Vec3::new(1.0, 0.2, 0.0), 0.0016f32, Mesh::default());
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let base = mesh.positions.len() as u32;
        for (inset, z) in [(0.0, -0.0012), (bevel, 0.0)] {
            for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let inner = |side: u32| if side == 0 { inset } else { -inset };
                let corner = Vec3::new((column + x) as f32 * size.x + inner(x), (row + y) as f32 * size.y + inner(y), z);
                mesh.positions.push(corner);
            }
        }
        let sides = (0..4).map(|k| [k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k]);
        for [a, b, c, d] in sides.chain([[4, 5, 6, 7]]).map(|quad| quad.map(|corner| base + corner)) {
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

#[test]
fn boards_bear_what_hovers_above_them_which_is_lowered() {
    let mut turned = boards(6, 3);
    turned.append(&{
        let mut more = boards(3, 4);
        more.positions.iter_mut().for_each(|p| p.y += 0.6);
        more
    });
    // A rectangle, and one that goes around a corner, each as one mesh.
    for floor in [boards(6, 25), turned] {
        let mut room = Room::default()
            .with("floor", "oak planks", Vec3::ONE, DVec3::ZERO, 2, -1)
            .with("screed", "screed", Vec3::new(6.0, 5.0, 0.1), DVec3::new(0.0, 0.0, -0.12), 2, -1)
            .with("table", "oak", Vec3::splat(0.4), DVec3::new(0.9, 0.1, 0.0005), 7, 1)
            .with("bowl", "oak", Vec3::splat(0.1), DVec3::new(1.0, 0.2, 0.402), 40, 2)
            .with("shelf", "oak", Vec3::new(0.5, 0.2, 0.02), DVec3::new(2.0, 0.1, 1.0), 15, 3)
            .with("vase", "oak", Vec3::splat(0.1), DVec3::new(2.1, 0.15, 1.021), 40, 4);
        room.scene.meshes[0] = floor.into();
        let model = simulated(&room.scene, &room.labels).unwrap();
        let body = |name: &str| model.bodies.iter().find(|body| body.name == name).unwrap();
        // The shelf hangs in the air and is fixed; the vase stands on it and is not.
        assert_eq!(["table", "bowl", "shelf", "vase"].map(|name| body(name).joint.kind), {
            [JointKind::Free, JointKind::Free, JointKind::Fixed, JointKind::Free]
        });
        for (name, bottom) in [("table", 0.0), ("bowl", 0.4), ("vase", 1.02)] {
            let corners = body(name).pieces.iter().flat_map(|piece| &piece.solid.corners);
            let found = corners.map(|corner| corner.z + body(name).origin.z).fold(f64::INFINITY, f64::min);
            assert!((found - bottom).abs() < 2e-4, "{name}: {found}");
            let seen = body(name).origin.z + body(name).visuals[0].place.z;
            assert!((seen - found).abs() < 1e-6, "{name}: seen at {seen}, in pieces at {found}");
        }
    }
}

#[test]
fn what_moves_without_a_volume_is_refused() {
    let mut room = Room::default().with("cord", "steel", Vec3::new(1.0, 0.0, 0.0), DVec3::ZERO, 40, 1);
    room.scene.bodies.push(Body {
        name: "cord".into(),
        parent: None,
        parts: vec![0],
        lights: Vec::new(),
        cameras: Vec::new(),
        limits: None,
        motion: BodyMotion::rest(),
    });
    let error = simulated(&room.scene, &room.labels).unwrap_err();
    assert!(matches!(&error, PhysicsError::NoVolume { body, .. } if body == "cord"), "{error}");
}

#[test]
fn what_deforms_is_a_rigid_thing_in_its_shape_of_rest() {
    let Room { mut scene, labels } = room();
    let shape = std::sync::Arc::new(Shape::of(&scene.meshes[scene.parts[1].mesh as usize]));
    let motion = BodyMotion { times_s: vec![0.0], states: BodyStates::Deform { shapes: vec![shape] } };
    scene.bodies.push(Body {
        name: "soft".into(),
        parent: None,
        parts: vec![1],
        lights: Vec::new(),
        cameras: Vec::new(),
        limits: None,
        motion,
    });
    assert_eq!(scene.validate(), Ok(()));
    let [soft, rigid] = [&scene, &room().scene].map(|scene| simulated(scene, &labels).unwrap());
    let names = |model: &crate::model::Model| model.bodies.iter().map(|body| (body.name.clone(), body.joint.kind)).collect::<Vec<_>>();
    assert_eq!(names(&soft), names(&rigid));
    assert!(soft.notes.iter().any(|note| note.starts_with("body \"soft\" deforms; it is a rigid thing")), "{:?}", soft.notes);
}

#[test]
fn without_labels_nothing_moves_and_that_is_told() {
    let model = simulated(&room().scene, &Labels::default()).unwrap();
    let moves = model.bodies.iter().filter(|body| body.joint.kind != JointKind::Fixed).count();
    assert_eq!(moves, 2, "the door and the drawer");
    let mut still = room();
    still.scene.bodies.clear();
    let model = simulated(&still.scene, &Labels::default()).unwrap();
    assert!(model.bodies.len() == 1 && model.notes[0].contains("enfilade annotate"), "{:?}", model.notes);
}

#[test]
fn urdf_is_read_back_with_every_part_in_its_place() {
    let Room { scene, labels } = room();
    let model = simulated(&scene, &labels).unwrap();
    let files = urdf(&model, "room", "room_files");
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), "room.urdf", &files);
    let read = enfilade_import::load(&path, &enfilade_import::ImportOptions::default(), &enfilade_scene::Quiet).unwrap().scene;
    assert_eq!(read.parts.len(), scene.parts.len());
    let box_of = |scene: &Scene, part: usize| {
        let part = &scene.parts[part];
        let corners = (0..scene.meshes[part.mesh as usize].triangles.len()).flat_map(|t| scene.world_corners(part, t));
        corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    };
    for (part, new) in read.parts.iter().enumerate() {
        let found = box_of(&read, part);
        let same = |old: &usize| box_of(&scene, *old).0.distance(found.0) < 1e-5 && box_of(&scene, *old).1.distance(found.1) < 1e-5;
        assert!((0..scene.parts.len()).any(|old| same(&old)), "{} at {found:?}", new.name);
    }
}

#[test]
fn mujoco_keeps_the_room_as_it_is_and_opens_its_door() {
    let Room { scene, labels } = room();
    let model = simulated(&scene, &labels).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), "room.xml", &mjcf(&model, "room", "room_files"));
    let Some(told) = told("simulate.py", &path) else { return };
    assert_eq!((told["bodies"].as_u64(), told["free"].as_u64(), told["joints"].as_u64()), (Some(8), Some(2), Some(2)), "{told}");
    let mass = told["mass_kg"]["crate"].as_f64().unwrap();
    assert!((mass - 18.0).abs() < 1e-3, "{mass}");
    assert!(told["drift_mm"][0].as_f64().unwrap() < 1.0 && told["jump_mm"][0].as_f64().unwrap() < 1.0, "{told}");
    assert_eq!(told["sweeps"], serde_json::json!({}));
}

#[test]
fn usd_is_valid_and_has_the_same_masses() {
    let Room { scene, labels } = room();
    let model = simulated(&scene, &labels).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), "room.usda", &usd(&model, "room", "room_files"));
    let Some(told) = told("validate_usd.py", &path) else { return };
    assert_eq!((told["bodies"].as_u64(), told["joints"].as_u64()), (Some(5), Some(3)), "{told}");
    let masses = told["mass_kg"].as_object().unwrap();
    let (_, mass) = masses.iter().find(|(name, _)| name.ends_with("crate")).unwrap();
    assert!((mass.as_f64().unwrap() - 18.0).abs() < 1e-3, "{mass}");
}

#[test]
fn mjcf_names_all_that_it_has() {
    let Room { scene, labels } = room();
    let model = simulated(&scene, &labels).unwrap();
    let files = mjcf(&model, "room", "room_files");
    let text = String::from_utf8(files.main.clone()).unwrap();
    for name in files.beside.keys() {
        assert!(text.contains(&format!("file=\"{}\"", name.trim_start_matches("room_files/"))), "{name}");
    }
    assert!(text.contains("<freejoint name=\"crate\"/>"));
    assert!(text.contains("name=\"cabinet_door\" type=\"hinge\" axis=\"0 0 1\" range=\"-1.5 0\""), "{text}");
    assert_eq!(files, mjcf(&simulated(&scene, &labels).unwrap(), "room", "room_files"), "the same bytes every time");
}
