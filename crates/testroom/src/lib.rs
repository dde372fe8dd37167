//! An analytic frame for tests: every layer of a room corner whose values are known in closed form.
//!
//! Floor (part 1, z = 0), wall (part 2, y = 2, up to z = 2.5) and a mirror in the wall (part 3), void above. The mirror has no
//! diffuse reflectance; one of its pixels is saturated.

mod dataset;

pub use dataset::{dataset, fixtures, rooms, surfaces};
use enfilade_frame::{Dtype, FixtureLayers, Frame, LAYERS, Layer, Validity, Values, f16, traits};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec2, DVec3, Rgb, Vec3};
use enfilade_scene::{Intrinsics, Labels, Material, Part, PartLabel, Pose, Scene, WorldMesh};

/// Names of the parts, in the order of their numbers.
pub const PARTS: [&str; 3] = ["floor", "wall", "wall/mirror"];

/// The camera: 64 by 48 pixels, 70 degrees wide.
pub fn intrinsics() -> Intrinsics {
    Intrinsics::from_fov_x(64, 48, 70f64.to_radians())
}

/// Pose of the camera of the first frame: in front of the wall, looking at the mirror.
pub fn pose() -> Pose {
    Pose::look_at(0, DVec3::new(0.3, -3.0, 1.5), DVec3::new(-0.2, 1.0, 1.4), DVec3::new(0.02, 0.0, 1.0)).unwrap()
}

/// Labels of the parts: a floor, a wall, and a mirror, which is instance 1.
pub fn labels() -> Labels {
    let label = |semantic, instance| PartLabel { semantic, instance };
    Labels { parts: vec![label(2, -1), label(1, -1), label(19, 1)] }
}

/// The hit of a ray: distance along it, part, normal toward the camera, texture coordinates.
fn meet(origin: DVec3, direction: DVec3) -> Option<(f64, i16, DVec3, DVec2)> {
    let to_floor = -origin.z / direction.z;
    let to_wall = (2.0 - origin.y) / direction.y;
    let wall = origin + direction * to_wall;
    if to_wall > 0.0 && (0.0..2.5).contains(&wall.z) {
        let mirror = wall.x.abs() < 0.5 && (1.0..2.0).contains(&wall.z);
        return Some((to_wall, if mirror { 3 } else { 2 }, DVec3::NEG_Y, DVec2::new(wall.x, wall.z)));
    }
    let floor = origin + direction * to_floor;
    (to_floor > 0.0 && floor.y < 2.0).then_some((to_floor, 1, DVec3::Z, DVec2::new(floor.x, floor.y)))
}

