//! The colours that things of each class come in: the table of what varies.

use super::oklab::Oklch;
use crate::config::ColorRange;
use crate::draw::uniform;
use enfilade_math::Rng;

/// What something is made of, as far as its colours go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Made {
    /// Painted or papered: three of four pale, the others coloured or dark.
    Wall,
    /// Nearly white.
    Ceiling,
    /// Stone, tiles, carpet: quiet, of any lightness.
    Floor,
    /// Lacquer, where it is not of wood: half of it white to grey, half coloured.
    Joinery,
    /// Lacquer of doors: three quarters white.
    Door,
    /// Cloth: any hue, of middling chroma.
    Cloth,
    /// Wool and cotton of rugs: naturals, greys, reds, blues; seldom green.
    Rug,
    /// Cardboard, plastic, paper: any colour.
    Thing,
    /// Wood, from bleached over oak, beech and cherry to walnut and wenge.
    Wood,
    /// Leather: black, browns, cream.
    Leather,
    /// Bare brick.
    Brick,
}

/// The classes that vary, with what they are made of. Windows, mirrors, pictures, screens, books, plants and people are not among
/// them, nor what is of enamel and steel everywhere.
pub const CLASSES: [(&str, Made); 25] = [
    ("wall", Made::Wall),
    ("ceiling", Made::Ceiling),
    ("floor", Made::Floor),
    ("cabinet", Made::Joinery),
    ("bed", Made::Cloth),
    ("chair", Made::Cloth),
    ("sofa", Made::Cloth),
    ("table", Made::Joinery),
    ("door", Made::Door),
    ("bookshelf", Made::Joinery),
    ("counter", Made::Joinery),
    ("blinds", Made::Cloth),
    ("desk", Made::Joinery),
    ("shelves", Made::Joinery),
    ("curtain", Made::Cloth),
    ("dresser", Made::Joinery),
    ("pillow", Made::Cloth),
    ("floormat", Made::Rug),
    ("clothes", Made::Cloth),
    ("towel", Made::Cloth),
    ("showercurtain", Made::Cloth),
    ("box", Made::Thing),
    ("nightstand", Made::Joinery),
    ("bag", Made::Cloth),
    ("otherfurniture", Made::Joinery),
];

/// What a class is made of, and of one that is not in the table.
pub fn made(class: &str) -> Made {
    CLASSES.iter().find(|(name, _)| *name == class).map_or(Made::Thing, |(_, made)| *made)
}

/// Ranges of lightness, chroma and hue, with the probability of each row; hues are any where none are given.
struct Row(f64, [f64; 2], [f64; 2], [f64; 2]);

const ANY: [f64; 2] = [0.0, 360.0];
/// Yellow to orange: the hues of warm whites, sand and wood.
const WARM: [f64; 2] = [55.0, 100.0];

const WALL: [Row; 4] = [
    Row(0.45, [0.88, 0.95], [0.0, 0.02], WARM),
    Row(0.3, [0.8, 0.92], [0.01, 0.03], ANY),
    Row(0.15, [0.62, 0.8], [0.025, 0.06], ANY),
    Row(0.1, [0.36, 0.5], [0.005, 0.035], ANY),
];
const CEILING: [Row; 1] = [Row(1.0, [0.91, 0.955], [0.0, 0.012], WARM)];
const FLOOR: [Row; 2] = [Row(0.6, [0.45, 0.82], [0.0, 0.03], WARM), Row(0.4, [0.3, 0.75], [0.0, 0.04], ANY)];
const JOINERY: [Row; 3] =
    [Row(0.45, [0.82, 0.94], [0.0, 0.015], WARM), Row(0.2, [0.28, 0.6], [0.0, 0.02], ANY), Row(0.35, [0.4, 0.75], [0.02, 0.07], ANY)];
const DOOR: [Row; 3] =
    [Row(0.75, [0.84, 0.94], [0.0, 0.015], WARM), Row(0.1, [0.3, 0.6], [0.0, 0.015], ANY), Row(0.15, [0.4, 0.75], [0.02, 0.06], ANY)];
const CLOTH: [Row; 3] =
    [Row(0.4, [0.65, 0.9], [0.005, 0.035], WARM), Row(0.2, [0.28, 0.6], [0.0, 0.025], ANY), Row(0.4, [0.35, 0.75], [0.03, 0.095], ANY)];
