//! Flow between any two frames: forward and backward agree, and between neighbours it is the layer.

use crate::common::{along_y, board, cuboid, dataset, pinhole, scene};
use enfilade_dataset::{Dataset, FramePair};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::{DVec2, DVec3, Rgb, Vec3};
use enfilade_multiview::{Filmed, ScenePackage, write_flow};
use enfilade_render::{FlowTo, Guide, RenderConfig, RenderScene, add_extra_layers, render_frame};
use enfilade_scene::{Camera, CameraView, Environment, Fisheye, Pose, Projection, Quiet};

fn write(dataset: &Dataset, pairs: impl FnOnce(&Filmed<'_>) -> Vec<[usize; 2]>) {
    let filmed = Filmed::read(dataset, "room", None, &Quiet).unwrap();
    let package = ScenePackage::read(&filmed, &Quiet).unwrap().unwrap();
    write_flow(&filmed, &package, &pairs(&filmed), &Quiet).unwrap();
}

fn pair(first: (&str, u32), second: (&str, u32)) -> FramePair {
    FramePair { scene: "room".into(), first: (first.0.into(), first.1), second: (second.0.into(), second.1) }
}

fn read(dataset: &Dataset, pair: &FramePair, layer: Layer) -> Values {
    dataset.read_pair_layer(pair, layer).unwrap().1
}

#[test]
fn to_the_next_frame_it_has_the_bits_of_the_rendered_layers() {
    let folder = tempfile::tempdir().unwrap();
    let mut furnished = scene(&[cuboid(Vec3::splat(-3.0), Vec3::splat(3.0)), cuboid(Vec3::new(-0.4, 1.0, -0.5), Vec3::new(0.3, 1.6, 0.7))]);
    furnished.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let poses = vec![along_y(0, DVec3::ZERO), along_y(1, DVec3::new(0.4, 0.1, 0.2)), along_y(2, DVec3::new(0.5, 0.3, 0.1))];
    let camera = Camera::from(pinhole());
    let dataset = dataset(folder.path(), &furnished, &[("cam_00", camera.clone(), poses.clone())]);
    write(&dataset, |filmed| filmed.steps(1));
    let prepared = RenderScene::new(&furnished, &Quiet).unwrap();
    let config = RenderConfig { samples: 1, ..RenderConfig::default() };
    let views: Vec<CameraView<'_>> = (0..3).map(|i| CameraView::of_frame(&camera, &poses, i)).collect();
    let guide = Guide::learn(&prepared, &views, &config);
    for i in 0..2 {
        let mut frame: Frame = render_frame(&prepared, &guide, &views[i], &config, &Quiet).unwrap();
        add_extra_layers(&prepared, &views[i], Some(FlowTo::still(&views[i + 1])), &mut frame);
        let pair = pair(("cam_00", i as u32), ("cam_00", i as u32 + 1));
        for layer in [Layer::OpticalFlow, Layer::SceneFlow, Layer::FlowVisibility] {
            assert!(read(&dataset, &pair, layer).as_bytes() == frame.get(layer).unwrap().as_bytes(), "{layer:?} of frame {i}");
        }
        let hidden = (0..frame.pixels()).filter(|&p| frame.get(Layer::FlowVisibility).unwrap().get(p) == 0.0).count();
        assert!(hidden > 20, "{hidden} pixels leave the image or are hidden");
    }
}

#[test]
fn steps_lead_forward_and_backward_within_a_trajectory() {
    let folder = tempfile::tempdir().unwrap();
    let poses = |n: u32| (0..n).map(|i| along_y(i, DVec3::new(f64::from(i), 0.0, 0.0))).collect::<Vec<_>>();
    let cameras = [("cam_00", Camera::from(pinhole()), poses(3)), ("cam_01", pinhole().into(), poses(2))];
    let dataset = dataset(folder.path(), &scene(&[board(4.0, -40.0, 40.0)]), &cameras);
    let filmed = Filmed::read(&dataset, "room", None, &Quiet).unwrap();
    assert_eq!(filmed.steps(1), [[0, 1], [1, 2], [3, 4]]);
    assert_eq!(filmed.steps(-1), [[1, 0], [2, 1], [4, 3]]);
    assert_eq!(filmed.steps(-2), [[2, 0]]);
    assert_eq!((filmed.find("cam_01", 1), filmed.find("cam_01", 2)), (Some(4), None));
}

#[test]
fn before_a_wall_flow_is_baseline_times_focal_length_over_depth() {
    let folder = tempfile::tempdir().unwrap();
    let poses = vec![along_y(0, DVec3::ZERO), along_y(1, DVec3::X), along_y(2, DVec3::new(1.5, 0.0, 0.0))];
    let dataset = dataset(folder.path(), &scene(&[board(4.0, -40.0, 40.0)]), &[("cam_00", pinhole().into(), poses)]);
    write(&dataset, |_| vec![[2, 0]]);
    let pair = pair(("cam_00", 2), ("cam_00", 0));
    let (flow, moved, seen) =
        (read(&dataset, &pair, Layer::OpticalFlow), read(&dataset, &pair, Layer::SceneFlow), read(&dataset, &pair, Layer::FlowVisibility));
    for pixel in 0..64 * 48 {
        let shift = 32.0 * 1.5 / 4.0;
        assert!((flow.get(2 * pixel) - shift).abs() < 1e-4 && flow.get(2 * pixel + 1).abs() < 1e-4);
        assert!(
            (moved.get(3 * pixel) - 1.5).abs() < 1e-5 && moved.get(3 * pixel + 1).abs() < 1e-5 && moved.get(3 * pixel + 2).abs() < 1e-5
        );
        assert_eq!(seen.get(pixel) == 1.0, (pixel % 64) as f64 + 0.5 + shift < 64.0);
    }
}

#[test]
fn between_cameras_of_two_kinds_the_way_there_and_back_ends_where_it_began() {
    let folder = tempfile::tempdir().unwrap();
    let (k, pose) = (pinhole(), |x: f64, z: f64| Pose::look_at(0, DVec3::new(x, -2.0, z), DVec3::new(0.0, 2.0, 0.1), DVec3::Z).unwrap());
    let fisheye = Projection::Fisheye(k, Fisheye::new([-0.01, 0.002, -0.0003, 0.0]).unwrap());
    let room = scene(&[cuboid(Vec3::splat(-3.0), Vec3::splat(3.0))]);
    let cameras = [("cam_00", Camera::from(k), vec![pose(-0.5, 0.0)]), ("cam_01", fisheye.into(), vec![pose(0.7, 0.4)])];
    let dataset = dataset(folder.path(), &room, &cameras);
    write(&dataset, |_| vec![[0, 1], [1, 0]]);
    let (there, back) = (pair(("cam_00", 0), ("cam_01", 0)), pair(("cam_01", 0), ("cam_00", 0)));
    let [forward, backward] = [&there, &back].map(|pair| read(&dataset, pair, Layer::OpticalFlow));
    let seen = read(&dataset, &there, Layer::FlowVisibility);
    let at = |flow: &Values, x: usize, y: usize| DVec2::new(flow.get(2 * (64 * y + x)), flow.get(2 * (64 * y + x) + 1));
    let (mut compared, mut worst) = (0, 0.0f64);
    for pixel in (0..64 * 48).filter(|&pixel| seen.get(pixel) == 1.0) {
        let from = DVec2::new((pixel % 64) as f64 + 0.5, (pixel / 64) as f64 + 0.5);
        let to = from + at(&forward, pixel % 64, pixel / 64);
        // Between four pixel centres, whose flow is blended.
        let (corner, weight) = ((to - 0.5).floor(), (to - 0.5).fract());
        if corner.x < 0.0 || corner.y < 0.0 || corner.x >= 63.0 || corner.y >= 47.0 {
            continue;
        }
        let (x, y) = (corner.x as usize, corner.y as usize);
        let row = |y: usize| at(&backward, x, y).lerp(at(&backward, x + 1, y), weight.x);
        let returned = to + row(y).lerp(row(y + 1), weight.y);
        compared += 1;
        worst = worst.max(returned.distance(from));
    }
    // The room is convex, so nothing is hidden; blending across its edges is what differs.
    assert!(compared > 1000 && worst < 0.5, "{compared} pixels, {worst} px");
}
