//! Easy chairs, class chair: a frame of wooden rods, upholstered in the styles of a table, with an open frame, or on bent frames that spring.
//! Club chairs are a family of their own.

use super::Furniture;
use super::seating::{BentwoodChair, EASY_CHAIRS, EASY_FRAMES, OpenFrame, RodChair, Upholstered};
use super::style::drawn;
use crate::builder::Builder;
use enfilade_math::{DAffine3, Rng, Vec3};

/// An easy chair.
#[derive(Clone, Copy, Debug)]
pub enum Armchair {
    /// A frame of wooden rods with two loose cushions.
    Rods(RodChair),
    /// Upholstered, in a style of the table `EASY_CHAIRS`.
    Upholstered(Upholstered),
    /// With an open frame in a style of the table `EASY_FRAMES`.
    Open(OpenFrame),
    /// On bent frames of wood.
    Bentwood(BentwoodChair),
}

/// Kinds of easy chairs and their weights: rods, styles of the table, open frames, bent frames.
const KINDS: &[(u32, u8)] = &[(4, 0), (9, 1), (5, 2), (2, 3)];

impl Furniture for Armchair {
    fn random(rng: &mut Rng) -> Self {
        match drawn(KINDS, rng) {
            0 => Self::Rods(RodChair::random(rng)),
            1 => Self::Upholstered(Upholstered::of(drawn(EASY_CHAIRS, rng), rng)),
            2 => Self::Open(OpenFrame::of(drawn(EASY_FRAMES, rng), 1, rng)),
            _ => Self::Bentwood(BentwoodChair::random(rng)),
        }
    }

    fn size(&self) -> Vec3 {
        match self {
            Self::Rods(chair) => chair.size(),
            Self::Upholstered(chair) => chair.size(),
            Self::Open(chair) => chair.size(),
            Self::Bentwood(chair) => chair.size(),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        match self {
            Self::Rods(chair) => chair.build(b, pose, rng),
            Self::Upholstered(chair) => chair.build(b, "armchair", pose, rng),
            Self::Open(chair) => chair.build(b, "armchair", pose, rng),
            Self::Bentwood(chair) => chair.build(b, "armchair", pose, rng),
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
        for (i, &(_, style)) in EASY_CHAIRS.iter().enumerate() {
            things.push((format!("upholstered {i}"), Box::new(Armchair::Upholstered(Upholstered::of(style, &mut rng)))));
        }
        for (i, &(_, style)) in EASY_FRAMES.iter().enumerate() {
            things.push((format!("frame {i}"), Box::new(Armchair::Open(OpenFrame::of(style, 1, &mut rng)))));
        }
        for i in 0..4 {
            things.push((format!("bentwood {i}"), Box::new(Armchair::Bentwood(BentwoodChair::random(&mut rng)))));
        }
        check(Place::Free, &things);
    }
}
