//! The published network of Open Image Denoise, by our own kernels.
//!
//! A U-Net (Ronneberger et al. 2015) of convolutions by 3×3 pixels with rectifiers: four levels down, each with half the pixels of
//! the one before, and up again, each level beside what it had on the way down. It sees radiance as [`transfer`] encodes it,
//! reflectance and normals. Weights are in `data/`; [`winograd`] is the arithmetic.

mod block;
mod convolution;
mod instructions;
mod simd;
mod tiles;
mod transfer;
mod weights;
mod winograd;

use crate::Noisy;
use block::{Block, LANES, Shape, Tensor};
use convolution::{Convolution, Kept, Source};
pub use instructions::Instructions;
use rayon::prelude::*;
use tiles::{Span, spans};
use transfer::Transfer;
use weights::Weights;

/// For high dynamic range, with reflectance and normals that are free of noise; the large one of two, as the library takes at high
/// quality.
const WEIGHTS: &[u8] = include_bytes!("../../data/rt_hdr_calb_cnrm_large.tza");
/// Its name, as it stands in records.
pub(crate) const NAME: &str = "built-in (rt_hdr_calb_cnrm_large of Open Image Denoise 2)";

/// Channels that the network sees: radiance, reflectance, normal.
const CHANNELS: usize = 9;
/// Pixels that a pixel of the coarsest level covers per side.
const COARSEST: usize = 16;
/// Most pixels per side that are filtered at a time.
const MOST: usize = 1536;

/// The network, with its weights as the kernels read them.
pub(crate) struct Network {
    instructions: Instructions,
    /// Two layers per level, from the finest on; the second is pooled.
    down: [[Convolution; 2]; 4],
    bottom: [Convolution; 2],
    /// Two layers per level, from the coarsest on; the first reads what was pooled on the way down too.
    up: [[Convolution; 2]; 4],
    last: Convolution,
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
        let two = |level: &str| Ok::<_, String>([layer(&weights, &format!("{level}a"))?, layer(&weights, &format!("{level}b"))?]);
        Ok(Self {
            instructions,
            down: [two("enc_conv1")?, two("enc_conv2")?, two("enc_conv3")?, two("enc_conv4")?],
            bottom: two("enc_conv5")?,
            up: [two("dec_conv4")?, two("dec_conv3")?, two("dec_conv2")?, two("dec_conv1")?],
            last: layer(&weights, "dec_conv1c")?,
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

    /// What the network makes of its input.
    fn values(&self, input: Tensor) -> Tensor {
        let one = |layer: &Convolution, tensor: &Tensor, kept| layer.apply(self.instructions, &[Source { tensor, doubled: false }], kept);
        let mut passed = Vec::new();
        let mut x = input;
        for [first, second] in &self.down {
            let inner = one(first, &x, Kept::All);
            passed.push(std::mem::replace(&mut x, one(second, &inner, Kept::Greatest)));
        }
        for layer in &self.bottom {
            x = one(layer, &x, Kept::All);
        }
        for [first, second] in &self.up {
            let beside = passed.pop().expect("as many levels up as down");
            let sources = [Source { tensor: &x, doubled: true }, Source { tensor: &beside, doubled: false }];
            let inner = first.apply(self.instructions, &sources, Kept::All);
            drop(beside);
            x = one(second, &inner, Kept::All);
        }
        one(&self.last, &x, Kept::All)
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
            // `max` gives the other number for NaN.
            let albedo = of(noisy.albedo).map(|value| value.max(0.0).min(1.0));
            let number = |value: f32| if value.is_nan() { 0.0 } else { value };
            let normal = of(noisy.normal).map(|value| number(value).clamp(-1.0, 1.0) * 0.5 + 0.5);
            let mut values = [0.0; LANES];
            for (i, part) in [color, albedo, normal].iter().enumerate() {
                values[3 * i..3 * i + 3].copy_from_slice(part);
            }
            *pixel = Block(values);
        }
    });
    tensor
}
