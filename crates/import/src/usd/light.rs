//! UsdLux: lights with a surface become parts that emit; those without one, lights.
//!
//! The radiance of a light's surface is intensity · 2^exposure · colour (· the black body's colour), nits in UsdLux and W·sr⁻¹·m⁻²
//! here, one for the other. `normalize` divides it by the area of the surface in the stage's units; for a distant light by
//! π·sin²(half its angle), so that intensity becomes irradiance. OpenUSD, "UsdLux": `LightAPI`, `ShapingAPI`, `DistantLight`.

use super::camera::name;
use super::shapes;
use super::stage::{Prim, Stage};
use super::texture::{Textures, rgb};
use super::value::Value;
use crate::assembly::{Assembly, FileLabel, orthonormal};
use crate::blender::spot_inner_rad;
use crate::images::Use;
use crate::mesh::area;
use crate::spectrum::black_body;
use crate::{ImportError, ies};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use enfilade_scene::{ColorParam, Environment, Light, MapRows, Material, ObjectId, SpotFalloff, TextureRef};
use std::collections::HashMap;
use std::f64::consts::PI;

/// The temperature that UsdLux calls white, which is also the default.
const WHITE_KELVIN: f64 = 6500.0;

/// Blender's exporter writes this part of a sun's irradiance, "approximately matching Karma" (`usd_writer_light.cc`), in all versions that
/// write `normalize` (since 3.6).
const BLENDERS_SUN: f32 = 0.25;
/// Part of the sun's angle that Blender's exporter writes.
const BLENDERS_ANGLE: f64 = 0.5;

/// A light prim, its placement, and where to put what it becomes.
pub(super) struct Lamp<'l> {
    pub prim: &'l Prim,
    pub file_from_prim: DAffine3,
    pub object: ObjectId,
    pub label: FileLabel,
    pub baked: &'l mut HashMap<String, u32>,
    /// True where z is up in the file.
    pub z_up: bool,
}

/// An input of a light. Until 2021 they had no `inputs:` before their names.
fn input<'p>(prim: &'p Prim, name: &str) -> Option<&'p Value> {
    prim.value(&format!("inputs:{name}")).or_else(|| prim.value(name))
}

fn number(prim: &Prim, name: &str, default: f64) -> f64 {
    input(prim, name).and_then(Value::as_number).unwrap_or(default)
}

/// Radiance before normalization, where `default` is the intensity of lights that state none.
fn radiance(prim: &Prim, default: f64) -> Rgb {
    let strength = number(prim, "intensity", default) * number(prim, "exposure", 0.0).exp2();
    let mut color = input(prim, "color").and_then(rgb).unwrap_or(Rgb::WHITE);
    if input(prim, "enableColorTemperature").and_then(Value::as_bool) == Some(true) {
        let tint = tint(number(prim, "colorTemperature", WHITE_KELVIN).clamp(1000.0, 10_000.0));
        color = color * tint * (1.0 / tint.luminance());
    }
    color * strength as f32
}

/// The colour of a black body, relative to that of [`WHITE_KELVIN`] as white.
fn tint(kelvin: f64) -> Rgb {
    let (body, white) = (black_body(kelvin), black_body(WHITE_KELVIN));
    Rgb::new(body.r / white.r, body.g / white.g, body.b / white.b)
}

/// True for a normalized light of a layer that Blender wrote, according to its `doc`.
fn is_normalized_by_blender(prim: &Prim) -> bool {
    let stated = prim.value_at("inputs:intensity").map(|(_, site)| &site.layer);
    let doc = stated.and_then(|layer| layer.get("/", "doc").or(layer.get("/", "documentation"))).and_then(Value::as_text);
    is_normalized(prim) && doc.is_some_and(|doc| doc.starts_with("Blender v"))
}

fn is_normalized(prim: &Prim) -> bool {
    input(prim, "normalize").and_then(Value::as_bool).unwrap_or(false)
}

/// Radiance of a surface of `area` square units of the stage.
fn surface_radiance(prim: &Prim, area: f64) -> Rgb {
    let radiance = radiance(prim, 1.0);
    if is_normalized(prim) && area > 0.0 { radiance * (1.0 / area) as f32 } else { radiance }
}

