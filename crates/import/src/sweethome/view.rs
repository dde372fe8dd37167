//! Cameras, sky and ceiling lights of a home.

use super::home::Home;
use super::outline::Walls;
use super::piece::HOME_LIGHT;
use super::room::height_at;
use super::xml::Element;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec2, DVec3, Rgb, srgb_from_linear};
use enfilade_scene::{Environment, Light};
use std::f64::consts::PI;

/// Radius of the light below each ceiling, and how far below it hangs, centimetres, as in Sweet Home 3D's photographs.
const CEILING_LIGHT: (f64, f64) = (20.0, 25.0);

/// Adds cameras, the sky and the light of ceilings.
pub(super) fn add(root: &Element, walls: &Walls, home: &mut Home) -> Result<(), ImportError> {
    let environment = root.child("environment", None);
    let aspect = match environment {
        Some(e) => e.number_or("photoWidth", 400.0)? / e.number_or("photoHeight", 300.0)?.max(1.0),
        None => 4.0 / 3.0,
    };
    add_cameras(root, aspect, home)?;
    let sky = environment.map_or(Ok(None), |e| e.color("skyColor"))?;
    let radiance = sky.map_or(Rgb::new(0.6, 0.78, 0.97), |(_, c)| c);
    home.a.set_environment(Environment::Constant { radiance }, "<environment>");
    let textured = environment.is_some_and(|e| e.child("texture", Some("skyTexture")).is_some());
    let what = if textured { "the sky's picture and the sun were" } else { "the sun was" };
    home.a.warn("<environment>", format!("{what} left out; a sky of one colour lights the home from outside"));
    add_ceiling_lights(root, environment, walls, home)
}

/// The visitor's camera first, then the stored ones, the one above the home last: trajectories begin at the first.
fn add_cameras(root: &Element, aspect: f64, home: &mut Home) -> Result<(), ImportError> {
    let all: Vec<Element> = root.children().filter(|e| matches!(e.tag(), "camera" | "observerCamera")).collect();
    for wanted in ["observerCamera", "storedCamera", "topCamera"] {
        for camera in all.iter().filter(|c| c.text("attribute") == Some(wanted)) {
            let lens = camera.text("lens").unwrap_or("PINHOLE");
            if !matches!(lens, "PINHOLE" | "NORMAL") {
                home.a.warn(camera.place(), format!("the lens {lens} was replaced by a pinhole of its field of view"));
            }
            let position = DVec3::new(camera.required("x")?, camera.required("z")?, camera.required("y")?);
            let (yaw, pitch) = (camera.required("yaw")?, camera.required("pitch")?);
            let turn = DMat3::from_rotation_y(PI - yaw) * DMat3::from_rotation_x(-pitch);
            let placement = DAffine3::from_mat3_translation(turn, position);
            home.a.push_camera(camera.text("name").unwrap_or(wanted), placement, camera.required("fieldOfView")?, aspect);
        }
    }
    let path = all.iter().filter(|c| c.text("attribute") == Some("cameraPath")).count();
    if path > 0 {
        home.a.warn("<camera>", format!("the camera path of {path} points was left out; trajectories are planned again"));
    }
    Ok(())
}

/// A light below the ceiling of each room, as bright as the room's size and the home's colours ask for.
fn add_ceiling_lights(root: &Element, environment: Option<Element>, walls: &Walls, home: &mut Home) -> Result<(), ImportError> {
    let color = |name: &str| -> Result<Rgb, ImportError> {
        let found = environment.map_or(Ok(None), |e| e.color(name))?;
        Ok(found.map_or(Rgb::splat(HOME_LIGHT as f32), |(_, c)| c.map(srgb_from_linear)))
    };
    let (of_ceilings, of_home) = (color("ceillingLightColor")?, color("lightColor")?);
    if of_ceilings.is_black() {
        return Ok(());
    }
    for (index, room) in root.children().filter(|e| e.tag() == "room").enumerate() {
        let level = room.text("level");
        if !room.flag("ceilingVisible", true) || !home.shows(level) {
            continue;
        }
        let mut points = Vec::new();
        for point in room.children().filter(|e| e.tag() == "point") {
            points.push(DVec2::new(point.required("x")?, point.required("y")?));
        }
        if points.len() < 3 {
            continue;
        }
        let (min, max) = points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        let center = 0.5 * (min + max);
        let below_another = home.level(level).filter(|l| !home.is_highest(*l));
        let top = below_another.map_or_else(|| height_at(center, level, walls, home), |l| l.elevation + l.height);
        let (radius, below) = CEILING_LIGHT;
        let radiance = super::surface::area(&points).abs().sqrt() / 3.0 / HOME_LIGHT;
        let intensity = of_ceilings * of_home * (radiance * PI * radius * radius) as f32;
        let position = DVec3::new(center.x, top - below, center.y).as_vec3();
        let name = room.text("name").map_or_else(|| format!("room_{}", index + 1), str::to_string);
        home.a.push_light(Light::Point { name: format!("{name}.ceiling_light"), position, intensity });
    }
    Ok(())
}
