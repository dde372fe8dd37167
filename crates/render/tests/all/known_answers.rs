//! Whole pictures of scenes whose radiance is known in closed form.

use enfilade_frame::{Frame, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Mat3, Rgb, Vec2, Vec3};
use enfilade_render::{Guide, RenderConfig, RenderError, RenderScene, render_frame};
use enfilade_scene::{
    Bsdf, Camera, CameraView, Environment, Image, Intrinsics, Light, MapRows, Material, NormalMap, Part, PhotometricWeb, Pixels, Pose,
    Principled, Quiet, Scene, SpotFalloff, TextureRef,
};
use std::f64::consts::PI;
use std::sync::Arc;

fn quad(corners: [Vec3; 4]) -> Mesh {
    Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

/// An axis-aligned cube of side 2 about the origin; `inward` turns its normals inside.
fn cube(inward: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for sign in [-1.0f32, 1.0] {
            let place = |a: f32, b: f32| {
                let mut p = [0.0; 3];
                p[axis] = sign;
                p[(axis + 1) % 3] = a;
                p[(axis + 2) % 3] = b;
                Vec3::from(p)
            };
            let mut corners = [place(-1.0, -1.0), place(1.0, -1.0), place(1.0, 1.0), place(-1.0, 1.0)];
            if (sign < 0.0) != inward {
                corners.reverse();
            }
            mesh.append(&quad(corners));
        }
    }
    mesh
}

/// A latitude–longitude sphere with smooth normals.
fn sphere(segments: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=segments {
        for j in 0..2 * segments {
            let (theta, phi) = (f64::from(i) / f64::from(segments) * PI, f64::from(j) / f64::from(segments) * PI);
            let p = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()).as_vec3();
            mesh.positions.push(p);
            mesh.normals.push(p);
        }
    }
    let index = |i: u32, j: u32| i * 2 * segments + j % (2 * segments);
    for i in 0..segments {
        for j in 0..2 * segments {
            if i > 0 {
                mesh.triangles.push([index(i, j), index(i + 1, j), index(i, j + 1)]);
            }
            if i + 1 < segments {
                mesh.triangles.push([index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]);
            }
        }
    }
    mesh
}

fn scene(parts: Vec<(&str, Mesh, Material)>) -> Scene {
    let mut scene = Scene::default();
    for (name, mesh, material) in parts {
        let part = Part {
            name: name.into(),
            object: None,
            mesh: scene.meshes.len() as u32,
            material: scene.materials.len() as u32,
            world_from_mesh: DAffine3::IDENTITY,
        };
        scene.parts.push(part);
        scene.meshes.push(mesh.into());
        scene.materials.push(material);
    }
    scene
}

fn picture(scene: &Scene, from: DVec3, to: DVec3, size: u32, fov_deg: f64, samples: u32) -> Frame {
    scene.validate().unwrap();
    let prepared = RenderScene::new(scene, &Quiet).unwrap();
    let up = if (to - from).cross(DVec3::Z).length() < 1e-6 { DVec3::Y } else { DVec3::Z };
    let pose = Pose::look_at(0, from, to, up).unwrap();
    let config = RenderConfig { samples, ..RenderConfig::default() };
    render(&prepared, &Intrinsics::from_fov_x(size, size, fov_deg.to_radians()), &pose, &config).unwrap()
}

fn render(scene: &RenderScene<'_>, intrinsics: &Intrinsics, pose: &Pose, config: &RenderConfig) -> Result<Frame, RenderError> {
    let camera = Camera::from(*intrinsics);
    let view = CameraView::still(&camera, pose);
    let guide = Guide::learn(scene, &[view], config);
    render_frame(scene, &guide, &view, config, &Quiet)
}

fn mean(frame: &Frame, layer: Layer, channel: usize) -> f64 {
    let values = frame.get(layer).unwrap();
    let channels = layer.spec().channels;
    (0..frame.pixels()).map(|p| values.get(p * channels + channel)).sum::<f64>() / frame.pixels() as f64
}

fn assert_close(what: &str, found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{what}: found {found}, expected {expected} ± {}%", 100.0 * relative);
}

fn white_sky(mut scene: Scene) -> Scene {
    scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    scene
}

