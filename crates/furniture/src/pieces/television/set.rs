//! Television sets, class television: flat ones of 60 to 125 cm on two feet, on blades, on a stand in the middle or over a bar of loudspeakers,
//! and boxes with a picture tube. A row of [`STYLES`] is a style with its weight. Half of them are on and show a picture, the others reflect
//! the room. The origin is the middle of the foot.

use super::set_kind::{SetStand, TelevisionSet};
use super::tube;
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, picture};
use crate::pieces::style::drawn;
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A style of sets.
#[derive(Clone, Copy, Debug)]
struct Style {
    stand: SetStand,
    /// Smallest and largest width of the set, metres.
    width: [f32; 2],
    /// Smallest and largest width of the frame beside the screen, metres.
    bezel: [f32; 2],
    finishes: &'static [Finish],
}

const DARK: &[Finish] = &[Finish::BlackPlastic];

/// The styles and their weights. Diagonals: 65 cm (26 inches) to 140 cm (55 inches) for flat sets, 36 to 74 cm for tubes.
const STYLES: &[(u32, Style)] = &[
    (3, Style { stand: SetStand::Feet, width: [0.9, 1.23], bezel: [0.006, 0.012], finishes: DARK }),
    (3, Style { stand: SetStand::Blades, width: [0.9, 1.23], bezel: [0.005, 0.01], finishes: DARK }),
    (
        3,
        Style {
            stand: SetStand::Plate,
            width: [0.72, 1.1],
            bezel: [0.014, 0.03],
            finishes: &[Finish::BlackPlastic, Finish::BlackPlastic, Finish::WhitePlastic],
        },
    ),
    (2, Style { stand: SetStand::Bar, width: [0.9, 1.23], bezel: [0.007, 0.014], finishes: &[Finish::BlackPlastic, Finish::Aluminium] }),
    (2, Style { stand: SetStand::Speakers, width: [0.66, 1.0], bezel: [0.03, 0.05], finishes: &[Finish::BlackPlastic, Finish::Aluminium] }),
    (
        3,
        Style {
            stand: SetStand::Tube,
            width: [0.46, 0.74],
            bezel: [0.04, 0.06],
            finishes: &[Finish::BlackPlastic, Finish::Aluminium, Finish::BlackPlastic],
        },
    ),
];

/// Height of the lower edge of flat sets over their foot, metres.
const UNDER: f32 = 0.062;
/// Depth of a flat set, metres.
const FLAT: f32 = 0.035;

impl TelevisionSet {
    /// What a television in a home shows, for [`Finish::ScreenOn`]: half of them are off, the others show landscapes or a home page.
    pub fn shown(rng: &mut Rng) -> Option<u8> {
        let picture = [0, 4, 8, 3][rng.below(4)];
        (rng.below(2) == 0).then_some(picture)
    }

    fn flat(&self, b: &mut Builder, tv: &Object) {
        let [width, height] = self.screen();
        let (low, chin) = (UNDER + if self.stand == SetStand::Speakers { 0.06 } else { 0.0 }, self.bezel.max(0.016));
        let (high, thick) = (low + chin + height + self.bezel, if self.bezel > 0.025 { 0.09 } else { FLAT });
        let case = rounded_box(Vec3::new(self.width, thick, high - low), 0.004, 2);
        b.part(tv, "housing", case.moved(Vec3::new(0.0, 0.5 * (FLAT - thick), 0.5 * (low + high))), self.finish);
        let bulge = rounded_box(Vec3::new(0.6 * self.width, 0.04, 0.6 * (high - low)), 0.012, 2);
        b.part(tv, "back", bulge.moved(Vec3::new(0.0, 0.5 * FLAT - thick - 0.012, low + 0.4 * (high - low))), Finish::BlackPlastic);
        self.glass(b, tv, [width, height], Vec3::new(0.0, 0.5 * FLAT, low + chin + 0.5 * height));
        let neck = |half: f32, y: f32| board([-half, y - 0.014, 0.006], [half, y + 0.014, low + 0.03], 0.004);
        let (mesh, finish) = match self.stand {
            SetStand::Feet => (all([-0.62f32, 0.62].map(|s| foot(s * 0.5 * self.width, low))), Finish::BlackPlastic),
            SetStand::Blades => (all([-1.0f32, 1.0].map(|s| blades(s * 0.38 * self.width, low))), Finish::Aluminium),
            SetStand::Plate => {
                let plate = rounded_box(Vec3::new(0.42 * self.width, 0.22, 0.012), 0.005, 3).moved(Vec3::new(0.0, 0.0, 0.006));
                (plate.with(neck(0.05, -0.006)), Finish::GlossBlack)
            }
            SetStand::Bar => {
                let bend = |p: Vec3| Vec3::new(p.x, p.y + 0.1 - 0.75 * p.x * p.x / (self.width * 0.5), p.z);
                let bar = crate::shape::bendable_box(Vec3::new(0.5 * self.width, 0.03, 0.014), 0.003, [12, 1, 1]);
                let bar = bar.deformed(bend).smoothed(40.0).moved(Vec3::Z * 0.007);
                let arm = board([-0.03, -0.1, 0.002], [0.03, 0.1, 0.013], 0.002);
                (all([bar, arm, neck(0.035, -0.006)]), Finish::Aluminium)
            }
            SetStand::Speakers => {
                let case = rounded_box(Vec3::new(self.width - 0.01, 0.08, 0.062), 0.008, 2).moved(Vec3::new(0.0, -0.02, low - 0.03));
                b.part(tv, "loudspeakers", case, Finish::Felt);
                let plate = rounded_box(Vec3::new(0.5 * self.width, 0.22, 0.014), 0.006, 3).moved(Vec3::new(0.0, 0.0, 0.007));
                (plate.with(board([-0.12, -0.04, 0.012], [0.12, 0.01, low - 0.055], 0.004)), self.finish)
            }
            SetStand::Tube => return,
        };
        b.part(tv, "stand", mesh, finish);
    }

