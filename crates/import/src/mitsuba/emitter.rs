//! Emitters that are not part of a shape.

use super::reader::{Reader, spelling};
use super::spectrum;
use super::transform;
use super::xml::Node;
use crate::ImportError;
use crate::assembly::Source;
use crate::images::{self, Use};
use crate::spectrum::Kind;
use enfilade_math::{DVec3, Rgb, Vec3};
use enfilade_scene::sky::Daylight;
use enfilade_scene::{Environment, Light, MapRows, SpotFalloff};

/// Kilo-candela per square metre of one of Mitsuba's units of sky radiance, W·m⁻²·sr⁻¹·nm⁻¹: 683 lm/W × the 106.857 nm under the
/// luminosity curve.
const KILOCANDELA_PER_UNIT: f32 = 0.683 * 106.857;

/// Width of the sky's picture, texels.
const SKY_WIDTH: u32 = 1024;

impl<'n> Reader<'n, '_> {
    /// Adds an emitter of the scene itself.
    pub(super) fn emitter(&mut self, node: &'n Node) -> Result<(), ImportError> {
        match node.plugin.as_str() {
            "constant" => {
                self.report_unknown(node, &["radiance", "sampling_weight", "to_world"], &[]);
                let radiance = self.emission(node, "radiance")?;
                self.a.set_environment(Environment::Constant { radiance }, &node.place());
                Ok(())
            }
            "envmap" => self.environment_map(node),
            "point" | "spot" => self.point_or_spot(node),
            "directional" => {
                self.report_unknown(node, &["irradiance", "direction", "to_world", "sampling_weight"], &[]);
                let irradiance = self.emission(node, "irradiance")?;
                let direction = match node.child("direction") {
                    Some(d) => vector(d)?,
                    None => transform::of(node, "to_world")?.transform_vector3(DVec3::Z),
                };
                let direction = direction.normalize_or_zero().as_vec3();
                self.a.push_light(Light::Directional { name: name(node), direction, irradiance, angular_radius_rad: 0.0 });
                Ok(())
            }
            "sunsky" | "sky" | "sun" => self.daylight(node),
            // What shapes refer to is read with them.
            "area" if self.is_referred_to(node) => Ok(()),
            "area" => {
                self.warn(node, "no shape refers to the area emitter; it was left out");
                Ok(())
            }
            other => {
                self.warn(node, format!("{other} emitters are not supported{}; it was left out", spelling(other)));
                Ok(())
            }
        }
    }

    /// The emitted spectrum `name` of `node`, white when absent.
    fn emission(&mut self, node: &'n Node, name: &str) -> Result<Rgb, ImportError> {
        self.property(node, name)?.map_or(Ok(Rgb::WHITE), |p| self.spectrum(p, Kind::Emission))
    }

    fn environment_map(&mut self, node: &'n Node) -> Result<(), ImportError> {
        self.report_unknown(node, &["filename", "to_world", "scale", "gamma", "cache", "sampling_weight", "mis_compensation"], &[]);
        let path = node.raw_text("filename").ok_or_else(|| node.error("the envmap has no filename"))?;
        let scale = Rgb::splat(node.float_or("scale", 1.0)? as f32);
        let file_from_map = transform::of(node, "to_world")?.matrix3;
        if let Some(image) = self.a.light_image(&Source::File(path), &node.place())? {
            self.a.set_environment_map(image, MapRows::PoleToPole, scale, file_from_map, &node.place());
        }
        Ok(())
    }

    fn point_or_spot(&mut self, node: &'n Node) -> Result<(), ImportError> {
        const KNOWN: [&str; 7] = ["intensity", "position", "to_world", "cutoff_angle", "beam_width", "sampling_weight", "texture"];
        self.report_unknown(node, if node.plugin == "spot" { &KNOWN } else { &KNOWN[..6] }, &[]);
        let mut intensity = self.emission(node, "intensity")?;
        let placement = transform::of(node, "to_world")?;
        let at = node.child("position").map_or(Ok(placement.translation), vector)?;
        let position = at.as_vec3();
        if node.plugin == "point" {
            self.a.push_light_at(at, Light::Point { name: name(node), position, intensity });
            return Ok(());
        }
        let outer = node.float_or("cutoff_angle", 20.0)?;
        let inner = node.float_or("beam_width", 0.75 * outer)?.min(outer);
        let direction = placement.transform_vector3(DVec3::Z).normalize_or_zero().as_vec3();
        if let Some(texture) = self.property(node, "texture")?.filter(|p| p.tag == "texture") {
            self.warn(texture, "spots that project a picture are not supported; its mean colour was used");
            let t = self.texture(texture, Use::Color, 0)?;
            let mean = t.picture.map_or(Rgb::WHITE, |picture| images::mean_color(self.a.image_at(picture.image)));
            intensity = intensity * t.factor * mean;
        }
        let (inner_rad, outer_rad) = (inner.to_radians() as f32, outer.to_radians() as f32);
        let falloff = SpotFalloff::Angle;
        self.a.push_light_at(at, Light::Spot { name: name(node), position, direction, intensity, inner_rad, outer_rad, falloff });
        Ok(())
    }

    /// The sky as an environment and the sun as a light, by our own model, in Mitsuba's units.
    fn daylight(&mut self, node: &'n Node) -> Result<(), ImportError> {
        const KNOWN: [&str; 13] = [
            "sun_direction",
            "turbidity",
            "albedo",
            "scale",
            "sun_scale",
            "sky_scale",
            "sun_radius_scale",
            "sun_aperture",
            "to_world",
            "resolution",
            "sampling_weight",
            "extend",
            "complex_sun",
        ];
        self.report_unknown(node, &KNOWN, &[]);
        let scale = node.float_or("scale", 1.0)?;
        let (sun_scale, sky_scale) = (node.float_or("sun_scale", scale)? as f32, node.float_or("sky_scale", scale)? as f32);
        let to_sun = match node.child("sun_direction") {
            Some(d) => self.a.world_from_file().transform_vector3(vector(d)?),
            None => {
                self.warn(node, "the sun's place by date and location is not supported; it was put 45° high");
                DVec3::new(0.5, -0.5, std::f64::consts::FRAC_1_SQRT_2)
            }
        };
        let to_sun = to_sun.normalize_or_zero().as_vec3();
        let (own_up, albedo) = if self.version < 3 { (DVec3::Y, 0.15) } else { (DVec3::Z, 0.3) };
        let up = self.a.world_from_file() * transform::of(node, "to_world")?;
        if up.transform_vector3(own_up).normalize_or_zero().z < 0.999 {
            self.warn(node, "the sky's own up is not the scene's; the scene's was used");
        }
        if to_sun == Vec3::ZERO {
            return Err(node.error("the sun's direction is zero"));
        }
        let turbidity = node.float_or("turbidity", 3.0)?.clamp(1.7, 10.0) as f32;
        let ground_albedo =
            self.property(node, "albedo")?.map_or(Ok(Rgb::splat(albedo)), |p| spectrum::color(p, Kind::Factor))?.luminance();
        let daylight = Daylight { to_sun, turbidity, ground_albedo };
        self.warn(node, "daylight was computed by the atmosphere of Hillaire 2020; expect other colours than Mitsuba's");
        let image = self.a.next_image();
        let (picture, environment, sun) = daylight.lights(SKY_WIDTH, 1.0 / KILOCANDELA_PER_UNIT, image);
        if node.plugin != "sun" {
            self.a.push_image(picture);
            if let Environment::Map { image, rows, map_from_world, .. } = environment {
                self.a.set_environment(Environment::Map { image, rows, scale: Rgb::splat(sky_scale), map_from_world }, &node.place());
            }
        }
        if let Light::Directional { direction, irradiance, angular_radius_rad, .. } = sun
            && node.plugin != "sky"
            && to_sun.z > 0.0
        {
            let angular_radius_rad = match node.float("sun_aperture")? {
                Some(degrees) if degrees > 0.0 && degrees < 180.0 => (0.5 * degrees.to_radians()) as f32,
                Some(other) => return Err(node.error(format!("found a sun_aperture of {other}, expected degrees between 0 and 180"))),
                None => angular_radius_rad * node.float_or("sun_radius_scale", 1.0)?.max(0.0) as f32,
            };
            let irradiance = irradiance * sun_scale;
            self.a.push_world_light(Light::Directional { name: "sun".into(), direction, irradiance, angular_radius_rad });
        }
        Ok(())
    }
}

fn name(node: &Node) -> String {
    node.id.clone().unwrap_or_else(|| format!("{}_light", node.plugin))
}

/// A `vector` or `point` property: x, y, z or three numbers in `value`.
pub(super) fn vector(node: &Node) -> Result<DVec3, ImportError> {
    if let [x, y, z] = node.numbers("value")?[..] {
        return Ok(DVec3::new(x, y, z));
    }
    let component = |name: &str| Ok::<_, ImportError>(node.numbers(name)?.first().copied().unwrap_or(0.0));
    Ok(DVec3::new(component("x")?, component("y")?, component("z")?))
}