#[test]
fn in_a_closed_box_that_glows_light_adds_up_to_one_over_one_minus_albedo() {
    for albedo in [0.2f32, 0.5, 0.8] {
        let wall = Material { emission: Rgb::WHITE.into(), ..Material::diffuse("wall", Rgb::splat(albedo)) };
        let frame = picture(&scene(vec![("box", cube(true), wall)]), DVec3::new(0.1, 0.2, 0.0), DVec3::X, 16, 70.0, 256);
        assert_close(&format!("radiance, albedo {albedo}"), mean(&frame, Layer::Color, 1), 1.0 / (1.0 - f64::from(albedo)), 0.01);
        // The walls receive the same radiance from everywhere.
        let s = mean(&frame, Layer::DiffuseIllumination, 1);
        assert_close(&format!("illumination, albedo {albedo}"), s, 1.0 / (1.0 - f64::from(albedo)), 0.01);
        assert_close("residual is the emission", mean(&frame, Layer::Residual, 0), 1.0, 1e-3);
    }
}

#[test]
fn a_limit_on_bounces_cuts_the_series_of_reflections_and_nothing_else() {
    // Emission, plus one reflection at the first surface, plus one for each further bounce.
    let wall = || Material { emission: Rgb::WHITE.into(), ..Material::diffuse("wall", Rgb::splat(0.5)) };
    let s = scene(vec![("box", cube(true), wall())]);
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let pose = Pose::look_at(0, DVec3::new(0.1, 0.2, 0.0), DVec3::X, DVec3::Z).unwrap();
    for (max_bounces, expected) in [(0, 1.5), (1, 1.75), (3, 1.9375)] {
        let config = RenderConfig { samples: 256, max_bounces: Some(max_bounces), ..RenderConfig::default() };
        let frame = render(&prepared, &Intrinsics::from_fov_x(16, 16, 1.2), &pose, &config).unwrap();
        assert_close(&format!("{max_bounces} bounces"), mean(&frame, Layer::Color, 1), expected, 0.01);
    }
}

#[test]
fn a_limit_on_bounces_leaves_the_light_that_comes_through_panes() {
    // A floor under a white sky, of which a grey film lets one half through; the light that directions find there is beyond the limit.
    let floor = |z, half: f32| quad([[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| Vec3::new(x, y, z)));
    let film = Material::new("film", Bsdf::ThinDielectric { eta: 1.0, transmittance: Rgb::splat(0.5).into() });
    let grey = Material::diffuse("floor", Rgb::splat(0.5));
    let s = white_sky(scene(vec![("floor", floor(0.0, 50.0), grey), ("film", floor(1.0, 200.0), film)]));
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let pose = Pose::look_at(0, DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, DVec3::Y).unwrap();
    for max_bounces in [0, 1, 4] {
        let config = RenderConfig { samples: 256, max_bounces: Some(max_bounces), ..RenderConfig::default() };
        let frame = render(&prepared, &Intrinsics::from_fov_x(16, 16, 0.2), &pose, &config).unwrap();
        assert_close(&format!("{max_bounces} bounces"), mean(&frame, Layer::Color, 1), 0.25, 5e-3);
    }
}

#[test]
fn lossless_spheres_vanish_in_a_white_sky() {
    let glass =
        |eta: f32, alpha: f32| Bsdf::Dielectric { eta, alpha: alpha.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::BLACK };
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::WHITE.into(), alpha: 0.0.into() };
    let plastic = Bsdf::Plastic { diffuse: Rgb::WHITE.into(), eta: 1.5, alpha: 0.0.into(), specular: Rgb::WHITE.into(), nonlinear: true };
    let varnish = Bsdf::Principled(Box::new(Principled { roughness: 0.5.into(), ..Principled::default() }));
    let thin = Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::WHITE.into() };
    let diffuse = Bsdf::Diffuse { reflectance: Rgb::WHITE.into() };
    for (name, bsdf, tolerance) in [
        ("diffuse", diffuse, 0.01),
        ("glass", glass(1.5, 0.0), 0.01),
        ("mirror", mirror, 0.01),
        ("plastic", plastic, 0.015),
        ("varnish", varnish, 0.015),
        ("thin", thin, 0.01),
        // One bounce off facets loses a little.
        ("rough glass", glass(1.5, 0.1), 0.03),
        ("rough air", glass(1.0, 0.3), 1e-3),
    ] {
        let s = white_sky(scene(vec![("sphere", sphere(64), Material::new(name, bsdf))]));
        let frame = picture(&s, DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 24, 40.0, 128);
        assert_close(name, mean(&frame, Layer::Color, 1), 1.0, tolerance);
    }
}

