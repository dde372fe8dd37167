//! Which detections of an image are hits, after Mesh R-CNN's `evaluate_for_pix3d`.
//!
//! Pix3D has one object per image, and the original asserts it. Here an image may have several: a detection is judged by the object whose
//! box overlaps the detection's box most. With one object per image the results are the original's.

use crate::ShapesError;
use crate::surface::{CompareConfig, Surface, compare};

/// A set of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Row by row.
    pub pixels: Vec<bool>,
}

/// An object that is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Category of the object.
    pub category: u32,
    /// Left, upper, right and lower border, pixels.
    pub bbox: [f64; 4],
    /// Pixels of the object.
    pub mask: Mask,
    /// Surface of the object in camera space.
    pub surface: Surface,
}

/// An object that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Category of the prediction.
    pub category: u32,
    /// How sure the network is.
    pub score: f64,
    /// Left, upper, right and lower border, pixels.
    pub bbox: [f64; 4],
    /// Pixels of the prediction.
    pub mask: Mask,
    /// Surface of the prediction in camera space.
    pub surface: Surface,
}

/// Conditions of a hit.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// Detections whose box overlaps none by more than this are not looked at; 0.3.
    pub filter_iou: f64,
    /// Overlap of boxes and of masks that makes a hit; 0.5.
    pub iou: f64,
    /// F1 that makes a hit, 0 to 1; 0.5.
    pub f1: f64,
    /// Distance within which points count for F1, in a true box whose longest edge is 10; 0.3.
    pub f1_distance: f64,
    /// Points drawn from either surface; 10 000.
    pub samples: usize,
    /// Seed of the points.
    pub seed: u64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { filter_iou: 0.3, iou: 0.5, f1: 0.5, f1_distance: 0.3, samples: 10_000, seed: 0 }
    }
}

/// A detection, judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// Category of the prediction.
    pub category: u32,
    /// How sure the network is.
    pub score: f64,
    /// Index of the object that it was judged by.
    pub truth: usize,
    /// Overlap of the boxes, 0 to 1.
    pub box_iou: f64,
    /// Overlap of the masks, 0 to 1.
    pub mask_iou: f64,
    /// F1, 0 to 1.
    pub f1: f64,
    /// First with the right class whose box overlaps enough.
    pub box_hit: bool,
    /// First with the right class whose mask overlaps enough.
    pub mask_hit: bool,
    /// First with the right class whose surface agrees enough.
    pub mesh_hit: bool,
}

/// Judges the detections of an image, surest first. Those that overlap no object enough to be looked at are left out.
///
/// # Errors
/// When masks differ in size, or a true surface has no area.
pub fn judge(truths: &[Truth], found: &[Found], rules: &Rules) -> Result<Vec<Judged>, ShapesError> {
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&a, &b| found[b].score.total_cmp(&found[a].score));
    let mut taken = vec![[false; 3]; truths.len()];
    let mut judged = Vec::new();
    for index in order {
        let one = &found[index];
        let overlaps = truths.iter().map(|truth| box_iou(truth.bbox, one.bbox));
        let Some((nearest, overlap)) = overlaps.enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) else { break };
        if overlap <= rules.filter_iou {
            continue;
        }
        let truth = &truths[nearest];
        let config = CompareConfig {
            samples: rules.samples,
            thresholds: vec![rules.f1_distance],
            seed: rules.seed.wrapping_add(index as u64),
            ..CompareConfig::default()
        };
        let f1 = compare(&one.surface, &truth.surface, &config)?.agreement[0].f1 / 100.0;
        let mask_iou = mask_iou(&truth.mask, &one.mask)?;
        let enough = [overlap > rules.iou, mask_iou > rules.iou, f1 > rules.f1];
        let mut hits = [false; 3];
        for ((hit, enough), taken) in hits.iter_mut().zip(enough).zip(&mut taken[nearest]) {
            *hit = enough && one.category == truth.category && !*taken;
            *taken |= *hit;
        }
        let [box_hit, mask_hit, mesh_hit] = hits;
        let (category, score) = (one.category, one.score);
        judged.push(Judged { category, score, truth: nearest, box_iou: overlap, mask_iou, f1, box_hit, mask_hit, mesh_hit });
    }
    Ok(judged)
}

/// Intersection over union of two boxes; 0 for boxes without area.
fn box_iou(a: [f64; 4], b: [f64; 4]) -> f64 {
    let area = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let both = area([a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])]);
    let union = area(a) + area(b) - both;
    if union > 0.0 { both / union } else { 0.0 }
}

