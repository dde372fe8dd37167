//! Whether a surface point can be seen in a frame, as far as the frame's stored distances can decide.

use enfilade_math::DVec3;
use enfilade_scene::CameraView;

/// A surface is before a point when it is nearer than this share of the point's distance: as far as a ray is followed to the point.
const BEFORE: f64 = 0.999;
/// Distances alone do not show how a surface runs between pixels: a point is clearly hidden only if the farthest pixel around it is nearer
/// than this share of its distance.
const SEEN: f64 = 0.99;

/// A frame whose distances are known.
pub(crate) struct Surroundings<'a> {
    view: CameraView<'a>,
    distances_m: Vec<f32>,
}

/// What the pixels around the image of a point show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Around {
    /// The point has no image, or it is outside.
    Outside,
    /// None of the pixels around shows anything before the point.
    Free,
    /// At least one pixel around shows something before the point; `all`: every one does, clearly.
    Before { all: bool },
}

impl<'a> Surroundings<'a> {
    /// The surroundings of points in a frame with one distance in metres per pixel of the view, NaN where nothing was hit.
    pub fn new(view: CameraView<'a>, distances_m: Vec<f32>) -> Self {
        Self { view, distances_m }
    }

    /// The frame's view.
    pub fn view(&self) -> &CameraView<'a> {
        &self.view
    }

    /// What the four pixels whose centres are around the image of a world point show; at the border, the existing ones.
    pub fn around(&self, p_world: DVec3) -> Around {
        let [width, height] = self.view.camera().size();
        let Some((x, y)) = self.view.project(p_world) else { return Around::Outside };
        if !(0.0..f64::from(width)).contains(&x) || !(0.0..f64::from(height)).contains(&y) {
            return Around::Outside;
        }
        let distance = self.view.row_placement(y).0.distance(p_world);
        // The pixel whose centre is at the upper left, and the one at the lower right.
        let both = |at: f64, side: u32| [(at - 0.5).floor().max(0.0) as u32, ((at + 0.5).floor() as u32).min(side - 1)];
        let (columns, rows) = (both(x, width), both(y, height));
        let (mut near, mut far) = (f64::INFINITY, 0.0f64);
        for row in rows {
            for column in columns {
                let stored = f64::from(self.distances_m[(row * width + column) as usize]);
                let stored = if stored.is_nan() { f64::INFINITY } else { stored };
                (near, far) = (near.min(stored), far.max(stored));
            }
        }
        if near >= BEFORE * distance { Around::Free } else { Around::Before { all: far < SEEN * distance } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Camera, Intrinsics, Pose};

    #[test]
    fn a_point_is_free_behind_others_or_between_them() {
        // Two by two pixels of 90 degrees that look along y: centres at x = ±0.5 of depth.
        let camera = Camera::from(Intrinsics { width: 2, height: 2, fx: 1.0, fy: 1.0, cx: 1.0, cy: 1.0, skew: 0.0 });
        let pose = Pose::look_at(0, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
        let around = |distances_m: [f32; 4], y: f64| {
            Surroundings::new(CameraView::still(&camera, &pose), distances_m.into()).around(DVec3::new(0.1, y, 0.1))
        };
        assert_eq!(around([2.0; 4], 1.9), Around::Free);
        assert_eq!(around([2.0, 2.0, 2.0, f32::NAN], 1.9), Around::Free);
        assert_eq!(around([2.0, 2.0, 1.0, 2.0], 1.9), Around::Before { all: false });
        assert_eq!(around([f32::NAN, 1.0, 1.0, 1.0], 1.9), Around::Before { all: false });
        assert_eq!(around([1.0; 4], 1.9), Around::Before { all: true });
        assert_eq!(around([2.0; 4], -1.0), Around::Outside);
        let beside = Surroundings::new(CameraView::still(&camera, &pose), vec![9.0; 4]).around(DVec3::new(1.1, 1.0, 0.0));
        assert_eq!(beside, Around::Outside);
        // Within half a pixel of the border there are fewer.
        let at_border = Surroundings::new(CameraView::still(&camera, &pose), vec![9.0, 0.5, 9.0, 0.5]);
        assert_eq!(at_border.around(DVec3::new(-0.9, 1.0, -0.9)), Around::Free);
        assert_eq!(at_border.around(DVec3::new(0.9, 1.0, -0.9)), Around::Before { all: true });
    }
}
