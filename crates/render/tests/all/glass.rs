//! Light through solid glass, against what the laws of optics give in closed form or by quadrature.

use enfilade_frame::{Frame, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Mat3, Rgb, Vec3};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{
    Bsdf, Camera, CameraView, Environment, Image, Intrinsics, Light, MapRows, Material, Part, Pixels, Pose, Quiet, Scene,
};
use std::f64::consts::PI;

const ETA: f64 = 1.5;

/// A box with outward normals.
fn block(min: [f32; 3], max: [f32; 3]) -> Mesh {
    let corner = |i: usize| Vec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { max[axis] } else { min[axis] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut mesh = Mesh::default();
    for face in faces {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(face.map(corner));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

/// A rectangle that faces up, or down.
fn sheet(half: f32, z: f32, up: bool) -> Mesh {
    let mut positions = [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]].map(Vec3::from).to_vec();
    if !up {
        positions.reverse();
    }
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

/// A ball with smooth normals.
fn ball(center: Vec3, radius: f32) -> Mesh {
    let (rows, columns) = (96u32, 192u32);
    let mut mesh = Mesh::default();
    for i in 0..=rows {
        for j in 0..columns {
            let (theta, phi) = (f64::from(i) / f64::from(rows) * PI, f64::from(j) / f64::from(columns) * 2.0 * PI);
            // Its poles are off the axes, so that no axis of a test passes through one.
            let n = DVec3::new(theta.cos(), theta.sin() * phi.cos(), theta.sin() * phi.sin()).as_vec3();
            mesh.positions.push(center + n * radius);
            mesh.normals.push(n);
        }
    }
    let index = |i: u32, j: u32| i * columns + j % columns;
    for i in 0..rows {
        for j in 0..columns {
            if i > 0 {
                mesh.triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
            }
            if i + 1 < rows {
                mesh.triangles.push([index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]);
            }
        }
    }
    mesh
}

fn glass(absorption: f32) -> Material {
    let body =
        Bsdf::Dielectric { eta: ETA as f32, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::splat(absorption) };
    Material::new("glass", body)
}

/// A grey floor at z = 0 below things of some materials.
fn above_floor(things: Vec<(Mesh, Material)>) -> Scene {
    let mut scene = Scene::default();
    let floor = (sheet(100.0, 0.0, true), Material::diffuse("floor", Rgb::splat(0.5)));
    for (mesh, material) in std::iter::once(floor).chain(things) {
        let number = scene.parts.len() as u32;
        scene.parts.push(Part {
            name: format!("part {number}"),
            object: None,
            mesh: number,
            material: number,
            world_from_mesh: DAffine3::IDENTITY,
        });
        scene.meshes.push(mesh.into());
        scene.materials.push(material);
    }
    scene
}

/// A picture of the floor about (x, 0, 0), from below everything.
fn floor_at(scene: &Scene, x: f64, config: &RenderConfig) -> Frame {
    scene.validate().unwrap();
    let prepared = RenderScene::new(scene, &Quiet).unwrap();
    let pose = Pose::look_at(0, DVec3::new(x + 0.1, 0.05, 0.2), DVec3::new(x, 0.0, 0.0), DVec3::Y).unwrap();
    let camera = Camera::from(Intrinsics::from_fov_x(8, 8, 0.01));
    let view = CameraView::still(&camera, &pose);
    let guide = Guide::learn(&prepared, &[view], config);
    render_frame(&prepared, &guide, &view, config, &Quiet).unwrap()
}

/// Direct light alone.
fn direct(samples: u32) -> RenderConfig {
    RenderConfig { samples, max_bounces: Some(0), ..RenderConfig::default() }
}

fn illumination(frame: &Frame) -> f64 {
    let values = frame.get(Layer::DiffuseIllumination).unwrap();
    (0..frame.pixels()).map(|p| values.get(3 * p)).sum::<f64>() / frame.pixels() as f64
}

fn assert_close(what: &str, found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{what}: found {found}, expected {expected} ± {}%", 100.0 * relative);
}

/// Fresnel's equations for unpolarized light, and the cosine within the glass.
fn fresnel(cos: f64) -> (f64, f64) {
    let inner = (1.0 - (1.0 - cos * cos) / (ETA * ETA)).sqrt();
    let across = (cos - ETA * inner) / (cos + ETA * inner);
    let along = (ETA * cos - inner) / (ETA * cos + inner);
    (0.5 * (across * across + along * along), inner)
}

/// Transmittance of a pane at a cosine: Fresnel's losses at both faces, Beer's absorption, and all reflections between the faces.
fn pane_passes(cos: f64, thickness: f64, absorption: f64) -> f64 {
    let (r, inner) = fresnel(cos);
    let a = (-absorption * thickness / inner).exp();
    (1.0 - r).powi(2) * a / (1.0 - (r * a).powi(2))
}

/// Transmittance of a pane for uniform light onto a parallel surface.
fn diffuse_passes(thickness: f64, absorption: f64) -> f64 {
    let n = 100_000;
    (0..n).map(|i| pane_passes((1.0 - (f64::from(i) + 0.5) / f64::from(n)).sqrt(), thickness, absorption) / f64::from(n)).sum()
}

fn sun(angle_deg: f64, radius: f32) -> Light {
    let angle = angle_deg.to_radians();
    let direction = DVec3::new(angle.sin(), 0.0, -angle.cos()).as_vec3();
    Light::Directional { name: "sun".into(), direction, irradiance: Rgb::WHITE, angular_radius_rad: radius }
}

#[test]
fn the_sun_behind_a_pane_is_dimmed_by_fresnel_and_beer() {
    for (thickness, absorption) in [(0.006f32, 0.0f32), (0.02, 20.0), (0.2, 3.0)] {
        let mut scene = above_floor(vec![(block([-60.0, -60.0, 1.0], [60.0, 60.0, 1.0 + thickness]), glass(absorption))]);
        for angle in [0.0f64, 45.0, 60.0, 75.0, 85.0] {
            let cos = angle.to_radians().cos();
            let expected = cos / PI * pane_passes(cos, thickness.into(), absorption.into());
            for (radius, samples, tolerance) in [(0.0, 4, 2e-3), (0.004_65, 64, 0.01)] {
                scene.lights = vec![sun(angle, radius)];
                let found = illumination(&floor_at(&scene, 0.0, &direct(samples)));
                assert_close(&format!("{angle}°, {thickness} m, {absorption}/m, radius {radius}"), found, expected, tolerance);
            }
        }
    }
}

#[test]
fn two_tilted_panes_pass_the_product_of_both() {
    // Panes with a picture's usual numbers: 4 mm each, turned by 20° and −35° about y.
    let turned = |angle_deg: f32, z: f32| {
        let turn = Mat3::from_rotation_y(angle_deg.to_radians());
        let mut mesh = block([-5.0, -5.0, 0.0], [5.0, 5.0, 0.004]);
        mesh.positions.iter_mut().for_each(|p| *p = turn * *p + Vec3::new(0.0, 0.0, z));
        (mesh, glass(0.0))
    };
    let mut scene = above_floor(vec![turned(20.0, 3.0), turned(-35.0, 8.0)]);
    scene.lights = vec![sun(10.0, 0.0)];
    let cosine = |tilt: f64| (10.0f64 + tilt).to_radians().cos();
    let passes = |tilt: f64| pane_passes(cosine(tilt), 0.004, 0.0);
    let found = illumination(&floor_at(&scene, 0.0, &direct(4)));
    assert_close("two panes", found, 10.0f64.to_radians().cos() / PI * passes(20.0) * passes(-35.0), 2e-3);
}

/// The light of a lamp that a thick block shifts: the angle by bisection, its spread by a difference.
fn lamp_above_block(x: f64, height: f64, thickness: f64) -> f64 {
    let reach = |angle: f64| {
        let inner = (angle.sin() / ETA).asin();
        (height - thickness) * angle.tan() + thickness * inner.tan()
    };
    let (mut low, mut high) = (0.0, 0.5 * PI - 1e-9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if reach(middle) < x { low = middle } else { high = middle }
    }
    let (angle, step) = (low, 1e-5);
    let spread = if x == 0.0 {
        (step / reach(step)).powi(2)
    } else {
        angle.sin() / (x * (reach(angle + step) - reach(angle - step)) / (2.0 * step))
    };
    spread * pane_passes(angle.cos(), thickness, 0.0) / PI
}

#[test]
fn a_lamp_behind_a_thick_block_is_found_where_its_light_comes_from() {
    let mut scene = above_floor(vec![(block([-40.0, -40.0, 0.5], [40.0, 40.0, 1.1]), glass(0.0))]);
    scene.lights = vec![Light::Point { name: "lamp".into(), position: Vec3::new(0.0, 0.0, 1.6), intensity: Rgb::WHITE }];
    for x in [0.0, 0.7, 2.0, 5.0] {
        let found = illumination(&floor_at(&scene, x, &direct(4)));
        assert_close(&format!("{x} m aside"), found, lamp_above_block(x, 1.6, 0.6), 4e-3);
    }
}

#[test]
fn a_bright_ceiling_behind_a_thick_block_counts_once() {
    // A square of side 1 whose light arrives in the directions that the block shifts to it, added up over all directions.
    let (height, thickness, half) = (1.6f64, 0.6f64, 0.5f64);
    let (n, m) = (4000, 720);
    let mut expected = 0.0;
    for i in 0..n {
        let sine_2 = (f64::from(i) + 0.5) / f64::from(n);
        let (sin, cos) = (sine_2.sqrt(), (1.0 - sine_2).sqrt());
        let (_, inner) = fresnel(cos);
        let reach = (height - thickness) * sin / cos + thickness * (sin / ETA) / inner;
        let inside = (0..m).filter(|&j| {
            let phi = (f64::from(j) + 0.5) / f64::from(m) * 2.0 * PI;
            (reach * phi.cos()).abs() < half && (reach * phi.sin()).abs() < half
        });
        expected += inside.count() as f64 / f64::from(m) * pane_passes(cos, thickness, 0.0) / f64::from(n);
    }
    let lamp = Material::emitter("lamp", Rgb::WHITE);
    let scene = above_floor(vec![
        (block([-40.0, -40.0, 0.5], [40.0, 40.0, 0.5 + thickness as f32]), glass(0.0)),
        (sheet(half as f32, height as f32, false), lamp),
    ]);
    assert_close("direct light", illumination(&floor_at(&scene, 0.0, &direct(1024))), expected, 0.01);
    // Without a limit the floor sees itself in the block as well, so only little more comes.
    let all = illumination(&floor_at(&scene, 0.0, &RenderConfig { samples: 1024, ..RenderConfig::default() }));
    assert!(all > expected && all < 1.12 * expected, "{all} for {expected}");
}

/// Irradiance over π at (x, 0, 0) by a lamp at a height, `lamp` wide along x and from −1 to 1 along y, behind a block that fills x > 0 and
/// whose face at x = 0 is opaque: the part that arrives past the block, and the part through it.
fn lamp_beside_the_edge(x: f64, lamp: [f64; 2], [bottom, top, height]: [f64; 3]) -> [f64; 2] {
    // Points of the plane of the lamp, each seen past the edge in one direction; then directions, each shifted to one point.
    let (n, mut found) = (2000, [0.0; 2]);
    let cell = [(lamp[1] - lamp[0]) / f64::from(n), 2.0 / f64::from(n)];
    let at = |i: u32, from: f64, size: f64| from + (f64::from(i) + 0.5) * size;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let to = DVec3::new(at(i, lamp[0], cell[0]) - x, at(j, -1.0, cell[1]), height);
        if -x / to.x * height > top {
            found[0] += height * height / to.length_squared().powi(2) * cell[0] * cell[1] / PI;
        }
    }
    let size = 6.0 / f64::from(n);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let aside = DVec3::new(at(i, 0.0, size), at(j, -3.0, size), 1.0);
        let cos = 1.0 / aside.length();
        let inner = (1.0 - (1.0 - cos * cos) / (ETA * ETA)).sqrt();
        let reach = height - (top - bottom) * (1.0 - cos / (ETA * inner));
        let [enters, ends] = [x + aside.x * bottom, x + aside.x * reach];
        if enters > 0.0 && ends > lamp[0] && ends < lamp[1] && (aside.y * reach).abs() < 1.0 {
            found[1] += cos.powi(4) * pane_passes(cos, top - bottom, 0.0) * size * size / PI;
        }
    }
    found
}

#[test]
fn a_lamp_that_only_a_thick_block_shifts_into_view_is_not_lost() {
    let (x, lamp, heights) = (-0.5, [0.7, 1.1], [1.0, 1.6, 3.0]);
    let expected = lamp_beside_the_edge(x, lamp, heights);
    assert!(expected[0] == 0.0 && expected[1] > 0.0, "{expected:?}");
    // A third of it comes from points that are behind the black face along a straight line.
    let mut emitter = Material::diffuse("lamp", Rgb::BLACK);
    emitter.emission = Rgb::WHITE.into();
    let [left, right] = lamp.map(|x| x as f32);
    let corners = [[left, -1.0, 3.0], [left, 1.0, 3.0], [right, 1.0, 3.0], [right, -1.0, 3.0]].map(Vec3::from).to_vec();
    let lamp = Mesh { positions: corners, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let face = block([-0.01, -9.0, 1.0], [-1e-4, 9.0, 1.6]);
    let things =
        vec![(block([0.0, -9.0, 1.0], [9.0, 9.0, 1.6]), glass(0.0)), (face, Material::diffuse("face", Rgb::BLACK)), (lamp, emitter)];
    let found = illumination(&floor_at(&above_floor(things), x, &direct(1024)));
    assert_close("beside the edge", found, expected[1], 0.01);
}

#[test]
fn a_white_sky_behind_a_pane_counts_once() {
    let mut scene = above_floor(vec![(block([-60.0, -60.0, 1.0], [60.0, 60.0, 1.006]), glass(30.0))]);
    scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let expected = diffuse_passes(0.006, 30.0);
    assert_close("sky", illumination(&floor_at(&scene, 0.0, &direct(1024))), expected, 0.01);
}

#[test]
fn the_sun_of_a_picture_of_the_sky_is_found_behind_a_pane_without_fireflies() {
    let (width, height) = (512u32, 256u32);
    let mut texels = vec![[0.05f32; 3]; (width * height) as usize];
    texels[(60 * width + 200) as usize] = [40_000.0; 3];
    let lit = |panes| {
        let mut scene = above_floor(panes);
        scene.images = vec![Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels.clone()) }.into()];
        let map_from_world = Mat3::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        scene.environment = Some(Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world });
        floor_at(&scene, 0.0, &RenderConfig { samples: 256, ..RenderConfig::default() })
    };
    let open = illumination(&lit(vec![]));
    let behind = lit(vec![(block([-60.0, -60.0, 1.0], [60.0, 60.0, 1.02]), glass(0.0))]);
    // The texel's middle is 60.5/256 of the way down from the zenith. What the floor of a half sends up, the pane reflects in part.
    let reflected = 1.0 - diffuse_passes(0.02, 0.0);
    let expected = pane_passes((60.5 / 256.0 * PI).cos(), 0.02, 0.0) / (1.0 - 0.5 * reflected);
    let found = illumination(&behind);
    assert_close("behind the pane", found / open, expected, 0.01);
    let values = behind.get(Layer::Color).unwrap();
    let brightest = (0..behind.pixels()).map(|p| values.get(3 * p)).fold(0.0, f64::max);
    assert!(brightest < 2.0 * 0.5 * found, "{brightest} beside {found}");
}

