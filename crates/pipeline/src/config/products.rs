//! `products` of `dataset.toml`: what is made of finished frames, by its word or as a table with options.

use super::sensors::read_sensors;
use crate::error::Error;
use crate::relight::mixes_of;
use crate::request::{FlowPairs, FrameChoice, MOST_SURFACES, MixRequest, PairsRequest, Product, Request, SURFACES, checked};
use enfilade_multiview::TracksConfig;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::path::PathBuf;

/// A product that is asked for.
#[derive(Clone)]
pub(super) struct ProductKey(Asked);

/// A product with its options: a word alone, or a table with the word as its only key.
#[derive(Clone, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Asked {
    Pairs(PairsKeys),
    Flow(FlowKeys),
    Tracks(TracksKeys),
    Surfaces(SurfacesKeys),
    Rooms(NoKeys),
    Words(NoKeys),
    Sensors(String),
    Relit(String),
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct PairsKeys {
    pixels: Option<u32>,
    overlap: Option<[f32; 2]>,
    min_baseline_m: f64,
    max_baseline_m: Option<f64>,
    angle_deg: Option<[f64; 2]>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlowKeys {
    step: Option<i64>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TracksKeys {
    points: Option<u32>,
    seed: u64,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct SurfacesKeys {
    layers: Option<u32>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoKeys {}

impl Asked {
    /// The product of a word alone; `None` where it needs a file, or there is none.
    fn of_word(word: &str) -> Option<Self> {
        Some(match word {
            "pairs" => Self::Pairs(PairsKeys::default()),
            "flow" => Self::Flow(FlowKeys::default()),
            "tracks" => Self::Tracks(TracksKeys::default()),
            "surfaces" => Self::Surfaces(SurfacesKeys::default()),
            "rooms" => Self::Rooms(NoKeys {}),
            "words" => Self::Words(NoKeys {}),
            _ => return None,
        })
    }
}

impl ProductKey {
    /// What it asks of every frame. `path` finds the file that it names.
    ///
    /// # Errors
    /// When a number is out of its range, or that file is not what it should be.
    pub fn requests(&self, path: &dyn Fn(&str) -> Result<PathBuf, Error>) -> Result<Vec<Request>, Error> {
        let of = FrameChoice::default();
        Ok(match &self.0 {
            Asked::Pairs(keys) => {
                let usual = PairsRequest::default();
                vec![Request::Pairs(PairsRequest {
                    pixels: checked("pixels", keys.pixels.unwrap_or(usual.pixels), u32::MAX)?,
                    overlap: keys.overlap,
                    min_baseline_m: keys.min_baseline_m,
                    max_baseline_m: keys.max_baseline_m,
                    angle_deg: keys.angle_deg.unwrap_or(usual.angle_deg),
                    ..usual
                })]
            }
            Asked::Flow(keys) => vec![Request::Flow { pairs: keys.step.map_or(FlowPairs::Listed, FlowPairs::Step), cameras: None }],
            Asked::Tracks(keys) => {
                let points = checked("points", keys.points.unwrap_or(TracksConfig::default().points), u32::MAX)?;
                vec![Request::Tracks { points, seed: keys.seed, of }]
            }
            Asked::Surfaces(keys) => {
                vec![Request::Surfaces { layers: checked("layers", keys.layers.unwrap_or(SURFACES), MOST_SURFACES)?, of }]
            }
            Asked::Rooms(_) => vec![Request::Rooms { of }],
            Asked::Words(_) => vec![Request::Words],
            Asked::Sensors(file) => {
                let sensors = read_sensors(&path(file)?)?;
                sensors.all().map(|sensor| Request::Sensor { sensor, of: of.clone() }).collect()
            }
            Asked::Relit(file) => {
                let mixes = mixes_of(&path(file)?, None)?;
                mixes.into_iter().map(|mix| Request::Mix { mix: MixRequest(mix), of: of.clone() }).collect()
            }
        })
    }

    /// The file that it names, as written.
    pub fn file(&self) -> Option<&str> {
        if let Asked::Sensors(file) | Asked::Relit(file) = &self.0 { Some(file) } else { None }
    }
}

impl<'de> Deserialize<'de> for ProductKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WordOrTable;
        impl<'de> Visitor<'de> for WordOrTable {
            type Value = ProductKey;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                let words: Vec<&str> = Product::ON_REQUEST.iter().map(|product| product.name()).collect();
                write!(f, "a product, one of {}, or a table such as {{ sensors = \"sensors.toml\" }}", words.join(", "))
            }
            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<ProductKey, E> {
                let needs_file = |file: &str| E::custom(format!("{word} needs a file: {{ {word} = \"{file}\" }}"));
                match word {
                    "sensors" => Err(needs_file("sensors.toml")),
                    "relit" => Err(needs_file("mixes.csv")),
                    _ => Asked::of_word(word).map(ProductKey).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ProductKey, A::Error> {
                Asked::deserialize(MapAccessDeserializer::new(map)).map(ProductKey)
            }
        }
        deserializer.deserialize_any(WordOrTable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Deserialize)]
    struct File {
        products: Vec<ProductKey>,
    }

    fn requests(text: &str) -> Result<Vec<Request>, String> {
        let file: File = toml::from_str(&format!("products = {text}")).map_err(|error| error.to_string())?;
        let found = file.products.iter().map(|key| key.requests(&|path| Ok(path.into())).map_err(|error| error.to_string()));
        Ok(found.collect::<Result<Vec<_>, _>>()?.concat())
    }

    #[test]
    fn words_and_tables_are_requests_of_all_frames() {
        let of = FrameChoice::default();
        let found = requests(r#"["pairs", "words", { tracks = { points = 9 } }, { flow = { step = -1 } }, "surfaces"]"#).unwrap();
        let expected = [
            Request::Pairs(PairsRequest::default()),
            Request::Words,
            Request::Tracks { points: 9, seed: 0, of: of.clone() },
            Request::Flow { pairs: FlowPairs::Step(-1), cameras: None },
            Request::Surfaces { layers: 8, of },
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn unknown_products_and_values_out_of_range_are_refused() {
        for (text, expected) in [
            (r#"["depth"]"#, "expected a product, one of pairs, flow, tracks"),
            (r#"["sensors"]"#, "sensors needs a file: { sensors = \"sensors.toml\" }"),
            (r#"[{ tracks = { point = 9 } }]"#, "unknown field `point`"),
            (r#"[{ tracks = { points = 0 } }]"#, "points is 0, expected at least 1"),
            (r#"[{ sensors = "none.toml" }]"#, "cannot read none.toml"),
        ] {
            let message = requests(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