/// A cube of what does not bend light and absorbs this much per metre.
fn tinted_air(absorption: Rgb) -> Material {
    Material::new("air", Bsdf::Dielectric { eta: 1.0, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption })
}

#[test]
fn light_is_absorbed_by_the_law_of_beer() {
    let air = tinted_air(Rgb::new(0.2, 0.5, 1.5));
    let dust = Box::new(Bsdf::Diffuse { reflectance: Rgb::WHITE.into() });
    let blended = Material::new("blend", Bsdf::Blend { first: dust, second: Box::new(air.bsdf.clone()), weight: 1.0.into() });
    for material in [air, blended] {
        let s = white_sky(scene(vec![("cube", cube(false), material)]));
        let frame = picture(&s, DVec3::new(-400.0, 0.0, 0.0), DVec3::ZERO, 8, 0.1, 256);
        for (channel, absorption) in [0.2f64, 0.5, 1.5].into_iter().enumerate() {
            assert_close("two metres", mean(&frame, Layer::Color, channel), (-2.0 * absorption).exp(), 2e-3);
        }
    }
}

#[test]
fn the_sun_beside_a_sheet_that_encloses_nothing_lights_what_is_seen_through_it() {
    let sheet = quad([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]].map(|[x, y]| Vec3::new(x, y, 0.25)));
    let direction = -Vec3::new(0.0, 1.0, 2.0).normalize();
    let sun = Light::Directional { name: "sun".into(), direction, irradiance: Rgb::splat(3.0), angular_radius_rad: 0.0 };
    let found = floor_radiance(Scene { lights: vec![sun], ..Scene::default() }, vec![("sheet", sheet, tinted_air(Rgb::splat(2.0)))], 16);
    assert_close("a quarter of a metre from the sheet", found, 0.5 / PI * 3.0 * 2.0 / 5.0f64.sqrt() * (-0.5f64).exp(), 2e-3);
}

#[test]
fn a_lamp_inside_a_body_that_absorbs_lights_what_is_in_it_less() {
    let square =
        |half: f32, z: f32, up: f32| quad([[-1.0, -up], [1.0, -up], [1.0, up], [-1.0, up]].map(|[x, y]| Vec3::new(half * x, half * y, z)));
    let (absorption, half, height, reflectance) = (0.7, 0.5, 0.6, 0.5);
    let s = scene(vec![
        ("cube", cube(false), tinted_air(Rgb::splat(absorption))),
        ("lamp", square(half, 0.5 * height, -1.0), Material { two_sided: false, ..Material::emitter("lamp", Rgb::WHITE) }),
        ("table", square(0.1, -0.5 * height, 1.0), Material::diffuse("table", Rgb::splat(reflectance))),
    ]);
    let (from, to) = (DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 0.0, -0.5 * f64::from(height)));
    let frame = picture(&s, from, to, 8, 0.1, 512);
    // The radiance that the middle of the table sends back, by the midpoint rule over the lamp, and what is left of it outside.
    let (a, steps) = (f64::from(absorption), 400);
    let at = |i: usize| f64::from(half) * (2.0 * (i as f64 + 0.5) / steps as f64 - 1.0);
    let area = (2.0 * f64::from(half) / steps as f64).powi(2);
    let light = |x: f64, y: f64| {
        let distance = DVec3::new(x, y, f64::from(height)).length();
        (f64::from(height) / distance).powi(2) * (-a * distance).exp() / distance.powi(2) * area
    };
    let irradiance: f64 = (0..steps * steps).map(|k| light(at(k % steps), at(k / steps))).sum();
    let inside = (to - from).length() / 3.0;
    let expected = f64::from(reflectance) / PI * irradiance * (-a * inside).exp();
    assert_close("radiance", mean(&frame, Layer::Color, 1), expected, 0.01);
}

