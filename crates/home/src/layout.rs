//! Where things go: a floor plan that only accepts what fits.

use crate::builder::pose;
use crate::furniture::CONTACT;
use crate::room::{Room, Wall};
use enfilade_math::{DAffine3, Vec2, Vec3};

/// A turned rectangle on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Its middle.
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

    /// Its four corners.
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
}

/// The floor plan of one room, seen from the sofa: u runs from the sofa's wall into the room, v towards the window's wall; the
/// middle of the room is (0, 0).
#[derive(Clone, Debug)]
pub struct Plan {
    /// The room.
    pub room: Room,
    /// The wall behind the sofa.
    pub sofa_wall: Wall,
    taken: Vec<Footprint>,
}

/// What stands along walls keeps this distance, because of the skirting.
pub const WALL_GAP: f32 = 0.02;

impl Plan {
    /// An empty room.
    pub fn new(room: Room, sofa_wall: Wall) -> Self {
        Self { room, sofa_wall, taken: Vec::new() }
    }

    /// Half the room's extent along u and v.
    pub fn half(&self) -> Vec2 {
        0.5 * Vec2::new(self.room.length(self.room.window.wall), self.room.length(self.sofa_wall))
    }

    /// World direction of a (u, v) direction.
    pub fn direction(&self, uv: Vec2) -> Vec2 {
        self.sofa_wall.inward() * uv.x - self.room.window.wall.inward() * uv.y
    }

    /// Yaw of something whose front looks along (u, v).
    pub fn facing(&self, uv: Vec2) -> f32 {
        let d = self.direction(uv);
        d.y.atan2(d.x) - std::f32::consts::FRAC_PI_2
    }

    /// Place along `wall` of the point (u, v).
    pub fn along(&self, wall: Wall, uv: Vec2) -> f32 {
        self.direction(uv).dot(wall.along())
    }

    /// Pose on `wall` at `height`, beside the point (u, v), for what hangs there.
    pub fn hang(&self, wall: Wall, uv: Vec2, height: f32) -> DAffine3 {
        crate::furniture::on(self.room.wall_pose(wall), Vec3::new(self.along(wall, uv), 0.0, height), 0.0)
    }

    /// Stands something of `size` with its back to `wall` beside the point (u, v), if it fits.
    pub fn against(&mut self, wall: Wall, uv: Vec2, size: Vec3, clearance: f32) -> Option<DAffine3> {
        let n = wall.inward();
        let to_wall = 0.5 * self.room.size.truncate().dot(n.abs());
        let center = wall.along() * self.along(wall, uv) + n * (WALL_GAP + 0.5 * size.y - to_wall);
        self.place(Footprint { center, half: 0.5 * size.truncate(), yaw: wall.yaw() as f32 }, clearance)
    }

    /// Stands something of `size` at (u, v) with its front along `front`, if it fits.
    pub fn free(&mut self, uv: Vec2, front: Vec2, size: Vec3, clearance: f32) -> Option<DAffine3> {
        let footprint = Footprint { center: self.direction(uv), half: 0.5 * size.truncate(), yaw: self.facing(front) };
        self.place(footprint, clearance)
    }

    /// As [`Plan::free`] for a chair at a table, which may stand partly under it.
    pub fn seat(&mut self, uv: Vec2, front: Vec2, size: Vec3) -> Option<DAffine3> {
        let table = self.taken.pop();
        let found = self.free(uv, front, size, 0.04);
        let chair = if found.is_some() { self.taken.pop() } else { None };
        // The table stays last, for the next chair.
        self.taken.extend(chair);
        self.taken.extend(table);
        found
    }

    /// Keeps a rectangle between two (u, v) corners free of furniture.
    pub fn keep_clear(&mut self, from: Vec2, to: Vec2) {
        let center = self.direction(0.5 * (from + to));
        let half = self.direction(0.5 * (to - from)).abs();
        self.taken.push(Footprint { center, half, yaw: 0.0 });
    }

    /// Pose at (u, v) with the front along `front`, for what lies under or hangs over other things.
    pub fn pose(&self, uv: Vec2, front: Vec2, height: f32) -> DAffine3 {
        let p = self.direction(uv);
        pose(f64::from(p.x), f64::from(p.y), f64::from(height), f64::from(self.facing(front)))
    }

    fn place(&mut self, footprint: Footprint, clearance: f32) -> Option<DAffine3> {
        let half = 0.5 * self.room.size.truncate() - 0.9 * WALL_GAP;
        let inside = footprint.corners().iter().all(|c| c.abs().cmple(half).all());
        if !inside || self.taken.iter().any(|t| t.meets(&footprint, clearance)) {
            return None;
        }
        self.taken.push(footprint);
        Some(pose(f64::from(footprint.center.x), f64::from(footprint.center.y), f64::from(CONTACT), f64::from(footprint.yaw)))
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
