//! The film as a whole: light in parts, the standard error, and frames that continue where they were interrupted.

use enfilade_frame::{Frame, LIGHT_BY_PATH, LIGHT_BY_SOURCE, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_render::{FrameRender, Guide, PartialError, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Alpha, Bsdf, Camera, CameraView, Environment, Intrinsics, Light, Material, Part, Pose, Quiet, Scene};
use enfilade_testkit::Mean;

/// An axis-aligned box that is seen from inside.
fn room(half: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for sign in [-1.0f32, 1.0] {
            let first = mesh.positions.len() as u32;
            for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign, a, b);
                mesh.positions.push(half * Vec3::from(p));
            }
            let corners: [u32; 4] = if sign < 0.0 { [0, 1, 2, 3] } else { [3, 2, 1, 0] };
            let [a, b, c, d] = corners.map(|corner| first + corner);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A square about `centre`, facing −x.
fn screen(centre: Vec3, half: f32) -> Mesh {
    let corner = |y: f32, z: f32| centre + half * Vec3::new(0.0, y, z);
    let positions = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

fn scene(parts: Vec<(Mesh, Material)>) -> Scene {
    let mut scene = Scene::default();
    for (i, (mesh, material)) in parts.into_iter().enumerate() {
        let i = i as u32;
        scene.parts.push(Part { name: format!("part {i}"), object: None, mesh: i, material: i, world_from_mesh: DAffine3::IDENTITY });
        scene.meshes.push(mesh.into());
        scene.materials.push(material);
    }
    scene
}

/// A camera that looks along +x from near the origin.
fn place(size: [u32; 2]) -> (Camera, Pose) {
    let pose = Pose::look_at(0, DVec3::new(-0.5, 0.1, 0.05), DVec3::X, DVec3::Z).unwrap();
    (Camera::from(Intrinsics::from_fov_x(size[0], size[1], 1.2)), pose)
}

fn picture(scene: &Scene, size: [u32; 2], config: &RenderConfig) -> Frame {
    scene.validate().unwrap();
    let prepared = RenderScene::new(scene, &Quiet).unwrap();
    let (camera, pose) = place(size);
    let view = CameraView::still(&camera, &pose);
    let guide = Guide::learn(&prepared, &[view], config);
    render_frame(&prepared, &guide, &view, config, &Quiet).unwrap()
}

fn splitting(samples: u32) -> RenderConfig {
    RenderConfig { samples, light_parts: true, ..RenderConfig::default() }
}

fn mean(frame: &Frame, layer: Layer) -> f64 {
    let values = frame.get(layer).unwrap();
    (0..values.len()).map(|i| values.get(i)).sum::<f64>() / values.len() as f64
}

fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{what}: found {found}, expected {expected} ± {tolerance}");
}

/// Asserts that both sets of parts sum to colour, and three of them to the residual, in every pixel.
fn assert_sums(frame: &Frame) {
    let sets: [(&[Layer], Layer); 3] = [
        (&LIGHT_BY_PATH, Layer::Color),
        (&LIGHT_BY_SOURCE, Layer::Color),
        (&[Layer::Specular, Layer::Transmission, Layer::Emission], Layer::Residual),
    ];
    for (parts, whole) in sets {
        let values = frame.get(whole).unwrap();
        for i in 0..values.len() {
            let sum: f64 = parts.iter().map(|&part| frame.get(part).unwrap().get(i)).sum();
            assert!(
                (sum - values.get(i)).abs() <= 2e-3 * values.get(i).max(1e-3),
                "{parts:?} in {i}: {sum}, {whole:?} is {}",
                values.get(i)
            );
        }
    }
}

/// A room with everything: a lamp, a sun and a sky behind a window of glass, a point light, a mirror, a body of glass, paint.
fn furnished() -> Scene {
    let walls = {
        let mut mesh = room(1.0);
        mesh.triangles.drain(2..4); // towards +x it is open
        mesh
    };
    let glass = Bsdf::Dielectric { eta: 1.5, alpha: 0.1.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::new(1.0, 0.5, 0.1) };
    let paint = Bsdf::Plastic {
        diffuse: Rgb::new(0.6, 0.3, 0.1).into(),
        eta: 1.5,
        alpha: 0.1.into(),
        specular: Rgb::WHITE.into(),
        nonlinear: true,
    };
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::splat(0.9).into(), alpha: 0.0.into() };
    let mut body = room(0.15);
    body.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    body.positions.iter_mut().for_each(|p| *p += Vec3::new(0.3, -0.3, -0.3));
    let mut scene = scene(vec![
        (walls, Material::new("paint", paint)),
        (
            screen(Vec3::new(0.95, 0.0, 0.0), 0.95),
            Material::new("pane", Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::WHITE.into() }),
        ),
        (screen(Vec3::new(0.6, 0.4, 0.3), 0.1), Material::emitter("lamp", Rgb::splat(5.0))),
        (screen(Vec3::new(0.7, 0.4, -0.4), 0.2), Material::new("mirror", mirror)),
        (body, Material::new("glass", glass)),
    ]);
    scene.environment = Some(Environment::Constant { radiance: Rgb::new(0.5, 0.7, 1.0) });
    let direction = Vec3::new(-1.0, 0.3, -0.4).normalize();
    let sun = Light::Directional { name: "sun".into(), direction, irradiance: Rgb::splat(3.0), angular_radius_rad: 0.05 };
    let bulb = Light::Point { name: "bulb".into(), position: Vec3::new(-0.2, -0.5, 0.6), intensity: Rgb::splat(0.2) };
    scene.lights = vec![sun, bulb];
    scene
}

