//! Where bodies meet: below, above, beside. Rays start a little inside of one body and look for the other.

use crate::body::Body;
use enfilade_dataset::RelationKind;
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::CEILING;

/// Things sink so far into what is hard under them, metres: feet into a rug's pile.
const SINK_M: f32 = 0.005;
/// How far things sink into what is soft, such as cushions, metres.
const SOFT_SINK_M: f32 = 0.03;
/// A gap up to which things touch, metres.
const TOUCH_M: f32 = 0.005;
/// A gap up to which soft things touch, metres: they lie in waves.
const SOFT_TOUCH_M: f32 = 0.02;
/// The lowest and the highest of a thing, as far as what carries it is concerned, metres.
const ENDS_M: f32 = 0.01;
/// A gap up to which people say that something stands against a wall, metres.
pub const AGAINST_M: f32 = 0.1;
/// Rows of rays from each side of a box, and rays in each row.
const GRID: usize = 5;
/// Share of a box at each border that the rays leave out: corners are rounded, and backs are bent.
const MARGIN: f64 = 0.1;

/// From a point along a unit direction.
type Ray = (Vec3, Vec3);

/// The gap to the other body of those rays that find it, and what share of all they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Meeting {
    /// On [0, 1].
    pub share: f64,
    /// The least gap, metres; 0 where one sinks into the other.
    pub gap_m: f64,
}

/// Rays of `a` along `direction`, from `sink` metres behind their origins to `reach` before them, that find `b`.
fn meet(b: &Body, rays: &[Ray], sink: f32, reach: f32) -> Option<Meeting> {
    let hit = |&(p, direction): &Ray| b.hit(p - direction * sink, direction, [0.0, sink + reach]).map(|t| t - sink);
    let gaps: Vec<f32> = rays.iter().filter_map(hit).collect();
    let gap = gaps.iter().copied().reduce(f32::min)?;
    Some(Meeting { share: gaps.len() as f64 / rays.len() as f64, gap_m: f64::from(gap.max(0.0)) })
}

/// A way in which a thing may be supported, and the bodies that it meets.
pub struct Attempt {
    /// Kind of support: on it, or hanging from it.
    pub kind: RelationKind,
    /// Bodies that meet the thing so, by their place in the list.
    pub met: Vec<(usize, Meeting)>,
}

/// The ways in which a body meets those that may support it, the most conclusive first: under its lowest points, over its highest, sinking
/// in, under any part of it that faces down (as with cloth over things), at its sides, and above or beside it by some centimetres.
pub fn attempts(a: &Body, others: &[(usize, &Body)]) -> Vec<Attempt> {
    let along = |points: Vec<Vec3>, direction: Vec3| points.into_iter().map(|p| (p, direction)).collect::<Vec<_>>();
    let feet = along(a.ends(false, ENDS_M), Vec3::NEG_Z);
    let tops = along(a.ends(true, ENDS_M), Vec3::Z);
    let looking_down: Vec<Ray> = a.points.iter().filter(|(_, normal)| normal.z < -0.5).map(|(p, _)| (*p, Vec3::NEG_Z)).collect();
    let sides: Vec<Ray> = a.points.iter().filter(|(_, normal)| normal.z.abs() < 0.5).copied().collect();
    let (near, soft) = ([SINK_M, TOUCH_M], [SOFT_SINK_M, SOFT_TOUCH_M]);
    let (on, hangs) = (RelationKind::On, RelationKind::HangsFrom);
    let ways: [(RelationKind, &[Ray], [f32; 2]); 7] = [
        (on, &feet, near),
        (hangs, &tops, near),
        (on, &feet, soft),
        (on, &looking_down, near),
        (hangs, &sides, near),
        (hangs, &tops, soft),
        (hangs, &sides, soft),
    ];
    let attempt = |(kind, rays, [sink, reach]): (RelationKind, &[Ray], [f32; 2])| {
        // Nothing stands on a ceiling.
        let others = others.iter().filter(|(_, b)| kind != on || b.class != CEILING);
        Attempt { kind, met: others.filter_map(|&(i, b)| Some((i, meet(b, rays, sink, reach)?))).collect() }
    };
    ways.into_iter().map(attempt).filter(|attempt| !attempt.met.is_empty()).collect()
}

/// How the side of a body's box in a horizontal direction of its own (`axis` 0 or 1, `sign` ±1) meets another body.
pub fn beside(a: &Body, b: &Body, axis: usize, sign: f64) -> Option<Meeting> {
    let out = a.upright.world_from_box.col(axis) * sign;
    let across = [a.upright.world_from_box.col(1 - axis), DVec3::Z];
    let middle = a.center() + out * 0.5 * a.upright.extents[axis];
    let lengths = [a.upright.extents[1 - axis], a.upright.extents.z];
    meet(b, &grid(middle, across, lengths, out), SINK_M, AGAINST_M)
}

/// How much of the upper side of a body's box has another above it, within `reach_m`.
pub fn above(a: &Body, b: &Body, reach_m: f32) -> Option<Meeting> {
    let across = [0, 1].map(|axis| a.upright.world_from_box.col(axis));
    let middle = a.center() + DVec3::Z * 0.5 * a.upright.extents.z;
    meet(b, &grid(middle, across, [a.upright.extents.x, a.upright.extents.y], DVec3::Z), 0.0, reach_m)
}

