//! Render elements: the layers beside the image.

use super::normalize::linear_frame_buffer;
use super::{add, set_on_settings, set_where_present, text};
use enfilade_vrscene::{Document, Value};

/// A part of the image's light, by V-Ray's number for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColorChannel {
    /// Name in the file that V-Ray writes.
    pub name: &'static str,
    /// V-Ray's number.
    pub alias: i64,
    /// Filters that the light passes rather than light: not tone mapped.
    pub is_filter: bool,
}

const fn light(name: &'static str, alias: i64) -> ColorChannel {
    ColorChannel { name, alias, is_filter: false }
}

/// The parts that Hypersim renders. With A the diffuse filter, S the raw total lighting and R the sum of reflection, refraction,
/// specular, subsurface scattering, self-illumination, caustics, atmosphere and background, the image is A · S + R.
pub const COLOR_CHANNELS: [ColorChannel; 13] = [
    light("VRayAtmosphere", 100),
    ColorChannel { name: "VRayDiffuseFilter", alias: 101, is_filter: true },
    light("VRayReflection", 102),
    light("VRayRefraction", 103),
    light("VRaySelfIllumination", 104),
    light("VRaySpecular", 106),
    light("VRayLighting", 107),
    light("VRayGlobalIllumination", 108),
    light("VRayCaustics", 109),
    light("VRayBackground", 124),
    light("VRayTotalLighting", 129),
    light("VRayRawTotalLighting", 130),
    light("VRaySSS2", 133),
];

/// Unmodified light: 32 bits, linear, nothing clamped, surroundings of a plain known colour, surfaces without transparency.
pub fn prepare_for_layers(scene: &mut Document) {
    set_on_settings(scene, "SettingsEXR", &[("bits_per_channel", Value::Int(32)), ("write_integer_ids", Value::Int(1))]);
    set_on_settings(
        scene,
        "SettingsColorMapping",
        &[
            ("type", Value::Int(0)),
            ("affect_background", Value::Int(1)),
            ("dark_mult", Value::Float(1.0)),
            ("bright_mult", Value::Float(1.0)),
            ("subpixel_mapping", Value::Int(0)),
            ("clamp_output", Value::Int(0)),
            ("adaptation_only", Value::Int(2)),
            ("linearWorkflow", Value::Int(0)),
        ],
    );
    set_on_settings(scene, "SettingsVFB", &linear_frame_buffer());
    set_where_present(scene, "BRDFVRayMtl", &[("reflect_affect_alpha", Value::Int(0))]);
    set_where_present(scene, "MtlWrapper", &[("matte_surface", Value::Int(0))]);
}

/// Position, normals without and with bump, texture coordinates, and the numbers of the entities.
pub fn add_geometry_channels(scene: &mut Document) {
    let sampled = [("VRayPosition", "point"), ("VRayNormal", "normal"), ("VRayNormalBump", "bumpNormal"), ("VRayTexCoord", "uvCoord")];
    for (name, output) in sampled {
        let (sampler, color) = (format!("HYPERSIM_sampler_{name}"), format!("HYPERSIM_color_{name}"));
        add(scene, "TexSampler", &sampler, &[("uv_index", Value::Int(1))]);
        // The sampler puts out vectors, and a render element takes a texture.
        add(scene, "TexVectorToColor", &color, &[("input", Value::Name(format!("{sampler}::{output}").into_bytes()))]);
        let parameters = [
            ("name", text(name)),
            ("consider_for_aa", Value::Int(0)),
            ("affect_matte_objects", Value::Int(1)),
            ("filtering", Value::Int(0)),
            ("force_32_bit_output", Value::Int(1)),
            ("texmap", Value::Name(color.into_bytes())),
        ];
        add(scene, "RenderChannelExtraTex", &format!("HYPERSIM_channel_{name}"), &parameters);
    }
    add(scene, "RenderChannelNodeID", "HYPERSIM_channel_VRayRenderEntityID", &[("name", text("VRayRenderEntityID"))]);
}

/// The parts of the image's light.
pub fn add_color_channels(scene: &mut Document) {
    for channel in COLOR_CHANNELS {
        let parameters = [
            ("name", text(channel.name)),
            ("alias", Value::Int(channel.alias)),
            ("color_mapping", Value::Int(i64::from(!channel.is_filter))),
            ("consider_for_aa", Value::Int(0)),
            ("filtering", Value::Int(1)),
            ("denoise", Value::Int(0)),
        ];
        add(scene, "RenderChannelColor", &format!("HYPERSIM_channel_{}", channel.name), &parameters);
    }
}

/// Adds the channels for V-Ray's denoiser; it is run afterwards, if at all.
pub fn add_denoiser(scene: &mut Document) {
    let parameters = [
        ("name", text("VRayDenoiser")),
        ("engine", Value::Int(0)),
        ("mode", Value::Int(0)),
        ("type", Value::Int(0)),
        ("preset", Value::Int(1)),
        ("strength", Value::Float(1.0)),
        ("radius", Value::Float(10.0)),
        ("use_gpu", Value::Int(0)),
    ];
    add(scene, "RenderChannelDenoiser", "HYPERSIM_channel_VRayDenoiser", &parameters);
}
