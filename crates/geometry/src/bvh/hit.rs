//! The hit of a ray with a triangle, which every query of the hierarchy returns.

/// The hit of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter on the ray, strictly between its `t_min` and `t_max`.
    pub t: f32,
    /// Index of the triangle in the order given to [`Bvh::new`](super::Bvh::new), or its number among those given to
    /// [`Bvh::with_placements`](super::Bvh::with_placements).
    pub triangle: u32,
    /// Barycentric weight of corner 1, in [0, 1].
    pub u: f32,
    /// Barycentric weight of corner 2, in [0, 1]; corner 0 has the weight 1 − u − v.
    pub v: f32,
}

impl Hit {
    /// Weights of the three corners.
    #[inline]
    pub fn weights(&self) -> [f32; 3] {
        [1.0 - self.u - self.v, self.u, self.v]
    }
}
