//! Each law is broken in an otherwise correct frame, and no other law fails for it.

use super::*;
use enfilade_frame::{Frame, Layer, Pass, Values, compose, f16};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, CameraView, Intrinsics, Labels, PartLabel, Pose};
use enfilade_testroom::{self as testroom, pixel_of, set};

/// The analytic frame and what it is checked against; tests break one or the other.
struct Case {
    frame: Frame,
    pose: Pose,
    intrinsics: Intrinsics,
    labels: Labels,
    pieces: Vec<(u32, PartLabel)>,
}

impl Case {
    fn new() -> Self {
        let pose = testroom::pose();
        let (frame, intrinsics, labels) = (testroom::frame(&pose), testroom::intrinsics(), testroom::labels());
        Self { frame, pose, intrinsics, labels, pieces: Vec::new() }
    }

    fn card(&self) -> Card {
        let camera = Camera::from(self.intrinsics);
        let view = View {
            camera: CameraView::still(&camera, &self.pose),
            rounding: Rounding::default(),
            denoised: true,
            released: false,
            entities: self.labels.parts.len(),
            labels: Some(&self.labels),
            pieces: &self.pieces,
            last_class: 40,
        };
        check_frame(&self.frame, &view, "room/cam_00/frame.0000")
    }

    fn vector(&self, layer: Layer, pixel: usize) -> DVec3 {
        enfilade_frame::vector(self.frame.get(layer).unwrap(), pixel)
    }

    /// Drops the layers of light parts, and sets the error of pixel `p` to none: for tests that change its colour.
    fn forget_parts_and_error(&mut self, p: usize) {
        let mut frame = Frame::new(self.frame.width, self.frame.height);
        let kept = self.frame.iter().filter(|(layer, _)| layer.spec().pass != Pass::LightParts);
        kept.for_each(|(layer, values)| frame.insert(layer, values.clone()));
        self.frame = frame;
        self.set(Layer::ColorStandardError, p, &[0.0]);
    }

    /// Rewrites one pixel of a layer.
    fn set(&mut self, layer: Layer, pixel: usize, channels: &[f64]) {
        set(&mut self.frame, layer, pixel, channels);
    }
}

/// The laws that fail after `change`, which receives a pixel of the floor.
fn failures(change: impl Fn(&mut Case, usize)) -> Vec<Law> {
    let mut case = Case::new();
    let floor = pixel_of(&case.frame, 1);
    change(&mut case, floor);
    case.card().failures()
}

#[test]
fn exact_frame_satisfies_every_frame_law() {
    let card = Case::new().card();
    assert_eq!(card.failures(), []);
    let report = VerifyReport::new(&card, 1, vec![FrameValues::default()], vec![], vec![]);
    assert!(report.passed);
    let checked: Vec<Law> = report.laws.iter().map(|l| l.law).collect();
    let frame_laws: Vec<Law> = LAWS
        .iter()
        .map(|spec| spec.law)
        .filter(|&law| law == Law::LayersPresent || law == Law::Calibration || (Law::SeesScene..Law::InstanceClass).contains(&law))
        .collect();
    assert_eq!(checked, frame_laws);
}

