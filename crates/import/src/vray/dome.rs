//! Light from the surroundings: `LightDome`, `SettingsEnvironment`.
//!
//! A scene here has one environment, which is seen and gives light. A dome has precedence over the settings, and among these the light
//! (`gi_tex`) over the background (`bg_tex`).

use super::light::Strength;
use super::parameters;
use super::plugins::Handle;
use super::reader::{MAX_CHAIN, Reader};
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Environment, Image, MapRows, Pixels, TextureRef, Wrap, direction_from_uv};
use enfilade_vrscene::Value;
use std::f32::consts::PI;

/// Rows of a picture that is half dome, half black; the step between them at the horizon is one row.
const HALF_DOME_ROWS: u32 = 256;

/// Width of an angular picture once it is unrolled, texels.
const UNROLLED_WIDTH: u32 = 1024;

impl<'n> Reader<'n, '_> {
    /// Sets the environment.
    pub(super) fn surroundings(&mut self) -> Result<(), ImportError> {
        self.suns()?;
        let mut domes = 0;
        for dome in self.plugins.of_kind("LightDome") {
            if self.is_on(dome)? {
                domes += 1;
                self.dome(dome)?;
            }
        }
        let Some(settings) = self.plugins.settings("SettingsEnvironment") else { return Ok(()) };
        let [background, light] = [self.backdrop(settings, "bg")?, self.backdrop(settings, "gi")?];
        if domes > 0 {
            if background.is_some() {
                self.warn(settings, "the dome light is the environment; the background was left out");
            }
            return Ok(());
        }
        if light.is_some() && background.is_some() && settings.value("gi_tex")? != settings.value("bg_tex")? {
            self.warn(
                settings,
                "the environment that gives light (gi) differs from the one that is seen (bg); the former was used for both",
            );
        }
        if light.is_none() && background.is_some() && settings.plugin.parameter("gi_tex").is_some() {
            self.warn(settings, "the background (bg) gives no light in V-Ray (gi is black); here it does");
        }
        if let Some((parameter, value, scale)) = light.or(background) {
            self.environment(settings, &parameter, &value, scale, 0)?;
        }
        Ok(())
    }

    /// The setting of the background (`bg`) or of light (`gi`), with a multiplier; `None` if it is black.
    fn backdrop(&mut self, settings: Handle<'n>, kind: &str) -> Result<Option<(String, Value, Rgb)>, ImportError> {
        let texture = format!("{kind}_tex");
        let multiplier = Rgb::splat(settings.number(&format!("{kind}_tex_mult"), 1.0)? as f32 * self.exposure);
        for parameter in [texture, format!("{kind}_color")] {
            let Some(value) = settings.value(&parameter)? else { continue };
            let black = parameters::constant(&value).is_some_and(|c| c.is_black()) || value.plugin() == Some(b"NULL");
            if !black && !multiplier.is_black() {
                return Ok(Some((parameter, value, multiplier)));
            }
        }
        Ok(None)
    }

    fn dome(&mut self, dome: Handle<'n>) -> Result<(), ImportError> {
        if dome.flag("invisible", false)? {
            self.warn(dome, "an invisible dome is not supported: it is seen in the background");
        }
        let textured = dome.flag("use_dome_tex", dome.plugin.parameter("dome_tex").is_some())?;
        let strength = match self.strength(dome, textured)? {
            Strength::Image(radiance) => radiance,
            Strength::PerSteradian(nits, hue) => hue * (nits * self.photometric_scale) as f32,
            Strength::Power(..) => {
                self.warn(dome, "a dome's total power says nothing of its radiance; it was left out, so give it in units 0, 2 or 4");
                return Ok(());
            }
        };
        if textured && let Some(texture) = dome.value("dome_tex")? {
            if !dome.flag("dome_spherical", false)? {
                self.warn(dome, "a dome of half a sphere is not supported with a texture; the texture goes all round");
            }
            return self.environment(dome, "dome_tex", &texture, strength, 0);
        }
        if dome.flag("dome_spherical", false)? {
            self.a.set_environment(Environment::Constant { radiance: strength }, &dome.place());
            return Ok(());
        }
        let file_from_dome = dome.transform("transform")?.matrix3;
        let row = |i: u32| if i < HALF_DOME_ROWS / 2 { [1.0; 3] } else { [0.0; 3] };
        let pixels = Pixels::RgbF32((0..HALF_DOME_ROWS).map(row).collect());
        let image = self.a.push_image(Image { name: dome.name(), width: 1, height: HALF_DOME_ROWS, pixels });
        self.a.set_environment_map(image, MapRows::Bands, strength, file_from_dome * z_up_from_map(), &dome.place());
        Ok(())
    }

    /// Sets the environment by the value of a texture parameter.
    ///
    /// V-Ray looks textures up by directions in the world, so that a dome's transform does not turn them: what exporters lock to the
    /// dome they turn by `uvw_matrix`.
    fn environment(&mut self, plugin: Handle<'n>, parameter: &str, value: &Value, scale: Rgb, depth: usize) -> Result<(), ImportError> {
        if depth > MAX_CHAIN {
            return Err(plugin.error(parameter, "textures refer to each other in a circle; correct the reference that closes it"));
        }
        if parameters::constant(value).is_none()
            && let Some(texture) = plugin.resolve(parameter, value)?
        {
            match texture.kind() {
                "TexSky" => return self.sky(texture, scale),
                "TexBitmap" => return self.environment_map(texture, scale),
                "TexAColor" => {
                    if let Some(value) = texture.value("texture")? {
                        return self.environment(texture, "texture", &value, scale, depth + 1);
                    }
                }
                _ => {}
            }
        }
        let texture = self.texture_of(plugin, parameter, value, depth)?;
        let radiance = texture.factor * scale;
        if let Some(picture) = texture.picture {
            self.warn(plugin, format!("{parameter}: the picture was taken for one that goes all round (equirectangular)"));
            self.a.set_environment_map(picture.image, MapRows::Bands, radiance, z_up_from_map(), &plugin.place());
        } else {
            self.a.set_environment(Environment::Constant { radiance }, &plugin.place());
        }
        Ok(())
    }

    /// A picture all round, by the mapping of its `UVWGenEnvironment`.
    fn environment_map(&mut self, texture: Handle<'n>, scale: Rgb) -> Result<(), ImportError> {
        let factor = self.plain_color(texture, "color_mult", Rgb::WHITE)? * scale;
        let Some(mut image) = self.picture(texture)? else {
            self.a.set_environment(Environment::Constant { radiance: factor * super::material::MID_GREY }, &texture.place());
            return Ok(());
        };
        let mut file_from_map = z_up_from_map();
        if let Some(generator) = texture.reference("uvwgen")?.filter(|g| g.kind() == "UVWGenEnvironment") {
            let inverse = generator.transform("uvw_matrix")?.matrix3.inverse();
            if !inverse.is_finite() {
                return Err(generator.error("uvw_matrix", "the matrix has no inverse; correct it"));
            }
            file_from_map = inverse * file_from_map;
            if generator.transform("uvw_transform")? != DAffine3::IDENTITY {
                self.warn(generator, "a shift or scale of the picture (uvw_transform) is not supported and was left out");
            }
            match generator.text("mapping_type")?.as_deref() {
                None | Some("spherical" | "spherical_vray" | "max_spherical") => {}
                Some("angular") => image = self.unrolled(image, |cos| cos.acos() / PI),
                Some("mirror_ball") => image = self.unrolled(image, |cos| (0.5 * (1.0 - cos)).max(0.0).sqrt()),
                Some(other) => {
                    self.warn(generator, format!("mapping {other:?} is not supported; the picture was taken for a spherical one"));
                }
            }
        }
        self.warn(texture, "how far the picture is turned about the vertical is a guess: its middle lies where y of its own space points");
        self.a.set_environment_map(image, MapRows::Bands, factor, file_from_map, &texture.place());
        Ok(())
    }

    /// The equirectangular picture of one that shows all directions in a disk: `radius` is the distance from its middle, as a share
    /// of its half width, by the cosine of the angle from the middle direction.
    fn unrolled(&mut self, image: u32, radius: impl Fn(f32) -> f32) -> u32 {
        let source = self.a.image_at(image);
        let (width, height) = (UNROLLED_WIDTH, UNROLLED_WIDTH / 2);
        let texture = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(image) };
        let texel = |i: u32| {
            let uv = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / Vec2::new(width as f32, height as f32);
            // Map space: the middle is +z, and seen from inside the right is −x.
            let d: Vec3 = direction_from_uv(uv);
            let aside = Vec2::new(-d.x, d.y).normalize_or_zero();
            let at = Vec2::splat(0.5) + aside * (0.5 * radius(d.z.clamp(-1.0, 1.0)));
            source.sample(&texture, at).0.to_array()
        };
        let pixels = Pixels::RgbF32((0..width * height).map(texel).collect());
        let name = format!("{} unrolled", source.name);
        self.a.push_image(Image { name, width, height, pixels })
    }
}

/// V-Ray's space of environment pictures, z up, from our space of pictures, y up: the middle of the picture (+z) is at +y.
fn z_up_from_map() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_X, DVec3::Z, DVec3::Y)
}
