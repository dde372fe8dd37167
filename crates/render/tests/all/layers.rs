//! Every geometry layer on scenes whose answer is known for each pixel: plane, sphere, corner of a room.

use enfilade_frame::{Frame, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec2, Vec3};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{
    Camera, CameraView, Environment, Image, Intrinsics, Material, NormalMap, Part, Pixels, Pose, Quiet, Scene, TextureRef,
};

fn quad(origin: Vec3, e1: Vec3, e2: Vec3) -> Mesh {
    Mesh {
        positions: vec![origin, origin + e1, origin + e1 + e2, origin + e2],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let mut s = Scene { environment: Some(Environment::Constant { radiance: Rgb::WHITE }), ..Scene::default() };
    s.materials.push(Material::diffuse("grey", Rgb::splat(0.5)));
    for (i, mesh) in meshes.into_iter().enumerate() {
        s.parts.push(Part { name: format!("part {i}"), object: None, mesh: i as u32, material: 0, world_from_mesh: DAffine3::IDENTITY });
        s.meshes.push(mesh.into());
    }
    s.validate().unwrap();
    s
}

/// An off-centre camera with unequal focal lengths: nothing may rely on symmetry.
const CAMERA: Intrinsics = Intrinsics { width: 41, height: 31, fx: 35.0, fy: 38.0, cx: 18.5, cy: 17.0, skew: 0.0 };

fn render(s: &Scene, from: DVec3, to: DVec3) -> (Frame, Pose) {
    let pose = Pose::look_at(0, from, to, DVec3::new(0.05, 0.0, 1.0)).unwrap();
    let config = RenderConfig { samples: 1, ..RenderConfig::default() };
    let prepared = RenderScene::new(s, &Quiet).unwrap();
    let camera = Camera::from(CAMERA);
    let view = CameraView::still(&camera, &pose);
    let guide = Guide::learn(&prepared, &[view], &config);
    (render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap(), pose)
}

fn vector(frame: &Frame, layer: Layer, p: usize) -> DVec3 {
    let v = frame.get(layer).unwrap();
    DVec3::new(v.get(3 * p), v.get(3 * p + 1), v.get(3 * p + 2))
}

fn scalar(frame: &Frame, layer: Layer, p: usize) -> f64 {
    frame.get(layer).unwrap().get(p)
}

/// Checks one pixel's layers against the exact surface point (`None`: nothing there) and its outward normal.
fn check(frame: &Frame, pose: &Pose, p: usize, exact: Option<(DVec3, DVec3, i16)>, tolerance: f64) {
    let Some((point, normal, entity)) = exact else {
        assert_eq!((scalar(frame, Layer::RenderEntityId, p), scalar(frame, Layer::Valid, p)), (-1.0, 0.0));
        assert!(scalar(frame, Layer::DepthMeters, p).is_nan() && scalar(frame, Layer::DepthZMeters, p).is_nan());
        assert!(vector(frame, Layer::Position, p).is_nan() && vector(frame, Layer::NormalCam, p).is_nan());
        return;
    };
    let in_camera = pose.world_from_camera.transpose() * (point - pose.position);
    assert!((vector(frame, Layer::Position, p) - point).length() < tolerance, "{} not {point}", vector(frame, Layer::Position, p));
    assert!((scalar(frame, Layer::DepthMeters, p) - in_camera.length()).abs() < tolerance);
    assert!((scalar(frame, Layer::DepthZMeters, p) + in_camera.z).abs() < tolerance);
    let facing = if normal.dot(point - pose.position) < 0.0 { normal } else { -normal };
    for (world, cam) in [(Layer::NormalWorld, Layer::NormalCam), (Layer::NormalBumpWorld, Layer::NormalBumpCam)] {
        assert!((vector(frame, world, p) - facing).length() < 1e-3 + 10.0 * tolerance, "{} not {facing}", vector(frame, world, p));
        assert!((vector(frame, cam, p) - pose.world_from_camera.transpose() * facing).length() < 1e-3 + 10.0 * tolerance);
    }
    assert_eq!(scalar(frame, Layer::RenderEntityId, p), f64::from(entity));
    // 3 is possible too: at a silhouette the one filtered sample may miss what the pixel's centre hits.
    assert!(scalar(frame, Layer::Valid, p) >= 1.0);
}

fn ray(pose: &Pose, p: usize) -> DVec3 {
    let (x, y) = (p % CAMERA.width as usize, p / CAMERA.width as usize);
    (pose.world_from_camera * CAMERA.ray(x as f64 + 0.5, y as f64 + 0.5)).normalize()
}

#[test]
fn plane_is_exact_and_the_sky_above_it_is_void() {
    let s = scene(vec![quad(Vec3::new(-1000.0, -1000.0, 0.25), Vec3::X * 2000.0, Vec3::Y * 2000.0)]);
    let (frame, pose) = render(&s, DVec3::new(1.0, 2.0, 1.7), DVec3::new(3.0, 5.0, 1.2));
    let mut seen = [0, 0];
    for p in 0..frame.pixels() {
        let d = ray(&pose, p);
        let t = (0.25 - pose.position.z) / d.z;
        let point = pose.position + d * t;
        // Close to the horizon the quad ends.
        if t > 0.0 && point.length() > 900.0 {
            continue;
        }
        let exact = (t > 0.0).then_some((point, DVec3::Z, 1));
        seen[usize::from(exact.is_some())] += 1;
        check(&frame, &pose, p, exact, 1e-5 * t.abs().max(1.0));
        if exact.is_some() {
            let uv = vector(&frame, Layer::TexCoord, p);
            let expected = DVec3::new((point.x + 1000.0) / 2000.0, (point.y + 1000.0) / 2000.0, 0.0);
            assert!((uv - expected).length() < 1e-3, "{uv} not {expected}");
        }
    }
    assert!(seen[0] > 100 && seen[1] > 100, "{seen:?}");
}

#[test]
fn corner_room_shows_three_walls_with_their_ids() {
    let s = scene(vec![
        quad(Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0),
        quad(Vec3::ZERO, Vec3::Y * 4.0, Vec3::Z * 4.0),
        quad(Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0),
    ]);
    let (frame, pose) = render(&s, DVec3::new(2.1, 2.3, 1.9), DVec3::ZERO);
    let mut seen = [0; 3];
    for p in 0..frame.pixels() {
        let d = ray(&pose, p);
        let walls = [(DVec3::Z, 1), (DVec3::X, 2), (DVec3::Y, 3)];
        let (t, n, id) = walls
            .map(|(n, id)| (-pose.position.dot(n) / d.dot(n), n, id))
            .into_iter()
            .filter(|&(t, ..)| t > 0.0)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        seen[id as usize - 1] += 1;
        check(&frame, &pose, p, Some((pose.position + d * t, n, id)), 1e-6 * 5.0);
    }
    assert!(seen.iter().all(|&n| n > 50), "{seen:?}");
}

#[test]
fn sphere_is_as_exact_as_its_triangles() {
    let n = 256u32;
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=2 * n {
            let (theta, phi) = (f64::from(i) / f64::from(n) * std::f64::consts::PI, f64::from(j) / f64::from(n) * std::f64::consts::PI);
            let p = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()).as_vec3();
            mesh.positions.push(p);
            mesh.normals.push(p);
        }
    }
    for i in 0..n {
        for j in 0..2 * n {
            let a = i * (2 * n + 1) + j;
            mesh.triangles.push([a, a + 2 * n + 1, a + 1]);
            mesh.triangles.push([a + 1, a + 2 * n + 1, a + 2 * n + 2]);
        }
    }
    let s = scene(vec![mesh]);
    let (frame, pose) = render(&s, DVec3::new(2.0, -2.0, 0.7), DVec3::new(0.1, 0.0, 0.0));
    let mut seen = [0, 0];
    for p in 0..frame.pixels() {
        let d = ray(&pose, p);
        let b = pose.position.dot(d);
        let discriminant = b * b - (pose.position.length_squared() - 1.0);
        // At the silhouette a polyhedron and a sphere differ.
        if discriminant.abs() < 0.05 {
            continue;
        }
        let exact = (discriminant > 0.0).then(|| {
            let point = pose.position + d * (-b - discriminant.sqrt());
            (point, point, 1)
        });
        seen[usize::from(exact.is_some())] += 1;
        check(&frame, &pose, p, exact, 5e-4);
    }
    assert!(seen[0] > 100 && seen[1] > 100, "{seen:?}");
}