#[test]
fn parts_of_light_sum_to_the_whole_and_change_nothing_else() {
    let scene = furnished();
    for clamp in [None, Some(0.5)] {
        let config = RenderConfig { clamp, ..splitting(24) };
        let in_parts = picture(&scene, [40, 30], &config);
        assert_sums(&in_parts);
        for part in LIGHT_BY_PATH.into_iter().chain(LIGHT_BY_SOURCE) {
            assert!(mean(&in_parts, part) > 0.0, "{part:?} is black");
        }
        let whole = picture(&scene, [40, 30], &RenderConfig { light_parts: false, ..config });
        assert_eq!(whole.iter().count() + 9, in_parts.iter().count());
        for (layer, values) in whole.iter() {
            assert_eq!(values.as_bytes(), in_parts.get(layer).unwrap().as_bytes(), "{layer:?}");
        }
    }
}

/// Light that a fixture adds to each channel of the picture.
fn light_of(frame: &Frame, fixture: usize) -> Vec<f64> {
    let reflectance = frame.get(Layer::DiffuseReflectance).unwrap();
    let light = &frame.fixtures()[fixture];
    (0..reflectance.len()).map(|i| reflectance.get(i) * light.diffuse_illumination.get(i) + light.residual.get(i)).collect()
}

#[test]
fn light_of_fixtures_sums_to_the_whole_and_changes_nothing_else() {
    let scene = furnished();
    for (clamp, max_bounces) in [(None, None), (Some(0.5), None), (None, Some(1))] {
        let config = RenderConfig { clamp, max_bounces, fixtures: true, ..splitting(24) };
        let apart = picture(&scene, [40, 30], &config);
        let ready = RenderScene::new(&scene, &Quiet).unwrap();
        let names: Vec<&str> = ready.fixtures().iter().map(|fixture| fixture.name.as_str()).collect();
        assert_eq!(names, ["sky", "sun", "part 1", "bulb", "part 2"]);
        let color = apart.get(Layer::Color).unwrap();
        let lights: Vec<Vec<f64>> = (0..5).map(|fixture| light_of(&apart, fixture)).collect();
        for i in 0..color.len() {
            let sum: f64 = lights.iter().map(|light| light[i]).sum();
            assert!((sum - color.get(i)).abs() <= 2e-3 * color.get(i).max(1e-3), "value {i}: {sum}, color is {}", color.get(i));
        }
        // By kind they are the layers of light by source.
        let mean_of = |fixture: &usize| lights[*fixture].iter().sum::<f64>() / color.len() as f64;
        for (layer, of_kind) in LIGHT_BY_SOURCE.into_iter().zip([&[0, 2][..], &[1], &[4], &[3]]) {
            let stored = mean(&apart, layer);
            assert_close(names[of_kind[0]], of_kind.iter().map(mean_of).sum(), stored, 2e-3 * stored);
        }
        let whole = picture(&scene, [40, 30], &RenderConfig { fixtures: false, ..config });
        assert!(whole.fixtures().is_empty());
        assert_eq!(bytes(&whole), bytes(&apart));
    }
}

