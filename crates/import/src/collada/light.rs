//! Lights and cameras, which nodes place.

use super::document::{Dae, Node, at, called, child, exactly, number, text};
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::{Light, SpotFalloff};
use std::f64::consts::PI;

/// Width over height of pictures of a camera that states no shape.
const ASPECT: f64 = 4.0 / 3.0;

fn float(node: Node, tag: &str) -> Option<f64> {
    number(&text(child(node, tag)?))
}

/// Adds a light at a node, along whose −z it shines.
pub(super) fn add_light(dae: &Dae, light: Node, name: &str, file_from_node: DAffine3, a: &mut Assembly) {
    let kind = child(light, "technique_common").and_then(|t| t.children().find(roxmltree::Node::is_element));
    let Some(kind) = kind else {
        a.warn(called(light), "it has no common technique and was left out");
        return;
    };
    let of_blender = dae.tool().contains("Blender");
    let color = child(kind, "color").and_then(exactly::<3>).unwrap_or([1.0; 3]).map(|c| c as f32);
    let tag = kind.tag_name().name();
    // Blender writes the colour times its watts, which a point sends in all directions.
    let strength = Rgb::from(color) * if of_blender && tag != "directional" { (0.25 / PI) as f32 } else { 1.0 };
    let (name, position) = (name.to_string(), file_from_node.translation.as_vec3());
    let direction = file_from_node.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
    match tag {
        "ambient" => {
            a.warn(called(light), "ambient light has no place and was left out; an environment lights from everywhere");
            return;
        }
        "directional" => a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 }),
        "spot" => {
            let outer_rad = (0.5 * float(kind, "falloff_angle").unwrap_or(180.0).clamp(0.1, 180.0)).to_radians() as f32;
            let light = Light::Spot {
                name,
                position,
                direction,
                intensity: strength,
                inner_rad: outer_rad,
                outer_rad,
                falloff: SpotFalloff::CosineSquare,
            };
            a.push_light_at(file_from_node.translation, light);
        }
        "point" => a.push_light_at(file_from_node.translation, Light::Point { name, position, intensity: strength }),
        other => {
            a.warn(called(light), format!("{other} lights are not supported and were left out"));
            return;
        }
    }
    if !of_blender {
        a.warn("library_lights", "COLLADA states no unit of light; strengths were taken as W/sr and W/m²");
    }
}

/// Adds a camera at a node, along whose −z it looks.
pub(super) fn add_camera(camera: Node, name: &str, file_from_node: DAffine3, a: &mut Assembly) {
    let Some(lens) = at(camera, &["optics", "technique_common", "perspective"]) else {
        a.warn(called(camera), "it is not perspective and was left out");
        return;
    };
    let tan = |tag: &str| float(lens, tag).map(|degrees| (0.5 * degrees).to_radians().tan());
    let (x, y, stated) = (tan("xfov"), tan("yfov"), float(lens, "aspect_ratio").filter(|r| *r > 0.0));
    let (x, y) = match (x, y) {
        (Some(x), Some(y)) => (x, y),
        (Some(x), None) => (x, x / stated.unwrap_or(ASPECT)),
        (None, Some(y)) => (y * stated.unwrap_or(ASPECT), y),
        (None, None) => {
            a.warn(called(camera), "it states no field of view and was left out");
            return;
        }
    };
    a.push_camera(name, file_from_node, 2.0 * x.atan(), x / y);
}
