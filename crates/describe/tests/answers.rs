//! A generated home, described, and every answer found once more in another way: from pixels, corners and stored boxes.

use enfilade_dataset::{BoxKind, Dataset, DescribedInstance, FrameInfo, FrameTime, Question, RelationKind};
use enfilade_describe::describe;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_geometry::Bvh;
use enfilade_home::{Home, HomeConfig, RoomKind, home};
use enfilade_math::{DMat2, DVec2, DVec3, OrientedBox};
use enfilade_scene::{CameraView, Intrinsics, Pose, Quiet, Trajectory, WorldMesh};
use enfilade_testroom::store;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const SIZE: [u32; 2] = [160, 120];
const NAMES: [&str; 2] = ["home", "cam_00"];

/// A frame's pixels: instance, and distance from the camera.
struct Shown {
    instances: Vec<i16>,
    distances: Vec<f64>,
}

/// A home that is described, and what its frames show.
struct Told {
    dataset: Dataset,
    home: Home,
    shown: Vec<Shown>,
    boxes: Vec<Option<OrientedBox>>,
    things: BTreeMap<i16, DescribedInstance>,
    questions: Vec<Question>,
}

impl Told {
    fn new(root: &Path) -> Self {
        let home = home(&HomeConfig { seed: 4, rooms: vec![RoomKind::Study], lived_in: 0.0, ..HomeConfig::default() });
        let dataset = Dataset::create(root).unwrap();
        dataset.write_scene("home", &home.scene).unwrap();
        dataset.write_label_tables("home", &home.labels).unwrap();
        dataset.write_rooms("home", &home.rooms()).unwrap();
        enfilade_label::boxes::write_boxes(&dataset, "home", &home.scene, &home.labels).unwrap();
        let boxes = dataset.read_boxes("home", BoxKind::ObjectAligned2d).unwrap();
        let shown = film(&dataset, &home);
        describe(&dataset, "home", &Quiet).unwrap().unwrap();
        let things = dataset.read_described_instances("home").unwrap().into_iter().map(|thing| (thing.instance, thing)).collect();
        let text = std::fs::read_to_string(dataset.layout().questions("home", "cam_00")).unwrap();
        let questions = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        Self { dataset, home, shown, boxes, things, questions }
    }

    /// Corners of the triangles of an instance.
    fn corners(&self, instance: i16) -> Vec<[DVec3; 3]> {
        let world = WorldMesh::new(&self.home.scene);
        let is_of = |part: u32| self.home.labels.parts[part as usize].instance == instance;
        let of = world.corners.iter().zip(&world.sources).filter(|(_, source)| is_of(source.part));
        of.map(|(corners, _)| corners.map(|p| p.as_dvec3())).collect()
    }

    fn noun(&self, instance: i16) -> &str {
        &self.things[&instance].noun
    }

    /// The option that is marked as right, without its letter; the answer itself if there are no options.
    fn answer<'q>(&self, question: &'q Question) -> &'q str {
        let Some(options) = &question.options else { return &question.ground_truth };
        let option = options.iter().find(|option| option.starts_with(&format!("{}. ", question.ground_truth)));
        &option.expect("the right letter is among the options")[3..]
    }

    /// Pixels of an instance in a frame.
    fn pixels(&self, frame: usize, instance: i16) -> Vec<usize> {
        (0..self.shown[frame].instances.len()).filter(|&pixel| self.shown[frame].instances[pixel] == instance).collect()
    }
}