/// A placement without its translation, which does not change areas but costs digits far from the origin.
fn unmoved(placement: DAffine3) -> DAffine3 {
    DAffine3::from_mat3(placement.matrix3)
}

/// The radiance of a mesh that is a light (`MeshLightAPI`); `None` for those that are none.
pub(super) fn of_mesh(prim: &Prim, mesh: &Mesh, placement: DAffine3) -> Option<Rgb> {
    prim.schemas().iter().any(|s| s == "MeshLightAPI").then(|| surface_radiance(prim, area(mesh, unmoved(placement))))
}

impl Lamp<'_> {
    /// Adds the light.
    ///
    /// # Errors
    /// When a texture or profile cannot be read.
    pub(super) fn add(&mut self, stage: &mut Stage, a: &mut Assembly) -> Result<(), ImportError> {
        for multiplier in ["diffuse", "specular"] {
            if number(self.prim, multiplier, 1.0) != 1.0 {
                a.warn(&self.prim.path, format!("the light's {multiplier} multiplier was left out: it is no property of light"));
            }
        }
        match self.prim.kind() {
            "DistantLight" => self.distant(a),
            "DomeLight" | "DomeLight_1" => return self.dome(stage, a),
            "SphereLight" => return self.sphere(stage, a),
            "RectLight" => {
                let (width, height) = (number(self.prim, "width", 1.0), number(self.prim, "height", 1.0));
                let picture = self.picture("texture:file", stage, a)?;
                self.surface(panel(width as f32, height as f32), width * height, picture, a)?;
            }
            "DiskLight" => {
                let radius = number(self.prim, "radius", 0.5);
                self.surface(backward(shapes::disk(radius as f32)), PI * radius * radius, None, a)?;
            }
            "CylinderLight" => {
                let (radius, length) = (number(self.prim, "radius", 0.5), number(self.prim, "length", 1.0));
                self.surface(shapes::tube_along_x(radius as f32, length as f32), 2.0 * PI * radius * length, None, a)?;
            }
            other => a.warn(&self.prim.path, format!("{other} is not supported; it was left out")),
        }
        Ok(())
    }

    /// Adds a part that emits. `exact` is the area of the shape that the mesh approximates.
    fn surface(&self, mesh: Mesh, exact: f64, picture: Option<u32>, a: &mut Assembly) -> Result<(), ImportError> {
        let cone = number(self.prim, "shaping:cone:angle", 90.0);
        if cone < 90.0 || number(self.prim, "shaping:focus", 0.0) != 0.0 || input(self.prim, "shaping:ies:file").is_some() {
            a.warn(&self.prim.path, "the light's cone, focus or profile was left out: surfaces emit evenly over directions");
        }
        let placed = exact * area(&mesh, unmoved(self.file_from_prim)) / area(&mesh, DAffine3::IDENTITY);
        let factor = surface_radiance(self.prim, placed);
        let name = name(self.prim);
        let mut material = Material::emitter(&name, factor);
        material.emission = ColorParam { factor, texture: picture.map(TextureRef::new) };
        let file = a.file().to_path_buf();
        if let Some(mesh) = a.push_mesh(mesh, &file, &self.prim.path)? {
            let material = a.push_material(material);
            a.push_part_of(self.object, &name, mesh, material, self.file_from_prim, self.label);
        }
        Ok(())
    }

    /// A sphere; a point where it is to be one, or shines into a cone or by a profile, which surfaces cannot here.
    fn sphere(&self, stage: &Stage, a: &mut Assembly) -> Result<(), ImportError> {
        let radius = number(self.prim, "radius", 0.5);
        let mesh = shapes::lamp(radius as f32);
        let exact = 4.0 * PI * radius * radius;
        let (cone, softness) = (number(self.prim, "shaping:cone:angle", 90.0), number(self.prim, "shaping:cone:softness", 0.0));
        let profile = input(self.prim, "shaping:ies:file").and_then(Value::as_text).filter(|t| !t.is_empty()).map(str::to_string);
        let as_point = input(self.prim, "treatAsPoint").and_then(Value::as_bool).unwrap_or(false);
        if !as_point && cone >= 90.0 && profile.is_none() {
            return self.surface(mesh, exact, None, a);
        }
        let placed = exact * area(&mesh, unmoved(self.file_from_prim)) / area(&mesh, DAffine3::IDENTITY);
        // A sphere of radiance L shows the area πr² from everywhere.
        let factor = if is_normalized(self.prim) { 0.25 } else { 0.25 * placed };
        let intensity = radiance(self.prim, 1.0) * if factor.is_finite() { factor as f32 } else { 0.0 };
        self.report_shaping(as_point, profile.is_some(), a);
        let (name, position) = (name(self.prim), self.file_from_prim.translation.as_vec3());
        if let Some(asset) = profile {
            return self.profile(stage, &asset, intensity, a);
        }
        let light = if cone < 90.0 {
            let direction = self.file_from_prim.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
            let (outer, softness) = (cone.max(0.0).to_radians(), softness.clamp(0.0, 1.0));
            // Blender writes its blend as it is.
            let (inner, falloff) = match is_normalized_by_blender(self.prim) {
                true => (spot_inner_rad(outer, softness), SpotFalloff::SmoothCosine),
                false => (outer * (1.0 - softness), SpotFalloff::SmoothAngle),
            };
            Light::Spot { name, position, direction, intensity, inner_rad: inner as f32, outer_rad: outer as f32, falloff }
        } else {
            Light::Point { name, position, intensity }
        };
        a.push_light_at(self.file_from_prim.translation, light);
        Ok(())
    }

    /// Reports the shaping of a sphere light that was made a point.
    fn report_shaping(&self, as_point: bool, profile: bool, a: &mut Assembly) {
        if !as_point {
            a.warn(
                &self.prim.path,
                match (profile, self.is_profile_normalized()) {
                    (false, _) => "the light shines into a cone, so it was made a point of the same intensity",
                    (true, false) => "the light shines by a profile, so it was made a point of its intensity times the profile's candela",
                    (true, true) => "the light shines by a profile, so it was made a point of the same power",
                },
            );
        }
        let dropped = [
            ("focus", number(self.prim, "shaping:focus", 0.0) != 0.0),
            ("cone", profile && number(self.prim, "shaping:cone:angle", 90.0) < 90.0),
            ("profile's angle scale", profile && number(self.prim, "shaping:ies:angleScale", 0.0) != 0.0),
        ];
        for (what, _) in dropped.iter().filter(|(_, stated)| *stated) {
            a.warn(&self.prim.path, format!("the light's {what} was left out: points that stand for spheres do not have it"));
        }
    }

    fn is_profile_normalized(&self) -> bool {
        input(self.prim, "shaping:ies:normalize").and_then(Value::as_bool).unwrap_or(false)
    }

    /// A point that shines by a photometric profile, whose axis is the light's −z.
    fn profile(&self, stage: &Stage, asset: &str, intensity: Rgb, a: &mut Assembly) -> Result<(), ImportError> {
        let layer =
            self.prim.value_at("inputs:shaping:ies:file").or(self.prim.value_at("shaping:ies:file")).map(|(_, site)| &site.layer.location);
        let location = super::files::resolve(asset, layer.map_or("", String::as_str));
        let (file, bytes) = match stage.embedded(&location) {
            Some(bytes) => (a.path_of(&location), bytes),
            None => a.read(&location)?,
        };
        let parsed = ies::parse(&bytes, &file, "")?;
        for warning in parsed.warnings {
            a.warn(&self.prim.path, warning);
        }
        let m = self.file_from_prim.matrix3;
        let Some(axes) = orthonormal(m.y_axis, m.z_axis) else {
            a.warn(&self.prim.path, "the light's placement makes no sense, so it was left out");
            return Ok(());
        };
        let mut intensity = intensity;
        if self.is_profile_normalized() {
            // Over all directions, the candela that multiply the intensity then have a mean of one.
            let factor = (4.0 * PI / parsed.web.lumens()) as f32;
            if factor.is_finite() {
                intensity *= factor;
            } else {
                a.warn(&self.prim.path, "the light's profile is dark, so it could not be normalized");
            }
        }
        let position = self.file_from_prim.translation.as_vec3();
        let web_from_world = axes.transpose().as_mat3();
        let light = Light::Profile { name: name(self.prim), position, web_from_world, intensity, web: Box::new(parsed.web) };
        a.push_light_at(self.file_from_prim.translation, light);
        Ok(())
    }

    /// The sun: a disk in the sky of some angle across.
    fn distant(&self, a: &mut Assembly) {
        let of_blender = is_normalized_by_blender(self.prim);
        let across = number(self.prim, "angle", 0.53) / if of_blender { BLENDERS_ANGLE } else { 1.0 };
        let half = 0.5 * across.clamp(0.0, 180.0).to_radians();
        let solid = PI * half.sin().powi(2);
        let mut irradiance = radiance(self.prim, 50_000.0);
        if !is_normalized(self.prim) && solid > 0.0 {
            irradiance *= solid as f32;
        }
        if of_blender {
            irradiance *= 1.0 / BLENDERS_SUN;
            a.warn(
                &self.prim.path,
                "Blender wrote a quarter of the sun's strength and half its angle; it was made four times as strong and twice as wide, as in Blender",
            );
        }
        let direction = self.file_from_prim.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
        a.push_light(Light::Directional { name: name(self.prim), direction, irradiance, angular_radius_rad: half as f32 });
    }

    /// The surroundings. Their pictures are OpenEXR's latitude-longitude maps: the middle is +z, +x a quarter left of it; just ours.
    fn dome(&mut self, stage: &mut Stage, a: &mut Assembly) -> Result<(), ImportError> {
        let scale = radiance(self.prim, 1.0);
        let format = input(self.prim, "texture:format").and_then(Value::as_text).unwrap_or("automatic");
        if !matches!(format, "automatic" | "latlong") {
            a.warn(
                &self.prim.path,
                format!("an environment in the format {format} is not supported, only latlong; its mean was not taken either: it is plain"),
            );
        } else if let Some(image) = self.picture("texture:file", stage, a)? {
            let scene_axis = self.prim.kind() == "DomeLight_1" && self.z_up && self.prim.text("poleAxis").unwrap_or("scene") == "scene";
            let z_axis = self.prim.kind() == "DomeLight_1" && self.prim.text("poleAxis") == Some("Z");
            let pole = if scene_axis || z_axis { DMat3::from_rotation_x(0.5 * PI) } else { DMat3::IDENTITY };
            a.set_environment_map(image, MapRows::Bands, scale, self.file_from_prim.matrix3 * pole, &self.prim.path);
            return Ok(());
        }
        a.set_environment(Environment::Constant { radiance: scale }, &self.prim.path);
        Ok(())
    }

    /// The picture that an attribute of the light names.
    fn picture(&mut self, attribute: &str, stage: &mut Stage, a: &mut Assembly) -> Result<Option<u32>, ImportError> {
        let found = self.prim.value_at(&format!("inputs:{attribute}")).or(self.prim.value_at(attribute));
        let Some((asset, layer)) = found.and_then(|(v, site)| Some((v.as_text()?.to_string(), site.layer.location.clone()))) else {
            return Ok(None);
        };
        if asset.is_empty() {
            return Ok(None);
        }
        let user = format!("light <{}>", self.prim.path);
        Textures { stage, a, user, uv_name: None, color_name: None, baked: self.baked }.picture(&asset, &layer, Use::Color)
    }
}

/// The rectangle of a `RectLight`. Seen from where it shines, +x is to the left, and so is the left edge of its picture: "a texture file's
/// min coordinates should be at (+X, +Y) and max coordinates at (-X, -Y)" (OpenUSD, `RectLight`).
fn panel(width: f32, height: f32) -> Mesh {
    let mut mesh = backward(shapes::plane(width, height));
    mesh.uvs.iter_mut().for_each(|uv| uv.x = 1.0 - uv.x);
    mesh
}

/// A mesh that faces +z turned round to −z, where these lights shine.
fn backward(mut mesh: Mesh) -> Mesh {
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}
