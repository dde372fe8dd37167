//! The surroundings that light a scene instead of its file's own: a picture, or a sky without a file.

use enfilade_math::{DMat3, DVec3, Rgb};
use enfilade_options::{Form, Given, Value};
use enfilade_scene::sky::{Daylight, Overcast, SolarMoment};
use enfilade_scene::{Environment, Image, Light, MapRows, Scene};
use serde::de::{Deserializer, Error as _, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;

/// Width of the picture of a sky, texels.
const SKY_WIDTH: u32 = 1024;

/// Haze of the clear sky: between very clear and warm (see [`Daylight::turbidity`]).
const TURBIDITY: f32 = 3.0;

/// Share of the light that the ground around a building reflects: grass, soil and roads.
const GROUND_ALBEDO: f32 = 0.2;

/// What lights a scene instead of the file's own surroundings.
///
/// In files it is a table, and the two skies as they come are words:
///
/// ```
/// use enfilade_import::{EnvironmentOverride, EnvironmentSource};
///
/// let read = |text: &str| serde_json::from_str::<EnvironmentOverride>(text);
/// let sky = read(r#"{ "sky": "clear", "date": "12-21", "hour": 9.5, "latitude_deg": 48.1 }"#)?;
/// assert!(matches!(sky.source, EnvironmentSource::Clear(moment) if moment.solar_hour == 9.5));
/// assert!(matches!(read(r#""overcast""#)?.source, EnvironmentSource::Overcast(_)));
/// assert!(matches!(read(r#"{ "file": "sky.hdr", "scale": 2 }"#)?.source, EnvironmentSource::Picture(_)));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "Keys")]
pub struct EnvironmentOverride {
    /// Where the light comes from.
    pub source: EnvironmentSource,
    /// Multiplies its radiance.
    pub scale: f32,
    /// Turns it about the up axis, counter-clockwise seen from above, in degrees.
    pub rotation_deg: f32,
}

/// Where the light of an [`EnvironmentOverride`] comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// An equirectangular picture (HDR, EXR, PFM, or an eight-bit one); its upper edge is straight up, its middle −y.
    Picture(PathBuf),
    /// A clear sky with its sun, in kilo-candela per square metre; north is +y.
    Clear(SolarMoment),
    /// An overcast sky, as bright as it is at that moment; in kilo-candela per square metre.
    Overcast(SolarMoment),
}

/// An afternoon in summer in the middle of Europe or North America.
const AFTERNOON: SolarMoment = SolarMoment { month: 6, day: 21, solar_hour: 15.0, latitude_deg: 45.0 };

impl EnvironmentOverride {
    /// A word for what needs no file, `"sky"` or `"overcast"`; anything else is the path of a picture.
    pub fn named(word: &str) -> Self {
        match word {
            "sky" => EnvironmentSource::Clear(AFTERNOON).into(),
            "overcast" => EnvironmentSource::Overcast(AFTERNOON).into(),
            path => EnvironmentSource::Picture(path.into()).into(),
        }
    }

    /// The picture, unless it is a sky.
    pub fn file(&self) -> Option<&PathBuf> {
        if let EnvironmentSource::Picture(file) = &self.source { Some(file) } else { None }
    }

    /// The picture, to be changed, unless it is a sky.
    pub fn file_mut(&mut self) -> Option<&mut PathBuf> {
        if let EnvironmentSource::Picture(file) = &mut self.source { Some(file) } else { None }
    }

    /// What is wrong with it, as a sentence; `None` when nothing is.
    pub(crate) fn problem(&self) -> Option<String> {
        let Self { source, scale, rotation_deg } = self;
        if !(scale.is_finite() && *scale >= 0.0 && rotation_deg.is_finite()) {
            let expected = "expected finite numbers, the scale not below zero";
            return Some(format!("found scale {scale} and rotation {rotation_deg}; {expected}"));
        }
        match source {
            EnvironmentSource::Picture(_) => None,
            EnvironmentSource::Clear(moment) | EnvironmentSource::Overcast(moment) => moment.problem(),
        }
    }

    /// Turns directions of the unturned surroundings.
    fn turn(&self) -> DMat3 {
        DMat3::from_rotation_z(f64::from(self.rotation_deg).to_radians())
    }

