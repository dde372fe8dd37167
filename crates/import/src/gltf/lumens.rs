//! The units that the strengths of a file's lights are in.
//!
//! Units of `KHR_lights_punctual` are photometric, while emission has none in practice, and converters write watts and numbers without a
//! unit alike. Candela and lux are read as W/sr and W/m², which keeps lights and emitters of one file together. The one exception is
//! Blender's exporter: it multiplies lights, and only them, by 683 lm/W unless set otherwise ("Lighting Mode: Standard").

use crate::assembly::Assembly;
use gltf::json::Root;

/// Factor by which Blender's exporter multiplies watts.
const BLENDER_LUMENS_PER_WATT: f32 = 683.0;

/// The exporter's first version that does so.
const BLENDER_SINCE: [u32; 3] = [3, 4, 40];

/// A file whose brightest light is weaker has not been multiplied: this is a sun of half a watt per square metre or a bulb of six watts
/// if it was, and a lamp of four kilowatts if not.
const BLENDER_BRIGHT: f32 = 300.0;

/// Divisor of the strengths of the file's lights: 683 if Blender has multiplied them, which is guessed, with a warning.
pub(super) fn per_watt(root: &Root, a: &mut Assembly) -> f32 {
    let generator = root.asset.generator.as_deref().unwrap_or_default();
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map_or(&[][..], |l| &l.lights);
    let brightest = lights.iter().map(|l| l.intensity).fold(0.0, f32::max);
    if brightest <= BLENDER_BRIGHT || blender_version(generator).is_none_or(|version| version < BLENDER_SINCE) {
        return 1.0;
    }
    let message = format!(
        "guessed: Blender wrote the lights in its mode \"Standard\", 683 times as strong beside emission as they were, so they were divided \
         by 683 (the brightest has {brightest}); if that is wrong, export with the lighting mode \"Unitless\""
    );
    a.warn("extensions.KHR_lights_punctual", message);
    BLENDER_LUMENS_PER_WATT
}

/// The version in "Khronos glTF Blender I/O v4.5.32".
fn blender_version(generator: &str) -> Option<[u32; 3]> {
    let version = generator.strip_prefix("Khronos glTF Blender I/O v")?.split_whitespace().next()?;
    let mut numbers = version.split('.').map(|n| n.parse::<u32>());
    Some([numbers.next()?.ok()?, numbers.next()?.ok()?, numbers.next()?.ok()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_blender_are_compared_by_number() {
        assert_eq!(blender_version("Khronos glTF Blender I/O v4.5.32"), Some([4, 5, 32]));
        assert!(blender_version("Khronos glTF Blender I/O v1.2.8 with hand-edits").unwrap() < BLENDER_SINCE);
        assert!(blender_version("Khronos glTF Blender I/O v3.10.0").unwrap() > BLENDER_SINCE);
        assert_eq!(blender_version("enfilade 1.0.0"), None);
    }
}
