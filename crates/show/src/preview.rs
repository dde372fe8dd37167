//! A picture of every layer, under Hypersim's names.
//!
//! Radiance-like pictures share the tone map's scale of the frame, so that they can be compared with each other; only `display.jpg` has the
//! exposure of the trajectory, and `color.jpg` and `gamma.jpg` are unscaled, as Hypersim's. `non_lambertian` is color − reflectance ×
//! illumination: under that name the toolkit saves the full reconstruction, which is `tonemap` once more. Pixels without a value are
//! transparent in PNG. Where values are stretched over a range, the range is the preview's note and is written to the PNG's text.

use crate::display::Display;
use crate::exposure::Exposure;
use crate::palette::{LabelPalette, id_color, traits_color, validity_color};
use crate::picture::{Picture, byte, from_pixels, jpeg, png};
use crate::stretch::{self, Stretch};

pub use crate::picture::Preview;
use enfilade_frame::tonemap::{ToneMap, encode};
use enfilade_frame::{Frame, Layer, Pass, Values, f16};

/// A preview that can be made of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreviewSpec {
    /// Folder.
    pub pass: Pass,
    /// Name with extension, as in `frame.IIII.<name>`.
    pub name: &'static str,
    /// The subject of the preview.
    pub subject: Subject,
}

/// The subject of a preview.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Colour through the tone map.
    ToneMapped,
    /// Colour as people see it, see [`Display`].
    Displayed,
    /// Colour clipped to `[0,1]`, linear.
    Clipped,
    /// Colour clipped to `[0,1]`, gamma 1/2.2.
    Gamma,
    /// Reflectance × illumination through the tone map.
    Lambertian,
    /// Colour − reflectance × illumination through the tone map.
    NonLambertian,
    /// |colour − (reflectance × illumination + residual)| through the tone map: black where the identity is satisfied.
    Difference,
    /// The layer in the way that suits it.
    Layer(Layer),
}

const fn spec(pass: Pass, name: &'static str, subject: Subject) -> PreviewSpec {
    PreviewSpec { pass, name, subject }
}

