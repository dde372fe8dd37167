//! What lights a scene: its lamps, surfaces that stand for daylight, and everything else that glows.

use crate::planck;
use enfilade_furniture::{Glow, object_of};
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::{LabelledScene, Light, Part, PartId, Scene};
use std::collections::BTreeMap;
use std::f32::consts::PI;

/// Classes whose glowing surfaces stand for the daylight outside: windows, doors, blinds, curtains.
const DAYLIT: [i16; 4] = [9, 8, 13, 16];
/// Classes whose glowing surfaces show something: televisions and pictures.
const SHOWN: [i16; 2] = [25, 11];
/// Least area of an upright surface without a class that is taken for a window, square metres.
const WINDOW_M2: f32 = 0.5;
/// Largest share of its normal's length that points up or down.
const UPRIGHT: f32 = 0.5;

/// How a part glows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glowing {
    /// Not at all.
    No,
    /// As a part of a lamp, lit or not.
    Lamp,
    /// In place of the daylight behind it.
    Daylight,
    /// As a screen does.
    Other,
}

/// A lamp: everything of one object that glows, or a light at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// Name of its object, part or light.
    pub name: String,
    /// Parts that glow where it is lit.
    pub parts: Vec<PartId>,
    /// Indices of its lights at a point.
    pub lights: Vec<usize>,
}

/// How each part glows, by its material and its class. `daylight` names those that stand for daylight, where it is known.
pub fn glow_of_parts(scene: &LabelledScene, daylight: Option<&[String]>) -> Vec<Glowing> {
    (0..scene.scene.parts.len() as PartId).map(|part| glowing(scene, part, daylight)).collect()
}

/// Whether a part glows, or would if its lamp were lit.
pub fn glows(scene: &Scene, part: PartId) -> bool {
    let material = &scene.materials[scene.parts[part as usize].material as usize];
    !material.emission.factor.is_black() || Glow::of_material(&material.name).is_some()
}

fn glowing(scene: &LabelledScene, id: PartId, daylight: Option<&[String]>) -> Glowing {
    let (class, scene) = (scene.labels.parts[id as usize].semantic, &scene.scene);
    let part = &scene.parts[id as usize];
    let material = &scene.materials[part.material as usize];
    if Glow::of_material(&material.name).is_some() {
        return Glowing::Lamp;
    }
    let is_named = |names: &[String]| names.iter().any(|name| [&part.name, &material.name].into_iter().any(|known| matches(name, known)));
    match daylight {
        _ if !glows(scene, id) => Glowing::No,
        Some(names) if is_named(names) => Glowing::Daylight,
        None if DAYLIT.contains(&class) || class < 1 && is_upright(scene, part) => Glowing::Daylight,
        _ if SHOWN.contains(&class) || material.name.contains("screen") => Glowing::Other,
        _ => Glowing::Lamp,
    }
}

/// Whether a part is a large upright surface, as the windows are that stand for the sky in files without one.
fn is_upright(scene: &Scene, part: &Part) -> bool {
    let triangles = 0..scene.meshes[part.mesh as usize].triangles.len();
    let normals = triangles.map(|triangle| {
        let [a, b, c] = scene.world_corners(part, triangle);
        0.5 * (b - a).cross(c - a)
    });
    let (sum, area) = normals.fold((Vec3::ZERO, 0.0), |(sum, area), n| (sum + n, area + n.length()));
    area >= WINDOW_M2 && sum.length() > 0.4 * area && sum.z.abs() < UPRIGHT * sum.length()
}

/// Whether a name is meant by a pattern in which `*` is any run of characters.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => name
            .strip_prefix(start)
            .is_some_and(|tail| (0..=tail.len()).filter(|&i| tail.is_char_boundary(i)).any(|i| matches(rest, &tail[i..]))),
    }
}