#[test]
fn the_reflectance_of_sheer_cloth_is_exact_and_its_colour_as_even_as_samples_allow() {
    let velvet = || (screen(Vec3::new(0.9, 0.0, 0.0), 2.0), Material::diffuse("velvet", Rgb::BLACK));
    let cloth = |x: f32, opacity: f32| {
        let white = Material::diffuse("cloth", Rgb::splat(0.8));
        (screen(Vec3::new(x, 0.0, 0.0), 2.0), Material { alpha: Alpha::Blend { opacity: opacity.into() }, ..white })
    };
    let seen = |parts: Vec<(Mesh, Material)>, layers: [Layer; 2]| {
        let mut scene = scene(parts);
        scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
        let frame = picture(&scene, [24, 18], &RenderConfig { samples: 16, ..RenderConfig::default() });
        layers.map(|layer| frame.get(layer).unwrap()).map(|values| (0..values.len()).map(|i| values.get(i)).collect::<Vec<f64>>())
    };

    // One layer has the light of half the sky (E = 1), and the surface behind is black. If samples drew independently, colours would be
    // spread by 0.09.
    let [reflectance, color] = seen(vec![velvet(), cloth(0.5, 0.3)], [Layer::DiffuseReflectance, Layer::Color]);
    for reflectance in reflectance {
        assert_close("one layer", reflectance, 0.8 * 0.3, 2e-4);
    }
    let off: Vec<f64> = color.into_iter().map(|color| color - 0.8 * 0.3).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let spread = (off.iter().map(|off| off * off).sum::<f64>() / off.len() as f64).sqrt();
    assert!(mean.abs() < 5e-3 && spread < 0.05, "colour off by {mean}, spread by {spread}");
    // The far layer is seen by the rays that the near one lets through, and the background by the others.
    let [reflectance, _] = seen(vec![cloth(0.5, 0.5), cloth(0.6, 0.25)], [Layer::DiffuseReflectance, Layer::Color]);
    for reflectance in reflectance {
        assert_close("two layers", reflectance, 0.8 * (0.5 + 0.5 * 0.25), 4e-4);
    }
}

#[test]
fn of_very_many_lamps_the_weakest_have_their_light_together() {
    let mut s = scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.5)))]);
    let position = |i: u32| Vec3::new(0.3 * (i % 7) as f32 - 0.9, 0.3 * (i / 7) as f32 - 0.9, 0.3 * (i % 5) as f32 - 0.6);
    s.lights = (0..49).map(|i| Light::Point { name: format!("{i}"), position: position(i), intensity: Rgb::splat(0.01) }).collect();
    let frame = picture(&s, [12, 9], &RenderConfig { samples: 32, fixtures: true, ..RenderConfig::default() });
    let color = frame.get(Layer::Color).unwrap();
    assert_eq!(frame.fixtures().len(), enfilade_frame::MAX_FIXTURES);
    let lights: Vec<Vec<f64>> = (0..frame.fixtures().len()).map(|fixture| light_of(&frame, fixture)).collect();
    for i in 0..color.len() {
        let sum: f64 = lights.iter().map(|light| light[i]).sum();
        assert!((sum - color.get(i)).abs() <= 2e-3 * color.get(i).max(1e-3), "value {i}: {sum}, color is {}", color.get(i));
    }
    assert!(lights.last().unwrap().iter().sum::<f64>() > 3.0 * lights[0].iter().sum::<f64>() / 40.0);
}