/// Rays from a side of a box.
fn grid(middle: DVec3, across: [DVec3; 2], lengths: [f64; 2], out: DVec3) -> Vec<Ray> {
    let at = |i: usize| (1.0 - 2.0 * MARGIN) * (i as f64 / (GRID - 1) as f64 - 0.5);
    let point = |k: usize| middle + across[0] * (lengths[0] * at(k % GRID)) + across[1] * (lengths[1] * at(k / GRID));
    (0..GRID * GRID).map(|k| (point(k).as_vec3(), out.as_vec3())).collect()
}

/// Number of the six ways from the middle of a body, along the axes of another's box, on which the other is met, and whether down is one.
pub fn enclosed(a: &Body, b: &Body) -> (usize, bool) {
    let middle = a.center().as_vec3();
    let reach = b.bounds.extent().length();
    let ways = [0, 1, 2].map(|axis| b.upright.world_from_box.col(axis).as_vec3());
    let meets = |direction: Vec3| b.hit(middle, direction, [0.0, reach]).is_some();
    let down = meets(Vec3::NEG_Z);
    let others = [ways[0], -ways[0], ways[1], -ways[1], Vec3::Z];
    (others.into_iter().filter(|&way| meets(way)).count() + usize::from(down), down)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_rooms::{body, box_corners, boxed};

    /// The most conclusive support of a body.
    fn carried(a: &Body, others: &[(usize, &Body)]) -> Option<(RelationKind, Vec<(usize, Meeting)>)> {
        attempts(a, others).into_iter().next().map(|attempt| (attempt.kind, attempt.met))
    }

    #[test]
    fn feet_touch_sink_or_float() {
        let floor = boxed(-1, 2, DVec3::new(-5.0, -5.0, -0.1), DVec3::new(5.0, 5.0, 0.0));
        let found = |z: f64| carried(&boxed(1, 7, DVec3::Z * z, DVec3::new(1.0, 1.0, z + 1.0)), &[(7, &floor)]);
        assert_eq!(found(0.0), Some((RelationKind::On, vec![(7, Meeting { share: 1.0, gap_m: 0.0 })])));
        assert!((found(0.004).unwrap().1[0].1.gap_m - 0.004).abs() < 1e-6);
        assert_eq!((found(-0.02).unwrap().1[0].1.gap_m, found(0.03)), (0.0, None));
    }

    #[test]
    fn what_is_flat_lies_on_the_table_and_not_on_what_lies_on_it() {
        let table = boxed(1, 7, DVec3::ZERO, DVec3::new(1.0, 1.0, 0.7));
        let plate = boxed(2, 40, DVec3::new(0.2, 0.2, 0.7), DVec3::new(0.4, 0.4, 0.71));
        let toast = boxed(3, 40, DVec3::new(0.25, 0.25, 0.71), DVec3::new(0.35, 0.35, 0.725));
        let under = |a: &Body, others: &[(usize, &Body)]| carried(a, others).unwrap().1.into_iter().map(|(i, _)| i).collect::<Vec<_>>();
        assert_eq!(under(&plate, &[(1, &table), (3, &toast)]), [1]);
        assert_eq!(under(&toast, &[(1, &table), (2, &plate)]), [2]);
    }

    #[test]
    fn lamps_hang_from_ceilings_and_pictures_from_walls() {
        let ceiling = boxed(-1, CEILING, DVec3::new(-5.0, -5.0, 2.5), DVec3::new(5.0, 5.0, 2.6));
        let wall = boxed(-1, 1, DVec3::new(-5.0, 2.0, 0.0), DVec3::new(5.0, 2.2, 2.5));
        let lamp = boxed(1, 35, DVec3::new(0.0, 0.0, 2.48), DVec3::new(0.3, 0.3, 2.5));
        let picture = boxed(2, 11, DVec3::new(0.0, 1.97, 1.0), DVec3::new(0.6, 1.998, 1.5));
        let others: [(usize, &Body); 2] = [(0, &ceiling), (1, &wall)];
        let from = |a: &Body| carried(a, &others).map(|(kind, met)| (kind, met[0].0));
        assert_eq!((from(&lamp), from(&picture)), (Some((RelationKind::HangsFrom, 0)), Some((RelationKind::HangsFrom, 1))));
    }

    #[test]
    fn a_sofa_near_a_wall_stands_against_it() {
        let wall = boxed(-1, 1, DVec3::new(-5.0, 2.0, 0.0), DVec3::new(5.0, 2.2, 2.5));
        let sofa = boxed(1, 6, DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, 1.93, 0.8));
        let sides: Vec<f64> = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)]
            .iter()
            .filter_map(|&(axis, sign)| beside(&sofa, &wall, axis, sign))
            .map(|m| m.gap_m)
            .collect();
        assert!(sides.len() == 1 && (sides[0] - 0.07).abs() < 1e-5, "{sides:?}");
    }

    #[test]
    fn a_rug_is_under_a_table_and_fruit_in_a_bowl() {
        let top = boxed(1, 7, DVec3::new(0.0, 0.0, 0.7), DVec3::new(1.0, 1.0, 0.75));
        let rug = boxed(2, 20, DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.9, 0.9, 0.01));
        assert_eq!(above(&rug, &top, 2.0).unwrap().share, 1.0);
        assert!(above(&top, &rug, 2.0).is_none());
        let (low, high) = (DVec3::ZERO, DVec3::new(0.3, 0.3, 0.1));
        let mut bowl = box_corners(low, high);
        bowl.retain(|t| !t.iter().all(|p| p.z == 0.1));
        let apple = boxed(3, 40, DVec3::new(0.1, 0.1, 0.01), DVec3::new(0.2, 0.2, 0.08));
        assert_eq!(enclosed(&apple, &body(4, 40, bowl)), (5, true));
    }
}
