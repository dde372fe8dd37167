//! What was measured.

use super::scores::Judgement;
use enfilade_suggest::learn::Split;

/// Parts that scenes or volumes are divided into.
pub const FOLDS: usize = 10;

/// What was measured of one way to hold scenes out.
pub struct Measured {
    /// What stayed together.
    pub split: Split,
    /// Our suggestions.
    pub ours: Judgement,
    /// Suggestions by a lookup of whole names.
    pub lookup: Judgement,
    /// Suggestions by a search for the names of classes.
    pub keyword: Judgement,
}