/// Frames from the middle of the room to its four sides, by rays.
fn film(dataset: &Dataset, home: &Home) -> Vec<Shown> {
    let world = WorldMesh::new(&home.scene);
    let bvh = Bvh::new(&world.corners, &|_| false);
    let [width, height] = SIZE;
    let intrinsics = Intrinsics { width, height, fx: 130.0, fy: 130.0, cx: 80.0, cy: 60.0, skew: 0.0 };
    let eye = home.scene.cameras[0].position;
    let pose = |frame: u32| {
        let (sin, cos) = (0.3 + 0.9 * f64::from(frame)).sin_cos();
        Pose::look_at(frame, eye, eye + DVec3::new(cos, sin, -0.3), DVec3::Z).unwrap()
    };
    let trajectory = Trajectory { name: "cam_00".into(), poses: (0..7).map(pose).collect() };
    dataset.write_camera_parameters("home", &intrinsics.into()).unwrap();
    dataset.write_trajectory("home", &trajectory, &intrinsics.into(), None).unwrap();
    let camera = intrinsics.into();
    let shoot = |pose: &Pose| {
        let view = CameraView::still(&camera, pose);
        let mut shown = Shown { instances: Vec::new(), distances: Vec::new() };
        let mut reflectance = Vec::new();
        for pixel in 0..width * height {
            let ray = view.centre_ray(f64::from(pixel % width) + 0.5, f64::from(pixel / width) + 0.5).unwrap();
            let ray =
                enfilade_math::Ray { origin: ray.origin.as_vec3(), direction: ray.direction.as_vec3(), t_min: 0.0, t_max: f32::INFINITY };
            let hit = bvh.closest(&ray);
            let part = hit.map(|hit| world.sources[hit.triangle as usize].part as usize);
            let instance = part.map_or(-1, |part| home.labels.parts[part].instance);
            shown.instances.push(instance);
            shown.distances.push(hit.map_or(f64::NAN, |hit| f64::from(hit.t)));
            // One colour for even instances and another for odd ones.
            reflectance.extend(if instance % 2 == 0 { [0.5, 0.01, 0.01] } else { [0.01, 0.02, 0.5] });
        }
        let mut frame = Frame::new(width, height);
        frame.insert(Layer::DepthMeters, store(Layer::DepthMeters, shown.distances.clone()));
        frame.insert(Layer::DiffuseReflectance, store(Layer::DiffuseReflectance, reflectance));
        let info = FrameInfo {
            seed: 1,
            samples: 1,
            config_hash: "test".into(),
            pose: *pose,
            camera: intrinsics.into(),
            sampling: None,
            recipe: None,
        };
        dataset.write_frame("home", "cam_00", &frame, &info, FrameTime::default()).unwrap();
        let mut labels = Frame::new(width, height);
        labels.insert(Layer::SemanticInstance, Values::I16(shown.instances.clone()));
        labels.insert(Layer::Semantic, Values::I16(vec![-1; shown.instances.len()]));
        dataset.write_label_layers("home", "cam_00", pose.frame, &labels, "test").unwrap();
        shown
    };
    trajectory.poses.iter().map(shoot).collect()
}

/// The least distance between points spread over two lists of triangles: an upper bound that is a few centimetres off at most.
fn apart_m(a: &[[DVec3; 3]], b: &[[DVec3; 3]]) -> f64 {
    let spread = |list: &[[DVec3; 3]]| -> Vec<DVec3> {
        let of = |&[p, q, r]: &[DVec3; 3]| {
            let steps = ((q - p).length().max((r - p).length()) / 0.05).ceil().clamp(1.0, 60.0) as usize;
            let weights = (0..=steps).flat_map(move |i| (0..=steps - i).map(move |j| (i as f64 / steps as f64, j as f64 / steps as f64)));
            weights.map(move |(u, v)| p + (q - p) * u + (r - p) * v).collect::<Vec<_>>()
        };
        list.iter().flat_map(of).collect()
    };
    // Cells of 10 cm keep the search short.
    let cell = |p: DVec3| (p / 0.1).floor().as_i64vec3().to_array();
    let keep_one =
        |points: Vec<DVec3>| points.into_iter().map(|p| ((p / 0.03).round().as_i64vec3().to_array(), p)).collect::<BTreeMap<_, _>>();
    let (a, b) = (keep_one(spread(a)), keep_one(spread(b)));
    let cells: BTreeSet<[i64; 3]> = b.values().map(|p| cell(*p)).collect();
    let nearest = |p: &DVec3| b.values().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
    let bound = |p: &DVec3| {
        cells
            .iter()
            .map(|c| p.distance(p.clamp(DVec3::from(c.map(|v| v as f64 * 0.1)), DVec3::from(c.map(|v| v as f64 * 0.1 + 0.1)))))
            .fold(f64::INFINITY, f64::min)
    };
    let mut bounds: Vec<(f64, DVec3)> = a.values().map(|p| (bound(p), *p)).collect();
    bounds.sort_by(|x, y| x.0.total_cmp(&y.0));
    bounds.iter().fold(f64::INFINITY, |best, (bound, p)| if *bound < best { best.min(nearest(p)) } else { best })
}

