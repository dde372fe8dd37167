//! The hand that makes a material: its pictures first, each made once, then the surface that carries them.

use crate::lamplight::Exposure;
use crate::palette::Palette;
use enfilade_math::{Rgb, Rng, Vec2, hash_text};
use enfilade_scene::{Bsdf, ColorParam, Image, Material, NormalMap, ScalarParam, Scene};
use enfilade_textures::{Paint, Skin, worn, worn_gloss};
use std::collections::BTreeMap;
use std::fmt::Debug;

/// The inputs of materials: the colours of the room, and the pictures made so far.
#[derive(Clone, Debug)]
pub(super) struct Stock {
    pub palette: Palette,
    pub exposure: Exposure,
    /// How much rougher varnish is where it has been used most.
    pub wear: f32,
    rng: Rng,
    /// By name and by what they depend on.
    pictures: BTreeMap<(&'static str, String), Paint>,
}

impl Stock {
    /// Without pictures yet; `rng` decides them.
    pub fn new(palette: Palette, exposure: Exposure, rng: Rng) -> Self {
        Self { palette, exposure, wear: 0.0, rng, pictures: BTreeMap::new() }
    }
}

/// Makes one material, and those of its pictures that do not exist yet.
pub(super) struct Maker<'a> {
    pub stock: &'a mut Stock,
    pub scene: &'a mut Scene,
}

impl Maker<'_> {
    /// The colours of the room.
    pub fn palette(&self) -> Palette {
        self.stock.palette
    }

    /// A seed that depends on the home, the name and the variant, but not on what was made before.
    pub fn seed(&self, name: &str, variant: &impl Debug) -> u32 {
        let text = format!("{name} {variant:?}");
        self.stock.rng.fork(hash_text(&text)).next_u64() as u32
    }

    /// The picture of this name and variant, made if there is none yet. It covers `covers` metres across and up.
    pub fn picture(&mut self, name: &'static str, variant: &impl Debug, covers: [f32; 2], make: impl FnOnce(u32) -> Image) -> Paint {
        let key = (name, format!("{variant:?}"));
        let known = self.stock.pictures.get(&key).copied();
        let image = known.map_or_else(
            || {
                self.scene.images.push(make(self.seed(name, variant)).into());
                self.scene.images.len() as u32 - 1
            },
            |paint| paint.image,
        );
        let paint = Paint { image, covers: Vec2::from_array(covers) };
        self.stock.pictures.insert(key, paint);
        paint
    }

    /// Pictures of a surface with its heights, which follow its colours in the scene; otherwise as [`Maker::picture`].
    pub fn skin(&mut self, name: &'static str, variant: &impl Debug, covers: [f32; 2], make: impl FnOnce(u32) -> Skin) -> Layers {
        let mut relief = None;
        let color = self.picture(name, variant, covers, |seed| {
            let skin = make(seed);
            relief = Some(skin.height);
            skin.color
        });
        self.scene.images.extend(relief.map(Into::into));
        Layers { color, relief: Paint { image: color.image + 1, ..color } }
    }
}

impl Maker<'_> {
    /// Pictures of a varnished surface, worn as the home is; otherwise as [`Maker::skin`].
    pub fn varnished(&mut self, name: &'static str, variant: &impl Debug, covers: [f32; 2], make: impl FnOnce(u32) -> Skin) -> Layers {
        let wear = self.stock.wear;
        self.skin(name, variant, covers, |seed| if wear > 0.0 { worn(make(seed), wear, seed) } else { make(seed) })
    }

    /// The roughness of lacquer that is `alpha` where it is new.
    pub fn gloss(&mut self, alpha: f32) -> ScalarParam {
        let wear = self.stock.wear;
        if wear == 0.0 {
            return alpha.into();
        }
        self.picture("worn gloss", &(), [0.9, 0.9], |seed| worn_gloss("worn gloss", wear, seed)).alpha(255.0 / 128.0 * alpha)
    }
}

/// The pictures of a surface in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layers {
    color: Paint,
    relief: Paint,
}

impl Layers {
    /// The colours multiplied by `factor`.
    pub fn tinted(&self, factor: Rgb) -> ColorParam {
        self.color.tinted(factor)
    }

    /// The roughness multiplied by `factor`.
    pub fn alpha(&self, factor: f32) -> ScalarParam {
        self.color.alpha(factor)
    }

    /// `material` with this relief, `depth_m` metres deep.
    pub fn relieved(&self, material: Material, depth_m: f32) -> Material {
        Material { normal_map: Some(NormalMap::Bump { texture: self.relief.texture(), scale: depth_m }), ..material }
    }
}

/// Matt paint, paper, cloth, clay: a rough diffuse surface of a roughness from 0 to 1.
pub fn rough(name: &str, reflectance: impl Into<ColorParam>, roughness: f32) -> Material {
    Material::new(name, Bsdf::RoughDiffuse { reflectance: reflectance.into(), roughness: roughness.into() })
}

/// Varnish, lacquer, glaze or plastic: a diffuse body under a clear coat of roughness `alpha`.
pub fn coated(name: &str, diffuse: impl Into<ColorParam>, alpha: impl Into<ScalarParam>) -> Material {
    let bsdf =
        Bsdf::Plastic { diffuse: diffuse.into(), eta: 1.5, alpha: alpha.into().into(), specular: Rgb::WHITE.into(), nonlinear: false };
    Material::new(name, bsdf)
}
