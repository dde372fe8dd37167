//! The position of the sun: its direction from latitude, day of the year and true solar time.

use enfilade_math::Vec3;
use std::f32::consts::TAU;

/// Declination of the sun, radians, on a day of the year (1 to 365), at noon: Spencer 1971, "Fourier series representation of the
/// position of the sun", good to 0.0006 radians.
pub fn declination_rad(day_of_year: u32) -> f32 {
    let day = TAU * (day_of_year as f32 - 1.0) / 365.0;
    let terms = [(0.399_912, 0.070_257), (0.006_758, 0.000_907), (0.002_697, 0.001_48)];
    let series = terms.iter().zip(1..).map(|((cos, sin), k)| {
        let angle = day * k as f32;
        sin * angle.sin() - cos * angle.cos()
    });
    0.006_918 + series.sum::<f32>()
}

/// Unit direction to the sun with x east, y north and z up, at a latitude (north positive), a day of the year and the hour of true
/// solar time (12: the sun is highest).
pub fn to_sun(latitude_deg: f32, day_of_year: u32, hour: f32) -> Vec3 {
    let (sin_latitude, cos_latitude) = latitude_deg.to_radians().sin_cos();
    let (sin_declination, cos_declination) = declination_rad(day_of_year).sin_cos();
    let (sin_hour, cos_hour) = (TAU * (hour - 12.0) / 24.0).sin_cos();
    Vec3::new(
        -cos_declination * sin_hour,
        cos_latitude * sin_declination - sin_latitude * cos_declination * cos_hour,
        sin_latitude * sin_declination + cos_latitude * cos_declination * cos_hour,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOLSTICES: [(u32, f32); 2] = [(172, 23.44), (355, -23.44)];

    #[test]
    fn at_noon_of_a_solstice_the_sun_stands_the_axis_tilt_above_or_below_the_equator() {
        for (day, tilt) in SOLSTICES {
            for latitude in [0.0f32, 23.44, 48.0, 60.0] {
                let sun = to_sun(latitude, day, 12.0);
                let expected = 90.0 - (latitude - tilt).abs();
                assert!((sun.z.asin().to_degrees() - expected).abs() < 0.15, "{latitude}° on day {day}: {sun}, expected {expected}°");
                assert!(sun.x.abs() < 1e-5 && (sun.length() - 1.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn at_the_equinoxes_the_sun_rises_in_the_east_at_six_and_sets_in_the_west_at_eighteen() {
        for day in [80, 266] {
            for latitude in [-35.0, 0.0, 48.0] {
                let (rise, set) = (to_sun(latitude, day, 6.0), to_sun(latitude, day, 18.0));
                assert!(rise.distance(Vec3::X) < 0.015 && set.distance(Vec3::NEG_X) < 0.015, "{rise} {set}");
            }
        }
    }

    #[test]
    fn the_longest_day_of_berlin_has_sixteen_and_three_quarter_hours() {
        // cos ω = −tan φ tan δ; almanacs give 16 h 50 min with refraction and the sun's radius, 16 h 36 min without.
        let lit = (0..2400).filter(|k| to_sun(52.52, 172, *k as f32 * 0.01).z > 0.0).count();
        assert!((lit as f32 * 0.01 - 16.6).abs() < 0.05, "{lit}");
    }
}
