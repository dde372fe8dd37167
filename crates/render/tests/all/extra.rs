//! The further layers on scenes whose answer is known: a card in front of a wall, a pane, a camera that moves.

use enfilade_frame::{Frame, Layer, traits};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec2, Vec3};
use enfilade_render::{FlowTo, Guide, Lookout, RenderConfig, RenderScene, add_extra_layers, render_frame};
use enfilade_scene::{Alpha, Bsdf, Camera, CameraView, Environment, Intrinsics, Material, Part, Pose, Principled, Quiet, Scene, Shutter};

const CAMERA: Intrinsics = Intrinsics { width: 48, height: 36, fx: 40.0, fy: 42.0, cx: 23.0, cy: 18.5, skew: 0.0 };

/// A rectangle across x, from `low` to `high` in y and z, facing −x.
fn board(x: f32, low: f32, high: f32) -> Mesh {
    let corner = |y: f32, z: f32| Vec3::new(x, y, z);
    Mesh {
        positions: vec![corner(low, low), corner(low, high), corner(high, high), corner(high, low)],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

fn scene(things: Vec<(Mesh, Material)>) -> Scene {
    let mut s = Scene { environment: Some(Environment::Constant { radiance: Rgb::WHITE }), ..Scene::default() };
    for (i, (mesh, material)) in things.into_iter().enumerate() {
        s.parts.push(Part {
            name: format!("part {i}"),
            object: None,
            mesh: i as u32,
            material: i as u32,
            world_from_mesh: DAffine3::IDENTITY,
        });
        s.meshes.push(mesh.into());
        s.materials.push(material);
    }
    s.validate().unwrap();
    s
}

fn grey() -> Material {
    Material::diffuse("grey", Rgb::splat(0.5))
}

fn of(bsdf: Bsdf) -> Material {
    Material { bsdf, ..grey() }
}

/// The frame of the first pose, with the second as the next.
fn frame(s: &Scene, poses: &[Pose]) -> Frame {
    let camera = Camera::from(CAMERA);
    let views: Vec<CameraView> = (0..poses.len()).map(|i| CameraView::of_frame(&camera, poses, i)).collect();
    frame_of(s, &views)
}

/// The frame of the first view, with the second as the next.
fn frame_of(s: &Scene, views: &[CameraView<'_>]) -> Frame {
    let config = RenderConfig { samples: 1, ..RenderConfig::default() };
    let prepared = RenderScene::new(s, &Quiet).unwrap();
    let guide = Guide::learn(&prepared, views, &config);
    let mut frame = render_frame(&prepared, &guide, &views[0], &config, &Quiet).unwrap();
    add_extra_layers(&prepared, &views[0], views.get(1).map(FlowTo::still), &mut frame);
    frame
}

fn pose(number: u32, position: DVec3) -> Pose {
    Pose::look_at(number, position, position + DVec3::new(4.0, 0.1, 0.2), DVec3::Z).unwrap()
}

fn value(frame: &Frame, layer: Layer, index: usize) -> f64 {
    frame.get(layer).unwrap().get(index)
}

fn pixels() -> impl Iterator<Item = (usize, DVec3)> {
    let (w, h) = (CAMERA.width as usize, CAMERA.height as usize);
    (0..w * h).map(move |p| (p, CAMERA.ray((p % w) as f64 + 0.5, (p / w) as f64 + 0.5)))
}

fn thin(transmittance: f32) -> Bsdf {
    Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::splat(transmittance).into() }
}

#[test]
fn behind_panes_lies_the_wall_straight_on() {
    let s = scene(vec![(board(2.0, -9.0, 0.0), of(thin(0.9))), (board(2.5, -9.0, 0.0), of(thin(0.8))), (board(4.0, -30.0, 30.0), grey())]);
    let pose = pose(0, DVec3::ZERO);
    let frame = frame(&s, &[pose]);
    let mut through = 0;
    for (p, ray) in pixels() {
        let direction = (pose.world_from_camera * ray).normalize();
        let wall = 4.0 / direction.x;
        assert!((value(&frame, Layer::DepthBehindMeters, p) - wall).abs() < 1e-4 * wall);
        assert_eq!(value(&frame, Layer::EntityBehindId, p), 3.0);
        let glass = value(&frame, Layer::RenderEntityId, p) == 1.0;
        assert_eq!(value(&frame, Layer::TransmissionWeight, p), f64::from(u8::from(glass)));
        assert_eq!(value(&frame, Layer::SurfaceTraits, p) as u8 & traits::GLASS != 0, glass);
        assert!((value(&frame, Layer::BaseColor, 3 * p) - if glass { 0.9 } else { 0.5 }).abs() < 1e-3);
        through += usize::from(glass);
    }
    assert!(through > 300 && through < 1400, "{through} pixels look through glass");
}

#[test]
fn nothing_lies_behind_what_is_opaque_where_it_is_met() {
    // As metal lets nothing through; and a veil of one half is there in every layer of geometry.
    let metal = Principled { transmission: 1.0.into(), metallic: 1.0.into(), ..Principled::default() };
    let veil = Material { alpha: Alpha::Blend { opacity: 0.5.into() }, ..grey() };
    let s = scene(vec![
        (board(2.0, -9.0, 0.0), of(Bsdf::Principled(Box::new(metal)))),
        (board(2.0, 0.0, 9.0), veil),
        (board(4.0, -30.0, 30.0), grey()),
    ]);
    let frame = frame(&s, &[pose(0, DVec3::ZERO)]);
    let mut parts = [0; 4];
    for (p, _) in pixels() {
        let part = value(&frame, Layer::RenderEntityId, p);
        parts[part as usize] += 1;
        assert_eq!(value(&frame, Layer::EntityBehindId, p), part);
        assert_eq!(value(&frame, Layer::DepthBehindMeters, p), value(&frame, Layer::DepthMeters, p));
        assert_eq!(value(&frame, Layer::SurfaceTraits, p) as u8 & traits::GLASS, 0);
    }
    assert!(parts[1] > 200 && parts[2] > 200, "{parts:?}");
}

#[test]
fn flow_leads_to_where_the_next_frame_shows_the_point() {
    let s = scene(vec![(board(4.0, -30.0, 30.0), grey()), (board(1.5, -0.2, 0.2), grey())]);
    let poses = [pose(0, DVec3::ZERO), pose(1, DVec3::new(0.2, 0.5, 0.1))];
    let frame = frame(&s, &poses);
    let (mut visible, mut hidden, mut left) = (0, 0, 0);
    for (p, ray) in pixels() {
        let direction = (poses[0].world_from_camera * ray).normalize();
        let point = direction * value(&frame, Layer::DepthMeters, p);
        let [now, then] = [0, 1].map(|i| poses[i].world_from_camera.transpose() * (point - poses[i].position));
        let (x, y) = CAMERA.project(then);
        let at = ((p % 48) as f64 + 0.5, (p / 48) as f64 + 0.5);
        for (axis, expected) in [x - at.0, y - at.1].into_iter().enumerate() {
            assert!((value(&frame, Layer::OpticalFlow, 2 * p + axis) - expected).abs() < 1e-3);
        }
        for axis in 0..3 {
            assert!((value(&frame, Layer::SceneFlow, 3 * p + axis) - (then - now)[axis]).abs() < 1e-5);
        }
        let inside = (0.0..48.0).contains(&x) && (0.0..36.0).contains(&y);
        // Is the small board between the next camera and the wall?
        let (from, on_wall) = (poses[1].position, value(&frame, Layer::RenderEntityId, p) == 1.0);
        let crossing = from + (point - from) * (1.5 - from.x) / (point.x - from.x);
        let margin = crossing.y.abs().max(crossing.z.abs()) - 0.2;
        if margin.abs() > 1e-4 || !on_wall {
            let shown = inside && !(on_wall && margin < 0.0);
            assert_eq!(value(&frame, Layer::FlowVisibility, p) == 1.0, shown, "pixel {p}");
            visible += usize::from(shown);
            hidden += usize::from(inside && !shown);
            left += usize::from(!inside);
        }
    }
    assert!(visible > 800 && hidden > 20 && left > 50, "{visible} visible, {hidden} hidden, {left} outside");
}

#[test]
fn flow_leads_to_the_row_of_a_rolling_shutter_that_shows_the_point_however_fast_the_camera_turns() {
    let s = scene(vec![(board(4.0, -30.0, 30.0), grey())]);
    let shutter = Shutter { exposure_s: 0.01, readout_s: 0.03, frame_time_s: 1.0 / 30.0 };
    let camera = Camera { shutter: Some(shutter), ..CAMERA.into() };
    // Down by 30 degrees from one frame to the next.
    let poses = [0u32, 1].map(|number| {
        let (sin, cos) = ((-30f64).to_radians() * f64::from(number)).sin_cos();
        let position = f64::from(number) * DVec3::new(0.1, 0.05, 0.02);
        Pose::look_at(number, position, position + DVec3::new(cos, 0.0, sin), DVec3::Z).unwrap()
    });
    let views = [0, 1].map(|index| CameraView::of_frame(&camera, &poses, index));
    let frame = frame_of(&s, &views);
    let mut visible = 0;
    for p in 0..48 * 36 {
        let at = ((p % 48) as f64 + 0.5, (p / 48) as f64 + 0.5);
        let seen = views[0].centre_ray(at.0, at.1).unwrap();
        let point = seen.origin + seen.direction * value(&frame, Layer::DepthMeters, p);
        let [x, y] = [at.0 + value(&frame, Layer::OpticalFlow, 2 * p), at.1 + value(&frame, Layer::OpticalFlow, 2 * p + 1)];
        // A point that no row shows is projected at the moment of the border's row.
        let there = views[1].project_in_row(point, y.clamp(0.0, 36.0)).unwrap();
        assert!((there.0 - x).abs() < 1e-3 && (there.1 - y).abs() < 1e-3, "pixel {p}: ({x}, {y}), but its row has it at {there:?}");
        visible += usize::from(value(&frame, Layer::FlowVisibility, p) == 1.0);
    }
    assert!((500..1500).contains(&visible), "{visible} of 1728 points are seen again");
}

#[test]
fn the_last_frame_has_no_flow() {
    let frame = frame(&scene(vec![(board(4.0, -30.0, 30.0), grey())]), &[pose(0, DVec3::ZERO)]);
    assert!(value(&frame, Layer::OpticalFlow, 0).is_nan() && value(&frame, Layer::SceneFlow, 0).is_nan());
    assert_eq!(value(&frame, Layer::FlowVisibility, 0), 0.0);
}

#[test]
fn boundaries_run_along_the_outline_of_a_board_and_not_along_the_corner_of_a_room() {
    // A wall, a floor that meets it, and a board in front of both.
    let floor = Mesh {
        positions: vec![Vec3::new(-9.0, -30.0, -1.0), Vec3::new(4.0, -30.0, -1.0), Vec3::new(4.0, 30.0, -1.0), Vec3::new(-9.0, 30.0, -1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let s = scene(vec![(board(4.0, -30.0, 30.0), grey()), (floor, grey()), (board(2.0, -0.3, 0.5), grey())]);
    let frame = frame(&s, &[pose(0, DVec3::ZERO)]);
    let entity = |p: usize| value(&frame, Layer::RenderEntityId, p);
    let mut counts = [0; 3];
    for p in 0..48 * 36 {
        let (x, y) = (p % 48, p / 48);
        let mut beside = Vec::new();
        beside.extend((x > 0).then(|| p - 1));
        beside.extend((x < 47).then(|| p + 1));
        beside.extend((y > 0).then(|| p - 48));
        beside.extend((y < 35).then(|| p + 48));
        let board = |p: usize| entity(p) == 3.0;
        let expected = match (board(p), beside.iter().any(|&q| board(q) != board(p))) {
            (_, false) => 0,
            (true, true) => 1,
            (false, true) => 2,
        };
        assert_eq!(value(&frame, Layer::OcclusionBoundary, p), f64::from(expected), "pixel {x}, {y}");
        counts[expected as usize] += 1;
        // The outline runs through the pixel or it does not; beyond its own corners a pixel shows nothing.
        let partial = value(&frame, Layer::SurfaceTraits, p) as u8 & traits::PARTIAL != 0;
        assert!(!partial || expected > 0 || beside.iter().any(|&q| entity(q) != entity(p)), "pixel {x}, {y}");
    }
    assert!(counts[1] > 20 && counts[2] > 20, "{counts:?}");
}

#[test]
fn metals_mirrors_lamps_and_mixtures_say_what_they_are() {
    let metal =
        |alpha: f32| Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::new(0.9, 0.6, 0.3).into(), alpha: alpha.into() };
    let dull = Bsdf::Diffuse { reflectance: Rgb::splat(0.1).into() };
    let blend = Bsdf::Blend { first: Box::new(metal(0.16)), second: Box::new(dull), weight: 0.25.into() };
    let mut lamp = grey();
    lamp.emission = Rgb::new(3.0, 2.0, 1.0).into();
    let one = |material: Material| {
        let frame = frame(&scene(vec![(board(4.0, -30.0, 30.0), material)]), &[pose(0, DVec3::ZERO)]);
        let v = |layer, i| value(&frame, layer, i);
        let base = [0, 1, 2].map(|c| (v(Layer::BaseColor, c) * 1000.0).round() / 1000.0);
        let traits = v(Layer::SurfaceTraits, 0) as u8;
        (base, v(Layer::Metallic, 0), v(Layer::Roughness, 0), v(Layer::EmittedRadiance, 0), traits, v(Layer::MaterialId, 0))
    };
    let near = |a: f64, b: f64| (a - b).abs() < 2e-3;
    let (base, metallic, roughness, _, kind, id) = one(of(metal(0.0)));
    assert!(
        near(base[0], 0.9) && near(base[2], 0.3) && (metallic, roughness, kind, id) == (1.0, 0.0, traits::MIRROR, 1.0),
        "{base:?} {kind}"
    );
    let (base, metallic, roughness, _, kind, _) = one(of(blend));
    assert!(near(base[0], 0.7) && near(metallic, 0.75) && near(roughness, 0.37f64.sqrt()) && kind == 0, "{base:?} {metallic} {roughness}");
    let (_, metallic, roughness, emitted, kind, _) = one(lamp);
    assert_eq!((metallic, roughness, emitted, kind), (0.0, 1.0, 3.0, traits::EMITTER));
}

#[test]
fn every_surface_along_a_ray_is_met_in_order_with_its_side() {
    let mut turned = board(3.0, -30.0, 30.0);
    turned.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let s = scene(vec![(board(2.0, -30.0, 30.0), of(thin(0.9))), (turned, grey()), (board(4.0, -30.0, 30.0), grey())]);
    let (camera, pose) = (Camera::from(CAMERA), pose(0, DVec3::ZERO));
    let view = CameraView::still(&camera, &pose);
    let lookout = Lookout::through_surfaces(&s).unwrap();
    let found = lookout.surfaces(&view, 4);
    for (pixel, ray) in pixels() {
        let direction = pose.world_from_camera * ray.normalize();
        for (layer, x) in [2.0, 3.0, 4.0].into_iter().enumerate() {
            let at = 4 * pixel + layer;
            let off = f64::from(found.distance_m[at]) * direction.x / x - 1.0;
            assert!(off.abs() < 1e-6, "pixel {pixel}, surface {layer}: {off}");
            assert_eq!((found.entity[at], found.side[at]), (layer as i16 + 1, if layer == 1 { 2 } else { 1 }));
            assert_eq!(found.normal_world[at].map(|v| v.to_f32()), [-1.0, 0.0, 0.0]);
        }
        let beyond = 4 * pixel + 3;
        assert!(found.distance_m[beyond].is_nan() && found.entity[beyond] == -1 && found.side[beyond] == 0);
        // A pane bends nothing, so the way ends on the board behind it.
        let off = found.bent[pixel].way_m / found.distance_m[4 * pixel + 1] - 1.0;
        assert!(found.bent[pixel].entity == 2 && off.abs() < 3e-5, "pixel {pixel}: {off}");
    }
    let nearest = lookout.surfaces(&view, 1);
    assert!(pixels().all(|(pixel, _)| nearest.distance_m[pixel] == found.distance_m[4 * pixel]));
}

#[test]
fn surfaces_in_one_place_are_all_met_and_the_edge_of_two_triangles_is_one_surface() {
    // Two boards in one place that face each other, and a third one that is of two triangles, whose common edge the middle ray meets.
    let mut turned = board(2.0, -30.0, 30.0);
    turned.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let s = scene(vec![(board(2.0, -30.0, 30.0), grey()), (turned, grey()), (board(3.0, -30.0, 30.0), grey())]);
    let camera = Camera::from(Intrinsics { width: 2, height: 2, fx: 1.0, fy: 1.0, cx: 0.5, cy: 0.5, skew: 0.0 });
    let pose = Pose::look_at(0, DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
    let found = Lookout::through_surfaces(&s).unwrap().surfaces(&CameraView::still(&camera, &pose), 4);
    for pixel in 0..4 {
        let mut entities = found.entity[4 * pixel..4 * pixel + 4].to_vec();
        entities[..2].sort_unstable();
        assert_eq!(entities, [1, 2, 3, -1], "pixel {pixel}");
    }
}

#[test]
fn a_slab_of_glass_moves_what_is_behind_it_aside() {
    // Half a metre of glass across x, and a wall 1.5 m behind it.
    let mut back = board(2.5, -30.0, 30.0);
    back.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let glass = Bsdf::Dielectric { eta: 1.5, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::BLACK };
    let s = scene(vec![(board(2.0, -30.0, 30.0), of(glass.clone())), (back, of(glass)), (board(4.0, -30.0, 30.0), grey())]);
    let (camera, pose) = (Camera::from(CAMERA), pose(0, DVec3::ZERO));
    let found = Lookout::through_surfaces(&s).unwrap().surfaces(&CameraView::still(&camera, &pose), 2);
    for (pixel, ray) in pixels() {
        let direction = pose.world_from_camera * ray.normalize();
        let (along, aside) = (direction.x, direction.y.hypot(direction.z));
        let within = aside / 1.5;
        let (tan, tan_within) = (aside / along, within / (1.0 - within * within).sqrt());
        let expected = 3.5 * tan + 0.5 * tan_within;
        let way = 3.5 * tan.hypot(1.0) + 0.5 * tan_within.hypot(1.0);
        let bent = found.bent[pixel];
        let p = DVec3::from(bent.position.map(f64::from));
        assert!((p.x - 4.0).abs() < 1e-5 && bent.entity == 3, "{bent:?}");
        assert!((p.y.hypot(p.z) - expected).abs() < 1e-4, "pixel {pixel}: {} aside, expected {expected}", p.y.hypot(p.z));
        assert!((f64::from(bent.way_m) - way).abs() < 1e-4, "pixel {pixel}: {} m, expected {way}", bent.way_m);
    }
}

/// Fresnel's reflectance of an interface, by the angles.
fn fresnel(cos_i: f64, eta: f64) -> f64 {
    let (i, t) = (cos_i.acos(), (cos_i.acos().sin() / eta).asin());
    0.5 * (((i - t).sin() / (i + t).sin()).powi(2) + ((i - t).tan() / (i + t).tan()).powi(2))
}

/// What guides denoising at pixel `p`: the x of both normals, the others must be 0, and the reflectance.
fn guides(frame: &Frame, p: usize) -> [f64; 3] {
    for layer in [Layer::NormalFilteredWorld, Layer::NormalBeyondWorld] {
        assert_eq!([1, 2].map(|c| value(frame, layer, 3 * p + c)), [0.0; 2]);
    }
    [Layer::NormalFilteredWorld, Layer::NormalBeyondWorld, Layer::ReflectanceBeyond].map(|layer| value(frame, layer, 3 * p))
}

/// `first` in front of the camera, a wall of 0.5 behind it at 4 m, and one of 0.25 behind the camera, at −3 m.
fn between_walls(first: Bsdf) -> (Frame, Pose) {
    let dark = of(Bsdf::Diffuse { reflectance: Rgb::splat(0.25).into() });
    let s = scene(vec![(board(2.0, -30.0, 30.0), of(first)), (board(4.0, -60.0, 60.0), grey()), (board(-3.0, -60.0, 60.0), dark)]);
    let pose = pose(0, DVec3::ZERO);
    (frame(&s, &[pose]), pose)
}

#[test]
fn mirrors_are_guided_by_what_they_show_and_varnish_by_what_it_mirrors() {
    let mirror = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::splat(0.9).into(), alpha: 0.0.into() };
    let varnish =
        Bsdf::Plastic { diffuse: Rgb::splat(0.75).into(), eta: 1.5, alpha: 0.0.into(), specular: Rgb::WHITE.into(), nonlinear: false };
    // Most of the light that varnish sends is diffuse, but its residual is a mirror image.
    for (first, way_x) in [(mirror, 2.0 + 5.0), (varnish, 2.0)] {
        let (frame, pose) = between_walls(first);
        for (p, ray) in pixels() {
            assert_eq!(guides(&frame, p), [-1.0, 1.0, 0.25]);
            let way = way_x / (pose.world_from_camera * ray).normalize().x;
            assert!((value(&frame, Layer::DepthBeyondMeters, p) / way - 1.0).abs() < 1e-5);
        }
    }
}

#[test]
fn panes_are_guided_by_both_sides_in_proportion_to_their_light() {
    let (frame, pose) = between_walls(Bsdf::ThinDielectric { eta: 3.0, transmittance: Rgb::splat(0.9).into() });
    for (p, ray) in pixels() {
        let direction = (pose.world_from_camera * ray).normalize();
        let r = fresnel(direction.x, 3.0);
        let mirrored = 2.0 * r / (1.0 + r);
        let share = mirrored / (mirrored + 0.9 * (1.0 - mirrored));
        let [filtered, beyond, reflectance] = guides(&frame, p);
        assert_eq!(filtered, -1.0);
        assert!((beyond - (share - (1.0 - share))).abs() < 5e-3, "{beyond} at a share of {share}");
        assert!((reflectance - (0.25 * share + 0.5 * (1.0 - share))).abs() < 2e-3, "{reflectance} at a share of {share}");
        assert!((value(&frame, Layer::DepthBeyondMeters, p) * direction.x - 4.0).abs() < 1e-4);
    }
    // A pane of window glass mirrors too little to matter, and rough metal shows nothing that could be made out.
    let (through, _) = between_walls(thin(0.9));
    let rough = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: Rgb::WHITE.into(), alpha: 0.3.into() };
    let (blurred, _) = between_walls(rough);
    for (p, _) in pixels() {
        assert_eq!(guides(&through, p), [-1.0, -1.0, 0.5]);
        assert_eq!(guides(&blurred, p), [-1.0, -1.0, 1.0]);
    }
}

#[test]
fn a_bent_way_through_a_block_of_glass_ends_on_the_wall_behind_it() {
    let glass = Bsdf::Dielectric { eta: 1.5, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::BLACK };
    let mut block = board(2.0, -30.0, 30.0);
    let mut far_side = board(3.0, -30.0, 30.0);
    far_side.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    block.append(&far_side);
    let s = scene(vec![(block, of(glass)), (board(4.0, -60.0, 60.0), grey())]);
    let pose = pose(0, DVec3::ZERO);
    let frame = frame(&s, &[pose]);
    for (p, ray) in pixels() {
        assert_eq!(guides(&frame, p), [-1.0, -1.0, 0.5]);
        let cos = (pose.world_from_camera * ray).normalize().x;
        let cos_within = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
        let way = 2.0 / cos + 1.0 / cos_within + 1.0 / cos;
        assert!((value(&frame, Layer::DepthBeyondMeters, p) / way - 1.0).abs() < 1e-4, "pixel {p}");
    }
}

#[test]
fn guides_are_means_over_the_samples_and_the_background_has_none() {
    // The edge of the board runs through the middle column of pixels.
    let s = scene(vec![(board(4.0, -30.0, 0.0), grey())]);
    let camera = Camera::from(CAMERA);
    let pose = Pose::look_at(0, DVec3::ZERO, DVec3::X, DVec3::Z).unwrap();
    let prepared = RenderScene::new(&s, &Quiet).unwrap();
    let config = RenderConfig { samples: 64, adaptive: false, ..RenderConfig::default() };
    let view = CameraView::still(&camera, &pose);
    let guide = Guide::learn(&prepared, &[view], &config);
    let frame = render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap();
    let mut shared = 0;
    for (p, _) in pixels() {
        let [filtered, beyond, reflectance] = guides(&frame, p);
        // Colour shows as much of the board: the sky behind it is white, the board grey by an unknown part.
        assert!((-1.0..=0.0).contains(&filtered) && (beyond - filtered).abs() < 0.2 && reflectance == 1.0);
        let seen = value(&frame, Layer::DiffuseReflectance, 3 * p) / 0.5;
        assert!((filtered + seen).abs() < 2e-3, "{filtered}, but {seen} of the pixel shows the board");
        shared += usize::from(filtered > -1.0 && filtered < 0.0);
    }
    assert!(shared > 30, "{shared} pixels show both");
}
