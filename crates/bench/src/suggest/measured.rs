//! The measurements.

use super::scores::Judgement;
use enfilade_suggest::learn::Split;

/// Parts that scenes or volumes are divided into.
pub const FOLDS: usize = 10;

/// The measurements for one way to hold scenes out.
pub struct Measured {
    /// The unit that was held out together.
    pub split: Split,
    /// Our suggestions.
    pub ours: Judgement,
    /// Suggestions by a lookup of whole names.
    pub lookup: Judgement,
    /// Suggestions by a search for the names of classes.
    pub keyword: Judgement,
}
