//! Light sampling as a whole: what is sampled agrees with its density, and rooms are lit as they should be.

use super::choice::{Arrival, LightChoice};
use super::sample::{LightPoint, power_heuristic};
use crate::prepared::{AlphaTest, RenderScene};
use crate::texture::{Cone, Footprint};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Ray, Rgb, Rng, Vec2, Vec3, warp};
use enfilade_scene::{ColorParam, Image, Material, Part, Pixels, Quiet, Scene, TextureRef};
use enfilade_testkit::Mean;

fn scene_of(parts: Vec<(Mesh, Material)>) -> Scene {
    let mut scene = Scene::default();
    for (index, (mesh, material)) in parts.into_iter().enumerate() {
        let (mesh_index, material_index) = (index as u32, index as u32);
        let name = format!("part {index}");
        scene.parts.push(Part { name, object: None, mesh: mesh_index, material: material_index, world_from_mesh: DAffine3::IDENTITY });
        scene.meshes.push(mesh.into());
        scene.materials.push(material);
    }
    scene
}

fn quad(corner: Vec3, u: Vec3, v: Vec3) -> Mesh {
    Mesh {
        positions: vec![corner, corner + u, corner + u + v, corner + v],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// The choice learned from a few dozen trials of each source at a point.
fn learned_at(scene: &RenderScene<'_>, at: &LightPoint) -> LightChoice {
    let mut rng = Rng::new(17);
    let sources = scene.lights.source_count(0);
    let arrivals: Vec<Arrival> = (0..sources * 40)
        .map(|k| {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            let light = scene.lights.sample_source(scene, scene.lights.source(k % sources), None, at, u, |wi| wi.dot(at.n) > 0.0);
            let value = light.map_or(0.0, |l| scene.lights.radiance_of(scene, &l, &Cone::POINT, 0.5).luminance() * l.wi.dot(at.n) / l.pdf);
            Arrival { at: *at, source: (k % sources) as u32, value }
        })
        .collect();
    LightChoice::from_arrivals(&scene.lights, None, &arrivals)
}

/// Irradiance by a polygon of unit radiance that is above the horizon (Lambert 1760): half the sum of its edges' angles, each
/// times the cosine of the normal of the plane through edge and eye.
fn by_polygon(at: &LightPoint, corners: &[Vec3]) -> f64 {
    let sum: f64 = (0..corners.len())
        .map(|i| {
            let a = (corners[i] - at.p).as_dvec3().normalize();
            let b = (corners[(i + 1) % corners.len()] - at.p).as_dvec3().normalize();
            let across = a.cross(b);
            across.length().atan2(a.dot(b)) * across.normalize().dot(at.n.as_dvec3())
        })
        .sum();
    0.5 * sum.abs()
}

/// Unoccluded irradiance estimates, luminance, and their mean.
fn irradiance(scene: &RenderScene<'_>, choice: &LightChoice, at: &LightPoint, samples: u32) -> Mean {
    let mut rng = Rng::new(11);
    let n = at.n;
    Mean::of((0..samples).map(|_| {
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let light = scene.lights.sample(scene, choice, at, u, |wi| wi.dot(n) > 0.0);
        light.map_or(0.0, |l| f64::from(scene.lights.radiance_of(scene, &l, &Cone::POINT, 0.5).luminance() * l.wi.dot(n) / l.pdf))
    }))
}

/// The relative standard deviation of one sample.
fn noise(mean: &Mean, samples: u32) -> f64 {
    mean.standard_error() * f64::from(samples).sqrt() / mean.value()
}

/// Thousands of small squares and triangles under a ceiling at 3 m, of unlike power, all facing down.
fn many_lamps(count: usize) -> (Scene, Vec<Vec<Vec3>>, Vec<f64>) {
    let mut rng = Rng::new(21);
    let (mut parts, mut polygons, mut radiances) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..count {
        let corner = Vec3::new(rng.next_f32() * 20.0, rng.next_f32() * 20.0, 2.6 + 0.4 * rng.next_f32());
        let size = 0.02 + 0.1 * rng.next_f32();
        let (u, v) = (Vec3::Y * size, Vec3::X * size);
        let radiance = 0.1 + 50.0 * rng.next_f32().powi(6);
        let mut mesh = quad(corner, u, v);
        let mut polygon = mesh.positions.clone();
        if i % 3 == 0 {
            mesh.triangles.truncate(1);
            polygon.truncate(3);
        }
        parts.push((mesh, Material::emitter("lamp", Rgb::splat(radiance))));
        polygons.push(polygon);
        radiances.push(f64::from(radiance));
    }
    (scene_of(parts), polygons, radiances)
}

#[test]
fn thousands_of_lamps_give_the_light_of_lamberts_formula_with_little_noise() {
    let (scene, polygons, radiances) = many_lamps(4000);
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    let normals = [Vec3::Z, Vec3::new(0.1, 0.05, 1.0).normalize(), Vec3::Z, Vec3::Z];
    let places = [Vec3::new(10.0, 10.0, 0.0), Vec3::new(3.0, 15.0, 0.7), Vec3::new(0.5, 0.5, 1.5), Vec3::new(18.0, 4.0, 2.3)];
    for (k, (p, n)) in places.into_iter().zip(normals).enumerate() {
        let at = LightPoint { p, n };
        let each: Vec<f64> = polygons.iter().zip(&radiances).map(|(polygon, radiance)| radiance * by_polygon(&at, polygon)).collect();
        let expected: f64 = each.iter().sum();
        let samples = 40_000;
        let found = irradiance(&prepared, &learned_at(&prepared, &at), &at, samples);
        found.assert_is(&format!("{} lamps, place {k}", polygons.len()), expected, 4);
        // By power alone: Σ E²/p − E², per sample and as a fraction of E.
        let powers: Vec<f64> = polygons.iter().zip(&radiances).map(|(p, r)| r * area(p)).collect();
        let total: f64 = powers.iter().sum();
        let second: f64 = each.iter().zip(&powers).map(|(e, power)| e * e * total / power).sum();
        let by_power = (second / (expected * expected) - 1.0).sqrt();
        let by_tree = noise(&found, samples);
        assert!(by_tree < 0.6 * by_power, "place {k}: relative deviation {by_tree} by the hierarchy, {by_power} by power");
    }
}

fn area(polygon: &[Vec3]) -> f64 {
    let half = |a: Vec3, b: Vec3| f64::from(0.5 * (a - polygon[0]).cross(b - polygon[0]).length());
    polygon.windows(2).skip(1).map(|pair| half(pair[0], pair[1])).sum()
}

#[test]
fn surfaces_met_by_chance_have_the_density_with_which_they_are_sampled() {
    let (mut scene, ..) = many_lamps(300);
    // A glowing ball, a lamp with two sides, and a screen with a picture.
    let mut ball = Mesh::default();
    for k in 0..12 {
        ball.positions.push(warp::fibonacci_sphere(k, 12).as_vec3() * 0.4 + Vec3::new(6.0, 6.0, 1.5));
    }
    ball.triangles = (0..10).map(|k| [k, k + 1, k + 2]).collect();
    let glow = Material { emits_both_sides: true, ..Material::emitter("glow", Rgb::splat(3.0)) };
    let screen = screen_material(&mut scene);
    let wall = quad(Vec3::new(0.0, 19.0, 0.2), Vec3::X * 4.0, Vec3::Z * 2.0);
    for (mesh, material) in [(ball, glow), (wall, screen)] {
        let (mesh_index, material_index) = (scene.meshes.len() as u32, scene.materials.len() as u32);
        scene.parts.push(Part {
            name: "x".into(),
            object: None,
            mesh: mesh_index,
            material: material_index,
            world_from_mesh: DAffine3::IDENTITY,
        });
        scene.meshes.push(mesh.into());
        scene.materials.push(material);
    }
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    let choice = LightChoice::from_arrivals(&prepared.lights, None, &[]);
    let mut rng = Rng::new(3);
    let mut compared = 0;
    for _ in 0..20_000 {
        let p = Vec3::new(rng.next_f32() * 20.0, rng.next_f32() * 20.0, rng.next_f32() * 2.5);
        let n = if rng.next_f32() < 0.3 { Vec3::ZERO } else { warp::sphere([rng.next_f32(), rng.next_f32()]) };
        let at = LightPoint { p, n };
        let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
        let Some(light) = prepared.lights.sample(&prepared, &choice, &at, u, |_| true) else { continue };
        let Some(hit) = prepared.closest(&Ray::new(p, light.wi), AlphaTest::Stochastic) else { continue };
        let met = prepared.surface(&hit, light.wi, &crate::texture::Cone::POINT);
        // Another lamp may be in the way.
        if light.target.is_none_or(|target| target.distance(met.p) > 1e-3) {
            continue;
        }
        let pdf = prepared.lights.surface_pdf(&prepared, &choice, &at, light.wi, &hit, met.p);
        // Edge-on, rounding moves the cosine.
        if light.wi.dot(met.ng).abs() > 0.02 {
            assert!((pdf / light.pdf - 1.0).abs() < 0.02, "sampled with {}, found with {pdf}, at {at:?}", light.pdf);
            compared += 1;
        }
    }
    assert!(compared > 5000, "{compared}");
}

/// A screen that is dark except for one corner.
fn screen_material(scene: &mut Scene) -> Material {
    let (w, h) = (64u32, 32u32);
    let texels = (0..w * h).map(|i| if i % w > 52 && i / w < 6 { [40.0, 30.0, 20.0] } else { [0.02; 3] }).collect();
    scene.images.push(Image { name: "screen".into(), width: w, height: h, pixels: Pixels::RgbF32(texels) }.into());
    let texture = Some(TextureRef::new((scene.images.len() - 1) as u32));
    Material { emission: ColorParam { factor: Rgb::splat(2.0), texture }, ..Material::emitter("screen", Rgb::WHITE) }
}

#[test]
fn a_picture_on_a_screen_lights_by_its_texels() {
    let mut scene = Scene::default();
    let screen = screen_material(&mut scene);
    let (corner, u, v) = (Vec3::new(-1.0, 2.0, 0.5), Vec3::X * 2.0, Vec3::Z);
    let built = scene_of(vec![(quad(corner, u, v), screen)]);
    (scene.parts, scene.meshes, scene.materials) = (built.parts, built.meshes, built.materials);
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    for (k, p) in [Vec3::ZERO, Vec3::new(0.8, 1.6, 1.1)].into_iter().enumerate() {
        let at = LightPoint { p, n: Vec3::Y };
        // Midpoints, sixteen to a texel.
        let (columns, rows) = (64 * 4, 32 * 4);
        let mut expected = 0.0f64;
        for i in 0..columns * rows {
            let uv = Vec2::new(((i % columns) as f32 + 0.5) / columns as f32, ((i / columns) as f32 + 0.5) / rows as f32);
            let q = corner + u * uv.x + v * uv.y;
            let d2 = q.distance_squared(p);
            let wi = (q - p) / d2.sqrt();
            let radiance = prepared.textures.color(&scene.materials[0].emission, uv, &Footprint::POINT).luminance();
            expected += f64::from(radiance * wi.y * wi.y / d2) * 2.0 / f64::from(columns * rows);
        }
        let samples = 40_000;
        let found = irradiance(&prepared, &learned_at(&prepared, &at), &at, samples);
        found.assert_is(&format!("screen, place {k}"), expected, 2);
        // Spread evenly over the screen, of which 3 % are bright, it would be above 5.
        assert!(noise(&found, samples) < 1.2, "relative deviation {}", noise(&found, samples));
    }
}

#[test]
fn lamps_of_many_shapes_light_a_point_by_their_form_factors() {
    // A disk of radius r at height h overhead: E = π L r² / (r² + h²); a sphere: E = π L (r/d)².
    let (r, h, sides) = (0.8f32, 1.1f32, 256u32);
    let mut disk = Mesh { positions: vec![Vec3::Z * h], ..Mesh::default() };
    for k in 0..sides {
        let (sin, cos) = (k as f32 / sides as f32 * std::f32::consts::TAU).sin_cos();
        disk.positions.push(Vec3::new(r * cos, r * sin, h));
        disk.triangles.push([0, 1 + (k + 1) % sides, 1 + k]);
    }
    let mut ball = Mesh::default();
    let rings = 48u32;
    for i in 0..=rings {
        for j in 0..2 * rings {
            let (theta, phi) = (i as f32 / rings as f32 * std::f32::consts::PI, j as f32 / rings as f32 * std::f32::consts::PI);
            let d = Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            ball.positions.push(d * 0.5 + Vec3::Z * 2.0);
        }
    }
    for i in 0..rings {
        for j in 0..2 * rings {
            let index = |i: u32, j: u32| i * 2 * rings + j % (2 * rings);
            ball.triangles.push([index(i, j), index(i + 1, j), index(i + 1, j + 1)]);
            ball.triangles.push([index(i, j), index(i + 1, j + 1), index(i, j + 1)]);
        }
    }
    let lamp = || Material::emitter("lamp", Rgb::WHITE);
    let at = LightPoint { p: Vec3::ZERO, n: Vec3::Z };
    let pi = std::f64::consts::PI;
    let r2 = f64::from(r * r);
    for (name, mesh, expected) in [("disk", disk, pi * r2 / (r2 + f64::from(h * h))), ("sphere", ball, pi * 0.0625)] {
        let scene = scene_of(vec![(mesh, lamp())]);
        let prepared = RenderScene::new(&scene, &Quiet).unwrap();
        let found = irradiance(&prepared, &learned_at(&prepared, &at), &at, 60_000);
        // The polygons are a little smaller than the round shapes.
        let relative = found.value() / expected - 1.0;
        assert!(relative.abs() < 0.01 && found.standard_error() < 0.004 * expected, "{name}: {relative} ± {}", found.standard_error());
    }
}

#[test]
fn heuristic_weights_sum_to_one() {
    for (a, b) in [(1.0, 2.0), (1e30, 1e-3), (0.5, 0.0)] {
        assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6);
    }
}