#[test]
fn the_light_of_a_lamp_is_that_of_the_scene_where_no_other_is_on() {
    // Two lamps, of which one is red; each is rendered alone as well.
    let lamp = |y: f32, color: Rgb| {
        (screen(Vec3::new(0.9, y, 0.5), 0.2), Material { emission: color.into(), ..Material::diffuse("lamp", Rgb::splat(0.5)) })
    };
    let scene_of =
        |left: Rgb, right: Rgb| scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.5))), lamp(-0.7, left), lamp(0.7, right)]);
    let (red, white) = (Rgb::new(4.0, 0.5, 0.5), Rgb::splat(3.0));
    let config = RenderConfig { samples: 512, fixtures: true, ..RenderConfig::default() };
    let both = picture(&scene_of(red, white), [24, 18], &config);
    // The white one is the stronger.
    for (fixture, alone) in [(0, scene_of(Rgb::BLACK, white)), (1, scene_of(red, Rgb::BLACK))] {
        let alone = picture(&alone, [24, 18], &config);
        let (light, expected) = (light_of(&both, fixture), alone.get(Layer::Color).unwrap());
        for channel in 0..3 {
            let sum = |value: &dyn Fn(usize) -> f64| (0..24 * 18).map(|pixel| value(3 * pixel + channel)).sum::<f64>();
            let (found, expected) = (sum(&|i| light[i]), sum(&|i| expected.get(i)));
            assert_close(&format!("fixture {fixture}, channel {channel}"), found, expected, 0.01 * expected);
        }
    }
}

#[test]
fn the_light_of_a_window_is_that_of_the_room_where_the_other_is_shut() {
    // Two windows in the open end of a room, one of them with two panes, and a picture's glass on the wall; a black plate outside shuts one.
    let thin = |name: &str| Material::new(name, Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::splat(0.9).into() });
    let shutter = (screen(Vec3::new(0.985, 0.5, 0.0), 0.42), Material::diffuse("shutter", Rgb::BLACK));
    let scene_of = |shut: bool| {
        let mut walls = room(1.0);
        walls.triangles.drain(2..4);
        let mut meshes = vec![
            (walls, Material::diffuse("wall", Rgb::splat(0.6))),
            (screen(Vec3::new(0.98, -0.6, 0.0), 0.3), thin("left")),
            (screen(Vec3::new(0.98, 0.5, 0.0), 0.4), thin("right")),
            (screen(Vec3::new(0.96, -0.6, 0.0), 0.3), thin("inner left")),
            (screen(Vec3::new(-0.98, 0.0, 0.0), 0.3), thin("glass of a picture")),
        ];
        meshes.extend(shut.then(|| shutter.clone()));
        let mut scene = scene(meshes);
        scene.environment = Some(Environment::Constant { radiance: Rgb::new(0.5, 0.7, 1.0) });
        scene
    };
    let config = RenderConfig { samples: 512, fixtures: true, ..RenderConfig::default() };
    let (open, right_shut) = (scene_of(false), scene_of(true));
    let ready = RenderScene::new(&open, &Quiet).unwrap();
    let found: Vec<(&str, &[u32])> = ready.fixtures().iter().map(|fixture| (fixture.name.as_str(), &fixture.parts[..])).collect();
    assert_eq!(found, [("sky", &[][..]), ("part 2", &[2]), ("part 1", &[1])]);
    let (open, right_shut) = (picture(&open, [24, 18], &config), picture(&right_shut, [24, 18], &config));
    // Where the right one is shut only the left one is listed, beside the sky, and sends the same light.
    assert_eq!(right_shut.fixtures().len(), 2);
    let [found, expected] = [light_of(&open, 2), light_of(&right_shut, 1)].map(|light| light.iter().sum::<f64>());
    assert_close("the left window", found, expected, 0.02 * expected);
}

#[test]
fn in_a_box_that_glows_every_reflection_has_its_place() {
    // Emission 1, reflected once directly, and then the series of further reflections.
    let albedo = 0.5f32;
    let wall = Material { emission: Rgb::WHITE.into(), ..Material::diffuse("wall", Rgb::splat(albedo)) };
    let frame = picture(&scene(vec![(room(1.0), wall)]), [16, 16], &splitting(256));
    assert_sums(&frame);
    assert_close("emission", mean(&frame, Layer::Emission), 1.0, 1e-3);
    assert_close("direct", mean(&frame, Layer::DiffuseDirect), 0.5, 5e-3);
    assert_close("indirect", mean(&frame, Layer::DiffuseIndirect), 0.5, 1e-2);
    assert_close("of surfaces", mean(&frame, Layer::LightSurfaces), 2.0, 1e-2);
}

