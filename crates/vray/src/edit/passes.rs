//! Hypersim renders every trajectory three times: geometry without light, light caches at low quality, the image.

use super::normalize::linear_frame_buffer;
use super::{remove_kinds, set_on_settings, text};
use enfilade_vrscene::{Document, SceneTextError, Value};

/// Which of the three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// One sample per pixel, no light: positions, normals, entities.
    Geometry,
    /// Indirect light of every frame, kept in files of its own.
    Pre,
    /// The image and the parts of its light, with the light kept by all frames together.
    Final,
}

/// Paths of the light cache (`.vrlmap`) and the irradiance map (`.vrmap`) on the machine that renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GiCaches {
    /// Light that has been reflected more than once.
    pub light_cache: String,
    /// Light that has been reflected once.
    pub irradiance_map: String,
}

/// Which files of indirect light a scene makes when it is rendered with [`Pass::Pre`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GiFiles {
    /// A light cache.
    pub light_cache: bool,
    /// An irradiance map.
    pub irradiance_map: bool,
}

/// The files of indirect light that a scene makes: those of its engines, and none if indirect light is off, the default. Of keyframes the
/// first is used.
///
/// # Errors
/// When a setting cannot be read.
pub fn gi_files(scene: &Document) -> Result<GiFiles, SceneTextError> {
    const IRRADIANCE_MAP: i64 = 0;
    const BRUTE_FORCE: i64 = 2;
    const LIGHT_CACHE: i64 = 3;
    let Some(gi) = scene.of_kind("SettingsGI").last() else { return Ok(GiFiles { light_cache: false, irradiance_map: false }) };
    let number = |name: &str, default: i64| {
        let first = gi.get(name)?.and_then(|value| match value {
            Value::Animated(keys) => keys.first().and_then(|(_, value)| value.number()),
            value => value.number(),
        });
        Ok::<i64, SceneTextError>(first.map_or(default, |number| number as i64))
    };
    let on = number("on", 0)? != 0;
    let (primary, secondary) = (number("primary_engine", IRRADIANCE_MAP)?, number("secondary_engine", BRUTE_FORCE)?);
    Ok(GiFiles { light_cache: on && [primary, secondary].contains(&LIGHT_CACHE), irradiance_map: on && primary == IRRADIANCE_MAP })
}

/// Makes the scene of one pass from the full scene by removing everything that the pass does not need.
pub fn make_pass(scene: &mut Document, pass: Pass, caches: &GiCaches) {
    match pass {
        Pass::Geometry => {
            remove_kinds(scene, &["SettingsGI", "RenderChannelColor", "RenderChannelDenoiser"]);
            reduce_quality(scene);
        }
        Pass::Pre => {
            let geometry = ["RenderChannelExtraTex", "RenderChannelRenderID", "RenderChannelNodeID"];
            remove_kinds(scene, &[geometry.as_slice(), &["RenderChannelColor", "RenderChannelDenoiser"]].concat());
            reduce_quality(scene);
            save_gi_caches(scene, caches);
        }
        Pass::Final => {
            remove_kinds(scene, &["RenderChannelExtraTex", "RenderChannelRenderID", "RenderChannelNodeID"]);
            load_gi_caches(scene, caches);
        }
    }
}

/// One sample in the middle of every pixel.
pub fn reduce_quality(scene: &mut Document) {
    let sampler = [
        ("type", Value::Int(0)),
        ("fixed_subdivs", Value::Int(1)),
        ("fixed_per_pixel_filtering", Value::Int(0)),
        ("min_shade_rate", Value::Int(1)),
    ];
    set_on_settings(scene, "SettingsImageSampler", &sampler);
}

/// Pictures of 256×256 pixels, for a quick look.
pub fn reduce_size(scene: &mut Document) {
    set_on_settings(scene, "SettingsOutput", &[("img_width", Value::Int(256)), ("img_height", Value::Int(256))]);
}

/// No tone mapping: what is written is radiance.
pub fn linear_output(scene: &mut Document) {
    set_on_settings(scene, "SettingsColorMapping", &[("type", Value::Int(0)), ("adaptation_only", Value::Int(2))]);
    set_on_settings(scene, "SettingsVFB", &linear_frame_buffer());
}

/// Computes indirect light anew in every frame and keeps it in files.
pub fn save_gi_caches(scene: &mut Document, caches: &GiCaches) {
    let saved = |file: &str| [("mode", Value::Int(0)), ("auto_save", Value::Int(1)), ("auto_save_file", text(file))];
    set_on_settings(scene, "SettingsLightCache", &saved(&caches.light_cache));
    set_on_settings(scene, "SettingsIrradianceMap", &saved(&caches.irradiance_map));
}

/// Takes indirect light from files.
fn load_gi_caches(scene: &mut Document, caches: &GiCaches) {
    let loaded = |file: &str| [("mode", Value::Int(2)), ("auto_save", Value::Int(0)), ("file", text(file))];
    set_on_settings(scene, "SettingsLightCache", &loaded(&caches.light_cache));
    set_on_settings(scene, "SettingsIrradianceMap", &loaded(&caches.irradiance_map));
}
