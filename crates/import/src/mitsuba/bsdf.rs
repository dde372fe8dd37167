//! BSDFs to materials: the adapters (`twosided`, `mask`, `bumpmap`, blends, coats) around those that scatter light.

use super::reader::Reader;
use super::scattering::eta;
use super::texture::Texture;
use super::xml::Node;
use crate::ImportError;
use crate::images::Use;
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, ScalarParam};

/// A bsdf being read: what it scatters, and what the adapters around it add.
pub(super) struct Surface {
    /// `None` for `null`, which scatters nothing.
    bsdf: Option<Bsdf>,
    two_sided: bool,
    pub alpha: Alpha,
    normal_map: Option<NormalMap>,
}

impl Surface {
    fn plain(bsdf: Bsdf) -> Self {
        Self { bsdf: Some(bsdf), two_sided: false, alpha: Alpha::Opaque, normal_map: None }
    }
}

impl<'n> Reader<'n, '_> {
    /// The material of a bsdf and an area emitter, with a medium within. `None` where there is nothing to see.
    pub(super) fn material(
        &mut self,
        bsdf: Option<&'n Node>,
        emitter: Option<&'n Node>,
        medium: Option<&'n Node>,
    ) -> Result<Option<u32>, ImportError> {
        let key = ([bsdf, emitter, medium].map(|node| node.map(std::ptr::from_ref)), self.attributes.current);
        if let Some(&known) = self.materials.get(&key) {
            return Ok(Some(known));
        }
        let surface = match bsdf {
            Some(node) => self.surface(node, 0)?,
            // A lamp without a bsdf of its own is black.
            None => Surface::plain(Bsdf::Diffuse { reflectance: Rgb::splat(if emitter.is_some() { 0.0 } else { 0.5 }).into() }),
        };
        let emission: ColorParam = match emitter {
            Some(emitter) => self.color(emitter, "radiance", Kind::Emission, Rgb::WHITE)?,
            None => Rgb::BLACK.into(),
        };
        let bsdf_itself = match surface.bsdf {
            Some(bsdf) => bsdf,
            None if emitter.is_some() => Bsdf::Diffuse { reflectance: Rgb::BLACK.into() },
            None => return Ok(None),
        };
        let bsdf_itself = match medium {
            Some(medium) => self.filled(bsdf_itself, medium)?,
            None => bsdf_itself,
        };
        let suffix = if emitter.is_some() { "_emitter" } else { "" };
        let material = Material {
            name: format!("{}{suffix}", name(bsdf)),
            bsdf: bsdf_itself,
            emission,
            two_sided: surface.two_sided,
            emits_both_sides: false,
            alpha: surface.alpha,
            normal_map: surface.normal_map,
        };
        let index = self.a.push_material(material);
        self.materials.insert(key, index);
        Ok(Some(index))
    }

    fn surface(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.visit(node, depth, "bsdfs")?;
        match node.plugin.as_str() {
            "twosided" => {
                self.report_unknown(node, &[], &["bsdf"]);
                if self.objects(node, "bsdf")?.len() > 1 {
                    self.warn(node, "the second bsdf, for the back, was dropped; the first one is on both sides");
                }
                Ok(Surface { two_sided: true, ..self.inner(node, depth)? })
            }
            "mask" => self.mask(node, depth),
            "bumpmap" | "bump" => self.bump_map(node, depth),
            "normalmap" => self.normal_map(node, depth),
            "blendbsdf" | "mixturebsdf" => self.blend(node, depth),
            "coating" | "roughcoating" => self.coating(node, depth),
            "null" => Ok(Surface { bsdf: None, ..Surface::plain(Bsdf::Diffuse { reflectance: Rgb::BLACK.into() }) }),
            _ => Ok(Surface::plain(self.scattering(node)?)),
        }
    }

    /// The bsdf within an adapter.
    pub(super) fn inner(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        let inner = self.objects(node, "bsdf")?.first().copied();
        let inner = inner.ok_or_else(|| node.error(format!("there is no bsdf within the {}", node.plugin)))?;
        self.surface(inner, depth + 1)
    }

    fn bump_map(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["scale"], &["bsdf", "texture"]);
        let surface = self.inner(node, depth)?;
        let Some(texture) = self.objects(node, "texture")?.first().copied() else {
            return Err(node.error("there is no texture within the bump map"));
        };
        let Texture { factor, picture, .. } = self.texture(texture, Use::Color, 0)?;
        let scale = factor.g * (node.float_or("scale", 1.0)? * self.a.meters_per_unit()) as f32;
        Ok(Surface { normal_map: picture.map(|texture| NormalMap::Bump { texture, scale }), ..surface })
    }

    fn normal_map(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["normalmap"], &["bsdf", "texture"]);
        let surface = self.inner(node, depth)?;
        let Some(texture) = self.objects(node, "texture")?.first().copied() else {
            return Err(node.error("there is no texture within the normal map"));
        };
        let picture = self.texture(texture, Use::Data, 0)?.picture;
        Ok(Surface { normal_map: picture.map(|texture| NormalMap::Normal { texture, scale: 1.0 }), ..surface })
    }

    /// Two bsdfs by a weight, or several by a list of weights.
    fn blend(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["weight", "weights"], &["bsdf", "texture"]);
        let inner = self.objects(node, "bsdf")?;
        let weights = match node.child("weights") {
            Some(list) => list.numbers("value")?.into_iter().map(|w| w.max(0.0) as f32).collect(),
            None => vec![0.5; 2],
        };
        if inner.len() < 2 || inner.len() != weights.len() {
            return Err(node.error(format!(
                "found {} bsdfs and {} weights, expected as many of each, and two at least",
                inner.len(),
                weights.len()
            )));
        }
        let total: f32 = weights.iter().sum();
        if node.child("weights").is_some() && (total - 1.0).abs() > 1e-3 {
            self.warn(node, format!("the weights add up to {total}; they were scaled to 1"));
        }
        // The last two first: each step blends one more in front of them.
        let mut blended = self.surface(inner[inner.len() - 1], depth + 1)?;
        let mut weight_behind = weights[weights.len() - 1];
        for i in (0..inner.len() - 1).rev() {
            let first = self.surface(inner[i], depth + 1)?;
            let sum = weights[i] + weight_behind;
            let weight = match node.child("weights") {
                Some(_) => if sum > 0.0 { weight_behind / sum } else { 0.5 }.into(),
                None => self.scalar(node, "weight", 0.5)?,
            };
            blended = self.blend_two(node, first, blended, weight);
            if blended.bsdf.as_ref().is_some_and(|bsdf| bsdf.depth() > Bsdf::DEEPEST) {
                return Err(node.error(format!("bsdfs are blended more than {} deep; blend fewer", Bsdf::DEEPEST)));
            }
            weight_behind = sum;
        }
        Ok(blended)
    }

    /// `weight` is the share of the second.
    fn blend_two(&mut self, node: &'n Node, first: Surface, second: Surface, weight: ScalarParam) -> Surface {
        if first.normal_map != second.normal_map || first.alpha != second.alpha {
            self.warn(node, "normal maps and masks within a blend are not blended; those of the heavier bsdf are on both");
        }
        let second_is_heavier = weight.texture.is_none() && weight.factor > 0.5;
        let (alpha, normal_map) = if second_is_heavier { (second.alpha, second.normal_map) } else { (first.alpha, first.normal_map) };
        let two_sided = first.two_sided || second.two_sided;
        let surface = |bsdf, alpha| Surface { bsdf, two_sided, alpha, normal_map };
        match (first.bsdf, second.bsdf) {
            (Some(first), Some(second)) => surface(Some(Bsdf::Blend { first: Box::new(first), second: Box::new(second), weight }), alpha),
            // Nothing in part of the surface is an opacity.
            (None, bsdf) if bsdf.is_some() => surface(bsdf, Alpha::Blend { opacity: weight }),
            (bsdf, _) if weight.texture.is_none() => surface(bsdf, Alpha::Blend { opacity: (1.0 - weight.factor).into() }),
            (bsdf, _) => {
                self.warn(node, "a textured blend towards null is not supported; the first bsdf was used");
                surface(bsdf, alpha)
            }
        }
    }

    fn coating(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        let known = ["int_ior", "ext_ior", "alpha", "distribution", "specular_reflectance", "thickness", "sigma_a", "nonlinear"];
        self.report_unknown(node, &known, &["bsdf"]);
        let surface = self.inner(node, depth)?;
        let Some(Bsdf::Diffuse { reflectance }) = surface.bsdf else {
            self.warn(node, "a coat over anything but a diffuse base is not supported; the coat was dropped");
            return Ok(surface);
        };
        self.warn(node, "a coat over a diffuse base was taken for plastic");
        let alpha = self.alpha(node)?;
        let eta = eta(node, "bk7")? as f32;
        let bsdf = Bsdf::Plastic { diffuse: reflectance, eta, alpha, specular: Rgb::WHITE.into(), nonlinear: false };
        Ok(Surface { bsdf: Some(bsdf), ..surface })
    }
}

/// The name of a bsdf's material: its id, or `inline`.
pub(super) fn name(bsdf: Option<&Node>) -> &str {
    bsdf.and_then(|b| b.id.as_deref()).unwrap_or("inline")
}
