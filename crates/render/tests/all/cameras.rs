//! Lenses, shutters and camera models against closed forms.

use enfilade_frame::{Frame, Layer, Validity, Values, f16};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{
    Camera, CameraView, Environment, Fisheye, Intrinsics, Material, Part, Pose, Projection, Quiet, RadialTangential, RayGrid, Scene,
    Shutter, ThinLens, TiltedPinhole,
};

fn quad(origin: Vec3, e1: Vec3, e2: Vec3) -> Mesh {
    Mesh { positions: vec![origin, origin + e1, origin + e1 + e2, origin + e2], triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

fn scene(parts: Vec<(Mesh, Material)>) -> Scene {
    let mut s = Scene::default();
    for (i, (mesh, material)) in parts.into_iter().enumerate() {
        let (mesh_id, material_id) = (i as u32, i as u32);
        s.parts.push(Part {
            name: format!("part {i}"),
            object: None,
            mesh: mesh_id,
            material: material_id,
            world_from_mesh: DAffine3::IDENTITY,
        });
        s.meshes.push(mesh.into());
        s.materials.push(material);
    }
    s
}

fn glowing() -> Material {
    Material { emission: Rgb::WHITE.into(), ..Material::diffuse("glowing", Rgb::BLACK) }
}

/// From (x, 0, 0), looking along +y.
fn pose(frame: u32, x: f64) -> Pose {
    let position = DVec3::new(x, 0.0, 0.0);
    Pose::look_at(frame, position, position + DVec3::Y, DVec3::Z).unwrap()
}

fn render(s: &Scene, view: &CameraView<'_>, config: &RenderConfig) -> Frame {
    s.validate().unwrap();
    let prepared = RenderScene::new(s, &Quiet).unwrap();
    let guide = Guide::learn(&prepared, &[*view], config);
    render_frame(&prepared, &guide, view, config, &Quiet).unwrap()
}

/// Samples at pixel centres, so that a picture's formula needs no filter.
fn unfiltered(samples: u32) -> RenderConfig {
    RenderConfig { samples, adaptive: false, filter_radius: 0.0, ..RenderConfig::default() }
}

fn color(frame: &Frame, x: u32, y: u32) -> f64 {
    frame.get(Layer::Color).unwrap().get(3 * (y * frame.width + x) as usize)
}

fn vector(frame: &Frame, layer: Layer, p: usize) -> DVec3 {
    let v = frame.get(layer).unwrap();
    DVec3::new(v.get(3 * p), v.get(3 * p + 1), v.get(3 * p + 2))
}

#[test]
fn a_point_out_of_focus_is_a_disk_of_the_diameter_of_the_circle_of_confusion() {
    let (depth, side) = (3.0f32, 0.02f32);
    let spot = quad(Vec3::new(-0.5 * side, depth, -0.5 * side), Vec3::X * side, Vec3::Z * side);
    let s = scene(vec![(spot, glowing())]);
    for (focus, radius) in [(1.5, 0.06), (9.0, 0.08)] {
        let lens = ThinLens { aperture_radius_m: radius, focus_distance_m: focus, blades: 0, focus_tilt_rad: [0.0; 2] };
        let k = Intrinsics { fx: 300.0, fy: 300.0, ..Intrinsics::from_fov_x(65, 65, 1.0) };
        let camera = Camera { lens: Some(lens), ..k.into() };
        let frame = render(
            &s,
            &CameraView::still(&camera, &pose(0, 0.0)),
            &RenderConfig { samples: 2048, adaptive: false, ..RenderConfig::default() },
        );
        // The lens's rays that meet the point leave a disk of the radius f·R·|1/d − 1/F|.
        let expected = 300.0 * radius * (1.0 / f64::from(depth) - 1.0 / focus).abs();
        let (mut sum, mut moment, mut farthest) = (0.0, [0.0; 2], 0.0f64);
        for (y, x) in (0..65).flat_map(|y| (0..65).map(move |x| (y, x))) {
            let (light, at) = (color(&frame, x, y), [x, y].map(|v| f64::from(v) + 0.5 - 32.5));
            sum += light;
            (0..2).for_each(|i| moment[i] += light * at[i] * at[i]);
            farthest = if light > 0.0 { farthest.max(at[0].hypot(at[1])) } else { farthest };
        }
        // Variance of a disk along an axis, of the spot's square, and of the tent filter.
        let spot_px = 300.0 * f64::from(side / depth);
        let variance = expected * expected / 4.0 + spot_px * spot_px / 12.0 + 1.0 / 6.0;
        for m in moment {
            assert!((m / sum / variance - 1.0).abs() < 0.03, "variance {} instead of {variance}", m / sum);
        }
        assert!(farthest < expected + 2f64.sqrt() * (1.0 + spot_px) && farthest > expected - 1.0, "{farthest} for {expected}");
        // The light of the spot is the same, however it is spread: the image of its area.
        assert!((sum / (spot_px * spot_px) - 1.0).abs() < 0.05, "{sum}");
        // Geometry has no blur: the pixels that see the spot are exactly its image.
        let ids = frame.get(Layer::RenderEntityId).unwrap();
        assert!((1..=9).contains(&(0..ids.len()).filter(|&i| ids.get(i) == 1.0).count()));
    }
}

/// A glowing half plane at y = 4 that begins at x = 0.1 and extends to the right.
fn edge() -> Scene {
    scene(vec![(quad(Vec3::new(0.1, 4.0, -50.0), Vec3::X * 100.0, Vec3::Z * 100.0), glowing())])
}

#[test]
fn an_edge_that_moves_during_the_exposure_is_a_linear_ramp() {
    let k = Intrinsics { fx: 80.0, fy: 80.0, ..Intrinsics::from_fov_x(64, 8, 1.0) };
    let shutter = Shutter { exposure_s: 0.25, readout_s: 0.0, frame_time_s: 0.5 };
    let camera = Camera { shutter: Some(shutter), ..k.into() };
    // 1.6 m/s before the frame and after it: 20 pixels · 1.6 · 0.25 = 8 pixels.
    let poses = [pose(0, -0.8), pose(1, 0.0), pose(2, 0.8)];
    let frame = render(&edge(), &CameraView::of_frame(&camera, &poses, 1), &unfiltered(512));
    let edge_px = 32.0 + 80.0 * 0.1 / 4.0;
    for (y, x) in (0..8).flat_map(|y| (0..64).map(move |x| (y, x))) {
        let expected = (0.5 + (f64::from(x) + 0.5 - edge_px) / 8.0).clamp(0.0, 1.0);
        assert!((color(&frame, x, y) - expected).abs() < 4e-3, "pixel {x}: {} instead of {expected}", color(&frame, x, y));
        // Geometry is of the middle of the exposure.
        let id = frame.get(Layer::RenderEntityId).unwrap().get((y * 64 + x) as usize);
        assert_eq!(id == 1.0, f64::from(x) + 0.5 > edge_px, "pixel {x}");
    }
}

#[test]
fn a_rolling_shutter_slants_a_vertical_edge_in_colour_and_geometry_alike() {
    let k = Intrinsics { fx: 80.0, fy: 80.0, ..Intrinsics::from_fov_x(64, 48, 1.0) };
    let shutter = Shutter { exposure_s: 0.0, readout_s: 0.5, frame_time_s: 0.5 };
    let camera = Camera { shutter: Some(shutter), ..k.into() };
    let poses = [pose(0, 0.0), pose(1, 0.8)];
    let view = CameraView::of_frame(&camera, &poses, 0);
    let frame = render(&edge(), &view, &unfiltered(4));
    for (y, x) in (0..48).flat_map(|y| (0..64).map(move |x| (y, x))) {
        // 20 pixels per metre, 1.6 m/s; the row in the middle is exposed at time 0.
        let time = 0.5 * ((f64::from(y) + 0.5) / 48.0 - 0.5);
        let beyond = f64::from(x) + 0.5 - (32.0 + 20.0 * (0.1 - 1.6 * time));
        // On the edge itself either is right.
        if beyond.abs() < 1e-3 {
            continue;
        }
        let (seen, p) = (beyond > 0.0, (y * 64 + x) as usize);
        assert_eq!(frame.get(Layer::RenderEntityId).unwrap().get(p) == 1.0, seen, "pixel ({x}, {y})");
        assert_eq!(color(&frame, x, y), if seen { 1.0 } else { 0.0 });
    }
}

/// A closed room of 4 × 3 × 2.5 m around the origin whose walls are parts of their own.
fn room() -> Scene {
    let (x, y, z) = (Vec3::X * 4.0, Vec3::Y * 3.0, Vec3::Z * 2.5);
    let corner = -0.5 * (x + y + z);
    let walls = [
        quad(corner, x, y),
        quad(corner, y, z),
        quad(corner, z, x),
        quad(corner + x, z, y),
        quad(corner + y, x, z),
        quad(corner + z, y, x),
    ];
    let paint = |i: usize| Material { emission: Rgb::splat(0.2).into(), ..Material::diffuse("paint", Rgb::splat(0.1 + 0.15 * i as f32)) };
    scene(walls.into_iter().enumerate().map(|(i, mesh)| (mesh, paint(i))).collect())
}

/// Distance to the walls of [`room`] from inside.
fn wall_distance(origin: DVec3, direction: DVec3) -> f64 {
    let half = DVec3::new(2.0, 1.5, 1.25);
    ((half * direction.signum() - origin) / direction).min_element()
}

/// One camera of each model, with a lens and a rolling shutter.
fn cameras() -> Vec<Camera> {
    let k = Intrinsics { width: 64, height: 48, fx: 50.0, fy: 52.0, cx: 30.5, cy: 25.0, skew: 0.7 };
    let grid: Vec<DVec3> = (0..7 * 9).map(|i| k.ray(f64::from(i % 9) * 8.0, f64::from(i / 9) * 8.0)).map(|r| r + r * r * 0.03).collect();
    let projections = [
        Projection::Pinhole(k),
        Projection::TiltedPinhole(TiltedPinhole::new(64, 48, DMat3::from_rotation_x(0.2) * k.cam_from_uv()).unwrap()),
        Projection::RadialTangential(k, RadialTangential::new(&[-0.2, 0.05, 0.002, -0.001, 0.01]).unwrap()),
        Projection::Fisheye(Intrinsics { fx: 18.0, fy: 18.0, ..k }, Fisheye::new([-0.1, 0.0, 0.0, 0.0]).unwrap()),
        Projection::Equirectangular { width: 64, height: 48 },
        Projection::RayGrid(RayGrid::new(64, 48, 7, 9, &grid).unwrap()),
    ];
    let lens = ThinLens { aperture_radius_m: 0.03, focus_distance_m: 1.2, blades: 6, focus_tilt_rad: [0.0; 2] };
    let shutter = Shutter { exposure_s: 0.3, readout_s: 0.6, frame_time_s: 1.0 };
    projections.map(|projection| Camera { projection, lens: Some(lens), shutter: Some(shutter) }).into()
}

/// Two poses within [`room`], a step and a turn apart.
fn moving() -> [Pose; 2] {
    let look = |frame, from: DVec3, to: DVec3| Pose::look_at(frame, from, to, DVec3::Z).unwrap();
    let to = DVec3::new(1.5, 1.2, 0.3);
    [look(0, DVec3::new(-0.3, 0.2, 0.1), to), look(1, DVec3::new(0.4, -0.1, 0.0), to + DVec3::X)]
}

#[test]
fn geometry_of_every_model_is_what_the_files_rays_meet() {
    let s = room();
    for camera in cameras() {
        let view = CameraView::of_frame(&camera, &moving(), 0);
        let frame = render(&s, &view, &RenderConfig { samples: 1, ..RenderConfig::default() });
        let mut seen = 0;
        for p in 0..64 * 48 {
            let (x, y) = ((p % 64) as f64 + 0.5, (p / 64) as f64 + 0.5);
            let value = |layer: Layer| frame.get(layer).unwrap().get(p);
            let Some(ray) = view.centre_ray(x, y) else {
                assert_eq!((value(Layer::RenderEntityId), value(Layer::Valid)), (-1.0, f64::from(Validity::Void as u8)));
                assert!(value(Layer::DepthMeters).is_nan() && vector(&frame, Layer::Position, p).is_nan());
                continue;
            };
            seen += 1;
            let distance = wall_distance(ray.origin, ray.direction);
            let (_, world_from_camera) = view.row_placement(y);
            let in_camera = world_from_camera.transpose() * ray.direction;
            assert!((value(Layer::DepthMeters) - distance).abs() < 1e-5, "{camera:?} at {x}, {y}");
            assert!((value(Layer::DepthZMeters) + in_camera.z * distance).abs() < 1e-5);
            let position = vector(&frame, Layer::Position, p);
            assert!((position - (ray.origin + ray.direction * distance)).length() < 1e-5);
            let back = view.project_in_row(position, y).unwrap();
            assert!(camera.projection.image_distance(back, (x, y)) < 1e-3, "{camera:?}: ({x}, {y}) became {back:?}");
            let n_camera = world_from_camera.transpose() * vector(&frame, Layer::NormalWorld, p);
            assert!((n_camera - vector(&frame, Layer::NormalCam, p)).length() < 2e-3);
        }
        assert!(seen == 64 * 48 || matches!(camera.projection, Projection::Fisheye(..)) && seen > 1000, "{seen}");
    }
}

#[test]
fn colour_recomposes_to_the_last_bit_through_lens_and_motion() {
    let s = room();
    for camera in cameras() {
        let frame = render(&s, &CameraView::of_frame(&camera, &moving(), 0), &RenderConfig { samples: 3, ..RenderConfig::default() });
        let layers = [Layer::Color, Layer::DiffuseReflectance, Layer::DiffuseIllumination, Layer::Residual].map(|l| match frame.get(l) {
            Some(Values::F16(values)) => values.clone(),
            _ => panic!("colour is float16"),
        });
        let [color, a, s, r] = layers;
        for i in 0..color.len() {
            assert_eq!(color[i], f16::from_f32(a[i].to_f32() * s[i].to_f32() + r[i].to_f32()));
        }
    }
}

#[test]
fn a_panorama_in_a_glowing_room_has_neither_seam_nor_poles() {
    // From the middle of a cube of one colour every pixel is that colour, and opposite borders see neighbouring points.
    let mut s = room();
    s.materials.iter_mut().for_each(|m| *m = glowing());
    let camera: Camera = Projection::Equirectangular { width: 64, height: 32 }.into();
    let frame = render(&s, &CameraView::still(&camera, &pose(0, 0.0)), &RenderConfig { samples: 4, ..RenderConfig::default() });
    assert!((0..64 * 32).all(|p| color(&frame, p % 64, p / 64) == 1.0));
    let step = |a: usize, b: usize| vector(&frame, Layer::Position, a).distance(vector(&frame, Layer::Position, b));
    for y in 0..32 {
        let (across, beside) = (step(64 * y, 64 * y + 63), step(64 * y, 64 * y + 1));
        assert!(across < 1.5 * beside + 1e-5, "row {y}: {across} m across the seam, {beside} m beside it");
    }
    let behind = frame.get(Layer::DepthZMeters).unwrap().get(64 * 16);
    assert!((behind + 1.5).abs() < 0.02, "straight behind, the wall is at a planar depth of {behind}");
}

#[test]
fn outside_of_the_image_circle_the_picture_is_black_and_void() {
    let mut s = room();
    s.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let k = Intrinsics { fx: 8.0, fy: 8.0, ..Intrinsics::from_fov_x(64, 64, 1.0) };
    let camera: Camera = Projection::Fisheye(k, Fisheye::new([0.0; 4]).unwrap()).into();
    let frame = render(&s, &CameraView::still(&camera, &pose(0, 0.0)), &unfiltered(1));
    for (y, x) in (0..64).flat_map(|y| (0..64).map(move |x| (y, x))) {
        let radius = (f64::from(x) + 0.5 - 32.0).hypot(f64::from(y) + 0.5 - 32.0) / 8.0;
        let inside = radius < std::f64::consts::PI;
        let p = (y * 64 + x) as usize;
        assert_eq!(frame.get(Layer::Valid).unwrap().get(p) != 0.0, inside, "({x}, {y})");
        assert_eq!(color(&frame, x, y) > 0.0, inside);
    }
}

#[test]
fn a_camera_that_cannot_be_is_refused() {
    let s = room();
    let lens = ThinLens { aperture_radius_m: f64::NAN, focus_distance_m: 1.0, blades: 0, focus_tilt_rad: [0.0; 2] };
    let camera = Camera { lens: Some(lens), ..Intrinsics::from_fov_x(8, 8, 1.0).into() };
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let (good, config) = (Camera::from(Intrinsics::from_fov_x(8, 8, 1.0)), RenderConfig::default());
    let guide = Guide::learn(&prepared, &[CameraView::still(&good, &pose(5, 0.0))], &config);
    let error = render_frame(&prepared, &guide, &CameraView::still(&camera, &pose(5, 0.0)), &config, &Quiet).unwrap_err();
    assert!(error.to_string().starts_with("frame 5: the camera is not usable: the camera's aperture_radius_m is NaN"), "{error}");
}