/// The frame seen from `pose`.
pub fn frame(pose: &Pose) -> Frame {
    let k = intrinsics();
    let labels = labels();
    let mut layers: Vec<Vec<f64>> = vec![Vec::new(); LAYERS.len()];
    let mut push = |layer: Layer, values: &[f64]| layers[layer as usize].extend(values);
    for i in 0..k.width * k.height {
        let (x, y) = (f64::from(i % k.width) + 0.5, f64::from(i / k.width) + 0.5);
        let direction_camera = k.ray(x, y).normalize();
        let hit = meet(pose.position, pose.world_from_camera * direction_camera);
        let (distance, id, normal, uv) = hit.unwrap_or((f64::NAN, -1, DVec3::NAN, DVec2::ZERO));
        let position = pose.position + pose.world_from_camera * direction_camera * distance;
        let in_camera = pose.world_from_camera.transpose() * normal;
        push(Layer::DepthMeters, &[distance]);
        push(Layer::DepthZMeters, &[-direction_camera.z * distance]);
        push(Layer::Position, &position.to_array());
        [Layer::NormalWorld, Layer::NormalBumpWorld].into_iter().for_each(|l| push(l, &normal.to_array()));
        [Layer::NormalCam, Layer::NormalBumpCam].into_iter().for_each(|l| push(l, &in_camera.to_array()));
        push(Layer::TexCoord, &[uv.x, uv.y, 0.0]);
        push(Layer::RenderEntityId, &[f64::from(id)]);
        let label = usize::try_from(id - 1).map_or(PartLabel::NONE, |part| labels.parts[part]);
        push(Layer::Semantic, &[f64::from(label.semantic)]);
        push(Layer::SemanticInstance, &[f64::from(label.instance)]);
        let saturated = id == 3 && i == 20 * k.width + 36;
        let (a, s, r) = match id {
            1 => (0.5, 0.8, 0.05),
            2 => (0.7, 0.4 + 0.3 * (x / 64.0), 0.02),
            3 => (0.0, 0.3, if saturated { 65504.0 } else { 0.6 }),
            _ => (0.0, 0.0, 1.5),
        };
        let [a, s, r] = [a, s, r].map(|v| f16::from_f64(v).to_f32());
        push(Layer::DiffuseReflectance, &[f64::from(a); 3]);
        [Layer::DiffuseIllumination, Layer::DiffuseIlluminationRendered].into_iter().for_each(|l| push(l, &[f64::from(s); 3]));
        [Layer::Residual, Layer::ResidualRendered].into_iter().for_each(|l| push(l, &[f64::from(r); 3]));
        [Layer::Color, Layer::ColorRendered].into_iter().for_each(|l| push(l, &[f64::from(a * s + r); 3]));
        [Layer::NormalFilteredWorld, Layer::NormalBeyondWorld]
            .into_iter()
            .for_each(|l| push(l, &normal.to_array().map(|v| if v.is_nan() { 0.0 } else { v })));
        push(Layer::ReflectanceBeyond, &[1.0; 3]);
        push(Layer::ColorStandardError, &[f64::from(0.125 * (a * s + r))]);
        // The floor is lit from the void, the wall by a lamp.
        let diffuse = f64::from(a * s);
        let (r, seen) = (f64::from(r), id != -1);
        push(Layer::DiffuseDirect, &[0.75 * diffuse; 3]);
        push(Layer::DiffuseIndirect, &[0.25 * diffuse; 3]);
        push(Layer::Specular, &[if seen { r } else { 0.0 }; 3]);
        push(Layer::Transmission, &[0.0; 3]);
        push(Layer::Emission, &[if seen { 0.0 } else { r }; 3]);
        push(Layer::LightEnvironment, &[if id <= 1 { diffuse + r } else { 0.0 }; 3]);
        push(Layer::LightSurfaces, &[if id <= 1 { 0.0 } else { 0.5 * (diffuse + r) }; 3]);
        push(Layer::LightPoints, &[if id <= 1 { 0.0 } else { 0.5 * (diffuse + r) }; 3]);
        push(Layer::LightDistant, &[0.0; 3]);
        push(Layer::MaterialId, &[f64::from(id)]);
        push(Layer::BaseColor, &[f64::from(a); 3]);
        push(Layer::Metallic, &[f64::from(u8::from(id == 3))]);
        push(Layer::Roughness, &[if id == 3 || !seen { 0.0 } else { 1.0 }]);
        push(Layer::TransmissionWeight, &[0.0]);
        push(Layer::EmittedRadiance, &[0.0; 3]);
        push(Layer::NormalGeometricWorld, &normal.to_array());
        push(Layer::SurfaceTraits, &[f64::from(u8::from(id == 3) * traits::MIRROR)]);
        push(Layer::DepthBehindMeters, &[distance]);
        push(Layer::EntityBehindId, &[f64::from(id)]);
        push(Layer::DepthBeyondMeters, &[distance]);
        push(Layer::OcclusionBoundary, &[0.0]);
        // The camera rests.
        push(Layer::OpticalFlow, &[if seen { 0.0 } else { f64::NAN }; 2]);
        push(Layer::SceneFlow, &[if seen { 0.0 } else { f64::NAN }; 3]);
        push(Layer::FlowVisibility, &[f64::from(u8::from(seen))]);
        let code = match id {
            -1 => Validity::Void,
            3 if saturated => Validity::Saturated,
            3 => Validity::NoDiffuse,
            _ => Validity::Valid,
        };
        push(Layer::Valid, &[f64::from(code as u8)]);
    }
    let mut frame = Frame::new(k.width, k.height);
    for (spec, values) in LAYERS.iter().zip(layers) {
        frame.insert(spec.layer, store(spec.layer, values));
    }
    add_fixtures(&mut frame);
    frame
}

