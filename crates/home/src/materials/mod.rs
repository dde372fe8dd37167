//! What surfaces are made of: each [`Finish`] becomes a material when the first thing asks for it.
//!
//! Reflectances follow measured ones: white emulsion 0.8, glaze and washed cotton 0.76, pale wood 0.4 to 0.5, concrete 0.35, dark wood
//! and leather 0.05 to 0.15, black plastic 0.025. Pictures that take their colour from a factor are shared by all rooms.

mod cloth;
mod finish;
mod glass;
mod luminous;
mod metal;
mod nature;
mod solid;
mod wall;

pub use finish::{Finish, Surfacing};

use crate::light::{Exposure, Glow, LightConfig};
use crate::palette::Palette;
use crate::texture::{Paint, Skin};
use enfilade_geometry::Mesh;
use enfilade_math::{Rgb, Rng, Vec2};
use enfilade_scene::{Bsdf, ColorParam, Image, Material, NormalMap, ScalarParam, Scene};
use std::collections::BTreeMap;
use std::fmt::Debug;

/// The materials and pictures made so far, and the palette that new ones take their colours from.
#[derive(Clone, Debug)]
pub struct Materials {
    palette: Palette,
    /// Which palette that is, counted in the order in which rooms were entered.
    room: u32,
    rng: Rng,
    light: LightConfig,
    exposure: Exposure,
    materials: BTreeMap<(u32, Finish), u32>,
    /// By name and by what they depend on.
    pictures: BTreeMap<(&'static str, String), Paint>,
}

impl Materials {
    /// None yet. `rng` decides the pictures, `light` how bright what glows is.
    pub fn new(palette: Palette, light: LightConfig, rng: Rng) -> Self {
        let exposure = light.exposure();
        Self { palette, room: 0, rng, light, exposure, materials: BTreeMap::new(), pictures: BTreeMap::new() }
    }

    /// From now on finishes have the colours of `palette`.
    pub fn enter_room(&mut self, palette: Palette) {
        (self.palette, self.room) = (palette, self.room + 1);
    }

    /// Index of the material, made and added to `scene` if there is none yet.
    pub fn get(&mut self, scene: &mut Scene, finish: Finish) -> u32 {
        let key = (self.room, finish);
        if let Some(&known) = self.materials.get(&key) {
            return known;
        }
        let material = Maker { stock: self, scene }.material(finish);
        let index = add(scene, material);
        self.materials.insert(key, index);
        index
    }

    /// The material of a luminous part with this mesh; the lamp's name decides whether it is lit, unless it always is.
    pub fn glow(&self, scene: &mut Scene, lamp: &str, always: bool, mesh: &Mesh, glow: Glow) -> u32 {
        add(scene, glow.material(mesh, always || self.light.lit(lamp), self.exposure))
    }
}

/// Index of a material of the scene; equal ones are stored once.
fn add(scene: &mut Scene, material: Material) -> u32 {
    let found = scene.materials.iter().position(|m| *m == material);
    found.unwrap_or_else(|| {
        scene.materials.push(material);
        scene.materials.len() - 1
    }) as u32
}

/// Makes one material, and the pictures that it is the first to need.
struct Maker<'a> {
    stock: &'a mut Materials,
    scene: &'a mut Scene,
}