#[test]
fn every_answer_is_found_in_another_way_too() {
    let folder = tempfile::tempdir().unwrap();
    let told = Told::new(folder.path());
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for question in &told.questions {
        *kinds.entry(&question.question_type).or_default() += 1;
        check(&told, question);
    }
    // All kinds were asked, except for what a study does not have.
    for kind in ["object_counting", "object_size_estimation", "room_size_estimation", "object_abs_distance", "object_rel_distance"] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
    for kind in ["object_rel_direction_easy", "object_rel_direction_medium", "object_rel_direction_hard", "obj_appearance_order"] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
    for kind in ["object_relation", "object_color", "camera_distance", "image_side"] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
    let ids: BTreeSet<&str> = told.questions.iter().map(|question| question.id.as_str()).collect();
    assert_eq!(ids.len(), told.questions.len());
}

fn check(told: &Told, question: &Question) {
    let (answer, is, of) = (told.answer(question), &question.instances, format!("{question:?}"));
    let number = || answer.parse::<f64>().unwrap();
    let upright = |instance: i16| told.boxes[instance as usize].unwrap();
    let frame = question.frame.map(|frame| frame as usize);
    match question.question_type.as_str() {
        "object_counting" | "image_counting" => {
            let frames: Vec<usize> = frame.map_or((0..told.shown.len()).collect(), |frame| vec![frame]);
            let seen: BTreeSet<i16> = frames.iter().flat_map(|&f| told.shown[f].instances.iter().copied()).filter(|i| *i >= 1).collect();
            let count = seen.iter().filter(|i| told.noun(**i).ends_with(told.noun(is[0]))).count();
            assert_eq!(number() as usize, count, "{of}");
        }
        "object_size_estimation" => {
            assert!((number() - 100.0 * upright(is[0]).extents.max_element()).abs() <= 0.51, "{of}");
        }
        "room_size_estimation" => {
            // The floor's triangles.
            let world = WorldMesh::new(&told.home.scene);
            let floor = world.corners.iter().zip(&world.sources).filter(|(_, s)| told.home.labels.parts[s.part as usize].semantic == 2);
            let level =
                floor.filter(|(c, _)| c.iter().all(|p| p.z.abs() < 1e-4)).map(|(c, _)| 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length());
            assert!((number() - f64::from(level.sum::<f32>())).abs() < 1.5, "{of}");
        }
        "object_abs_distance" => {
            let apart = apart_m(&told.corners(is[0]), &told.corners(is[1]));
            assert!(number() <= apart + 0.06 && number() >= apart - 0.12, "{of} {apart}");
        }
        "object_rel_distance" => {
            let target = told.corners(is[0]);
            let apart: Vec<f64> = is[1..].iter().map(|&other| apart_m(&target, &told.corners(other))).collect();
            let nearest = (0..apart.len()).min_by(|&a, &b| apart[a].total_cmp(&apart[b])).unwrap();
            assert_eq!(told.noun(is[1 + nearest]), answer, "{of} {apart:?}");
        }
        kind if kind.starts_with("object_rel_direction") => {
            // Turned so that the way ahead is along y, right is positive x.
            let [standing, facing, asked] = [is[0], is[1], is[2]].map(|i| upright(i).center.truncate());
            let ahead = (facing - standing).normalize();
            let turned: DVec2 = DMat2::from_cols(DVec2::new(ahead.y, ahead.x), DVec2::new(-ahead.x, ahead.y)) * (asked - standing);
            let side = if turned.x > 0.0 { "right" } else { "left" };
            let expected = match kind {
                "object_rel_direction_easy" => side.to_string(),
                "object_rel_direction_medium" if turned.y < -turned.x.abs() => "back".into(),
                "object_rel_direction_medium" => side.into(),
                _ => format!("{}-{side}", if turned.y > 0.0 { "front" } else { "back" }),
            };
            assert_eq!(answer, expected, "{of} {turned}");
        }
        "obj_appearance_order" => {
            let first =
                |i: i16| (0..told.shown.len()).find(|&f| told.pixels(f, i).len() as f64 >= 0.005 * told.shown[f].instances.len() as f64);
            let mut order: Vec<(usize, &str)> = is.iter().map(|&i| (first(i).unwrap(), told.noun(i))).collect();
            order.sort_unstable();
            let names: Vec<&str> = order.iter().map(|(_, noun)| *noun).collect();
            assert_eq!(answer, names.join(", "), "{of}");
        }
        "object_relation" => {
            // What is right below the lowest corner, or around the middle.
            let (a, b) = (upright(is[0]), upright(is[1]));
            let middle = (b.world_from_box.transpose() * (a.center - b.center)).abs();
            assert!((middle.truncate().cmple(0.5 * b.extents.truncate() + 0.05)).all(), "{of}");
            assert!(a.center.z > b.center.z - 0.5 * b.extents.z, "{of}");
            let kinds = told.dataset.read_instance_relations("home").unwrap();
            assert!(
                kinds.iter().any(|r| r.subject == is[0] && r.object == is[1] && matches!(r.kind, RelationKind::On | RelationKind::In)),
                "{of}"
            );
        }
        "object_color" => assert_eq!(answer, if is[0] % 2 == 0 { "red" } else { "blue" }, "{of}"),
        "camera_distance" => {
            let mean = |i: i16| {
                let pixels = told.pixels(frame.unwrap(), i);
                pixels.iter().map(|&p| told.shown[frame.unwrap()].distances[p]).sum::<f64>() / pixels.len() as f64
            };
            let nearer = if mean(is[0]) < mean(is[1]) { is[0] } else { is[1] };
            assert!(answer.ends_with(told.noun(nearer)), "{of}");
        }
        "image_side" => {
            let mean = |i: i16| {
                let pixels = told.pixels(frame.unwrap(), i);
                pixels.iter().map(|p| (p % SIZE[0] as usize) as f64).sum::<f64>() / pixels.len() as f64
            };
            assert_eq!(answer, if mean(is[0]) < mean(is[1]) { "left" } else { "right" }, "{of}");
        }
        other => panic!("{other} is checked by nothing"),
    }
}

#[test]
fn captions_speak_of_what_the_frame_shows_and_the_same_bytes_come_again() {
    let folder = tempfile::tempdir().unwrap();
    let told = Told::new(folder.path());
    let layout = told.dataset.layout();
    let files = [
        layout.captions("home", "cam_00"),
        layout.questions("home", "cam_00"),
        layout.described_instances("home"),
        layout.instance_relations("home"),
    ];
    let bytes = || files.clone().map(|file| std::fs::read(file).unwrap());
    let before = bytes();
    let captions: Vec<enfilade_dataset::Caption> =
        String::from_utf8(before[0].clone()).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(captions.len(), told.shown.len());
    for (caption, shown) in captions.iter().zip(&told.shown) {
        assert!(caption.caption.starts_with("A study with "), "{caption:?}");
        assert!(!caption.instances.is_empty() && caption.instances.iter().all(|i| shown.instances.contains(i)), "{caption:?}");
    }
    let one = std::thread::spawn({
        let root = folder.path().to_path_buf();
        move || describe(&Dataset::open(&root).unwrap(), NAMES[0], &Quiet).unwrap()
    });
    one.join().unwrap();
    assert_eq!(bytes(), before);
}
