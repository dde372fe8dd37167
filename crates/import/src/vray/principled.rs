//! `BRDFVRayMtl`, V-Ray's general material.
//!
//! | V-Ray | here |
//! |---|---|
//! | `diffuse`, `roughness` | diffuse, or rough diffuse where nothing reflects |
//! | `reflect` with `fresnel`; `metalness`, `coat_*`, `sheen_*` | principled: `reflect` scales the reflection, roughness = 1 − glossiness (or the glossiness itself with `option_use_roughness`) |
//! | `reflect` without `fresnel` | a mirror mixed in by its strength |
//! | `refract` | glass mixed in by its strength; thin with `refract_thin_walled` or an index of 1, and frosted where it is thin and `refract_glossiness` is below 1 |
//! | `refract_affect_shadows` | on or off, light passes as the glass reflects, absorbs and bends it: straight on through panes |
//! | `fog_color`, `fog_color_tex`, `fog_mult`, `fog_depth` | absorption, −ln(colour) · `fog_mult` / `fog_depth` per centimetre, or per unit of the scene where `fog_unit_scale_on` is 0 |
//! | `opacity`, or `opacity_color` where `opacity_source` is 1; `opacity_mode` | shares of the surface that are there; mode 1 cuts at one half |
//! | `self_illumination`, `bump_map` | emission, perturbed normals |

use super::brdf::{DEFAULT_IOR, blend, diffuse, mirror};
use super::material::{MID_GREY, Surface};
use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Principled, ScalarParam};

/// Fog below this colour counts as this: a black one would absorb without limit.
const DARKEST_FOG: f32 = 1e-4;

/// A body whose index of refraction is nearer to 1 than this bends no light.
const NO_REFRACTION: f64 = 1e-3;

/// Length of the unit that V-Ray measures fog in.
const CENTIMETRE_M: f64 = 0.01;

/// Parameters without a counterpart and the values at which they do nothing.
const UNSUPPORTED: [(&str, f64); 5] =
    [("anisotropy", 0.0), ("translucency", 0.0), ("dispersion_on", 0.0), ("thin_film_on", 0.0), ("reflect_dim_distance_on", 0.0)];