/// Every preview.
pub const PREVIEWS: [PreviewSpec; 55] = [
    spec(Pass::Final, "tonemap.jpg", Subject::ToneMapped),
    spec(Pass::Final, "display.jpg", Subject::Displayed),
    spec(Pass::Final, "color.jpg", Subject::Clipped),
    spec(Pass::Final, "gamma.jpg", Subject::Gamma),
    spec(Pass::Final, "diffuse_reflectance.jpg", Subject::Layer(Layer::DiffuseReflectance)),
    spec(Pass::Final, "diffuse_illumination.jpg", Subject::Layer(Layer::DiffuseIllumination)),
    spec(Pass::Final, "residual.jpg", Subject::Layer(Layer::Residual)),
    spec(Pass::Final, "lambertian.jpg", Subject::Lambertian),
    spec(Pass::Final, "non_lambertian.jpg", Subject::NonLambertian),
    spec(Pass::Final, "diff.jpg", Subject::Difference),
    spec(Pass::Final, "color_standard_error.jpg", Subject::Layer(Layer::ColorStandardError)),
    spec(Pass::Geometry, "color.jpg", Subject::Clipped),
    spec(Pass::Geometry, "gamma.jpg", Subject::Gamma),
    spec(Pass::Geometry, "depth_meters.png", Subject::Layer(Layer::DepthMeters)),
    spec(Pass::Geometry, "depth_z_meters.png", Subject::Layer(Layer::DepthZMeters)),
    spec(Pass::Geometry, "position.png", Subject::Layer(Layer::Position)),
    spec(Pass::Geometry, "normal_world.png", Subject::Layer(Layer::NormalWorld)),
    spec(Pass::Geometry, "normal_cam.png", Subject::Layer(Layer::NormalCam)),
    spec(Pass::Geometry, "normal_bump_world.png", Subject::Layer(Layer::NormalBumpWorld)),
    spec(Pass::Geometry, "normal_bump_cam.png", Subject::Layer(Layer::NormalBumpCam)),
    spec(Pass::Geometry, "tex_coord.png", Subject::Layer(Layer::TexCoord)),
    spec(Pass::Geometry, "render_entity_id.png", Subject::Layer(Layer::RenderEntityId)),
    spec(Pass::Geometry, "valid.png", Subject::Layer(Layer::Valid)),
    spec(Pass::Label, "semantic.png", Subject::Layer(Layer::Semantic)),
    spec(Pass::Label, "semantic_instance.png", Subject::Layer(Layer::SemanticInstance)),
    spec(Pass::Rendered, "color_rendered.jpg", Subject::Layer(Layer::ColorRendered)),
    spec(Pass::Rendered, "diffuse_illumination_rendered.jpg", Subject::Layer(Layer::DiffuseIlluminationRendered)),
    spec(Pass::Rendered, "residual_rendered.jpg", Subject::Layer(Layer::ResidualRendered)),
    spec(Pass::Guides, "normal_filtered_world.jpg", Subject::Layer(Layer::NormalFilteredWorld)),
    spec(Pass::Guides, "normal_beyond_world.jpg", Subject::Layer(Layer::NormalBeyondWorld)),
    spec(Pass::Guides, "reflectance_beyond.jpg", Subject::Layer(Layer::ReflectanceBeyond)),
    spec(Pass::LightParts, "diffuse_direct.jpg", Subject::Layer(Layer::DiffuseDirect)),
    spec(Pass::LightParts, "diffuse_indirect.jpg", Subject::Layer(Layer::DiffuseIndirect)),
    spec(Pass::LightParts, "specular.jpg", Subject::Layer(Layer::Specular)),
    spec(Pass::LightParts, "transmission.jpg", Subject::Layer(Layer::Transmission)),
    spec(Pass::LightParts, "emission.jpg", Subject::Layer(Layer::Emission)),
    spec(Pass::LightParts, "light_environment.jpg", Subject::Layer(Layer::LightEnvironment)),
    spec(Pass::LightParts, "light_distant.jpg", Subject::Layer(Layer::LightDistant)),
    spec(Pass::LightParts, "light_surfaces.jpg", Subject::Layer(Layer::LightSurfaces)),
    spec(Pass::LightParts, "light_points.jpg", Subject::Layer(Layer::LightPoints)),
    spec(Pass::Extra, "material_id.png", Subject::Layer(Layer::MaterialId)),
    spec(Pass::Extra, "base_color.png", Subject::Layer(Layer::BaseColor)),
    spec(Pass::Extra, "metallic.png", Subject::Layer(Layer::Metallic)),
    spec(Pass::Extra, "roughness.png", Subject::Layer(Layer::Roughness)),
    spec(Pass::Extra, "transmission_weight.png", Subject::Layer(Layer::TransmissionWeight)),
    spec(Pass::Extra, "emitted_radiance.png", Subject::Layer(Layer::EmittedRadiance)),
    spec(Pass::Extra, "normal_geometric_world.png", Subject::Layer(Layer::NormalGeometricWorld)),
    spec(Pass::Extra, "surface_traits.png", Subject::Layer(Layer::SurfaceTraits)),
    spec(Pass::Extra, "depth_behind_meters.png", Subject::Layer(Layer::DepthBehindMeters)),
    spec(Pass::Extra, "entity_behind_id.png", Subject::Layer(Layer::EntityBehindId)),
    spec(Pass::Extra, "depth_beyond_meters.png", Subject::Layer(Layer::DepthBeyondMeters)),
    spec(Pass::Extra, "occlusion_boundary.png", Subject::Layer(Layer::OcclusionBoundary)),
    spec(Pass::Extra, "optical_flow.png", Subject::Layer(Layer::OpticalFlow)),
    spec(Pass::Extra, "scene_flow.png", Subject::Layer(Layer::SceneFlow)),
    spec(Pass::Extra, "flow_visibility.png", Subject::Layer(Layer::FlowVisibility)),
];

impl PreviewSpec {
    /// True for previews with the exposure of the whole trajectory: all others can be made from a single frame.
    pub fn of_trajectory(&self) -> bool {
        self.subject == Subject::Displayed
    }

    /// The bytes of the preview's file; `None` when the frame lacks a layer it needs.
    pub fn file(&self, frame: &Frame, exposure: Exposure) -> Option<Vec<u8>> {
        self.file_of_scene(frame, exposure, LabelPalette::usual())
    }