    /// How the picture with the index `image` surrounds the scene.
    pub(crate) fn of_picture(&self, image: u32) -> Environment {
        let world_from_map = self.turn() * DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
        let map_from_world = world_from_map.transpose().as_mat3();
        Environment::Map { image, rows: MapRows::Bands, scale: Rgb::splat(self.scale), map_from_world }
    }

    /// Gives the scene this sky, with its sun where it is clear, in place of its surroundings; false for a picture of a file, which changes
    /// nothing.
    pub fn light(&self, scene: &mut Scene) -> bool {
        let Some((picture, environment, sun)) = self.of_sky(scene.images.len() as u32) else { return false };
        scene.images.push(picture.into());
        scene.lights.extend(sun);
        scene.environment = Some(environment);
        true
    }

    /// The sky, its sun where it is clear, and its picture, which will have the index `image`; `None` for a picture of a file.
    fn of_sky(&self, image: u32) -> Option<(Image, Environment, Option<Light>)> {
        let turned = |moment: &SolarMoment| self.turn().as_mat3() * moment.to_sun();
        match &self.source {
            EnvironmentSource::Picture(_) => None,
            EnvironmentSource::Clear(moment) => {
                let day = Daylight { to_sun: turned(moment), turbidity: TURBIDITY, ground_albedo: GROUND_ALBEDO };
                let (picture, sky, sun) = day.lights(SKY_WIDTH, self.scale, image);
                Some((picture, sky, (day.to_sun.z > 0.0).then_some(sun)))
            }
            EnvironmentSource::Overcast(moment) => {
                let (picture, sky) = Overcast { to_sun: turned(moment) }.lights(SKY_WIDTH, self.scale, GROUND_ALBEDO, image);
                Some((picture, sky, None))
            }
        }
    }
}

impl From<EnvironmentSource> for EnvironmentOverride {
    fn from(source: EnvironmentSource) -> Self {
        Self { source, scale: 1.0, rotation_deg: 0.0 }
    }
}

/// The table of a file.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    /// An equirectangular picture (HDR, EXR, PFM, or an eight-bit one); its upper edge is straight up, its middle −y.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    /// A sky in place of a picture; its light is in kilo-candela per square metre, and north is +y.
    #[serde(skip_serializing_if = "Option::is_none")]
    sky: Option<Kind>,
    /// Month and day, as in `"06-21"`; a year before them is not looked at.
    #[serde(skip_serializing_if = "Option::is_none")]
    date: Option<String>,
    /// Hour of solar time.
    #[serde(skip_serializing_if = "Option::is_none")]
    hour: Option<f64>,
    /// Degrees, north positive.
    #[serde(skip_serializing_if = "Option::is_none")]
    latitude_deg: Option<f64>,
    /// Multiplies its radiance.
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<f32>,
    /// Turns it about the up axis, counter-clockwise seen from above, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation_deg: Option<f32>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Clear,
    Overcast,
}

impl From<EnvironmentOverride> for Keys {
    fn from(e: EnvironmentOverride) -> Self {
        let common = Self { scale: Some(e.scale), rotation_deg: Some(e.rotation_deg), ..Self::default() };
        let (sky, moment) = match e.source {
            EnvironmentSource::Picture(file) => return Self { file: Some(file), ..common },
            EnvironmentSource::Clear(moment) => (Kind::Clear, moment),
            EnvironmentSource::Overcast(moment) => (Kind::Overcast, moment),
        };
        let date = Some(format!("{:02}-{:02}", moment.month, moment.day));
        Self { sky: Some(sky), date, hour: Some(moment.solar_hour), latitude_deg: Some(moment.latitude_deg), ..common }
    }
}

impl Keys {
    fn read(self) -> Result<EnvironmentOverride, String> {
        let moment = || {
            let [month, day] = self.date.as_deref().map_or(Ok([AFTERNOON.month, AFTERNOON.day]), month_and_day)?;
            let solar_hour = self.hour.unwrap_or(AFTERNOON.solar_hour);
            let latitude_deg = self.latitude_deg.unwrap_or(AFTERNOON.latitude_deg);
            Ok::<_, String>(SolarMoment { month, day, solar_hour, latitude_deg })
        };
        let tells_moment = self.date.is_some() || self.hour.is_some() || self.latitude_deg.is_some();
        let source = match (self.file.clone(), self.sky) {
            (Some(_), None) if tells_moment => return Err("date, hour and latitude_deg are keys of a sky, and it has a file".into()),
            (Some(file), None) => EnvironmentSource::Picture(file),
            (None, Some(Kind::Clear)) => EnvironmentSource::Clear(moment()?),
            (None, Some(Kind::Overcast)) => EnvironmentSource::Overcast(moment()?),
            (None, None) => return Err("it needs a file or a sky".into()),
            (Some(_), Some(_)) => return Err("it has a file and a sky; one of them lights the scene".into()),
        };
        Ok(EnvironmentOverride { source, scale: self.scale.unwrap_or(1.0), rotation_deg: self.rotation_deg.unwrap_or(0.0) })
    }
}