#[test]
fn a_mirror_and_a_pane_in_a_box_that_glows_show_the_box() {
    let wall = Material { emission: Rgb::WHITE.into(), ..Material::diffuse("wall", Rgb::splat(0.5)) };
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::WHITE.into(), alpha: 0.0.into() };
    let pane = Bsdf::Dielectric { eta: 1.5, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::BLACK };
    let mut glass = room(0.2);
    glass.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    for (name, mesh, bsdf) in [("mirror", screen(Vec3::X * 0.5, 0.9), mirror), ("glass", glass, pane)] {
        let frame = picture(&scene(vec![(room(1.0), wall.clone()), (mesh, Material::new(name, bsdf))]), [32, 32], &splitting(256));
        assert_close(name, mean(&frame, Layer::Color), 2.0, 5e-3);
    }
}

#[test]
fn light_of_colours_that_the_first_surface_lacks_is_in_its_illumination() {
    // The wall before the camera reflects no green; the light on it is that on a black one.
    let glowing = |name: &str, reflectance: Rgb| Material { emission: Rgb::WHITE.into(), ..Material::diffuse(name, reflectance) };
    let illumination = |reflectance: Rgb, guiding: bool| {
        let parts =
            vec![(room(1.0), glowing("green", Rgb::new(0.0, 0.5, 0.0))), (screen(Vec3::X * 0.99, 0.99), glowing("other", reflectance))];
        let config = RenderConfig { samples: 512, guiding, ..RenderConfig::default() };
        let frame = picture(&scene(parts), [16, 16], &config);
        let values = frame.get(Layer::DiffuseIllumination).unwrap();
        (0..16 * 16).map(|p| values.get(3 * p + 1)).sum::<f64>() / 256.0
    };
    let expected = illumination(Rgb::BLACK, true);
    assert!(expected > 1.5, "{expected}");
    for guiding in [true, false] {
        assert_close(&format!("guiding {guiding}"), illumination(Rgb::new(0.5, 0.0, 0.0), guiding), expected, 0.02 * expected);
    }
}

#[test]
fn walls_that_are_half_mirrors_keep_the_light_that_they_reflect() {
    // Half of each wall is paint and half a mirror, of reflectance 0.5 both.
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::splat(0.5).into(), alpha: 0.0.into() };
    let paint = Bsdf::Diffuse { reflectance: Rgb::splat(0.5).into() };
    let both = Bsdf::Blend { first: Box::new(paint), second: Box::new(mirror), weight: 0.5.into() };
    let wall = Material { emission: Rgb::WHITE.into(), ..Material::new("wall", both) };
    let scene = scene(vec![(room(1.0), wall)]);
    for max_bounces in [None, Some(40)] {
        let config = RenderConfig { max_bounces, samples: 256, ..RenderConfig::default() };
        let frame = picture(&scene, [32, 32], &config);
        assert_close(&format!("at most {max_bounces:?}"), mean(&frame, Layer::Color), 2.0, 2e-3);
    }
}

#[test]
fn glass_and_mirrors_have_their_own_parts_and_sources_theirs() {
    let through = |bsdf: Bsdf| {
        let mut s = scene(vec![(screen(Vec3::X, 9.0), Material::new("screen", bsdf))]);
        s.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
        let frame = picture(&s, [8, 8], &splitting(64));
        assert_sums(&frame);
        assert_close("all of it is the sky's", mean(&frame, Layer::LightEnvironment), mean(&frame, Layer::Color), 2e-3);
        [Layer::DiffuseDirect, Layer::Specular, Layer::Transmission, Layer::Emission].map(|layer| mean(&frame, layer))
    };
    let [diffuse, specular, transmission, emission] = through(Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::WHITE.into() });
    assert_close("a pane has no other way", diffuse + emission, 0.0, 0.0);
    assert!((0.04..0.2).contains(&specular) && (specular + transmission - 1.0).abs() < 5e-3, "{specular} and {transmission}");
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::WHITE.into(), alpha: 0.0.into() };
    assert_eq!(through(mirror), [0.0, 1.0, 0.0, 0.0]);
    let [diffuse, ..] = through(Bsdf::Diffuse { reflectance: Rgb::splat(0.5).into() });
    assert_close("paint under a white sky", diffuse, 0.5, 1e-2);
}

#[test]
fn rays_pass_a_veil_by_chance_without_a_filter_too() {
    let veil = Material { alpha: Alpha::Blend { opacity: 0.5.into() }, ..Material::diffuse("veil", Rgb::BLACK) };
    let mut s = scene(vec![(screen(Vec3::X, 9.0), veil)]);
    s.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let config = RenderConfig { samples: 256, adaptive: false, filter_radius: 0.0, ..RenderConfig::default() };
    let frame = picture(&s, [16, 16], &config);
    let color = frame.get(Layer::Color).unwrap();
    for pixel in 0..256 {
        // Half of the rays, within five standard errors.
        assert_close(&format!("pixel {pixel}"), color.get(3 * pixel), 0.5, 5.0 * 0.5 / 256f64.sqrt());
    }
}