/// Undyed wool, greys, madder to rust, indigo, ochre, and green in one of thirty.
const RUG: [Row; 6] = [
    Row(0.34, [0.62, 0.88], [0.01, 0.04], WARM),
    Row(0.2, [0.3, 0.68], [0.0, 0.012], ANY),
    Row(0.18, [0.34, 0.56], [0.06, 0.11], [15.0, 45.0]),
    Row(0.15, [0.32, 0.6], [0.03, 0.08], [240.0, 275.0]),
    Row(0.1, [0.48, 0.72], [0.04, 0.09], [60.0, 88.0]),
    Row(0.03, [0.38, 0.6], [0.02, 0.05], [125.0, 165.0]),
];
const THING: [Row; 1] = [Row(1.0, [0.3, 0.9], [0.0, 0.14], ANY)];
const WOOD: [Row; 4] = [
    Row(0.25, [0.74, 0.84], [0.03, 0.06], [70.0, 88.0]),
    Row(0.35, [0.6, 0.74], [0.05, 0.085], [62.0, 80.0]),
    Row(0.25, [0.42, 0.56], [0.045, 0.08], [45.0, 68.0]),
    Row(0.15, [0.28, 0.4], [0.02, 0.045], [40.0, 70.0]),
];
const LEATHER: [Row; 4] = [
    Row(0.3, [0.2, 0.3], [0.0, 0.01], WARM),
    Row(0.25, [0.3, 0.42], [0.03, 0.06], [40.0, 65.0]),
    Row(0.25, [0.48, 0.62], [0.07, 0.11], [50.0, 70.0]),
    Row(0.2, [0.72, 0.86], [0.01, 0.035], WARM),
];
const BRICK: [Row; 1] = [Row(1.0, [0.46, 0.58], [0.05, 0.09], [38.0, 55.0])];

impl Made {
    fn rows(self) -> &'static [Row] {
        match self {
            Self::Wall => &WALL,
            Self::Ceiling => &CEILING,
            Self::Floor => &FLOOR,
            Self::Joinery => &JOINERY,
            Self::Door => &DOOR,
            Self::Cloth => &CLOTH,
            Self::Rug => &RUG,
            Self::Thing => &THING,
            Self::Wood => &WOOD,
            Self::Leather => &LEATHER,
            Self::Brick => &BRICK,
        }
    }
}

/// A colour of what something is made of; where the configuration has ranges, within these.
pub fn draw(made: Made, given: &ColorRange, rng: &mut Rng) -> Oklch {
    let rows = made.rows();
    let place = rng.next_f64();
    let mut end = 0.0;
    let row = rows.iter().find(|Row(share, ..)| {
        end += share;
        place < end
    });
    let Row(_, lightness, chroma, hue_deg) = row.unwrap_or(&rows[rows.len() - 1]);
    Oklch {
        lightness: uniform(rng, given.lightness.unwrap_or(*lightness)) as f32,
        chroma: uniform(rng, given.chroma.unwrap_or(*chroma)) as f32,
        hue_deg: uniform(rng, given.hue_deg.unwrap_or(*hue_deg)) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::class_id;

    #[test]
    fn all_classes_exist_and_shares_add_up() {
        use Made::{Brick, Ceiling, Cloth, Door, Floor, Joinery, Leather, Rug, Thing, Wall, Wood};
        assert!(CLASSES.iter().all(|(name, _)| class_id(name).is_some()));
        for made in [Wall, Ceiling, Floor, Joinery, Door, Cloth, Rug, Thing, Wood, Leather, Brick] {
            assert!((made.rows().iter().map(|Row(share, ..)| share).sum::<f64>() - 1.0).abs() < 1e-9, "{made:?}");
        }
    }

    #[test]
    fn most_walls_are_pale_and_given_ranges_win() {
        let rng = &mut Rng::new(7);
        let pale = (0..1000).filter(|_| draw(Made::Wall, &ColorRange::default(), rng).lightness > 0.79).count();
        assert!((700..800).contains(&pale), "{pale}");
        let red = ColorRange { lightness: Some([0.5, 0.5]), chroma: Some([0.1, 0.12]), hue_deg: Some([20.0, 30.0]) };
        assert!((0..100).map(|_| draw(Made::Wood, &red, rng)).all(|c| c.lightness == 0.5 && (20.0..30.0).contains(&c.hue_deg)));
    }

    #[test]
    fn rugs_are_seldom_green_and_often_warm_or_grey() {
        let rng = &mut Rng::new(11);
        let drawn: Vec<Oklch> = (0..4000).map(|_| draw(Made::Rug, &ColorRange::default(), rng)).collect();
        let share = |is: fn(&Oklch) -> bool| drawn.iter().filter(|c| is(c)).count() as f64 / 4000.0;
        let is_green = |c: &Oklch| c.chroma > 0.015 && (105.0..200.0).contains(&c.hue_deg);
        assert!((0.02..0.04).contains(&share(is_green)), "{}", share(is_green));
        assert!(share(|c| c.chroma < 0.012) > 0.18 && share(|c| c.chroma >= 0.01 && !(101.0..360.0).contains(&c.hue_deg)) > 0.55);
    }
}
