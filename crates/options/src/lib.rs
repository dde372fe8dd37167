//! Options that are declared once: in a struct, with type, default and one doc comment.
//!
//! [`options!`] declares the struct. From it come the keys of `dataset.toml` (a struct of [`Keys`] that remembers where each value is written),
//! the flags of the command line and the keywords of Python (from the table [`Options::OPTIONS`]), and the tables of the documentation, for which
//! `xtask` reads the same lines. [`words!`] declares an enum whose variants are words in all of them.
//!
//! ```
//! use enfilade_options::{Given, Options, named, options, words};
//!
//! words! {
//!     /// Where lamps hang.
//!     #[derive(Clone, Copy, Debug, PartialEq)]
//!     pub enum Lamps {
//!         /// Below every ceiling.
//!         Ceiling = "ceiling",
//!     }
//! }
//! options! {
//!     /// What a scene file does not state.
//!     pub struct Import {
//!         /// Metres per unit of the file.
//!         pub meters_per_unit: f64 = 1.0,
//!         /// Lamps for a scene without any.
//!         pub lamps: Option<Lamps> = None => named("WHERE"),
//!     }
//! }
//!
//! let mut import = Import::default();
//! import.set("lamps", &Given::Text("ceiling".into()))?;
//! assert_eq!((import.meters_per_unit, import.lamps), (1.0, Some(Lamps::Ceiling)));
//! assert_eq!(Import::OPTIONS[0].flag(), "meters-per-unit");
//! assert!(import.set("lamp", &Given::Switch(true)).unwrap_err().contains("did you mean `lamps`"));
//! # Ok::<(), String>(())
//! ```

mod bounded;
mod declare;
mod form;
mod keys;
mod spec;
pub mod text;
mod value;

pub use bounded::{Interval, Whole};
pub use form::{Form, Given, Word};
pub use keys::{Keys, read_keys, read_keys_of};
pub use serde_spanned::Spanned;
pub use spec::{DEGREES, MEBIBYTES, METERS, Options, SHARE, SHARES, Shown, Spec, TIME, named, unknown};
pub use text::Unit;
pub use value::Value;

/// The candidate most like `found`, when one is near enough to be what was meant.
pub fn closest<'a>(found: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let similarity = |c: &str| strsim::jaro_winkler(&found.to_lowercase(), &c.to_lowercase());
    candidates.iter().copied().map(|c| (similarity(c), c)).filter(|(s, _)| *s > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, c)| c)
}

/// The names in `known`, after the one that is most like `found`, if any is.
pub fn proposal(found: &str, known: &[&str]) -> String {
    let nearest = closest(found, known).map(|name| format!("did you mean `{name}`? "));
    format!("{}expected one of {}", nearest.unwrap_or_default(), known.join(", "))
}

/// Serde's message about an unknown field or variant with the nearest known one; other messages as they are.
pub fn with_nearest(message: &str) -> String {
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let nearest = match names.split_first() {
        Some((found, known)) if message.starts_with("unknown ") => closest(found, known),
        _ => None,
    };
    nearest.map_or_else(|| message.into(), |name| format!("{message}; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn proposals_are_near_or_none() {
        assert_eq!(closest("sampels", &["size", "samples", "seed"]), Some("samples"));
        assert_eq!(closest("zzz", &["size", "samples"]), None);
        let message = "unknown field `seeed`, expected `size` or `seed`";
        assert_eq!(with_nearest(message), format!("{message}; did you mean `seed`?"));
        assert_eq!(with_nearest("invalid type: `seed`"), "invalid type: `seed`");
        assert_eq!(proposal("seeed", &["size", "seed"]), "did you mean `seed`? expected one of size, seed");
    }
}
