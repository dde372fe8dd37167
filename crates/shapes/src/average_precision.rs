//! Average precision as in Pascal VOC since 2010: the area below the curve of precision over recall, where precision is made to
//! fall. Everingham et al. 2015; Mesh R-CNN's `VOCap.compute_ap`.

use crate::judge::Judged;
use std::collections::BTreeMap;

/// The area below the curve, 0 to 1, of detections with their scores and whether each is a hit, where there are `truths` objects to find.
/// Detections of one score keep their order. Without objects it is 0.
///
/// ```
/// use enfilade_shapes::average_precision;
/// // The first hit finds half of the objects at precision 1, the second the other half at precision 2/3.
/// let detections = [(0.9, true), (0.8, false), (0.7, true)];
/// assert!((average_precision(&detections, 2) - (0.5 + 0.5 * 2.0 / 3.0)).abs() < 1e-12);
/// ```
pub fn average_precision(detections: &[(f64, bool)], truths: usize) -> f64 {
    if truths == 0 {
        return 0.0;
    }
    let mut sorted = detections.to_vec();
    sorted.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut hits = 0;
    let mut curve: Vec<(f64, f64)> = (1..)
        .zip(&sorted)
        .map(|(seen, &(_, hit))| {
            hits += usize::from(hit);
            (hits as f64 / truths as f64, hits as f64 / f64::from(seen))
        })
        .collect();
    for i in (1..curve.len()).rev() {
        curve[i - 1].1 = curve[i - 1].1.max(curve[i].1);
    }
    let mut recall = 0.0;
    let strip = |&(next, precision): &(f64, f64)| (next - std::mem::replace(&mut recall, next)) * precision;
    // The sum of nothing is −0.
    curve.iter().map(strip).sum::<f64>() + 0.0
}

/// Average precision of boxes, masks and meshes, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Precision {
    /// Average precision of boxes.
    pub bbox: f64,
    /// Average precision of masks.
    pub mask: f64,
    /// Average precision of meshes.
    pub mesh: f64,
    /// Objects that were there to be found.
    pub truths: usize,
}

/// The average precision of every category that has objects, and their mean. `truths` counts the objects of each category.
pub fn summarize(judged: &[Judged], truths: &BTreeMap<u32, usize>) -> (Precision, BTreeMap<u32, Precision>) {
    let of = |category: u32, count: usize| {
        let ours: Vec<&Judged> = judged.iter().filter(|row| row.category == category).collect();
        let ap = |hit: fn(&Judged) -> bool| average_precision(&ours.iter().map(|row| (row.score, hit(row))).collect::<Vec<_>>(), count);
        Precision { bbox: ap(|row| row.box_hit), mask: ap(|row| row.mask_hit), mesh: ap(|row| row.mesh_hit), truths: count }
    };
    let by_category: BTreeMap<u32, Precision> =
        truths.iter().filter(|(_, count)| **count > 0).map(|(&category, &count)| (category, of(category, count))).collect();
    let mean = |value: fn(&Precision) -> f64| by_category.values().map(value).sum::<f64>() / by_category.len().max(1) as f64;
    let all = Precision {
        bbox: mean(|p| p.bbox),
        mask: mean(|p| p.mask),
        mesh: mean(|p| p.mesh),
        truths: by_category.values().map(|p| p.truths).sum(),
    };
    (all, by_category)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perfect_detections_have_one_and_none_have_zero() {
        assert_eq!(average_precision(&[(0.9, true), (0.8, true)], 2), 1.0);
        assert_eq!(average_precision(&[(0.9, false)], 2), 0.0);
        assert_eq!(average_precision(&[], 2), 0.0);
        assert_eq!(average_precision(&[(0.9, true)], 0), 0.0);
    }

    #[test]
    fn a_curve_is_made_to_fall_before_its_area_is_taken() {
        // Hit, miss, hit, hit of 4 objects: precision 1, 1/2, 2/3, 3/4 becomes 1, 3/4, 3/4, 3/4.
        let found = average_precision(&[(0.6, true), (0.9, true), (0.7, true), (0.8, false)], 4);
        assert!((found - (0.25 + 0.25 * 0.75 + 0.25 * 0.75)).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_miss_behind_all_hits_costs_nothing_and_one_before_them_does() {
        assert_eq!(average_precision(&[(0.9, true), (0.1, false)], 1), 1.0);
        assert_eq!(average_precision(&[(0.1, true), (0.9, false)], 1), 0.5);
    }

    #[test]
    fn the_mean_is_over_categories_that_have_objects() {
        let row = |category, hit| Judged {
            category,
            score: 0.5,
            truth: 0,
            box_iou: 0.9,
            mask_iou: 0.9,
            f1: 0.9,
            box_hit: true,
            mask_hit: hit,
            mesh_hit: false,
        };
        let truths = BTreeMap::from([(1, 1), (3, 2), (5, 0)]);
        let (all, by_category) = summarize(&[row(1, true), row(3, true), row(5, true)], &truths);
        assert_eq!((all.bbox, all.mask, all.mesh, all.truths), (0.75, 0.75, 0.0, 3));
        assert_eq!(by_category.keys().copied().collect::<Vec<_>>(), [1, 3]);
    }
}
