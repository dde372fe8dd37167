//! Depth sensors before walls.

use crate::common::{depths, facing, refused, scan, values};
use enfilade_frame::{Layer, Values, traits};

/// A wall four metres away.
fn wall() -> enfilade_frame::Frame {
    facing(|_, _| 4.0, 0.5, [1.0; 3])
}

/// A wall four metres away behind a post one metre away, in columns 40 to 49.
fn post() -> enfilade_frame::Frame {
    facing(|x, _| if (40..50).contains(&x) { 1.0 } else { 4.0 }, 0.5, [1.0; 3])
}

#[test]
fn ideal_sensors_give_back_the_truth_to_the_bit() {
    let frame = post();
    for (text, layer) in [
        ("[[time_of_flight]]\nname = \"s\"", Layer::DepthMeters),
        ("[[structured_light]]\nname = \"s\"", Layer::DepthZMeters),
        ("[[stereo]]\nname = \"s\"", Layer::DepthZMeters),
    ] {
        assert_eq!(values(text, &frame), (layer, frame.get(layer).unwrap().clone()), "{text}");
    }
}

#[test]
fn time_of_flight_errs_by_the_root_of_the_signal() {
    let frame = wall();
    let sensed = depths("[[time_of_flight]]\nname = \"s\"\nnoise_m = 0.002", &frame);
    let truth = frame.get(Layer::DepthMeters).unwrap();
    // A wall that faces the axis has the cosine z/d at the distance d.
    let errors = (0..sensed.len()).map(|i| {
        let d = truth.get(i);
        (sensed[i] - d) / (0.002 * d / (0.5 * 4.0 / d).sqrt())
    });
    let errors: Vec<f64> = errors.collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let variance = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    assert!(mean.abs() < 0.06 && (variance - 1.0).abs() < 0.08, "mean {mean}, variance {variance}");
    assert_ne!(sensed, depths("seed = 1\n[[time_of_flight]]\nname = \"s\"\nnoise_m = 0.002", &frame));
}

#[test]
fn time_of_flight_loses_weak_signals_and_turns_and_steps() {
    let frame = wall();
    let truth = frame.get(Layer::DepthMeters).unwrap();
    let weak = depths("[[time_of_flight]]\nname = \"s\"\nmin_signal = 0.025", &frame);
    for (i, sensed) in weak.iter().enumerate() {
        let d = truth.get(i);
        assert_eq!(sensed.is_nan(), 0.5 * (4.0 / d) / (d * d) < 0.025, "{d} m");
    }
    let turned = depths("[[time_of_flight]]\nname = \"s\"\nambiguity_m = 1.5", &frame);
    assert!((0..turned.len()).all(|i| (turned[i] - truth.get(i) % 1.5).abs() < 1e-6));
    let near = depths("[[time_of_flight]]\nname = \"s\"\nrange_m = [0.5, 4.2]\nstep_m = 0.25", &frame);
    assert!((0..near.len()).all(|i| if truth.get(i) > 4.2 { near[i].is_nan() } else { (near[i] / 0.25).fract() == 0.0 }));
}

#[test]
fn flying_pixels_lie_between_the_sides_of_an_edge_nearer_to_the_brighter_one() {
    let frame = post();
    let sensed = depths("[[time_of_flight]]\nname = \"s\"\nmixing = 0.3", &frame);
    let truth = frame.get(Layer::DepthMeters).unwrap();
    let row = 30 * 80;
    let (before, post) = (sensed[row + 39], sensed[row + 40]);
    let signal = |i: usize| 0.5 * frame.get(Layer::DepthZMeters).unwrap().get(i) / truth.get(i).powi(3);
    let (mut light, mut way) = (0.0, 0.0);
    for y in 29..=31 {
        for x in 38..=40 {
            let share = match (y, x) {
                (30, 39) => 0.7,
                (30, _) | (_, 39) => 0.05,
                _ => 0.025,
            };
            let i = y * 80 + x;
            (light, way) = (light + share * signal(i), way + share * signal(i) * truth.get(i));
        }
    }
    assert!((before - way / light).abs() < 1e-5, "{before} m, expected {}", way / light);
    assert!(before > 1.3 && before < 3.0 && post < 1.1, "{before} m, {post} m");
    assert!((sensed[row + 20] - truth.get(row + 20)).abs() < 2e-3);
}

