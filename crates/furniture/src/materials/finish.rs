//! The list of finishes, which define the material of a surface but not its colour; and which of them glow.

use crate::lamplight::{Glow, area_m2};
use enfilade_geometry::Mesh;

/// The material of a surface, without its colours. The maker of a thing chooses it; the palette of the room that the thing is in gives the
/// colours.
///
/// A number chooses among the colours that the palette has for the finish; it may be any, and equal numbers give equal surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "plain words")]
pub enum Finish {
    // Walls, ceilings and floors.
    WallPaint,
    AccentWallPaint,
    /// Paper with the pattern of the room, for one wall.
    Wallpaper,
    CeilingPaint,
    /// Bare lime plaster, trowelled.
    Plaster,
    Brick,
    /// Eight strips of wood, one above the other: see [`enfilade_textures::FLOOR_STRIPS`].
    PlankFloor,
    /// Herringbone or laid strips, laid by the picture.
    ParquetFloor,
    FloorTile,
    WallTile,
    Terrazzo,
    Concrete,
    Carpet,
    /// A foot mat of coir.
    Coir,
    /// Carpet in tiles of 50 cm, as in offices: see [`super::CARPET_TILE_M`].
    CarpetTile,
    /// Tiles of vinyl with chips, as in schools and shops.
    Vinyl,
    /// Tiles of mineral fibre, 60 cm square, of suspended ceilings: see [`super::CEILING_TILE_M`].
    MineralTile,

    // Wood and paint.
    Wood,
    DarkWood,
    WhitePaint,
    WhiteLacquer,
    /// Furniture lacquer in a colour of the palette.
    ColoredLacquer(u8),
    /// Fronts of kitchen units: 0 for the lower ones, 1 for the upper ones and tall units.
    KitchenFront(u8),
    Worktop,
    Cork,

    // Stone and pottery.
    Stone,
    MarbleTop,
    /// Sanitary ware.
    Porcelain,
    /// Glazed pottery in one of three colours.
    Ceramic(u8),
    /// Unglazed flower pots.
    Terracotta,

    // Cloth.
    SofaCloth,
    ArmchairCloth,
    CurtainLinen,
    /// A thin white curtain that lets light through.
    SheerCurtain,
    /// The cloth or foil of a shower curtain.
    ShowerCurtain,
    RugWool,
    /// Cushion cloth in one of the three accent colours of the palette.
    Accent(u8),
    KnittedThrow,
    Velvet,
    Boucle,
    /// Washed cotton: 0 the sheet, 1 the duvet, 2 the pillow cases, 3 the bedspread.
    BedLinen(u8),
    Mattress,
    Towel(u8),
    Clothes(u8),
    Felt,

    // Leather and plaited things.
    Leather,
    LeatherBag(u8),
    Wicker,
    Rattan,

    // Metal.
    Steel,
    Chrome,
    Brass,
    Copper,
    Aluminium,
    BlackMetal,
    /// Powder-coated metal in a colour of the palette.
    ColoredMetal(u8),
    WhiteEnamel,
    /// Enamelled or lacquered sheet metal of appliances.
    CoatedWhite,
    Foil,

    // Glass.
    Mirror,
    /// A window's pane: a surface without thickness.
    Glass,
    /// A pane without thickness that scatters: shower screens, bathroom windows.
    FrostedGlass,
    /// A pane without thickness in grey or bronze.
    TintedGlass,
    /// A solid transparent body: drinking glasses, vases, thick panes.
    DrinkingGlass,
    /// A solid body of bottle glass: green, brown, clear, blue.
    BottleGlass(u8),
    /// Black glass: hobs, fronts of ovens.
    GlossBlack,
    Water,

    // Plastic and rubber.
    BlackPlastic,
    WhitePlastic,
    Plastic(u8),
    Rubber,

    // Paper.
    Paper,
    Cardboard,
    /// A sheet of spines: texture coordinates choose the book, see [`enfilade_textures::BOOK_COLUMNS`].
    BookJackets,
    /// Fronts of packages: texture coordinates choose one, see `PACKAGE_COLUMNS`.
    Packages,
    /// Slate or enamel to write on with chalk: 0 green, 1 black.
    Chalkboard(u8),

    // Screens: texture coordinates run over the unit square.
    Screen,
    ScreenOn(u8),