impl<'n> Reader<'n, '_> {
    pub(super) fn vray_mtl(&mut self, m: Handle<'n>) -> Result<Surface, ImportError> {
        for (parameter, idle) in UNSUPPORTED {
            // A texture counts as something.
            if m.value(parameter)?.is_some_and(|v| v.number() != Some(idle)) {
                self.warn(m, format!("{parameter} is not supported and was left out"));
            }
        }
        let opaque = self.opaque(m)?;
        let bsdf = self.refracting(m, opaque)?;
        let mut emission = self.color(m, "self_illumination", Rgb::BLACK)?;
        emission.factor *= if m.flag("compensate_camera_exposure", false)? { 1.0 } else { self.exposure };
        let alpha = self.opacity(m)?;
        let normal_map = self.bump(m, "bump_map", "bump_amount", "bump_type")?;
        Ok(Surface { bsdf, emission, emits_both_sides: true, alpha, normal_map })
    }

    /// The scattering at the surface without refraction.
    fn opaque(&mut self, m: Handle<'n>) -> Result<Bsdf, ImportError> {
        let base = self.color(m, "diffuse", Rgb::splat(MID_GREY))?;
        let reflect = self.color(m, "reflect", Rgb::BLACK)?;
        let metallic = self.scalar(m, "metalness", 0.0)?;
        let coat = self.scalar(m, "coat_amount", 0.0)?;
        let sheen = self.color(m, "sheen_color", Rgb::BLACK)?;
        let plain = metallic.factor == 0.0 && coat.factor == 0.0 && sheen.factor.is_black();
        if plain && reflect.factor.is_black() {
            let roughness = self.scalar(m, "roughness", 0.0)?;
            return Ok(diffuse(base, roughness));
        }
        let as_roughness = m.flag("option_use_roughness", false)?;
        let roughness = self.roughness(m, "reflect_glossiness", 1.0, as_roughness)?;
        let (share, hue) = self.share_and_hue(m, "reflect", reflect);
        if plain && !m.flag("fresnel", false)? {
            let alpha = self.squared(m, roughness);
            return Ok(blend(Bsdf::Diffuse { reflectance: base }, mirror(hue.into(), alpha), share));
        }
        let ior = if m.flag("fresnel_ior_lock", true)? { "refract_ior" } else { "fresnel_ior" };
        Ok(Bsdf::Principled(Box::new(Principled {
            base_color: base,
            metallic,
            roughness,
            ior: self.plain_number(m, ior, DEFAULT_IOR)? as f32,
            specular: share,
            specular_color: hue.into(),
            clearcoat: coat,
            clearcoat_roughness: self.roughness(m, "coat_glossiness", 1.0, as_roughness)?,
            sheen_color: sheen,
            sheen_roughness: self.roughness(m, "sheen_glossiness", 0.8, as_roughness)?,
            ..Principled::default()
        })))
    }

    /// Glass in the place of `opaque` as far as the material refracts.
    fn refracting(&mut self, m: Handle<'n>, opaque: Bsdf) -> Result<Bsdf, ImportError> {
        let refract = self.color(m, "refract", Rgb::BLACK)?;
        if refract.factor.is_black() {
            return Ok(opaque);
        }
        let (share, hue) = self.share_and_hue(m, "refract", refract);
        let transmittance = ColorParam::from(hue);
        let ior = self.plain_number(m, "refract_ior", DEFAULT_IOR)?;
        if ior <= 0.0 {
            return Err(m.error("refract_ior", format!("found {ior}, expected a number above zero, such as 1.5; correct the value")));
        }
        let as_roughness = m.int("option_use_roughness", 0)? != 0;
        let bends = (ior - 1.0).abs() >= NO_REFRACTION;
        let glass = if m.flag("refract_thin_walled", false)? || !bends {
            let roughness = if bends { self.roughness(m, "refract_glossiness", 1.0, as_roughness)? } else { 0.0.into() };
            sheet(ior as f32, transmittance, roughness)
        } else {
            let roughness = self.roughness(m, "refract_glossiness", 1.0, as_roughness)?;
            let alpha = self.squared(m, roughness);
            Bsdf::Dielectric { eta: ior as f32, alpha: alpha.into(), transmittance, absorption: self.fog(m)? }
        };
        Ok(blend(opaque, glass, share))
    }

    /// Absorption within a refracting body, per metre.
    fn fog(&mut self, m: Handle<'n>) -> Result<Rgb, ImportError> {
        let color = self.plain_color(m, m.overriding("fog_color", "fog_color_tex")?, Rgb::WHITE)?;
        let mut depth = self.plain_number(m, "fog_depth", 1.0)?;
        if depth <= 0.0 {
            self.warn(m, format!("fog_depth is {depth} and not above zero, so it was left out"));
            depth = 1.0;
        }
        let unit_m = if m.flag("fog_unit_scale_on", true)? { CENTIMETRE_M } else { self.a.meters_per_unit() };
        let per_metre = (m.number("fog_mult", 1.0)?.max(0.0) / depth / unit_m) as f32;
        Ok(color.map(|c| -c.clamp(DARKEST_FOG, 1.0).ln() * per_metre))
    }

    fn opacity(&mut self, m: Handle<'n>) -> Result<Alpha, ImportError> {
        let parameter = if m.int("opacity_source", 0)? == 1 { "opacity_color" } else { "opacity" };
        let opacity = self.scalar(m, parameter, 1.0)?;
        Ok(if opacity == ScalarParam::from(1.0) {
            Alpha::Opaque
        } else if m.int("opacity_mode", 0)? == 1 {
            Alpha::Mask { opacity, cutoff: 0.5 }
        } else {
            Alpha::Blend { opacity }
        })
    }
}

/// A thin sheet of glass, clear or frosted.
fn sheet(ior: f32, transmittance: ColorParam, roughness: ScalarParam) -> Bsdf {
    if roughness == ScalarParam::from(0.0) {
        return Bsdf::ThinDielectric { eta: ior, transmittance };
    }
    Bsdf::Principled(Box::new(Principled { base_color: transmittance, roughness, ior, transmission: 1.0.into(), ..Principled::default() }))
}
