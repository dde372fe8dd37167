//! Pairs of frames that are worth training on, of all that a scene has.

use crate::Filmed;
use enfilade_dataset::{Covisibility, PairRow};

/// Which pairs are chosen. Bounds are included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairFilter {
    /// Bounds of both shares: of the first frame that the second sees, and the other way around.
    pub overlap: [f32; 2],
    /// Range of distances between the camera centres, metres.
    pub baseline_m: [f64; 2],
    /// Range of angles between the viewing axes, degrees.
    pub angle_deg: [f64; 2],
}

impl Default for PairFilter {
    /// Every pair whose frames see each other at all.
    fn default() -> Self {
        Self { overlap: [f32::MIN_POSITIVE, 1.0], baseline_m: [0.0, f64::INFINITY], angle_deg: [0.0, 180.0] }
    }
}

impl PairFilter {
    /// Whether a pair is chosen.
    pub fn takes(&self, row: &PairRow) -> bool {
        let [least, most] = self.overlap;
        [row.first_seen_by_second, row.second_seen_by_first].iter().all(|share| (least..=most).contains(share))
            && (self.baseline_m[0]..=self.baseline_m[1]).contains(&row.baseline_m)
            && (self.angle_deg[0]..=self.angle_deg[1]).contains(&row.angle_deg)
    }
}

/// The pairs of a scene that the filter takes, each once, by first and then second frame. The matrix must be of these frames.
///
/// # Panics
/// When it is of fewer.
pub fn choose_pairs(filmed: &Filmed<'_>, covisibility: &Covisibility, filter: &PairFilter) -> Vec<PairRow> {
    let n = filmed.len();
    let row = |first: usize, second: usize| PairRow {
        pair: filmed.pair([first, second]),
        first_seen_by_second: covisibility.share(first, second),
        second_seen_by_first: covisibility.share(second, first),
        baseline_m: filmed.baseline_m([first, second]),
        angle_deg: filmed.angle_deg([first, second]),
    };
    let pairs = (0..n).flat_map(|first| (first + 1..n).map(move |second| (first, second)));
    pairs.map(|(first, second)| row(first, second)).filter(|row| filter.takes(row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::FramePair;

    #[test]
    fn both_shares_the_baseline_and_the_angle_must_lie_in_their_ranges() {
        let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 0), second: ("cam_00".into(), 1) };
        let row = |first_seen_by_second, second_seen_by_first, baseline_m, angle_deg| PairRow {
            pair: pair.clone(),
            first_seen_by_second,
            second_seen_by_first,
            baseline_m,
            angle_deg,
        };
        let filter = PairFilter { overlap: [0.2, 0.7], baseline_m: [0.1, 2.0], angle_deg: [0.0, 60.0] };
        assert!(filter.takes(&row(0.2, 0.7, 0.1, 60.0)));
        for other in [
            row(0.1, 0.5, 1.0, 9.0),
            row(0.5, 0.8, 1.0, 9.0),
            row(0.5, 0.5, 0.0, 9.0),
            row(0.5, 0.5, 1.0, 61.0),
            row(f32::NAN, 0.5, 1.0, 9.0),
        ] {
            assert!(!filter.takes(&other), "{other:?}");
        }
        let any = PairFilter::default();
        assert!(any.takes(&row(0.01, 1.0, 9.0, 180.0)) && !any.takes(&row(0.0, 0.0, 1.0, 0.0)));
    }
}