#[test]
fn a_plain_of_kilometres_loses_no_light() {
    let corners = [[-1300.0, -1100.0], [1200.0, -1250.0], [1250.0, 1300.0], [-1150.0, 1200.0]].map(|[x, y]| Vec3::new(x, y, 0.3));
    let ground = || Material::diffuse("ground", Rgb::splat(0.5));
    let scene = white_sky(scene(vec![("plain", quad(corners), ground())]));
    let frame = picture(&scene, DVec3::new(3.0, -4.0, 2.0), DVec3::new(3.5, -3.0, 0.3), 24, 50.0, 64);
    assert_close("radiance of a plain", mean(&frame, Layer::Color, 1), 0.5, 0.002);
}

#[test]
fn a_luminous_ceiling_of_kilometres_lights_a_table_under_it() {
    // Not along the axes, so that the ceiling's heights are rounded.
    let tilt = DAffine3::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), 0.3);
    let place = |x: f64, y: f64, z: f64| tilt.transform_point3(DVec3::new(x, y, z)).as_vec3();
    let ceiling = quad([[-1300.0, 1200.0], [1250.0, 1300.0], [1200.0, -1250.0], [-1300.0, -1100.0]].map(|[x, y]| place(x, y, 0.5)));
    let table = quad([[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]].map(|[x, y]| place(x, y, 0.0)));
    let s = scene(vec![
        ("ceiling", ceiling, Material { two_sided: false, ..Material::emitter("ceiling", Rgb::WHITE) }),
        ("table", table, Material::diffuse("table", Rgb::splat(0.5))),
    ]);
    let (from, to) = ((0.3, 0.1, 0.4), (0.02, 0.01, 0.0));
    let at = |(x, y, z)| tilt.transform_point3(DVec3::new(x, y, z));
    let frame = picture(&s, at(from), at(to), 16, 10.0, 256);
    assert_close("radiance of the table", mean(&frame, Layer::Color, 1), 0.5, 2e-3);
}

#[test]
fn a_thin_sheet_of_gltf_glass_passes_what_it_does_not_reflect() {
    let glass = Principled { transmission: 1.0.into(), roughness: 0.0.into(), ..Principled::default() };
    let s = white_sky(scene(vec![("sphere", sphere(32), Material::new("glass", Bsdf::Principled(Box::new(glass))))]));
    let frame = picture(&s, DVec3::new(0.0, -4.0, 0.0), DVec3::ZERO, 16, 30.0, 64);
    assert_close("radiance", mean(&frame, Layer::Color, 1), 1.0, 0.01);
}

