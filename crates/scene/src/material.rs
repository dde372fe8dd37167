//! Materials: how a surface scatters and emits light, what is cut out of it, and how its normals are perturbed.
//!
//! The variants of [`Bsdf`] are the materials of scene files; the renderer resolves each at a point to the lobes that it samples.

use crate::nesting::{self, nested};
use crate::texture::TextureRef;
use enfilade_math::Rgb;
use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};

/// A colour that may vary over the surface: `factor` × texture (1 without one).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColorParam {
    /// Linear factor.
    pub factor: Rgb,
    /// RGB of the texture multiplies the factor.
    pub texture: Option<TextureRef>,
}

/// A number that may vary over the surface: `factor` × channel of a texture (1 without one).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScalarParam {
    /// Linear factor.
    pub factor: f32,
    /// The texture and its channel (0 red … 3 alpha).
    pub texture: Option<(TextureRef, u8)>,
}

/// How rough an interface is: the width of its facets' slopes, and their distribution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Roughness {
    /// Alpha; 0 is smooth.
    pub param: ScalarParam,
    /// Distribution of the slopes.
    pub distribution: Distribution,
}

/// Distribution of the slopes of facets, and treatment of light between them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Distribution {
    /// Trowbridge and Reitz'; light that meets several facets in a row is kept, except under a plastic's coat.
    #[default]
    Ggx,
    /// Beckmann's, as Mitsuba has it: only single bounces count, and the facets mask both directions independently.
    Beckmann,
}

impl Deref for Roughness {
    type Target = ScalarParam;
    fn deref(&self) -> &ScalarParam {
        &self.param
    }
}

impl DerefMut for Roughness {
    fn deref_mut(&mut self) -> &mut ScalarParam {
        &mut self.param
    }
}

impl From<f32> for Roughness {
    fn from(alpha: f32) -> Self {
        ScalarParam::from(alpha).into()
    }
}

impl From<ScalarParam> for Roughness {
    /// Roughness of GGX facets.
    fn from(param: ScalarParam) -> Self {
        Self { param, distribution: Distribution::Ggx }
    }
}

impl From<Rgb> for ColorParam {
    fn from(factor: Rgb) -> Self {
        Self { factor, texture: None }
    }
}

impl From<f32> for ScalarParam {
    fn from(factor: f32) -> Self {
        Self { factor, texture: None }
    }
}

/// How light is scattered at a surface. `alpha` is the roughness of interfaces (0 = smooth); reflectances are in `[0,1]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Bsdf {
    /// Lambert's law.
    Diffuse {
        /// Reflectance.
        reflectance: ColorParam,
    },
    /// A rough diffuse surface (plaster, cloth, clay), by energy-preserving Oren–Nayar.
    RoughDiffuse {
        /// Reflectance. Light that bounces between the surface's own facets takes this colour each time.
        reflectance: ColorParam,
        /// 0 (Lambert's law) … 1.
        roughness: ScalarParam,
    },
    /// Metal by its complex index of refraction.
    Conductor {
        /// Real part. With `k` zero and `eta` zero the surface is a perfect mirror (Fresnel term 1).
        eta: Rgb,
        /// Imaginary part.
        k: Rgb,
        /// Multiplies the Fresnel reflectance.
        reflectance: ColorParam,
        /// Roughness.
        alpha: Roughness,
    },
    /// A solid transparent body: reflection and refraction by Fresnel's equations. Outward normals point to `eta` = 1.
    Dielectric {
        /// Interior over exterior index of refraction.
        eta: f32,
        /// Roughness.
        alpha: Roughness,
        /// Multiplies transmitted light at each crossing.
        transmittance: ColorParam,
        /// Beer–Lambert absorption inside, per metre.
        absorption: Rgb,
    },
    /// A pane too thin to displace light: reflects and transmits straight through, with all inner reflections.
    ThinDielectric {
        /// Index of refraction of the pane.
        eta: f32,
        /// Multiplies transmitted light.
        transmittance: ColorParam,
    },
    /// A diffuse base under a clear dielectric coat (Mitsuba's `plastic`/`roughplastic`).
    Plastic {
        /// Diffuse base colour.
        diffuse: ColorParam,
        /// Index of refraction of the coat.
        eta: f32,
        /// Roughness of the coat.
        alpha: Roughness,
        /// Multiplies the coat's reflection.
        specular: ColorParam,
        /// True when colour shifts by inner reflections are modelled (Mitsuba's `nonlinear`).
        nonlinear: bool,
    },
    /// glTF's metallic-roughness model with its common extensions.
    Principled(Box<Principled>),
    /// Disney's model, as Mitsuba has it in `principled` and `principledthin`.
    Disney(Box<Disney>),
    /// Two of these side by side.
    Blend {
        /// Scattering where the weight is 0.
        #[serde(deserialize_with = "nested")]
        first: Box<Bsdf>,
        /// Scattering where the weight is 1.
        #[serde(deserialize_with = "nested")]
        second: Box<Bsdf>,
        /// Share of the second.
        weight: ScalarParam,
    },
}

