//! Angles and their functions, fast and the same on every platform.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Sine and cosine of `turns` full turns, for |`turns`| below 10⁶: the same on every platform, to 10⁻⁷.
#[inline]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let rounded = 4.0 * turns + 0.5;
    let towards_zero = rounded as i32;
    let quarter = towards_zero - i32::from(towards_zero as f32 > rounded);
    let (sin, cos) = sin_cos_eighth((turns - 0.25 * quarter as f32) * TAU);
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The angle of a cosine, radians; values beyond ±1 count as ±1. Abramowitz & Stegun 1964, 4.4.46: to 2e−8 and rounding.
#[inline]
pub fn acos(x: f32) -> f32 {
    const C: [f32; 8] =
        [FRAC_PI_2, -0.214_598_8, 0.088_978_99, -0.050_174_305, 0.030_891_88, -0.017_088_126, 0.006_670_09, -0.001_262_491_1];
    let a = x.abs().min(1.0);
    let a2 = a * a;
    let a4 = a2 * a2;
    let pairs = [C[0] + C[1] * a, C[2] + C[3] * a, C[4] + C[5] * a, C[6] + C[7] * a];
    let angle = (1.0 - a).sqrt() * ((pairs[0] + pairs[1] * a2) + (pairs[2] + pairs[3] * a2) * a4);
    if x < 0.0 { PI - angle } else { angle }
}

/// The angle of the vector (x, y) with the x axis on [−π, π], 0 for the zero vector; to 1e−6.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    if ax + ay == 0.0 {
        return 0.0;
    }
    let steep = ay > ax;
    let angle = atan_below_one(if steep { ax / ay } else { ay / ax });
    let angle = if steep { FRAC_PI_2 - angle } else { angle };
    (if x < 0.0 { PI - angle } else { angle }).copysign(y)
}

/// Sine and cosine by their series, for |`x`| ≤ π/4.
#[inline]
pub(crate) fn sin_cos_eighth(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40_320.0))));
    (sin, cos)
}

/// atan on [−1,1] to 2e−8 and rounding. Abramowitz & Stegun 1964, 4.4.49.
#[inline]
pub(crate) fn atan_below_one(x: f32) -> f32 {
    const C: [f32; 8] =
        [-0.333_331_45, 0.199_935_51, -0.142_089, 0.106_562_64, -0.075_289_64, 0.042_909_61, -0.016_165_737, 0.002_866_225_7];
    // Estrin's scheme: its steps are independent of each other and run in parallel.
    let x2 = x * x;
    let x4 = x2 * x2;
    let pairs = [C[0] + C[1] * x2, C[2] + C[3] * x2, C[4] + C[5] * x2, C[6] + C[7] * x2];
    let x8 = x4 * x4;
    x * (1.0 + x2 * ((pairs[0] + pairs[1] * x4) + (pairs[2] + pairs[3] * x4) * x8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_cosines_are_those_of_the_mathematics_library() {
        for i in -1000..=1000 {
            let cos = i as f32 / 1000.0;
            assert!((f64::from(acos(cos)) - f64::from(cos).acos()).abs() < 5e-7, "{cos}: {}", acos(cos));
        }
        assert_eq!((acos(1.5), acos(-1.5)), (0.0, PI));
    }

    #[test]
    fn angles_of_vectors_are_those_of_the_mathematics_library() {
        for i in 0..1000 {
            let (sin, cos) = (f64::from(i) * 0.01).sin_cos();
            let (y, x) = ((3.0 * sin) as f32, (3.0 * cos) as f32);
            assert!((f64::from(atan2(y, x)) - f64::from(y).atan2(f64::from(x))).abs() < 1e-6, "{y}, {x}: {}", atan2(y, x));
        }
        assert_eq!([atan2(0.0, 0.0), atan2(0.0, -1.0), atan2(-2.0, 0.0)], [0.0, PI, -FRAC_PI_2]);
    }

    #[test]
    fn sines_and_cosines_are_those_of_the_mathematics_library() {
        for i in -4000..=4000 {
            let turns = i as f32 / 1000.0;
            let (sin, cos) = sin_cos_turns(turns);
            let exact = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
            assert!((f64::from(sin) - exact.0).abs() < 3e-7 && (f64::from(cos) - exact.1).abs() < 3e-7, "{turns} turns: {sin}, {cos}");
        }
    }
}
