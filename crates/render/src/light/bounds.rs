//! Bounds that a node of the light hierarchy has for the emitters below it, and how much light they could send to a point.
//!
//! Conty Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting": a box, a cone of normals and a
//! power. The importance is never zero where light could arrive: every angle is taken at its most favourable within the box.

use super::sample::LightPoint;
use enfilade_math::{Bounds3, Quat, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};
use std::fmt::Debug;

/// Cosine of the emission angle of cones, whose emission is straight ahead: zero up to rounding.
const STRAIGHT_AHEAD: f32 = 0.99;

/// Bounds that a node has for the emitters below it.
pub(super) trait Emitters: Copy {
    /// Precomputed data for their importance.
    type Reach: Reach;

    /// The box around them.
    fn bounds(&self) -> Bounds3;
    /// Their total emission; emitters without any are never drawn.
    fn power(&self) -> f32;
    /// Bounds of both together.
    fn union(&self, other: &Self) -> Self;
    /// The measure of the directions that they emit to.
    fn orientation_measure(&self) -> f32;
    /// Prepares their importance.
    fn reach(&self) -> Self::Reach;
}

/// How far the light of emitters reaches.
pub(super) trait Reach: Copy + Debug {
    /// About the light that they send to a point if nothing is in the way.
    fn importance(&self, at: &LightPoint) -> f32;
}

/// Box, cone and power of one emitter or of many.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightBounds {
    pub bounds: Bounds3,
    /// Axis of the cone of normals; unit.
    pub axis: Vec3,
    /// Cosine of the angle about `axis` that contains all normals (θo).
    pub cos_normals: f32,
    /// Cosine of the angle about a normal beyond which nothing is emitted (θe).
    pub cos_emission: f32,
    /// Intensity along the normal, luminance: radiance × area of surfaces.
    pub power: f32,
    /// True when both sides emit.
    pub two_sided: bool,
}

impl LightBounds {
    /// A flat emitter with its normal.
    pub fn flat(bounds: Bounds3, normal: Vec3, power: f32, two_sided: bool) -> Self {
        Self { bounds, axis: normal, cos_normals: 1.0, cos_emission: 0.0, power, two_sided }
    }

    /// An emitter at a point that radiates in all directions.
    pub fn point(p: Vec3, power: f32) -> Self {
        let bounds = Bounds3 { min: p, max: p };
        Self { bounds, axis: Vec3::Z, cos_normals: -1.0, cos_emission: 0.0, power, two_sided: false }
    }

    /// An emitter at a point that radiates within an angle about its axis.
    pub fn cone(p: Vec3, axis: Vec3, power: f32, outer_rad: f32) -> Self {
        // Within the cone the intensity is about uniform: its directions are treated as normals that emit straight ahead.
        Self { axis, cos_normals: outer_rad.clamp(0.0, PI).cos(), cos_emission: STRAIGHT_AHEAD, ..Self::point(p, power) }
    }
}

/// [`LightBounds`] as their importance needs them.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightReach {
    center: Vec3,
    /// Radius of the ball around the box.
    radius: f32,
    axis: Vec3,
    power: f32,
    cos_normals: f32,
    sin_normals: f32,
    cos_emission: f32,
    two_sided: bool,
}

impl Emitters for LightBounds {
    type Reach = LightReach;

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn power(&self) -> f32 {
        self.power
    }

