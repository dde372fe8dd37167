//! Results of a BSDF: its value for a pair of directions, and sampled directions with their weight and density.

use enfilade_math::{Rgb, Vec3};
use std::ops::Mul;

/// The value of a BSDF for a pair of directions, 1/sr, cosine of `wi` included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Value {
    /// Diffuse part for a reflectance of one.
    pub diffuse: Rgb,
    /// Everything else.
    pub specular: Rgb,
}

impl Value {
    /// Sum of diffuse and other light, given the diffuse reflectance.
    #[inline]
    pub fn total(&self, reflectance: Rgb) -> Rgb {
        reflectance * self.diffuse + self.specular
    }
}

impl Mul<f32> for Value {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self { diffuse: self.diffuse * s, specular: self.specular * s }
    }
}

/// How a sampled direction came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// From a density per solid angle: light sampling could have found it too.
    Finite,
    /// One of finitely many directions: light sampling cannot find it.
    Delta,
    /// Straight through a thin pane, like shadow rays: Mitsuba's `Null`.
    Straight,
}

/// A sampled incident direction.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Incident direction.
    pub wi: Vec3,
    /// Value over density.
    pub weight: Value,
    /// Density per solid angle; zero for [`Event::Delta`] and [`Event::Straight`].
    pub pdf: f32,
    /// Kind of the direction.
    pub event: Event,
}

impl Sample {
    /// One of finitely many directions, with its value over its probability.
    #[inline]
    pub(super) fn delta(wi: Vec3, weight: Rgb) -> Self {
        Self { wi, weight: Value { diffuse: Rgb::BLACK, specular: weight }, pdf: 0.0, event: Event::Delta }
    }

    /// The mirror image of `wo` about the shading normal, with its value over its probability.
    #[inline]
    pub(super) fn mirrored(wo: Vec3, weight: Rgb) -> Self {
        Self::delta(Vec3::new(-wo.x, -wo.y, wo.z), weight)
    }
}
