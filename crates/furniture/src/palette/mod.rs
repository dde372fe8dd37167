//! Colours that go together: of a home, and of each of its rooms.
//!
//! A home has one palette, either a curated family or one that is generated to the same statistics: large surfaces pale or dark but
//! quiet, cloth of middling chroma, small things colourful. Rooms vary it.

mod colors;
mod family;
mod generated;
mod oklch;
mod tiles;

pub(crate) use colors::COTTON;
pub use colors::Palette;

use enfilade_math::Rng;
use serde::{Deserialize, Serialize};

/// The configuration of a home's surfaces.
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rgb;

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
