//! Scenes in which a part changes its shape, against formulas.

use crate::common::{LAMP, WALL, assert_made, assert_related, block, write_blocks};
use enfilade_dataset::Dataset;
use enfilade_frame::{Layer, traits, vector};
use enfilade_import::{ImportOptions, UpAxis, load};
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_pipeline::{Config, Overrides, Silent, replay, run};
use enfilade_scene::{Body, BodyMotion, BodyStates, CameraView, DEFORM, Quiet, Scene, Shape, to_bytes};
use std::path::Path;
use std::sync::Arc;

const FRAMES: u32 = 4;
/// The part that deforms, as `render_entity_id` numbers it, and below it the one that bears it.
const BAG: i64 = 3;
const CART: i64 = 4;
const LAST_S: f64 = 3.0;

/// The way of the bag from rest: it grows and leans, while the cart goes on.
fn expected(t: f64) -> DAffine3 {
    let grown = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.15 * t, 0.0, 1.0 + 0.2 * t));
    let foot = DVec3::new(0.0, 1.0, 0.3);
    slid(t) * DAffine3::from_translation(foot) * DAffine3::from_mat3(grown) * DAffine3::from_translation(-foot)
}

fn slid(t: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::X * (-0.2 * t))
}

/// A room with a cart and a bag on it. A vertex of the bag goes straight, so that between two shapes formulas are exact.
fn scene(folder: &Path) -> Scene {
    let thing = |name, min, max| block(name, min, max, [0.6, 0.4, 0.3]);
    write_blocks(folder, &[WALL, LAMP, thing("bag", [-0.4, 0.8, 0.3], [0.4, 1.1, 1.0]), thing("cart", [-0.6, 0.7, 0.1], [0.6, 1.2, 0.3])]);
    let options = ImportOptions { up_axis: Some(UpAxis::Z), ..ImportOptions::default() };
    let mut scene = load(&folder.join("room.obj"), &options, &Quiet).unwrap().scene;
    let part = &scene.parts[BAG as usize - 1];
    let (mesh, place) = (scene.meshes[part.mesh as usize].clone(), part.world_from_mesh);
    let shape = |t: f64| {
        let within = place.inverse() * slid(t).inverse() * expected(t) * place;
        let positions = mesh.positions.iter().map(|p| within.transform_point3(p.as_dvec3()).as_vec3()).collect();
        Arc::new(Shape { positions, normals: mesh.normals.clone() })
    };
    let body = |name: &str, parent, part: i64, states| Body {
        name: name.into(),
        parent,
        parts: vec![part as u32 - 1],
        lights: Vec::new(),
        cameras: Vec::new(),
        limits: None,
        motion: BodyMotion { times_s: vec![0.0, LAST_S], states },
    };
    let away = BodyStates::Slide { axis: DVec3::NEG_X, distances_m: vec![0.0, 0.2 * LAST_S] };
    let shapes = vec![shape(0.0), shape(LAST_S)];
    scene.bodies = vec![body("cart", None, CART, away), body("bag", Some(0), BAG, BodyStates::Deform { shapes })];
    scene.validate().unwrap();
    scene
}

fn config(folder: &Path, path: &str, samples: &str, rest: &str) -> Config {
    std::fs::write(folder.join("room.scene"), to_bytes(&scene(folder))).unwrap();
    let path = format!("frame,position_x,position_y,position_z,look_at_x,look_at_y,look_at_z,roll_deg\n{path}\n");
    std::fs::write(folder.join("path.csv"), path).unwrap();
    let text = format!(
        "seed = 3\n[render]\nsize = [64, 48]\n{samples}\nmax_bounces = 1\nextra = true\n[carve]\nrays = 8192\niterations = 2\n[gate]\naction = \
         \"report\"\n[[scene]]\nname = \"room\"\nfile = \"room.scene\"\n{rest}[scene.plan]\nmode = {{ kind = \"keyframes\", files = [\"path.csv\"] }}\n"
    );
    std::fs::write(folder.join("dataset.toml"), text).unwrap();
    Config::read(&folder.join("dataset.toml"), &Overrides::default()).unwrap()
}

#[test]
fn points_of_what_deforms_stay_on_their_triangle_and_every_law_holds() {
    let folder = tempfile::tempdir().unwrap();
    let (config, out) =
        (config(folder.path(), "0,-0.2,-1.3,1.4,0,1,0.8,0\n3,0.2,-1.2,1.3,-0.1,1,0.8,0", "samples = 1", ""), folder.path().join("out"));
    assert_made(&config, &out);
    assert!(run(&config, &out, None, &Silent).unwrap().nothing_done());

    let dataset = Dataset::open(&out).unwrap();
    let bodies = dataset.read_filmed_bodies("room", "cam_00").unwrap().unwrap();
    assert_eq!(bodies.bodies.iter().map(|body| (body.joint.as_str(), body.moves)).collect::<Vec<_>>(), [("slide", true), (DEFORM, true)]);
    let compared: usize = (0..FRAMES).map(|frame| flow_is_as_expected(&dataset, frame)).sum();
    assert!(compared > 500, "{compared} pixels show the bag");

    let report = assert_related(&dataset, "room");
    // No map takes points of the bag along, so none is followed.
    tracks_are_as_expected(&dataset);
    assert!(report.notes.iter().any(|note| note.starts_with("room: 1 parts deform, the first is \"bag\"")), "{:?}", report.notes);
    assert!(replay(&dataset.layout().frame_record("room", "cam_00", 2), None, &Quiet).unwrap().is_same());
}

