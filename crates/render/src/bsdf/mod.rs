//! Scattering at a surface point: `eval`, `sample`, `pdf` over a weighted sum of [`Lobe`]s.
//!
//! Directions are unit vectors in shading space (z = shading normal, facing `wo`), pointing away from the surface. The
//! diffuse part is kept apart and *demodulated* (its value is for a reflectance of one), because the ground truth splits
//! radiance into reflectance × illumination + residual.

pub mod coat;
pub mod fresnel;
pub mod ggx;
mod lobe;
mod resolve;

pub use lobe::{Event, Fresnel, Lobe, thin_reflectance};
pub use resolve::{Inputs, straight_transmittance};

use enfilade_math::{Rgb, Vec3, warp};
use std::sync::LazyLock;

/// What a surface does to light from one direction, cosine included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Value {
    /// Diffuse part for a reflectance of one.
    pub diffuse: Rgb,
    /// Everything else.
    pub specular: Rgb,
}

impl Value {
    /// The whole, given the diffuse reflectance.
    #[inline]
    pub fn total(&self, reflectance: Rgb) -> Rgb {
        reflectance * self.diffuse + self.specular
    }
}

impl std::ops::Mul<f32> for Value {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self { diffuse: self.diffuse * s, specular: self.specular * s }
    }
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
    /// What kind of direction it is.
    pub event: Event,
}

/// A lobe with its weight.
#[derive(Clone, Copy, Debug)]
struct Entry<'a> {
    lobe: Lobe<'a>,
    /// Multiplies the lobe's value (not the diffuse one's: see [`Bsdf::reflectance`]).
    scale: Rgb,
    /// Probability of being sampled.
    select: f32,
    /// True for the clear-coat itself, which its own layer does not dim.
    on_top: bool,
}

/// The most lobes that a material has: glTF's with everything on.
const CAPACITY: usize = 6;

/// Layers above the other lobes, which dim them.
#[derive(Clone, Copy, Debug)]
struct Layers {
    clearcoat: f32,
    sheen: f32,
    sheen_roughness: f32,
}

/// The scattering of one surface point.
#[derive(Clone, Debug)]
pub struct Bsdf<'a> {
    entries: [Entry<'a>; CAPACITY],
    count: usize,
    layers: Option<Layers>,
    /// Diffuse reflectance on [0,1]: what the reflectance layer shows.
    pub reflectance: Rgb,
}

impl<'a> Bsdf<'a> {
    const EMPTY: Entry<'static> = Entry { lobe: Lobe::Diffuse { coat: None }, scale: Rgb::BLACK, select: 0.0, on_top: false };

    /// Absorbs all light.
    pub fn black() -> Self {
        Self { entries: [Self::EMPTY; CAPACITY], count: 0, layers: None, reflectance: Rgb::BLACK }
    }

    /// True when light is never scattered.
    pub fn is_black(&self) -> bool {
        self.count == 0
    }

    /// Adds a lobe. `importance` ≥ 0 is an estimate of its albedo; zero leaves it out of sampling and must mean zero value.
    fn add(&mut self, lobe: Lobe<'a>, scale: Rgb, importance: f32) {
        if importance > 0.0 {
            self.entries[self.count] = Entry { lobe, scale, select: importance, on_top: false };
            self.count += 1;
        }
    }

    /// Turns importances into probabilities, none of them below a tenth of an even share, so that no lobe starves.
    fn finish(&mut self) {
        let total: f32 = self.entries[..self.count].iter().map(|e| e.select).sum();
        let n = self.count as f32;
        for e in &mut self.entries[..self.count] {
            e.select = 0.9 * e.select / total + 0.1 / n;
        }
    }

