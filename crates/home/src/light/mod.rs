//! The light of a home: sun, sky and surroundings outside, the hour, and which lamps are lit.
//!
//! Light is computed in kilo-candela per square metre and kilo-lux. The scene's radiance is that times an [`Exposure`], which
//! brings the walls of a home to about the same value by day and by night and balances the white as a camera does; the radiance's
//! luminance divided by [`Exposure::per_kcd`] and multiplied by 1000 is about that in cd/m² again.

mod outside;
mod sky;
mod sun;
mod weather;

pub use outside::Outside;
pub use sun::{declination_rad, to_sun};
pub use weather::Weather;

use enfilade_furniture::{Exposure, LampLight};
use enfilade_math::{Rng, Vec2, Vec3};
use enfilade_options::words;
use enfilade_scene::Scene;
use serde::{Deserialize, Serialize};

words! {
    /// Part of the day.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Moment {
        /// The sun is up; a few lamps may be lit.
        #[default]
        Day = "day",
        /// Blue dusk outside, lamps inside.
        Evening = "evening",
        /// Lamps inside, lit windows and street lamps outside.
        Night = "night",
    }
}

/// The configuration of the light of a home, which is a function of it alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightConfig {
    /// Latitude, degrees, north positive.
    pub latitude_deg: f32,
    /// Day of the year, 1 to 365.
    pub day_of_year: u32,
    /// Hour of true solar time, 0 to 24.
    pub hour: f32,
    /// Bearing of the home's y axis, degrees clockwise from north.
    pub north_deg: f32,
    /// Haze of the clear part of the sky, as Preetham, Shirley & Smits 1999 count it: 2 very clear, 4 usual, 8 hazy.
    pub turbidity: f32,
    /// Share of the sky under an even layer of cloud, 0 clear to 1 overcast.
    pub cloud: f32,
    /// Share of the lamps that are lit, 0 to 1.
    pub lamps: f32,
    /// Illuminance of the walls when all lamps are lit, kilo-lux.
    pub lamps_klx: f32,
    /// What is seen from the windows.
    pub outside: Outside,
    /// Decides the houses and trees outside, and which lamps are lit.
    pub seed: u64,
}

impl Moment {
    /// Three of five homes by day, the others in the evening or at night.
    pub fn usual(rng: &mut Rng) -> Self {
        [Self::Day, Self::Day, Self::Day, Self::Evening, Self::Night][rng.below(5)]
    }
}

impl Default for LightConfig {
    /// A clear afternoon in early summer in the middle of Europe.
    fn default() -> Self {
        Self {
            latitude_deg: 48.0,
            day_of_year: 150,
            hour: 15.0,
            north_deg: 0.0,
            turbidity: 4.0,
            cloud: 0.0,
            lamps: 0.5,
            lamps_klx: Exposure::LAMPS_KLX,
            outside: Outside::Garden,
            seed: 0,
        }
    }
}

/// Sun's elevations at dusk, degrees: civil twilight ends at −6.
const DUSK_DEG: [f32; 2] = [-6.5, -4.0];
/// Minimum elevation of the sun by day, degrees; where it does not get that high, it is noon.
const DAY_DEG: f32 = 12.0;

impl LightConfig {
    /// Light of one of many homes at a moment of the day. Latitudes, weather and dates are spread over those of most homes: 25 to 60
    /// degrees, all days of the year, a third of them cloudy.
    pub fn random(moment: Moment, rng: &mut Rng) -> Self {
        let (place, date, weather, lamps) = (&mut rng.fork(1), &mut rng.fork(2), &mut rng.fork(3), &mut rng.fork(4));
        let light = Self {
            latitude_deg: place.range(25.0, 60.0),
            north_deg: place.range(0.0, 360.0),
            outside: Outside::ALL[place.below(Outside::ALL.len())],
            seed: lamps.next_u64(),
            ..Self::default()
        };
        light.drawn(moment, date, weather, lamps)
    }

    /// The light of this place on another day: date, hour, weather and the share of lit lamps are drawn as by [`LightConfig::random`].
    #[must_use]
    pub fn at(self, moment: Moment, rng: &mut Rng) -> Self {
        self.drawn(moment, &mut rng.fork(2), &mut rng.fork(3), &mut rng.fork(4))
    }

    fn drawn(self, moment: Moment, date: &mut Rng, weather: &mut Rng, lamps: &mut Rng) -> Self {
        let mut light = Self {
            day_of_year: 1 + date.below(365) as u32,
            turbidity: weather.range(2.2, 7.0),
            cloud: [0.0, 0.0, 0.25, 0.25, 0.6, 1.0][weather.below(6)],
            ..self
        };
        let u = date.next_f32();
        light.hour = match moment {
            Moment::Day => light.hour_between([DAY_DEG, 90.0], u),
            Moment::Evening => light.hour_between(DUSK_DEG, u),
            Moment::Night => 22.0 + 2.0 * u,
        };
        light.lamps = match moment {
            Moment::Day if light.cloud < 0.5 => [0.0, 0.0, 0.3][lamps.below(3)],
            Moment::Day => lamps.range(0.3, 0.8),
            Moment::Evening | Moment::Night => lamps.range(0.75, 1.0),
        };
        if moment == Moment::Night {
            // Nights are dark: not those of northern summers.
            light.day_of_year = [300 + light.day_of_year % 65, light.day_of_year % 65 + 1][date.below(2)];
        }
        light
    }

