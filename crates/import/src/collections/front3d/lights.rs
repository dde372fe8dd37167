//! The lights of a house: V-Ray's, in JSON.
//!
//! 3D-FRONT's toolbox does not read them. They have the form of programs that write such houses for V-Ray, and of V-Ray's own parameters;
//! missing information is guessed and reported: that `size0` and `size1` are whole sides along the light's x and y (`up_vector`), that a
//! light without `units` is in those of the image, V-Ray's default scale between them and lumens, and the sky around a sun.

use super::super::json::{flag, number, text, vector};
use crate::assembly::{Assembly, orthonormal};
use crate::{ImportError, primitives, spectrum};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::sky::{Daylight, SUN_RADIUS_RAD};
use enfilade_scene::{Light, Material, PartLabel};
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// V-Ray's default of the image's units per lumen, square metre and steradian (`SettingsUnitsInfo.photometric_scale`).
const PHOTOMETRIC_SCALE: f64 = 0.002;
/// Luminous efficacy by which V-Ray turns watts into lumens, lm/W.
const LUMENS_PER_WATT: f64 = 683.0;
/// Candela in a kilo-candela.
const KILO: f64 = 1000.0;
/// Width of the sky's picture, texels.
const SKY_WIDTH: u32 = 1024;
/// Names that a warning gives.
const NAMED: usize = 3;

/// Adds the lights that can be understood, and reports what became of the others.
///
/// # Errors
/// When a mesh of a light is not valid, which its sizes exclude.
pub(super) fn add(lights: &[Value], a: &mut Assembly) -> Result<(), ImportError> {
    let mut lamps = Lamps::default();
    for (i, light) in lights.iter().enumerate() {
        let name = text(light, &["uid"]).map_or_else(|| format!("lights[{i}]"), str::to_string);
        let on = flag(light, &["enabled", "on"]).unwrap_or(true);
        let problem = match text(light, &["nodeType"]).unwrap_or_default().to_ascii_lowercase().as_str() {
            _ if !on => continue,
            "vraylight" => lamps.lamp(light, i, a)?,
            "vraysun" => lamps.sun(light, a),
            _ => Some("are of a kind that is not read"),
        };
        match problem {
            Some(problem) => lamps.left_out.entry(problem).or_default().push(name),
            None => lamps.read += 1,
        }
    }
    lamps.report(a);
    Ok(())
}

#[derive(Default)]
struct Lamps {
    read: usize,
    /// Surfaces whose size was taken as written.
    surfaces: usize,
    suns: usize,
    /// Faults of lights that were left out, and the lights' names.
    left_out: BTreeMap<&'static str, Vec<String>>,
}

impl Lamps {
    /// A light with a surface, or why there is none.
    fn lamp(&mut self, light: &Value, index: usize, a: &mut Assembly) -> Result<Option<&'static str>, ImportError> {
        if flag(light, &["skylightPortal", "skylight_portal"]).unwrap_or(false) {
            return Ok(Some("are portals, which give no light of their own"));
        }
        let Some(position) = vector(light, &["src_position", "position", "pos"]) else {
            return Ok(Some("have no place (src_position)"));
        };
        let [width, height] = [["size0", "width"], ["size1", "height"]].map(|keys| number(light, &keys).unwrap_or(0.0));
        let both = flag(light, &["DoubleSided", "doubleSided", "double_sided"]).unwrap_or(false);
        let shape = match number(light, &["type"]).unwrap_or(0.0) as i64 {
            0 if width > 0.0 && height > 0.0 => rectangle(light, position, width, height),
            2 if width > 0.0 => Some(Shape {
                mesh: primitives::lamp(),
                placement: DAffine3::from_translation(position) * DAffine3::from_scale(DVec3::splat(width)),
                area: 4.0 * PI * width * width,
            }),
            0 | 2 => return Ok(Some("have no size (size0, size1)")),
            _ => return Ok(Some("are domes or meshes")),
        };
        let Some(Shape { mesh, placement, area }) = shape else { return Ok(Some("have no direction")) };
        let Some(radiance) = radiance(light, if both { 2.0 * area } else { area }) else {
            return Ok(Some("have a strength that makes no sense (multiplier, units)"));
        };
        let room = text(light, &["roomId"]).filter(|room| !room.is_empty() && *room != "none");
        let name = room.map_or("light".to_string(), |room| format!("light ({room})"));
        let material = a.push_material(Material { emits_both_sides: both, ..Material::emitter(&name, radiance) });
        let file = a.file().to_path_buf();
        if let Some(mesh) = a.push_mesh(mesh, &file, &format!("lights[{index}]"))? {
            a.push_part(&name, mesh, material, placement, PartLabel::NONE);
        }
        self.surfaces += 1;
        Ok(None)
    }

    /// A sun with its sky, or why there is none.
    fn sun(&mut self, light: &Value, a: &mut Assembly) -> Option<&'static str> {
        let [position, target] = [vector(light, &["src_position"]), vector(light, &["target_position"])];
        let to_sun = position.zip(target).map(|(position, target)| position - target);
        let to_sun = to_sun.or_else(|| vector(light, &["direction"]).map(|direction| -direction));
        let to_sun = to_sun.and_then(|to_sun| a.world_from_file().transform_vector3(to_sun).try_normalize());
        let Some(to_sun) = to_sun else { return Some("have no direction") };
        if to_sun.z <= 0.0 {
            return Some("are suns below the horizon");
        }
        let turbidity = number(light, &["turbidity"]).unwrap_or(3.0).clamp(1.7, 10.0) as f32;
        let daylight = Daylight { to_sun: to_sun.as_vec3(), turbidity, ground_albedo: 0.2 };
        let strength = number(light, &["intensity_multiplier", "multiplier"]).unwrap_or(1.0).max(0.0);
        let exposure = (strength * KILO * PHOTOMETRIC_SCALE) as f32;
        let tint = vector(light, &["filter_Color", "filter_color"]).map_or(Rgb::WHITE, color);
        let size = number(light, &["size_multiplier"]).unwrap_or(1.0).clamp(0.0, 100.0) as f32;
        let image = a.next_image();
        let (picture, environment, _) = daylight.lights(SKY_WIDTH, exposure, image);
        a.push_image(picture);
        a.set_environment(environment, "lights");
        a.push_world_light(Light::Directional {
            name: "sun".into(),
            direction: -daylight.to_sun,
            irradiance: daylight.sun_irradiance() * tint * exposure,
            angular_radius_rad: SUN_RADIUS_RAD * size,
        });
        self.suns += 1;
        None
    }

    fn report(&self, a: &mut Assembly) {
        for (problem, names) in &self.left_out {
            let named = names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
            a.warn("lights", format!("{} lights {problem}, such as {named}; they were left out", names.len()));
        }
        if self.surfaces > 0 {
            let message = format!(
                "{} lights are read as V-Ray's, with 0.002 of the picture's units per lumen; that their sizes are whole sides is guessed",
                self.surfaces
            );
            a.warn("lights", message);
        }
        if self.suns > 0 {
            a.warn("lights", "the sun is computed by the atmosphere of Hillaire 2020, and its sky is guessed");
        }
    }
}

