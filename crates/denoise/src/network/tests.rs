//! The promises of the network in the binary: the same bytes with any instructions and threads, tiles without seams, and sane pictures.

use super::*;

/// A picture of blocks of light on two walls, with noise; all of it by the pixel.
struct Picture {
    width: u32,
    height: u32,
    color: Vec<f32>,
    albedo: Vec<f32>,
    normal: Vec<f32>,
}

impl Picture {
    fn new(width: u32, height: u32) -> Self {
        let (mut color, mut normal) = (Vec::new(), Vec::new());
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let side = usize::from((x / 24 + y / 16) % 2 == 0);
            for channel in 0..3 {
                let random = ((x * 7919 + y * 104_729 + channel * 31).wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32;
                color.push([0.3, 1.1][side] * 2.0 * random);
                normal.push(f32::from(channel as usize == side));
            }
        }
        Self { width, height, albedo: vec![1.0; color.len()], color, normal }
    }

    fn noisy(&self) -> Noisy<'_> {
        let Self { width, height, color, albedo, normal } = self;
        Noisy { width: *width, height: *height, color, albedo, normal }
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn any_instructions_and_any_number_of_threads_give_the_same_bytes() {
    let picture = Picture::new(43, 27);
    let with = |instructions, threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&Network::new(instructions).filter(&picture.noisy())))
    };
    let expected = with(Instructions::best(), 1);
    for instructions in Instructions::available() {
        for threads in [2, 5] {
            assert!(with(instructions, threads) == expected, "{} with {threads} threads", instructions.name());
        }
    }
}

#[test]
fn tiles_of_a_large_picture_meet_without_a_seam() {
    let picture = Picture::new(450, 40);
    let whole = Network::new(Instructions::best());
    let tiled = Network { most: 384, ..Network::new(Instructions::best()) };
    assert_eq!(spans(450, 384).len(), 4);
    let (whole, tiled) = (whole.filter(&picture.noisy()), tiled.filter(&picture.noisy()));
    for (i, (a, b)) in whole.iter().zip(&tiled).enumerate() {
        assert!((a - b).abs() < 1e-4 * a, "value {i}: {a} and {b}");
    }
}

#[test]
fn a_picture_of_one_radiance_stays_one() {
    let network = Network::new(Instructions::best());
    let mut picture = Picture::new(96, 64);
    picture.normal = [0.0, 0.0, 1.0].repeat(96 * 64);
    for radiance in [0.001, 0.5, 200.0] {
        picture.color.fill(radiance);
        let output = network.filter(&picture.noisy());
        let mean = output.iter().sum::<f32>() / output.len() as f32;
        assert!((mean / radiance - 1.0).abs() < 0.02, "{radiance} became {mean} in the mean");
        let furthest = output.iter().map(|value| (value / radiance - 1.0).abs()).fold(0.0, f32::max);
        assert!(furthest < 0.15, "{radiance} is off by a share of {furthest} in a pixel");
    }
}

#[test]
fn pictures_of_any_size_and_with_any_values_become_finite_radiance() {
    let network = Network::new(Instructions::best());
    for (width, height) in [(1, 1), (1, 40), (33, 2), (16, 16), (17, 31)] {
        let mut picture = Picture::new(width, height);
        let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, f32::MAX, f32::MIN_POSITIVE, 1e-40, 0.0];
        for values in [&mut picture.color, &mut picture.albedo, &mut picture.normal] {
            values.iter_mut().step_by(5).enumerate().for_each(|(i, value)| *value = strange[i % strange.len()]);
        }
        let output = network.filter(&picture.noisy());
        assert_eq!(output.len(), 3 * (width * height) as usize);
        assert!(output.iter().all(|value| value.is_finite() && *value >= 0.0), "{width}x{height}");
    }
    let empty = Noisy { width: 0, height: 3, color: &[], albedo: &[], normal: &[] };
    assert!(network.filter(&empty).is_empty());
}

#[test]
fn a_file_that_lacks_a_layer_or_has_another_shape_is_refused() {
    let without = |from: &[u8], to: &[u8]| {
        let mut file = WEIGHTS.to_vec();
        let place = file.windows(from.len()).rposition(|window| window == from).unwrap();
        file[place..place + to.len()].copy_from_slice(to);
        Network::read(&file, Instructions::best()).err().unwrap()
    };
    assert_eq!(without(b"enc_conv3b.bias", b"enc_conv9b.bias"), "there is no tensor `enc_conv3b.bias`");
    let error = without(b"dec_conv1c.bias\x01\x03", b"dec_conv1c.bias\x01\x02");
    assert_eq!(error, "`dec_conv1c` has weights [3, 64, 3, 3] and biases [2]; expected [n, m, 3, 3] and [n]");
}
