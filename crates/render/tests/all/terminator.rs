//! Light on coarse smooth meshes fades by their normals, where their faces alone would cut it off.

use enfilade_frame::{Frame, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Environment, Intrinsics, Light, Material, Part, Pose, Quiet, Scene};
use std::f64::consts::PI;

/// A ball of `2 n²` faces, smooth, of the given radius.
fn ball(n: u32, radius: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for (i, j) in (0..=n).flat_map(|i| (0..2 * n).map(move |j| (i, j))) {
        let (theta, phi) = (f64::from(i) / f64::from(n) * PI, f64::from(j) / f64::from(n) * PI);
        let normal = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()).as_vec3();
        mesh.positions.push(normal * radius);
        mesh.normals.push(normal);
    }
    let index = |i: u32, j: u32| i * 2 * n + j % (2 * n);
    for (i, j) in (0..n).flat_map(|i| (0..2 * n).map(move |j| (i, j))) {
        if i > 0 {
            mesh.triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
        }
        if i + 1 < n {
            mesh.triangles.push([index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]);
        }
    }
    mesh
}

fn add(scene: &mut Scene, mesh: Mesh, material: Material) {
    let (mesh_number, material_number) = (scene.meshes.len() as u32, scene.materials.len() as u32);
    let world_from_mesh = DAffine3::IDENTITY;
    scene.parts.push(Part {
        name: format!("part {mesh_number}"),
        object: None,
        mesh: mesh_number,
        material: material_number,
        world_from_mesh,
    });
    scene.meshes.push(mesh.into());
    scene.materials.push(material);
}

fn picture(scene: &Scene, size: u32, samples: u32) -> Frame {
    scene.validate().unwrap();
    let prepared = RenderScene::new(scene, &Quiet).unwrap();
    let pose = Pose::look_at(0, DVec3::new(0.0, -3.5, 0.3), DVec3::ZERO, DVec3::Z).unwrap();
    let camera = Camera::from(Intrinsics::from_fov_x(size, size, 0.65));
    let (view, config) = (CameraView::still(&camera, &pose), RenderConfig { samples, ..RenderConfig::default() });
    let guide = Guide::learn(&prepared, &[view], &config);
    render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap()
}

#[test]
fn a_coarse_ball_in_the_sun_fades_by_the_cosine() {
    let sun = Vec3::new(1.0, -0.2, 0.4).normalize();
    let mut scene = Scene::default();
    scene.lights.push(Light::Directional { name: "sun".into(), direction: -sun, irradiance: Rgb::WHITE, angular_radius_rad: 0.0 });
    add(&mut scene, ball(8, 1.0), Material::diffuse("chalk", Rgb::splat(0.5)));
    let frame = picture(&scene, 160, 16);
    let (light, normal) = (frame.get(Layer::DiffuseIllumination).unwrap(), frame.get(Layer::NormalWorld).unwrap());
    // The rendered light and Lambert's law for the interpolated normal, by bands of the cosine.
    let mut bands = [(0.05, 0.0, 0.0), (0.1, 0.0, 0.0), (0.2, 0.0, 0.0), (1.0, 0.0, 0.0)];
    for pixel in 0..frame.pixels() {
        let n = DVec3::new(normal.get(3 * pixel), normal.get(3 * pixel + 1), normal.get(3 * pixel + 2));
        let cos = n.dot(sun.as_dvec3());
        if let Some(band) = bands.iter_mut().find(|band| cos > 0.0 && cos < band.0) {
            band.1 += light.get(3 * pixel + 1);
            band.2 += cos / PI;
        }
    }
    for (below, found, expected) in bands {
        assert!(expected > 0.5, "the band below {below} is empty");
        assert!((found / expected - 1.0).abs() < 0.04, "cosines below {below}: {:.3} of Lambert's law", found / expected);
    }
}

#[test]
fn coarse_smooth_balls_keep_all_light_in_a_white_sky() {
    let mut scene = Scene { environment: Some(Environment::Constant { radiance: Rgb::WHITE }), ..Scene::default() };
    add(&mut scene, ball(8, 1.0), Material::diffuse("white", Rgb::WHITE));
    let frame = picture(&scene, 24, 128);
    let color = frame.get(Layer::Color).unwrap();
    let mean = (0..frame.pixels()).map(|p| color.get(3 * p + 1)).sum::<f64>() / frame.pixels() as f64;
    assert!((mean - 1.0).abs() < 5e-3, "{mean}");
}

/// All surfaces glow and reflect half: radiance is 2 everywhere, on the ball as on the walls.
#[test]
fn a_closed_room_with_a_coarse_smooth_ball_keeps_its_light() {
    let mut scene = Scene::default();
    let glowing = |name: &str| Material { emission: Rgb::WHITE.into(), ..Material::diffuse(name, Rgb::splat(0.5)) };
    let mut room = ball(6, 4.0);
    room.normals.clear();
    add(&mut scene, room, Material { emits_both_sides: true, ..glowing("wall") });
    add(&mut scene, ball(8, 1.0), glowing("ball"));
    let frame = picture(&scene, 24, 256);
    let color = frame.get(Layer::Color).unwrap();
    let mean = (0..frame.pixels()).map(|p| color.get(3 * p + 1)).sum::<f64>() / frame.pixels() as f64;
    assert!((mean - 2.0).abs() < 0.02, "{mean}");
}