/// Looks straight down at the origin of a grey floor from `height`, through a tiny field of view.
fn floor_radiance(mut s: Scene, extra: Vec<(&'static str, Mesh, Material)>, samples: u32) -> f64 {
    let floor = quad([Vec3::new(-50.0, -50.0, 0.0), Vec3::new(50.0, -50.0, 0.0), Vec3::new(50.0, 50.0, 0.0), Vec3::new(-50.0, 50.0, 0.0)]);
    let mut parts = vec![("floor", floor, Material::diffuse("floor", Rgb::splat(0.5)))];
    parts.extend(extra);
    let built = scene(parts);
    s.meshes = built.meshes;
    s.parts = built.parts;
    s.materials = built.materials;
    let frame = picture(&s, DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, 8, 0.2, samples);
    mean(&frame, Layer::Color, 1)
}

#[test]
fn point_spot_and_sun_light_a_floor_by_their_laws() {
    let with = |light| Scene { lights: vec![light], ..Scene::default() };
    let position = Vec3::new(0.0, 1.0, 2.0);
    let (d2, cos) = (5.0f64, 2.0 / 5.0f64.sqrt());
    let expected = 0.5 / PI * 10.0 * cos / d2;
    let intensity = Rgb::splat(10.0);
    assert_close("point", floor_radiance(with(Light::Point { name: "p".into(), position, intensity }), vec![], 1), expected, 2e-3);
    let direction = (-position).normalize();
    let falloff = SpotFalloff::CosineSquare;
    let spot = Light::Spot { name: "s".into(), position, direction, intensity, inner_rad: 0.1, outer_rad: 0.2, falloff };
    assert_close("spot", floor_radiance(with(spot), vec![], 1), expected, 2e-3);
    let away = Light::Spot { name: "s".into(), position, direction: -direction, intensity, inner_rad: 0.1, outer_rad: 0.2, falloff };
    assert_eq!(floor_radiance(with(away), vec![], 1), 0.0);
    // A measured lamp: half as bright at 45 degrees as on its axis, linear between, turned about the vertical.
    let web = PhotometricWeb::new(vec![0.0, 45.0, 90.0], vec![0.0, 90.0], vec![20.0, 10.0, 0.0, 20.0, 10.0, 0.0]).unwrap();
    let candela = 20.0 - 10.0 * f64::from(position.y).atan2(f64::from(position.z)).to_degrees() / 45.0;
    let web_from_world = Mat3::from_rotation_z(0.7);
    let lamp = Light::Profile { name: "l".into(), position, web_from_world, intensity: Rgb::splat(0.5), web: Box::new(web) };
    assert_close("profile", floor_radiance(with(lamp), vec![], 1), 0.5 / PI * 0.5 * candela * cos / d2, 2e-3);
    // As wide as it may be without setting in part: the same irradiance.
    for angular_radius_rad in [0.0, 0.00465, 0.4] {
        let sun = Light::Directional { name: "sun".into(), direction, irradiance: Rgb::splat(3.0), angular_radius_rad };
        assert_close("sun", floor_radiance(with(sun), vec![], 64), 0.5 / PI * 3.0 * cos, 3e-3);
    }
}

#[test]
fn a_square_lamp_lights_the_floor_by_its_form_factor() {
    // Facing square of side 2a at height h over the point: F = 4 · (1/2π) · 2 · X/√(1+X²) · atan(X/√(1+X²)), X = a/h.
    let (a, h) = (0.5f32, 1.5f32);
    let lamp = quad([Vec3::new(-a, a, h), Vec3::new(a, a, h), Vec3::new(a, -a, h), Vec3::new(-a, -a, h)]);
    let x = f64::from(a / h);
    let s = (1.0 + x * x).sqrt();
    let form_factor = 4.0 / (2.0 * PI) * 2.0 * (x / s) * (x / s).atan();
    let found = floor_radiance(Scene::default(), vec![("lamp", lamp.clone(), Material::emitter("lamp", Rgb::splat(8.0)))], 256);
    assert_close("lamp", found, 0.5 * 8.0 * form_factor, 0.01);
    // Through a pane of glass: shadow rays pass it, dimmed by what it reflects; at most angles here that is about 8 %.
    let pane = quad([Vec3::new(-9.0, -9.0, 1.0), Vec3::new(9.0, -9.0, 1.0), Vec3::new(9.0, 9.0, 1.0), Vec3::new(-9.0, 9.0, 1.0)]);
    let glass = Material::new("pane", Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::WHITE.into() });
    let lamp = ("lamp", lamp, Material::emitter("lamp", Rgb::splat(8.0)));
    let dimmed = floor_radiance(Scene::default(), vec![lamp, ("pane", pane, glass)], 1024);
    // The pane also mirrors the floor's own light back: a fraction of a percent of a percent.
    assert!((0.90..0.96).contains(&(dimmed / found)), "a pane lets {} through", dimmed / found);
}