/// A parameter of a [`Bsdf`].
#[derive(Clone, Copy, Debug)]
pub enum Parameter<'a> {
    /// A colour.
    Color(&'a ColorParam),
    /// A number.
    Scalar(&'a ScalarParam),
}

/// A number of a [`Bsdf`] that is the same all over the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Constant {
    /// An index of refraction, or the ratio of two.
    Index(f32),
    /// A colour, one number per channel.
    Color(Rgb),
}

impl Bsdf {
    /// Blends within blends are no deeper than this.
    pub const DEEPEST: usize = nesting::MAX_DEPTH;

    /// How deep its blends within blends are; 0 for what is no blend.
    pub fn depth(&self) -> usize {
        match self {
            Self::Blend { first, second, .. } => 1 + first.depth().max(second.depth()),
            _ => 0,
        }
    }

    /// True when light passes, so that the surface always has two sides.
    pub fn transmits(&self) -> bool {
        match self {
            Self::Dielectric { .. } | Self::ThinDielectric { .. } => true,
            Self::Principled(p) => p.transmission.factor > 0.0,
            Self::Disney(p) => p.spec_trans.factor > 0.0 || p.thin && p.diff_trans.factor > 0.0,
            Self::Blend { first, second, .. } => first.transmits() || second.transmits(),
            Self::Diffuse { .. } | Self::RoughDiffuse { .. } | Self::Conductor { .. } | Self::Plastic { .. } => false,
        }
    }

    /// True when light may go straight on through the surface.
    pub fn is_pane(&self) -> bool {
        match self {
            Self::ThinDielectric { .. } => true,
            Self::Principled(p) => !p.solid && p.transmission.factor > 0.0,
            Self::Disney(p) => p.is_pane(),
            Self::Blend { first, second, .. } => first.is_pane() || second.is_pane(),
            _ => false,
        }
    }

    /// Calls `found` with every number that may not be textured.
    pub(crate) fn constants(&self, found: &mut dyn FnMut(Constant)) {
        match self {
            Self::Diffuse { .. } | Self::RoughDiffuse { .. } => (),
            Self::Conductor { eta, k, .. } => [*eta, *k].into_iter().for_each(|v| found(Constant::Color(v))),
            Self::Dielectric { eta, absorption, .. } => {
                found(Constant::Index(*eta));
                found(Constant::Color(*absorption));
            }
            Self::ThinDielectric { eta, .. } | Self::Plastic { eta, .. } => found(Constant::Index(*eta)),
            Self::Principled(p) => {
                found(Constant::Index(p.ior));
                found(Constant::Color(p.absorption));
            }
            Self::Disney(p) => found(Constant::Index(p.eta)),
            Self::Blend { first, second, .. } => {
                first.constants(found);
                second.constants(found);
            }
        }
    }

    /// Calls `found` with every parameter that may be textured.
    pub fn parameters<'a>(&'a self, found: &mut dyn FnMut(Parameter<'a>)) {
        let mut all = |colors: &[&'a ColorParam], scalars: &[&'a ScalarParam]| {
            colors.iter().for_each(|p| found(Parameter::Color(p)));
            scalars.iter().for_each(|p| found(Parameter::Scalar(p)));
        };
        match self {
            Self::Diffuse { reflectance } => all(&[reflectance], &[]),
            Self::RoughDiffuse { reflectance, roughness } => all(&[reflectance], &[roughness]),
            Self::Conductor { reflectance, alpha, .. } => all(&[reflectance], &[alpha]),
            Self::Dielectric { transmittance, alpha, .. } => all(&[transmittance], &[alpha]),
            Self::ThinDielectric { transmittance, .. } => all(&[transmittance], &[]),
            Self::Plastic { diffuse, specular, alpha, .. } => all(&[diffuse, specular], &[alpha]),
            Self::Blend { first, second, weight } => {
                all(&[], &[weight]);
                first.parameters(found);
                second.parameters(found);
            }
            Self::Disney(p) => all(&[&p.base_color], &p.scalars()),
            Self::Principled(p) => all(
                &[&p.base_color, &p.specular_color, &p.sheen_color],
                &[&p.metallic, &p.roughness, &p.specular, &p.transmission, &p.clearcoat, &p.clearcoat_roughness, &p.sheen_roughness],
            ),
        }
    }
}