#[test]
fn missing_layers_and_wrong_sizes_are_found() {
    let without = |c: &mut Case, _| {
        let mut frame = Frame::new(c.frame.width, c.frame.height);
        c.frame.iter().filter(|(layer, _)| *layer != Layer::TexCoord).for_each(|(layer, values)| frame.insert(layer, values.clone()));
        c.frame = frame;
    };
    assert_eq!(failures(without), [Law::LayersPresent]);
    let keep = |c: &mut Case, wanted: &dyn Fn(Layer) -> bool| {
        let mut frame = Frame::new(c.frame.width, c.frame.height);
        c.frame.iter().filter(|(layer, _)| wanted(*layer)).for_each(|(layer, values)| frame.insert(layer, values.clone()));
        c.frame = frame;
    };
    assert_eq!(failures(|c, _| keep(c, &|layer| layer.spec().pass != Pass::Rendered)), [], "denoised layers are there when asked for");
    assert_eq!(failures(|c, _| keep(c, &|layer| layer != Layer::ResidualRendered)), [Law::LayersPresent]);
    assert_eq!(failures(|c, _| keep(c, &|layer| layer.spec().pass != Pass::LightParts)), [], "light is kept in parts when asked for");
    assert_eq!(failures(|c, _| keep(c, &|layer| layer != Layer::Emission)), [Law::LayersPresent]);
    assert_eq!(failures(|c, _| keep(c, &|layer| layer.spec().pass != Pass::Guides)), [], "guides go with what was rendered");
    assert_eq!(failures(|c, _| keep(c, &|layer| layer != Layer::ReflectanceBeyond)), [Law::LayersPresent]);
    assert_eq!(failures(|c, _| keep(c, &|layer| layer != Layer::DepthBeyondMeters)), [], "frames of earlier versions are without it");
    assert_eq!(failures(|c, _| c.intrinsics.height += 1), [Law::Calibration]);
}

#[test]
fn a_frame_of_the_void_is_found() {
    let sky = |c: &mut Case, _| {
        let up = c.pose.position + DVec3::new(0.0, -1.0, 3.0);
        c.pose = Pose::look_at(0, c.pose.position, up, DVec3::Z).unwrap();
        c.frame = testroom::frame(&c.pose);
    };
    assert_eq!(failures(sky), [Law::SeesScene]);
}

#[test]
fn ids_and_codes_are_checked() {
    let foreign_part = |c: &mut Case, p| {
        c.set(Layer::RenderEntityId, p, &[9.0]);
        c.set(Layer::EntityBehindId, p, &[9.0]);
        c.set(Layer::Semantic, p, &[-1.0]);
    };
    assert_eq!(failures(foreign_part), [Law::EntityIds]);
    assert_eq!(failures(|c, p| c.set(Layer::Valid, p, &[0.0])), [Law::VoidCode]);
    assert_eq!(failures(|c, p| c.set(Layer::Valid, p, &[3.0])), [Law::ReasonCodes]);
    assert_eq!(failures(|c, p| c.set(Layer::Valid, p, &[4.0])), [Law::ReasonCodes]);
}

#[test]
fn pixels_brighter_than_float16_hold_to_every_law() {
    let half = f16::from_f64(0.5);
    let brightness = [(2.66f32, 1e6f32), (32.0, 1e6), (1e6, 0.05)];
    for (illumination, residual) in brightness {
        let stored = compose(half, illumination, residual);
        assert!(stored.saturated);
        let too_bright = |c: &mut Case, p: usize| {
            c.forget_parts_and_error(p);
            c.set(Layer::DiffuseReflectance, p, &[0.5; 3]);
            let values = [
                (stored.color, [Layer::Color, Layer::ColorRendered]),
                (stored.illumination, [Layer::DiffuseIllumination, Layer::DiffuseIlluminationRendered]),
                (stored.residual, [Layer::Residual, Layer::ResidualRendered]),
            ];
            for (value, layers) in values {
                layers.into_iter().for_each(|layer| c.set(layer, p, &[value.to_f64(); 3]));
            }
            // The error belongs to the light before it was clipped.
            c.set(Layer::ColorStandardError, p, &[60_000.0]);
            c.set(Layer::Valid, p, &[2.0]);
        };
        assert_eq!(failures(too_bright), [], "{illumination}, {residual}");
        let unmarked = |c: &mut Case, p: usize| {
            too_bright(c, p);
            c.set(Layer::Valid, p, &[1.0]);
        };
        // If rounding leaves the colour below the limit, either code is valid.
        let expected: &[Law] = if illumination == 32.0 { &[] } else { &[Law::ReasonCodes] };
        assert_eq!(failures(unmarked), expected, "{illumination}, {residual}");
    }
    assert_eq!(failures(|c, p| c.set(Layer::Valid, p, &[2.0])), [Law::ReasonCodes]);
}

