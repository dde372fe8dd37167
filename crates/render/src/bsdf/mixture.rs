//! Several lobes side by side or in layers: metals blended with dielectrics, sheen and clear-coat on top, blended materials.

use super::layers::Layers;
use super::lobe::Lobe;
use super::sample::{Event, Sample, Value};
use super::sharp::Sharp;
use enfilade_math::{ONE_MINUS_EPSILON, Rgb, Vec3};

/// A lobe and its part in the whole.
#[derive(Clone, Copy, Debug)]
struct Entry<'a> {
    lobe: Lobe<'a>,
    /// Multiplies the lobe's diffuse part: the share of its reflectance in the reflectance of the whole.
    diffuse: Rgb,
    /// Multiplies everything else.
    specular: f32,
    /// Probability of being sampled.
    select: f32,
    /// The layers above it, in [`Mixture::layers`].
    under: Option<u8>,
}

/// A weighted sum of lobes.
#[derive(Clone, Debug, Default)]
pub struct Mixture<'a> {
    entries: Vec<Entry<'a>>,
    layers: Vec<Layers>,
}

/// The most lobes of a material that is no blend, so that its mixture is allocated once.
const USUAL: usize = 6;

impl<'a> Mixture<'a> {
    /// No lobes yet.
    pub fn new() -> Self {
        Self { entries: Vec::with_capacity(USUAL), layers: Vec::new() }
    }

    /// Adds a lobe. `importance` ≥ 0 is an estimate of its albedo; zero leaves it out and must mean zero value.
    pub fn add(&mut self, lobe: Lobe<'a>, diffuse: Rgb, specular: f32, importance: f32) {
        if importance > 0.0 {
            self.entries.push(Entry { lobe, diffuse, specular, select: importance, under: None });
        }
    }

    /// Adds the lobes of another mixture, whose diffuse reflectance is `reflectance`, as the given `fraction` of this one. `diffuse` is the
    /// share of its reflectance in the reflectance of the whole.
    pub fn add_mixture(&mut self, other: &Self, reflectance: Rgb, diffuse: Rgb, fraction: f32, cos_o: f32) {
        let first = self.layers.len() as u8;
        self.layers.extend(&other.layers);
        let (rough, sharp) = other.albedo(cos_o);
        let albedo = (rough.total(reflectance) + sharp.specular).luminance();
        self.entries.extend(other.entries.iter().map(|e| Entry {
            diffuse: e.diffuse * diffuse,
            specular: e.specular * fraction,
            select: e.select * fraction * albedo.max(f32::MIN_POSITIVE),
            under: e.under.map(|index| index + first),
            ..*e
        }));
    }

    /// Lays layers over all lobes so far.
    pub fn cover(&mut self, layers: Layers) {
        let index = self.layers.len() as u8;
        self.layers.push(layers);
        self.entries.iter_mut().for_each(|e| e.under = Some(index));
    }

    /// Turns importances into probabilities, each at least a tenth of the uniform probability, so that every lobe keeps being sampled.
    pub fn finish(&mut self) {
        let total: f32 = self.entries.iter().map(|e| e.select).sum();
        let n = self.entries.len() as f32;
        self.entries.iter_mut().for_each(|e| e.select = 0.9 * e.select / total + 0.1 / n);
    }

    /// True without lobes.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// See [`Lobe::eval_pdf`].
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Value, f32) {
        let mut value = Value::default();
        let mut density = 0.0;
        for e in &self.entries {
            let (v, pdf) = e.lobe.eval_pdf(wo, wi);
            density += e.select * pdf;
            if v == Value::default() {
                continue;
            }
            let passes = self.passes(e, wo, wi);
            value.diffuse += e.diffuse * v.diffuse * passes;
            value.specular += v.specular * (e.specular * passes);
        }
        (value, density)
    }

    /// See [`Lobe::sample`].
    pub fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        // Choose a lobe and renew the random number within its interval.
        let mut choice = u[2];
        let mut index = 0;
        while index + 1 < self.entries.len() && choice >= self.entries[index].select {
            choice -= self.entries[index].select;
            index += 1;
        }
        let entry = self.entries.get(index)?;
        let renewed = (choice / entry.select).min(ONE_MINUS_EPSILON);
        let sample = entry.lobe.sample(wo, [u[0], u[1], renewed])?;
        if sample.event == Event::Finite {
            let (value, pdf) = self.eval_pdf(wo, sample.wi);
            return (pdf > 0.0).then(|| Sample { weight: value * (1.0 / pdf), pdf, ..sample });
        }
        let scale = entry.specular * self.passes(entry, wo, sample.wi) / entry.select;
        Some(Sample { weight: sample.weight * scale, ..sample })
    }

    /// See [`Lobe::albedo`]; the lobes that are rough come first, the others second.
    pub fn albedo(&self, cos_o: f32) -> (Value, Value) {
        let (mut rough, mut sharp) = (Value::default(), Value::default());
        for e in &self.entries {
            let albedo = e.lobe.albedo(cos_o);
            let straight = Vec3::new(0.0, 0.0, cos_o);
            let passes = self.passes(e, straight, straight);
            rough.diffuse += e.diffuse * albedo.diffuse * passes;
            let other = if e.lobe.is_rough() { &mut rough } else { &mut sharp };
            other.specular += albedo.specular * (e.specular * passes);
        }
        (rough, sharp)
    }

    /// See [`super::Bsdf::sharp`].
    pub fn sharp(&self, wo: Vec3) -> Sharp {
        let mut sharp = Sharp::default();
        for e in &self.entries {
            sharp.add(&e.lobe.sharp(wo), e.specular * self.passes(e, wo, wo));
        }
        sharp
    }

    /// Fraction of light that the layers above a lobe let pass.
    #[inline]
    fn passes(&self, entry: &Entry<'_>, wo: Vec3, wi: Vec3) -> f32 {
        entry.under.map_or(1.0, |index| self.layers[usize::from(index)].passes(wo.z, wi.z))
    }
}
