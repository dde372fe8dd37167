//! Colours that go together: of a home, and of each of its rooms.
//!
//! A home has one palette, either a curated family or one that is generated to the same statistics: large surfaces pale or dark but
//! quiet, cloth of middling chroma, small things colourful. Rooms vary it.

mod family;
mod generated;

use crate::texture::{PaperPattern, Pattern, SlabLook, TileFigure, TileLook, WoodTone};
use enfilade_math::{Rgb, Rng};
use serde::{Deserialize, Serialize};

/// How the surfaces of a home are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DecorConfig {
    /// Decides palettes and pictures, and nothing else.
    pub seed: u64,
    /// Share of the colours that go together, 0 to 1; the others are random, as domain randomisation wants them.
    pub realism: f32,
}

impl Default for DecorConfig {
    fn default() -> Self {
        Self { seed: 0, realism: 1.0 }
    }
}

impl DecorConfig {
    /// The palette of the home.
    pub fn palette(&self) -> Palette {
        let rng = self.rng();
        Palette::choose(self.seed, &mut rng.fork(1)).randomized(1.0 - self.realism, &mut rng.fork(2))
    }

    /// The palette of one of its rooms, counted in any order that does not change.
    pub fn room(&self, home: &Palette, room: u64) -> Palette {
        let rng = self.rng().fork(3).fork(room);
        home.room(&mut rng.fork(1)).randomized(1.0 - self.realism, &mut rng.fork(2))
    }

    /// Random numbers for pictures.
    pub fn pictures(&self) -> Rng {
        self.rng().fork(4)
    }

    fn rng(&self) -> Rng {
        Rng::new(self.seed).fork(0xdec0)
    }
}

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
    /// What is printed on the bed linen.
    pub linen_pattern: Pattern,
    /// What is printed on wallpaper.
    pub paper: PaperPattern,
    /// Leather furniture.
    pub leather: Rgb,
}

/// White of walls: matt emulsion reflects 80 to 85 %.
const WHITE: Rgb = Rgb::new(0.80, 0.785, 0.75);
/// White of glazed tiles and of washed cotton.
const GLAZE: Rgb = Rgb::new(0.76, 0.755, 0.73);
const COTTON: Rgb = Rgb::new(0.77, 0.765, 0.745);

impl Palette {
    /// The palette of a home: two of three times a curated family, else a generated one; seed 0 gets the first family.
    pub fn choose(seed: u64, rng: &mut Rng) -> Self {
        let families = &family::FAMILIES;
        if seed == 0 {
            return families[0].palette(rng);
        }
        let k = rng.below(families.len() * 3 / 2);
        match families.get(k) {
            Some(family) => family.palette(rng),
            None => generated::palette(rng),
        }
    }

    /// Every curated family.
    pub fn all() -> Vec<Self> {
        family::FAMILIES.iter().zip(0..).map(|(family, k)| family.palette(&mut Rng::new(k))).collect()
    }

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
    fn details(&mut self, rng: &mut Rng) {
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
            let random = generated::any_color(rng);
            if rng.next_f32() < share {
                *color = random;
            }
        }
        self
    }
}

/// Saturation of tiles that cover whole rooms: their light falls on each other and grows more colourful with every bounce.
const TILED: f32 = 0.22;

/// A colour without more saturation than tiled rooms bear, as light as before.
fn quiet(c: Rgb) -> Rgb {
    let (most, least) = (c.max_component(), c.r.min(c.g).min(c.b));
    let saturation = (most - least) / most.max(1e-3);
    c.lerp(Rgb::splat(c.luminance()), 1.0 - (TILED / saturation.max(TILED)))
}

/// A usual wall of tiles.
fn wall_tile(kind: usize, [soft, strong]: [Rgb; 2], rng: &mut Rng) -> TileLook {
    let color = [GLAZE, GLAZE, soft, strong][rng.below(4)];
    let plain = TileLook {
        tile: [0.10, 0.10],
        joint: 0.002,
        bond: 0.0,
        colors: [color, strong],
        grout: Rgb::splat(0.55),
        figure: TileFigure::Plain,
        alpha: 0.05,
        handmade: 0.0,
    };
    match kind {
        // Metro tiles.
        0 => TileLook { tile: [0.20, 0.10], bond: 0.5, ..plain },
        // Hand-made squares and bars.
        1 => TileLook { handmade: 0.6, ..plain },
        2 => TileLook { tile: [0.065, 0.20], handmade: 0.45, bond: 0.5, ..plain },
        // Large formats.
        3 => TileLook { tile: [0.30, 0.60], colors: [GLAZE; 2], alpha: 0.12, ..plain },
        4 => TileLook {
            tile: [0.60, 0.30],
            bond: 0.5,
            colors: [Rgb::new(0.50, 0.46, 0.40), strong],
            grout: Rgb::new(0.42, 0.39, 0.34),
            figure: TileFigure::Stone,
            alpha: 0.22,
            ..plain
        },
        _ => TileLook { tile: [0.15, 0.15], handmade: 0.12, ..plain },
    }
}

