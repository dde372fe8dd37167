//! The promises of denoising: the identity, the layers it reads, the noise it removes, and that the network in the binary gives the results
//! of the library of Open Image Denoise.

use enfilade_denoise::{DenoiseError, Denoiser, GUIDES, INPUTS, Noisy, denoise, inputs_of};
use enfilade_frame::{Frame, Layer, Pass, Values, f16};

const WIDTH: u32 = 96;
const HEIGHT: u32 = 64;
/// The denoised layers.
const PARTS: [Layer; 2] = [Layer::DiffuseIllumination, Layer::Residual];

/// A number on [0,1) for every pixel, channel and purpose.
fn random(pixel: usize, channel: usize, purpose: u64) -> f32 {
    let mut x = (pixel as u64) << 20 ^ (channel as u64) << 10 ^ purpose;
    for _ in 0..3 {
        x = (x ^ x >> 31).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    (x >> 40) as f32 / (1u64 << 24) as f32
}

/// A floor and a wall of checks, half of it black, a light of 0.4 that falls off to the right, a sheen of 0.05, and void in the
/// upper corner; `noise` 0 to 1.
fn frame(noise: f32) -> Frame {
    let mut layers = INPUTS.map(|layer| (layer, Vec::new()));
    for pixel in 0..(WIDTH * HEIGHT) as usize {
        let (x, y) = (pixel % WIDTH as usize, pixel / WIDTH as usize);
        let (void, wall) = (x > 80 && y < 12, y < 40);
        for c in 0..3 {
            let spread = |purpose| 1.0 + noise * (2.0 * random(pixel, c, purpose) - 1.0);
            let reflectance = if (x / 8 + y / 8) % 2 == 0 { 0.0 } else { 0.3 + 0.2 * c as f32 };
            let light = 0.4 - 0.002 * x as f32;
            let normal = if wall { [0.0, -1.0, 0.0] } else { [0.0, 0.0, 1.0] };
            let values = if void { [0.0, 0.1, 0.0, f32::NAN] } else { [light * spread(1), 0.05 * spread(2), reflectance, normal[c]] };
            layers.iter_mut().zip(values).for_each(|((_, layer), value)| layer.push(f16::from_f32(value)));
        }
    }
    let mut frame = Frame::new(WIDTH, HEIGHT);
    layers.into_iter().for_each(|(layer, values)| frame.insert(layer, Values::F16(values)));
    frame
}

fn value(frame: &Frame, layer: Layer, i: usize) -> f32 {
    frame.get(layer).unwrap().get(i) as f32
}

fn assert_identity(rendered: &Frame, denoised: &Frame) {
    assert!(denoised.iter().all(|(layer, _)| layer.spec().pass == Pass::Final) && denoised.iter().count() == 3);
    for i in 0..3 * rendered.pixels() {
        let (a, s) = (value(rendered, Layer::DiffuseReflectance, i), value(denoised, Layer::DiffuseIllumination, i));
        let sum = f16::from_f32(a * s + value(denoised, Layer::Residual, i)).to_f32();
        assert_eq!(sum, value(denoised, Layer::Color, i), "value {i}");
        assert!(sum.is_finite() && sum >= 0.0);
    }
}

#[test]
fn the_identity_holds_whatever_a_filter_makes() {
    let rendered = frame(1.0);
    let strange = [0.0, -1.0, f32::NAN, f32::INFINITY, 7e4, 1e-8, 0.3333];
    let denoised = denoise(&rendered, |noisy: &Noisy| (0..noisy.color.len()).map(|i| strange[i % strange.len()]).collect()).unwrap();
    assert_identity(&rendered, &denoised);
}

#[test]
fn a_filter_sees_finite_pictures_and_one_that_changes_nothing_gives_back_what_was_rendered() {
    let rendered = frame(0.7);
    let unchanged = |noisy: &Noisy| {
        for values in [noisy.color, noisy.albedo, noisy.normal] {
            assert!(values.len() == 3 * rendered.pixels() && values.iter().all(|v| v.is_finite()));
        }
        noisy.color.to_vec()
    };
    let denoised = denoise(&rendered, unchanged).unwrap();
    assert_identity(&rendered, &denoised);
    for part in PARTS {
        assert_eq!(rendered.get(part), denoised.get(part));
    }
}

#[test]
fn light_is_guided_by_filtered_normals_and_residual_by_what_is_seen_beyond() {
    let mut rendered = frame(1.0);
    let guides_of = |frame: &Frame| {
        let mut seen = Vec::new();
        denoise(frame, |noisy| {
            seen.push((noisy.albedo[7], noisy.normal[7]));
            noisy.color.to_vec()
        })
        .unwrap();
        seen
    };
    // The wall faces −y; without the layers that guide, that guides both.
    assert_eq!(inputs_of(|layer| rendered.get(layer).is_some()), INPUTS);
    assert_eq!(guides_of(&rendered), [(1.0, -1.0); 2]);
    for (layer, value) in GUIDES.into_iter().zip([0.5, -0.25, 0.75]) {
        rendered.insert(layer, Values::F16(vec![f16::from_f32(value); 3 * rendered.pixels()]));
    }
    assert_eq!(inputs_of(|layer| rendered.get(layer).is_some()), [&INPUTS[..], &GUIDES].concat());
    assert_eq!(guides_of(&rendered), [(1.0, 0.5), (0.75, -0.25)]);
}

#[test]
fn a_missing_layer_is_named() {
    let error = denoise(&Frame::new(4, 4), |noisy| noisy.color.to_vec()).unwrap_err();
    assert!(error.to_string().contains("diffuse_illumination"), "{error}");
    assert!(matches!(error, DenoiseError::MissingLayer { .. }));
}

#[test]
fn the_network_in_the_binary_takes_noise_away() {
    let denoiser = Denoiser::built_in();
    assert_eq!(denoiser.name(), "built-in (rt_hdr_calb_cnrm_large of Open Image Denoise 2)");
    let (noisy, clean) = (frame(1.0), frame(0.0));
    let denoised = denoise(&noisy, |noisy| denoiser.filter(noisy)).unwrap();
    assert_identity(&noisy, &denoised);
    for part in PARTS {
        let error =
            |of: &Frame| (0..3 * clean.pixels()).map(|i| f64::from(value(of, part, i) - value(&clean, part, i)).powi(2)).sum::<f64>();
        let (with_noise, without) = (error(&noisy), error(&denoised));
        assert!(without < 0.1 * with_noise, "{}: {without} of {with_noise}", part.spec().name);
    }
}

/// Output of Open Image Denoise 2.5.1 for the pictures below: every eleventh value of each. Made by `library/make.py`.
const ANSWERS: &[u8] = include_bytes!("library/answers.f32");
const STRIDE: usize = 11;

#[test]
fn the_network_in_the_binary_makes_what_the_library_makes() {
    let built_in = Denoiser::built_in();
    let mut answers = ANSWERS.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
    let random = |count: u32, scale: f32, purpose| -> Vec<f32> {
        (0..3 * count as usize).map(|i| scale * random(i / 3, i % 3, purpose).powi(2)).collect()
    };
    // Neither side is a multiple of 16; dim, usual, bright, and all of it black.
    for (width, height, scale) in [(77, 50, 1e-3), (64, 96, 1.0), (129, 33, 1e4), (40, 40, 0.0)] {
        let count = width * height;
        let (color, albedo, normal) = (random(count, scale, 4), random(count, 1.2, 5), random(count, 1.0, 6));
        let found = built_in.filter(&Noisy { width, height, color: &color, albedo: &albedo, normal: &normal });
        let found: Vec<f32> = found.into_iter().step_by(STRIDE).collect();
        let expected: Vec<f32> = answers.by_ref().take(found.len()).collect();
        assert_eq!(expected.len(), found.len());
        let sum = |values: &mut dyn Iterator<Item = f32>| values.map(f64::from).sum::<f64>();
        let difference = sum(&mut expected.iter().zip(&found).map(|(a, b)| (a - b).abs()));
        let all = sum(&mut expected.iter().copied());
        assert!(difference <= 1e-4 * all, "{width}x{height}, times {scale}: {difference} of {all}");
    }
    assert_eq!(answers.next(), None);
}
