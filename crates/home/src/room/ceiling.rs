//! The ceiling of a room under a roof: level, but where planes that rise from outer walls are lower.
//!
//! The height is the least of linear functions, so over a rectangle it is least at a corner.

use super::kind::{self, Ceiling};
use super::{Footprint, Incline, Room, Wall};
use enfilade_math::{DAffine3, DQuat, DVec3, Vec2};
use enfilade_scene::Slope;

/// Slopes that are nowhere lower than the level ceiling by more than this do not count, metres.
const CUTS: f32 = 0.02;
/// Step of the grid on which places are sought, metres.
const GRID: f32 = 0.1;
/// Half the side of the part of the ceiling that a lamp needs, and its distance from walls, metres.
const LAMP: [f32; 2] = [0.3, 0.35];
/// Lamps that would hang closer to each other than this are one, metres.
const APART: f32 = 1.2;

/// Depth by which the grid of a suspended ceiling is below its tiles, metres.
pub const GRID_BELOW: f32 = 0.004;

impl Room {
    /// Whether tiles in a grid are the ceiling. The lines of the grid run through the middle of the box around the room.
    pub fn has_grid(&self) -> bool {
        self.slopes.is_empty() && kind::row(self.kind).shell.ceiling == Ceiling::Grid
    }

    /// Puts the room under these planes; those that are above its ceiling everywhere do not count.
    pub fn put_under(&mut self, slopes: impl Iterator<Item = Slope>) {
        let level = self.size.z;
        let cuts = |incline: &Incline| self.outline.edges().any(|[corner, _]| incline.z(corner) < level - CUTS);
        self.slopes = slopes.map(Incline::new).filter(cuts).collect();
    }

    /// Height of the ceiling over a point.
    pub fn ceiling_at(&self, p: Vec2) -> f32 {
        self.slopes.iter().map(|slope| slope.z(p)).fold(self.size.z, f32::min)
    }

    /// The least height of the ceiling over a rectangle.
    pub fn lowest_over(&self, rectangle: &Footprint) -> f32 {
        rectangle.corners().into_iter().map(|corner| self.ceiling_at(corner)).fold(self.size.z, f32::min)
    }

    /// The least height of the ceiling before a piece of wall, between two distances from it; negative ones are in the wall.
    pub fn lowest_before(&self, wall: Wall, x: [f32; 2], out: [f32; 2]) -> f32 {
        let corners = out.into_iter().flat_map(|out| x.map(|x| self.before(wall, x, out)));
        corners.map(|corner| self.ceiling_at(corner)).fold(self.size.z, f32::min)
    }

    /// Spans along a wall in which the ceiling is lower than `height` somewhere between two distances from it.
    pub fn low_spans(&self, wall: Wall, out: [f32; 2], height: f32) -> Vec<[f32; 2]> {
        let half = 0.5 * self.length(wall);
        let span = |slope: &Incline, out: f32| {
            let [low, high] = [-half, half].map(|x| slope.z(self.before(wall, x, out)) - height);
            let x = half * (high + low) / (low - high);
            match (low < 0.0, high < 0.0) {
                (false, false) => None,
                (true, true) => Some([-half, half]),
                (true, false) => Some([-half, x]),
                (false, true) => Some([x, half]),
            }
        };
        self.slopes.iter().flat_map(|slope| out.into_iter().filter_map(move |out| span(slope, out))).collect()
    }

    /// Where the ceiling bends along a line at this distance before a wall, along the wall's x axis.
    pub fn bends(&self, wall: Wall, out: f32) -> Vec<f32> {
        let half = 0.5 * self.length(wall).max(1e-3);
        let line = |slope: &Incline| [-half, half].map(|x| slope.z(self.before(wall, x, out)));
        let lines: Vec<[f32; 2]> = self.slopes.iter().map(line).chain([[self.size.z; 2]]).collect();
        let pairs = (0..lines.len()).flat_map(|i| (i + 1..lines.len()).map(move |k| (i, k)));
        let meet = pairs.filter_map(|(i, k)| {
            let [low, high] = [lines[i][0] - lines[k][0], lines[i][1] - lines[k][1]];
            let x = half * (high + low) / (low - high);
            let lowest = self.ceiling_at(self.before(wall, x, out));
            let z = 0.5 * (lines[i][0] + lines[i][1]) + 0.5 * (lines[i][1] - lines[i][0]) * x / half;
            ((low - high).abs() > 1e-4 && (z - lowest).abs() < 1e-3).then_some(x)
        });
        meet.collect()
    }

    /// Whether people can stand upright within `around` metres of a point.
    pub fn has_headroom(&self, p: Vec2, around: f32, height: f32) -> bool {
        self.slopes.iter().all(|slope| slope.z(p) - around * slope.rise() >= height)
    }

    /// Share of the floor over which the ceiling is at least this high.
    pub fn share_above(&self, height: f32) -> f32 {
        let all: Vec<Vec2> = self.grid().filter(|p| self.outline.contains(*p)).collect();
        let high = all.iter().filter(|p| self.ceiling_at(**p) >= height).count();
        high as f32 / all.len().max(1) as f32
    }

    fn grid(&self) -> impl Iterator<Item = Vec2> {
        let [low, high] = self.outline.bounds();
        let count = ((high - low) / GRID).ceil();
        (0..=count.y as usize).flat_map(move |j| (0..=count.x as usize).map(move |i| low + GRID * Vec2::new(i as f32, j as f32)))
    }

