//! Lights with a surface, and what all lights share: strength in V-Ray's units.

use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use crate::{primitives, spectrum};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use enfilade_scene::{ColorParam, Material};
use std::f64::consts::PI;

/// Luminous efficacy by which V-Ray turns watts into lumens, lm/W (its documentation of `units`).
const LUMENS_PER_WATT: f64 = 683.0;

/// The strength of a light, by its parameters `color`, `intensity` and `units`.
pub(super) enum Strength {
    /// Colour × intensity in units of the image.
    Image(Rgb),
    /// Total power in lumens, with a hue of luminance 1.
    Power(f64, Rgb),
    /// Radiance, or for points intensity, in lumens per steradian and square metre, with a hue of luminance 1.
    PerSteradian(f64, Rgb),
}

impl<'n> Reader<'n, '_> {
    /// Adds all lights but those of the surroundings.
    pub(super) fn lights(&mut self) -> Result<(), ImportError> {
        if let Some(settings) = self.plugins.settings("SettingsEnvironment") {
            self.light_level = settings.color("global_light_level", Rgb::WHITE)? * self.exposure;
        }
        for light in self.plugins.all() {
            match light.kind() {
                kind if !kind.starts_with("Light") && kind != "MayaLightDirect" => {}
                _ if !self.is_on(light)? => {}
                "LightRectangle" => self.rectangle(light)?,
                "LightSphere" => self.sphere(light)?,
                "LightMesh" => self.mesh_light(light)?,
                "LightDirect" | "LightDirectMax" | "MayaLightDirect" | "LightOmni" | "LightOmniMax" | "LightSpot" | "LightSpotMax"
                | "LightIES" => self.point_light(light)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// True unless a light, or all light of the scene, is turned off.
    pub(super) fn is_on(&self, light: Handle<'n>) -> Result<bool, ImportError> {
        let all = self.plugins.settings("SettingsOptions").map_or(Ok(true), |s| s.flag("light_doLights", true))?;
        Ok(all && light.flag("enabled", true)?)
    }

    /// The strength that a light's parameters state. A texture takes the place of its colour.
    pub(super) fn strength(&mut self, light: Handle<'n>, textured: bool) -> Result<Strength, ImportError> {
        self.warn_of_animation(light, &["intensity", "color", "transform"]);
        let intensity = self.plain_number(light, light.overriding("intensity", "intensity_tex")?, 1.0)?;
        let color = match light.int("color_mode", 0)? {
            _ if textured => Rgb::WHITE,
            1 => {
                let kelvin = light.number("temperature", 6500.0)?;
                if !(500.0..=50_000.0).contains(&kelvin) {
                    return Err(light.error("temperature", format!("found {kelvin}, expected 500 to 50000 kelvin; correct the value")));
                }
                let color = spectrum::black_body(kelvin);
                color / color.max_component()
            }
            _ => self.plain_color(light, light.overriding("color", "color_tex")?, Rgb::WHITE)?,
        };
        let hue = || if color.luminance() > 0.0 { color / color.luminance() } else { Rgb::BLACK };
        let level = f64::from(self.light_level.luminance());
        Ok(match light.int("units", 0)? {
            0 => Strength::Image(color * self.light_level * intensity as f32),
            1 => Strength::Power(intensity * level, hue()),
            2 => Strength::PerSteradian(intensity * level, hue()),
            3 => Strength::Power(intensity * level * LUMENS_PER_WATT, hue()),
            4 => Strength::PerSteradian(intensity * level * LUMENS_PER_WATT, hue()),
            other => {
                let problem = format!("found {other}, expected 0 (image), 1 (lm), 2 (lm/m2/sr), 3 (W) or 4 (W/m2/sr); correct the value");
                return Err(light.error("units", problem));
            }
        })
    }

    /// Radiance of a surface of `area` square units that sends this light from one side.
    fn radiance(&self, strength: &Strength, area: f64) -> Rgb {
        let square_metres = area * self.a.meters_per_unit().powi(2);
        let scaled = |v: f64| (v * self.photometric_scale) as f32;
        match *strength {
            Strength::Image(radiance) => radiance,
            Strength::Power(lumens, hue) if square_metres > 0.0 => hue * scaled(lumens / (PI * square_metres)),
            Strength::Power(..) => Rgb::BLACK,
            Strength::PerSteradian(nits, hue) => hue * scaled(nits),
        }
    }

    /// u_size and v_size are half the sides; the light goes to −z.
    fn rectangle(&mut self, light: Handle<'n>) -> Result<(), ImportError> {
        if light.int("lightPortal", 0)? != 0 {
            self.warn(light, "a portal gives no light of its own and was left out: surroundings are sampled without one");
            return Ok(());
        }
        let (u, v) = (light.number("u_size", 1.0)?, light.number("v_size", 1.0)?);
        let disc = light.flag("is_disc", false)?;
        let (mesh, unit_area) = if disc { (primitives::disk(), PI) } else { (primitives::rectangle(), 4.0) };
        // Turned about x, so that the front is at −z.
        let placement = light.transform("transform")? * DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(u, -v, -1.0)));
        let area = unit_area * placement.matrix3.x_axis.cross(placement.matrix3.y_axis).length();
        if light.number("directional", 0.0)? != 0.0 {
            self.warn(light, "light that goes forward more than aside (directional) is not supported; it goes to all sides");
        }
        let texture = self.light_texture(light, "use_rect_tex", "rect_tex")?;
        self.surface_light(light, mesh, placement, area, texture)
    }

    fn sphere(&mut self, light: Handle<'n>) -> Result<(), ImportError> {
        let radius = light.number("radius", 1.0)?;
        let placement = light.transform("transform")? * DAffine3::from_scale(DVec3::splat(radius));
        let size = placement.matrix3.determinant().abs().cbrt();
        self.surface_light(light, primitives::lamp(), placement, 4.0 * PI * size * size, None)
    }

    fn mesh_light(&mut self, light: Handle<'n>) -> Result<(), ImportError> {
        let Some(geometry) = light.reference("geometry")? else {
            self.warn(light, "it has no geometry and was left out");
            return Ok(());
        };
        let placement = light.transform("transform")?;
        let texture = self.light_texture(light, "use_tex", "tex")?;
        let meshes = self.geometry(geometry, 1, false)?;
        let Some(&(_, mesh)) = meshes.first() else { return Ok(()) };
        let area = self.a.area(mesh, placement);
        let material = self.light_material(light, area, texture)?;
        self.light_part(light, mesh, material, placement);
        Ok(())
    }

    fn surface_light(
        &mut self,
        light: Handle<'n>,
        mesh: Mesh,
        placement: DAffine3,
        area: f64,
        texture: Option<ColorParam>,
    ) -> Result<(), ImportError> {
        let material = self.light_material(light, area, texture)?;
        if let Some(mesh) = self.a.push_mesh(mesh, light.file, &light.place())? {
            self.light_part(light, mesh, material, placement);
        }
        Ok(())
    }

    /// The texture of a light where it is turned on.
    fn light_texture(&mut self, light: Handle<'n>, switch: &str, parameter: &str) -> Result<Option<ColorParam>, ImportError> {
        if !light.flag(switch, false)? || light.plugin.parameter(parameter).is_none() {
            return Ok(None);
        }
        self.color(light, parameter, Rgb::WHITE).map(Some)
    }

    /// The material of a light's surface.
    fn light_material(&mut self, light: Handle<'n>, area: f64, texture: Option<ColorParam>) -> Result<u32, ImportError> {
        if light.flag("invisible", false)? {
            self.warn(light, "an invisible light with a surface is not supported: it is seen by cameras and in mirrors");
        }
        for (parameter, message) in [
            ("noDecay", "light without decay is not supported: it falls off with the square of the distance"),
            ("excludeGI", "light that is left out of indirect light is not supported: it is counted"),
        ] {
            if light.flag(parameter, false)? {
                self.warn(light, message);
            }
        }
        for parameter in ["shadows", "affectDiffuse", "affectSpecular", "affectReflections"] {
            if !light.flag(parameter, true)? {
                self.warn(light, format!("{parameter}=0 is not supported: it is as if it were 1"));
            }
        }
        let both = light.flag("doubleSided", false)?;
        let strength = self.strength(light, texture.is_some())?;
        let radiance = self.radiance(&strength, if both { 2.0 * area } else { area });
        let texture = texture.unwrap_or(Rgb::WHITE.into());
        let emission = ColorParam { factor: texture.factor * radiance, ..texture };
        let material = Material { emission, emits_both_sides: both, ..Material::emitter(light.name(), radiance) };
        Ok(self.a.push_material(material))
    }
}
