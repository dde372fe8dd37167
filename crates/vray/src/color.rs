//! V-Ray's final pass as the colour layers of a frame.
//!
//! With I the image, A the diffuse filter and S the raw total lighting, the layers are reflectance A, illumination S and residual
//! I − A·S. They are stored as our own are: A within [0, 1], and color from the stored values, so that color = A·S + R to the last bit.
//! Hypersim sums its residual of eight render elements instead; where the file has them, the two are compared.

use crate::error::VrayError;
use crate::exr_file::VrayImage;
use crate::notes::Notes;
use enfilade_frame::{Frame, Layer, Validity, Values, compose, f16};

/// The elements whose sum is Hypersim's residual.
const RESIDUAL: [&str; 8] = [
    "VRayReflection",
    "VRayRefraction",
    "VRaySpecular",
    "VRaySSS2",
    "VRaySelfIllumination",
    "VRayCaustics",
    "VRayAtmosphere",
    "VRayBackground",
];
/// No radiance is larger: a value above becomes this, so that sums stay finite.
const MAX_RADIANCE: f32 = 1e9;
/// A reflectance or a difference of light beyond this share is reported; less is noise and rounding.
const SHARE: f32 = 0.01;
/// Mean difference of the two residuals, relative to the mean image, above which it is reported.
const SUMS_DIFFER: f64 = 0.02;

/// How many values were fixed, by reason.
#[derive(Default)]
struct Fixed {
    no_number: usize,
    negative: usize,
    bright: usize,
    excess: usize,
}

/// One pixel as it is stored.
#[derive(Default)]
struct Pixel {
    color: [f16; 3],
    illumination: [f16; 3],
    reflectance: [f16; 3],
    residual: [f16; 3],
}

/// Adds the colour layers to a frame that has its entities, and the reason codes.
///
/// # Errors
/// When the image, the diffuse filter or the raw total lighting is missing.
pub(crate) fn add_colors(frame: &mut Frame, image: &VrayImage, notes: &mut Notes) -> Result<(), VrayError> {
    let [colors, filters, lights] = ["", "VRayDiffuseFilter", "VRayRawTotalLighting"].map(|name| image.triples(name));
    let (colors, filters, lights) = (colors?, filters?, lights?);
    let mut fixed = Fixed::default();
    let pixels: Vec<Pixel> = (0..colors.len()).map(|i| pixel(colors[i], filters[i], lights[i], &mut fixed)).collect();
    fixed.tell(&image.name(), notes);
    compare_sums(image, &colors, &pixels, notes)?;
    let halves = |of: fn(&Pixel) -> [f16; 3]| Values::F16(pixels.iter().flat_map(of).collect());
    frame.insert(Layer::Color, halves(|p| p.color));
    frame.insert(Layer::DiffuseIllumination, halves(|p| p.illumination));
    frame.insert(Layer::DiffuseReflectance, halves(|p| p.reflectance));
    frame.insert(Layer::Residual, halves(|p| p.residual));
    // V-Ray does not report how much noise is left.
    frame.insert(Layer::ColorStandardError, Values::F16(vec![f16::NAN; pixels.len()]));
    let codes = match frame.get(Layer::RenderEntityId) {
        Some(Values::I16(ids)) => ids.iter().zip(&pixels).map(|(&id, pixel)| validity(id, pixel) as u8).collect(),
        _ => vec![Validity::Void as u8; pixels.len()],
    };
    frame.insert(Layer::Valid, Values::U8(codes));
    Ok(())
}

fn pixel(color: [f32; 3], filter: [f32; 3], light: [f32; 3], fixed: &mut Fixed) -> Pixel {
    let mut out = Pixel::default();
    let radiances = [color, light].map(|values| values.map(|v| fixed.light(v)));
    for c in 0..3 {
        let [image, light] = [radiances[0][c], radiances[1][c]];
        let filter = fixed.light(filter[c]);
        fixed.bright += usize::from(filter > 1.0 + SHARE);
        let reflectance = f16::from_f32(filter.min(1.0));
        // A and S are means over the pixel, so A·S need not be the diffuse light of the image. The product is kept, up to the image itself.
        let diffuse = f64::from(filter) * f64::from(light);
        let image = f64::from(image);
        fixed.excess += usize::from(diffuse > image + f64::from(SHARE) * image.max(f64::from(SHARE)));
        let diffuse = if reflectance > f16::ZERO { diffuse.min(image) } else { 0.0 };
        let light = if reflectance > f16::ZERO { (diffuse / reflectance.to_f64()) as f32 } else { light };
        let stored = compose(reflectance, light, (image - diffuse) as f32);
        (out.color[c], out.illumination[c], out.reflectance[c], out.residual[c]) =
            (stored.color, stored.illumination, reflectance, stored.residual);
    }
    out
}