#[test]
fn a_second_eye_on_the_right_casts_a_shadow_to_the_left() {
    let frame = post();
    // Disparities of 8 and 2 pixels: the post covers six columns of the wall.
    for (text, shadow) in [("baseline_m = 0.2", 34..40), ("baseline_m = -0.2", 50..56)] {
        let sensed = depths(&format!("[[structured_light]]\nname = \"s\"\n{text}"), &frame);
        for x in 0..80 {
            let expected = if (40..50).contains(&x) { 1.0 } else { 4.0 };
            let found = sensed[10 * 80 + x];
            assert!(if shadow.contains(&x) { found.is_nan() } else { found == expected }, "{text}: column {x} has {found} m");
        }
    }
    // A thin thing covers no more than its own width.
    let thread = facing(|x, _| if x == 40 { 1.0 } else { 4.0 }, 0.5, [1.0; 3]);
    let sensed = depths("[[structured_light]]\nname = \"s\"\nbaseline_m = 0.2", &thread);
    assert_eq!((0..80).filter(|x| sensed[x + 800].is_nan()).collect::<Vec<usize>>(), [34]);
    // A second camera does not see the first one's border, either.
    let sensed = depths("[[stereo]]\nname = \"s\"\nbaseline_m = 0.2", &frame);
    let missing: Vec<usize> = (0..80).filter(|x| sensed[x + 800].is_nan()).collect();
    assert_eq!(missing, [0, 1, 34, 35, 36, 37, 38, 39]);
}

#[test]
fn disparities_have_steps_and_noise() {
    let frame = facing(|x, _| 3.0 + 0.01 * x as f64, 0.5, [1.0; 3]);
    let sensed = depths("[[structured_light]]\nname = \"s\"\nbaseline_m = 0.1\nstep_px = 0.125", &frame);
    let truth = frame.get(Layer::DepthZMeters).unwrap();
    for (i, z) in sensed.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
        let disparity = 4.0 / z;
        assert!((disparity / 0.125 - (disparity / 0.125).round()).abs() < 1e-4, "{z} m");
        assert!((disparity - 4.0 / truth.get(i)).abs() < 0.0626, "{z} m");
    }
    let frame = wall();
    let noisy = depths("[[stereo]]\nname = \"s\"\nbaseline_m = 0.1\nnoise_px = 0.02", &frame);
    let errors: Vec<f64> = noisy.iter().filter(|z| !z.is_nan()).map(|z| (4.0 / z - 1.0) / 0.02).collect();
    let variance = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    assert!((variance - 1.0).abs() < 0.08, "{variance}");
}

#[test]
fn what_cannot_be_matched_has_no_depth() {
    let frame = wall();
    let truth = frame.get(Layer::DepthMeters).unwrap();
    let seen = depths("[[structured_light]]\nname = \"s\"\nmax_angle_deg = 30", &frame);
    for (i, sensed) in seen.iter().enumerate() {
        let degrees = (4.0 / truth.get(i)).acos().to_degrees();
        assert!((degrees - 30.0).abs() < 0.05 || sensed.is_nan() == (degrees > 30.0), "{degrees}");
    }
    assert!(depths("[[structured_light]]\nname = \"s\"\nmin_reflectance = 0.6", &frame).iter().all(|z| z.is_nan()));
    let holes = depths("[[structured_light]]\nname = \"s\"\ndropout = 0.1", &frame).iter().filter(|z| z.is_nan()).count();
    assert!((400..560).contains(&holes), "{holes} of 4800");
    // A window takes the depth that it has most of: the post loses no pixel, a thread of one pixel vanishes.
    let thread = facing(|x, _| if x == 40 { 1.0 } else { 4.0 }, 0.5, [1.0; 3]);
    let matched = depths("[[structured_light]]\nname = \"s\"\nbaseline_m = 0.001\nwindow_px = 3", &thread);
    assert!((matched[2440] - 4.0).abs() < 1e-5, "{}", matched[2440]);
}

#[test]
fn glass_and_mirrors_are_seen_as_asked() {
    let mut frame = wall();
    let mut codes = vec![0u8; 4800];
    (codes[0], codes[1]) = (traits::GLASS, traits::MIRROR);
    frame.insert(Layer::SurfaceTraits, Values::U8(codes));
    let mut behind = vec![f32::NAN; 4800];
    behind[0] = 9.0;
    frame.insert(Layer::DepthBehindMeters, Values::F32(behind));
    let seen = |keys: &str| depths(&format!("[[time_of_flight]]\nname = \"s\"\n{keys}"), &frame)[..3].to_vec();
    let truth: Vec<f64> = (0..3).map(|i| frame.get(Layer::DepthMeters).unwrap().get(i)).collect();
    assert_eq!(seen(""), truth);
    let nothing = seen("glass = \"nothing\"\nmirrors = false");
    assert!(nothing[0].is_nan() && nothing[1].is_nan() && nothing[2] == truth[2]);
    assert_eq!(seen("glass = \"behind\"")[0], 9.0);
}

