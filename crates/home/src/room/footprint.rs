//! Turned rectangles on the floor: what things cover, and what must stay free before them.

use enfilade_math::{DAffine3, Vec2, Vec3};

/// A turned rectangle on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// The middle of the rectangle.
    pub center: Vec2,
    /// Half its width and depth.
    pub half: Vec2,
    /// Turn about the vertical, radians.
    pub yaw: f32,
}

impl Footprint {
    fn axes(&self) -> [Vec2; 2] {
        let x = Vec2::from_angle(self.yaw);
        [x, x.perp()]
    }

    /// The four corners of the rectangle.
    pub fn corners(&self) -> [Vec2; 4] {
        let [x, y] = self.axes();
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[sx, sy]| self.center + x * self.half.x * sx + y * self.half.y * sy)
    }

    /// True when both come closer than `clearance` (by separating axes; corners count as sharp).
    pub fn meets(&self, other: &Self, clearance: f32) -> bool {
        let gap = |axis: Vec2| {
            let span = |f: &Self| {
                let reach = f.axes()[0].dot(axis).abs() * f.half.x + f.axes()[1].dot(axis).abs() * f.half.y;
                (f.center.dot(axis) - reach, f.center.dot(axis) + reach)
            };
            let ((a0, a1), (b0, b1)) = (span(self), span(other));
            (b0 - a1).max(a0 - b1)
        };
        self.axes().into_iter().chain(other.axes()).all(|axis| gap(axis) < clearance)
    }

    /// Distance from `p` to the rectangle; 0 inside.
    pub fn distance(&self, p: Vec2) -> f32 {
        let [x, y] = self.axes();
        let d = p - self.center;
        (Vec2::new(d.dot(x), d.dot(y)).abs() - self.half).max(Vec2::ZERO).length()
    }

    /// The rectangle of a thing of `size` in `pose`.
    pub fn of(pose: DAffine3, size: Vec3) -> Self {
        let x = pose.matrix3.x_axis;
        let center = pose.translation.as_vec3().truncate();
        Self { center, half: 0.5 * size.truncate(), yaw: (x.y.atan2(x.x)) as f32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn footprints_meet_when_closer_than_the_clearance() {
        let a = Footprint { center: Vec2::ZERO, half: Vec2::splat(0.5), yaw: 0.0 };
        let beside = Footprint { center: Vec2::new(1.3, 0.0), ..a };
        assert!(!a.meets(&beside, 0.25) && a.meets(&beside, 0.35));
        // A square on its corner reaches √2 as far, but not sideways past a neighbour's corner.
        let diamond = Footprint { center: Vec2::new(1.15, 0.0), yaw: std::f32::consts::FRAC_PI_4, ..a };
        assert!(a.meets(&diamond, 0.0));
        let diagonal = Footprint { center: Vec2::new(0.9, 0.9), yaw: std::f32::consts::FRAC_PI_4, ..a };
        assert!(!a.meets(&diagonal, 0.0));
    }
}
