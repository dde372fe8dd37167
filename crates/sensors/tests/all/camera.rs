//! Cameras before surfaces of known radiance.

use crate::common::{camera, facing, picture, reading, values};
use enfilade_frame::Layer;

const COLOR: [f64; 3] = [0.5, 0.25, 0.125];

#[test]
fn an_ideal_camera_gives_back_the_radiance_to_the_bit() {
    let frame = facing(|_, _| 1.0, 0.5, [3.5, 0.001, 700.0]);
    assert_eq!(values("[[camera]]\nname = \"s\"", &frame), (Layer::Color, frame.get(Layer::Color).unwrap().clone()));
}

#[test]
fn exposure_stops_and_vignetting_are_factors() {
    let frame = facing(|_, _| 1.0, 0.5, COLOR);
    let (_, brighter) = values("[[camera]]\nname = \"s\"\nexposure = 0.5\nstops = 3", &frame);
    assert_eq!([0, 1, 2].map(|c| brighter.get(c)), COLOR.map(|v| 4.0 * v));
    let (_, darker) = values("[[camera]]\nname = \"s\"\nvignetting = 0.5", &frame);
    let cosine = 1.0 / camera().ray(0.5, 0.5).unwrap().length();
    let expected = 0.5 * (0.5 + 0.5 * cosine.powi(4));
    assert!((darker.get(0) - expected).abs() < 2e-4, "{} of {expected}", darker.get(0));
}

#[test]
fn noise_has_the_variance_of_its_electrons() {
    let frame = facing(|_, _| 1.0, 0.5, COLOR);
    let (_, noisy) = values("[[camera]]\nname = \"s\"\nfull_well_electrons = 1000\nread_noise_electrons = 5", &frame);
    for (c, light) in COLOR.into_iter().enumerate() {
        let electrons: Vec<f64> = (0..4800).map(|i| 1000.0 * noisy.get(3 * i + c)).collect();
        let mean = electrons.iter().sum::<f64>() / 4800.0;
        let variance = electrons.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4800.0;
        let expected = 1000.0 * light + 25.0;
        assert!((mean - 1000.0 * light).abs() < 5.0 * (expected / 4800.0).sqrt(), "mean {mean}");
        assert!((variance / expected - 1.0).abs() < 0.1, "variance {variance} of {expected}");
    }
}

#[test]
fn pictures_are_exposed_balanced_and_contrasted() {
    let frame = facing(|_, _| 1.0, 0.5, COLOR);
    let grey = picture("[[camera]]\nname = \"s\"\nformat = \"png\"\nwhite_balance = 1", &frame).into_rgb8();
    // The 90th percentile, which is every pixel here, is shown at 0.8.
    assert!(grey.pixels().all(|pixel| pixel.0 == [204; 3]), "{:?}", grey.get_pixel(0, 0));
    let contrasted = picture("[[camera]]\nname = \"s\"\nformat = \"png\"\nwhite_balance = 1\ncontrast = 2", &frame).into_rgb8();
    assert_eq!(contrasted.get_pixel(40, 30).0, [163; 3]);
    let warm = picture("[[camera]]\nname = \"s\"\nformat = \"jpg\"", &frame).into_rgb8();
    let [r, g, b] = warm.get_pixel(40, 30).0;
    assert!(r > g && g > b, "{r} {g} {b}");
}

#[test]
fn raw_files_have_the_mosaic_in_whole_numbers_of_their_bits() {
    let frame = facing(|_, _| 1.0, 0.5, COLOR);
    let raw = picture("[[camera]]\nname = \"s\"\nformat = \"raw\"\nexposure = 1\nadc_bits = 10", &frame).into_luma16();
    let at = |x, y| raw.get_pixel(x, y).0[0];
    assert_eq!([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], [512, 256, 256, 128]);
    let text = "[[camera]]\nname = \"s\"\nformat = \"png\"\nexposure = 1\nmosaic = true";
    let [r, g, b] = picture(text, &frame).into_rgb8().get_pixel(41, 31).0;
    assert_eq!([r, g, b], COLOR.map(|v| (255.0 * v.powf(1.0 / 2.2)).round() as u8));
}

#[test]
fn what_is_drawn_lies_in_its_range_and_differs_by_seed() {
    let frame = facing(|_, _| 1.0, 0.5, COLOR);
    let drawn = |seed: u64| {
        let drawn = reading(&format!("seed = {seed}\n[[camera]]\nname = \"s\"\nformat = \"jpg\"\ncontrast = [1.2, 1.9]"), &frame).drawn;
        drawn.into_iter().find(|(name, _)| *name == "contrast").unwrap().1
    };
    let found: Vec<f64> = (0..20).map(drawn).collect();
    assert!(found.iter().all(|v| (1.2..1.9).contains(v)) && found.windows(2).all(|pair| pair[0] != pair[1]), "{found:?}");
    assert_eq!(drawn(3), drawn(3));
}