/// The lamps of a scene: those of parts first, in the order of these.
pub fn lamps(scene: &LabelledScene, glow: &[Glowing]) -> Vec<Lamp> {
    let mut lamps: Vec<Lamp> = Vec::new();
    let mut known: BTreeMap<(bool, u32), usize> = BTreeMap::new();
    for part in (0..scene.scene.parts.len() as PartId).filter(|&part| glow[part as usize] == Glowing::Lamp) {
        let instance = scene.labels.parts[part as usize].instance;
        let key = if instance >= 1 { (true, instance as u32) } else { (false, scene.scene.object_of(part)) };
        let lamp = *known.entry(key).or_insert_with(|| {
            lamps.push(Lamp { name: thing_name(&scene.scene, part), parts: Vec::new(), lights: Vec::new() });
            lamps.len() - 1
        });
        lamps[lamp].parts.push(part);
    }
    for (index, light) in scene.scene.lights.iter().enumerate().filter(|(_, light)| !matches!(light, Light::Directional { .. })) {
        let of = light.name().split_once('/').map(|(object, _)| object);
        match lamps.iter_mut().find(|lamp| of == Some(lamp.name.as_str())) {
            Some(lamp) => lamp.lights.push(index),
            None => lamps.push(Lamp { name: light.name().into(), parts: Vec::new(), lights: vec![index] }),
        }
    }
    lamps
}

/// Name of the thing that a part belongs to: its object, or its own up to the slash.
pub fn thing_name(scene: &Scene, part: PartId) -> String {
    let part = &scene.parts[part as usize];
    let named = part.object.map(|object| scene.objects[object as usize].name.as_str()).filter(|name| !name.is_empty());
    named.unwrap_or_else(|| object_of(&part.name)).to_string()
}

/// The luminous flux that a lamp gave off in the first scene, or would have if it had been lit; kilo-lumens where `measure` gives kcd.
pub fn flux(scene: &Scene, lamp: &Lamp, measure: &dyn Fn(Rgb) -> Rgb) -> f32 {
    let of_part = |part: &PartId| {
        let part = &scene.parts[*part as usize];
        let material = &scene.materials[part.material as usize];
        match Glow::of_material(&material.name) {
            Some(glow) => 1e-3 * glow.lumens,
            None => PI * area_m2(scene, part) * measure(material.emission.factor).luminance(),
        }
    };
    let of_light = |light: &usize| match &scene.lights[*light] {
        Light::Point { intensity, .. } => 4.0 * PI * measure(*intensity).luminance(),
        Light::Spot { intensity, outer_rad, .. } => 2.0 * PI * (1.0 - outer_rad.cos()) * measure(*intensity).luminance(),
        Light::Profile { intensity, web, .. } => web.lumens() as f32 * measure(*intensity).luminance(),
        Light::Directional { .. } => 0.0,
    };
    lamp.parts.iter().map(of_part).sum::<f32>() + lamp.lights.iter().map(of_light).sum::<f32>()
}

/// Area of a part in the world.
pub fn area_m2(scene: &Scene, part: &Part) -> f32 {
    let triangles = scene.meshes[part.mesh as usize].triangles.len();
    let doubled = (0..triangles).map(|triangle| {
        let [a, b, c] = scene.world_corners(part, triangle);
        f64::from((b - a).cross(c - a).length())
    });
    (0.5 * doubled.sum::<f64>()) as f32
}

/// Colour of light of `kelvin` whose luminance is that of `measured`.
pub fn tinted(measured: Rgb, kelvin: f64, power: f64) -> Rgb {
    planck::color(kelvin) * (measured.luminance() * power as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_in_names_are_any_run_of_characters() {
        for (pattern, name, is_meant) in [
            ("inline*", "inline32", true),
            ("*emitter", "inline32_emitter", true),
            ("a*b*c", "abbc", true),
            ("a*b", "abc", false),
            ("a", "ab", false),
        ] {
            assert_eq!(matches(pattern, name), is_meant, "{pattern} {name}");
        }
    }
}