/// A surface that gives light, its placement and its area.
struct Shape {
    mesh: Mesh,
    placement: DAffine3,
    area: f64,
}

/// A rectangle about `position` that faces along the light's direction; `None` where that is no direction.
fn rectangle(light: &Value, position: DVec3, width: f64, height: f64) -> Option<Shape> {
    let direction = vector(light, &["direction"]).unwrap_or(DVec3::NEG_Y).try_normalize()?;
    let up = vector(light, &["up_vector"]).unwrap_or(DVec3::NEG_Z);
    let axes = orthonormal(up, direction).or_else(|| orthonormal(direction.any_orthonormal_vector(), direction))?;
    let sides = DVec3::new(0.5 * width, 0.5 * height, 1.0);
    let placement = DAffine3 { matrix3: axes, translation: position } * DAffine3::from_scale(sides);
    Some(Shape { mesh: primitives::rectangle(), placement, area: width * height })
}

/// The radiance of a surface of `area` square metres, in units of the image; `None` where the strength is none.
fn radiance(light: &Value, area: f64) -> Option<Rgb> {
    let strength = number(light, &["multiplier", "intensity", "power"]).unwrap_or(1.0);
    let hue = match number(light, &["color_temperature", "temperature", "colorTemperature"]) {
        Some(kelvin) if (500.0..=50_000.0).contains(&kelvin) => spectrum::black_body(kelvin),
        _ => vector(light, &["color"]).map_or(Rgb::WHITE, color),
    };
    let power = |lumens: f64| lumens * PHOTOMETRIC_SCALE / (PI * area);
    let value = match number(light, &["units"]).unwrap_or(0.0) as i64 {
        // In the image's units V-Ray keeps the largest channel of a temperature's colour, in others its luminance.
        0 => return strength.is_finite().then(|| hue / hue.max_component().max(f32::MIN_POSITIVE) * strength.max(0.0) as f32),
        1 => power(strength),
        2 => strength * PHOTOMETRIC_SCALE,
        3 => power(strength * LUMENS_PER_WATT),
        4 => strength * LUMENS_PER_WATT * PHOTOMETRIC_SCALE,
        _ => return None,
    };
    (value.is_finite() && value >= 0.0).then(|| hue / hue.luminance().max(f32::MIN_POSITIVE) * value as f32)
}

/// A colour of a light: from 0 to 1, or to 255 where a channel is above 1.
fn color(v: DVec3) -> Rgb {
    let scale = if v.max_element() > 1.0 { 1.0 / 255.0 } else { 1.0 };
    let [r, g, b] = (v.max(DVec3::ZERO) * scale).as_vec3().to_array();
    Rgb::new(r, g, b)
}