    /// The bytes of the preview's file, with labels in the colours of `palette`.
    pub fn file_of_scene(&self, frame: &Frame, exposure: Exposure, palette: &LabelPalette) -> Option<Vec<u8>> {
        let preview = match self.subject {
            Subject::Layer(layer @ (Layer::Semantic | Layer::SemanticInstance)) => labels(layer, frame.get(layer)?, frame, palette),
            subject => preview(subject, frame, exposure)?,
        };
        let note = Some(preview.note.as_str()).filter(|note| !note.is_empty());
        Some(if self.name.ends_with(".jpg") { jpeg(&preview.picture) } else { png(&preview.picture, note) })
    }
}

impl Subject {
    /// The layers that it is made of.
    pub fn layers(self) -> Vec<Layer> {
        let lambertian = [Layer::Color, Layer::DiffuseReflectance, Layer::DiffuseIllumination];
        match self {
            Self::ToneMapped | Self::Displayed | Self::Clipped | Self::Gamma => vec![Layer::Color],
            Self::Lambertian => lambertian[1..].to_vec(),
            Self::NonLambertian => lambertian.to_vec(),
            Self::Difference => [&lambertian[..], &[Layer::Residual]].concat(),
            Self::Layer(layer) => vec![layer],
        }
    }
}

/// Shows `subject`; `None` when the frame lacks a layer it needs.
pub fn preview(subject: Subject, frame: &Frame, exposure: impl Into<Exposure>) -> Option<Preview> {
    preview_over(subject, frame, exposure, None)
}

/// A preview as by [`preview`], but with values stretched over a given range instead of the frame's own.
pub fn preview_over(subject: Subject, frame: &Frame, exposure: impl Into<Exposure>, stretch: Option<&Stretch>) -> Option<Preview> {
    let Exposure { frame: tone, display } = exposure.into();
    let layer = |layer| frame.get(layer);
    let color = layer(Layer::Color);
    let lambertian = || Some((layer(Layer::DiffuseReflectance)?, layer(Layer::DiffuseIllumination)?));
    let plain = |picture| Some(Preview { picture, note: String::new() });
    match subject {
        Subject::ToneMapped => color.and_then(|c| plain(shown(frame, c, |v| tone.apply(v)))),
        Subject::Displayed => color.and_then(|c| plain(displayed(frame, c, display))),
        Subject::Clipped => color.and_then(|c| plain(shown(frame, c, |v| v))),
        Subject::Gamma => color.and_then(|c| plain(shown(frame, c, encode))),
        Subject::Lambertian => {
            let (a, s) = lambertian()?;
            plain(rgb(frame, |i| tone.apply(a.get(i) * s.get(i))))
        }
        Subject::NonLambertian => {
            let (c, (a, s)) = (color?, lambertian()?);
            plain(rgb(frame, |i| tone.apply(c.get(i) - a.get(i) * s.get(i))))
        }
        Subject::Difference => {
            let (c, (a, s), r) = (color?, lambertian()?, layer(Layer::Residual)?);
            let recomposed = |i| enfilade_frame::f16::from_f32(a.get(i) as f32 * s.get(i) as f32 + r.get(i) as f32).to_f64();
            plain(rgb(frame, |i| tone.apply((c.get(i) - recomposed(i)).abs())))
        }
        Subject::Layer(of) => layer(of).map(|values| layer_preview(of, values, frame, tone, stretch)),
    }
}