#[test]
fn extra_layers_must_fit_the_geometry() {
    for (layer, wrong) in [
        (Layer::BaseColor, &[0.5, 1.2, 0.5][..]),
        (Layer::Roughness, &[-0.1]),
        (Layer::NormalGeometricWorld, &[0.0, 0.0, 0.9]),
        (Layer::DepthBehindMeters, &[0.5]),
        (Layer::DepthBeyondMeters, &[0.5]),
        (Layer::NormalBeyondWorld, &[0.8, 0.8, 0.0]),
        (Layer::ReflectanceBeyond, &[0.5, 1.2, 0.5]),
        (Layer::EntityBehindId, &[2.0]),
        (Layer::OcclusionBoundary, &[3.0]),
        (Layer::OpticalFlow, &[f64::NAN; 2]),
    ] {
        assert_eq!(failures(|c, p| c.set(layer, p, wrong)), [Law::ExtraLayers], "{layer:?}");
    }
    let glass = |c: &mut Case, p| {
        c.set(Layer::SurfaceTraits, p, &[2.0]);
        c.set(Layer::DepthBehindMeters, p, &[40.0]);
        c.set(Layer::EntityBehindId, p, &[2.0]);
    };
    assert_eq!(failures(glass), []);
}

#[test]
fn values_in_the_void_and_texture_coordinates_are_checked() {
    let void_normal = |c: &mut Case, _| {
        let void = pixel_of(&c.frame, -1);
        c.set(Layer::NormalWorld, void, &[0.0, 0.0, 1.0]);
    };
    assert_eq!(failures(void_normal), [Law::GeometryFinite]);
    assert_eq!(failures(|c, p| c.set(Layer::TexCoord, p, &[0.5, 0.5, 1.0])), [Law::TexCoord]);
    assert_eq!(failures(|c, p| c.set(Layer::TexCoord, p, &[0.5, f64::INFINITY, 0.0])), [Law::TexCoord]);
}

#[test]
fn colour_laws_are_checked() {
    let infinite = |c: &mut Case, p| {
        for layer in [Layer::Color, Layer::Residual, Layer::ColorRendered, Layer::ResidualRendered] {
            c.set(layer, p, &[f64::INFINITY; 3]);
        }
        c.set(Layer::Valid, p, &[2.0]);
    };
    assert_eq!(failures(infinite), [Law::ColorFinite]);
    let negative = |c: &mut Case, p| {
        c.forget_parts_and_error(p);
        c.set(Layer::DiffuseIllumination, p, &[0.0; 3]);
        c.set(Layer::Residual, p, &[-0.25; 3]);
        c.set(Layer::Color, p, &[-0.25; 3]);
    };
    assert_eq!(failures(negative), [Law::ColorNotNegative]);
    let too_white = |c: &mut Case, p| {
        c.forget_parts_and_error(p);
        c.set(Layer::DiffuseReflectance, p, &[1.5; 3]);
        for (illumination, color) in
            [(Layer::DiffuseIllumination, Layer::Color), (Layer::DiffuseIlluminationRendered, Layer::ColorRendered)]
        {
            c.set(illumination, p, &[0.0; 3]);
            c.set(color, p, &[c.frame.get(Layer::Residual).unwrap().get(3 * p); 3]);
        }
    };
    assert_eq!(failures(too_white), [Law::Albedo]);
    let one_bit = |c: &mut Case, p: usize| {
        let Some(Values::F16(mut values)) = c.frame.get(Layer::Color).cloned() else { panic!("colour is float16") };
        values[3 * p + 1] = f16::from_bits(values[3 * p + 1].to_bits() + 1);
        c.frame.insert(Layer::Color, Values::F16(values));
    };
    assert_eq!(failures(one_bit), [Law::Recomposition]);
    for error in [0.0, 0.4, f64::NAN, -0.01, 0.5] {
        let expected: &[Law] = if (0.0..0.45).contains(&error) { &[] } else { &[Law::StandardError] };
        assert_eq!(failures(|c, p| c.set(Layer::ColorStandardError, p, &[error])), expected, "{error}");
    }
    let one_sample = |c: &mut Case, _| {
        let unknown = vec![f64::NAN; c.frame.pixels()];
        c.frame.insert(Layer::ColorStandardError, testroom::store(Layer::ColorStandardError, unknown));
    };
    assert_eq!(failures(one_sample), []);
    for part in [Layer::DiffuseIndirect, Layer::Transmission, Layer::LightDistant] {
        assert_eq!(failures(|c, p| c.set(part, p, &[0.002; 3])), [Law::LightParts], "{part:?}");
    }
    // The parts of light belong to the rendered layers.
    let rendered = |c: &mut Case, p: usize| c.set(Layer::ResidualRendered, p, &[0.5; 3]);
    assert_eq!(failures(rendered), [Law::Recomposition, Law::LightParts]);
    let denoised = |c: &mut Case, p: usize| c.set(Layer::Residual, p, &[0.5; 3]);
    assert_eq!(failures(denoised), [Law::Recomposition]);
}

