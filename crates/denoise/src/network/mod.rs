//! The published network of Open Image Denoise, by our own kernels.
//!
//! A U-Net (Ronneberger et al. 2015) of convolutions by 3×3 pixels with rectifiers: four levels down, each with half the pixels of
//! the one before, and up again, each level beside what it had on the way down. It sees radiance as [`transfer`] encodes it,
//! reflectance and normals. Weights are in `data/`; [`winograd`] is the arithmetic.

mod block;
mod chain;
mod convolution;
mod fused;
mod instructions;
mod pixels;
mod simd;
mod tiles;
mod transfer;
mod weights;
mod winograd;

#[cfg(test)]
mod tests;

use crate::Noisy;
use block::{Block, LANES, Shape, Tensor};
use chain::chain;
use convolution::{Convolution, Kept, Source, Workshop};
pub use instructions::Instructions;
use rayon::prelude::*;
use tiles::{Span, spans};
use transfer::{Transfer, within};
use weights::Weights;

/// For high dynamic range, with reflectance and normals that are free of noise; the large one of two, as the library takes at high
/// quality.
const WEIGHTS: &[u8] = include_bytes!("../../data/rt_hdr_calb_cnrm_large.tza");
/// Name of the network, as in records.
pub(crate) const NAME: &str = "built-in (rt_hdr_calb_cnrm_large of Open Image Denoise 2)";

/// Channels that the network sees: radiance, reflectance, normal.
const CHANNELS: usize = 9;
/// Pixels that a pixel of the coarsest level covers per side.
const COARSEST: usize = 16;
/// Most pixels per side that are filtered at a time. So memory stays below 1.3 GB.
const MOST: usize = 2048;

/// The network, with its weights as the kernels read them.
pub(crate) struct Network {
    instructions: Instructions,
    /// The layers of each level, from the finest on, of which the last is pooled.
    down: Vec<Vec<Convolution>>,
    bottom: Vec<Convolution>,
    /// The layers of each level, from the coarsest on; the first of each reads what its level had on the way down too.
    up: Vec<Vec<Convolution>>,
    most: usize,
}

impl Network {
    /// The network in the binary.
    pub fn new(instructions: Instructions) -> Self {
        Self::read(WEIGHTS, instructions).expect("the binary holds the weights of the network")
    }

    /// The network of a file of weights.
    fn read(file: &[u8], instructions: Instructions) -> Result<Self, String> {
        let weights = weights::read(file)?;
        let layers = |names: &[&str]| names.iter().map(|name| layer(&weights, name)).collect::<Result<Vec<_>, _>>();
        let levels = |levels: [&[&str]; 4]| levels.into_iter().map(layers).collect::<Result<Vec<_>, _>>();
        Ok(Self {
            instructions,
            down: levels([
                &["enc_conv1a", "enc_conv1b"],
                &["enc_conv2a", "enc_conv2b"],
                &["enc_conv3a", "enc_conv3b"],
                &["enc_conv4a", "enc_conv4b"],
            ])?,
            bottom: layers(&["enc_conv5a", "enc_conv5b"])?,
            up: levels([
                &["dec_conv4a", "dec_conv4b"],
                &["dec_conv3a", "dec_conv3b"],
                &["dec_conv2a", "dec_conv2b"],
                &["dec_conv1a", "dec_conv1b", "dec_conv1c"],
            ])?,
            most: MOST,
        })
    }

    /// Denoises a picture, on the threads of the current pool. See [`crate::Denoiser::filter`].
    pub fn filter(&self, noisy: &Noisy<'_>) -> Vec<f32> {
        let (width, height) = (noisy.width as usize, noisy.height as usize);
        for (name, values) in [("color", noisy.color), ("albedo", noisy.albedo), ("normal", noisy.normal)] {
            assert_eq!(values.len(), 3 * width * height, "{name} of {width}x{height}");
        }
        let mut output = vec![0.0; 3 * width * height];
        if output.is_empty() {
            return output;
        }
        let transfer = Transfer::new(noisy);
        for y in spans(height, self.most) {
            for x in spans(width, self.most) {
                let values = self.values(input(noisy, transfer, &x, &y));
                output.par_chunks_mut(3 * width).enumerate().skip(y.kept.start).take(y.kept.len()).for_each(|(row, output)| {
                    let pixels = &values.row(0, row - y.read.start)[x.kept.start - x.read.start..];
                    for (pixel, output) in pixels.iter().zip(output[3 * x.kept.start..3 * x.kept.end].chunks_exact_mut(3)) {
                        output.iter_mut().zip(pixel.0).for_each(|(output, value)| *output = transfer.decode(value));
                    }
                });
            }
        }
        output
    }

    /// The network's output for an input.
    fn values(&self, input: Tensor) -> Tensor {
        let workshop = Workshop::new(self.instructions);
        let mut passed = Vec::new();
        let mut x = input;
        for layers in &self.down {
            let pooled = chain(&workshop, layers, &[Source { tensor: &x, doubled: false }], Kept::Greatest);
            passed.push(std::mem::replace(&mut x, pooled));
        }
        x = chain(&workshop, &self.bottom, &[Source { tensor: &x, doubled: false }], Kept::All);
        for layers in &self.up {
            let beside = passed.pop().expect("as many levels up as down");
            let sources = [Source { tensor: &x, doubled: true }, Source { tensor: &beside, doubled: false }];
            x = chain(&workshop, layers, &sources, Kept::All);
        }
        x
    }
}

/// A layer by its name.
fn layer(weights: &[Weights], name: &str) -> Result<Convolution, String> {
    let find = |kind: &str| {
        let name = format!("{name}.{kind}");
        weights.iter().find(|weights| weights.name == name).ok_or_else(|| format!("there is no tensor `{name}`"))
    };
    let (kernel, bias) = (find("weight")?, find("bias")?);
    match (&kernel.sizes[..], &bias.sizes[..]) {
        (&[outputs, inputs, 3, 3], &[biases]) if outputs == biases => Ok(Convolution::new(inputs, outputs, &kernel.values, &bias.values)),
        (kernel, bias) => Err(format!("`{name}` has weights {kernel:?} and biases {bias:?}; expected [n, m, 3, 3] and [n]")),
    }
}

/// A part of a picture as the network sees it, filled up with zeros to whole pixels of the coarsest level.
fn input(noisy: &Noisy<'_>, transfer: Transfer, x: &Span, y: &Span) -> Tensor {
    let [width, height] = [&x.read, &y.read].map(|range| range.len().next_multiple_of(COARSEST));
    let mut tensor = Tensor::new(Shape { channels: CHANNELS, width, height });
    let pitch = tensor.shape.pitch();
    tensor.data.par_chunks_mut(pitch).skip(1).zip(y.read.clone()).for_each(|(row, y)| {
        for (pixel, x) in row[1..].iter_mut().zip(x.read.clone()) {
            let first = 3 * (y * noisy.width as usize + x);
            let of = |values: &[f32]| <[f32; 3]>::try_from(&values[first..first + 3]).expect("three values per pixel");
            let color = of(noisy.color).map(|value| transfer.encode(value));
            let albedo = of(noisy.albedo).map(|value| within(value, 0.0, 1.0));
            let normal = of(noisy.normal).map(|value| within(value, -1.0, 1.0) * 0.5 + 0.5);
            let mut values = [0.0; LANES];
            for (i, part) in [color, albedo, normal].iter().enumerate() {
                values[3 * i..3 * i + 3].copy_from_slice(part);
            }
            *pixel = Block(values);
        }
    });
    tensor
}
