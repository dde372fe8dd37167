use crate::ViewStats;
use serde::{Deserialize, Serialize};

/// How much a view is worth. Poses are chosen in proportion to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Saliency {
    /// The Hypersim paper's equation 1: n^`alpha` · (1 − e)^`beta`, with n the number of distinct triangles in the test image and e
    /// the share of its pixels that show no surface. It prefers finely tessellated things.
    Triangles {
        /// Exponent of the number of triangles.
        alpha: f64,
        /// Exponent of the share of pixels that show a surface.
        beta: f64,
    },
}

impl Default for Saliency {
    fn default() -> Self {
        Self::Triangles { alpha: 1.0, beta: 2.0 }
    }
}

impl Saliency {
    /// The score of a view, 0 or more.
    pub fn score(&self, view: &ViewStats) -> f64 {
        match self {
            Self::Triangles { alpha, beta } => f64::from(view.triangles).powf(*alpha) * (1.0 - view.void_share()).powf(*beta),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_count_once_and_empty_pixels_count_squared() {
        let view = ViewStats { pixels: 100, hits: 50, triangles: 12 };
        assert_eq!(Saliency::default().score(&view), 3.0);
        assert_eq!(Saliency::Triangles { alpha: 2.0, beta: 0.0 }.score(&view), 144.0);
        assert_eq!(Saliency::default().score(&ViewStats { pixels: 100, hits: 0, triangles: 0 }), 0.0);
    }
}
