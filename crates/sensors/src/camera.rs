//! A camera from radiance to the numbers in its files.

use crate::depth::check_within;
use crate::raw::{Pixels, demosaiced};
use crate::reading::{Data, Reading, Subject};
use crate::{Amount, SensorError};
use enfilade_frame::tonemap::{ToneMap, brightness, encode};
use enfilade_frame::{Layer, Values, f16};
use enfilade_math::Rng;
use image::ExtendedColorType::Rgb8;
use image::ImageEncoder;
use image::codecs::jpeg::JpegEncoder;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Output of a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraFormat {
    /// The layer `color`: linear RGB, radiance times the exposure. Without `full_well_electrons`, `adc_bits` and `mosaic` it is
    /// not clipped.
    #[default]
    Linear,
    /// `color.jpg`: 8 bits.
    Jpg,
    /// `color.png`: 8 bits.
    Png,
    /// `raw.png`: the sensor's own numbers, one per pixel, in 16 bits of grey; red is at even rows and columns, blue at odd ones (RGGB).
    Raw,
}

/// A camera's own path from radiance to files. Lens, shutter and distortion are not part of it: they are rendered.
///
/// Light passes, in this order: vignetting; the exposure; the sensor with shot noise, read noise, mosaic and converter; white balance; the
/// tone curve; sharpening; rounding. All of it acts on `color`, denoised or as rendered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraSensor {
    /// Name of its folder.
    pub name: String,
    /// What the camera outputs.
    #[serde(default)]
    pub format: CameraFormat,
    /// Radiance is multiplied by this, and 1 saturates the sensor. Unless it is given, pictures are exposed as in Hypersim's tone map, by the
    /// 90th percentile of brightness, and `linear` values are as they are.
    #[serde(default)]
    pub exposure: Option<Amount>,
    /// Change of the exposure in stops: factors of two.
    #[serde(default = "Amount::nothing")]
    pub stops: Amount,
    /// How much of the fall-off of light with the fourth power of the cosine to the optical axis is left, 0 to 1.
    #[serde(default = "Amount::nothing")]
    pub vignetting: Amount,
    /// How far the picture's mean is turned to grey, 0 to 1.
    #[serde(default = "Amount::nothing")]
    pub white_balance: Amount,
    /// Electrons of a saturated pixel: shot noise is their Poisson distribution. A camera at ISO 100 has some 20,000, at ISO 1600 some 1,200.
    #[serde(default)]
    pub full_well_electrons: Option<Amount>,
    /// Standard deviation of what the sensor's electronics add, electrons.
    #[serde(default = "Amount::nothing")]
    pub read_noise_electrons: Amount,
    /// Number of bits of the sensor's values.
    #[serde(default)]
    pub adc_bits: Option<u8>,
    /// Every pixel of the sensor sees one colour, and the others are interpolated between its neighbours.
    #[serde(default)]
    pub mosaic: bool,
    /// Power of the displayed values after the gamma curve (1/2.2): above 1 for contrast and dark shadows.
    #[serde(default = "one")]
    pub contrast: Amount,
    /// How much of the difference from the mean of the 3 × 3 pixels around is added.
    #[serde(default = "Amount::nothing")]
    pub sharpening: Amount,
    /// Quality of JPEG, 1 to 100.
    #[serde(default = "quality")]
    pub jpeg_quality: Amount,
}

const fn one() -> Amount {
    Amount::of(1.0)
}

const fn quality() -> Amount {
    Amount::of(92.0)
}

/// Bits of a raw file unless others are given.
const RAW_BITS: u8 = 12;

/// Random values drawn for a frame.
struct Drawn {
    exposure: Option<f64>,
    stops: f64,
    vignetting: f64,
    white_balance: f64,
    full_well: Option<f64>,
    read_noise: f64,
    contrast: f64,
    sharpening: f64,
    jpeg_quality: f64,
}

impl CameraSensor {
    /// The layers that it looks at.
    pub(crate) fn layers(&self) -> Vec<Layer> {
        vec![Layer::Color, Layer::RenderEntityId]
    }

