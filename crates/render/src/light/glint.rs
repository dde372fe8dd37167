//! Glints: sunlit glossy surfaces as light sources.
//!
//! The sun on a chair's metal frame lights the floor around it, and no light sample finds that: the floor's light samples aim at the sun
//! itself, and only the few sampled directions that happen to meet the frame where its lobe points back see how bright it is. So the
//! triangles of glossy materials that the sun reaches are emitters here. A point samples one by its importance and a place on it, and the
//! light is the sunlight that the surface reflects there: a connection to a light path with one surface (Veach 1997, chapter 10), weighted
//! by the power heuristic against paths that arrive there by sampled directions.
//!
//! Light that is not found here — from other surfaces and lights, or through panes — is left to sampled directions. This file has the
//! hierarchy of the glints; [`super::sunlit`] finds and samples them.

use super::bounds::{Emitters, Reach};
use super::sample::LightPoint;
use super::tree::LightTree;
use enfilade_math::{Bounds3, Vec3, warp};
use std::f32::consts::PI;

/// Triangles are halved until no edge is longer, in metres, but no more often than this.
const PIECE: f32 = 0.1;
const MAX_DEPTH: u32 = 10;
/// The smallest square of a distance, square metres: a cluster that is a point may be asked about at that point.
const MIN_DISTANCE_2: f32 = 1e-12;
/// The half vector's squared length, of two at most, is taken for at least this much: along a grazing ray it may point anywhere.
const MIN_HALF: f32 = 0.01;

/// The sunlit glossy triangles of a scene. The default has none.
#[derive(Debug, Default)]
pub(super) struct Glints {
    /// In the order of their numbers.
    pub triangles: Vec<Glinting>,
    /// Triangle of each emitter: its place in `triangles`.
    pub of_emitter: Vec<u32>,
    pub tree: LightTree<GlintBounds>,
    /// Nodes of the tree that are clusters.
    pub clusters: Vec<u32>,
    pub cluster_of_emitter: Vec<u32>,
}

/// A triangle whose pieces are emitters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glinting {
    pub number: u32,
    /// Number of its first emitter; one for each piece follows.
    pub first: u32,
    /// How often it is halved.
    pub depth: u32,
    /// Area of a piece, square metres.
    pub area: f32,
}

/// Bounds and means that a node of the hierarchy has for the glints below it; means are weighted by power.
#[derive(Clone, Copy, Debug)]
pub(super) struct GlintBounds {
    pub bounds: Bounds3,
    /// Irradiance × area × reflectance at normal incidence, luminance.
    pub power: f32,
    /// Irradiance × area × what the reflectance lacks to one, luminance: it is reached at grazing angles.
    pub grazing: f32,
    /// Direction of the mean normal; unit.
    pub axis: Vec3,
    /// Length of the mean normal: below one where normals differ.
    pub mean_length: f32,
    /// Mean of the squared GGX roughness.
    pub alpha_2: f32,
    /// Unit vector to the sun.
    pub to_sun: Vec3,
}

/// [`GlintBounds`] as their importance needs them.
#[derive(Clone, Copy, Debug)]
pub(super) struct GlintReach {
    center: Vec3,
    /// Square of the radius of the ball around the box.
    radius_2: f32,
    axis: Vec3,
    power: f32,
    grazing: f32,
    /// See [`GlintBounds::spread`].
    spread: f32,
    to_sun: Vec3,
}

impl Emitters for GlintBounds {
    type Reach = GlintReach;

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn power(&self) -> f32 {
        self.power
    }

    fn union(&self, other: &Self) -> Self {
        let power = self.power + other.power;
        let part = other.power / power;
        let normal = (self.axis * self.mean_length).lerp(other.axis * other.mean_length, part);
        Self {
            bounds: self.bounds.union(other.bounds),
            power,
            grazing: self.grazing + other.grazing,
            axis: normal.normalize_or(self.axis),
            mean_length: normal.length(),
            alpha_2: self.alpha_2 + (other.alpha_2 - self.alpha_2) * part,
            to_sun: self.to_sun,
        }
    }

    fn orientation_measure(&self) -> f32 {
        PI * self.spread().min(1.0)
    }

    fn reach(&self) -> GlintReach {
        GlintReach {
            center: self.bounds.center(),
            radius_2: 0.25 * self.bounds.extent().length_squared(),
            axis: self.axis,
            power: self.power,
            grazing: self.grazing,
            spread: self.spread(),
            to_sun: self.to_sun,
        }
    }
}

