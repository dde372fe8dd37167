//! `KHR_lights_punctual`.
//!
//! Its units are photometric, while emission has none in practice, and converters write watts and numbers without a unit alike. Candela
//! and lux are read as W/sr and W/m², which keeps lights and emitters of one file together. The one exception is Blender's exporter: it
//! multiplies lights, and only them, by 683 lm/W where it is not told otherwise ("Lighting Mode: Standard").

use super::container::Document;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::{Light, SpotFalloff};
use gltf::json::Root;
use gltf::json::extensions::scene::khr_lights_punctual::Type;
use gltf::json::validation::Checked;

/// What Blender's exporter multiplies watts by.
const BLENDER_LUMENS_PER_WATT: f32 = 683.0;

/// The exporter's first version that does so.
const BLENDER_SINCE: [u32; 3] = [3, 4, 40];

/// A file whose brightest light is weaker has not been multiplied: this is a sun of half a watt per square metre or a bulb of six watts
/// if it was, and a lamp of four kilowatts if not.
const BLENDER_BRIGHT: f32 = 300.0;

/// What the strengths of the file's lights are to be divided by: 683 where Blender has multiplied them, which is guessed and told.
pub(super) fn lumens_per_watt(root: &Root, a: &mut Assembly) -> f32 {
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

/// Adds light `index` of the file at a node. Lights shine along the node's −z; a node's scale does not change their strength.
pub(super) fn add(document: &Document, index: usize, node_name: Option<&str>, node: usize, file_from_node: DAffine3, a: &mut Assembly) {
    let lights = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let place = format!("nodes[{node}]");
    let Some(light) = lights.and_then(|l| l.lights.get(index)) else {
        a.warn(place, format!("it refers to light {index}, which does not exist"));
        return;
    };
    if light.range.is_some() {
        a.warn(&place, "the light's range was ignored: light falls off with the square of the distance");
    }
    let own = light.name.as_deref();
    let name = node_name.or(own).map_or_else(|| format!("light_{index}"), str::to_string);
    let strength = Rgb::from(light.color) * (light.intensity / document.lumens_per_watt);
    let position = file_from_node.translation.as_vec3();
    let direction = file_from_node.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
    match light.type_ {
        Checked::Valid(Type::Point) => a.push_light(Light::Point { name, position, intensity: strength }),
        Checked::Valid(Type::Spot) => {
            let (inner_rad, outer_rad) =
                light.spot.as_ref().map_or((0.0, std::f32::consts::FRAC_PI_4), |s| (s.inner_cone_angle, s.outer_cone_angle));
            let (inner_rad, falloff) = (inner_rad.min(outer_rad), SpotFalloff::CosineSquare);
            a.push_light(Light::Spot { name, position, direction, intensity: strength, inner_rad, outer_rad, falloff });
        }
        Checked::Valid(Type::Directional) => {
            a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 });
        }
        Checked::Invalid => a.warn(place, format!("light {index} has an unknown type and was left out")),
    }
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
