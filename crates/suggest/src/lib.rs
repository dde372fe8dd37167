//! NYU40 labels proposed from the names of parts and materials, with a confidence that can be trusted.
//!
//! ```
//! use enfilade_suggest::{PartNames, Suggester};
//! let suggester = Suggester::builtin();
//! let suggestion = suggester.suggest(&PartNames { part: "Couch_01", ..PartNames::default() }).unwrap();
//! assert_eq!(suggestion.class, 6); // sofa
//! assert!(suggester.suggest(&PartNames { part: "Mesh.017", ..PartNames::default() }).is_none());
//! ```
//!
//! [`words`](mod@words) takes a name apart, [`features`](mod@features) lists what it is judged by, [`weights`](mod@weights) adds up what
//! each feature speaks for, and [`calibration`] turns the result into a probability. The tables in `data/` were learned ([`mod@learn`])
//! from the names of Hypersim's objects and their labels; `words.csv` is a word list of ours. `docs/suggest.md` has measurements of its
//! quality.

pub mod calibration;
pub mod chain;
pub mod features;
pub mod learn;
pub mod lexicon;
pub mod roles;
mod suggester;
mod table;
pub mod weights;
pub mod words;

pub use suggester::{PartNames, Suggester, Suggestion};
pub use table::TableError;
