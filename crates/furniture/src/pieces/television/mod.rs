//! A low cabinet (class cabinet) with a television set on it (class television) or below one on the wall: with doors, with drawers, with open
//! shelves, or of glass, 95 to 190 cm wide and 38 to 52 cm high. A row of [`STYLES`] is a style with its weight.

mod bench;
mod doors;
mod open;
mod set;
mod set_kind;
mod tube;

pub use bench::{BenchStyle, TelevisionBench};
pub use set_kind::TelevisionSet;

use super::style::drawn;
use super::{CONTACT, Furniture, on};
use crate::builder::Builder;
use crate::materials::Finish;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A style, its smallest and largest width, and its height, metres.
type Row = (BenchStyle, [f32; 2], f32);

/// The styles and their weights.
const STYLES: &[(u32, Row)] = &[
    (2, (BenchStyle::Doors(false), [1.55, 1.8], doors::TOP)),
    (2, (BenchStyle::Doors(true), [1.55, 1.8], doors::TOP)),
    (2, (BenchStyle::Drawers(Finish::Wood), [1.35, 1.9], 0.44)),
    (2, (BenchStyle::Drawers(Finish::WhiteLacquer), [1.35, 1.9], 0.4)),
    (1, (BenchStyle::Drawers(Finish::DarkWood), [1.2, 1.6], 0.52)),
    (2, (BenchStyle::Open(Finish::Wood), [1.1, 1.6], 0.45)),
    (1, (BenchStyle::Open(Finish::DarkWood), [1.0, 1.4], 0.5)),
    (2, (BenchStyle::Glass, [0.95, 1.25], 0.48)),
];

/// Least depth of a cabinet, metres.
const DEPTH: f32 = 0.40;
/// Distance of a set from either end of its cabinet at least, metres.
const ASIDE: f32 = 0.05;

impl Furniture for TelevisionBench {
    fn random(rng: &mut Rng) -> Self {
        let (style, [low, high], top) = drawn(STYLES, rng);
        let set = TelevisionSet::random(rng);
        let width = rng.range(low, high).max(set.width + 2.0 * ASIDE);
        Self { style, width, depth: DEPTH.max(set.depth() + 0.01), top, set: Some(set) }
    }

    fn size(&self) -> Vec3 {
        let set = self.set.map_or(Vec3::ZERO, |set| set.size() + Vec3::Z * CONTACT);
        Vec3::new(self.width, self.depth + 0.042, self.top + set.z.max(0.02))
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        match self.style {
            BenchStyle::Doors(white) => doors::doors(self, white, b, pose, rng),
            BenchStyle::Drawers(finish) => open::drawers(self, finish, b, pose, rng),
            BenchStyle::Open(finish) => open::open(self, finish, b, pose, rng),
            BenchStyle::Glass => open::glass(self, b, pose, rng),
        }
        if let Some(set) = self.set {
            // It stands back a little from the middle, within the cabinet.
            let back = 0.02f32.min(0.5 * (self.depth - set.depth())).max(0.0);
            set.add(b, on(pose, Vec3::new(0.0, -back, self.top + CONTACT), 0.0));
        }
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
        for &(_, (style, _, top)) in STYLES {
            let bench = TelevisionBench { style, top, ..TelevisionBench::random(&mut rng) };
            things.push((format!("{style:?}"), Box::new(bench)));
            things.push((format!("{style:?} without a set"), Box::new(TelevisionBench { set: None, depth: DEPTH, ..bench })));
        }
        check(Place::AgainstWall, &things);
    }

    #[test]
    fn a_set_is_no_wider_or_deeper_than_its_cabinet() {
        for seed in 0..200 {
            let bench = TelevisionBench::random(&mut Rng::new(seed));
            let set = bench.set.expect("a random cabinet has a set");
            assert!(set.width < bench.width && set.depth() < bench.depth, "{bench:?}");
        }
    }
}
