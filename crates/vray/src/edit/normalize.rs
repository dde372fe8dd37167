//! Corrects settings that exporters of different ages wrote differently: frame buffer, photometric scale, gamma of pictures.

use super::{set_on_settings, set_where_present};
use enfilade_vrscene::{Document, SceneTextError, Value};

/// Levels of correction of an exporter's settings; each does everything that the one before does, and more. Hypersim used the first for 414
/// scenes, the second for 33, the third for 35.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Normalization {
    /// The frame buffer corrects no colours and shows them linearly.
    V0,
    /// `V0`, and lights have photometric units as 3ds Max means them.
    V1,
    /// `V1`, and pictures are decoded with gamma 2.2.
    V2,
}

/// Puts right what old exporters wrote.
pub fn normalize(scene: &mut Document, policy: Normalization) {
    set_on_settings(scene, "SettingsVFB", &linear_frame_buffer());
    if policy >= Normalization::V1 {
        set_on_settings(scene, "SettingsUnitsInfo", &[("photometric_scale", Value::Float(0.002094395))]);
    }
    if policy >= Normalization::V2 {
        set_where_present(scene, "BitmapBuffer", &[("gamma", Value::Float(0.4545454))]);
    }
}

/// A frame buffer that leaves colours as they were rendered.
pub(super) fn linear_frame_buffer() -> [(&'static str, Value); 2] {
    [("cc_settings", Value::Int(-1)), ("display_srgb", Value::Int(0))]
}

/// Metres per unit of the scene's coordinates; `None` if the scene does not state it.
///
/// # Errors
/// When the value cannot be read.
pub fn meters_per_asset_unit(scene: &Document) -> Result<Option<f64>, SceneTextError> {
    match scene.of_kind("SettingsUnitsInfo").last() {
        Some(units) => Ok(units.get("meters_scale")?.and_then(|value| value.number())),
        None => Ok(None),
    }
}
