//! Hypersim's settings of the final image: sampling and indirect light, the same for all scenes; and the light of the surroundings.

use super::set_on_settings;
use enfilade_vrscene::{Document, Value};

/// Radiance of the surroundings in Hypersim's scenes: arbitrary, and white after tone mapping.
const SURROUNDINGS: f32 = 4.0;

/// Settings for rays that leave the scene: in the picture, for indirect light, in mirrors, through glass, and from matte objects.
const SURROUNDINGS_OF: [&str; 5] = ["bg", "gi", "reflect", "refract", "secondary_matte"];

/// Hypersim's settings of the image in place of the scene's: progressive sampling to a noise of 0.001 for 300 minutes at most, and an
/// irradiance map and a light cache for indirect light. No light of the scene changes.
pub fn hypersim_quality(scene: &mut Document) {
    set_on_settings(
        scene,
        "SettingsImageSampler",
        &[
            ("type", Value::Int(3)),
            ("min_shade_rate", Value::Int(6)),
            ("progressive_minSubdivs", Value::Int(1)),
            ("progressive_maxSubdivs", Value::Int(24)),
            ("progressive_threshold", Value::Float(0.001)),
            ("progressive_maxTime", Value::Float(300.0)),
        ],
    );
    set_on_settings(scene, "SettingsDMCSampler", &[("subdivs_mult", Value::Float(0.0))]);
    set_on_settings(scene, "SettingsGI", &[("on", Value::Int(1)), ("primary_engine", Value::Int(0)), ("secondary_engine", Value::Int(3))]);
    set_on_settings(scene, "SettingsLightCache", &[("subdivs", Value::Int(1500))]);
    set_on_settings(
        scene,
        "SettingsIrradianceMap",
        &[("min_rate", Value::Int(-3)), ("max_rate", Value::Int(-1)), ("subdivs", Value::Int(50)), ("multipass", Value::Int(1))],
    );
}

/// Hypersim's surroundings: of one plain colour, which lights the scene, where no texture, such as a picture or a sky, makes them.
pub fn hypersim_surroundings(scene: &mut Document) {
    let (color, texture) = (Value::Color([SURROUNDINGS; 3]), Value::AColor([SURROUNDINGS, SURROUNDINGS, SURROUNDINGS, 1.0]));
    let colors = SURROUNDINGS_OF.map(|of| format!("{of}_color"));
    set_on_settings(scene, "SettingsEnvironment", &colors.each_ref().map(|name| (name.as_str(), color.clone())));
    for environment in scene.of_kind_mut("SettingsEnvironment") {
        for name in SURROUNDINGS_OF.map(|of| format!("{of}_tex")) {
            if matches!(environment.get(&name), Ok(None | Some(Value::AColor(_) | Value::Color(_)))) {
                environment.set(&name, &texture);
            }
        }
    }
}