/// Month and day of "06-21" or "2026-06-21".
fn month_and_day(date: &str) -> Result<[u32; 2], String> {
    let numbers: Option<Vec<u32>> = date.split('-').map(|part| part.parse().ok()).collect();
    match numbers.as_deref() {
        Some([month, day] | [_, month, day]) => Ok([*month, *day]),
        _ => Err(format!("the date {date:?} is not like \"06-21\" or \"2026-06-21\"")),
    }
}

impl<'de> Deserialize<'de> for EnvironmentOverride {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = EnvironmentOverride;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("\"sky\", \"overcast\" or a table such as { file = \"sky.hdr\" }")
            }

            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Self::Value, E> {
                match word {
                    "sky" | "overcast" => Ok(EnvironmentOverride::named(word)),
                    other => Err(E::invalid_value(serde::de::Unexpected::Str(other), &self)),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                Keys::deserialize(MapAccessDeserializer::new(map))?.read().map_err(A::Error::custom)
            }
        }
        deserializer.deserialize_any(Words)
    }
}

impl Value for EnvironmentOverride {
    const FORM: Form = Form::Path;

    fn read(given: &Given) -> Option<Self> {
        given.text().map(Self::named)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;

    fn read(text: &str) -> Result<EnvironmentOverride, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    #[test]
    fn every_environment_survives_being_written_and_read() {
        for text in [
            r#""sky""#,
            r#""overcast""#,
            r#"{"file":"a/b.hdr","scale":2.0,"rotation_deg":-30.0}"#,
            r#"{"sky":"clear","date":"2024-12-03","hour":8.25}"#,
        ] {
            let first = read(text).unwrap();
            let again = read(&serde_json::to_string(&first).unwrap()).unwrap();
            assert_eq!(first, again, "{text}");
        }
    }

    #[test]
    fn tables_that_say_too_much_or_too_little_are_refused() {
        for (text, words) in [
            ("{}", "a file or a sky"),
            (r#"{"file":"a.hdr","sky":"clear"}"#, "a file and a sky"),
            (r#"{"file":"a.hdr","hour":3}"#, "keys of a sky"),
            (r#"{"sky":"clear","date":"midsummer"}"#, "midsummer"),
            (r#"{"sky":"cloudy"}"#, "unknown variant `cloudy`"),
            (r#""sunny""#, "expected \"sky\", \"overcast\""),
            (r#"{"sky":"clear","time":3}"#, "unknown field `time`"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(words), "{text}: {message}");
        }
        assert!(read(r#"{"sky":"clear","date":"02-31"}"#).unwrap().problem().unwrap().contains("day 31"));
    }

    #[test]
    fn the_sun_turns_with_the_sky() {
        let sun = |rotation_deg: f32| {
            let sky = EnvironmentOverride { rotation_deg, ..EnvironmentOverride::named("sky") };
            let Some((_, _, Some(Light::Directional { direction, .. }))) = sky.of_sky(0) else { panic!("no sun") };
            -direction
        };
        let (plain, turned) = (sun(0.0), sun(90.0));
        assert!(plain.x < -0.5 && plain.z > 0.6, "in the afternoon it is in the west: {plain}");
        assert!((turned - Vec3::new(-plain.y, plain.x, plain.z)).length() < 1e-5, "{plain} {turned}");
    }

    #[test]
    fn a_night_has_no_sun() {
        let night = SolarMoment { solar_hour: 0.0, ..AFTERNOON };
        let (_, _, sun) = EnvironmentOverride::from(EnvironmentSource::Clear(night)).of_sky(0).unwrap();
        assert_eq!(sun, None);
    }
}