impl Reach for GlintReach {
    /// The lobe is GGX's about the mean normal, widened by the variation of the normals and of the direction to the point within the node:
    /// both move the half vector. (Heitz 2014 for the lobe; variances add as in Toksvig 2005, "Mipmapping Normal Maps".)
    #[inline]
    fn importance(&self, at: &LightPoint) -> f32 {
        let to = self.center - at.p;
        let distance_2 = to.length_squared().max(self.radius_2).max(MIN_DISTANCE_2);
        let nearness = 1.0 / distance_2;
        let wi = to * nearness.sqrt();
        // Twice as long as the cosine between the half vector and either direction.
        let half = self.to_sun - wi;
        let square = half.length_squared().max(MIN_HALF);
        let cos = half.dot(self.axis).max(0.0);
        let width = self.spread + self.radius_2 * nearness / (3.0 * square);
        let lobe = ggx((cos * cos / square).min(1.0), width.min(1.0));
        let schlick = (1.0 - 0.5 * square.sqrt()).max(0.0).powi(5);
        let mut importance = 0.25 * (self.power + self.grazing * schlick) * lobe * nearness;
        if at.n != Vec3::ZERO {
            importance *= (at.n.dot(wi) + (self.radius_2 * nearness).sqrt()).clamp(0.0, 1.0);
        }
        importance
    }
}

impl GlintBounds {
    /// Variance of the half vector about the mean normal: of the lobes, and of the normals about their mean.
    fn spread(&self) -> f32 {
        self.alpha_2 + 2.0 * (1.0 - self.mean_length).max(0.0)
    }
}

/// The GGX density of normals at an angle of squared cosine `cos_2`, of squared roughness `alpha_2`.
#[inline]
fn ggx(cos_2: f32, alpha_2: f32) -> f32 {
    let t = cos_2 * alpha_2 + (1.0 - cos_2);
    alpha_2 / (PI * t * t)
}

impl Glints {
    /// Number of clusters.
    #[inline]
    pub fn len(&self) -> usize {
        self.clusters.len()
    }

    /// About the irradiance of a cluster at a point if nothing were in the way.
    pub fn importance(&self, cluster: usize, at: &LightPoint) -> f32 {
        self.tree.importance(self.clusters[cluster], at)
    }
}

/// How often a triangle is halved so that no piece is larger than [`PIECE`].
pub(super) fn depth(corners: &[Vec3; 3]) -> u32 {
    let is_small = |depth: &u32| {
        let piece = piece(corners, 0, *depth).map(|w| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z);
        (0..3).all(|i| piece[i].distance(piece[(i + 1) % 3]) <= PIECE)
    };
    (0..MAX_DEPTH).find(is_small).unwrap_or(MAX_DEPTH)
}

/// The corners of a piece as weights of the triangle's `corners`. Each halving cuts the longest edge in its middle, and the bits of `index`,
/// the highest first, select the half: the one with the edge's first corner, or with its second.
pub(super) fn piece(corners: &[Vec3; 3], index: u32, depth: u32) -> [Vec3; 3] {
    let mut piece = [Vec3::X, Vec3::Y, Vec3::Z];
    for level in (0..depth).rev() {
        let (a, b) = longest_edge(corners, &piece);
        let second = index >> level & 1 == 1;
        piece[if second { a } else { b }] = 0.5 * (piece[a] + piece[b]);
    }
    piece
}

/// The piece that contains the place with these `weights`.
pub(super) fn piece_at(corners: &[Vec3; 3], mut weights: [f32; 3], depth: u32) -> u32 {
    let (mut piece, mut index) = ([Vec3::X, Vec3::Y, Vec3::Z], 0);
    for _ in 0..depth {
        let (a, b) = longest_edge(corners, &piece);
        let second = weights[b] > weights[a];
        let (kept, moved) = if second { (b, a) } else { (a, b) };
        weights[kept] -= weights[moved];
        weights[moved] *= 2.0;
        piece[moved] = 0.5 * (piece[a] + piece[b]);
        index = 2 * index + u32::from(second);
    }
    index
}

fn longest_edge(corners: &[Vec3; 3], piece: &[Vec3; 3]) -> (usize, usize) {
    let [a, b, c] = piece.map(|w| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z);
    let (ab, bc, ca) = (a.distance_squared(b), b.distance_squared(c), c.distance_squared(a));
    if ab >= bc && ab >= ca {
        (0, 1)
    } else if bc >= ca {
        (1, 2)
    } else {
        (2, 0)
    }
}

/// A place of a piece, uniform for `u` uniform on [0,1)², as weights of the triangle's corners.
pub(super) fn place_in(piece: &[Vec3; 3], u: [f32; 2]) -> Vec3 {
    let place = warp::triangle(u);
    piece[0] * (1.0 - place.x - place.y) + piece[1] * place.x + piece[2] * place.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    #[test]
    fn a_triangle_falls_into_equal_pieces_and_each_place_into_its_own() {
        let corners = [Vec3::ZERO, Vec3::new(2.0, 0.1, 0.0), Vec3::new(1.9, 0.3, 0.5)];
        let depth = depth(&corners);
        assert!((5..MAX_DEPTH).contains(&depth), "{depth}");
        let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(c - a).length();
        let mut rng = Rng::new(6);
        for index in 0..1 << depth {
            let piece = piece(&corners, index, depth);
            let world = piece.map(|w| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z);
            assert!((area(world) * (1u32 << depth) as f32 / area(corners) - 1.0).abs() < 1e-3);
            let place = place_in(&piece, [rng.next_f32(), rng.next_f32()]);
            assert_eq!(piece_at(&corners, place.to_array(), depth), index);
        }
    }
}
