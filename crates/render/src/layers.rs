//! Arranges the resolved pixels of a frame as its layers, with the sentinel values of pixels that show nothing.

use crate::film::{PixelColor, PixelGuides};
use crate::geometry_pass::PixelGeometry;
use crate::light_parts::LightParts;
use enfilade_frame::{FixtureLayers, Frame, LIGHT_BY_PATH, LIGHT_BY_SOURCE, Layer, Validity, Values, f16};

/// One pixel of all rendered layers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pixel {
    pub color: PixelColor,
    pub guides: PixelGuides,
    pub geometry: Option<PixelGeometry>,
}

/// Writes the pixels, given row by row, as layers; where nothing was hit, the layers' sentinels.
pub(crate) fn layers(width: u32, height: u32, pixels: &[Pixel]) -> Frame {
    let color = |f: fn(&PixelColor) -> [f16; 3]| Values::F16(pixels.iter().flat_map(|p| f(&p.color)).collect());
    let guide = |f: fn(&PixelGuides) -> [f16; 3]| Values::F16(pixels.iter().flat_map(|p| f(&p.guides)).collect());
    let nan = [f16::NAN; 3];
    let half = |f: fn(&PixelGeometry) -> [f16; 3], void: [f16; 3]| {
        Values::F16(pixels.iter().flat_map(|p| p.geometry.as_ref().map_or(void, f)).collect())
    };
    let single = |f: fn(&PixelGeometry) -> f32| Values::F32(pixels.iter().map(|p| p.geometry.as_ref().map_or(f32::NAN, f)).collect());

    let mut frame = Frame::new(width, height);
    frame.insert(Layer::Color, color(|c| c.color));
    frame.insert(Layer::DiffuseIllumination, color(|c| c.illumination));
    frame.insert(Layer::DiffuseReflectance, color(|c| c.reflectance));
    frame.insert(Layer::Residual, color(|c| c.residual));
    frame.insert(Layer::NormalFilteredWorld, guide(|g| g.normal));
    frame.insert(Layer::NormalBeyondWorld, guide(|g| g.normal_beyond));
    frame.insert(Layer::ReflectanceBeyond, guide(|g| g.reflectance_beyond));
    frame.insert(Layer::ColorStandardError, Values::F16(pixels.iter().map(|p| p.color.standard_error).collect()));
    frame.insert(Layer::DepthMeters, single(|g| g.distance_m));
    frame.insert(Layer::DepthZMeters, single(|g| g.depth_z_m));
    let position = pixels.iter().flat_map(|p| p.geometry.as_ref().map_or([f32::NAN; 3], |g| g.position)).collect();
    frame.insert(Layer::Position, Values::F32(position));
    frame.insert(Layer::NormalWorld, half(|g| g.normal_world, nan));
    frame.insert(Layer::NormalCam, half(|g| g.normal_cam, nan));
    frame.insert(Layer::NormalBumpWorld, half(|g| g.normal_bump_world, nan));
    frame.insert(Layer::NormalBumpCam, half(|g| g.normal_bump_cam, nan));
    frame.insert(Layer::TexCoord, half(|g| g.tex_coord, [f16::ZERO; 3]));
    frame.insert(Layer::RenderEntityId, Values::I16(pixels.iter().map(|p| p.geometry.as_ref().map_or(-1, |g| g.entity)).collect()));
    frame.insert(Layer::Valid, Values::U8(pixels.iter().map(|p| validity(p) as u8).collect()));
    frame
}

/// Adds the light of the pixels in parts, given row by row.
pub(crate) fn add_light_parts(frame: &mut Frame, pixels: &[[[f16; 3]; LightParts::PARTS]]) {
    for (index, layer) in LIGHT_BY_PATH.into_iter().chain(LIGHT_BY_SOURCE).enumerate() {
        frame.insert(layer, Values::F16(pixels.iter().flat_map(|parts| parts[index]).collect()));
    }
}

/// Adds the light of one more fixture: illumination and residual of the pixels, given row by row.
pub(crate) fn add_fixture(frame: &mut Frame, pixels: &[[[f16; 3]; 2]]) {
    let channels = |part: usize| Values::F16(pixels.iter().flat_map(|light| light[part]).collect());
    frame.push_fixture(FixtureLayers { diffuse_illumination: channels(0), residual: channels(1) });
}

fn validity(pixel: &Pixel) -> Validity {
    match pixel.geometry {
        None => Validity::Void,
        Some(_) if pixel.color.saturated => Validity::Saturated,
        Some(_) if pixel.color.reflectance.iter().all(|&a| a == f16::ZERO) => Validity::NoDiffuse,
        Some(_) => Validity::Valid,
    }
}