    /// Checks every key.
    pub(crate) fn check(&self) -> Result<(), String> {
        let any = [0.0, f64::INFINITY];
        self.exposure.map_or(Ok(()), |exposure| check_within("exposure", exposure, any))?;
        check_within("stops", self.stops, [-20.0, 20.0])?;
        check_within("vignetting", self.vignetting, [0.0, 1.0])?;
        check_within("white_balance", self.white_balance, [0.0, 1.0])?;
        self.full_well_electrons.map_or(Ok(()), |electrons| check_within("full_well_electrons", electrons, [1.0, f64::INFINITY]))?;
        check_within("read_noise_electrons", self.read_noise_electrons, any)?;
        check_within("adc_bits", Amount::of(f64::from(self.adc_bits.unwrap_or(RAW_BITS))), [1.0, 16.0])?;
        check_within("contrast", self.contrast, [0.05, 20.0])?;
        check_within("sharpening", self.sharpening, any)?;
        check_within("jpeg_quality", self.jpeg_quality, [1.0, 100.0])?;
        if self.full_well_electrons.is_none() && self.read_noise_electrons.bounds()[1] > 0.0 {
            return Err("read_noise_electrons needs full_well_electrons, which says how many electrons white is".into());
        }
        Ok(())
    }

    fn draw(&self, rng: &mut Rng) -> Drawn {
        // Always in the same order, so that an added key does not change the values of others.
        Drawn {
            exposure: drawn_or_none(self.exposure, rng),
            stops: self.stops.draw(rng),
            vignetting: self.vignetting.draw(rng),
            white_balance: self.white_balance.draw(rng),
            full_well: drawn_or_none(self.full_well_electrons, rng),
            read_noise: self.read_noise_electrons.draw(rng),
            contrast: self.contrast.draw(rng),
            sharpening: self.sharpening.draw(rng),
            jpeg_quality: self.jpeg_quality.draw(rng),
        }
    }

    /// The reading for a frame.
    pub(crate) fn sense(&self, subject: &Subject<'_>, mut rng: Rng) -> Result<Reading, SensorError> {
        let drawn = self.draw(&mut rng);
        let mut light = self.arriving(subject, &drawn)?;
        let gains = white_balance(&light, drawn.white_balance);
        let exposure = self.exposure(subject, &light, gains, &drawn)? * drawn.stops.exp2();
        light.par_iter_mut().for_each(|rgb| *rgb = rgb.map(|v| (f64::from(v) * exposure) as f32));
        let columns = vec![
            ("exposure", exposure),
            ("vignetting", drawn.vignetting),
            ("white_balance_red", gains[0]),
            ("white_balance_green", gains[1]),
            ("white_balance_blue", gains[2]),
            ("full_well_electrons", drawn.full_well.unwrap_or(f64::INFINITY)),
            ("read_noise_electrons", drawn.read_noise),
            ("contrast", drawn.contrast),
            ("sharpening", drawn.sharpening),
            ("jpeg_quality", drawn.jpeg_quality),
        ];
        let data = self.developed(subject, light, gains, &drawn, &rng.fork(0));
        Ok(Reading { drawn: columns, data })
    }

    /// Radiance after the lens.
    fn arriving(&self, subject: &Subject<'_>, drawn: &Drawn) -> Result<Vec<[f32; 3]>, SensorError> {
        let color = subject.layer(&self.name, Layer::Color)?;
        let pixel = |i: usize| {
            let rgb = [0, 1, 2].map(|c| color.get(3 * i + c) as f32);
            if drawn.vignetting == 0.0 {
                return rgb;
            }
            let cosine = subject.ray(i).map_or(1.0, |ray| ray.dot(subject.projection.image_axis()).max(0.0));
            let left = 1.0 - drawn.vignetting + drawn.vignetting * cosine.powi(4);
            rgb.map(|v| (f64::from(v) * left) as f32)
        };
        Ok(enfilade_parallel::map_up_to(subject.frame.pixels(), pixel))
    }

    /// The factor of radiance, before stops.
    fn exposure(&self, subject: &Subject<'_>, light: &[[f32; 3]], gains: [f64; 3], drawn: &Drawn) -> Result<f64, SensorError> {
        if let Some(exposure) = drawn.exposure {
            return Ok(exposure);
        }
        if self.format == CameraFormat::Linear {
            return Ok(1.0);
        }
        let ids = subject.layer(&self.name, Layer::RenderEntityId)?;
        let balanced = |rgb: &[f32; 3]| brightness([0, 1, 2].map(|c| f64::from(rgb[c]) * gains[c]));
        let valid = light.iter().enumerate().filter(|(i, _)| ids.get(*i) != -1.0);
        Ok(ToneMap::fit(valid.map(|(_, rgb)| balanced(rgb)).collect()).scale)
    }

