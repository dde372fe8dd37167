//! The limits of the gates of views, and what becomes of views beyond them.

use super::{VIEW_GATES, ViewGate, ViewMeasures};
use crate::frame_gates::Gate;
use enfilade_options::{options, words};
use serde::{Deserialize, Serialize};

words! {
    /// What becomes of a view that a gate does not let through.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum GateAction {
        /// The view is not rendered, and planning looks for another one where it can.
        #[default]
        Reject = "reject",
        /// The view is rendered as if nothing were wrong, and reported.
        Report = "report",
    }
}

options! {
    /// The limits; values equal to a limit pass.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct GateConfig keys pub GateKeys {
        /// What becomes of a view that does not pass. Default: it is rejected.
        pub action: GateAction = GateAction::Reject,
        /// Largest share of the pixels that show no surface, for a view not to be blank. Default 0.9.
        pub max_void_share: f64 = 0.9,
        /// Something nearer to the camera than this closes it in, metres. Default 0.5.
        pub enclosed_m: f64 = 0.5,
        /// Largest share of the directions around the camera that may be closed. Default 0.8: a corner of a room closes less.
        pub max_enclosed_share: f64 = 0.8,
        /// Largest share of the level directions around the camera that may lead out. Default 0.5: outside of a building more do.
        pub max_open_share: f64 = 0.5,
        /// Largest share of the pixels that may show the back of things. Default 0.25.
        pub max_back_face_share: f64 = 0.25,
        /// Something nearer than this is too near, metres. Default 0.3.
        pub min_depth_m: f64 = 0.3,
        /// Largest share of the pixels that may show something too near. Default 0.5.
        pub max_near_share: f64 = 0.5,
        /// Least range of depths, metres. Default 0.5.
        pub min_depth_range_m: f64 = Gate::DepthRange.spec().bound,
        /// Largest share of the pixels that one plane may fill. Default 0.9.
        pub max_plane_share: f64 = Gate::PlaneShare.spec().bound,
        /// Largest share of pixels without depth. Default 0.03.
        pub max_invalid_share: f64 = Gate::InvalidShare.spec().bound,
    }
}

/// Shares measured through every so many pixels are within this of those of all pixels.
const CLOSE: f64 = 0.02;

/// A limit that is out of its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{expected}, found {found}")]
pub struct LimitError {
    /// Name of the field.
    pub field: &'static str,
    /// Value of the field.
    pub found: f64,
    /// What must be, as in "a share must lie between 0 and 1".
    pub expected: &'static str,
}

impl GateConfig {
    /// Checks the limits.
    ///
    /// # Errors
    /// The first one that is out of its range.
    pub fn validate(&self) -> Result<(), LimitError> {
        let shares = [
            ("max_void_share", self.max_void_share),
            ("max_enclosed_share", self.max_enclosed_share),
            ("max_open_share", self.max_open_share),
            ("max_back_face_share", self.max_back_face_share),
            ("max_near_share", self.max_near_share),
            ("max_plane_share", self.max_plane_share),
            ("max_invalid_share", self.max_invalid_share),
        ];
        for (field, found) in shares {
            if !(0.0..=1.0).contains(&found) {
                return Err(LimitError { field, found, expected: "a share must lie between 0 and 1" });
            }
        }
        for (field, found) in
            [("enclosed_m", self.enclosed_m), ("min_depth_m", self.min_depth_m), ("min_depth_range_m", self.min_depth_range_m)]
        {
            if !(found >= 0.0 && found.is_finite()) {
                return Err(LimitError { field, found, expected: "a length must be 0 or more metres" });
            }
        }
        Ok(())
    }

    /// The limit of a gate.
    pub fn limit(&self, gate: ViewGate) -> f64 {
        match gate {
            ViewGate::Blank => self.max_void_share,
            ViewGate::Buried => self.max_enclosed_share,
            ViewGate::Outside => self.max_open_share,
            ViewGate::BackFaces => self.max_back_face_share,
            ViewGate::Blocked => self.max_near_share,
            ViewGate::DepthRange => self.min_depth_range_m,
            ViewGate::BareWall => self.max_plane_share,
            ViewGate::Invalid => self.max_invalid_share,
        }
    }

    /// Whether a value is good. What is not a number is not.
    pub fn passes(&self, gate: ViewGate, value: f64) -> bool {
        match gate {
            ViewGate::DepthRange => value >= self.limit(gate),
            _ => value <= self.limit(gate),
        }
    }

    /// The worst fault of a view; `None` when it passes.
    pub fn fault(&self, measures: &ViewMeasures) -> Option<ViewGate> {
        VIEW_GATES.iter().map(|spec| spec.gate).find(|gate| !self.passes(*gate, measures.value(*gate)))
    }

    /// Whether more pixels might change the outcome, for measures taken through some of a view's pixels. A range of depths can only
    /// grow; directions around the camera are the same either way.
    pub fn is_close(&self, measures: &ViewMeasures) -> bool {
        for spec in &VIEW_GATES {
            let (value, limit) = (measures.value(spec.gate), self.limit(spec.gate));
            let close = match spec.gate {
                ViewGate::Buried | ViewGate::Outside => false,
                ViewGate::DepthRange => value < limit,
                _ => (value - limit).abs() <= CLOSE,
            };
            if close || !self.passes(spec.gate, value) {
                return close;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: ViewMeasures = ViewMeasures {
        void_share: 0.0,
        enclosed_share: 0.1,
        open_share: 0.0,
        back_face_share: 0.0,
        near_share: 0.0,
        depth_range_m: 3.0,
        plane_share: 0.4,
        invalid_share: 0.0,
    };

    #[test]
    fn a_view_is_rejected_for_its_worst_fault_and_a_limit_itself_passes() {
        let config = GateConfig::default();
        assert_eq!(config.fault(&GOOD), None);
        assert_eq!(config.fault(&ViewMeasures { plane_share: 0.9, depth_range_m: 0.5, invalid_share: 0.03, ..GOOD }), None);
        let wall = ViewMeasures { plane_share: 0.95, ..GOOD };
        assert_eq!(config.fault(&wall), Some(ViewGate::BareWall));
        assert_eq!(config.fault(&ViewMeasures { near_share: 0.9, ..wall }), Some(ViewGate::Blocked));
        assert_eq!(config.fault(&ViewMeasures { depth_range_m: f64::NAN, ..GOOD }), Some(ViewGate::DepthRange));
    }

    #[test]
    fn only_what_more_pixels_could_change_is_close() {
        let config = GateConfig::default();
        assert!(!config.is_close(&GOOD) && !config.is_close(&ViewMeasures { plane_share: 0.95, ..GOOD }));
        assert!(config.is_close(&ViewMeasures { plane_share: 0.915, ..GOOD }));
        assert!(config.is_close(&ViewMeasures { depth_range_m: 0.4, ..GOOD }));
        // A view that is clearly blank is so whatever its planes.
        assert!(!config.is_close(&ViewMeasures { void_share: 1.0, plane_share: 0.9, ..GOOD }));
    }
}
