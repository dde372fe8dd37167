//! `KHR_lights_punctual`: point, spot and directional lights at the place of their node; `lumens.rs` determines their units.

use super::container::Document;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::{Light, SpotFalloff};
use gltf::json::extensions::scene::khr_lights_punctual::Type;
use gltf::json::validation::Checked;

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
        Checked::Valid(Type::Point) => a.push_light_at(file_from_node.translation, Light::Point { name, position, intensity: strength }),
        Checked::Valid(Type::Spot) => {
            let (inner_rad, outer_rad) =
                light.spot.as_ref().map_or((0.0, std::f32::consts::FRAC_PI_4), |s| (s.inner_cone_angle, s.outer_cone_angle));
            let (inner_rad, falloff) = (inner_rad.min(outer_rad), SpotFalloff::CosineSquare);
            a.push_light_at(
                file_from_node.translation,
                Light::Spot { name, position, direction, intensity: strength, inner_rad, outer_rad, falloff },
            );
        }
        Checked::Valid(Type::Directional) => {
            a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 });
        }
        Checked::Invalid => a.warn(place, format!("light {index} has an unknown type and was left out")),
    }
}