#[test]
fn normal_map_tilts_the_bump_layer_and_leaves_the_other() {
    let mut s = scene(vec![quad(Vec3::new(-9.0, -9.0, 0.0), Vec3::X * 18.0, Vec3::Y * 18.0)]);
    // n = (0.6, 0, 0.8) in tangent space: towards +u, which is +x here.
    let texels = vec![[204, 128, 230, 255]];
    s.images.push(Image { name: "n".into(), width: 1, height: 1, pixels: Pixels::Rgba8 { srgb: false, texels } }.into());
    s.materials[0].normal_map = Some(NormalMap::Normal { texture: TextureRef::new(0), scale: 1.0 });
    let (frame, _) = render(&s, DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.5, 0.0));
    for p in 0..frame.pixels() {
        assert!((vector(&frame, Layer::NormalWorld, p) - DVec3::Z).length() < 1e-3);
        let bumped = vector(&frame, Layer::NormalBumpWorld, p);
        assert!((bumped - DVec3::new(0.6, 0.0, 0.8)).length() < 0.01, "{bumped}");
    }
}

#[test]
fn a_mirrored_part_keeps_its_outside() {
    let mesh = Mesh { normals: vec![Vec3::Z; 4], ..quad(Vec3::ZERO, Vec3::X, Vec3::Y) };
    let mut s = scene(vec![mesh]);
    s.materials[0].two_sided = false;
    // Mirrored in x: winding reversed, normals still up, so that its front is lit and its back black.
    s.parts[0].world_from_mesh = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let radiance = |z: f64| {
        let (frame, _) = render(&s, DVec3::new(-0.5, 0.45, z), DVec3::new(-0.5, 0.5, 0.0));
        let middle = (CAMERA.height / 2 * CAMERA.width + CAMERA.width / 2) as usize;
        vector(&frame, Layer::DiffuseReflectance, middle).x
    };
    assert_eq!((radiance(0.4), radiance(-0.4)), (0.5, 0.0));
}