#[test]
fn an_environment_map_is_sampled_in_proportion_and_from_the_right_side() {
    use enfilade_scene::{Image, Pixels, direction_from_uv};
    // A small bright patch in a dark sky, at a known direction.
    let (w, h, x, y) = (64u32, 32u32, 40u32, 8u32);
    let mut texels = vec![[0.0f32; 3]; (w * h) as usize];
    texels[(y * w + x) as usize] = [100.0; 3];
    let image = Image { name: "sky".into(), width: w, height: h, pixels: Pixels::RgbF32(texels) };
    let map_from_world = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y);
    let uv = enfilade_math::Vec2::new((x as f32 + 0.5) / w as f32, (y as f32 + 0.5) / h as f32);
    let to_patch = (map_from_world.transpose() * direction_from_uv(uv)).as_dvec3();
    let s = Scene {
        images: vec![image.into()],
        environment: Some(Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world }),
        ..Scene::default()
    };
    // Irradiance of the bilinearly interpolated texel: a tent of one texel's solid angle (integrated numerically).
    let mut irradiance = 0.0f64;
    let n = 400;
    for i in 0..n {
        for j in 0..n {
            let (du, dv) = ((f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0, (f64::from(j) + 0.5) / f64::from(n) * 2.0 - 1.0);
            let tent = (1.0 - du.abs()) * (1.0 - dv.abs());
            let (u, v) = ((f64::from(x) + 0.5 + du) / f64::from(w), (f64::from(y) + 0.5 + dv) / f64::from(h));
            let d = map_from_world.transpose() * direction_from_uv(enfilade_math::Vec2::new(u as f32, v as f32));
            let cell = 4.0 / f64::from(n * n) / f64::from(w * h) * 2.0 * PI * PI * (v * PI).sin();
            irradiance += 100.0 * tent * cell * f64::from(d.z);
        }
    }
    assert!(to_patch.z > 0.5);
    assert_close("environment", floor_radiance(s, vec![], 512), 0.5 / PI * irradiance, 0.01);
}

#[test]
fn a_dark_scene_and_bad_cameras_are_refused_with_reasons() {
    let dark = scene(vec![("box", cube(true), Material::diffuse("grey", Rgb::splat(0.5)))]);
    assert_eq!(RenderScene::new(&dark, &Quiet).err(), Some(RenderError::NoLight));
    let lit = white_sky(dark);
    let prepared = RenderScene::new(&lit, &Quiet).unwrap();
    let mut pose = Pose::look_at(3, DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
    pose.position.x = f64::NAN;
    let k = Intrinsics::from_fov_x(8, 8, 1.0);
    let error = render(&prepared, &k, &pose, &RenderConfig::default()).unwrap_err();
    assert!(error.to_string().starts_with("frame 3: the camera is not usable"), "{error}");
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let room = {
        let mut s = scene(vec![
            ("room", cube(true), Material::diffuse("wall", Rgb::new(0.7, 0.6, 0.5))),
            (
                "ball",
                sphere(16),
                Material::new(
                    "ball",
                    Bsdf::Dielectric { eta: 1.5, alpha: 0.1.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::new(1.0, 0.5, 0.1) },
                ),
            ),
        ]);
        s.parts[1].world_from_mesh = DAffine3::from_scale_rotation_translation(
            DVec3::splat(0.3),
            enfilade_math::DAffine3::IDENTITY.to_scale_rotation_translation().1,
            DVec3::new(0.4, 0.0, -0.2),
        );
        s.lights.push(Light::Point { name: "p".into(), position: Vec3::new(0.0, 0.5, 0.8), intensity: Rgb::splat(2.0) });
        s
    };
    let render = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| picture(&room, DVec3::new(-0.8, 0.0, 0.0), DVec3::X, 33, 70.0, 8))
    };
    let one = render(1);
    let bytes = |f: &Frame| f.iter().flat_map(|(_, v)| v.as_bytes().to_vec()).collect::<Vec<u8>>();
    assert_eq!(bytes(&one), bytes(&render(2)));
    assert_eq!(bytes(&one), bytes(&render(7)));
}