    fn union(&self, other: &Self) -> Self {
        let two_sided = self.two_sided && other.two_sided;
        // Of emitters with two sides either normal will do.
        let other_axis = if two_sided && self.axis.dot(other.axis) < 0.0 { -other.axis } else { other.axis };
        let (axis, cos_normals) = union_of_cones((self.axis, self.cos_normals), (other_axis, other.cos_normals));
        Self {
            bounds: self.bounds.union(other.bounds),
            axis,
            cos_normals,
            cos_emission: self.cos_emission.min(other.cos_emission),
            power: self.power + other.power,
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// Ω of the surface area–orientation heuristic: the measure of the directions that the cone emits to.
    fn orientation_measure(&self) -> f32 {
        let normals = self.cos_normals.clamp(-1.0, 1.0).acos();
        let widest = (normals + self.cos_emission.clamp(-1.0, 1.0).acos()).min(PI);
        let (sin, cos) = normals.sin_cos();
        let measure =
            2.0 * PI * (1.0 - cos) + FRAC_PI_2 * (2.0 * widest * sin - (normals - 2.0 * widest).cos() - 2.0 * normals * sin + cos);
        if self.two_sided { 2.0 * measure } else { measure }
    }

    fn reach(&self) -> LightReach {
        LightReach {
            center: self.bounds.center(),
            radius: 0.5 * self.bounds.extent().length(),
            axis: self.axis,
            power: self.power,
            cos_normals: self.cos_normals,
            sin_normals: sine(self.cos_normals),
            cos_emission: self.cos_emission,
            two_sided: self.two_sided,
        }
    }
}

impl Reach for LightReach {
    /// About the irradiance that the emitters could cast on a point if nothing were in the way; zero only where they cannot.
    ///
    /// All cases are computed and one is selected, without branches, which processors would often foresee wrongly.
    #[inline]
    fn importance(&self, at: &LightPoint) -> f32 {
        let to = self.center - at.p;
        let distance_squared = to.length_squared();
        let radius_squared = self.radius * self.radius;
        let nearness = 1.0 / distance_squared.sqrt();
        let wi = to * nearness;
        // The box spans this angle about its centre.
        let sin_box = self.radius * nearness;
        let cos_box = (1.0 - sin_box * sin_box).max(0.0).sqrt();

        let cos_receiver = at.n.dot(wi);
        let receiver = without((sine(cos_receiver), cos_receiver), (sin_box, cos_box)).1.max(0.0);
        let receiver = if at.n == Vec3::ZERO { 1.0 } else { receiver };

        let cos_axis = -self.axis.dot(wi);
        let cos_axis = if self.two_sided { cos_axis.abs() } else { cos_axis };
        let normal = without((sine(cos_axis), cos_axis), (self.sin_normals, self.cos_normals));
        let (_, cos_emission) = without(normal, (sin_box, cos_box));
        let emitted = if cos_emission > self.cos_emission { cos_emission } else { 0.0 };

        let outside = self.power * emitted * receiver * nearness * nearness;
        if distance_squared <= radius_squared { self.power / radius_squared.max(f32::MIN_POSITIVE) } else { outside }
    }
}

/// Sine and cosine of max(0, a − b), for angles on [0, π] given by their sine and cosine.
#[inline]
fn without(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    let (sin, cos) = (a.0 * b.1 - a.1 * b.0, a.1 * b.1 + a.0 * b.0);
    let positive = a.1 < b.1;
    (if positive { sin } else { 0.0 }, if positive { cos } else { 1.0 })
}

#[inline]
fn sine(cos: f32) -> f32 {
    (1.0 - cos * cos).max(0.0).sqrt()
}

/// The smallest cone (axis, cosine of the half-angle) around two.
fn union_of_cones(a: (Vec3, f32), b: (Vec3, f32)) -> (Vec3, f32) {
    let (angle_a, angle_b) = (a.1.clamp(-1.0, 1.0).acos(), b.1.clamp(-1.0, 1.0).acos());
    let between = a.0.angle_between(b.0);
    if (between + angle_b).min(PI) <= angle_a {
        return a;
    }
    if (between + angle_a).min(PI) <= angle_b {
        return b;
    }
    let angle = 0.5 * (angle_a + between + angle_b);
    let Some(hinge) = a.0.cross(b.0).try_normalize() else { return (a.0, -1.0) };
    if angle >= PI {
        return (a.0, -1.0);
    }
    let axis = Quat::from_axis_angle(hinge, angle - angle_a) * a.0;
    (axis.normalize(), angle.cos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Rng, warp};

    fn direction(rng: &mut Rng) -> Vec3 {
        warp::sphere([rng.next_f32(), rng.next_f32()])
    }

    #[test]
    fn a_union_of_cones_holds_both() {
        let mut rng = Rng::new(3);
        for _ in 0..2000 {
            let cones = [0, 1].map(|_| (direction(&mut rng), (rng.next_f32() * 3.0).cos()));
            let (axis, cos) = union_of_cones(cones[0], cones[1]);
            for (center, limit) in cones {
                let onb = enfilade_math::Onb::from_z(center);
                for _ in 0..20 {
                    let d = onb.to_world(warp::cone([rng.next_f32(), rng.next_f32()], 1.0 - limit));
                    assert!(d.dot(axis) >= cos - 1e-3, "{} below {cos}", d.dot(axis));
                }
            }
        }
    }

    #[test]
    fn importance_is_positive_wherever_light_can_arrive() {
        let mut rng = Rng::new(5);
        for _ in 0..500 {
            let patches: Vec<(Vec3, Vec3)> =
                (0..6).map(|_| (Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()), direction(&mut rng))).collect();
            let leaf = |&(p, n): &(Vec3, Vec3)| LightBounds::flat(Bounds3 { min: p, max: p }, n, 1.0, false);
            let node = patches[1..].iter().fold(leaf(&patches[0]), |all, patch| all.union(&leaf(patch)));
            let at = LightPoint { p: direction(&mut rng) * 2.5 + Vec3::splat(0.5), n: direction(&mut rng) };
            let arriving = patches.iter().any(|(p, n)| (*p - at.p).dot(at.n) > 1e-3 && (at.p - *p).dot(*n) > 1e-3);
            assert!(!arriving || node.reach().importance(&at) > 0.0);
        }
    }
}
