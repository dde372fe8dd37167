//! Light in parts, by its path to the camera and by its source, for the layers of `enfilade_frame::LIGHT_BY_PATH` and `LIGHT_BY_SOURCE`, and
//! by fixture.

use crate::bsdf::Value;
use crate::light::{Background, LightKind};
use enfilade_math::Rgb;
use std::ops::AddAssign;

/// Origin of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    pub kind: LightKind,
    /// `None` if light is not separated by fixture.
    pub fixture: Option<u16>,
}

/// Light that arrives at a surface along a path.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arriving {
    /// All of it.
    pub total: Rgb,
    /// Light straight from a source, through panes at most.
    direct: Rgb,
    /// By [`LightKind`].
    by_source: [Rgb; 4],
    /// Light of fixtures, one after the other; empty if light is not separated by fixture.
    pub by_fixture: Vec<(u16, Rgb)>,
}

impl Arriving {
    /// Adds light of a source, which is `direct` if only panes are between.
    #[inline]
    pub fn add(&mut self, from: Origin, light: Rgb, direct: bool) {
        self.total += light;
        self.by_source[from.kind as usize] += light;
        if direct {
            self.direct += light;
        }
        if let Some(fixture) = from.fixture {
            self.by_fixture.push((fixture, light));
        }
    }

    /// All of it times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.total *= factor;
        self.direct *= factor;
        self.by_source.iter_mut().for_each(|light| *light *= factor);
        self.by_fixture.iter_mut().for_each(|(_, light)| *light *= factor);
        self
    }
}

/// Names of the parts in [`LightParts::by_path`], in the order of `enfilade_frame::LIGHT_BY_PATH`.
const DIFFUSE_DIRECT: usize = 0;
const DIFFUSE_INDIRECT: usize = 1;
const SPECULAR: usize = 2;
const TRANSMISSION: usize = 3;
const EMISSION: usize = 4;

/// The light of a sample, or of a pixel, in parts; the parts of either kind sum to all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LightParts {
    /// In the order of `enfilade_frame::LIGHT_BY_PATH`.
    pub by_path: [Rgb; 5],
    /// In the order of `enfilade_frame::LIGHT_BY_SOURCE`, which is the order of [`LightKind`].
    pub by_source: [Rgb; 4],
}

impl LightParts {
    /// Number of parts.
    pub const PARTS: usize = 9;

    /// Words of [`LightParts::to_words`].
    pub const WORDS: usize = 3 * Self::PARTS;

    /// The sums, bit by bit.
    pub fn to_words(self) -> [u32; Self::WORDS] {
        std::array::from_fn(|i| self.part(i / 3)[i % 3].to_bits())
    }

    /// The inverse of [`LightParts::to_words`].
    pub fn from_words(words: &[u32; Self::WORDS]) -> Self {
        let mut parts = Self::default();
        let float = |i: usize| f32::from_bits(words[i]);
        (0..Self::PARTS).for_each(|part| *parts.part_mut(part) = Rgb::new(float(3 * part), float(3 * part + 1), float(3 * part + 2)));
        parts
    }

    /// Part `index` of those by path and then those by source.
    pub fn part(&self, index: usize) -> Rgb {
        if index < self.by_path.len() { self.by_path[index] } else { self.by_source[index - self.by_path.len()] }
    }

    /// A part to be changed, by its index as in [`LightParts::part`].
    pub fn part_mut(&mut self, index: usize) -> &mut Rgb {
        let paths = self.by_path.len();
        if index < paths { &mut self.by_path[index] } else { &mut self.by_source[index - paths] }
    }

    /// Adds what the first surface emits.
    pub fn add_emission(&mut self, emission: Rgb) {
        self.by_path[EMISSION] += emission;
        self.by_source[LightKind::Surfaces as usize] += emission;
    }

    /// Adds what is seen where there is no surface.
    pub fn add_background(&mut self, background: Background) {
        self.by_path[EMISSION] += background.total();
        self.by_source[LightKind::Environment as usize] += background.environment;
        self.by_source[LightKind::Distant as usize] += background.distant;
    }

    /// Adds what the first surface, of this diffuse reflectance, makes of arriving light; `crossed` when that comes through it.
    pub fn add_scattered(&mut self, reflectance: Rgb, weight: &Value, light: &Arriving, crossed: bool) {
        let diffuse = reflectance * weight.diffuse;
        let indirect = (light.total - light.direct).map(|v| v.max(0.0));
        self.by_path[DIFFUSE_DIRECT] += diffuse * light.direct;
        self.by_path[DIFFUSE_INDIRECT] += diffuse * indirect;
        self.by_path[if crossed { TRANSMISSION } else { SPECULAR }] += weight.specular * light.total;
        let total = diffuse + weight.specular;
        self.by_source.iter_mut().zip(light.by_source).for_each(|(sum, light)| *sum += total * light);
    }
}

impl AddAssign<&LightParts> for LightParts {
    fn add_assign(&mut self, other: &LightParts) {
        (0..Self::PARTS).for_each(|index| *self.part_mut(index) += other.part(index));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightKind::{Environment, Surfaces};

    #[test]
    fn both_kinds_of_parts_sum_to_the_whole() {
        let mut light = Arriving::default();
        let from = |kind| Origin { kind, fixture: Some(kind as u16) };
        light.add(from(Surfaces), Rgb::new(1.0, 2.0, 3.0), true);
        light.add(from(Environment), Rgb::splat(4.0), false);
        assert_eq!(light.clone().scaled(2.0).by_fixture, [(2, Rgb::new(2.0, 4.0, 6.0)), (0, Rgb::splat(8.0))]);
        let (reflectance, weight) = (Rgb::new(0.5, 0.25, 0.0), Value { diffuse: Rgb::WHITE, specular: Rgb::splat(0.125) });
        let mut parts = LightParts::default();
        parts.add_emission(Rgb::splat(0.5));
        parts.add_scattered(reflectance, &weight, &light.clone().scaled(2.0), true);
        let expected = Rgb::splat(0.5) + weight.total(reflectance) * light.total * 2.0;
        assert_eq!(parts.by_path.into_iter().sum::<Rgb>(), expected);
        assert_eq!(parts.by_source.into_iter().sum::<Rgb>(), expected);
        assert_eq!(parts.by_path[DIFFUSE_DIRECT], Rgb::new(1.0, 1.0, 0.0));
        assert_eq!(parts.by_path[SPECULAR], Rgb::BLACK);
        assert_eq!(LightParts::from_words(&parts.to_words()), parts);
    }

    #[test]
    fn the_order_is_that_of_the_layers() {
        use enfilade_frame::{LIGHT_BY_PATH, LIGHT_BY_SOURCE, Layer};
        let paths = [DIFFUSE_DIRECT, DIFFUSE_INDIRECT, SPECULAR, TRANSMISSION, EMISSION].map(|index| LIGHT_BY_PATH[index]);
        assert_eq!(paths, [Layer::DiffuseDirect, Layer::DiffuseIndirect, Layer::Specular, Layer::Transmission, Layer::Emission]);
        let kinds = [Environment, LightKind::Distant, Surfaces, LightKind::Points].map(|kind| LIGHT_BY_SOURCE[kind as usize]);
        assert_eq!(kinds, [Layer::LightEnvironment, Layer::LightDistant, Layer::LightSurfaces, Layer::LightPoints]);
        assert_eq!(LIGHT_BY_PATH.len() + LIGHT_BY_SOURCE.len(), LightParts::PARTS);
    }
}
