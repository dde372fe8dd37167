//! Labels that are proposed from the names of parts and materials.

use super::pieces::Piece;
use super::source::Source;
use serde::Serialize;

/// A proposed class.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suggestion {
    /// NYU40.
    pub semantic: i16,
    /// How likely it is, in [0, 1].
    pub confidence: f64,
    /// Other classes and how likely they are, the likeliest first.
    pub alternatives: Vec<(i16, f64)>,
}

/// What is proposed for each piece.
pub fn suggestions(_source: &Source, pieces: &[Piece]) -> Vec<Option<Suggestion>> {
    vec![None; pieces.len()]
}