fn validity(id: i16, pixel: &Pixel) -> Validity {
    let saturated = |values: &[f16; 3]| values.iter().any(|v| *v >= f16::MAX);
    match id {
        -1 => Validity::Void,
        _ if saturated(&pixel.color) || saturated(&pixel.illumination) || saturated(&pixel.residual) => Validity::Saturated,
        _ if pixel.reflectance.iter().all(|&a| a == f16::ZERO) => Validity::NoDiffuse,
        _ => Validity::Valid,
    }
}

/// Compares I − A·S with the sum of the elements that Hypersim's residual is made of, where all of them are there.
fn compare_sums(image: &VrayImage, colors: &[[f32; 3]], pixels: &[Pixel], notes: &mut Notes) -> Result<(), VrayError> {
    let missing: Vec<&str> = RESIDUAL.into_iter().filter(|name| !image.has(name)).collect();
    if !missing.is_empty() {
        notes.add(
            &format!("without {}, so the residual I - A S is not checked against V-Ray's own parts", missing.join(", ")),
            &image.name(),
        );
        return Ok(());
    }
    let mut sums = vec![[0.0f64; 3]; pixels.len()];
    for name in RESIDUAL {
        for (sum, part) in sums.iter_mut().zip(image.triples(name)?) {
            (0..3).for_each(|c| sum[c] += f64::from(part[c]));
        }
    }
    let (mut off, mut whole) = (0.0, 0.0);
    for ((sum, pixel), color) in sums.iter().zip(pixels).zip(colors) {
        for c in (0..3).filter(|&c| sum[c].is_finite() && color[c].is_finite()) {
            off += (sum[c] - pixel.residual[c].to_f64()).abs();
            whole += f64::from(color[c]).abs();
        }
    }
    if off > SUMS_DIFFER * whole {
        let message = "V-Ray's reflection, refraction, specular, SSS, self-illumination, caustics, atmosphere and background do not sum \
            to I - A S; was it rendered with tone mapping or without a render element?";
        notes.add(message, &format!("{} ({:.1} % of the light)", image.name(), 100.0 * off / whole.max(f64::MIN_POSITIVE)));
    }
    Ok(())
}

impl Fixed {
    /// A radiance or reflectance: not negative, and a number.
    fn light(&mut self, v: f32) -> f32 {
        if v.is_nan() {
            self.no_number += 1;
            return 0.0;
        }
        self.negative += usize::from(v < -SHARE * SHARE);
        v.clamp(0.0, MAX_RADIANCE)
    }

    fn tell(&self, place: &str, notes: &mut Notes) {
        notes.count("colours are no numbers and become 0", place, self.no_number.div_ceil(3));
        notes.count("colours are negative and become 0", place, self.negative.div_ceil(3));
        notes.count("the diffuse filter is above 1 and becomes 1, with the same light", place, self.bright.div_ceil(3));
        notes.count("A S is more than the image (by over 1 %) and becomes the image", place, self.excess.div_ceil(3));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored(color: f32, filter: f32, light: f32) -> ([f32; 4], Fixed) {
        let mut fixed = Fixed::default();
        let p = pixel([color; 3], [filter; 3], [light; 3], &mut fixed);
        let again = f16::from_f32(p.reflectance[0].to_f32() * p.illumination[0].to_f32() + p.residual[0].to_f32());
        assert_eq!(again, p.color[0]);
        ([p.reflectance[0], p.illumination[0], p.residual[0], p.color[0]].map(f16::to_f32), fixed)
    }

    #[test]
    fn the_parts_are_the_images() {
        assert_eq!(stored(1.5, 0.5, 2.0).0, [0.5, 2.0, 0.5, 1.5]);
        // Without reflectance the light is kept by itself, and the image is residual.
        assert_eq!(stored(0.25, 0.0, 2.0).0, [0.0, 2.0, 0.25, 0.25]);
        // A filter above 1 keeps its light.
        let (found, fixed) = stored(4.5, 2.0, 2.0);
        assert_eq!((found, fixed.bright), ([1.0, 4.0, 0.5, 4.5], 3));
        // More diffuse light than image: the image counts.
        let (found, fixed) = stored(0.5, 0.5, 2.0);
        assert_eq!((found, fixed.excess), ([0.5, 1.0, 0.0, 0.5], 3));
    }

    #[test]
    fn what_is_no_light_becomes_none_and_is_counted() {
        let (found, fixed) = stored(f32::NAN, 0.5, -1.0);
        assert_eq!((found, fixed.no_number, fixed.negative), ([0.5, 0.0, 0.0, 0.0], 3, 3));
        let (found, _) = stored(f32::INFINITY, 0.5, f32::INFINITY);
        assert!(found.iter().all(|v| v.is_finite()) && found[3] > 65000.0, "{found:?}");
    }
}