#[test]
fn in_a_white_furnace_panes_and_what_lies_behind_them_vanish() {
    // Everything sends out one: the floor by what it emits beside what it reflects.
    let panes = vec![
        (block([-1.0, -1.0, 0.2], [1.0, 1.0, 0.3]), glass(0.0)),
        (block([-1.0, 0.5, 0.4], [1.0, 0.6, 1.4]), glass(0.0)),
        (ball(Vec3::new(0.3, -0.4, 0.8), 0.3), glass(0.0)),
    ];
    let mut scene = above_floor(panes);
    scene.materials[0] = Material { emission: Rgb::splat(0.3).into(), ..Material::diffuse("floor", Rgb::splat(0.7)) };
    scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    let camera = Camera::from(Intrinsics::from_fov_x(24, 24, 1.0));
    let pose = Pose::look_at(0, DVec3::new(2.0, -2.0, 1.5), DVec3::new(0.0, 0.0, 0.3), DVec3::Z).unwrap();
    let view = CameraView::still(&camera, &pose);
    for max_bounces in [None, Some(40)] {
        let config = RenderConfig { samples: 64, max_bounces, ..RenderConfig::default() };
        let guide = Guide::learn(&prepared, &[view], &config);
        let frame = render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap();
        let values = frame.get(Layer::Color).unwrap();
        let mean = (0..frame.pixels()).map(|p| values.get(3 * p)).sum::<f64>() / frame.pixels() as f64;
        assert_close(&format!("furnace, {max_bounces:?}"), mean, 1.0, 0.01);
    }
}

