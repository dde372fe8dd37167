//! Time codes: how those of a layer become the stage's, and these seconds.
//!
//! A layer's time is scaled and shifted by the sublayer, reference or payload that brings it in, and by the ratio of both layers' time codes
//! a second (OpenUSD, `SdfLayerOffset` and `Pcp`).

use super::layer::Layer;
use super::value::Value;

/// Time codes a second where a layer states none.
const DEFAULT_CODES_PER_SECOND: f64 = 24.0;

/// A map from a layer's time codes to those of what uses it: by a scale, then by an offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Retiming {
    pub offset: f64,
    pub scale: f64,
}

impl Default for Retiming {
    fn default() -> Self {
        Self { offset: 0.0, scale: 1.0 }
    }
}

impl Retiming {
    /// The map of what a layer or file states; a map that makes no sense changes nothing, as in USD.
    pub(super) fn new(offset: f64, scale: f64) -> Self {
        let is_map = offset.is_finite() && scale.is_finite() && scale != 0.0;
        if is_map { Self { offset, scale } } else { Self::default() }
    }

    /// A time code.
    pub(super) fn of(self, code: f64) -> f64 {
        self.scale * code + self.offset
    }

    /// The map that `self` makes of the results of `inner`.
    pub(super) fn after(self, inner: Self) -> Self {
        Self { offset: self.of(inner.offset), scale: self.scale * inner.scale }
    }

    /// The map of a layer that another uses by `self`, with the time codes a second of both.
    pub(super) fn between(self, user: &Layer, used: &Layer) -> Self {
        Self { scale: self.scale * codes_per_second(user) / codes_per_second(used), ..self }
    }
}

/// Time codes a second of a layer.
pub(super) fn codes_per_second(layer: &Layer) -> f64 {
    let stated = |name: &str| layer.get("/", name).and_then(Value::as_number).filter(|rate| rate.is_finite() && *rate > 0.0);
    stated("timeCodesPerSecond").or_else(|| stated("framesPerSecond")).unwrap_or(DEFAULT_CODES_PER_SECOND)
}