    /// The screen: it faces +y with its middle at `at`.
    fn glass(&self, b: &mut Builder, tv: &Object, [width, height]: [f32; 2], at: Vec3) {
        match self.shows {
            Some(shows) => b.part(tv, "screen", picture(width, height).moved(at + Vec3::Y * 0.0012), Finish::ScreenOn(shows)),
            None => {
                let pane = board([-0.5 * width, -0.0008, -0.5 * height], [0.5 * width, 0.0012, 0.5 * height], 0.0006);
                b.part(tv, "screen", pane.moved(at), Finish::Screen);
            }
        }
    }

    /// Adds its parts.
    pub fn add(&self, b: &mut Builder, pose: DAffine3) {
        let tv = b.object("television", Class::Television, pose);
        if self.stand == SetStand::Tube { tube::tube(self, b, &tv) } else { self.flat(b, &tv) }
    }

    fn of(style: Style, rng: &mut Rng) -> Self {
        Self {
            stand: style.stand,
            width: rng.range(style.width[0], style.width[1]),
            bezel: rng.range(style.bezel[0], style.bezel[1]),
            finish: style.finishes[rng.below(style.finishes.len())],
            shows: Self::shown(rng),
        }
    }
}

/// A foot across the depth that carries a set's lower edge.
fn foot(x: f32, low: f32) -> Mesh {
    let bar = board([x - 0.011, -0.11, 0.0], [x + 0.011, 0.11, 0.008], 0.002);
    bar.with(board([x - 0.009, -0.012, 0.0082], [x + 0.009, 0.012, low + 0.01], 0.002))
}

/// Two blades that spread to the front and the rear.
fn blades(x: f32, low: f32) -> Mesh {
    all([-1.0f32, 1.0].map(|s| {
        let mesh = board([x - 0.014, -0.003, 0.0], [x + 0.014, 0.003, low + 0.012], 0.001);
        mesh.deformed(|p| p + Vec3::Y * s * 0.105 * (1.0 - p.z / (low + 0.012))).smoothed(30.0)
    }))
}

impl Furniture for TelevisionSet {
    fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    fn size(&self) -> Vec3 {
        let [_, height] = self.screen();
        let tall = match self.stand {
            SetStand::Tube => 0.09 + height + self.bezel + 0.002,
            SetStand::Speakers => UNDER + 0.06 + self.bezel.max(0.016) + height + self.bezel,
            _ => UNDER + self.bezel.max(0.016) + height + self.bezel,
        };
        Vec3::new(self.width, self.depth() + 0.016, tall + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        self.add(b, pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::{Place, style_tests::check};

    #[test]
    fn every_style_stands_and_is_of_one_piece() {
        let mut rng = Rng::new(1);
        let mut things: Vec<(String, Box<dyn Furniture>)> = Vec::new();
        for &(_, style) in STYLES {
            for shows in [None, Some(1)] {
                things.push((
                    format!("{:?} {shows:?}", style.stand),
                    Box::new(TelevisionSet { shows, ..TelevisionSet::of(style, &mut rng) }),
                ));
            }
        }
        check(Place::OnSurface, &things);
    }
}
