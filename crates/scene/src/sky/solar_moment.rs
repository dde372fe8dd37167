//! The sun's position at a moment of the year.

use enfilade_math::{DVec3, Vec3};
use std::f64::consts::TAU;

/// A moment of the year at a place, in solar time, so that neither longitude nor time zone matter.
///
/// ```
/// use enfilade_scene::sky::SolarMoment;
///
/// // At noon the sun is in the south of Zurich; on the longest day its elevation is 90 - 47.4 + 23.4 degrees.
/// let noon = SolarMoment { month: 6, day: 21, solar_hour: 12.0, latitude_deg: 47.4 };
/// let to_sun = noon.to_sun();
/// assert!((f64::from(to_sun.z).asin().to_degrees() - 66.0).abs() < 0.1 && to_sun.y < 0.0);
/// // Three hours later it has moved to the west.
/// assert!(SolarMoment { solar_hour: 15.0, ..noon }.to_sun().x < -0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolarMoment {
    /// 1 to 12.
    pub month: u32,
    /// Day of the month, from 1.
    pub day: u32,
    /// Hours of solar time, 0 to 24: at 12 the sun is highest.
    pub solar_hour: f64,
    /// North of the equator, degrees, −90 to 90.
    pub latitude_deg: f64,
}

/// Days of the months of a year that is no leap year.
const DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

impl SolarMoment {
    /// The problem with it, as the end of a sentence; `None` if there is none. The 29th of February counts as the 1st of March.
    pub fn problem(&self) -> Option<String> {
        let days = (self.month.checked_sub(1)).and_then(|m| DAYS.get(m as usize)).map(|days| days + u32::from(self.month == 2));
        match days {
            None => Some(format!("month {} is none of 1 to 12", self.month)),
            Some(days) if !(1..=days).contains(&self.day) => Some(format!("day {} is none of 1 to {days}", self.day)),
            _ if !(0.0..=24.0).contains(&self.solar_hour) => Some(format!("hour {} is not within 0 to 24", self.solar_hour)),
            _ if !(-90.0..=90.0).contains(&self.latitude_deg) => Some(format!("latitude {} is not within -90 to 90", self.latitude_deg)),
            _ => None,
        }
    }

    /// Unit direction towards the sun: x to the east, y to the north, z up. Below the horizon at night.
    ///
    /// The declination is the Fourier series of Spencer 1971, "Fourier series representation of the position of the sun", which is right to
    /// 0.04 degrees.
    pub fn to_sun(&self) -> Vec3 {
        let (sin_dec, cos_dec) = self.declination_rad().sin_cos();
        let (sin_lat, cos_lat) = self.latitude_deg.to_radians().sin_cos();
        let (sin_hour, cos_hour) = (TAU * (self.solar_hour - 12.0) / 24.0).sin_cos();
        let east = -cos_dec * sin_hour;
        let north = cos_lat * sin_dec - sin_lat * cos_dec * cos_hour;
        let up = sin_lat * sin_dec + cos_lat * cos_dec * cos_hour;
        DVec3::new(east, north, up).normalize().as_vec3()
    }

    fn declination_rad(&self) -> f64 {
        let days: u32 = DAYS.iter().take(self.month as usize - 1).sum();
        let angle = TAU * f64::from(days + self.day - 1) / 365.0;
        let wave = |n: f64, cos: f64, sin: f64| cos * (n * angle).cos() + sin * (n * angle).sin();
        0.006_918 + wave(1.0, -0.399_912, 0.070_257) + wave(2.0, -0.006_758, 0.000_907) + wave(3.0, -0.002_697, 0.001_48)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elevation_deg(month: u32, day: u32, solar_hour: f64, latitude_deg: f64) -> f64 {
        f64::from(SolarMoment { month, day, solar_hour, latitude_deg }.to_sun().z).asin().to_degrees()
    }

    #[test]
    fn the_sun_stands_where_almanacs_say() {
        // Noon at solstices and equinoxes, whose declinations are ±23.44 and 0 degrees.
        for (month, day, latitude, expected) in [
            (6, 21, 48.0, 65.44),
            (12, 21, 48.0, 18.56),
            (3, 21, 0.0, 90.0),
            (9, 23, 60.0, 30.0),
            (6, 21, -33.9, 32.7),
            (12, 21, -80.0, 33.4),
        ] {
            let found = elevation_deg(month, day, 12.0, latitude);
            assert!((found - expected).abs() < 0.5, "{month}-{day} at {latitude}: {found}, expected {expected}");
        }
        // On the equinox it rises at six in the east, at every latitude, and sets at eighteen in the west.
        for latitude in [-50.0, 0.0, 35.0, 60.0] {
            let rise = SolarMoment { month: 3, day: 21, solar_hour: 6.0, latitude_deg: latitude }.to_sun();
            assert!(rise.z.abs() < 0.01 && rise.x > 0.99, "{latitude}: {rise}");
        }
        // The midnight sun.
        assert!(elevation_deg(6, 21, 0.0, 70.0) > 3.0 && elevation_deg(12, 21, 12.0, 70.0) < -3.0);
    }

    #[test]
    fn south_of_the_equator_the_noon_sun_is_in_the_north() {
        assert!(SolarMoment { month: 12, day: 21, solar_hour: 12.0, latitude_deg: -33.9 }.to_sun().y > 0.0);
    }

    #[test]
    fn moments_that_are_none_are_told() {
        let good = SolarMoment { month: 2, day: 29, solar_hour: 24.0, latitude_deg: -90.0 };
        assert_eq!(good.problem(), None);
        for (moment, words) in [
            (SolarMoment { month: 0, ..good }, "month 0"),
            (SolarMoment { month: 13, ..good }, "month 13"),
            (SolarMoment { day: 30, ..good }, "day 30 is none of 1 to 29"),
            (SolarMoment { solar_hour: f64::NAN, ..good }, "hour NaN"),
            (SolarMoment { latitude_deg: 91.0, ..good }, "latitude 91"),
        ] {
            assert!(moment.problem().unwrap().contains(words), "{moment:?}");
        }
    }
}