    // Plants and food.
    Leaf,
    /// A paler leaf than [`Finish::Leaf`].
    PaleLeaf,
    Bark,
    Soil,
    Petal(u8),
    /// Skins: apple, orange, lemon, green apple, pear, plum.
    Fruit(u8),
    Bread,
    Wax,

    // Lamps: see `Finish::glow`.
    /// The cloth of a lit shade.
    Lampshade,
    Bulb,
    OpalGlobe,
}

impl Finish {
    /// The light that a part of this finish emits, if it is a part of a lamp: an 806 lm bulb, a shade around one, or opal glass of
    /// 1.5 kcd/m² or, where it is small, around a 470 lm bulb.
    pub fn glow(self, mesh: &Mesh) -> Option<Glow> {
        match self {
            Self::Bulb => Some(Glow::BULB),
            Self::Lampshade => Some(Glow::BULB.shaded()),
            Self::OpalGlobe => {
                let lumens = 1500.0 * std::f32::consts::PI * area_m2(mesh);
                Some(Glow { lumens: lumens.clamp(Glow::SMALL.lumens, Glow::CEILING.lumens), ..Glow::SMALL })
            }
            _ => None,
        }
    }

    /// One of every kind; kinds with a number have 0.
    pub fn all() -> impl Iterator<Item = Self> {
        ALL.into_iter()
    }
}

const ALL: [Finish; 89] = [
    Finish::WallPaint,
    Finish::AccentWallPaint,
    Finish::Wallpaper,
    Finish::CeilingPaint,
    Finish::Plaster,
    Finish::Brick,
    Finish::PlankFloor,
    Finish::ParquetFloor,
    Finish::FloorTile,
    Finish::WallTile,
    Finish::Terrazzo,
    Finish::Concrete,
    Finish::Carpet,
    Finish::Coir,
    Finish::CarpetTile,
    Finish::Vinyl,
    Finish::MineralTile,
    Finish::Wood,
    Finish::DarkWood,
    Finish::WhitePaint,
    Finish::WhiteLacquer,
    Finish::ColoredLacquer(0),
    Finish::KitchenFront(0),
    Finish::Worktop,
    Finish::Cork,
    Finish::Stone,
    Finish::MarbleTop,
    Finish::Porcelain,
    Finish::Ceramic(0),
    Finish::Terracotta,
    Finish::SofaCloth,
    Finish::ArmchairCloth,
    Finish::CurtainLinen,
    Finish::SheerCurtain,
    Finish::ShowerCurtain,
    Finish::RugWool,
    Finish::Accent(0),
    Finish::KnittedThrow,
    Finish::Velvet,
    Finish::Boucle,
    Finish::BedLinen(0),
    Finish::Mattress,
    Finish::Towel(0),
    Finish::Clothes(0),
    Finish::Felt,
    Finish::Leather,
    Finish::LeatherBag(0),
    Finish::Wicker,
    Finish::Rattan,
    Finish::Steel,
    Finish::Chrome,
    Finish::Brass,
    Finish::Copper,
    Finish::Aluminium,
    Finish::BlackMetal,
    Finish::ColoredMetal(0),
    Finish::WhiteEnamel,
    Finish::CoatedWhite,
    Finish::Foil,
    Finish::Mirror,
    Finish::Glass,
    Finish::FrostedGlass,
    Finish::TintedGlass,
    Finish::DrinkingGlass,
    Finish::BottleGlass(0),
    Finish::GlossBlack,
    Finish::Water,
    Finish::BlackPlastic,
    Finish::WhitePlastic,
    Finish::Plastic(0),
    Finish::Rubber,
    Finish::Paper,
    Finish::Cardboard,
    Finish::BookJackets,
    Finish::Packages,
    Finish::Chalkboard(0),
    Finish::Screen,
    Finish::ScreenOn(0),
    Finish::Leaf,
    Finish::PaleLeaf,
    Finish::Bark,
    Finish::Soil,
    Finish::Petal(0),
    Finish::Fruit(0),
    Finish::Bread,
    Finish::Wax,
    Finish::Lampshade,
    Finish::Bulb,
    Finish::OpalGlobe,
];

/// The surface of a part: a finish of the home, or a material that only one thing has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surfacing {
    /// A finish, in the colours of the room.
    Finish(Finish),
    /// Index into `Scene::materials`.
    Own(u32),
}

impl From<Finish> for Surfacing {
    fn from(finish: Finish) -> Self {
        Self::Finish(finish)
    }
}

impl From<u32> for Surfacing {
    fn from(material: u32) -> Self {
        Self::Own(material)
    }
}
