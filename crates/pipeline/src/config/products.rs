//! `products` of `dataset.toml`: what is made of finished frames, by its word or as a table with options.

use super::sensors::read_sensors;
use crate::error::Error;
use crate::relight::mixes_of;
use crate::request::{FrameChoice, MixRequest, Product, ProductKeys, ProductOptions, Request};
use enfilade_options::{Interval, keys, read_keys_of};
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::path::PathBuf;

/// A product that is asked for.
#[derive(Clone)]
pub(super) enum ProductKey {
    /// By its options.
    Options(Product, Box<ProductOptions>),
    /// By a file, as written.
    File(Product, String),
}

/// Keys of `pairs` that are ends of an option.
const ENDS: [&str; 2] = ["min_baseline_m", "max_baseline_m"];

keys! {
    /// Options of products, and ends of them.
    struct TableKeys {
        min_baseline_m: Option<f64>,
        max_baseline_m: Option<f64>,
    }
    with {
        options: ProductKeys,
    }
}

impl TableKeys {
    fn options<E: serde::de::Error>(&self) -> Result<ProductOptions, E> {
        let mut options = ProductOptions::of_keys(&self.options);
        if self.min_baseline_m.is_some() || self.max_baseline_m.is_some() {
            let ends = [self.min_baseline_m.unwrap_or(0.0), self.max_baseline_m.unwrap_or(f64::INFINITY)];
            let wrong = || E::custom(format_args!("the baseline is {ends:?} m; expected two numbers from 0, the smaller one first"));
            options.baseline_m = Some(Interval::of(ends).ok_or_else(wrong)?);
        }
        Ok(options)
    }
}

impl ProductKey {
    /// What it asks of every frame. `path` finds the file that it names.
    ///
    /// # Errors
    /// When that file is not what it should be.
    pub fn requests(&self, path: &dyn Fn(&str) -> Result<PathBuf, Error>) -> Result<Vec<Request>, Error> {
        let of = FrameChoice::default();
        Ok(match self {
            Self::Options(product, options) => options.request(*product, &of).into_iter().collect(),
            Self::File(Product::Relit, file) => {
                let mixes = mixes_of(&path(file)?, None)?;
                mixes.into_iter().map(|mix| Request::Mix { mix: MixRequest(mix), of: of.clone() }).collect()
            }
            Self::File(_, file) => {
                let sensors = read_sensors(&path(file)?)?;
                sensors.all().map(|sensor| Request::Sensor { sensor, of: of.clone() }).collect()
            }
        })
    }

    /// The file that it names, as written.
    pub fn file(&self) -> Option<&str> {
        if let Self::File(_, file) = self { Some(file) } else { None }
    }
}

/// The file that says what is asked of a product, if one does: an example of it.
fn file_of(product: Product) -> Option<&'static str> {
    match product {
        Product::Sensors => Some("sensors.toml"),
        Product::Relit => Some("mixes.csv"),
        _ => None,
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
                let product = on_request(word).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(word), &self))?;
                match file_of(product) {
                    Some(file) => Err(E::custom(format!("{word} needs a file: {{ {word} = \"{file}\" }}"))),
                    None => Ok(ProductKey::Options(product, Box::default())),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ProductKey, A::Error> {
                let word: String = map.next_key()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
                let product = on_request(&word).ok_or_else(|| {
                    let words = Product::ON_REQUEST.map(|product| format!("`{}`", product.name()));
                    A::Error::custom(format_args!("unknown variant `{word}`, expected one of {}", words.join(", ")))
                })?;
                let key = map.next_value_seed(OfProduct(product))?;
                match map.next_key::<String>()? {
                    None => Ok(key),
                    Some(other) => Err(A::Error::custom(format_args!("found `{other}` beside `{word}`; expected a table for each"))),
                }
            }
        }
        deserializer.deserialize_any(WordOrTable)
    }
}

fn on_request(word: &str) -> Option<Product> {
    Product::ON_REQUEST.into_iter().find(|product| product.name() == word)
}

/// Reads what is asked of a product.
struct OfProduct(Product);

impl<'de> DeserializeSeed<'de> for OfProduct {
    type Value = ProductKey;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<ProductKey, D::Error> {
        let Self(product) = self;
        if file_of(product).is_some() {
            return String::deserialize(deserializer).map(|file| ProductKey::File(product, file));
        }
        let ends: &[&str] = if product == Product::Pairs { &ENDS } else { &[] };
        let keys: TableKeys = read_keys_of(deserializer, &[product.keys(), ends].concat())?;
        keys.options().map(|options| ProductKey::Options(product, Box::new(options)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::{FlowPairs, PairsRequest};

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
    fn a_baseline_is_two_numbers_or_has_its_ends_by_themselves() {
        let pairs = PairsRequest { min_baseline_m: 0.3, max_baseline_m: Some(2.0), ..PairsRequest::default() };
        for text in ["baseline_m = [0.3, 2]", "min_baseline_m = 0.3, max_baseline_m = 2.0"] {
            assert_eq!(requests(&format!("[{{ pairs = {{ {text} }} }}]")).unwrap(), [Request::Pairs(pairs.clone())], "{text}");
        }
        let found = requests("[{ pairs = { min_baseline_m = 0.3, overlap = [0.1, 1], angle_deg = [0, 90] } }]").unwrap();
        let pairs = PairsRequest { max_baseline_m: None, overlap: Some([0.1, 1.0]), angle_deg: [0.0, 90.0], ..pairs };
        assert_eq!(found, [Request::Pairs(pairs)]);
    }

    #[test]
    fn unknown_products_and_values_out_of_range_are_refused() {
        for (text, expected) in [
            (r#"["depth"]"#, "expected a product, one of pairs, flow, tracks"),
            (r#"["sensors"]"#, "sensors needs a file: { sensors = \"sensors.toml\" }"),
            (r#"[{ tracks = { point = 9 } }]"#, "unknown field `point`"),
            (r#"[{ tracks = { layers = 9 } }]"#, "unknown field `layers`, expected one of `points`, `seed`"),
            (r#"[{ tracks = { points = 0 } }]"#, "expected a whole number from 1 to 4294967295, found 0"),
            (r#"[{ surfaces = { layers = 65 } }]"#, "expected a whole number from 1 to 64, found 65"),
            (r#"[{ pairs = { overlap = [0.7, 0.2] } }]"#, "expected two numbers from 0 to 1, the smaller one first, found [0.7, 0.2]"),
            (r#"[{ pairs = { max_baseline_m = -1 } }]"#, "the baseline is [0.0, -1.0] m"),
            (r#"[{ words = { seed = 9 } }]"#, "unknown field `seed`"),
            (r#"[{ depth = {} }]"#, "unknown variant `depth`, expected one of `pairs`, `flow`"),
            (r#"[{ words = {}, rooms = {} }]"#, "; expected a table for each"),
            (r#"[{ sensors = "none.toml" }]"#, "cannot read none.toml"),
        ] {
            let message = requests(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
