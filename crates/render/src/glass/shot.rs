//! Rays that smooth glass bends, with the derivatives of their end by their first direction.

use super::{are_parallel, refracted, repeated};
use crate::bsdf::Border;
use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::Medium;
use enfilade_math::{Onb, Ray, Rgb, Vec3, hash_u64};
use enfilade_scene::PartId;

/// The most surfaces on the way of a shot.
const MAX_SURFACES: usize = 64;
/// Shots meet borders at no smaller cosine, where their derivatives would lose all digits.
const MIN_COSINE: f32 = 1e-3;

/// The end of a shot.
#[derive(Clone, Copy)]
pub(super) enum End {
    /// The place nearest to a point or, if the point is on a surface with this normal, in the surface's plane.
    Near(Vec3, Vec3),
    /// After this length, metres.
    After(f32),
}

/// A ray on its way through glass, or at its end.
#[derive(Clone, Copy)]
pub(super) struct Shot {
    /// The position, and the unit direction in which the ray goes on.
    pub p: Vec3,
    pub direction: Vec3,
    /// Derivatives of both by the first direction, along the axes that [`Onb::from_z`] gives it.
    pub moved: [Vec3; 2],
    pub turned: [Vec3; 2],
    /// Fraction of the light that comes through.
    pub through: Rgb,
    /// The medium that it is in.
    pub medium: Medium,
    /// True as long as every body on its way was left through a border parallel to the one that it was entered by.
    pub parallel: bool,
    /// The panes and borders that it has passed.
    pub passed: Passed,
    /// A number for the flat ones among the borders, in their order.
    pub faces: u64,
}

/// The parts of the panes and borders that a shot has passed, the last few of them.
#[derive(Clone, Copy, Default)]
pub(crate) struct Passed {
    parts: [PartId; Self::KEPT],
    count: usize,
}

impl Passed {
    const KEPT: usize = 8;

    fn add(&mut self, part: PartId) {
        self.parts[self.count % Self::KEPT] = part;
        self.count += 1;
    }

    /// The `name` of the last of them that has one.
    pub fn last_named<T>(&self, name: impl Fn(PartId) -> Option<T>) -> Option<T> {
        let oldest = self.count.saturating_sub(Self::KEPT);
        (oldest..self.count).rev().find_map(|k| name(self.parts[k % Self::KEPT]))
    }
}

/// The way into a body through a flat border.
struct Entered {
    normal: Vec3,
    direction: Vec3,
    turned: [Vec3; 2],
}

impl<'s> RenderScene<'s> {
    /// Sends a shot along `ray`, which begins in `medium`. `None` when something is in the way, or light is reflected totally.
    pub(super) fn shoot(&self, ray: &Ray, medium: Medium, end: End) -> Option<Shot> {
        let axes = Onb::from_z(ray.direction);
        let mut shot = Shot {
            p: ray.origin,
            direction: ray.direction,
            moved: [Vec3::ZERO; 2],
            turned: [axes.x, axes.y],
            through: Rgb::WHITE,
            medium,
            parallel: true,
            passed: Passed::default(),
            faces: 0,
        };
        let mut entered: Option<Entered> = None;
        let mut way = 0.0;
        for _ in 0..MAX_SURFACES {
            // Find the next surface before the end.
            let ahead = match end {
                End::Near(target, normal) => {
                    let along = if normal.dot(shot.direction).abs() > MIN_COSINE { normal } else { shot.direction };
                    (target - shot.p).dot(along) / shot.direction.dot(along) * (1.0 - 1e-5)
                }
                End::After(length) => length - way,
            };
            if ahead <= 0.0 {
                return None;
            }
            let Some(hit) = self.closest(&Ray { t_max: ahead, ..Ray::new(shot.p, shot.direction) }, AlphaTest::Stochastic) else {
                // Only the direction of infinitely far lights is known.
                if ahead < f32::MAX {
                    shot.advance(ahead);
                }
                shot.parallel &= entered.is_none();
                return Some(shot);
            };
            let surface = self.surface(&hit, shot.direction, &Cone::POINT);
            shot.advance(hit.t);
            way += hit.t;

            // Go straight through thin panes, and bend at the borders of bodies.
            if let Some(passed) = surface.straight_transmittance(self).filter(|passed| !passed.is_black()) {
                shot.through *= passed;
            } else {
                let border = surface.border(self).filter(|border| !border.transmitted.is_black())?;
                let before = (shot.direction, shot.turned);
                let inner = shot.medium.transmittance(hit.t);
                shot.cross(self, &surface, &border)?;
                if surface.flat {
                    shot.faces = hash_u64(shot.faces ^ u64::from(hit.triangle));
                }
                match (surface.outside, entered.take()) {
                    (true, None) if surface.flat => {
                        entered = Some(Entered { normal: surface.ns, direction: before.0, turned: before.1 });
                    }
                    (false, Some(into)) if surface.flat && are_parallel(into.normal, surface.ns) => {
                        (shot.direction, shot.turned) = (into.direction, into.turned);
                        shot.through *= repeated(border.reflected, inner);
                    }
                    _ => shot.parallel = false,
                }
            }
            shot.passed.add(self.triangles.part_of(hit.triangle));
            shot.p = surface.ray(shot.direction).origin;
        }
        None
    }

    /// The light that comes through panes, thin and solid, along a ray that keeps its direction, and the panes passed; black where anything
    /// else is in the way. The shift by solid panes moves the end of a ray that has one.
    pub(crate) fn through_panes(&self, ray: &Ray) -> (Rgb, Passed) {
        let shot = self.shoot(ray, Medium::AIR, End::After(ray.t_max)).filter(|shot| shot.parallel);
        shot.map_or((Rgb::BLACK, Passed::default()), |shot| (shot.through, shot.passed))
    }

