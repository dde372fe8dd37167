//! A look before rendering has the values of the rendered frame, and knows which sides it sees.

use enfilade_frame::{Frame, Layer};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec2, Vec3};
use enfilade_render::{Guide, Look, Lookout, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{
    Alpha, Camera, CameraView, Environment, Fisheye, Image, Intrinsics, Material, Part, Pixels, Pose, Projection, Quiet, ScalarParam,
    Scene, TextureRef,
};

const LAYERS: [Layer; 5] = [Layer::DepthMeters, Layer::DepthZMeters, Layer::Position, Layer::NormalWorld, Layer::RenderEntityId];

fn quad(origin: Vec3, e1: Vec3, e2: Vec3) -> Mesh {
    Mesh {
        positions: vec![origin, origin + e1, origin + e1 + e2, origin + e2],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A floor seen from above, and over it a board of which the left half is cut out, seen from behind; void beyond them.
fn scene() -> Scene {
    let mut s = Scene { environment: Some(Environment::Constant { radiance: Rgb::WHITE }), ..Scene::default() };
    let texels = vec![[255, 255, 255, 0], [255, 255, 255, 255]];
    s.images.push(Image { name: "half".into(), width: 2, height: 1, pixels: Pixels::Rgba8 { srgb: true, texels } }.into());
    s.materials.push(Material::diffuse("grey", Rgb::splat(0.5)));
    let mut cut = Material::diffuse("cut", Rgb::splat(0.5));
    cut.alpha = Alpha::Mask { opacity: ScalarParam { factor: 1.0, texture: Some((TextureRef::new(0), 3)) }, cutoff: 0.5 };
    s.materials.push(cut);
    s.meshes.push(quad(Vec3::new(-2.0, -2.0, 0.0), Vec3::X * 4.0, Vec3::Y * 4.0).into());
    s.meshes.push(quad(Vec3::new(1.0, -1.0, 1.0), Vec3::X * -2.0, Vec3::Y * 2.0).into());
    for mesh in 0..2 {
        s.parts.push(Part { name: format!("part {mesh}"), object: None, mesh, material: mesh, world_from_mesh: DAffine3::IDENTITY });
    }
    s.validate().unwrap();
    s
}

fn pose() -> Pose {
    Pose::look_at(0, DVec3::new(0.3, -0.4, 4.0), DVec3::new(0.2, 0.1, 0.0), DVec3::Y).unwrap()
}

fn look(s: &Scene, camera: &Camera, step: u32) -> Look {
    Lookout::new(s).unwrap().look(&CameraView::still(camera, &pose()), step)
}

fn bits(frame: &Frame, layer: Layer) -> Vec<u64> {
    let values = frame.get(layer).unwrap();
    (0..values.len()).map(|i| values.get(i).to_bits()).collect()
}

#[test]
fn a_look_in_full_has_the_values_of_the_rendered_frame() {
    let (s, camera) = (scene(), Camera::from(Intrinsics::from_fov_x(60, 45, 1.4)));
    let view = CameraView::still(&camera, &pose());
    let (prepared, config) = (RenderScene::new(&s, &Quiet).unwrap(), RenderConfig { samples: 1, ..RenderConfig::default() });
    let guide = Guide::learn(&prepared, &[view], &config);
    let rendered = render_frame(&prepared, &guide, &view, &config, &Quiet).unwrap();
    let look = look(&s, &camera, 1);
    for layer in LAYERS {
        assert_eq!(bits(&look.frame, layer), bits(&rendered, layer), "{layer:?}");
    }
    assert_eq!(look.seeing, 60 * 45);
}

#[test]
fn a_coarse_look_has_the_values_of_the_pixels_in_the_middle_of_its_cells() {
    let (s, camera) = (scene(), Camera::from(Intrinsics::from_fov_x(61, 45, 1.4)));
    let (whole, coarse) = (look(&s, &camera, 1), look(&s, &camera, 4));
    assert_eq!((coarse.frame.width, coarse.frame.height), (16, 12));
    let depth = |look: &Look, i: usize| look.frame.get(Layer::DepthMeters).unwrap().get(i).to_bits();
    for (x, y) in [(0, 0), (5, 3), (15, 11)] {
        let (column, row) = ((4 * x + 2).min(60), (4 * y + 2).min(44));
        assert_eq!(depth(&coarse, y * 16 + x), depth(&whole, row * 61 + column), "{x} {y}");
    }
}

#[test]
fn backs_are_known_and_cut_outs_are_not_there() {
    let (s, camera) = (scene(), Camera::from(Intrinsics::from_fov_x(60, 45, 1.4)));
    let look = look(&s, &camera, 1);
    let ids = look.frame.get(Layer::RenderEntityId).unwrap();
    let seen = |id: f64| (0..ids.len()).filter(move |&i| ids.get(i) == id);
    assert!(seen(2.0).count() > 50 && seen(2.0).all(|i| look.behind[i]) && seen(1.0).all(|i| !look.behind[i]));
    // The board's texture begins at its right border: what is cut out is the half at greater x, where the floor shows.
    let x = |i: usize| look.frame.get(Layer::Position).unwrap().get(3 * i);
    let opaque: Vec<f64> = seen(2.0).map(x).collect();
    assert!(opaque.iter().all(|x| *x < 0.5), "{opaque:?}");
}

#[test]
fn pixels_beyond_the_rim_of_a_fisheye_do_not_see() {
    let pinhole = Intrinsics { width: 60, height: 60, fx: 8.0, fy: 8.0, cx: 30.0, cy: 30.0, skew: 0.0 };
    let camera = Camera::from(Projection::Fisheye(pinhole, Fisheye::new([0.0; 4]).unwrap()));
    let look = look(&scene(), &camera, 1);
    let rays = (0..3600).filter(|i| camera.projection.ray(f64::from(i % 60) + 0.5, f64::from(i / 60) + 0.5).is_some()).count();
    assert!(look.seeing == rays && rays < 3600, "{rays}");
}
