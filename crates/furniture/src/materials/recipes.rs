//! The table of all finishes: which material each becomes.

use super::{Finish, Maker, coated, glass, metal, rough};
use enfilade_math::Rgb;
use enfilade_scene::Material;
use enfilade_textures::SlabLook;

impl Maker<'_> {
    /// The material of a finish in the colours of the room.
    pub(super) fn material(&mut self, finish: Finish) -> Material {
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
            Finish::CarpetTile => self.carpet_tile(),
            Finish::Vinyl => self.vinyl(),
            Finish::MineralTile => self.mineral_tile(),

            Finish::Wood => self.veneer("veneer", false),
            Finish::DarkWood => self.veneer("stained wood", true),
            Finish::WhitePaint => self.lacquer("white paint", Rgb::new(0.76, 0.755, 0.73), 0.16),
            Finish::WhiteLacquer => self.lacquer("white lacquer", Rgb::new(0.74, 0.735, 0.715), 0.10),
            Finish::ColoredLacquer(i) => self.lacquer("coloured lacquer", self.paint_color(i), 0.14),
            Finish::KitchenFront(i) => self.lacquer("kitchen front", palette.kitchen[usize::from(i) % 2], 0.20),
            Finish::Worktop => self.worktop(),
            Finish::Cork => self.cork(),

            Finish::Stone => self.slab("honed stone", SlabLook::LIMESTONE, 3.0),
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
            Finish::Packages => self.packages(),
            Finish::Chalkboard(i) => self.chalkboard(i),
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
}