#[test]
fn distance_depth_and_position_are_checked_against_each_other() {
    let farther = |c: &mut Case, p| {
        let t = c.pose.position;
        c.set(Layer::Position, p, &(t + (c.vector(Layer::Position, p) - t) * 1.001).to_array());
    };
    assert_eq!(failures(farther), [Law::Distance]);
    let planar = |c: &mut Case, p| c.set(Layer::DepthZMeters, p, &[c.frame.get(Layer::DepthZMeters).unwrap().get(p) * 1.001]);
    assert_eq!(failures(planar), [Law::PlanarDepth]);
    let aside = |c: &mut Case, p: usize| {
        let (x, y) = (p % 64, p / 64);
        let direction = c.pose.world_from_camera * c.intrinsics.ray(x as f64 + 0.55, y as f64 + 0.5).normalize();
        let distance = c.frame.get(Layer::DepthMeters).unwrap().get(p);
        c.set(Layer::Position, p, &(c.pose.position + direction * distance).to_array());
    };
    assert_eq!(failures(aside), [Law::Projection]);
    let behind = |c: &mut Case, p| {
        let t = c.pose.position;
        c.set(Layer::Position, p, &(2.0 * t - c.vector(Layer::Position, p)).to_array());
    };
    assert_eq!(failures(behind), [Law::Projection]);
}

#[test]
fn normals_are_checked() {
    let both = |c: &mut Case, p, world: Layer, camera: Layer, change: &dyn Fn(DVec3) -> DVec3| {
        for layer in [world, camera] {
            c.set(layer, p, &change(c.vector(layer, p)).to_array());
        }
    };
    let bump = (Layer::NormalBumpWorld, Layer::NormalBumpCam);
    let smooth = (Layer::NormalWorld, Layer::NormalCam);
    assert_eq!(failures(|c, p| both(c, p, bump.0, bump.1, &|n| 1.01 * n)), [Law::UnitNormals]);
    assert_eq!(failures(|c, p| both(c, p, smooth.0, smooth.1, &|n| -n)), [Law::NormalFacing]);
    assert_eq!(failures(|c, p| both(c, p, bump.0, bump.1, &|n| -n)), [Law::BumpFacing]);
    assert_eq!(failures(|c, p| c.set(smooth.1, p, &[0.0, 0.0, 1.0])), [Law::NormalCamera]);
    assert_eq!(failures(|c, p| c.set(bump.1, p, &[0.0, 0.0, 1.0])), [Law::BumpCamera]);
}