#[test]
fn a_lamp_within_glass_shines_out_of_it() {
    // In the middle of a ball no ray is bent; one reflection of 4 % is lost from this way.
    let lamp = |position: Vec3| vec![Light::Point { name: "lamp".into(), position, intensity: Rgb::WHITE }];
    let mut scene = above_floor(vec![(ball(Vec3::new(0.0, 0.0, 2.0), 0.3), glass(1.0))]);
    scene.lights = lamp(Vec3::new(0.0, 0.0, 2.0));
    let in_the_middle = 0.96 * (-0.3f64).exp() / 4.0 / PI;
    assert_close("middle", illumination(&floor_at(&scene, 0.0, &direct(64))), in_the_middle, 0.02);

    // Nearer to the lower side, by rays near the axis: an angle of ψ meets the ball at a height of ψ · 0.1 and is bent there.
    scene.lights = lamp(Vec3::new(0.0, 0.0, 1.8));
    let psi = 1e-5f64;
    let across = psi * 0.1;
    let normal = across / 0.3;
    let bent = ETA * (psi - normal) + normal;
    let reach = across + bent * 1.7;
    assert_close("aside", illumination(&floor_at(&scene, 0.0, &direct(64))), 0.96 * (-0.1f64).exp() * (psi / reach).powi(2) / PI, 0.02);

    // In a block, as if it were farther away: below its middle only through the lower face.
    let mut scene = above_floor(vec![(block([-0.2, -0.2, 1.8], [0.2, 0.2, 2.2]), glass(0.0))]);
    scene.lights = lamp(Vec3::new(0.0, 0.0, 2.0));
    assert_close("block", illumination(&floor_at(&scene, 0.0, &direct(64))), 0.96 / (1.8 * ETA + 0.2).powi(2) / PI, 0.02);
}