#[test]
fn beams_meet_flat_surfaces_where_they_are() {
    let beams = "elevations_deg = [-20, 0, 13.7]\nazimuth_deg = [-50, 40]\ncolumns = 91";
    let text = format!("[[lidar]]\nname = \"s\"\n{beams}");
    // A wall that faces the axis, and one that runs away to the right.
    let slanted = |x: usize| 2.0 / (1.0 - 0.4 * (x as f64 + 0.5 - 40.0) / 40.0);
    for (frame, depth) in [(wall(), [4.0, 0.0]), (facing(|x, _| slanted(x), 0.5, [1.0; 3]), [2.0, 0.4])] {
        let scan = scan(&text, &frame);
        assert_eq!(scan.shape, [3, 91]);
        for (beam, found) in scan.distances_m.iter().enumerate() {
            let (elevation, azimuth) = ([-20f64, 0.0, 13.7][beam / 91].to_radians(), (-50.0 + (beam % 91) as f64).to_radians());
            let outside = azimuth.tan().abs() >= 1.0 || (elevation.tan() / azimuth.cos()).abs() >= 0.75;
            // z + slope * x is constant on the wall.
            let expected = depth[0] / (elevation.cos() * (azimuth.cos() - depth[1] * azimuth.sin()));
            assert!(found.is_nan() == outside, "beam {beam}");
            assert!(outside || (f64::from(*found) / expected - 1.0).abs() < 1e-6, "beam {beam}: {found} m, expected {expected}");
            let point = scan.points[beam].map(f64::from);
            assert!(outside || (point[1] - expected * elevation.sin()).abs() < 1e-5 && scan.parts[beam] == 1);
        }
    }
    let near = scan(&format!("{text}\nrange_m = [0, 4.5]\nstep_m = 0.5\nnoise_m = 0.01"), &wall());
    assert!(near.distances_m.iter().all(|d| d.is_nan() || (d / 0.5).fract() == 0.0 && *d <= 4.5));
    let strong = scan(&format!("{text}\nmin_intensity = 0.45"), &wall());
    let back: Vec<f32> = strong.intensities.iter().zip(&strong.distances_m).filter(|(_, d)| !d.is_nan()).map(|(i, _)| *i).collect();
    assert!(!back.is_empty() && back.iter().all(|intensity| (0.45..=0.5).contains(intensity)));
}

#[test]
fn settings_out_of_their_domain_are_refused_by_name() {
    for (text, parts) in [
        ("[[time_of_flight]]\nname = \"tof\"\nmixing = 1.5", ["\"tof\"", "mixing is 1.5, expected 0 to 1"]),
        ("[[time_of_flight]]\nname = \"tof\"\nnoise_m = [-1, 2]", ["\"tof\"", "noise_m is [-1, 2], expected at least 0"]),
        ("[[time_of_flight]]\nname = \"tof\"\nrange_m = [3, 1]", ["range_m is [3, 1]", "the nearer one first"]),
        ("[[stereo]]\nname = \"s\"\nnoise_px = 1", ["baseline_m is 0", "expected the distance of the two eyes"]),
        ("[[stereo]]\nname = \"s\"\nbaseline_m = 0.1\nwindow_px = 4", ["window_px is 4", "odd"]),
        ("[[time_of_flight]]\nname = \"tof\"\nnoise_m = 0.1\nglass = \"behind\"", ["goes without noise_m", "reflectance"]),
        ("[[stereo]]\nname = \"s\"\nrange_m = [0, inf]", ["range_m is [0, inf]", "expected two distances"]),
        ("[[stereo]]\nname = \"a/b\"", ["sensor name \"a/b\"", "rename it"]),
        ("[[stereo]]\nname = \"s\"\n[[camera]]\nname = \"s\"", ["\"s\"", "one of its own"]),
        ("[[lidar]]\nname = \"s\"\nelevations_deg = []\nazimuth_deg = [0, 9]\ncolumns = 9", ["elevations_deg", "one angle"]),
        ("[[lidar]]\nname = \"s\"\nelevations_deg = [0]\nazimuth_deg = [9, 0]\ncolumns = 9", ["azimuth_deg", "the left one first"]),
        ("[[camera]]\nname = \"s\"\nread_noise_electrons = 2", ["read_noise_electrons needs full_well_electrons", ""]),
    ] {
        let message = refused(text);
        assert!(parts.iter().all(|part| message.contains(part)), "{text}: {message}");
    }
}