/// A usual tiled floor.
fn floor_tile(kind: usize, [figure, dark]: [Rgb; 2], rng: &mut Rng) -> TileLook {
    let stones = [Rgb::new(0.40, 0.38, 0.35), Rgb::new(0.22, 0.215, 0.21), Rgb::new(0.50, 0.44, 0.35), Rgb::new(0.075, 0.077, 0.08)];
    let stone = stones[rng.below(4)];
    let slabs = TileLook {
        tile: [0.60, 0.60],
        joint: 0.003,
        bond: 0.0,
        colors: [stone, dark],
        grout: (stone * 0.75).lerp(Rgb::splat(0.3), 0.3),
        figure: TileFigure::Stone,
        alpha: 0.25,
        handmade: 0.0,
    };
    let pale = Rgb::new(0.62, 0.59, 0.52);
    match kind {
        0 => slabs,
        1 => TileLook { tile: [0.60, 0.30], bond: 0.5, ..slabs },
        2 => TileLook { tile: [0.30, 0.30], ..slabs },
        3 => TileLook {
            tile: [0.20, 0.20],
            joint: 0.0015,
            colors: [pale, figure.lerp(dark, 0.3)],
            figure: TileFigure::Inlaid,
            alpha: 0.3,
            ..slabs
        },
        4 => {
            let dark = if rng.below(2) == 0 { Rgb::splat(0.035) } else { dark };
            TileLook { tile: [0.20, 0.20], joint: 0.002, colors: [pale, dark], figure: TileFigure::Checker, alpha: 0.12, ..slabs }
        }
        // Terracotta.
        _ => TileLook {
            tile: [0.20, 0.20],
            joint: 0.006,
            colors: [Rgb::new(0.40, 0.17, 0.085), dark],
            grout: Rgb::new(0.42, 0.37, 0.30),
            figure: TileFigure::Plain,
            alpha: 0.35,
            handmade: 0.7,
            ..slabs
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colors(p: &Palette) -> Vec<Rgb> {
        let mut all = vec![p.wall, p.accent_wall, p.sofa, p.armchair, p.curtain, p.leather];
        all.extend(p.rug.iter().chain(&p.accents).chain(&p.art).chain(&p.kitchen).chain(&p.linen).chain(&p.wall_tile.colors));
        all
    }

    #[test]
    fn no_surface_reflects_more_than_snow_or_less_than_soot() {
        for seed in 0..300 {
            for realism in [1.0, 0.5, 0.0] {
                let decor = DecorConfig { seed, realism };
                let home = decor.palette();
                for palette in [home, decor.room(&home, 1), decor.room(&home, 2)] {
                    for c in colors(&palette) {
                        assert!(c.max_component() <= 0.86 && c.luminance() > 0.01 && c.r.min(c.g).min(c.b) >= 0.0, "seed {seed}: {c:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn most_walls_are_pale_and_some_homes_are_dark_or_colourful() {
        let walls: Vec<Rgb> = (1..400).map(|seed| DecorConfig { seed, realism: 1.0 }.palette().wall).collect();
        let share = |is: fn(&Rgb) -> bool| walls.iter().filter(|c| is(c)).count() as f32 / walls.len() as f32;
        let (pale, dark) = (share(|c| c.luminance() > 0.55), share(|c| c.luminance() < 0.25));
        assert!((0.55..0.92).contains(&pale) && (0.04..0.3).contains(&dark), "pale {pale}, dark {dark}");
        assert!(share(|c| c.max_component() > 1.35 * c.r.min(c.g).min(c.b)) > 0.08, "some are coloured");
    }

    #[test]
    fn families_are_many_and_rooms_of_a_home_differ() {
        assert!(Palette::all().len() >= 12);
        let decor = DecorConfig { seed: 9, realism: 1.0 };
        let home = decor.palette();
        let rooms: Vec<Palette> = (0..6).map(|k| decor.room(&home, k)).collect();
        assert!(rooms.iter().all(|r| r.wood == home.wood && r.floor == home.floor));
        assert!(rooms.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