    /// From exposed light to what is written.
    fn developed(&self, subject: &Subject<'_>, light: Vec<[f32; 3]>, gains: [f64; 3], drawn: &Drawn, rng: &Rng) -> Data {
        let size = subject.size();
        let has_sensor = drawn.full_well.is_some() || self.adc_bits.is_some() || self.format != CameraFormat::Linear;
        let bits = self.adc_bits.or(Some(RAW_BITS).filter(|_| self.format == CameraFormat::Raw));
        let pixels = Pixels { full_well: drawn.full_well, read_noise: drawn.read_noise, bits };
        if self.format == CameraFormat::Raw {
            let largest = f64::from((1u32 << bits.unwrap_or(RAW_BITS)) - 1);
            let values: Vec<u16> = pixels.mosaic(size, &light, rng).iter().map(|&v| (f64::from(v) * largest).round() as u16).collect();
            return Data::File { name: "raw.png", bytes: grey_png(size, &values) };
        }
        let sensed = if self.mosaic {
            demosaiced(size, &pixels.mosaic(size, &light, rng))
        } else if has_sensor {
            pixels.all(&light, rng)
        } else {
            light
        };
        let balanced = |rgb: [f32; 3], c: usize| f64::from(rgb[c]) * gains[c];
        if self.format == CameraFormat::Linear {
            let values = sensed.iter().flat_map(|&rgb| [0, 1, 2].map(|c| f16::from_f64(balanced(rgb, c)))).collect();
            return Data::Layer(Layer::Color, Values::F16(values));
        }
        let shown = enfilade_parallel::map(&sensed, |&rgb| [0, 1, 2].map(|c| encode(balanced(rgb, c)).powf(drawn.contrast) as f32));
        let shown = if drawn.sharpening > 0.0 { sharpened(size, &shown, drawn.sharpening as f32) } else { shown };
        let bytes: Vec<u8> = shown.as_flattened().iter().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
        if self.format == CameraFormat::Png {
            return Data::File { name: "color.png", bytes: rgb_png(size, &bytes) };
        }
        Data::File { name: "color.jpg", bytes: jpeg(size, &bytes, drawn.jpeg_quality.round() as u8) }
    }
}

fn drawn_or_none(amount: Option<Amount>, rng: &mut Rng) -> Option<f64> {
    let drawn = amount.unwrap_or(Amount::nothing()).draw(rng);
    amount.map(|_| drawn)
}

/// Factors of red, green and blue that turn the mean to grey by a share of the way; the least is 1, so that what saturates stays white.
fn white_balance(light: &[[f32; 3]], share: f64) -> [f64; 3] {
    if share == 0.0 {
        return [1.0; 3];
    }
    let mut sums = [0.0f64; 3];
    light.iter().for_each(|rgb| (0..3).for_each(|c| sums[c] += f64::from(rgb[c])));
    let grey = brightness(sums);
    let gains = sums.map(|sum| if sum > 1e-3 * grey { (grey / sum).powf(share) } else { 1.0 });
    let least = gains.into_iter().fold(f64::INFINITY, f64::min);
    gains.map(|gain| gain / least)
}

/// A picture whose difference from the mean of the 3 × 3 pixels around is enlarged.
fn sharpened([width, height]: [usize; 2], picture: &[[f32; 3]], amount: f32) -> Vec<[f32; 3]> {
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let mut sum = [0.0f32; 3];
        for v in [y.saturating_sub(1), y, (y + 1).min(height - 1)] {
            for u in [x.saturating_sub(1), x, (x + 1).min(width - 1)] {
                (0..3).for_each(|c| sum[c] += picture[v * width + u][c]);
            }
        }
        [0, 1, 2].map(|c| picture[i][c] + amount * (picture[i][c] - sum[c] / 9.0))
    };
    enfilade_parallel::map_up_to(picture.len(), pixel)
}

fn jpeg([width, height]: [usize; 2], rgb: &[u8], quality: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
    encoder.write_image(rgb, width as u32, height as u32, Rgb8).expect("frames have sides of 1 to 65535 pixels");
    bytes
}

fn rgb_png(size: [usize; 2], rgb: &[u8]) -> Vec<u8> {
    png_file(size, png::ColorType::Rgb, png::BitDepth::Eight, rgb)
}

fn grey_png(size: [usize; 2], values: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    png_file(size, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
}

fn png_file([width, height]: [usize; 2], color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("writing to memory cannot fail");
    writer.write_image_data(data).expect("as many pixels as the header says");
    writer.finish().expect("writing to memory cannot fail");
    bytes
}
