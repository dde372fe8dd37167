//! The placement of the world on a page.

use super::cut::Cut;
use crate::drawing::Point;
use enfilade_math::DVec3;

/// A rectangle of the page that shows a cut at a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chart {
    /// The cut that is shown.
    pub cut: Cut,
    /// Left, top, width and height on the page, whole pixels.
    pub place: [u32; 4],
    /// Pixels per metre.
    pub scale: f64,
    /// The world point at the middle of the rectangle, on the plane.
    middle: DVec3,
}

impl Chart {
    /// The box from `min` to `max` (metres) at the largest scale that fits into `width` × `height_limit` pixels at (left, top). The
    /// rectangle is as wide as given and as high as needed, but at least `height_least`.
    pub fn fit(cut: Cut, (min, max): (DVec3, DVec3), [left, top]: [u32; 2], width: u32, [height_least, height_limit]: [u32; 2]) -> Self {
        let [right, up, toward] = cut.look.axes();
        // Axes may point against the world's: then the corners change places.
        let extent = |axis: DVec3| ((max - min).dot(axis)).abs().max(0.1);
        let scale = (f64::from(width) / extent(right)).min(f64::from(height_limit) / extent(up));
        let height = ((extent(up) * scale).ceil() as u32).clamp(height_least, height_limit);
        let center = 0.5 * (min + max);
        let middle = center + (cut.through - center).dot(toward) * toward;
        Self { cut, place: [left, top, width, height], scale, middle }
    }

    /// The point of the page at which a world point appears.
    pub fn to_page(self, p: DVec3) -> Point {
        let [right, up, _] = self.cut.look.axes();
        let [x, y] = self.page_middle();
        let q = p - self.middle;
        [(x + self.scale * q.dot(right)) as f32, (y - self.scale * q.dot(up)) as f32]
    }

    /// The point of the plane that appears at (x, y).
    pub fn to_world(self, [x, y]: [f64; 2]) -> DVec3 {
        let [right, up, _] = self.cut.look.axes();
        let [mx, my] = self.page_middle();
        self.middle + (x - mx) / self.scale * right - (y - my) / self.scale * up
    }

    /// True for page points within the rectangle.
    pub fn holds(&self, [x, y]: Point) -> bool {
        let [left, top, width, height] = self.place.map(|v| v as f32);
        (left..=left + width).contains(&x) && (top..=top + height).contains(&y)
    }

    fn page_middle(&self) -> [f64; 2] {
        let [left, top, width, height] = self.place.map(f64::from);
        [left + 0.5 * width, top + 0.5 * height]
    }
}

/// The round length (1, 2 or 5 times a power of ten) nearest below `limit`.
pub(super) fn round_below(limit: f64) -> f64 {
    let power = 10f64.powf(limit.max(f64::MIN_POSITIVE).log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|v| *v <= limit * (1.0 + 1e-9)).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::super::cut::Look;
    use super::*;

    const BOX: (DVec3, DVec3) = (DVec3::new(-1.0, 2.0, 0.0), DVec3::new(5.0, 5.0, 2.5));

    #[test]
    fn the_box_fills_the_chart_and_keeps_its_aspect() {
        let cut = Cut { look: Look::Down, through: DVec3::new(0.0, 0.0, 1.4) };
        let chart = Chart::fit(cut, BOX, [10, 20], 600, [100, 900]);
        assert_eq!((chart.scale, chart.place), (100.0, [10, 20, 600, 300]));
        assert_eq!(chart.to_page(DVec3::new(-1.0, 5.0, 9.0)), [10.0, 20.0], "upper left: smallest x, largest y");
        assert_eq!(chart.to_page(DVec3::new(5.0, 2.0, 0.0)), [610.0, 320.0]);
        let narrow = Chart::fit(cut, BOX, [0, 0], 600, [100, 150]);
        assert_eq!((narrow.scale, narrow.to_page(0.5 * (BOX.0 + BOX.1))), (50.0, [300.0, 75.0]));
    }

    #[test]
    fn page_and_world_are_inverse_on_the_plane() {
        for look in [Look::Down, Look::AlongY, Look::AgainstX] {
            let cut = Cut { look, through: DVec3::new(1.0, 3.0, 1.4) };
            let chart = Chart::fit(cut, BOX, [30, 40], 500, [100, 400]);
            for point in [[31.5, 77.0], [420.25, 101.0]] {
                let p = chart.to_world(point);
                assert!(cut.height_over(p).abs() < 1e-9);
                let [x, y] = chart.to_page(p).map(f64::from);
                assert!((x - point[0]).abs() < 1e-3 && (y - point[1]).abs() < 1e-3, "{look:?}: {x} {y}");
            }
            let [right, up, toward] = look.axes();
            let p = chart.to_world([100.0, 100.0]);
            let shifted = chart.to_page(p + right + 2.0 * up + 5.0 * toward).map(f64::from);
            assert!((shifted[0] - 100.0 - chart.scale).abs() < 1e-3 && (shifted[1] - 100.0 + 2.0 * chart.scale).abs() < 1e-3);
        }
    }

    #[test]
    fn round_lengths_are_one_two_or_five() {
        assert_eq!([0.7, 1.0, 1.9, 2.4, 7.0, 40.0].map(round_below), [0.5, 1.0, 1.0, 2.0, 5.0, 20.0]);
    }
}