/// glTF 2.0 metallic-roughness with the ratified extensions that rooms use.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Principled {
    /// Diffuse colour of dielectrics, reflectance at normal incidence of metals.
    pub base_color: ColorParam,
    /// 0 dielectric … 1 metal.
    pub metallic: ScalarParam,
    /// Perceptual roughness; GGX alpha is its square.
    pub roughness: ScalarParam,
    /// Index of refraction (1.5 unless `KHR_materials_ior` states another).
    pub ior: f32,
    /// `KHR_materials_specular` strength.
    pub specular: ScalarParam,
    /// `KHR_materials_specular` colour at normal incidence.
    pub specular_color: ColorParam,
    /// `KHR_materials_transmission` share of the dielectric that transmits.
    pub transmission: ScalarParam,
    /// True for a solid body (`KHR_materials_volume` with thickness): transmitted light refracts. False: a thin sheet, frosted by its roughness.
    pub solid: bool,
    /// Beer–Lambert absorption inside a solid body, per metre.
    pub absorption: Rgb,
    /// `KHR_materials_clearcoat` strength.
    pub clearcoat: ScalarParam,
    /// Perceptual roughness of the coat.
    pub clearcoat_roughness: ScalarParam,
    /// `KHR_materials_sheen` colour; black means none.
    pub sheen_color: ColorParam,
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: ScalarParam,
}

impl Default for Principled {
    /// glTF's defaults, except for a dielectric instead of a metal.
    fn default() -> Self {
        Self {
            base_color: Rgb::WHITE.into(),
            metallic: 0.0.into(),
            roughness: 1.0.into(),
            ior: 1.5,
            specular: 1.0.into(),
            specular_color: Rgb::WHITE.into(),
            transmission: 0.0.into(),
            solid: false,
            absorption: Rgb::BLACK,
            clearcoat: 0.0.into(),
            clearcoat_roughness: 0.0.into(),
            sheen_color: Rgb::BLACK.into(),
            sheen_roughness: 0.0.into(),
        }
    }
}

/// Disney's model with the parameters of Mitsuba 3's `principled` and `principledthin`; roughness is the same in all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disney {
    /// Colour of the diffuse base, of metals and, by its root, of what is seen through.
    pub base_color: ColorParam,
    /// Perceptual roughness; alpha is its square.
    pub roughness: ScalarParam,
    /// 0 dielectric … 1 metal; sheets have none.
    pub metallic: ScalarParam,
    /// Interior over exterior index of refraction.
    pub eta: f32,
    /// Share of the dielectric that transmits.
    pub spec_trans: ScalarParam,
    /// How much of the base's hue the dielectric's reflection has.
    pub spec_tint: ScalarParam,
    /// Strength of the fuzz.
    pub sheen: ScalarParam,
    /// How much of the base's hue the fuzz has.
    pub sheen_tint: ScalarParam,
    /// From the diffuse base (0) to one that looks like skin (1).
    pub flatness: ScalarParam,
    /// Strength of the clear-coat; sheets have none.
    pub clearcoat: ScalarParam,
    /// The clear-coat's gloss; its alpha ranges from 0.1 to 0.001.
    pub clearcoat_gloss: ScalarParam,
    /// True for a sheet without thickness (`principledthin`).
    pub thin: bool,
    /// Twice the share of diffuse light that a sheet passes to its other side.
    pub diff_trans: ScalarParam,
}

impl Disney {
    /// True for a smooth sheet: light passes straight through it.
    pub fn is_pane(&self) -> bool {
        self.thin && self.spec_trans.factor > 0.0 && self.roughness.factor == 0.0
    }