/// Adds the light of two fixtures: the sky, which lights the floor and is seen in the void, and a lamp, which lights all else.
fn add_fixtures(frame: &mut Frame) {
    let [illumination, residual, reflectance] =
        [Layer::DiffuseIllumination, Layer::Residual, Layer::DiffuseReflectance].map(|layer| frame.get(layer).unwrap().clone());
    let ids = frame.get(Layer::RenderEntityId).unwrap().clone();
    for is_sky in [true, false] {
        let own = |values: &Values, has: &dyn Fn(usize) -> bool| {
            let value = |i: usize| if (ids.get(i / 3) <= 1.0) == is_sky && has(i) { values.get(i) } else { 0.0 };
            Values::F16((0..values.len()).map(|i| f16::from_f64(value(i))).collect())
        };
        let diffuse_illumination = own(&illumination, &|i| reflectance.get(i) > 0.0);
        let light = FixtureLayers { diffuse_illumination, residual: own(&residual, &|_| true) };
        frame.push_fixture(light);
    }
}

/// Values in the type of a layer.
pub fn store(layer: Layer, values: Vec<f64>) -> Values {
    match layer.spec().dtype {
        Dtype::F16 => Values::F16(values.into_iter().map(f16::from_f64).collect()),
        Dtype::F32 => Values::F32(values.into_iter().map(|v| v as f32).collect()),
        Dtype::I16 => Values::I16(values.into_iter().map(|v| v as i16).collect()),
        Dtype::U8 => Values::U8(values.into_iter().map(|v| v as u8).collect()),
    }
}

/// Rewrites the channels of one pixel.
pub fn set(frame: &mut Frame, layer: Layer, pixel: usize, channels: &[f64]) {
    let values = frame.get(layer).unwrap();
    let mut all: Vec<f64> = (0..values.len()).map(|i| values.get(i)).collect();
    let at = pixel * channels.len();
    all[at..at + channels.len()].copy_from_slice(channels);
    frame.insert(layer, store(layer, all));
}

/// The first pixel of a part, or of the void (−1), with its left and right neighbours of the same.
pub fn pixel_of(frame: &Frame, part: i16) -> usize {
    let ids = frame.get(Layer::RenderEntityId).unwrap();
    let is = |i: usize| ids.get(i) == f64::from(part);
    (1..frame.pixels() - 1).find(|&i| is(i) && is(i - 1) && is(i + 1)).unwrap()
}

/// A scene whose parts have the names of the analytic frame's; their shapes do not matter.
pub fn scene() -> Scene {
    let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Default::default() };
    let part = |name: &str| Part { name: name.into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
    Scene {
        meshes: vec![mesh.into()],
        parts: PARTS.map(part).into(),
        materials: vec![Material::diffuse("paint", Rgb::splat(0.5))],
        ..Default::default()
    }
}

/// A closed box room as rays meet it: part 0, six sides of two triangles.
pub fn box_room(min: DVec3, max: DVec3) -> WorldMesh {
    let corner = |i: usize| DVec3::new([min.x, max.x][i & 1], [min.y, max.y][(i >> 1) & 1], [min.z, max.z][i >> 2]).as_vec3();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() };
    let part = Part { name: "room".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
    let materials = vec![Material::diffuse("grey", Rgb::splat(0.5))];
    WorldMesh::new(&Scene { meshes: vec![mesh.into()], parts: vec![part], materials, ..Scene::default() })
}
