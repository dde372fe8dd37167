//! The pyramid of a tile's rays, and the test which boxes reach into it, sixteen at a time.

use super::pinhole::PinholeRays;
use super::tile::TILE;
use crate::bvh::node::Node;
use crate::bvh::wide::Wide;
use enfilade_math::Vec3;

/// The rays of a tile, and the planes around them.
pub(super) struct Frustum {
    pub origin: Vec3,
    /// Through the tile's first pixel.
    pub corner: Vec3,
    pub right: Vec3,
    pub down: Vec3,
    pub forward: Vec3,
    /// Inward normals of the four sides.
    sides: [Vec3; 4],
    /// A box is outside when its point farthest along a normal has a smaller product with it than this.
    limits: [f32; 4],
    /// Error bound of a box's computed distance.
    slack: f32,
    /// Vectors whose products with a point at depth 1, less those with `corner`, are the point's column and row in the tile.
    pub pixel: [Vec3; 2],
}

impl Frustum {
    pub fn new(rays: &PinholeRays, forward: Vec3, [x, y]: [usize; 2], largest_coordinate: f32) -> Self {
        /// Error of a test, by which boxes grow, as in the traversal for rays.
        const SLACK: f32 = 16.0 * f32::EPSILON;
        let corner = rays.direction(x as f32, y as f32);
        let last = (TILE - 1) as f32;
        let [right, down] = [last * rays.right, last * rays.down];
        let corners = [corner, corner + right, corner + right + down, corner + down];
        let middle = corner + 0.5 * (right + down);
        let slack = SLACK * (largest_coordinate + rays.origin.abs().max_element());
        let sides = [0, 1, 2, 3].map(|k| {
            let normal = corners[k].cross(corners[(k + 1) % 4]).normalize_or_zero();
            if normal.dot(middle) < 0.0 { -normal } else { normal }
        });
        // The basis dual to `right` and `down` in their plane.
        let area = rays.right.cross(rays.down);
        let pixel = [rays.down.cross(area) / area.length_squared(), area.cross(rays.right) / area.length_squared()];
        let limits = sides.map(|normal| normal.dot(rays.origin) - 4.0 * slack);
        Self { origin: rays.origin, corner, right: rays.right, down: rays.down, forward, sides, limits, slack: 4.0 * slack, pixel }
    }
}

/// The frustum's planes, ready for sixteen boxes at a time.
pub(super) struct Planes<W> {
    sides: [[W; 3]; 4],
    limits: [W; 4],
    /// Bound of a box that is farthest along a side's normal.
    farthest: [[usize; 3]; 4],
    forward: [W; 3],
    /// Depth of the world's origin, and what a box may be nearer than computed.
    behind: W,
    nearest: [usize; 3],
}

impl<W: Wide> Planes<W> {
    #[inline(always)]
    pub fn new(frustum: &Frustum) -> Self {
        let (s, l) = (&frustum.sides, &frustum.limits);
        Self {
            sides: [wide(s[0]), wide(s[1]), wide(s[2]), wide(s[3])],
            limits: [W::splat(l[0]), W::splat(l[1]), W::splat(l[2]), W::splat(l[3])],
            farthest: [upper(s[0]), upper(s[1]), upper(s[2]), upper(s[3])],
            forward: wide(frustum.forward),
            behind: W::splat(frustum.forward.dot(frustum.origin) + frustum.slack),
            nearest: upper(-frustum.forward),
        }
    }

    /// The children that reach into the frustum at a depth of no more than `limit`, and the smallest depth of each.
    #[inline(always)]
    pub fn enter(&self, node: &Node, limit: f32) -> (u32, W) {
        let z = self.along(&self.forward, self.nearest, node).sub(self.behind);
        let mut entered = z.le(W::splat(limit));
        for k in 0..4 {
            entered &= self.limits[k].le(self.along(&self.sides[k], self.farthest[k], node));
        }
        (entered, z)
    }

    #[inline(always)]
    fn along(&self, normal: &[W; 3], bound: [usize; 3], node: &Node) -> W {
        let x = normal[0].mul(W::load(&node.bounds[0][bound[0] & 1]));
        let y = normal[1].mul(W::load(&node.bounds[1][bound[1] & 1]));
        let z = normal[2].mul(W::load(&node.bounds[2][bound[2] & 1]));
        x.add(y).add(z)
    }
}

#[inline(always)]
pub(super) fn wide<W: Wide>(v: Vec3) -> [W; 3] {
    [W::splat(v.x), W::splat(v.y), W::splat(v.z)]
}

/// Per axis, which bound of a box is farthest along `v`.
#[inline(always)]
fn upper(v: Vec3) -> [usize; 3] {
    [usize::from(v.x >= 0.0), usize::from(v.y >= 0.0), usize::from(v.z >= 0.0)]
}