#[test]
fn a_lamp_in_a_hollow_globe_shines_through_both_sides_of_the_glass() {
    let center = Vec3::new(0.0, 0.0, 2.0);
    let mut hollow = ball(center, 0.25);
    hollow.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    hollow.normals.iter_mut().for_each(|n| *n = -*n);
    let mut globe = ball(center, 0.3);
    globe.append(&hollow);
    let mut scene = above_floor(vec![(globe, glass(0.0))]);
    scene.lights = vec![Light::Point { name: "lamp".into(), position: center, intensity: Rgb::WHITE }];
    assert_close("globe", illumination(&floor_at(&scene, 0.0, &direct(64))), 0.96 * 0.96 / 4.0 / PI, 0.02);
    // Here a straight line at 45° also passes through it.
    assert_close("globe aside", illumination(&floor_at(&scene, 2.0, &direct(64))), 0.96 * 0.96 / 8.0 * 0.5f64.sqrt() / PI, 0.02);
}

/// A closed body of flat facets: rows of quadrilaterals on a sphere, without normals.
fn faceted_ball(center: Vec3, radius: f32, columns: u32, rows: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=rows {
        for j in 0..columns {
            let (theta, phi) = (f64::from(i) / f64::from(rows) * PI, f64::from(j) / f64::from(columns) * 2.0 * PI);
            let n = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()).as_vec3();
            mesh.positions.push(center + n * radius);
        }
    }
    let index = |i: u32, j: u32| i * columns + j % columns;
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        if i > 0 {
            mesh.triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
        }
        if i + 1 < rows {
            mesh.triangles.push([index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]);
        }
    }
    mesh
}