impl Maker<'_> {
    fn material(&mut self, finish: Finish) -> Material {
        let palette = self.palette();
        match finish {
            Finish::WallPaint => self.wall_paint("wall paint", palette.wall),
            Finish::AccentWallPaint => self.wall_paint("accent wall paint", palette.accent_wall),
            Finish::Wallpaper => self.wallpaper(),
            Finish::CeilingPaint => self.wall_paint("ceiling paint", Rgb::new(0.83, 0.825, 0.81)),
            Finish::Plaster => self.lime_plaster(palette.wall),
            Finish::Brick => self.brick(),
            Finish::PlankFloor => self.plank_floor(),
            Finish::ParquetFloor => self.parquet_floor(),
            Finish::FloorTile => self.tiles("floor tiles", palette.floor_tile),
            Finish::WallTile => self.tiles("wall tiles", palette.wall_tile),
            Finish::Terrazzo => self.terrazzo(),
            Finish::Concrete => self.concrete(),
            Finish::Carpet => self.carpet(),
            Finish::Coir => self.felt("coir", 64, 0.3, Rgb::new(0.25, 0.155, 0.08), 0.004),

            Finish::Wood => self.veneer("veneer", false),
            Finish::DarkWood => self.veneer("stained wood", true),
            Finish::WhitePaint => self.lacquer("white paint", Rgb::new(0.76, 0.755, 0.73), 0.16),
            Finish::WhiteLacquer => self.lacquer("white lacquer", Rgb::new(0.74, 0.735, 0.715), 0.10),
            Finish::ColoredLacquer(i) => self.lacquer("coloured lacquer", self.paint_color(i), 0.14),
            Finish::KitchenFront(i) => self.lacquer("kitchen front", palette.kitchen[usize::from(i) % 2], 0.20),
            Finish::Worktop => self.worktop(),
            Finish::Cork => self.cork(),

            Finish::Stone => self.slab("honed stone", crate::texture::SlabLook::LIMESTONE, 3.0),
            Finish::MarbleTop => self.slab("polished stone", palette.slab, 1.0),
            Finish::Porcelain => coated("porcelain", Rgb::new(0.77, 0.77, 0.755), 0.03),
            Finish::Ceramic(i) => self.ceramic(i),
            Finish::Terracotta => self.terracotta(),

            Finish::SofaCloth => self.upholstery("sofa cloth", palette.sofa),
            Finish::ArmchairCloth => self.upholstery("armchair cloth", palette.armchair),
            Finish::CurtainLinen => self.linen("curtain linen", palette.curtain),
            Finish::SheerCurtain => self.sheer(),
            Finish::ShowerCurtain => coated("shower curtain", palette.linen[0].lerp(Rgb::splat(0.7), 0.5), 0.3),
            Finish::RugWool => self.rug(),
            Finish::Accent(i) => self.linen("cushion cloth", palette.accents[usize::from(i) % 3]),
            Finish::KnittedThrow => self.knitted(palette.accents[2]),
            Finish::Velvet => self.velvet(),
            Finish::Boucle => self.boucle(),
            Finish::BedLinen(i) => self.bed_linen(i),
            Finish::Mattress => self.mattress(),
            Finish::Towel(i) => self.towel(i),
            Finish::Clothes(i) => self.clothes(i),
            Finish::Felt => self.felt("felt", 40, 0.25, palette.art[3], 0.000_5),

            Finish::Leather => self.leather("leather", palette.leather),
            Finish::LeatherBag(i) => self.leather_bag(i),
            Finish::Wicker => self.wicker("wicker", 24, 0.24, Rgb::new(0.50, 0.36, 0.21)),
            Finish::Rattan => self.wicker("rattan", 48, 0.24, Rgb::new(0.60, 0.44, 0.26)),

            Finish::Steel => self.brushed("brushed steel", metal::STEEL, 0.20),
            Finish::Chrome => metal::conductor("chrome", metal::CHROMIUM, 1.0, 0.02),
            Finish::Brass => self.brushed("satin brass", metal::BRASS, 0.18),
            Finish::Copper => self.brushed("satin copper", metal::COPPER, 0.16),
            Finish::Aluminium => self.brushed("brushed aluminium", metal::ALUMINIUM, 0.24),
            Finish::BlackMetal => self.lacquer("black powder coat", Rgb::splat(0.022), 0.3),
            Finish::ColoredMetal(i) => self.lacquer("powder coat", self.paint_color(i), 0.28),
            Finish::WhiteEnamel => coated("white enamel", Rgb::new(0.77, 0.77, 0.76), 0.035),
            Finish::CoatedWhite => self.lacquer("coated sheet", Rgb::new(0.76, 0.765, 0.76), 0.10),
            Finish::Foil => metal::conductor("foil", metal::ALUMINIUM, 0.92, 0.10),

            Finish::Mirror => metal::conductor("mirror", metal::SILVER, 0.95, 0.0),
            Finish::Glass => glass::pane("window glass", Rgb::new(0.96, 0.975, 0.965)),
            Finish::FrostedGlass => glass::frosted(),
            Finish::TintedGlass => glass::pane("tinted glass", Rgb::new(0.42, 0.38, 0.34)),
            Finish::DrinkingGlass => glass::body("drinking glass", 1.52, Rgb::new(1.2, 0.5, 0.9)),
            Finish::BottleGlass(i) => {
                let (name, absorption) = glass::BOTTLES[usize::from(i) % glass::BOTTLES.len()];
                glass::body(name, 1.52, absorption)
            }
            Finish::GlossBlack => coated("black glass", Rgb::splat(0.008), 0.01),
            Finish::Water => glass::body("water", 1.333, Rgb::new(0.35, 0.06, 0.02)),

            Finish::BlackPlastic => coated("black plastic", Rgb::splat(0.025), 0.25),
            Finish::WhitePlastic => coated("white plastic", Rgb::splat(0.74), 0.2),
            Finish::Plastic(i) => self.plastic(i),
            Finish::Rubber => coated("rubber", Rgb::splat(0.03), 0.5),

            Finish::Paper => rough("paper", Rgb::new(0.78, 0.77, 0.74), 0.2),
            Finish::Cardboard => self.cardboard(),
            Finish::BookJackets => self.book_jackets(),
            Finish::Screen => self.screen(),
            Finish::ScreenOn(i) => self.screen_on(i),

            Finish::Leaf => self.leaf("leaf", Rgb::new(0.050, 0.125, 0.030), Rgb::new(0.16, 0.25, 0.085)),
            Finish::PaleLeaf => self.leaf("pale leaf", Rgb::new(0.14, 0.22, 0.10), Rgb::new(0.36, 0.42, 0.26)),
            Finish::Bark => self.bark(),
            Finish::Soil => self.soil(),
            Finish::Petal(i) => self.petal(i),
            Finish::Fruit(i) => self.fruit(i),
            Finish::Bread => self.bread(),
            Finish::Wax => coated("wax", Rgb::new(0.76, 0.72, 0.62), 0.35),

            // Unlit: what they give off depends on their mesh, see `Finish::glow`.
            Finish::Lampshade => rough("lampshade cloth", Rgb::new(0.66, 0.62, 0.54), 0.4),
            Finish::Bulb | Finish::OpalGlobe => coated("opal glass", Rgb::splat(0.72), 0.1),
        }
    }

    fn palette(&self) -> Palette {
        self.stock.palette
    }

    /// A seed that depends on the home, the name and what the picture depends on, whatever was made before.
    fn seed(&self, name: &str, variant: &impl Debug) -> u32 {
        let text = format!("{name} {variant:?}");
        let key = text.bytes().fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        self.stock.rng.fork(key).next_u64() as u32
    }

    /// The picture of this name and variant, made if there is none yet; it covers so many metres across and up.
    fn picture(&mut self, name: &'static str, variant: &impl Debug, covers: [f32; 2], make: impl FnOnce(u32) -> Image) -> Paint {
        let key = (name, format!("{variant:?}"));
        let known = self.stock.pictures.get(&key).copied();
        let image = known.map_or_else(
            || {
                self.scene.images.push(make(self.seed(name, variant)));
                self.scene.images.len() as u32 - 1
            },
            |paint| paint.image,
        );
        let paint = Paint { image, covers: Vec2::from_array(covers) };
        self.stock.pictures.insert(key, paint);
        paint
    }

    /// As [`Maker::picture`] for a surface with its heights, which follow its colours in the scene.
    fn skin(&mut self, name: &'static str, variant: &impl Debug, covers: [f32; 2], make: impl FnOnce(u32) -> Skin) -> Layers {
        let mut relief = None;
        let color = self.picture(name, variant, covers, |seed| {
            let skin = make(seed);
            relief = Some(skin.height);
            skin.color
        });
        self.scene.images.extend(relief);
        Layers { color, relief: Paint { image: color.image + 1, ..color } }
    }
}

