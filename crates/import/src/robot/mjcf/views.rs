//! Cameras and lights, which may look at a body.

use super::tree::Element;
use super::walk::{Place, Walk};
use crate::ImportError;
use crate::assembly::{Assembly, orthonormal};
use enfilade_math::{DAffine3, DVec3, Rgb, linear_from_srgb};
use enfilade_scene::{Light, SpotFalloff};
use std::f32::consts::PI;

/// Aspect of a camera that states no resolution: the default aspect of this workspace's pictures.
const DEFAULT_ASPECT: f64 = 4.0 / 3.0;
/// Vertical field of view of a camera that states none, degrees.
const FOV_Y: f64 = 45.0;
/// Candela, and watts per steradian: 683 lm/W, as at 555 nm.
const LUMENS_PER_WATT: f64 = 683.0;

impl Walk<'_> {
    /// Adds a camera or a light.
    pub(super) fn view(&mut self, element: &Element, at: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let element = self.settings.complete(element, at.class.as_deref())?;
        let mode = element.text("mode").unwrap_or("fixed");
        let target = match mode {
            "targetbody" | "targetbodycom" => {
                let wanted = element.text("target").unwrap_or_default();
                let link = self.links.iter().find(|link| link.name == wanted);
                Some(link.ok_or_else(|| element.wrong(format!("there is no body {wanted:?} to look at")))?)
            }
            _ => None,
        };
        let is_led = mode != "fixed" && (at.body.is_some() || target.is_some_and(|link| link.body.is_some()));
        if is_led && element.tag == "camera" {
            let message =
                format!("a body that moves leads it (mode {mode}), so it stays as it is at rest: cameras of the mode fixed ride on bodies");
            let place = element.place(a);
            a.warn(place, message);
        }
        let target = target.map(|link| link.file_from_link.translation);
        if element.tag == "camera" { self.camera(&element, at, (target, is_led), a) } else { self.light(&element, at, target, a) }
    }

    /// Adds a camera, which rides on its body unless a body leads it in another way.
    fn camera(
        &mut self,
        camera: &Element,
        at: &Place,
        (target, is_led): (Option<DVec3>, bool),
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let name = if camera.name().is_empty() { "camera" } else { camera.name() };
        if camera.flag("orthographic") == Some(true) || camera.text("projection") == Some("orthographic") {
            let place = camera.place(a);
            a.warn(place, "it is orthographic and was left out");
            return Ok(());
        }
        let mut placed = at.file_from_here * self.settings.placement(camera)?;
        if let Some(axes) = target.and_then(|target| orthonormal(DVec3::Z, placed.translation - target)) {
            placed = DAffine3 { matrix3: axes, ..placed };
        }
        let aspect = camera.vector::<2>("resolution")?.filter(|[w, h]| *w > 1.0 && *h > 1.0).map_or(DEFAULT_ASPECT, |[w, h]| w / h);
        let sensor = camera.vector::<2>("sensorsize")?.filter(|[w, h]| *w > 0.0 && *h > 0.0);
        let focal = camera.vector::<2>("focal")?.or_else(|| {
            let [x, y] = camera.vector::<2>("focalpixel").ok()??;
            let ([w, h], [sw, sh]) = (camera.vector::<2>("resolution").ok()??, sensor?);
            Some([x * sw / w, y * sh / h])
        });
        let tangent = match (sensor, focal) {
            (Some([width, _]), Some([x, _])) if x > 0.0 => 0.5 * width / x,
            _ => (0.5 * camera.number("fovy")?.unwrap_or(FOV_Y).to_radians()).tan() * aspect,
        };
        let before = a.contents();
        a.push_camera(name, placed, 2.0 * tangent.atan(), aspect);
        if let Some(body) = at.body.filter(|_| !is_led) {
            a.carry(body, before);
        }
        Ok(())
    }

    fn light(&mut self, light: &Element, at: &Place, target: Option<DVec3>, a: &mut Assembly) -> Result<(), ImportError> {
        if light.flag("active") == Some(false) {
            return Ok(());
        }
        let name = if light.name().is_empty() { "light".to_string() } else { light.name().to_string() };
        let place = at.file_from_here * self.settings.placement(light)?;
        let direction = light.vector("dir")?.map_or(DVec3::NEG_Z, DVec3::from_array);
        let direction = target.map_or_else(|| at.file_from_here.transform_vector3(direction), |target| target - place.translation);
        let direction = direction.normalize_or_zero().as_vec3();
        let shown = Rgb::from(light.vector::<3>("diffuse")?.unwrap_or([0.7; 3]).map(|v| linear_from_srgb(v.clamp(0.0, 1.0) as f32)));
        let kind = match (light.text("type"), light.flag("directional")) {
            (Some(kind), _) => kind.to_string(),
            (None, Some(true)) => "directional".into(),
            (None, _) => "spot".into(),
        };
        let before = a.contents();
        let (position, file_position) = (place.translation.as_vec3(), place.translation);
        let candela = light.number("intensity")?.filter(|intensity| *intensity > 0.0);
        let distance = file_position.distance(self.middle()?).max(1.0) as f32;
        // A surface that faces the light, at the distance of the middle, has the radiance that MuJoCo shows of it.
        let intensity = candela.map_or(shown * (PI * distance * distance), |candela| shown * (candela / LUMENS_PER_WATT) as f32);
        match kind.as_str() {
            "directional" => a.push_light(Light::Directional { name, direction, irradiance: shown * PI, angular_radius_rad: 0.0 }),
            "point" => a.push_light_at(file_position, Light::Point { name, position, intensity }),
            "spot" => {
                let outer_rad = (light.number("cutoff")?.unwrap_or(45.0).to_radians() as f32).clamp(0.01, 0.5 * PI);
                let falloff = SpotFalloff::CosineSquare;
                let spot = Light::Spot { name, position, direction, intensity, inner_rad: 0.0, outer_rad, falloff };
                a.push_light_at(file_position, spot);
            }
            other => {
                let place = light.place(a);
                a.warn(place, format!("lights of the type {other:?} are not read; it was left out"));
                return Ok(());
            }
        }
        a.warn(
            "light",
            "MuJoCo's lights have no unit: each lights what faces it at the middle of the model (statistic center, else the origin, and 1 m or \
             more away) as MuJoCo shows it, and falls off with the square of the distance; intensity counts as candela, 683 lm/W",
        );
        if let Some(body) = at.body {
            a.carry(body, before);
        }
        Ok(())
    }

    /// The middle of the model, as it states it.
    fn middle(&self) -> Result<DVec3, ImportError> {
        for statistic in self.root.all("statistic") {
            if let Some(center) = statistic.vector("center")? {
                return Ok(DVec3::from_array(center));
            }
        }
        Ok(DVec3::ZERO)
    }
}
