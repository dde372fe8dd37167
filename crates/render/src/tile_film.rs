//! Sums of the samples of a tile's pixels.

use crate::film::PixelSum;
use crate::light_parts::LightParts;
use crate::pixel_sample::PixelSample;
use enfilade_math::Rgb;

/// The film of a tile's pixels, in their order.
pub(crate) struct TileFilm {
    pub sums: Vec<PixelSum>,
    /// Empty unless light is kept in parts.
    pub light_parts: Vec<LightParts>,
    /// For each pixel and then each fixture, the sums of reflectance × illumination and of the residual; empty unless light is separated by
    /// fixture.
    pub fixtures: Vec<[Rgb; 2]>,
    /// Number of fixtures that light is separated by.
    pub fixture_count: usize,
}

impl TileFilm {
    /// Without samples.
    pub fn new(pixels: usize, light_parts: bool, fixture_count: usize) -> Self {
        let light_parts = vec![LightParts::default(); if light_parts { pixels } else { 0 }];
        Self {
            sums: vec![PixelSum::default(); pixels],
            light_parts,
            fixtures: vec![[Rgb::BLACK; 2]; pixels * fixture_count],
            fixture_count,
        }
    }

    /// Adds a sample to a pixel.
    pub fn add(&mut self, pixel: usize, sample: &PixelSample) {
        self.sums[pixel].add(sample);
        if let Some(parts) = self.light_parts.get_mut(pixel) {
            *parts += &sample.parts;
        }
        if self.fixture_count > 0 {
            let own = &mut self.fixtures[pixel * self.fixture_count..][..self.fixture_count];
            for light in &sample.fixtures {
                let [diffuse, residual] = &mut own[usize::from(light.fixture)];
                *diffuse += sample.reflectance * light.illumination;
                *residual += light.residual;
            }
        }
    }

    /// Light of a fixture in each pixel, with the pixel's sum.
    pub fn of_fixture(&self, fixture: usize) -> impl Iterator<Item = (&PixelSum, [Rgb; 2])> {
        self.sums.iter().enumerate().map(move |(pixel, sum)| (sum, self.fixtures[pixel * self.fixture_count + fixture]))
    }
}