#[test]
fn the_standard_error_is_about_the_spread_over_seeds_and_not_below_it() {
    let mut s = scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.7)))]);
    s.lights.push(Light::Point { name: "p".into(), position: Vec3::new(0.0, 0.3, 0.5), intensity: Rgb::WHITE });
    let runs: Vec<Frame> = (0..24)
        .map(|seed| picture(&s, [12, 12], &RenderConfig { samples: 16, adaptive: false, guiding: false, seed, ..RenderConfig::default() }))
        .collect();
    let (mut spread, mut stated) = (0.0, 0.0);
    for pixel in 0..144 {
        // Grey: every channel is the luminance.
        let values: Vec<f64> = runs.iter().map(|run| run.get(Layer::Color).unwrap().get(3 * pixel)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        spread += values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64;
        stated += runs.iter().map(|run| run.get(Layer::ColorStandardError).unwrap().get(pixel).powi(2)).sum::<f64>() / runs.len() as f64;
    }
    let ratio = (spread / stated).sqrt();
    assert!((0.3..1.05).contains(&ratio), "the spread is {ratio} of what is stated");
}

#[test]
fn light_by_way_of_a_small_bright_place_is_the_same_and_steadier_where_it_is_learned() {
    // A lamp shines up into a small white shade, and nowhere else: the shade alone lights the room.
    let face = |z: f32, half: f32, up: bool| {
        let positions = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(0.3 + half * x, half * y, z)).to_vec();
        Mesh { positions, triangles: if up { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[0, 2, 1], [0, 3, 2]] }, ..Mesh::default() }
    };
    let lamp = Material { emission: Rgb::splat(200.0).into(), ..Material::diffuse("lamp", Rgb::BLACK) };
    let s = scene(vec![
        (room(1.0), Material::diffuse("wall", Rgb::splat(0.2))),
        (face(0.6, 0.05, false), Material::diffuse("shade", Rgb::splat(0.8))),
        (face(0.57, 0.02, true), lamp),
    ]);
    // The mean over the picture and the mean square of what its pixels state as their error.
    let brightness = |guiding: bool| {
        let (mut mean, mut error) = (Mean::default(), 0.0);
        for seed in 0..4 {
            let config = RenderConfig { samples: 256, adaptive: false, guiding, seed, ..RenderConfig::default() };
            let frame = picture(&s, [32, 32], &config);
            let color = frame.get(Layer::Color).unwrap();
            let stated = frame.get(Layer::ColorStandardError).unwrap();
            mean.add((0..1024).map(|pixel| color.get(3 * pixel)).sum::<f64>() / 1024.0);
            error += (0..1024).map(|pixel| stated.get(pixel).powi(2)).sum::<f64>() / 1024.0;
        }
        (mean, error)
    };
    let ((learned, error), (plain, plain_error)) = (brightness(true), brightness(false));
    learned.assert_agrees("learned against plain", &plain, 1);
    let gain = plain_error / error;
    assert!(gain > 3.0, "variance of the plain picture over that of the learned one: {gain}");
}

#[test]
fn where_nothing_varies_there_is_no_error_and_one_sample_says_nothing() {
    let mut s = scene(vec![(screen(Vec3::new(-9.0, 0.0, 0.0), 1.0), Material::diffuse("behind", Rgb::WHITE))]);
    s.environment = Some(Environment::Constant { radiance: Rgb::splat(0.3) });
    let errors = |samples| {
        let frame = picture(&s, [9, 7], &RenderConfig { samples, ..RenderConfig::default() });
        let values = frame.get(Layer::ColorStandardError).unwrap();
        (0..values.len()).map(|i| values.get(i)).collect::<Vec<_>>()
    };
    assert!(errors(64).iter().all(|&e| e == 0.0));
    assert!(errors(1).iter().all(|e| e.is_nan()));
}

/// All layers of a frame, one after the other.
fn bytes(frame: &Frame) -> Vec<u8> {
    frame.iter().flat_map(|(_, values)| values.as_bytes().to_vec()).collect()
}