/// Where a ray from a place in a direction next meets a surface, as a distance, and its outward normal there.
type Meet<'a> = &'a dyn Fn(DVec3, DVec3) -> Option<(f64, DVec3)>;

fn meet_faces(body: &Mesh) -> impl Fn(DVec3, DVec3) -> Option<(f64, DVec3)> {
    let corners: Vec<[DVec3; 3]> = body.triangles.iter().map(|t| t.map(|k| body.positions[k as usize].as_dvec3())).collect();
    move |from, d| {
        let hits = corners.iter().filter_map(|&[a, b, c]| {
            let n = (b - a).cross(c - a).normalize();
            let t = (a - from).dot(n) / d.dot(n);
            let p = from + d * t;
            let inside = [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| (v - u).cross(p - u).dot(n) >= 0.0);
            (t > 1e-9 && inside).then_some((t, n))
        });
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

fn meet_ball(center: DVec3, radius: f64) -> impl Fn(DVec3, DVec3) -> Option<(f64, DVec3)> {
    move |from, d| {
        let (along, away) = ((center - from).dot(d), (center - from).length_squared());
        let half = (radius * radius - away + along * along).sqrt();
        let t = [along - half, along + half].into_iter().find(|&t| t > 1e-9)?;
        Some((t, (from + d * t - center) / radius))
    }
}

/// Mean of what comes through a closed convex body of clear glass from a point lamp to rings of `width` on the floor, over what arrives
/// without the body: light is followed from the lamp, towards directions with a cosine of at least `flattest` with the vertical.
fn photons_through(meet: Meet<'_>, lamp: DVec3, flattest: f64, rings: usize, width: f64, photons: u32) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; rings];
    let mut add = |p: DVec3, light: f64, k: usize| {
        if let Some(sum) = sums.get_mut((p.truncate().length() / width) as usize) {
            sum[k] += light;
        }
    };
    for i in 0..photons {
        // Points of a lattice (R2) over the cap of directions.
        let [u, v] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2].map(|step| (f64::from(i) * step).fract());
        let (cos, phi) = (flattest + (1.0 - flattest) * u, v * 2.0 * PI);
        let sin = (1.0 - cos * cos).sqrt();
        let (mut p, mut d, mut light) = (lamp, DVec3::new(sin * phi.cos(), sin * phi.sin(), -cos), 1.0);
        add(p + d * (p.z / cos), 1.0, 1);
        while let Some((t, n)) = meet(p, d) {
            p += d * t;
            let leaves = d.dot(n) > 0.0;
            let (n, eta) = if leaves { (-n, 1.0 / ETA) } else { (n, ETA) };
            let cos_in = -d.dot(n);
            let square = 1.0 - (1.0 - cos_in * cos_in) / (eta * eta);
            if square <= 0.0 {
                light = 0.0;
                break;
            }
            let cos_out = square.sqrt();
            let across = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
            let along = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
            light *= 1.0 - 0.5 * (across * across + along * along);
            d = (d / eta + n * (cos_in / eta - cos_out)).normalize();
        }
        if d.z < 0.0 {
            add(p - d * (p.z / d.z), light, 0);
        }
    }
    sums.iter().map(|[through, open]| through / open).collect()
}

/// Illumination of rings of `width` on the floor over what arrives there of a lamp at `lamp` if nothing is in its way.
fn rings_on_floor(scene: &Scene, lamp: DVec3, camera: DVec3, rings: usize, width: f64, samples: u32) -> Vec<f64> {
    scene.validate().unwrap();
    let prepared = RenderScene::new(scene, &Quiet).unwrap();
    let pose = Pose::look_at(0, camera, DVec3::new(0.0, 0.0, 0.0), DVec3::Y).unwrap();
    let view_angle = 2.0 * (rings as f64 * width / camera.z).atan();
    let view_camera = Camera::from(Intrinsics::from_fov_x(128, 128, view_angle));
    let view = CameraView::still(&view_camera, &pose);
    let config = direct(samples);
    let guide = Guide::learn(&prepared, &[view], &config);
    let frame = render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap();
    let (light, place) = (frame.get(Layer::DiffuseIllumination).unwrap(), frame.get(Layer::Position).unwrap());
    let mut sums = vec![[0.0; 2]; rings];
    for p in 0..frame.pixels() {
        let x = place.get(3 * p).hypot(place.get(3 * p + 1));
        if let Some(sum) = sums.get_mut((x / width) as usize) {
            sum[0] += light.get(3 * p);
            sum[1] += lamp.z / (lamp.z * lamp.z + x * x).powf(1.5) / PI;
        }
    }
    sums.iter().map(|[light, open]| light / open).collect()
}

#[test]
fn a_lamp_within_a_ball_of_flat_facets_shines_out_of_it() {
    // Below its pole all 48 facets of a row show the lamp at once.
    let center = DVec3::new(0.0, 0.0, 1.0);
    let body = faceted_ball(center.as_vec3(), 0.1, 48, 24);
    let expected = photons_through(&meet_faces(&body), center, 0.5, 5, 0.1, 20_000);
    let mut scene = above_floor(vec![(body, glass(0.0))]);
    scene.lights = vec![Light::Point { name: "lamp".into(), position: center.as_vec3(), intensity: Rgb::WHITE }];
    let found = rings_on_floor(&scene, center, DVec3::new(0.0, 0.0, 0.8), 5, 0.1, 16);
    for (ring, (found, expected)) in found.into_iter().zip(expected).enumerate() {
        assert_close(&format!("ring {ring}"), found, expected, 0.04);
    }
}

#[test]
fn a_ball_throws_the_light_of_a_lamp_beyond_its_shadow() {
    // Its shadow ends at 0.15 m.
    let (center, lamp) = (DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 1.5));
    let expected = photons_through(&meet_ball(center, 0.1), lamp, 0.8, 10, 0.05, 200_000);
    let mut scene = above_floor(vec![(ball(center.as_vec3(), 0.1), glass(0.0))]);
    scene.lights = vec![Light::Point { name: "lamp".into(), position: lamp.as_vec3(), intensity: Rgb::WHITE }];
    let found = rings_on_floor(&scene, lamp, DVec3::new(0.0, 0.0, 0.38), 10, 0.05, 16);
    for (ring, (found, expected)) in found.into_iter().zip(expected).enumerate() {
        // A ring with an edge in it depends on the pixels.
        let tolerance = if ring == 2 { 0.15 } else { 0.03 };
        assert_close(&format!("ring {ring}"), found, expected, tolerance);
    }
}
