//! What lights a scene: its lamps, surfaces that stand for daylight, and everything else that glows.

use crate::planck;
use enfilade_furniture::{Glow, object_of};
use enfilade_math::Rgb;
use enfilade_scene::{LabelledScene, Light, PartId, Scene};
use std::collections::BTreeMap;
use std::f32::consts::PI;

/// Classes whose glowing surfaces stand for the daylight outside: windows, doors, blinds, curtains.
const DAYLIT: [i16; 4] = [9, 8, 13, 16];
/// Classes whose glowing surfaces show something: televisions and pictures.
const SHOWN: [i16; 2] = [25, 11];
/// Words of unlabelled surfaces that stand for daylight.
const DAYLIGHT_WORDS: [&str; 4] = ["window", "portal", "sky", "outside"];

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

/// How a part glows, by its material and its class.
pub fn glowing(scene: &LabelledScene, part: PartId) -> Glowing {
    let (scene, label) = (&scene.scene, scene.labels.parts[part as usize]);
    let material = &scene.materials[scene.parts[part as usize].material as usize];
    if Glow::of_material(&material.name).is_some() {
        return Glowing::Lamp;
    }
    let names = || [&material.name, &scene.parts[part as usize].name].map(|name| name.to_lowercase());
    let says_daylight = || names().iter().any(|name| DAYLIGHT_WORDS.iter().any(|word| name.contains(word)));
    match label.semantic {
        _ if material.emission.factor.is_black() => Glowing::No,
        class if DAYLIT.contains(&class) => Glowing::Daylight,
        class if SHOWN.contains(&class) || material.name.contains("screen") => Glowing::Other,
        -1 if says_daylight() => Glowing::Daylight,
        _ => Glowing::Lamp,
    }
}

/// The lamps of a scene: those of parts first, in the order of these.
pub fn lamps(scene: &LabelledScene) -> Vec<Lamp> {
    let mut lamps: Vec<Lamp> = Vec::new();
    let mut known: BTreeMap<(bool, u32), usize> = BTreeMap::new();
    for part in (0..scene.scene.parts.len() as PartId).filter(|&part| glowing(scene, part) == Glowing::Lamp) {
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
pub fn area_m2(scene: &Scene, part: &enfilade_scene::Part) -> f32 {
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
