//! Whether the surfaces of two objects cut each other.

use enfilade_math::{Bounds3, Vec3};

/// Corners in the world, metres.
pub type Triangle = [Vec3; 3];

/// An object: its triangles in the world, part by part.
pub struct Body {
    /// The object's name.
    pub name: String,
    /// The box around it.
    pub bounds: Bounds3,
    parts: Vec<(Bounds3, Vec<Triangle>)>,
}

impl Body {
    /// Without parts yet.
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), bounds: Bounds3::EMPTY, parts: Vec::new() }
    }

    /// Adds a part.
    pub fn push(&mut self, triangles: Vec<Triangle>) {
        let bounds = Bounds3::from_points(triangles.iter().flatten().copied());
        self.bounds = self.bounds.union(bounds);
        self.parts.push((bounds, triangles));
    }

    /// Moves it.
    pub fn shift(&mut self, offset: Vec3) {
        let moved = |b: &Bounds3| Bounds3 { min: b.min + offset, max: b.max + offset };
        self.bounds = moved(&self.bounds);
        for (bounds, triangles) in &mut self.parts {
            *bounds = moved(bounds);
            triangles.iter_mut().flatten().for_each(|p| *p += offset);
        }
    }

    /// The triangles of the body whose boxes meet `window`.
    pub fn within(&self, window: &Bounds3) -> impl Iterator<Item = &Triangle> {
        let parts = self.parts.iter().filter(|(bounds, _)| overlap(bounds, window, 0.0));
        parts.flat_map(|(_, triangles)| triangles).filter(|t| overlap(&around(t), window, 0.0))
    }

    /// The triangles of the body, part by part.
    pub fn parts(&self) -> impl Iterator<Item = &[Triangle]> {
        self.parts.iter().map(|(_, triangles)| triangles.as_slice())
    }

    /// Volume of the box around it, cubic metres: of two bodies the smaller gives way.
    pub fn volume(&self) -> f32 {
        self.bounds.extent().max(Vec3::splat(1e-3)).element_product()
    }

    /// The boxes around its parts.
    pub fn boxes(&self) -> impl Iterator<Item = Bounds3> {
        self.parts.iter().map(|(bounds, _)| *bounds)
    }

    /// The body shrunk towards its middle by `by` metres on every side; never to less than a third of its size.
    pub fn shrunk(&self, by: f32) -> Self {
        let (center, extent) = (self.bounds.center(), self.bounds.extent().max(Vec3::splat(1e-6)));
        let scale = ((extent - 2.0 * by) / extent).max(Vec3::splat(1.0 / 3.0));
        let mut body = Self::new(&self.name);
        for (_, triangles) in &self.parts {
            body.push(triangles.iter().map(|t| t.map(|p| center + (p - center) * scale)).collect());
        }
        body
    }

    /// True when some triangle of this body, moved by `offset`, cuts one of the other.
    pub fn meets(&self, other: &Self, offset: Vec3) -> bool {
        let whole = Bounds3 { min: self.bounds.min + offset, max: self.bounds.max + offset };
        if !overlap(&whole, &other.bounds, 0.0) {
            return false;
        }
        self.parts.iter().any(|(bounds, triangles)| {
            let bounds = Bounds3 { min: bounds.min + offset, max: bounds.max + offset };
            other.parts.iter().any(|(theirs, others)| overlap(&bounds, theirs, 0.0) && cut(triangles, offset, others, &bounds, theirs))
        })
    }
}

/// The box around a triangle.
pub fn around([a, b, c]: &Triangle) -> Bounds3 {
    Bounds3 { min: a.min(*b).min(*c), max: a.max(*b).max(*c) }
}

/// True when the boxes come nearer than `margin`.
pub fn overlap(a: &Bounds3, b: &Bounds3, margin: f32) -> bool {
    a.min.cmple(b.max + margin).all() && b.min.cmple(a.max + margin).all()
}

/// True when a triangle of `a`, moved by `offset`, cuts one of `b`. Both are sorted by x, so that pairs far apart are skipped.
fn cut(a: &[Triangle], offset: Vec3, b: &[Triangle], bounds_a: &Bounds3, bounds_b: &Bounds3) -> bool {
    let shared = Bounds3 { min: bounds_a.min.max(bounds_b.min), max: bounds_a.max.min(bounds_b.max) };
    let within = |t: &Triangle| overlap(&around(t), &shared, 1e-5);
    let mut a: Vec<Triangle> = a.iter().map(|t| t.map(|p| p + offset)).filter(within).collect();
    let mut b: Vec<Triangle> = b.iter().copied().filter(within).collect();
    let left = |t: &Triangle| t[0].x.min(t[1].x).min(t[2].x);
    a.sort_by(|s, t| left(s).total_cmp(&left(t)));
    b.sort_by(|s, t| left(s).total_cmp(&left(t)));
    let widest = b.iter().map(|t| around(t).extent().x).fold(0.0, f32::max);
    let mut from = 0;
    for t in &a {
        let box_t = around(t);
        while from < b.len() && left(&b[from]) < box_t.min.x - widest {
            from += 1;
        }
        for s in b[from..].iter().take_while(|s| left(s) <= box_t.max.x) {
            if overlap(&box_t, &around(s), 0.0) && triangles_cut(t, s) {
                return true;
            }
        }
    }
    false
}

/// True when an edge of either pierces the other; triangles in one plane do not count.
pub fn triangles_cut(a: &Triangle, b: &Triangle) -> bool {
    let pierced = |a: &Triangle, b: &Triangle| (0..3).any(|k| pierces(a[k], a[(k + 1) % 3], b));
    pierced(a, b) || pierced(b, a)
}

/// Möller & Trumbore 1997, for the segment from `p` to `q`.
fn pierces(p: Vec3, q: Vec3, [a, b, c]: &Triangle) -> bool {
    let (d, e1, e2) = (q - p, *b - *a, *c - *a);
    let h = d.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-14 {
        return false;
    }
    let s = (p - *a) / det;
    let u = s.dot(h);
    let k = s.cross(e1);
    let v = d.dot(k);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&e2.dot(k))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Reshape, bevelled_box};

    fn cube(at: Vec3) -> Body {
        let mesh = bevelled_box(Vec3::ONE, 0.01).moved(at);
        let mut body = Body::new("cube");
        body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect());
        body
    }

    #[test]
    fn boxes_meet_when_they_overlap_and_not_when_they_stand_apart() {
        let a = cube(Vec3::ZERO);
        assert!(a.meets(&cube(Vec3::new(0.9, 0.4, 0.3)), Vec3::ZERO));
        assert!(!a.meets(&cube(Vec3::new(1.01, 0.4, 0.3)), Vec3::ZERO));
        assert!(a.meets(&cube(Vec3::new(1.01, 0.4, 0.3)), Vec3::new(0.02, 0.0, 0.0)));
    }
}