    /// The ray beyond a solid pane that a ray of this `direction` enters at `surface`, and what comes through; `None` where it is none.
    pub(crate) fn beyond_pane(&self, surface: &Surface<'s>, direction: Vec3) -> Option<(Rgb, Ray)> {
        let into = Some(surface).filter(|s| self.bodies.any && s.flat && s.outside)?.border(self)?;
        let inner = refracted(direction, surface.ns, into.eta)?;
        let hit = self.closest(&surface.ray(inner), AlphaTest::Stochastic)?;
        let back = self.surface(&hit, inner, &Cone::POINT);
        let out = Some(&back).filter(|s| s.flat && !s.outside && are_parallel(s.ns, surface.ns))?.border(self)?;
        let absorbed = Medium::AIR.after(surface, true).transmittance(hit.t);
        Some((into.transmitted * out.transmitted * absorbed * repeated(out.reflected, absorbed), back.ray(direction)))
    }

    /// About what comes through glass of any shape along a straight ray: enough to learn where the light of a lamp inside of it arrives.
    pub(crate) fn about_through_glass(&self, ray: &Ray) -> Rgb {
        let (mut at, mut left, mut through) = (*ray, ray.t_max, Rgb::WHITE);
        for _ in 0..MAX_SURFACES {
            let Some(hit) = self.closest(&Ray { t_max: left, ..at }, AlphaTest::Stochastic) else { return through };
            let surface = self.surface(&hit, at.direction, &Cone::POINT);
            let passed = surface.straight_transmittance(self).filter(|passed| !passed.is_black());
            let Some(passed) = passed.or_else(|| surface.border(self).map(|border| border.transmitted)) else { return Rgb::BLACK };
            through *= passed;
            left -= hit.t;
            at = surface.ray(at.direction);
        }
        Rgb::BLACK
    }

    /// How far away the first border of a body is that a ray meets, beyond thin panes, and its part; `None` where something else is before
    /// it.
    pub(super) fn glass_ahead(&self, ray: &Ray) -> Option<(f32, PartId)> {
        let (mut at, mut way) = (*ray, 0.0);
        for _ in 0..MAX_SURFACES {
            let hit = self.closest(&Ray { t_max: ray.t_max - way, ..at }, AlphaTest::Stochastic)?;
            let surface = self.surface(&hit, at.direction, &Cone::POINT);
            way += hit.t;
            if surface.border(self).is_some() {
                return Some((way, self.triangles.part_of(hit.triangle)));
            }
            surface.straight_transmittance(self).filter(|passed| !passed.is_black())?;
            at = surface.ray(at.direction);
        }
        None
    }
}

impl Shot {
    /// Advances by `t` metres.
    fn advance(&mut self, t: f32) {
        self.p += self.direction * t;
        self.through *= self.medium.transmittance(t);
        for (moved, turned) in self.moved.iter_mut().zip(self.turned) {
            *moved += turned * t;
        }
    }

    /// Refracts at a border. `None` where the light grazes it, or where a normal map replaces the border's own shape.
    fn cross(&mut self, scene: &RenderScene<'_>, surface: &Surface<'_>, border: &Border) -> Option<()> {
        let (d, n, ratio) = (self.direction, surface.ns, 1.0 / border.eta);
        let (cosine, onto) = (-d.dot(n), d.dot(surface.ng));
        let bent = refracted(d, n, border.eta)?;
        let beyond = -bent.dot(n);
        let grazes = [cosine, beyond, -onto, -bent.dot(surface.ng)].iter().any(|&cosine| cosine < MIN_COSINE);
        if grazes || surface.material.normal_map.is_some() {
            return None;
        }
        for (moved, turned) in self.moved.iter_mut().zip(&mut self.turned) {
            // Onto the face along the ray, then the derivative of the law of refraction.
            *moved -= d * (moved.dot(surface.ng) / onto);
            let curved = if surface.flat { Vec3::ZERO } else { curvature(scene, surface, *moved) };
            let cosine_by = -(turned.dot(n) + d.dot(curved));
            let beyond_by = ratio * ratio * cosine * cosine_by / beyond;
            *turned = *turned * ratio + n * (ratio * cosine_by - beyond_by) + curved * (ratio * cosine - beyond);
        }
        self.through *= border.transmitted;
        self.medium = self.medium.after(surface, true);
        self.direction = bent;
        Some(())
    }
}

/// How the interpolated normal of a face turns when the point on it is moved.
fn curvature(scene: &RenderScene<'_>, surface: &Surface<'_>, moved: Vec3) -> Vec3 {
    let triangle = scene.triangles.get(surface.triangle);
    let [a, b, c] = triangle.corners;
    let (ab, ac) = (b - a, c - a);
    let (bb, bc, cc) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
    let determinant = bb * cc - bc * bc;
    if determinant <= 0.0 {
        return Vec3::ZERO;
    }
    let (to_b, to_c) = (moved.dot(ab), moved.dot(ac));
    let (v, w) = ((cc * to_b - bc * to_c) / determinant, (bb * to_c - bc * to_b) / determinant);
    let [na, nb, nc] = triangle.normals;
    let weights = surface.weights;
    let normal = na * weights[0] + nb * weights[1] + nc * weights[2];
    let turned = ((nb - na) * v + (nc - na) * w) / normal.length().max(f32::MIN_POSITIVE);
    let side = if normal.dot(surface.ns) < 0.0 { -1.0 } else { 1.0 };
    (turned - surface.ns * surface.ns.dot(turned)) * side
}