fn layer_preview(layer: Layer, values: &Values, frame: &Frame, tone: ToneMap, range: Option<&Stretch>) -> Preview {
    let own = || Stretch::over(stretch::shown_values(layer, values, 1));
    let range = || range.cloned().unwrap_or_else(own);
    let picture = match layer {
        Layer::DepthMeters | Layer::DepthZMeters | Layer::DepthBehindMeters | Layer::DepthBeyondMeters => {
            return stretch::lengths(values, frame, &range());
        }
        Layer::Position | Layer::SceneFlow => return stretch::vectors(values, frame, &range()),
        Layer::OpticalFlow => return stretch::flow(values, frame, &range()),
        Layer::Color
        | Layer::DiffuseIllumination
        | Layer::Residual
        | Layer::ColorRendered
        | Layer::DiffuseIlluminationRendered
        | Layer::ResidualRendered
        | Layer::DiffuseDirect
        | Layer::DiffuseIndirect
        | Layer::Specular
        | Layer::Transmission
        | Layer::Emission
        | Layer::LightEnvironment
        | Layer::LightDistant
        | Layer::LightSurfaces
        | Layer::LightPoints
        | Layer::EmittedRadiance => shown(frame, values, |v| tone.apply(v)),
        Layer::ColorStandardError => shown(frame, values, |v| tone.apply(v)),
        Layer::DiffuseReflectance | Layer::BaseColor | Layer::ReflectanceBeyond => shown(frame, values, encode),
        Layer::NormalWorld
        | Layer::NormalCam
        | Layer::NormalBumpWorld
        | Layer::NormalBumpCam
        | Layer::NormalGeometricWorld
        | Layer::NormalFilteredWorld
        | Layer::NormalBeyondWorld => shown(frame, values, |v| 0.5 * (v + 1.0)),
        Layer::Metallic | Layer::Roughness | Layer::TransmissionWeight => shown(frame, values, |v| v),
        Layer::TexCoord => shown(frame, values, |v| v - v.floor()),
        Layer::RenderEntityId | Layer::MaterialId | Layer::EntityBehindId => ids(frame, values, id_color),
        Layer::Semantic | Layer::SemanticInstance => return labels(layer, values, frame, LabelPalette::usual()),
        Layer::Valid => ids(frame, values, |code| validity_color(code as u8)),
        Layer::SurfaceTraits => ids(frame, values, |bits| traits_color(bits as u8)),
        Layer::OcclusionBoundary => ids(frame, values, |code| [[0; 3], [255; 3], [110; 3]][code.clamp(0, 2) as usize]),
        Layer::FlowVisibility => ids(frame, values, |code| [if code == 0 { 0 } else { 255 }; 3]),
    };
    Preview { picture, note: String::new() }
}

/// Classes or instances in their colours.
fn labels(layer: Layer, values: &Values, frame: &Frame, palette: &LabelPalette) -> Preview {
    let picture = match layer {
        Layer::Semantic => ids(frame, values, |class| palette.class(class)),
        _ => ids(frame, values, |instance| palette.instance(instance)),
    };
    Preview { picture, note: String::new() }
}

/// Each value of a layer as `show` has it; one channel is grey. There are fewer float16 values than an image has pixels, so each of them
/// is shown once.
fn shown(frame: &Frame, values: &Values, show: impl Fn(f64) -> f64) -> Picture {
    let channels = values.len() / frame.pixels().max(1);
    let place = |i: usize| if channels == 1 { i / 3 } else { i };
    match values {
        Values::F16(halves) if halves.len() > usize::from(u16::MAX) => {
            let levels: Vec<Option<u8>> = (0..=u16::MAX).map(|bits| level(show(f16::from_bits(bits).to_f64()))).collect();
            from_levels(frame, |i| levels[usize::from(halves[place(i)].to_bits())])
        }
        _ => rgb(frame, |i| show(values.get(place(i)))),
    }
}

/// Colour as people see it; transparent where a channel is NaN.
fn displayed(frame: &Frame, color: &Values, display: Display) -> Picture {
    from_pixels(frame.width, frame.height, |i| {
        let radiance = [0, 1, 2].map(|c| color.get(3 * i + c));
        match radiance.iter().any(|channel| channel.is_nan()) {
            true => [0; 4],
            false => {
                let [r, g, b] = display.apply(radiance).map(byte);
                [r, g, b, 255]
            }
        }
    })
}

/// Three channels, value by value; transparent where one is NaN.
fn rgb(frame: &Frame, value: impl Fn(usize) -> f64) -> Picture {
    from_levels(frame, |i| level(value(i)))
}

fn level(value: f64) -> Option<u8> {
    (!value.is_nan()).then(|| byte(value))
}

fn from_levels(frame: &Frame, level: impl Fn(usize) -> Option<u8>) -> Picture {
    from_pixels(frame.width, frame.height, |i| match [0, 1, 2].map(|c| level(3 * i + c)) {
        [Some(r), Some(g), Some(b)] => [r, g, b, 255],
        _ => [0; 4],
    })
}

