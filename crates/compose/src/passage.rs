//! What is in the way of solids that move.

use crate::shapes::pose;
use crate::solid::Solid;
use enfilade_math::{DAffine3, DQuat};
use rapier3d_f64::math::Pose3;
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d_f64::parry::query;
use rapier3d_f64::parry::shape::SharedShape;

/// Solids that are moved as one among things that stay.
pub struct Passage {
    moving: Vec<SharedShape>,
    /// Each solid of the things, with its thing's number.
    there: Vec<(usize, Aabb, SharedShape)>,
}

impl Passage {
    /// Solids at rest, and things with their numbers.
    pub fn new<'s>(moving: &[Solid], things: impl IntoIterator<Item = (usize, &'s [Solid])>) -> Self {
        let solids = things.into_iter().flat_map(|(number, thing)| thing.iter().map(move |solid| (number, solid)));
        let there = |(number, solid): (usize, &Solid)| solid.shape().map(|shape| (number, shape.compute_local_aabb(), shape));
        Self { moving: moving.iter().filter_map(Solid::shape).collect(), there: solids.filter_map(there).collect() }
    }

    /// The number of a thing that the solids are in, after a rotation and translation has taken them from rest.
    pub fn hit(&self, map: DAffine3) -> Option<usize> {
        let map = pose(DQuat::from_mat3(&map.matrix3).normalize(), map.translation);
        self.moving.iter().find_map(|shape| {
            let bounds = shape.compute_aabb(&map);
            let mut near = self.there.iter().filter(|(_, other, _)| bounds.intersects(other));
            let meets = |other: &SharedShape| query::contact(&map, &**shape, &Pose3::IDENTITY, &**other, 0.0).ok().flatten().is_some();
            near.find(|(_, _, other)| meets(other)).map(|(number, _, _)| *number)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;

    #[test]
    fn a_leaf_that_turns_is_in_a_post_at_its_angle() {
        let block = |low: DVec3, high: DVec3| {
            let corner = |i: u32| {
                DVec3::new([low.x, high.x][(i & 1) as usize], [low.y, high.y][(i >> 1 & 1) as usize], [low.z, high.z][(i >> 2) as usize])
            };
            Solid::around(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
        };
        let leaf = block(DVec3::new(0.0, -0.01, 0.0), DVec3::new(0.8, 0.01, 2.0));
        // Its near side is seen from the hinge at 45 degrees.
        let posts = [
            vec![block(DVec3::new(-0.5, -0.5, 0.0), DVec3::new(-0.4, -0.4, 1.0))],
            vec![block(DVec3::new(0.3, 0.3, 0.0), DVec3::new(0.4, 0.4, 1.0))],
        ];
        let passage = Passage::new(&[leaf], posts.iter().map(Vec::as_slice).zip(4..).map(|(post, number)| (number, post)));
        let at = |degrees: f64| passage.hit(DAffine3::from_rotation_z(degrees.to_radians()));
        assert_eq!([0.0, 30.0, 45.0, 60.0, 225.0].map(at), [None, None, Some(5), None, Some(4)]);
    }
}
