//! Time codes: how those of a layer become those of the stage.
//!
//! A layer's time is scaled and shifted by the sublayer, reference or payload that brings it in, and by the ratio of both layers' time codes
//! a second (OpenUSD, `SdfLayerOffset` and `Pcp`).

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

    /// The map of a layer that another uses by `self`, with the time codes a second of the user and of the used one.
    pub(super) fn between(self, user: f64, used: f64) -> Self {
        Self { scale: self.scale * user / used, ..self }
    }
}
