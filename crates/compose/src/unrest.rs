//! How much things move that are left to themselves.

use crate::solid::{Moments, Solid};
use crate::world::World;
use enfilade_math::DVec3;
use rapier3d_f64::math::Pose3;
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d_f64::parry::query;
use rapier3d_f64::parry::shape::SharedShape;

/// What is fixed and farther from every thing than this plays no part in the simulation, metres.
const NEAR_M: f64 = 0.1;

/// How a thing has moved, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// The way of the corner that moved most.
    pub farthest_m: f64,
    /// The way of the middle of the corners.
    pub middle_m: DVec3,
}

/// A thing of convex solids.
#[derive(Clone, Debug, Default)]
pub struct Thing {
    /// The shape.
    pub solids: Vec<Solid>,
    /// How its mass is distributed; as that of wood unless given.
    pub moments: Option<Moments>,
}

/// How things move that are simulated for some time, all at once and with nothing asleep, beside what does not move.
pub fn unrest(fixed: &[Solid], things: &[Thing], seconds: f64) -> Vec<Way> {
    let around = |solids: &[Solid]| {
        let corners = solids.iter().flat_map(|solid| &solid.corners);
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
    };
    let bounds: Vec<(DVec3, DVec3)> = things.iter().map(|thing| around(&thing.solids)).collect();
    let near = |solid: &&Solid| {
        let (low, high) = around(std::slice::from_ref(*solid));
        bounds.iter().any(|(least, most)| low.cmple(*most + NEAR_M).all() && high.cmpge(*least - NEAR_M).all())
    };
    let mut world = World::beside(fixed.iter().filter(near).filter_map(Solid::shape));
    for thing in things {
        let parts = thing.solids.iter().filter_map(|solid| Some((Pose3::IDENTITY, solid.shape()?)));
        world.add_weighed(SharedShape::compound(parts.collect()), Pose3::IDENTITY, thing.moments);
    }
    world.run(seconds);
    let way = |(number, thing): (usize, &Thing)| {
        let after = world.placement(number);
        let corners = || thing.solids.iter().flat_map(|solid| &solid.corners);
        let ways = || corners().map(|corner| after.transform_point3(*corner) - *corner);
        let middle_m = ways().sum::<DVec3>() / corners().count().max(1) as f64;
        Way { farthest_m: ways().map(DVec3::length).fold(0.0, f64::max), middle_m }
    };
    things.iter().enumerate().map(way).collect()
}

/// Pairs of things, the first one lower, that are nearer to each other than this, metres; below 0, deeper in each other.
pub fn overlaps(things: &[Vec<Solid>], within_m: f64) -> Vec<[usize; 2]> {
    let shaped = |solid: &Solid| solid.shape().map(|shape| (shape.compute_local_aabb().loosened(within_m.max(0.0)), shape));
    let shapes: Vec<Vec<(Aabb, SharedShape)>> = things.iter().map(|thing| thing.iter().filter_map(shaped).collect()).collect();
    let around = |of: &Vec<(Aabb, SharedShape)>| of.iter().map(|(bounds, _)| *bounds).reduce(|all, one| all.merged(&one));
    let bounds: Vec<Option<Aabb>> = shapes.iter().map(around).collect();
    let meet = |a: &SharedShape, b: &SharedShape| {
        let contact = query::contact(&Pose3::IDENTITY, &**a, &Pose3::IDENTITY, &**b, within_m.max(0.0));
        contact.ok().flatten().is_some_and(|contact| contact.dist < within_m)
    };
    let pair = |a: usize, b: usize| {
        let (Some(first), Some(second)) = (bounds[a], bounds[b]) else { return false };
        let near = |of: usize, other: Aabb| shapes[of].iter().filter(move |(bounds, _)| bounds.intersects(&other));
        first.intersects(&second) && near(a, second).any(|(one, a)| near(b, first).any(|(other, b)| one.intersects(other) && meet(a, b)))
    };
    let of = |a: usize| (a + 1..things.len()).filter(|b| pair(a, *b)).map(|b| [a, b]).collect::<Vec<_>>();
    enfilade_parallel::flat_map_up_to(things.len(), of)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(low: DVec3, size: DVec3) -> Solid {
        let corner = |i: u32| low + size * DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        Solid::around(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn pairs_are_told_by_their_distance_and_their_depth() {
        let at = |x: f64| vec![block(DVec3::X * x, DVec3::splat(0.1))];
        let things = [at(0.0), at(0.1005), at(0.2)];
        assert_eq!(overlaps(&things, 0.001), [[0, 1], [1, 2]]);
        assert_eq!(overlaps(&things, -0.0003), [[1, 2]]);
        assert!(overlaps(&things, -0.001).is_empty());
    }

    #[test]
    fn what_stands_stays_and_what_hangs_falls() {
        let floor = block(DVec3::new(-2.0, -2.0, -0.1), DVec3::new(4.0, 4.0, 0.1));
        let stands = block(DVec3::ZERO, DVec3::splat(0.2));
        let hangs = block(DVec3::new(1.0, 0.0, 0.5), DVec3::splat(0.2));
        let things = [stands, hangs].map(|solid| Thing { solids: vec![solid], moments: None });
        let found = unrest(&[floor], &things, 0.5);
        assert!(found[0].farthest_m < 3e-4 && (found[1].middle_m.z + 0.5).abs() < 0.05, "{found:?}");
    }

    #[test]
    fn a_thing_falls_by_its_own_mass_not_by_its_shape() {
        // A block a third of which is over the edge of a table, with nearly all of its mass there.
        let table = block(DVec3::new(-1.0, -0.5, -0.1), DVec3::new(1.0, 1.0, 0.1));
        let [lies, hangs] = [-0.2, 0.0].map(|x| block(DVec3::new(x, -0.05, 0.0), DVec3::new(if x < 0.0 { 0.2 } else { 0.1 }, 0.1, 0.05)));
        let moments = Moments::joined(&[lies.moments(0.05), hangs.moments(1.0)]);
        let thing = |moments| Thing { solids: vec![lies.clone(), hangs.clone()], moments };
        let moves = |moments| unrest(std::slice::from_ref(&table), &[thing(moments)], 0.3)[0].farthest_m;
        assert!(moves(None) < 3e-4 && moves(moments) > 0.02, "{} and {}", moves(None), moves(moments));
    }
}