/// Compares the tracks of points of the bag with the formula.
fn tracks_are_as_expected(dataset: &Dataset) {
    let tracks = dataset.read_tracks("room", "cam_00").unwrap();
    let camera = dataset.read_camera("room", "cam_00").unwrap();
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    let mut compared = 0;
    for (point, _) in tracks.node_ids.iter().enumerate().filter(|(_, part)| i64::from(**part) == BAG) {
        let rest = expected(f64::from(tracks.seeds[point].0)).inverse().transform_point3(tracks.positions[point]);
        for frame in 0..FRAMES as usize {
            let view = CameraView::of_frame(&camera, &poses, frame);
            let (x, y) = view.project(expected(frame as f64).transform_point3(rest)).unwrap();
            let [found_x, found_y] = tracks.points[point * FRAMES as usize + frame].map(f64::from);
            assert!((found_x * 64.0 - x).hypot(found_y * 48.0 - y) < 1e-3, "point {point} in frame {frame}");
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}

/// Compares flow and scene flow on the bag with the formula; returns the number of its pixels.
fn flow_is_as_expected(dataset: &Dataset, number: u32) -> usize {
    let layers = [Layer::RenderEntityId, Layer::OpticalFlow, Layer::SceneFlow, Layer::SurfaceTraits, Layer::DepthMeters];
    let frame = dataset.read_frame("room", "cam_00", number, &layers).unwrap();
    let [entities, flows, scene_flows, kinds, distances] = layers.map(|layer| frame.get(layer).unwrap());
    let camera = dataset.read_camera("room", "cam_00").unwrap();
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    let view = |index: usize| CameraView::of_frame(&camera, &poses, index);
    let mut compared = 0;
    for pixel in (0..frame.pixels()).filter(|&pixel| entities.get(pixel) as i64 == BAG) {
        assert!(kinds.get(pixel) as u8 & traits::MOVES != 0);
        compared += 1;
        if number + 1 == FRAMES {
            continue;
        }
        let (x, y) = ((pixel % 64) as f64 + 0.5, (pixel / 64) as f64 + 0.5);
        let [from, to] = [view(number as usize), view(number as usize + 1)];
        let ray = from.centre_ray(x, y).unwrap();
        let p = ray.origin + ray.direction * distances.get(pixel);
        let [here, there] = [number, number + 1].map(|frame| expected(f64::from(frame)));
        let then = there.transform_point3(here.inverse().transform_point3(p));
        let (to_x, to_y) = to.project(then).unwrap();
        assert!((flows.get(2 * pixel) - (to_x - x)).hypot(flows.get(2 * pixel + 1) - (to_y - y)) < 1e-3);
        let in_camera = |view: &CameraView<'_>, p: DVec3| DMat3::transpose(&view.pose().world_from_camera) * (p - view.pose().position);
        let moved: DVec3 = vector(scene_flows, pixel);
        assert!(moved.distance(in_camera(&to, then) - in_camera(&from, p)) < 1e-5, "{moved}");
    }
    compared
}

/// The share of the exposure in which the growing bag covers a pixel is the share of its colour there.
#[test]
fn what_deforms_while_the_shutter_is_open_is_blurred() {
    let folder = tempfile::tempdir().unwrap();
    let samples = "samples = 64\nadaptive = false\nfilter = \"box\"";
    let exposed = "camera = { shutter = { exposure_s = 1.0, frame_time_s = 1.0 } }\n";
    let config = config(folder.path(), "0,0,-1.3,1,0,1,1,0\n2,0,-1.3,1,0,1,1,0", samples, exposed);
    let out = folder.path().join("out");
    assert!(run(&config, &out, None, &Silent).unwrap().ok());
    let dataset = Dataset::open(&out).unwrap();
    let camera = dataset.read_camera("room", "cam_00").unwrap();
    let poses = dataset.read_trajectory("room", "cam_00").unwrap().poses;
    let frame = dataset.read_frame("room", "cam_00", 1, &[Layer::DiffuseReflectance]).unwrap();
    let reflectance = frame.get(Layer::DiffuseReflectance).unwrap();
    let view = CameraView::of_frame(&camera, &poses, 1);
    // The front of the bag is in the plane y = 0.8; its top rises through the pixels of a column in the middle of the picture.
    let front_z = |y: f64| {
        let ray = view.centre_ray(32.0, y).unwrap();
        ray.origin.z + ray.direction.z * (0.8 - ray.origin.y) / ray.direction.y
    };
    let mut partly = 0;
    for row in 8..32 {
        let covers = |step: usize| {
            let (share, t) = (((step % 32) as f64 + 0.5) / 32.0, 0.5 + ((step / 32) as f64 + 0.5) / 256.0);
            front_z(f64::from(row) + share) < 0.3 + 0.7 * (1.0 + 0.2 * t)
        };
        let share = (0..32 * 256).filter(|&step| covers(step)).count() as f64 / (32.0 * 256.0);
        let found = |channel: usize| reflectance.get(3 * (row as usize * 64 + 31) + channel);
        let of_bag = (0.7 - found(2)) / 0.4;
        assert!((of_bag - share).abs() < 0.15, "row {row}: {of_bag}, expected {share}");
        partly += u32::from((0.1..0.9).contains(&share));
    }
    assert!(partly >= 2, "{partly}");
}