/// The light of all fixtures, one after the other.
fn fixture_bytes(frame: &Frame) -> Vec<u8> {
    let parts = frame.fixtures().iter().flat_map(|light| [&light.diffuse_illumination, &light.residual]);
    parts.flat_map(|values| values.as_bytes().to_vec()).collect()
}

#[test]
fn a_frame_goes_on_from_bytes_with_the_same_result_on_any_number_of_threads() {
    let scene = furnished();
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    let (camera, pose) = place([37, 21]);
    let view = CameraView::still(&camera, &pose);
    let config = RenderConfig { fixtures: true, ..splitting(90) };
    let guide = Guide::learn(&prepared, &[view], &config);
    let new = || FrameRender::new(&prepared, &guide, &view, &config).unwrap();
    let with = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();

    let mut whole = new();
    while !whole.is_done() {
        whole.pass(&Quiet);
    }
    assert!((whole.samples() - 90.0).abs() < 1.0 && whole.noise().unwrap() > 0.0 && !whole.met_noise_target());
    let (mut kept, mut passes) = (new().save(b"key"), 0);
    loop {
        let mut next = new();
        next.restore(&kept, b"key").unwrap();
        if next.is_done() {
            assert_eq!(bytes(&next.frame()), bytes(&whole.frame()));
            assert!(fixture_bytes(&next.frame()) == fixture_bytes(&whole.frame()) && next.frame().fixtures().len() == 5);
            break;
        }
        let before = next.samples();
        with(1 + passes % 3).install(|| next.pass(&Quiet));
        assert!(next.samples() > before && next.samples() < before + 24.0, "a pass is short");
        (kept, passes) = (next.save(b"key"), passes + 1);
    }
    assert!(passes >= 6, "{passes} passes");

    let mut other = new();
    assert_eq!(other.restore(&kept, b"another"), Err(PartialError::OtherFrame));
    assert_eq!(other.restore(b"", b"key"), Err(PartialError::Foreign));
    assert_eq!(other.restore(&kept[..kept.len() / 2], b"key"), Err(PartialError::Damaged));
    let whole_config = RenderConfig { light_parts: false, ..config.clone() };
    let mut unsplit = FrameRender::new(&prepared, &guide, &view, &whole_config).unwrap();
    assert_eq!(unsplit.restore(&kept, b"key"), Err(PartialError::OtherFrame));
    let together_config = RenderConfig { fixtures: false, ..config.clone() };
    let mut together = FrameRender::new(&prepared, &guide, &view, &together_config).unwrap();
    assert_eq!(together.restore(&kept, b"key"), Err(PartialError::OtherFrame));
    assert_eq!(other.samples(), 0.0, "what is refused changes nothing");
}

#[test]
fn a_first_pass_in_parts_begins_with_one_sample_and_ends_with_the_same_bytes() {
    let scene = furnished();
    let prepared = RenderScene::new(&scene, &Quiet).unwrap();
    let (camera, pose) = place([37, 21]);
    let view = CameraView::still(&camera, &pose);
    let config = splitting(90);
    let guide = Guide::learn(&prepared, &[view], &config);
    let new = || FrameRender::new(&prepared, &guide, &view, &config).unwrap();

    let (mut whole, mut begun, mut parts) = (new(), new(), new());
    begun.short_pass(&Quiet);
    assert_eq!((begun.samples(), begun.noise()), (1.0, None));
    // Parts of a pass are kept too.
    parts.restore(&begun.save(b"key"), b"key").unwrap();
    let mut samples = Vec::new();
    while !parts.is_done() {
        parts.short_pass(&Quiet);
        samples.push(parts.samples());
    }
    assert_eq!(samples[..3], [2.0, 4.0, 8.0]);
    while !whole.is_done() {
        whole.pass(&Quiet);
    }
    assert_eq!(bytes(&parts.frame()), bytes(&whole.frame()));
}

