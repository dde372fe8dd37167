//! A dataset whose every value follows from a formula: a ball on a square floor under an empty sky.

use enfilade_dataset::{Dataset, FrameInfo, FrameTime};
use enfilade_frame::{Frame, Layer, Validity, Values, f16};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Rng, Vec3};
use enfilade_scene::{Intrinsics, Labels, Material, Part, PartLabel, Pose, Scene, Trajectory};

pub const SCENE: &str = "ball-room";
pub const CAMERA: &str = "cam_00";
const BALL: (DVec3, f64) = (DVec3::new(0.2, -0.1, 0.5), 0.5);
const FLOOR_HALF_M: f64 = 3.0;

/// Floor and ball as parts; the ball's mesh is a placeholder, because no ray is traced.
pub fn scene() -> Scene {
    let h = FLOOR_HALF_M as f32;
    let corners = vec![Vec3::new(-h, -h, 0.0), Vec3::new(h, -h, 0.0), Vec3::new(h, h, 0.0), Vec3::new(-h, h, 0.0)];
    let floor = Mesh { positions: corners, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let ball = Mesh { positions: vec![Vec3::X, Vec3::Y, Vec3::Z], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let part = |name: &str, mesh| Part { name: name.into(), object: None, mesh, material: 0, world_from_mesh: DAffine3::IDENTITY };
    Scene {
        meshes: vec![floor.into(), ball.into()],
        parts: vec![part("floor", 0), part("ball", 1)],
        materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
        ..Scene::default()
    }
}

pub fn labels() -> Labels {
    Labels { parts: vec![PartLabel { semantic: 2, instance: -1 }, PartLabel { semantic: 40, instance: 1 }] }
}

pub fn trajectory(frames: u32) -> Trajectory {
    let pose = |frame: u32| {
        let angle = f64::from(frame) * 0.4;
        let from = DVec3::new(2.5 * angle.cos(), 2.5 * angle.sin(), 1.3);
        Pose::look_at(frame, from, DVec3::new(0.0, 0.0, 0.8), DVec3::Z).expect("not straight down")
    };
    Trajectory { name: CAMERA.into(), poses: (0..frames).map(pose).collect() }
}

/// Nearest hit of a ray with a unit direction: distance, normal, part number.
fn hit(origin: DVec3, direction: DVec3) -> Option<(f64, DVec3, i16)> {
    let to_floor = -origin.z / direction.z;
    let p = origin + direction * to_floor;
    let on_floor = to_floor > 0.0 && p.x.abs() < FLOOR_HALF_M && p.y.abs() < FLOOR_HALF_M;
    let oc = origin - BALL.0;
    let (b, c) = (oc.dot(direction), oc.length_squared() - BALL.1 * BALL.1);
    let ball = (b * b > c).then(|| -b - (b * b - c).sqrt()).filter(|&t| t > 0.0);
    match ball {
        Some(t) if !on_floor || t < to_floor => Some((t, (origin + direction * t - BALL.0) / BALL.1, 2)),
        _ => on_floor.then_some((to_floor, DVec3::Z, 1)),
    }
}

/// All rendered layers from the formulas, colours at random.
pub fn frame(intrinsics: &Intrinsics, pose: &Pose, seed: u64) -> Frame {
    let mut rng = Rng::new(seed).fork(u64::from(pose.frame));
    let pixels = (intrinsics.width * intrinsics.height) as usize;
    let [mut depth, mut depth_z, mut position] = [(); 3].map(|()| Vec::<f32>::with_capacity(3 * pixels));
    let [mut normal_world, mut normal_cam, mut tex, mut color, mut shading, mut albedo, mut residual] =
        [(); 7].map(|()| Vec::<f16>::with_capacity(3 * pixels));
    let (mut ids, mut valid) = (Vec::<i16>::new(), Vec::<u8>::new());
    for (y, x) in (0..intrinsics.height).flat_map(|y| (0..intrinsics.width).map(move |x| (y, x))) {
        let ray = intrinsics.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).normalize();
        let found = hit(pose.position, pose.world_from_camera * ray);
        let (t, n, id) = found.unwrap_or((f64::NAN, DVec3::NAN, -1));
        let p = pose.position + pose.world_from_camera * ray * t;
        depth.push(t as f32);
        depth_z.push((-ray.z * t) as f32);
        position.extend(p.as_vec3().to_array());
        normal_world.extend(n.to_array().map(f16::from_f64));
        normal_cam.extend((pose.world_from_camera.transpose() * n).to_array().map(f16::from_f64));
        tex.extend([if found.is_some() { p.x } else { 0.0 }, if found.is_some() { p.y } else { 0.0 }, 0.0].map(f16::from_f64));
        ids.push(id);
        valid.push(if found.is_some() { Validity::Valid } else { Validity::Void } as u8);
        for _ in 0..3 {
            let [a, s, r] = [1.0, 20.0, 0.1].map(|scale| f16::from_f32(rng.range(0.0, scale)));
            color.push(f16::from_f32(a.to_f32() * s.to_f32() + r.to_f32()));
            albedo.push(a);
            shading.push(s);
            residual.push(r);
        }
    }
    let mut frame = Frame::new(intrinsics.width, intrinsics.height);
    for (layer, values) in [
        (Layer::Color, Values::F16(color)),
        (Layer::DiffuseIllumination, Values::F16(shading)),
        (Layer::DiffuseReflectance, Values::F16(albedo)),
        (Layer::Residual, Values::F16(residual)),
        (Layer::ColorStandardError, Values::F16(vec![f16::from_f32(0.125); frame.pixels()])),
        (Layer::DepthMeters, Values::F32(depth)),
        (Layer::DepthZMeters, Values::F32(depth_z)),
        (Layer::Position, Values::F32(position)),
        (Layer::NormalBumpWorld, Values::F16(normal_world.clone())),
        (Layer::NormalBumpCam, Values::F16(normal_cam.clone())),
        (Layer::NormalWorld, Values::F16(normal_world)),
        (Layer::NormalCam, Values::F16(normal_cam)),
        (Layer::TexCoord, Values::F16(tex)),
        (Layer::RenderEntityId, Values::I16(ids)),
        (Layer::Valid, Values::U8(valid)),
    ] {
        frame.insert(layer, values);
    }
    frame
}

/// The label layers of a rendered frame.
pub fn label_frame(frame: &Frame) -> Frame {
    let Some(Values::I16(ids)) = frame.get(Layer::RenderEntityId) else { panic!("no ids") };
    let labels = labels();
    let join = |of: fn(&PartLabel) -> i16| ids.iter().map(|&id| if id < 1 { -1 } else { of(&labels.parts[id as usize - 1]) }).collect();
    let mut joined = Frame::new(frame.width, frame.height);
    joined.insert(Layer::Semantic, Values::I16(join(|label| label.semantic)));
    joined.insert(Layer::SemanticInstance, Values::I16(join(|label| label.instance)));
    joined
}

pub fn info(intrinsics: &Intrinsics, pose: &Pose) -> FrameInfo {
    FrameInfo { seed: 7, samples: 1, config_hash: "c0ffee".into(), pose: *pose, camera: (*intrinsics).into(), sampling: None, recipe: None }
}

/// A whole dataset of `frames` frames, of which the last stays unrendered.
pub fn write(dataset: &Dataset, intrinsics: &Intrinsics, frames: u32) {
    let trajectory = trajectory(frames);
    dataset.write_scene(SCENE, &scene()).unwrap();
    dataset.write_camera_parameters(SCENE, &(*intrinsics).into()).unwrap();
    dataset.write_trajectory(SCENE, &trajectory, &(*intrinsics).into(), None).unwrap();
    dataset.write_label_tables(SCENE, &labels()).unwrap();
    for pose in &trajectory.poses[..frames as usize - 1] {
        let picture = frame(intrinsics, pose, 7);
        dataset
            .write_frame(SCENE, CAMERA, &picture, &info(intrinsics, pose), FrameTime { wall_s: 0.5, cpu_s: 1.0, ..FrameTime::default() })
            .unwrap();
        dataset.write_label_layers(SCENE, CAMERA, pose.frame, &label_frame(&picture), "beef").unwrap();
    }
}
