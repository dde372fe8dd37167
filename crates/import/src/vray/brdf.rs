//! The simpler BRDF plugins, and layers of several.

use super::material::Surface;
use super::plugins::Handle;
use super::reader::Reader;
use crate::{ImportError, images};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, NormalMap, ScalarParam};

/// Index of refraction where a plugin does not state it.
pub(super) const DEFAULT_IOR: f64 = 1.6;

impl<'n> Reader<'n, '_> {
    /// A BRDF that is neither layers nor the general material.
    pub(super) fn brdf(&mut self, plugin: Handle<'n>) -> Result<Surface, ImportError> {
        let tint = if plugin.plugin.parameter("color_tex").is_some() { "color_tex" } else { "color" };
        let color = |reader: &mut Self| reader.color(plugin, tint, Rgb::WHITE);
        let mut surface: Surface = match plugin.kind() {
            "BRDFDiffuse" => {
                let (reflectance, roughness) = (color(self)?, self.scalar(plugin, "roughness", 0.0)?);
                diffuse(reflectance, roughness).into()
            }
            "BRDFMirror" => mirror(color(self)?, 0.0.into()).into(),
            "BRDFPhong" | "BRDFBlinn" | "BRDFGGX" | "BRDFWard" | "BRDFCookTorrance" => {
                // Highlights of other shapes become GGX of the same glossiness.
                let parameter =
                    if plugin.plugin.parameter("reflectionGlossiness").is_some() { "reflectionGlossiness" } else { "glossiness" };
                let roughness = self.roughness(plugin, parameter, 0.8, false)?;
                mirror(color(self)?, self.squared(plugin, roughness)).into()
            }
            "BRDFGlass" | "BRDFGlassGlossy" => {
                let roughness = self.roughness(plugin, "glossiness", 1.0, false)?;
                let alpha = self.squared(plugin, roughness);
                let eta = plugin.number("ior", DEFAULT_IOR)? as f32;
                Bsdf::Dielectric { eta, alpha: alpha.into(), transmittance: color(self)?, absorption: Rgb::BLACK }.into()
            }
            "BRDFLight" => {
                let multiplier = self.plain_number(plugin, "colorMultiplier", 1.0)? as f32;
                let mut emission = color(self)?;
                emission.factor *= multiplier * if plugin.flag("compensateExposure", false)? { 1.0 } else { self.exposure };
                let emits_both_sides = plugin.flag("emitOnBackSide", false)?;
                Surface { emission, emits_both_sides, ..Bsdf::Diffuse { reflectance: Rgb::BLACK.into() }.into() }
            }
            _ => return self.substitute(plugin),
        };
        let see_through = plugin.plugin.parameter("transparency_tex").map_or("transparency", |_| "transparency_tex");
        let opacity = self.complement(plugin, see_through, 0.0)?;
        if opacity != ScalarParam::from(1.0) {
            surface.alpha = Alpha::Blend { opacity };
        }
        Ok(surface)
    }

    /// Layers over a base: the first of the list is the uppermost.
    pub(super) fn layered(&mut self, plugin: Handle<'n>, depth: usize) -> Result<Surface, ImportError> {
        let mut layers = plugin.references("brdfs")?;
        let weights = match plugin.value("weights")? {
            Some(enfilade_vrscene::Value::List(_, list)) => list,
            Some(single) => vec![single],
            None => Vec::new(),
        };
        if plugin.flag("additive_mode", false)? {
            self.warn(plugin, "layers that add light are not supported; each covers those below it");
        }
        let base = match plugin.reference("base_brdf")? {
            Some(base) => base,
            None => match layers.pop() {
                Some(last) => last,
                None => return self.substitute(plugin),
            },
        };
        let mut result = self.surface(base, depth + 1)?;
        for (i, layer) in layers.into_iter().enumerate().rev() {
            let weight = match weights.get(i) {
                Some(value) => self.scalar_of(plugin, "weights", value)?,
                None => 1.0.into(),
            };
            let over = self.surface(layer, depth + 1)?;
            if !over.emission.factor.is_black() {
                if !result.emission.factor.is_black() {
                    self.warn(plugin, "several layers emit light; the uppermost one counts");
                }
                result.emission = ColorParam { factor: over.emission.factor * weight.factor, ..over.emission };
                result.emits_both_sides = over.emits_both_sides;
            }
            result.normal_map = over.normal_map.or(result.normal_map);
            result.bsdf = blend(result.bsdf, over.bsdf, weight);
        }
        Ok(result)
    }

    /// Perturbed normals by a texture parameter: a height, or normals in tangent space.
    pub(super) fn bump(&mut self, plugin: Handle<'n>, texture: &str, amount: &str, kind: &str) -> Result<Option<NormalMap>, ImportError> {
        let (mut plugin, mut names) = (plugin, [texture, amount, kind]);
        if let Some(within) = plugin.reference(texture).ok().flatten()
            && within.kind() == "TexNormalBump"
        {
            (plugin, names) = (within, ["bump_tex_color", "bump_tex_mult", "map_type"]);
        }
        let [texture, amount, kind] = names;
        let map = self.color(plugin, texture, Rgb::BLACK)?;
        let Some(texture) = map.texture else { return Ok(None) };
        let scale = self.plain_number(plugin, amount, 1.0)? as f32;
        match plugin.int(kind, if plugin.kind() == "TexNormalBump" { 1 } else { 0 })? {
            0 => {
                self.warn(plugin, "the strength of the bump is a guess: heights count as units of the scene");
                Ok(Some(NormalMap::Bump { texture, scale: scale * self.a.meters_per_unit() as f32 * map.factor.luminance() }))
            }
            1 => {
                if plugin.flag("flip_green", false)? || plugin.flag("flip_red", false)? {
                    self.warn(plugin, "the turned axes of the normal map (flip_red, flip_green) were not turned");
                }
                Ok(Some(NormalMap::Normal { texture, scale }))
            }
            other => {
                self.warn(
                    plugin,
                    format!("normal maps of type {other} (object, screen or world space) are not supported; it was left out"),
                );
                Ok(None)
            }
        }
    }

    /// A colour parameter that scales something as a share of it and the hue that remains: the largest component, and the colour over it.
    pub(super) fn share_and_hue(&mut self, plugin: Handle, parameter: &str, color: ColorParam) -> (ScalarParam, Rgb) {
        let largest = color.factor.max_component();
        if largest <= 0.0 {
            return (0.0.into(), Rgb::WHITE);
        }
        if color.texture.is_some_and(|texture| !images::is_grey(self.a.image_at(texture.image))) {
            self.warn(plugin, format!("the texture of {parameter} is coloured; its red channel was used"));
        }
        let share = ScalarParam { factor: largest.min(1.0), texture: color.texture.map(|t| (t, 0)) };
        (share, color.factor / largest)
    }
}

/// A surface by Lambert's law or Oren and Nayar's.
pub(super) fn diffuse(reflectance: ColorParam, roughness: ScalarParam) -> Bsdf {
    if roughness == ScalarParam::from(0.0) {
        return Bsdf::Diffuse { reflectance };
    }
    Bsdf::RoughDiffuse { reflectance, roughness }
}

/// A reflection of the same strength at all angles.
pub(super) fn mirror(reflectance: ColorParam, alpha: ScalarParam) -> Bsdf {
    Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance, alpha: alpha.into() }
}

/// `over` with a weight on `under`; only one of them if the weight is 0 or 1.
pub(super) fn blend(under: Bsdf, over: Bsdf, weight: ScalarParam) -> Bsdf {
    if weight == ScalarParam::from(0.0) {
        under
    } else if weight == ScalarParam::from(1.0) {
        over
    } else {
        Bsdf::Blend { first: Box::new(under), second: Box::new(over), weight }
    }
}