    /// The places nearest to `points` where the ceiling is level enough for a lamp, each once; the points themselves without slopes.
    pub fn level_places(&self, points: &[Vec2]) -> Vec<Vec2> {
        if self.slopes.is_empty() {
            return points.to_vec();
        }
        let around = |center: Vec2| Footprint { center, half: Vec2::splat(LAMP[0]), yaw: 0.0 };
        let is_level = |p: &Vec2| self.lowest_over(&around(*p)) >= self.size.z;
        let all: Vec<Vec2> = self.grid().filter(|p| is_level(p) && self.contains(*p, -LAMP[1])).collect();
        let mut found: Vec<Vec2> = Vec::new();
        for point in points {
            let own = Some(*point).filter(|p| is_level(p));
            let nearest = own.or_else(|| all.iter().copied().min_by(|a, b| a.distance(*point).total_cmp(&b.distance(*point))));
            found.extend(nearest.filter(|p| found.iter().all(|other| other.distance(*p) > APART)));
        }
        found
    }

    /// Where something is fixed to the ceiling near a point: where it is level, or else where it slopes and is highest.
    pub fn mounting(&self, near: Vec2) -> DAffine3 {
        let level = |p: Vec2| enfilade_furniture::pose(f64::from(p.x), f64::from(p.y), f64::from(self.size.z), 0.0);
        if let Some(p) = self.level_places(&[near]).first() {
            return level(*p);
        }
        let place = |slope: &Incline| {
            let is_there = |p: &Vec2| {
                let corners = Footprint { center: *p, half: Vec2::splat(LAMP[0]), yaw: 0.0 }.corners();
                self.contains(*p, -LAMP[1]) && corners.iter().all(|c| (slope.z(*c) - self.ceiling_at(*c)).abs() < 1e-4)
            };
            let best = self.grid().filter(is_there).max_by(|a, b| slope.z(*a).total_cmp(&slope.z(*b)));
            best.map(|p| (slope.z(p), p, -slope.slope.normal()))
        };
        let best = self.slopes.iter().filter_map(place).reduce(|a, b| if b.0 > a.0 + 1e-4 { b } else { a });
        best.map_or_else(
            || level(near),
            |(z, p, up)| {
                let turn = DQuat::from_rotation_arc(DVec3::Z, up);
                DAffine3::from_rotation_translation(turn, p.extend(z).as_dvec3())
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::RoomKind;
    use enfilade_math::Vec3;

    /// 4 × 5 metres around the origin, 2.5 m high, under 45° from a knee wall of 1.5 m in the south.
    fn attic() -> Room {
        let mut room = Room::rectangle(RoomKind::Bedroom, Vec2::ZERO, Vec3::new(4.0, 5.0, 2.5), [true; 4], [0.12, 0.36]);
        let slope = |from, to| Slope { from, to, low_z_m: 1.5, pitch_deg: 45.0 };
        // The second one is above the ceiling everywhere.
        room.put_under([slope([-2.0, -2.5], [2.0, -2.5]), slope([2.0, 9.0], [-2.0, 9.0])].into_iter());
        room
    }

    #[test]
    fn heights_follow_the_plane_up_to_the_ceiling() {
        let room = attic();
        assert_eq!(room.slopes.len(), 1);
        for (y, z) in [(-2.5, 1.5), (-2.0, 2.0), (-1.0, 2.5), (2.0, 2.5)] {
            assert!((room.ceiling_at(Vec2::new(0.3, y)) - z).abs() < 1e-5, "{y}");
        }
        assert!((room.lowest_before(Wall(0), [-0.5, 0.5], [0.2, 0.6]) - 1.7).abs() < 1e-5);
        // The gable in the east: its x axis runs northwards.
        let close = |found: &[f32], expected: f32| found.len() == 1 && (found[0] - expected).abs() < 1e-4;
        assert!(close(&room.bends(Wall(1), 0.0), -1.5), "{:?}", room.bends(Wall(1), 0.0));
        let low = room.low_spans(Wall(1), [0.0, 0.0], 2.1);
        assert!(low.iter().all(|[a, b]| (a + 2.5).abs() < 1e-4 && (b + 1.9).abs() < 1e-4) && low.len() == 2, "{low:?}");
        assert_eq!(room.low_spans(Wall(2), [0.0, 0.5], 2.4), Vec::<[f32; 2]>::new());
        assert!((room.share_above(2.0) - 0.9).abs() < 0.03, "{}", room.share_above(2.0));
    }

    #[test]
    fn lamps_hang_where_the_ceiling_is_level_or_on_the_slope() {
        let mut room = attic();
        assert_eq!(room.level_places(&[Vec2::ZERO]), [Vec2::ZERO]);
        let found = room.level_places(&[Vec2::new(0.0, -1.6)]);
        assert!(found.len() == 1 && (-1.2..-1.0).contains(&(found[0].y - 0.3)) || found[0].y > -1.2, "{found:?}");
        // All of it slopes: from 1.5 m in the south to 2.4 m in the north.
        room.put_under([Slope { from: [-2.0, -2.5], to: [2.0, -2.5], low_z_m: 1.5, pitch_deg: 10.2 }].into_iter());
        assert_eq!(room.level_places(&[Vec2::ZERO]), Vec::<Vec2>::new());
        let mounted = room.mounting(Vec2::ZERO);
        let at = mounted.translation.as_vec3();
        assert!((at.z - room.ceiling_at(at.truncate())).abs() < 1e-4 && at.z > 2.2, "{at}");
        assert!((mounted.transform_vector3(DVec3::Z) + room.slopes[0].slope.normal()).length() < 1e-9);
    }
}