    /// All parameters that are numbers and may be textured.
    pub fn scalars(&self) -> [&ScalarParam; 10] {
        [
            &self.roughness,
            &self.metallic,
            &self.spec_trans,
            &self.spec_tint,
            &self.sheen,
            &self.sheen_tint,
            &self.flatness,
            &self.clearcoat,
            &self.clearcoat_gloss,
            &self.diff_trans,
        ]
    }

    /// The scalar parameters, to change.
    pub fn scalars_mut(&mut self) -> [&mut ScalarParam; 10] {
        [
            &mut self.roughness,
            &mut self.metallic,
            &mut self.spec_trans,
            &mut self.spec_tint,
            &mut self.sheen,
            &mut self.sheen_tint,
            &mut self.flatness,
            &mut self.clearcoat,
            &mut self.clearcoat_gloss,
            &mut self.diff_trans,
        ]
    }
}

/// The parts of the surface that are cut out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Alpha {
    /// Nothing.
    #[default]
    Opaque,
    /// Present where the opacity is at least the cutoff.
    Mask {
        /// Opacity over the surface.
        opacity: ScalarParam,
        /// Threshold on `[0,1]`.
        cutoff: f32,
    },
    /// Present with probability equal to the opacity.
    Blend {
        /// Opacity over the surface.
        opacity: ScalarParam,
    },
}

/// A perturbation of the shading normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum NormalMap {
    /// Tangent-space normals, n = 2·rgb − 1, y along +v (OpenGL's convention); x and y are multiplied by `scale`.
    Normal {
        /// The map; its image must be linear data.
        texture: TextureRef,
        /// Strength.
        scale: f32,
    },
    /// Heights in metres: luminance × `scale`.
    Bump {
        /// The map.
        texture: TextureRef,
        /// Metres for a texture value of one.
        scale: f32,
    },
}

/// The material of a part's surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name from the file, or a stable one that the importer made.
    pub name: String,
    /// Scattering.
    pub bsdf: Bsdf,
    /// Emitted radiance in W·sr⁻¹·m⁻² (or the file's own units), uniform over directions; black means none.
    pub emission: ColorParam,
    /// True when the surface also scatters and emits on its back. Transmitting BSDFs always have two sides.
    pub two_sided: bool,
    /// True when light is emitted on the back as well.
    pub emits_both_sides: bool,
    /// Cut-outs.
    pub alpha: Alpha,
    /// Perturbed normals.
    pub normal_map: Option<NormalMap>,
}

impl Material {
    /// A two-sided opaque surface that emits nothing.
    pub fn new(name: impl Into<String>, bsdf: Bsdf) -> Self {
        Self {
            name: name.into(),
            bsdf,
            emission: Rgb::BLACK.into(),
            two_sided: true,
            emits_both_sides: false,
            alpha: Alpha::Opaque,
            normal_map: None,
        }
    }

    /// A two-sided Lambert surface of one colour.
    pub fn diffuse(name: impl Into<String>, reflectance: Rgb) -> Self {
        Self::new(name, Bsdf::Diffuse { reflectance: reflectance.into() })
    }

    /// Whether its surface has holes or is see-through, by its opacity.
    pub fn is_partly_there(&self) -> bool {
        match self.alpha {
            Alpha::Opaque => false,
            Alpha::Mask { opacity, .. } => opacity.texture.is_some(),
            Alpha::Blend { opacity } => opacity.texture.is_some() || opacity.factor < 1.0,
        }
    }

    /// Calls `found` with every texture that the material reads.
    pub fn textures<'a>(&'a self, mut found: impl FnMut(&'a TextureRef)) {
        self.bsdf.parameters(&mut |parameter| match parameter {
            Parameter::Color(p) => p.texture.iter().for_each(&mut found),
            Parameter::Scalar(p) => p.texture.iter().for_each(|(t, _)| found(t)),
        });
        self.emission.texture.iter().for_each(&mut found);
        if let Alpha::Mask { opacity, .. } | Alpha::Blend { opacity } = &self.alpha {
            opacity.texture.iter().for_each(|(t, _)| found(t));
        }
        if let Some(NormalMap::Normal { texture, .. } | NormalMap::Bump { texture, .. }) = &self.normal_map {
            found(texture);
        }
    }

    /// A black surface that emits `radiance` on its front.
    pub fn emitter(name: impl Into<String>, radiance: Rgb) -> Self {
        Self { emission: radiance.into(), ..Self::diffuse(name, Rgb::BLACK) }
    }
}