    /// Value × cosine for light from `wi`; smooth lobes do not take part.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Value {
        let mut value = Value::default();
        let under = self.layers.map_or(1.0, |layers| layers.dimming(wo, wi));
        for e in &self.entries[..self.count] {
            let v = e.lobe.eval(wo, wi) * if e.on_top { 1.0 } else { under };
            if matches!(e.lobe, Lobe::Diffuse { .. }) { value.diffuse += v } else { value.specular += e.scale * v }
        }
        value
    }

    /// Density with which [`Bsdf::sample`] finds `wi`.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.entries[..self.count].iter().map(|e| e.select * e.lobe.pdf(wo, wi)).sum()
    }

    /// Samples an incident direction in rough proportion to the value. `u` is uniform on [0,1)³; `None` absorbs the path.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if self.count == 0 {
            return None;
        }
        // Choose a lobe and renew the random number within its share.
        let mut choice = u[2];
        let mut index = 0;
        while index + 1 < self.count && choice >= self.entries[index].select {
            choice -= self.entries[index].select;
            index += 1;
        }
        let entry = &self.entries[index];
        let renewed = (choice / entry.select).min(enfilade_math::ONE_MINUS_EPSILON);
        let sampled = entry.lobe.sample(wo, [u[0], u[1], renewed])?;
        if sampled.event == Event::Finite {
            let pdf = self.pdf(wo, sampled.wi);
            if pdf <= 0.0 {
                return None;
            }
            let value = self.eval(wo, sampled.wi);
            let weight = Value { diffuse: value.diffuse / pdf, specular: value.specular / pdf };
            return Some(Sample { wi: sampled.wi, weight, pdf, event: Event::Finite });
        }
        let under = if entry.on_top { 1.0 } else { self.layers.map_or(1.0, |layers| layers.dimming(wo, sampled.wi)) };
        let weight = Value { diffuse: Rgb::BLACK, specular: entry.scale * sampled.delta_weight * (under / entry.select) };
        Some(Sample { wi: sampled.wi, weight, pdf: 0.0, event: sampled.event })
    }
}

impl Layers {
    /// Share of light that passes the layers on the way in and out.
    #[inline]
    fn dimming(&self, wo: Vec3, wi: Vec3) -> f32 {
        let coat = |cos: f32| 1.0 - self.clearcoat * fresnel::dielectric(cos.abs().min(1.0), CLEARCOAT_ETA).0;
        let sheen = |cos: f32| 1.0 - self.sheen * sheen_albedo(cos.abs(), self.sheen_roughness).min(1.0);
        let clear = if self.clearcoat > 0.0 { coat(wo.z) * coat(wi.z) } else { 1.0 };
        // glTF's KHR_materials_sheen scales by the smaller of both directions, which keeps reciprocity.
        if self.sheen > 0.0 { clear * sheen(wo.z).min(sheen(wi.z)) } else { clear }
    }
}

/// Index of refraction of glTF's clear-coat.
const CLEARCOAT_ETA: f32 = 1.5;

/// Directional albedo of the sheen lobe, from a table computed once.
fn sheen_albedo(cos: f32, roughness: f32) -> f32 {
    const N: usize = 16;
    static TABLE: LazyLock<[[f32; N]; N]> = LazyLock::new(|| {
        std::array::from_fn(|r| {
            let lobe = Lobe::Sheen { roughness: (r as f32 + 0.5) / N as f32 };
            std::array::from_fn(|c| {
                let cos = (c as f32 + 0.5) / N as f32;
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let n = 2048u32;
                let sum: f32 = (0..n)
                    .filter_map(|i| {
                        let wi = warp::cosine_hemisphere(warp::hammersley(i, n));
                        (wi.z > 0.0).then(|| lobe.eval(wo, wi).r / lobe.pdf(wo, wi))
                    })
                    .sum();
                sum / n as f32
            })
        })
    });
    let cell = |v: f32| {
        let x = (v * N as f32 - 0.5).clamp(0.0, (N - 1) as f32);
        let i = (x as usize).min(N - 2);
        (i, x - i as f32)
    };
    let ((r, fr), (c, fc)) = (cell(roughness), cell(cos));
    let row = |r: usize| TABLE[r][c] * (1.0 - fc) + TABLE[r][c + 1] * fc;
    row(r) * (1.0 - fr) + row(r + 1) * fr
}

#[cfg(test)]
mod tests;
