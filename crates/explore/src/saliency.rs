//! Saliency of views: scores computed from a test image of each.

use crate::ViewStats;
use enfilade_options::{Form, Given, Value};
use serde::{Deserialize, Serialize};

/// The score of a view: n^`alpha` · (1 − e)^`beta`, with e the share of pixels that show no surface. The kind defines n. Poses are chosen
/// in proportion to their scores.
///
/// All but the first depend on what things are and where, not on how finely they are tessellated.
///
/// ```
/// use enfilade_explore::{Saliency, ViewStats};
///
/// // A view whose lower half shows four parts of equal area, and whose upper half shows nothing.
/// let view = ViewStats { pixels: 100, hits: 50, triangles: 12, parts: 4, perplexity: 4.0, contrast: 0.0 };
/// assert_eq!(Saliency::Triangles { alpha: 1.0, beta: 2.0 }.score(&view), 3.0);
/// assert_eq!(Saliency::Entropy { alpha: 1.0, beta: 2.0 }.score(&view), 1.0);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Saliency {
    /// n is the number of distinct triangles in the test image: equation 1 of Hypersim's paper.
    Triangles {
        /// Exponent of n.
        #[serde(default = "one")]
        alpha: f64,
        /// Exponent of the share of pixels that show a surface.
        #[serde(default = "two")]
        beta: f64,
    },
    /// n is the number of distinct parts that cover at least one pixel in 2000.
    Parts {
        /// Exponent of n.
        #[serde(default = "one")]
        alpha: f64,
        /// Exponent of the share of pixels that show a surface.
        #[serde(default = "two")]
        beta: f64,
    },
    /// n is the perplexity of the parts' projected areas, exp(−Σ p ln p) with p a part's share of the pixels that show a surface: n
    /// parts of equal area have the perplexity n, and small ones beside a large one count little (Vázquez et al. 2001, "Viewpoint
    /// Selection using Viewpoint Entropy").
    Entropy {
        /// Exponent of n.
        #[serde(default = "one")]
        alpha: f64,
        /// Exponent of the share of pixels that show a surface.
        #[serde(default = "two")]
        beta: f64,
    },
    /// n is the perplexity of the projected areas times 1 + `weight` · c, with c the mean contrast of the textures in view (see
    /// [`enfilade_scene::WorldMesh::contrasts`]).
    Texture {
        /// Exponent of n.
        #[serde(default = "one")]
        alpha: f64,
        /// Exponent of the share of pixels that show a surface.
        #[serde(default = "two")]
        beta: f64,
        /// What a mean contrast of 1 adds, as a share.
        #[serde(default = "four")]
        weight: f64,
    },
}

const fn one() -> f64 {
    1.0
}

const fn two() -> f64 {
    2.0
}

const fn four() -> f64 {
    4.0
}

impl Default for Saliency {
    fn default() -> Self {
        Self::Triangles { alpha: 1.0, beta: 2.0 }
    }
}

impl Value for Saliency {
    const FORM: Form = Form::Table;

    fn read(_: &Given) -> Option<Self> {
        None
    }
}

impl Saliency {
    /// The exponents alpha and beta and the weight of texture; the weight is 0 where the saliency has none.
    pub(crate) fn numbers(&self) -> [f64; 3] {
        match *self {
            Self::Triangles { alpha, beta } | Self::Parts { alpha, beta } | Self::Entropy { alpha, beta } => [alpha, beta, 0.0],
            Self::Texture { alpha, beta, weight } => [alpha, beta, weight],
        }
    }

    /// The score of a view, 0 or more.
    pub fn score(&self, view: &ViewStats) -> f64 {
        let (n, alpha, beta) = match *self {
            Self::Triangles { alpha, beta } => (f64::from(view.triangles), alpha, beta),
            Self::Parts { alpha, beta } => (f64::from(view.parts), alpha, beta),
            Self::Entropy { alpha, beta } => (view.perplexity, alpha, beta),
            Self::Texture { alpha, beta, weight } => (view.perplexity * (1.0 + weight * view.contrast), alpha, beta),
        };
        n.powf(alpha) * (1.0 - view.void_share()).powf(beta)
    }

    /// Whether the score needs counts of parts, which take a little time.
    pub(crate) const fn asks_for_parts(&self) -> bool {
        !matches!(self, Self::Triangles { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_count_once_and_empty_pixels_count_squared() {
        let view = ViewStats { pixels: 100, hits: 50, triangles: 12, ..ViewStats::default() };
        assert_eq!(Saliency::default().score(&view), 3.0);
        assert_eq!(Saliency::Triangles { alpha: 2.0, beta: 0.0 }.score(&view), 144.0);
        assert_eq!(Saliency::default().score(&ViewStats { pixels: 100, ..ViewStats::default() }), 0.0);
    }

    #[test]
    fn the_other_kinds_take_their_own_number() {
        let view = ViewStats { pixels: 100, hits: 100, triangles: 12, parts: 5, perplexity: 3.5, contrast: 0.25 };
        assert_eq!(Saliency::Parts { alpha: 1.0, beta: 2.0 }.score(&view), 5.0);
        assert_eq!(Saliency::Entropy { alpha: 2.0, beta: 2.0 }.score(&view), 12.25);
        assert_eq!(Saliency::Texture { alpha: 1.0, beta: 2.0, weight: 4.0 }.score(&view), 7.0);
    }
}