fn ids(frame: &Frame, values: &Values, color: impl Fn(i16) -> [u8; 3]) -> Picture {
    from_pixels(frame.width, frame.height, |i| {
        let [r, g, b] = color(values.get(i) as i16);
        [r, g, b, 255]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom::{self as testroom, pixel_of};

    fn analytic() -> (Frame, ToneMap) {
        let frame = testroom::frame(&testroom::pose());
        let tone = ToneMap::of_frame(&frame).unwrap();
        (frame, tone)
    }

    fn pixel(subject: Subject, part: i16) -> [u8; 4] {
        let (frame, tone) = analytic();
        let i = pixel_of(&frame, part) as u32;
        preview(subject, &frame, tone).unwrap().picture.get_pixel(i % frame.width, i / frame.width).0
    }

    #[test]
    fn every_preview_has_a_file_of_its_kind_and_size() {
        let (frame, tone) = analytic();
        let exposure = Exposure::from(tone);
        let mut names = std::collections::BTreeSet::new();
        for spec in PREVIEWS {
            let file = spec.file(&frame, exposure).unwrap();
            let picture = image::load_from_memory(&file).unwrap();
            assert_eq!((picture.width(), picture.height()), (64, 48), "{}", spec.name);
            assert_eq!(spec.name.ends_with(".png"), file.starts_with(b"\x89PNG"));
            assert!(names.insert((spec.pass == Pass::Final, spec.name)), "{} twice", spec.name);
            assert_eq!(spec.file(&Frame::new(64, 48), exposure), None);
        }
    }

    #[test]
    fn known_values_get_known_colours() {
        let up = [byte(0.5), byte(0.5), 255, 255];
        assert_eq!(pixel(Subject::Layer(Layer::NormalWorld), 1), up);
        assert_eq!(pixel(Subject::Layer(Layer::Semantic), 1), [152, 223, 138, 255]);
        assert_eq!(pixel(Subject::Layer(Layer::Semantic), -1), [0, 0, 0, 255]);
        assert_eq!(pixel(Subject::Layer(Layer::SemanticInstance), 2), [0, 0, 0, 255]);
        assert_eq!(pixel(Subject::Layer(Layer::Valid), -1), [0, 0, 0, 255]);
        assert_eq!(pixel(Subject::Layer(Layer::DepthMeters), -1), [0; 4], "no value, no colour");
        assert_eq!(pixel(Subject::Difference, 1), [0, 0, 0, 255]);
        let reflectance = byte(0.5f64.powf(1.0 / 2.2));
        assert_eq!(pixel(Subject::Layer(Layer::DiffuseReflectance), 1)[0], reflectance);
        assert_eq!(pixel(Subject::Clipped, -1), [255; 4]);
    }

    #[test]
    fn parts_of_the_radiance_share_the_exposure_of_the_whole() {
        let (frame, tone) = analytic();
        let i = 3 * pixel_of(&frame, 1);
        let linear = |layer| frame.get(layer).unwrap().get(i);
        let shown = |v: f64| byte(tone.apply(v));
        assert_eq!(pixel(Subject::ToneMapped, 1)[0], shown(linear(Layer::Color)));
        assert_eq!(pixel(Subject::Layer(Layer::DiffuseIllumination), 1)[0], shown(linear(Layer::DiffuseIllumination)));
        assert_eq!(pixel(Subject::Lambertian, 1)[0], shown(linear(Layer::DiffuseReflectance) * linear(Layer::DiffuseIllumination)));
    }

    #[test]
    fn ranges_are_stated_in_the_note_and_in_the_png() {
        let (frame, tone) = analytic();
        let note = preview(Subject::Layer(Layer::DepthMeters), &frame, tone).unwrap().note;
        assert!(note.ends_with(" m") && note.contains(" to "), "{note}");
        let spec = PREVIEWS.iter().find(|spec| spec.name == "depth_meters.png").unwrap();
        let file = spec.file(&frame, Exposure::from(tone)).unwrap();
        assert!(file.windows(note.len()).any(|w| w == note.as_bytes()));
    }
}