/// The pictures of a surface in the scene.
#[derive(Clone, Copy, Debug)]
struct Layers {
    color: Paint,
    relief: Paint,
}

impl Layers {
    /// The colours multiplied by `factor`.
    fn tinted(&self, factor: Rgb) -> ColorParam {
        self.color.tinted(factor)
    }

    /// The roughness multiplied by `factor`.
    fn alpha(&self, factor: f32) -> ScalarParam {
        self.color.alpha(factor)
    }

    /// `material` with this relief, so many metres deep.
    fn relieved(&self, material: Material, depth_m: f32) -> Material {
        Material { normal_map: Some(NormalMap::Bump { texture: self.relief.texture(), scale: depth_m }), ..material }
    }
}

/// Matt paint, paper, cloth, clay: a rough diffuse surface of a roughness from 0 to 1.
fn rough(name: &str, reflectance: impl Into<ColorParam>, roughness: f32) -> Material {
    Material::new(name, Bsdf::RoughDiffuse { reflectance: reflectance.into(), roughness: roughness.into() })
}

/// Varnish, lacquer, glaze or plastic: a diffuse body under a clear coat of roughness `alpha`.
pub fn coated(name: &str, diffuse: impl Into<ColorParam>, alpha: impl Into<ScalarParam>) -> Material {
    let bsdf = Bsdf::Plastic { diffuse: diffuse.into(), eta: 1.5, alpha: alpha.into(), specular: Rgb::WHITE.into(), nonlinear: false };
    Material::new(name, bsdf)
}

/// Linear RGB of unit luminance of a black body of `kelvin`, by Planck's law at 612, 549 and 465 nm relative to 6500 K.
pub fn blackbody(kelvin: f32) -> Rgb {
    let planck = |wavelength_nm: f32, t: f32| 1.0 / ((1.438_777e7 / (wavelength_nm * t)).exp() - 1.0);
    let relative = Rgb::new(612.0, 549.0, 465.0).map(|w| planck(w, kelvin) / planck(w, 6500.0));
    relative / relative.luminance()
}

#[cfg(test)]
mod tests;
