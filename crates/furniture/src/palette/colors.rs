//! The palette of a room: its colours, woods, stones and patterns, and how rooms of one home vary it.

use super::oklch::any_color;
use super::tiles::{GLAZE, floor_tile, quiet, wall_tile};
use enfilade_math::{Rgb, Rng};
use enfilade_textures::{PaperPattern, Pattern, SlabLook, TileLook, WoodTone};

/// The surfaces of one room. Colours are linear reflectances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Most walls.
    pub wall: Rgb,
    /// One wall, as that behind the sofa.
    pub accent_wall: Rgb,
    /// The floor.
    pub floor: WoodTone,
    /// Furniture.
    pub wood: WoodTone,
    /// The sofa's cloth.
    pub sofa: Rgb,
    /// The armchair's cloth.
    pub armchair: Rgb,
    /// Ground and figure of the rug.
    pub rug: [Rgb; 2],
    /// Curtains.
    pub curtain: Rgb,
    /// Scatter cushions and the throw.
    pub accents: [Rgb; 3],
    /// Pictures: ground, then from light to dark.
    pub art: [Rgb; 5],
    /// Fronts of kitchen units: lower, upper.
    pub kitchen: [Rgb; 2],
    /// Tables and worktops of stone.
    pub slab: SlabLook,
    /// Tiled floors.
    pub floor_tile: TileLook,
    /// Tiled walls.
    pub wall_tile: TileLook,
    /// Ground and figure of bed linen.
    pub linen: [Rgb; 2],
    /// Pattern on the bed linen.
    pub linen_pattern: Pattern,
    /// Pattern on wallpaper.
    pub paper: PaperPattern,
    /// Leather furniture.
    pub leather: Rgb,
}

/// White of walls: matt emulsion reflects 80 to 85 %.
pub(super) const WHITE: Rgb = Rgb::new(0.80, 0.785, 0.75);
/// White of washed cotton: it reflects three quarters of the light.
pub(crate) const COTTON: Rgb = Rgb::new(0.77, 0.765, 0.745);

/// Luminance that walls of public rooms have at least.
const PALE: f32 = 0.62;

impl Palette {
    /// The palette with walls that are pale, as in most public rooms; a dark or colourful wall becomes the accent wall's.
    #[must_use]
    pub fn with_pale_walls(self) -> Self {
        let luminance = self.wall.luminance();
        if luminance >= PALE {
            return self;
        }
        // Mixed with white just so far that it is pale.
        let share = (WHITE.luminance() - PALE) / (WHITE.luminance() - luminance);
        Self { wall: WHITE.lerp(self.wall, share.min(0.2)), accent_wall: self.wall, ..self }
    }
}

impl Palette {
    /// A room of a home with this palette: the same woods and whites, other walls, cloth and tiles.
    #[must_use]
    pub fn room(&self, rng: &mut Rng) -> Self {
        let mut room = *self;
        let tints = [self.accent_wall, self.wall, self.accents[1].lerp(WHITE, 0.72), self.accents[0].lerp(WHITE, 0.8)];
        room.accent_wall = tints[rng.below(4)];
        if rng.next_f32() < 0.25 {
            room.wall = self.accent_wall.lerp(self.wall, rng.range(0.2, 0.7));
        }
        room.accents.rotate_left(rng.below(3));
        room.art[1..].rotate_left(rng.below(2));
        if rng.next_f32() < 0.5 {
            room.rug = [self.rug[0], [self.accents[0], self.accents[1], self.armchair][rng.below(3)]];
        }
        if rng.next_f32() < 0.3 {
            std::mem::swap(&mut room.sofa, &mut room.armchair);
        }
        room.details(rng);
        room
    }

    /// Chooses what follows from the colours: tiles, bed linen, papers.
    pub(super) fn details(&mut self, rng: &mut Rng) {
        let tint = |c: Rgb, share: f32| c.lerp(GLAZE, share);
        let (strong, soft) = (self.art[3], self.accents[rng.below(3)]);
        self.wall_tile = wall_tile(rng.below(6), [quiet(tint(soft, 0.3)), quiet(tint(strong, 0.15))], rng);
        self.floor_tile = floor_tile(rng.below(6), [self.art[3], self.art[4]], rng);
        let linens = [[COTTON, soft], [COTTON, strong], [tint(soft, 0.45), COTTON], [tint(strong, 0.2), tint(soft, 0.4)]];
        self.linen = linens[rng.below(4)];
        use Pattern::{Dots, Gingham, PinStripes, Plain, Sprigs, Stripes, Tartan};
        self.linen_pattern = [Plain, Plain, Plain, PinStripes, Stripes, Gingham, Dots, Sprigs, Tartan][rng.below(9)];
        self.paper = PaperPattern::ALL[rng.below(PaperPattern::ALL.len())];
    }

    /// Each colour replaced by a random one with probability `share`.
    #[must_use]
    pub fn randomized(mut self, share: f32, rng: &mut Rng) -> Self {
        let mut colors: Vec<&mut Rgb> = vec![&mut self.wall, &mut self.accent_wall, &mut self.sofa, &mut self.armchair, &mut self.curtain];
        colors.extend(self.rug.iter_mut().chain(&mut self.accents).chain(&mut self.art).chain(&mut self.kitchen).chain(&mut self.linen));
        colors.extend(self.wall_tile.colors.iter_mut().chain(&mut self.floor_tile.colors).chain(&mut self.slab.colors));
        colors.extend([&mut self.leather, &mut self.floor.light, &mut self.floor.dark, &mut self.wood.light, &mut self.wood.dark]);
        for color in colors {
            let random = any_color(rng);
            if rng.next_f32() < share {
                *color = random;
            }
        }
        self
    }
}
