//! Spheres that a cell aims some of its directions at: small bright places. Bins of directions are too coarse for these, and each point of
//! the cell sees them in another bin; a sphere is the same for all of them.

use enfilade_math::{ONE_MINUS_EPSILON, Onb, Vec3};
use std::f32::consts::TAU;

/// The most spheres that a cell aims at.
pub(super) const MAX_AIMS: usize = 8;
/// The smallest sine of half of a cone's angle: float32 can hardly distinguish the directions of narrower cones.
const MIN_SINE: f32 = 0.005;
/// The largest such sine: spheres in wider cones are too near to be aimed at, and bins are fine enough for them.
const MAX_SINE: f32 = 0.3;

/// A sphere, and the fraction of the directions that go to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    /// World position.
    pub center: Vec3,
    /// Metres.
    pub radius: f32,
    /// Fraction of the directions from points that are far enough from it.
    pub fraction: f32,
}

/// The cone that a sphere is seen in.
#[derive(Clone, Copy, Debug)]
pub(super) struct AimCone {
    /// Unit vector.
    axis: Vec3,
    /// One minus the cosine of half of its angle.
    height: f32,
}

/// The spheres that a cell aims at.
#[derive(Clone, Debug)]
pub(super) struct Aims {
    aims: [Aim; MAX_AIMS],
    count: u32,
}

impl Aim {
    const NONE: Self = Self { center: Vec3::ZERO, radius: 0.0, fraction: 0.0 };

    /// True if `p` is in the sphere.
    pub fn contains(&self, p: Vec3) -> bool {
        p.distance_squared(self.center) <= self.radius * self.radius
    }

    /// The square of its distance from `p`, and of that times the sine of half of the cone's angle; `None` where it is too near.
    #[inline]
    fn far(&self, way: Vec3) -> Option<[f32; 2]> {
        let square = way.length_squared();
        let own = self.radius * self.radius;
        (own < MAX_SINE * MAX_SINE * square).then(|| [square, own.max(MIN_SINE * MIN_SINE * square)])
    }

    /// Cone of the sphere as seen from `p`; `None` where that is too near.
    #[inline]
    pub fn cone(&self, p: Vec3) -> Option<AimCone> {
        let way = self.center - p;
        self.far(way).map(|[square, across]| AimCone { axis: way / square.sqrt(), height: height(across / square) })
    }
}

/// One minus the cosine of an angle below 90°, given the square of its sine: without cancellation.
#[inline]
fn height(sine_2: f32) -> f32 {
    sine_2 / (1.0 + (1.0 - sine_2).sqrt())
}

impl AimCone {
    /// Steradians.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        TAU * self.height
    }

    /// A unit direction, uniform in the cone for `u` uniform on [0,1)².
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        let height = u[0] * self.height;
        let sine = (height * (2.0 - height)).sqrt();
        let (sin, cos) = (TAU * u[1]).sin_cos();
        Onb::from_z(self.axis).to_world(Vec3::new(sine * cos, sine * sin, 1.0 - height)).normalize()
    }
}

impl Aims {
    /// Nothing is aimed at.
    const NONE: Self = Self { aims: [Aim::NONE; MAX_AIMS], count: 0 };

    /// The first [`MAX_AIMS`] of the spheres.
    pub fn new(spheres: impl IntoIterator<Item = Aim>) -> Self {
        let mut aims = Self::NONE;
        for (place, aim) in aims.aims.iter_mut().zip(spheres) {
            *place = aim;
            aims.count += 1;
        }
        aims
    }

    #[inline]
    fn all(&self) -> &[Aim] {
        &self.aims[..self.count as usize]
    }

    /// True if `p` is in one of the spheres.
    pub fn contains(&self, p: Vec3) -> bool {
        self.all().iter().any(|aim| aim.contains(p))
    }

    /// A unit direction from `p` to one of the spheres, and its number, for `u` uniform on [0,1)²; as an error numbers uniform there, for a
    /// direction that is not aimed.
    #[inline]
    pub fn sample(&self, u: [f32; 2], p: Vec3) -> Result<(Vec3, usize), [f32; 2]> {
        let (mut rest, mut left) = (u[0], 1.0);
        for (number, aim) in self.all().iter().enumerate() {
            if aim.far(aim.center - p).is_none() {
                continue;
            }
            if rest < aim.fraction
                && let Some(cone) = aim.cone(p)
            {
                return Ok((cone.sample([rest / aim.fraction, u[1]]), number));
            }
            rest -= aim.fraction;
            left -= aim.fraction;
        }
        Err([(rest / left).min(ONE_MINUS_EPSILON), u[1]])
    }

