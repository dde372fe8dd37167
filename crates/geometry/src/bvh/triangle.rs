//! The watertight test of eight triangles at once.

use super::lanes::{Eight, Lanes, lane_of};
use super::leaf::{LANES, Leaf};
use enfilade_math::Ray;

/// The intersections of a ray with the planes of eight triangles. Only the lanes named beside it are meaningful.
pub(super) struct Meets {
    pub t: Eight<f32>,
    pub u: Eight<f32>,
    pub v: Eight<f32>,
}

/// The watertight triangle test with its constants.
///
/// The triangle is sheared so that the ray is the z axis; then the origin of the xy plane is inside the projected triangle exactly when
/// its three edge functions have the same sign. Two triangles that share an edge compute the two products of its edge function alike
/// and subtract them the other way round, so the signs are opposite or both values are zero: there is no gap between them. A fused
/// multiply-add would round one of the products only and break that. Rounding turns no sign over but can make a value zero, which
/// [`settle_zeros`] looks into.
pub(super) struct TriangleTest<L> {
    /// The axes of the sheared space; the last is the one of the largest component of the direction.
    axes: [usize; 3],
    origin: [L; 3],
    shear: [L; 3],
    t_min: L,
}

// No closures and no `array::map` here: they would be compiled without AVX2 and called for every operation.
impl<L: Lanes> TriangleTest<L> {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let (origin, direction): (&[f32; 3], &[f32; 3]) = (ray.origin.as_ref(), ray.direction.as_ref());
        let [along_x, along_y, along_z] = ray.direction.abs().to_array();
        let x_or_y = usize::from(along_y > along_x);
        let along = if x_or_y == 1 { along_y } else { along_x };
        let axes = AXES[if along_z > along { 2 } else { x_or_y }];
        let [x, y, z] = axes;
        let inverse_z = 1.0 / direction[z];
        Self {
            axes,
            origin: [L::splat(origin[x]), L::splat(origin[y]), L::splat(origin[z])],
            shear: [L::splat(direction[x] * inverse_z), L::splat(direction[y] * inverse_z), L::splat(inverse_z)],
            t_min: L::splat(ray.t_min),
        }
    }

    /// Triangles hit with `t_min < t <= limit`, and where.
    #[inline(always)]
    pub fn meet(&self, leaf: Leaf<'_>, limit: f32, at: &mut Meets) -> u32 {
        let [x, y, z] = self.axes;
        // SAFETY: there are three axes, and `axes` is made of their numbers.
        let [x, y, z] = unsafe { [leaf.rows(x), leaf.rows(y), leaf.rows(z)] };
        let (a, b, c) = (self.sheared(x[0], y[0], z[0]), self.sheared(x[1], y[1], z[1]), self.sheared(x[2], y[2], z[2]));
        let mut weights = [edge(c, b), edge(a, c), edge(b, a)];
        let zero = L::splat(0.0);
        let lowest = weights[0].min(weights[1]).min(weights[2]);
        let highest = weights[0].max(weights[1]).max(weights[2]);
        let mut inside = (zero.le(lowest) | highest.le(zero)) & leaf.lanes();
        if inside == 0 {
            return 0;
        }
        let zeros = inside & !(weights[0].ne(zero) & weights[1].ne(zero) & weights[2].ne(zero));
        let scale = L::splat(1.0).div(weights[0].add(weights[1]).add(weights[2]));
        weights = [weights[0].mul(scale), weights[1].mul(scale), weights[2].mul(scale)];
        if zeros != 0 {
            let corners = [[a[0].store(), a[1].store()], [b[0].store(), b[1].store()], [c[0].store(), c[1].store()]];
            let mut settled = [weights[0].store(), weights[1].store(), weights[2].store()];
            inside &= !settle_zeros(zeros, &corners, &mut settled);
            weights = [L::load(&settled[0]), L::load(&settled[1]), L::load(&settled[2])];
        }
        let t = weights[0].mul(a[2]).add(weights[1].mul(b[2])).add(weights[2].mul(c[2])).mul(self.shear[2]);
        let lanes = inside & self.t_min.lt(t) & t.le(L::splat(limit));
        *at = Meets { t: t.store(), u: weights[1].store(), v: weights[2].store() };
        lanes
    }

    #[inline(always)]
    fn sheared(&self, at_x: &[f32; LANES], at_y: &[f32; LANES], at_z: &[f32; LANES]) -> [L; 3] {
        let pz = L::read(at_z).sub(self.origin[2]);
        let px = L::read(at_x).sub(self.origin[0]).sub(self.shear[0].mul(pz));
        let py = L::read(at_y).sub(self.origin[1]).sub(self.shear[1].mul(pz));
        [px, py, pz]
    }
}

/// Axes of the sheared space, by the last one.
static AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// Twice the area of the triangle of the origin, `p` and `q`; the sign turns over exactly with their order.
#[inline(always)]
fn edge<L: Lanes>(p: [L; 3], q: [L; 3]) -> L {
    p[0].mul(q[1]).sub(p[1].mul(q[0]))
}

/// Decides again for triangles with an edge function of zero, in double precision, where products of `f32` are exact: the ray runs
/// through an edge (inside), or the products were rounded to the same number (either). Returns the lanes that are outside.
#[cold]
fn settle_zeros(mut lanes: u32, corners: &[[Eight<f32>; 2]; 3], weights: &mut [Eight<f32>; 3]) -> u32 {
    let mut outside = 0;
    while lanes != 0 {
        let lane = lane_of(&mut lanes) & 7;
        let edge = |p: usize, q: usize| {
            let at = |corner: usize, axis: usize| f64::from(corners[corner][axis].0[lane]);
            at(p, 0) * at(q, 1) - at(p, 1) * at(q, 0)
        };
        let exact = [edge(2, 1), edge(0, 2), edge(1, 0)];
        let sum: f64 = exact.iter().sum();
        let same_sign = exact.iter().all(|&w| w >= 0.0) || exact.iter().all(|&w| w <= 0.0);
        if !same_sign || sum == 0.0 {
            outside |= 1 << lane;
        }
        for (weight, exact) in weights.iter_mut().zip(exact) {
            weight.0[lane] = (exact / sum) as f32;
        }
    }
    outside
}
