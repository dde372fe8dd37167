//! What is made and waits for a place.

use super::table::Row;
use super::textiles::Textiles;
use enfilade_math::Rng;
use std::ops::Range;

/// A trace that is made and has no place yet.
pub struct Wish {
    /// What asks for it.
    pub row: &'static Row,
    /// The room.
    pub room: usize,
    /// The piece to which it belongs.
    pub host: Option<String>,
    /// Parts among those that wait.
    pub parts: Range<usize>,
    /// The sort, if it is cloth.
    pub cloth: Option<Textiles>,
    /// Random numbers for its place.
    pub rng: Rng,
}