/// A white wall with strong relief by a normal map, seen from above.
fn embossed_wall() -> Scene {
    let mut mesh = quad([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
    mesh.uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let texels = vec![[230, 128, 180, 255], [60, 40, 190, 255], [128, 250, 150, 255], [20, 128, 140, 255]];
    let image = Image { name: "relief".into(), width: 2, height: 2, pixels: Pixels::Rgba8 { srgb: false, texels } };
    let normal_map = Some(NormalMap::Normal { texture: TextureRef::new(0), scale: 1.0 });
    let mut s = scene(vec![("wall", mesh, Material { normal_map, ..Material::diffuse("wall", Rgb::WHITE) })]);
    s.images.push(image.into());
    s
}

#[test]
fn no_light_leaks_through_a_wall_with_relief() {
    for below in [DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.7, 0.0, 0.7), DVec3::new(0.0, -0.95, 0.3)] {
        let mut s = embossed_wall();
        let direction = below.normalize().as_vec3();
        s.lights.push(Light::Directional { name: "sun".into(), direction, irradiance: Rgb::WHITE, angular_radius_rad: 0.01 });
        let frame = picture(&s, DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 16, 25.0, 16);
        assert_eq!(mean(&frame, Layer::Color, 1), 0.0, "sun from below along {below}");
    }
}

#[test]
fn relief_turns_with_its_texture() {
    // The texture turned by a quarter on the wall, or the wall's coordinates turned in its place, and mirrored.
    for [[a, b], [c, d]] in [[[0.0, 1.0], [-1.0, 0.0]], [[-1.0, 0.0], [0.0, 1.0]], [[0.0, 2.0], [1.0, 0.0]]] {
        let pictures = [false, true].map(|in_mesh| {
            let mut s = embossed_wall();
            if in_mesh {
                Arc::make_mut(&mut s.meshes[0]).uvs.iter_mut().for_each(|uv| *uv = Vec2::new(a * uv.x + b * uv.y, c * uv.x + d * uv.y));
            } else if let Some(NormalMap::Normal { texture, .. }) = &mut s.materials[0].normal_map {
                texture.uv_transform = [[a, b, 0.0], [c, d, 0.0]];
            }
            let direction = Vec3::new(0.3, 0.6, -0.7).normalize();
            s.lights.push(Light::Directional { name: "sun".into(), direction, irradiance: Rgb::WHITE, angular_radius_rad: 0.0 });
            let frame = picture(&s, DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 16, 25.0, 4);
            let color = frame.get(Layer::Color).unwrap();
            (0..16 * 16).map(|p| color.get(3 * p)).collect::<Vec<f64>>()
        });
        let off = pictures[0].iter().zip(&pictures[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 2e-3, "off by {off}");
    }
}

#[test]
fn relief_creates_no_light_and_loses_what_it_would_send_through_the_wall() {
    let frame = picture(&white_sky(embossed_wall()), DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 16, 25.0, 256);
    let albedo = mean(&frame, Layer::Color, 1);
    assert!((0.72..=1.0).contains(&albedo), "albedo {albedo}");
}

#[test]
fn a_lambertian_rendering_lights_a_point_the_same_from_everywhere() {
    // Plaster under a sun at 60 degrees from the normal, seen from the sun's side and from the other one.
    let rough = |reflectance: f32| Bsdf::RoughDiffuse { reflectance: Rgb::splat(reflectance).into(), roughness: 1.0.into() };
    let blend = Bsdf::Blend { first: Box::new(rough(0.8)), second: Box::new(rough(0.4)), weight: 0.5.into() };
    let direction = Vec3::new(-(60f32.to_radians().sin()), 0.0, -0.5);
    for bsdf in [rough(0.8), blend] {
        let floor = quad([(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)].map(|(x, y)| Vec3::new(x, y, 0.0)));
        let mut scene = scene(vec![("floor", floor, Material::new("plaster", bsdf))]);
        scene.lights.push(Light::Directional { name: "sun".into(), direction, irradiance: Rgb::splat(3.0), angular_radius_rad: 0.0 });
        let from = |x: f64, lambertian: bool| {
            let config = RenderConfig { samples: 16, lambertian, ..RenderConfig::default() };
            let ready = RenderScene::new(&scene, &Quiet).unwrap().settled(&config);
            let pose = Pose::look_at(0, DVec3::new(x, 0.0, 1.0), DVec3::ZERO, DVec3::Z).unwrap();
            mean(&render(&ready, &Intrinsics::from_fov_x(4, 4, 0.02), &pose, &config).unwrap(), Layer::DiffuseIllumination, 0)
        };
        // Irradiance over pi, by Lambert's law.
        for x in [1.5, -1.5] {
            assert_close(&format!("from {x}"), from(x, true), 3.0 * 0.5 / PI, 2e-3);
        }
        // As it is, the facets that face the sun are seen from its side.
        let [toward, away] = [1.5, -1.5].map(|x| from(x, false));
        assert!(toward > 1.2 * away, "{toward} from the sun's side, {away} from the other");
    }
}