#[test]
fn normals_that_do_not_fit_the_positions_are_found() {
    let tilted = |c: &mut Case, _| {
        let n = DVec3::new(0.0, -0.09, 1.0).normalize();
        let n_camera = c.pose.world_from_camera.transpose() * n;
        let ids = c.frame.get(Layer::RenderEntityId).unwrap().clone();
        for (layer, n) in [(Layer::NormalWorld, n), (Layer::NormalCam, n_camera)] {
            let old = c.frame.get(layer).unwrap();
            let new = (0..old.len()).map(|i| if ids.get(i / 3) == 1.0 { n[i % 3] } else { old.get(i) }).collect();
            c.frame.insert(layer, testroom::store(layer, new));
        }
    };
    assert_eq!(failures(tilted), [Law::Flatness]);
}

#[test]
fn steps_of_one_normal_are_flat() {
    // A staircase: every other row of the floor is higher, in steps of three rows each.
    let stairs = |c: &mut Case, _| {
        let ids = c.frame.get(Layer::RenderEntityId).unwrap().clone();
        for pixel in (0..c.frame.pixels()).filter(|&i| ids.get(i) == 1.0) {
            let (x, y) = (pixel % 64, pixel / 64);
            let ray = c.pose.world_from_camera * c.intrinsics.ray(x as f64 + 0.5, y as f64 + 0.5).normalize();
            let step = 0.17 * ((y / 3) % 2) as f64;
            let distance = (step - c.pose.position.z) / ray.z;
            c.set(Layer::DepthMeters, pixel, &[distance]);
            c.set(Layer::DepthBehindMeters, pixel, &[distance]);
            c.set(Layer::DepthZMeters, pixel, &[-(c.pose.world_from_camera.transpose() * ray).z * distance]);
            c.set(Layer::Position, pixel, &(c.pose.position + ray * distance).to_array());
        }
    };
    assert_eq!(failures(stairs), []);
}

#[test]
fn label_images_are_checked() {
    let mirror_is = |c: &mut Case, semantic: i16, instance: i16| {
        c.labels.parts[2] = enfilade_scene::PartLabel { semantic, instance };
        let Some(Values::I16(ids)) = c.frame.get(Layer::RenderEntityId).cloned() else { panic!("ids are int16") };
        let (s, i) = enfilade_label::join(&ids, &c.labels).unwrap();
        c.frame.insert(Layer::Semantic, Values::I16(s));
        c.frame.insert(Layer::SemanticInstance, Values::I16(i));
    };
    assert_eq!(failures(|c, _| mirror_is(c, 11, 1)), []);
    assert_eq!(failures(|c, _| mirror_is(c, 41, 1)), [Law::SemanticRange]);
    // A part that was split shows the labels of its pieces, and no others.
    let split = |c: &mut Case, found: f64| {
        let mirror = pixel_of(&c.frame, 3);
        c.pieces = vec![
            (3, enfilade_scene::PartLabel { semantic: 11, instance: 1 }),
            (2, enfilade_scene::PartLabel { semantic: 12, instance: 1 }),
        ];
        c.set(Layer::Semantic, mirror, &[found]);
    };
    assert_eq!(failures(|c, _| split(c, 11.0)), []);
    assert_eq!(failures(|c, _| split(c, 12.0)), [Law::SemanticJoin]);
    assert_eq!(failures(|c, _| mirror_is(c, 19, 0)), [Law::InstanceRange]);
    assert_eq!(failures(|c, p| c.set(Layer::Semantic, p, &[5.0])), [Law::SemanticJoin]);
    assert_eq!(failures(|c, p| c.set(Layer::SemanticInstance, p, &[5.0])), [Law::InstanceJoin]);
}

#[test]
fn failures_name_frame_pixel_and_part() {
    let mut case = Case::new();
    let floor = pixel_of(&case.frame, 1);
    case.set(Layer::Semantic, floor, &[5.0]);
    let text = VerifyReport::new(&case.card(), 1, vec![], vec![], vec![]).to_text();
    let place = format!("at  room/cam_00/frame.0000 pixel ({}, {}), part 1: 5 where the tables say 2", floor % 64, floor / 64);
    assert!(text.contains(&place), "{text}");
}