#[test]
fn a_noise_target_is_met_with_fewer_samples_and_says_so() {
    let mut s = scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.5)))]);
    s.lights.push(Light::Point { name: "p".into(), position: Vec3::new(0.0, 0.3, 0.5), intensity: Rgb::WHITE });
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let (camera, pose) = place([24, 24]);
    let view = CameraView::still(&camera, &pose);
    let config = RenderConfig { samples: 2048, noise: Some(0.02), ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let mut rendering = FrameRender::new(&prepared, &guide, &view, &config).unwrap();
    while !rendering.is_done() {
        rendering.pass(&Quiet);
    }
    assert!(rendering.met_noise_target() && rendering.samples() < 2000.0, "{} samples", rendering.samples());
    assert!(rendering.noise().unwrap() <= 0.02, "noise {:?}", rendering.noise());
}

#[test]
fn a_frame_stopped_by_noise_has_at_most_the_noise_that_was_asked_for() {
    let mut lit = scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.5)))]);
    lit.lights.push(Light::Point { name: "p".into(), position: Vec3::new(0.0, 0.3, 0.5), intensity: Rgb::WHITE });
    for (name, scene, target) in [("lit", &lit, 0.03f32), ("furnished", &furnished(), 0.06)] {
        let prepared = RenderScene::new(scene, &Quiet).unwrap();
        let (camera, pose) = place([24, 18]);
        let view = CameraView::still(&camera, &pose);
        for seed in 0..5 {
            let config = RenderConfig { samples: 4096, noise: Some(target), seed, ..RenderConfig::default() };
            let guide = Guide::learn(&prepared, &[view], &config);
            let mut rendering = FrameRender::new(&prepared, &guide, &view, &config).unwrap();
            while !rendering.is_done() {
                rendering.pass(&Quiet);
            }
            // The reported noise, and the noise measured in the stored layers.
            let (said, measured) = (rendering.noise().unwrap(), rendering.frame().noise().unwrap());
            assert_eq!(said, measured);
            assert!(rendering.met_noise_target(), "{name}, seed {seed}: {said} after {} samples", rendering.samples());
            assert!((0.9..=1.0).contains(&(measured / f64::from(target))), "{name}, seed {seed}: {measured}, asked for {target}");
        }
    }
}

#[test]
fn a_noise_target_takes_what_it_needs_however_many_samples_it_might_take() {
    let mut s = scene(vec![(room(1.0), Material::diffuse("wall", Rgb::splat(0.5)))]);
    s.lights.push(Light::Point { name: "p".into(), position: Vec3::new(0.0, 0.3, 0.5), intensity: Rgb::WHITE });
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let (camera, pose) = place([24, 24]);
    let view = CameraView::still(&camera, &pose);
    let config = RenderConfig { samples: 8192, noise: Some(0.07), ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let new = || FrameRender::new(&prepared, &guide, &view, &config).unwrap();

    let (mut whole, mut kept) = (new(), Vec::new());
    while !whole.is_done() {
        whole.pass(&Quiet);
        kept.push(whole.save(b"key"));
    }
    let (samples, passes) = (whole.samples(), kept.len());
    assert!(whole.met_noise_target() && samples < 400.0, "noise {:?} after {samples} samples", whole.noise());
    assert!(passes as f64 <= (samples / f64::from(FrameRender::PASS)).ceil() + 4.0, "{passes} passes for {samples} samples");
    // It continues the same from any of them.
    for kept in [&kept[passes / 2], &kept[passes - 1]] {
        let mut next = new();
        next.restore(kept, b"key").unwrap();
        while !next.is_done() {
            next.pass(&Quiet);
        }
        assert_eq!(bytes(&next.frame()), bytes(&whole.frame()));
    }
}

#[test]
fn a_noise_target_out_of_reach_is_not_said_to_be_met() {
    // All noise is at the edges of something small, which get all that a pixel may have; the others need nothing.
    let mut s = scene(vec![(screen(Vec3::X * 3.0, 0.05), Material::diffuse("board", Rgb::splat(0.2)))]);
    s.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let (camera, pose) = place([128, 96]);
    let view = CameraView::still(&camera, &pose);
    let config = RenderConfig { samples: 64, noise: Some(1e-4), ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);
    let mut rendering = FrameRender::new(&prepared, &guide, &view, &config).unwrap();
    while !rendering.is_done() {
        rendering.pass(&Quiet);
    }
    let (noise, samples) = (rendering.noise().unwrap(), rendering.samples());
    assert!(noise > 2e-4 && samples < 60.0, "noise {noise} after {samples} samples");
    assert!(!rendering.met_noise_target());
}