    /// Density per solid angle with which [`Aims::sample`] finds a direction, and the probability that it aims at none. A direction that
    /// was `sampled` by a sphere's number counts as in its cone even if rounding puts it outside; its weight would be thousands of times
    /// too large otherwise.
    #[inline]
    pub fn pdf(&self, direction: Vec3, p: Vec3, sampled: Option<usize>) -> (f32, f32) {
        let (mut pdf, mut left) = (0.0, 1.0);
        for (number, aim) in self.all().iter().enumerate() {
            let way = aim.center - p;
            let Some([square, across]) = aim.far(way) else { continue };
            left -= aim.fraction;
            let is_inside = way.dot(direction) > 0.0 && way.cross(direction).length_squared() < across;
            if is_inside || sampled == Some(number) {
                pdf += aim.fraction / (TAU * height(across / square));
            }
        }
        (pdf, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    #[test]
    fn directions_come_as_often_as_their_density_says() {
        // Two spheres that overlap, and one that is too near.
        let sphere = |x: f32, radius: f32, fraction: f32| Aim { center: Vec3::new(x, 0.0, 3.0), radius, fraction };
        let aims = Aims::new([sphere(0.0, 0.4, 0.3), sphere(0.5, 0.5, 0.2), sphere(0.0, 2.9, 0.4)]);
        let mut rng = Rng::new(1);
        let n = 100_000;
        let (mut none, mut overlap, mut expected) = (0, 0, 0.0f64);
        let alone = [0, 1].map(|number| Aims::new([aims.aims[number]]));
        let both = |d: Vec3| alone.iter().all(|aims| aims.pdf(d, Vec3::ZERO, None).0 > 0.0);
        let wide = Aim { center: 2.0 * Vec3::Z, radius: 0.5, fraction: 1.0 }.cone(Vec3::ZERO).expect("far enough");
        for _ in 0..n {
            let u = [rng.next_f32(), rng.next_f32()];
            match aims.sample(u, Vec3::ZERO) {
                Ok((d, number)) => {
                    assert!(aims.pdf(d, Vec3::ZERO, Some(number)).0 > 0.0 && (d.length() - 1.0).abs() < 1e-5, "{d:?}");
                    overlap += u32::from(both(d));
                }
                Err(v) => {
                    assert!(v.iter().all(|x| (0.0..1.0).contains(x)));
                    none += 1;
                }
            }
            let d = wide.sample(u);
            expected += f64::from(if both(d) { aims.pdf(d, Vec3::ZERO, None).0 } else { 0.0 } * wide.solid_angle()) / f64::from(n);
        }
        let fraction = |count: u32| f64::from(count) / f64::from(n);
        assert!((fraction(none) - 0.5).abs() < 0.006 && (aims.pdf(Vec3::X, Vec3::ZERO, None).1 - 0.5).abs() < 1e-6, "{none} of {n}");
        assert!(expected > 0.05 && (fraction(overlap) - expected).abs() < 0.006, "{} against {expected}", fraction(overlap));
    }

    #[test]
    fn the_smallest_and_the_nearest_are_aimed_at_without_harm() {
        let far = Aim { center: Vec3::new(0.0, 100.0, 0.0), radius: 0.01, fraction: 0.5 };
        let aims = Aims::new([far]);
        let cone = far.cone(Vec3::ZERO).expect("far enough");
        let mut rng = Rng::new(2);
        let is_inside = |d: Vec3| aims.pdf(d, Vec3::ZERO, None).0 > 0.0;
        let inside = (0..10_000).filter(|_| is_inside(cone.sample([rng.next_f32(), rng.next_f32()]))).count();
        assert!(inside > 9_980, "{inside}");
        // The last directions of the cone may be rounded to beside it, but have its density.
        for edge in 0..10_000 {
            let (direction, number) = aims.sample([0.5 * ONE_MINUS_EPSILON, edge as f32 / 10_000.0], Vec3::ZERO).expect("aimed");
            assert!(aims.pdf(direction, Vec3::ZERO, Some(number)).0 > 1000.0);
        }
        assert!(far.cone(far.center).is_none() && aims.contains(far.center));
        assert!(matches!(aims.sample([0.3, 0.6], far.center), Err([0.3, 0.6])));
    }
}
