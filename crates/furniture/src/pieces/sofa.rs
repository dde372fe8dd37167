//! Sofas, class sofa: of two or three seats with loose cushions, upholstered in the styles of a table, with an open frame, or a chaise longue.
//! Corner sofas, chesterfields and day beds are families of their own.

use super::Furniture;
use super::seating::{ChaiseLongue, LooseSofa, OpenFrame, SOFA_FRAMES, SOFAS, Upholstered};
use super::style::drawn;
use crate::builder::Builder;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A sofa.
#[derive(Clone, Copy, Debug)]
pub enum Sofa {
    /// With loose seat and back cushions on a low frame.
    Loose(LooseSofa),
    /// In a style of the table `SOFAS`.
    Upholstered(Upholstered),
    /// With an open frame in a style of the table `SOFA_FRAMES`.
    Open(OpenFrame),
    /// A chaise longue.
    Chaise(ChaiseLongue),
}

/// Kinds of sofas and their weights: loose cushions, styles of the table, open frames, chaise longues.
const KINDS: &[(u32, u8)] = &[(5, 0), (12, 1), (5, 2), (1, 3)];

impl Furniture for Sofa {
    fn random(rng: &mut Rng) -> Self {
        match drawn(KINDS, rng) {
            0 => Self::Loose(LooseSofa::random(rng)),
            1 => Self::Upholstered(Upholstered::of(drawn(SOFAS, rng), rng)),
            2 => {
                let seats = 2 + rng.below(2);
                Self::Open(OpenFrame::of(drawn(SOFA_FRAMES, rng), seats, rng))
            }
            _ => Self::Chaise(ChaiseLongue::random(rng)),
        }
    }

    fn size(&self) -> Vec3 {
        match self {
            Self::Loose(sofa) => sofa.size(),
            Self::Upholstered(sofa) => sofa.size(),
            Self::Open(sofa) => sofa.size(),
            Self::Chaise(sofa) => sofa.size(),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        match self {
            Self::Loose(sofa) => sofa.build(b, pose, rng),
            Self::Upholstered(sofa) => sofa.build(b, "sofa", pose, rng),
            Self::Open(sofa) => sofa.build(b, "sofa", pose, rng),
            Self::Chaise(sofa) => sofa.build(b, "sofa", pose, rng),
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
        for (i, &(_, style)) in SOFAS.iter().enumerate() {
            things.push((format!("upholstered {i}"), Box::new(Sofa::Upholstered(Upholstered::of(style, &mut rng)))));
        }
        for (i, &(_, style)) in SOFA_FRAMES.iter().enumerate() {
            things.push((format!("frame {i}"), Box::new(Sofa::Open(OpenFrame::of(style, 2, &mut rng)))));
        }
        for i in 0..6 {
            things.push((format!("chaise {i}"), Box::new(Sofa::Chaise(ChaiseLongue::random(&mut rng)))));
        }
        check(Place::AgainstWall, &things);
    }
}
