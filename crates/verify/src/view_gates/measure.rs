//! Measures of a view.

use super::ViewGate;
use crate::frame_gates::{Gate, view_values};
use enfilade_frame::{Frame, Layer};

/// Measures of a camera's place, independent of its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Share of all directions in which there is a back face, or a surface nearer than [`GateConfig::enclosed_m`](super::GateConfig).
    pub enclosed_share: f64,
    /// Share of the level directions in which there is nothing, or a back face.
    pub open_share: f64,
}

/// One value for each gate; [`super::VIEW_GATES`] defines each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "plain words")]
pub struct ViewMeasures {
    pub void_share: f64,
    pub enclosed_share: f64,
    pub open_share: f64,
    pub back_face_share: f64,
    pub near_share: f64,
    pub depth_range_m: f64,
    pub plane_share: f64,
    pub invalid_share: f64,
}

impl ViewMeasures {
    /// Measures from the geometry layers of a view, in metres, and the place where it is taken.
    ///
    /// `wrong_side` is true for pixels that show the back of something that has a front. In `seeing` of the pixels the camera sees
    /// at all; the others are ignored. Surfaces nearer than `min_depth_m` are too near.
    ///
    /// # Panics
    /// When a layer that `Look` has is missing, or `wrong_side` is not of the frame's size.
    pub fn new(frame: &Frame, wrong_side: &[bool], seeing: usize, place: Place, min_depth_m: f64) -> Self {
        assert_eq!(wrong_side.len(), frame.pixels(), "one entry per pixel");
        let distances = frame.get(Layer::DepthMeters).expect("a look has distances");
        let share = |n: usize| if seeing > 0 { n as f64 / seeing as f64 } else { 0.0 };
        let near = (0..distances.len()).filter(|&i| distances.get(i) < min_depth_m).count();
        let met = (0..distances.len()).filter(|&i| distances.get(i).is_finite()).count();
        let values = view_values(frame, seeing);
        Self {
            void_share: 1.0 - share(met),
            enclosed_share: place.enclosed_share,
            open_share: place.open_share,
            back_face_share: share(wrong_side.iter().filter(|wrong| **wrong).count()),
            near_share: share(near),
            depth_range_m: values[&Gate::DepthRange],
            plane_share: values[&Gate::PlaneShare],
            invalid_share: values[&Gate::InvalidShare],
        }
    }

    /// The value that a gate judges.
    pub fn value(&self, gate: ViewGate) -> f64 {
        match gate {
            ViewGate::Blank => self.void_share,
            ViewGate::Buried => self.enclosed_share,
            ViewGate::Outside => self.open_share,
            ViewGate::BackFaces => self.back_face_share,
            ViewGate::Blocked => self.near_share,
            ViewGate::DepthRange => self.depth_range_m,
            ViewGate::BareWall => self.plane_share,
            ViewGate::Invalid => self.invalid_share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom as testroom;

    const PLACE: Place = Place { enclosed_share: 0.1, open_share: 0.2 };

    #[test]
    fn void_counts_only_where_the_camera_sees() {
        let frame = testroom::frame(&testroom::pose());
        let ids = frame.get(Layer::RenderEntityId).unwrap();
        let void = (0..ids.len()).filter(|&i| ids.get(i) == -1.0).count();
        let measured = |seeing| ViewMeasures::new(&frame, &vec![false; ids.len()], seeing, PLACE, 0.3);
        let whole = measured(ids.len());
        assert!((whole.void_share - void as f64 / ids.len() as f64).abs() < 1e-12 && whole.void_share == whole.invalid_share);
        // All void pixels are beyond the rim.
        let rim = measured(ids.len() - void);
        assert_eq!((rim.void_share, rim.invalid_share), (0.0, 0.0));
        assert!(rim.plane_share > whole.plane_share && (rim.enclosed_share, rim.open_share) == (0.1, 0.2));
    }

    #[test]
    fn what_is_near_or_seen_from_behind_is_counted() {
        let frame = testroom::frame(&testroom::pose());
        let n = frame.pixels();
        let wrong: Vec<bool> = (0..n).map(|i| i % 4 == 0).collect();
        let measured = ViewMeasures::new(&frame, &wrong, n, PLACE, 1000.0);
        assert_eq!(measured.back_face_share, 0.25);
        assert!((measured.near_share - (1.0 - measured.void_share)).abs() < 1e-12);
    }
}