fn mask_iou(a: &Mask, b: &Mask) -> Result<f64, ShapesError> {
    if [a.width, a.height, a.pixels.len()] != [b.width, b.height, b.pixels.len()] {
        let message = format!("a mask has {}x{} pixels, the true one {}x{}", b.width, b.height, a.width, a.height);
        return Err(ShapesError::Value(format!("{message}; expected the size of the image")));
    }
    let pairs = || a.pixels.iter().zip(&b.pixels);
    let (both, either) = (pairs().filter(|(a, b)| **a && **b).count(), pairs().filter(|(a, b)| **a || **b).count());
    Ok(if either > 0 { both as f64 / either as f64 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::tests::block;
    use enfilade_math::DVec3;

    fn mask(x: std::ops::Range<usize>) -> Mask {
        Mask { width: 20, height: 4, pixels: (0..80).map(|i| x.contains(&(i % 20))).collect() }
    }

    fn shape(height: f64) -> Surface {
        block(DVec3::ZERO, DVec3::new(1.0, height, 1.0))
    }

    fn truth(category: u32, x: std::ops::Range<usize>) -> Truth {
        Truth { category, bbox: [x.start as f64, 0.0, x.end as f64, 4.0], mask: mask(x), surface: shape(1.0) }
    }

    fn found(category: u32, score: f64, x: std::ops::Range<usize>, height: f64) -> Found {
        let Truth { bbox, mask, .. } = truth(category, x);
        Found { category, score, bbox, mask, surface: shape(height) }
    }

    fn hits(rows: &[Judged]) -> Vec<[bool; 3]> {
        rows.iter().map(|row| [row.box_hit, row.mask_hit, row.mesh_hit]).collect()
    }

    fn rules() -> Rules {
        Rules { samples: 3000, ..Rules::default() }
    }

    #[test]
    fn overlaps_are_those_of_paper_and_pencil() {
        assert_eq!(box_iou([0.0, 0.0, 2.0, 2.0], [1.0, 0.0, 3.0, 2.0]), 1.0 / 3.0);
        assert_eq!((box_iou([0.0; 4], [0.0; 4]), box_iou([0.0, 0.0, 1.0, 1.0], [2.0, 2.0, 3.0, 3.0])), (0.0, 0.0));
        assert_eq!(mask_iou(&mask(0..10), &mask(5..15)).unwrap(), 1.0 / 3.0);
        assert_eq!(mask_iou(&mask(0..0), &mask(0..0)).unwrap(), 0.0);
    }

    #[test]
    fn an_object_is_met_once_by_the_surest_of_the_right_class() {
        let rows = judge(&[truth(3, 0..10)], &[found(3, 0.4, 0..10, 1.0), found(3, 0.9, 0..10, 1.0), found(1, 0.95, 0..10, 1.0)], &rules());
        let rows = rows.unwrap();
        assert_eq!(rows.iter().map(|row| row.score).collect::<Vec<_>>(), [0.95, 0.9, 0.4]);
        assert_eq!(hits(&rows), [[false; 3], [true; 3], [false; 3]]);
    }

    #[test]
    fn box_mask_and_mesh_are_hit_each_by_itself() {
        // The surest has the wrong shape, the second overlaps by 0.43.
        let rows = judge(&[truth(3, 0..10)], &[found(3, 0.9, 0..10, 9.0), found(3, 0.8, 4..14, 1.0)], &Rules::default()).unwrap();
        assert_eq!(hits(&rows), [[true, true, false], [false, false, true]]);
        assert!((rows[1].box_iou - 6.0 / 14.0).abs() < 1e-12 && rows[0].f1 < 0.5 && rows[1].f1 > 0.9, "{rows:?}");
    }

    #[test]
    fn what_overlaps_too_little_is_not_judged() {
        assert_eq!(judge(&[truth(3, 0..10)], &[found(3, 0.9, 6..16, 1.0)], &rules()).unwrap(), []);
        assert_eq!(judge(&[], &[found(3, 0.9, 6..16, 1.0)], &rules()).unwrap(), []);
    }

    #[test]
    fn of_several_objects_each_is_met_by_its_own_detection() {
        let rows = judge(&[truth(3, 0..8), truth(3, 10..18)], &[found(3, 0.9, 10..18, 1.0), found(3, 0.8, 0..8, 1.0)], &rules()).unwrap();
        assert_eq!(rows.iter().map(|row| row.truth).collect::<Vec<_>>(), [1, 0]);
        assert_eq!(hits(&rows), [[true; 3], [true; 3]]);
    }
}