    /// This light with the home turned so that the sun of the day is in the direction `outward` of the home's plan, offset by up to 50
    /// degrees to either side, as `u` on [0,1) chooses.
    #[must_use]
    pub fn facing_sun(mut self, outward: Vec2, u: f32) -> Self {
        self.north_deg = 0.0;
        let sun = self.to_sun();
        let turn = sun.x.atan2(sun.y).to_degrees() - outward.x.atan2(outward.y).to_degrees();
        self.north_deg = (turn + 100.0 * (u - 0.5)).rem_euclid(360.0);
        self
    }

    /// Unit direction to the sun in the home's own axes.
    pub fn to_sun(&self) -> Vec3 {
        let sun = to_sun(self.latitude_deg, self.day_of_year, self.hour);
        Vec2::from_angle(self.north_deg.to_radians()).rotate(sun.truncate()).extend(sun.z)
    }

    /// The exposure at which the scene is shown.
    pub fn exposure(&self) -> Exposure {
        let weather = self.weather();
        Exposure::with_lamps(weather.sky_klx(), weather.sun_klx(), self.lamps_klx * self.lamps)
    }

    /// How bright the lamps of the home are, and which of them are lit.
    pub fn lamp_light(&self) -> LampLight {
        LampLight { exposure: self.exposure(), lit: self.lamps, seed: self.seed }
    }

    /// Adds sun, sky and surroundings to `scene`. `outward` are the directions out of the home's windows: what faces away from all of
    /// them stays black, since no light from there can come in, and a renderer need not look for any.
    pub fn illuminate(&self, scene: &mut Scene, outward: &[Vec2]) {
        self.illuminate_exposed(scene, outward, self.exposure());
    }

    /// Adds sun, sky and surroundings as [`LightConfig::illuminate`] does, shown at a given exposure.
    pub fn illuminate_exposed(&self, scene: &mut Scene, outward: &[Vec2], exposure: Exposure) {
        let weather = self.weather();
        let surroundings = weather.surroundings(self.outside, self.seed as u32);
        sky::illuminate(scene, outward, &weather, &surroundings, exposure);
    }

    /// Sun and sky.
    pub fn weather(&self) -> Weather {
        Weather::new(self.to_sun(), self.turbidity, self.cloud)
    }

    /// The hour of the afternoon at which the sun's elevation is between two limits, or as near as it gets on this day.
    fn hour_between(&self, [low, high]: [f32; 2], u: f32) -> f32 {
        let elevation = |hour: f32| to_sun(self.latitude_deg, self.day_of_year, hour).z.asin().to_degrees();
        let hours: Vec<f32> = (0..144).map(|k| 12.0 + k as f32 / 12.0).collect();
        let fitting: Vec<f32> = hours.iter().copied().filter(|&h| (low..=high).contains(&elevation(h))).collect();
        let away = |h: f32| (elevation(h) - elevation(h).clamp(low, high)).abs();
        let nearest = hours.iter().copied().min_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap_or(12.0);
        let hour = fitting.get((u * fitting.len() as f32) as usize).copied().unwrap_or(nearest);
        // Mornings are as likely as afternoons; which it is must not depend on the digits that chose the hour.
        if low > 0.0 && (u * 977.0).fract() < 0.5 { 24.0 - hour } else { hour }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_follows_the_bearing_of_the_home() {
        let noon = LightConfig { hour: 12.0, ..LightConfig::default() };
        assert!(noon.to_sun().y < -0.3, "the sun of noon is in the south");
        // The y axis points south: the sun is before it.
        let turned = LightConfig { north_deg: 180.0, ..noon };
        assert!(turned.to_sun().y > 0.3 && (turned.to_sun().z - noon.to_sun().z).abs() < 1e-6);
        // The y axis points east: south is on its right, along +x.
        let east = LightConfig { north_deg: 90.0, ..noon };
        assert!(east.to_sun().x > 0.3, "{}", east.to_sun());
        for u in [0.0, 0.5, 0.99] {
            let facing = noon.facing_sun(Vec2::new(0.6, -0.8), u).to_sun();
            assert!(facing.truncate().normalize().dot(Vec2::new(0.6, -0.8)) > 0.6, "{facing}");
        }
    }

    #[test]
    fn moments_have_the_sun_where_they_say() {
        for seed in 0..200 {
            let elevation = |moment| LightConfig::random(moment, &mut Rng::new(seed)).to_sun().z.asin().to_degrees();
            let (day, evening, night) = (elevation(Moment::Day), elevation(Moment::Evening), elevation(Moment::Night));
            assert!(day > 5.0, "seed {seed}: {day}°");
            assert!((-7.5..-3.0).contains(&evening), "seed {seed}: {evening}°");
            assert!(night < -15.0, "seed {seed}: {night}°");
        }
    }

    #[test]
    fn exposure_rises_from_noon_to_night_and_stays_within_bounds() {
        let at = |hour, lamps| LightConfig { hour, lamps, ..LightConfig::default() }.exposure().per_kcd();
        let levels = [at(12.0, 0.0), at(18.0, 0.0), at(19.9, 1.0), at(23.5, 1.0)];
        assert!(levels.windows(2).all(|p| p[0] < p[1]), "{levels:?}");
        assert!(levels[0] > 0.4 && levels[3] < 40.0, "{levels:?}");
    }
}
