//! The lights of a scene.

use super::super::assets::unless_odd;
use super::super::json;
use super::dataset::{Dataset, SCENE};
use super::scene::SceneInstance;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DVec3, Rgb};
use enfilade_scene::{Light, SpotFalloff};
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Default of half the angle of a spot's cone, radians.
const CONE: f32 = std::f32::consts::FRAC_PI_2;

/// A layout of lights.
#[derive(Deserialize)]
struct Layout {
    #[serde(default)]
    lights: BTreeMap<String, Lamp>,
    #[serde(default = "unit")]
    positive_intensity_scale: f64,
}

#[derive(Deserialize)]
struct Lamp {
    #[serde(default)]
    position: DVec3,
    #[serde(default = "down")]
    direction: DVec3,
    #[serde(default = "white")]
    color: DVec3,
    #[serde(default = "unit")]
    intensity: f64,
    #[serde(default)]
    r#type: String,
    #[serde(default)]
    position_model: String,
    spot: Option<Cone>,
}

#[derive(Deserialize)]
struct Cone {
    #[serde(rename = "innerConeAngle")]
    inner: Option<f32>,
    #[serde(rename = "outerConeAngle")]
    outer: Option<f32>,
}

fn unit() -> f64 {
    1.0
}

fn down() -> DVec3 {
    DVec3::NEG_Y
}

fn white() -> DVec3 {
    DVec3::ONE
}

/// Adds the lights of the layout that the scene names, or that is called like the scene.
pub(super) fn add(scene: &SceneInstance, dataset: &Dataset, a: &mut Assembly) -> Result<(), ImportError> {
    let named = scene.default_lighting.as_deref().unwrap_or_default();
    let own = a.file().file_name().map_or(String::new(), |name| name.to_string_lossy().replace(SCENE, ""));
    let flat = "the scene has no lights: habitat-sim shows it evenly lit; give it an environment, or lights of its own";
    if named == "no_lights" {
        a.warn("default_lighting", flat);
        return Ok(());
    }
    let handle = if named.is_empty() { own.as_str() } else { named };
    let found = dataset.lights.find(handle, a);
    let Some(found) = unless_odd(found, "default_lighting", "the layout of lights", a)?.flatten() else {
        let message = if named.is_empty() { flat.to_string() } else { format!("the lights {named:?} are not in the dataset; {flat}") };
        a.warn("default_lighting", message);
        return Ok(());
    };
    let text = Value::Object(found.values).to_string();
    let layout = json::parse::<Layout>(text.as_bytes(), &found.file, "a layout of lights");
    let Some(layout) = unless_odd(layout, "default_lighting", "the layout of lights", a)? else { return Ok(()) };
    let (mut dark, mut elsewhere) = (0, 0);
    for (name, lamp) in layout.lights {
        match lamp.position_model.as_str() {
            "" | "global" => (),
            _ => {
                elsewhere += 1;
                continue;
            }
        }
        let strength = lamp.intensity * layout.positive_intensity_scale;
        if strength > 0.0 { a.push_light(light(name, &lamp, strength)) } else { dark += 1 }
    }
    a.warn("default_lighting", "Habitat's lights have no unit; their strengths were taken as W/sr and W/m²");
    if dark > 0 {
        a.warn("default_lighting", format!("{dark} lights take light away or have none; they were left out"));
    }
    if elsewhere > 0 {
        a.warn("default_lighting", format!("{elsewhere} lights move with the camera or with objects; they were left out"));
    }
    Ok(())
}

fn light(name: String, lamp: &Lamp, strength: f64) -> Light {
    let [r, g, b] = (lamp.color * strength).as_vec3().to_array();
    let (intensity, position) = (Rgb::new(r, g, b), lamp.position.as_vec3());
    let direction = lamp.direction.normalize_or_zero().as_vec3();
    match lamp.r#type.to_lowercase().as_str() {
        "directional" => Light::Directional { name, direction, irradiance: intensity, angular_radius_rad: 0.0 },
        "spot" => {
            let (inner, outer) = lamp.spot.as_ref().map_or((None, None), |cone| (cone.inner, cone.outer));
            let outer_rad = outer.unwrap_or(CONE);
            let inner_rad = inner.unwrap_or(0.0).min(outer_rad);
            Light::Spot { name, position, direction, intensity, inner_rad, outer_rad, falloff: SpotFalloff::CosineSquare }
        }
        _ => Light::Point { name, position, intensity },
    }
}
