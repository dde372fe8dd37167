//! The triangles and placements that a tree is built over, with the numbers that building needs of them: boxes, areas, marks.

use super::binary::{Binary, BinaryNode};
use super::placed::Placement;
use enfilade_math::{Bounds3, Vec3};

/// Triangles and placements to build a tree over. Its members are numbered: first the triangles, then the placements.
pub(super) struct Soup<'a> {
    pub corners: &'a [[Vec3; 3]],
    /// Numbers that hits report for the triangles; by default their indices.
    pub numbers: Option<&'a [u32]>,
    /// By number.
    pub filtered: &'a dyn Fn(u32) -> bool,
    pub placed: &'a [PlacedBox],
}

impl Soup<'_> {
    /// Computes the box of every node from what is below it.
    pub fn fit(&self, binary: &mut Binary) {
        for i in binary.children_first() {
            let BinaryNode { first, count, .. } = binary.nodes[i];
            binary.nodes[i].bounds = if count == 0 {
                binary.nodes[first as usize].bounds.union(binary.nodes[first as usize + 1].bounds)
            } else {
                self.bounds_of(&binary.order[first as usize..(first + count) as usize])
            };
        }
    }

    /// Index of the placement; `None` for triangles.
    pub fn placement(&self, member: u32) -> Option<usize> {
        (member as usize).checked_sub(self.corners.len())
    }

    /// The number that hits report for a triangle.
    pub fn number(&self, triangle: u32) -> u32 {
        self.numbers.map_or(triangle, |numbers| numbers[triangle as usize])
    }

    /// Surface of a triangle or placement that stops every ray; of one that is filtered, none.
    pub fn stopping_area(&self, member: u32) -> f64 {
        if let Some(placement) = self.placement(member) {
            return self.placed[placement].stopping_area;
        }
        if (self.filtered)(self.number(member)) { 0.0 } else { area(&self.corners[member as usize]) }
    }

    /// The smallest box around some members.
    pub fn bounds_of(&self, members: &[u32]) -> Bounds3 {
        members.iter().fold(Bounds3::EMPTY, |bounds, &i| match self.placement(i) {
            Some(placement) => bounds.union(self.placed[placement].bounds),
            None => self.corners[i as usize].iter().fold(bounds, |bounds, &p| bounds.include(p)),
        })
    }
}

/// The data about a placement that the tree of the world needs.
pub(super) struct PlacedBox {
    pub bounds: Bounds3,
    stopping_area: f64,
    pub triangle_count: usize,
}

impl PlacedBox {
    pub fn new(placement: &Placement, mesh: &[[Vec3; 3]]) -> Self {
        let world = mesh.iter().map(|corners| corners.map(|p| placement.world(p)));
        let (bounds, whole) = world.filter(has_area).fold((Bounds3::EMPTY, 0.0), |(bounds, sum), corners| {
            (corners.iter().fold(bounds, |bounds, &p| bounds.include(p)), sum + area(&corners))
        });
        Self { bounds, stopping_area: if placement.filtered { 0.0 } else { whole }, triangle_count: mesh.len() }
    }
}

/// True for finite triangles whose area is not zero. In double precision, where differences and products of `f32` are all but exact.
pub(super) fn has_area(triangle: &[Vec3; 3]) -> bool {
    let [a, b, c] = triangle.map(|p| p.as_dvec3());
    triangle.iter().all(|p| p.is_finite()) && (b - a).cross(c - a).length_squared() > 0.0
}

fn area(triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle.map(|p| p.as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}
