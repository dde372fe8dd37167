//! Dining chairs, class chair: a seat on round legs with a bent rail, straight frames of wood, bentwood, steel tube that springs, folding and
//! padded chairs, plastic chairs and stools. A row of [`STYLES`] is a style with its weight. The sitter looks to +y; what is in front of the
//! seat's middle by more than 15 cm is lower than 62 cm, so that chairs fit under tables.

mod bent;
mod bent_rail;
mod folding;
mod padded;
mod plastic;
mod stool;
mod wooden;

use self::bent::{Bentwood, Cantilever};
use self::bent_rail::BentRail;
use self::folding::FoldingChair;
use self::padded::PaddedChair;
use self::plastic::PlasticChair;
use self::stool::Stool;
use self::wooden::{Bottom, Filling, WoodenChair};
use super::Furniture;
use super::style::drawn;
use crate::builder::Builder;
use crate::materials::Finish;
use crate::materials::Finish::{
    Aluminium, ArmchairCloth, BlackMetal, Chrome, ColoredLacquer, DarkWood, Leather, Rattan, SofaCloth, Velvet, WhiteLacquer, WhitePaint,
    Wicker, Wood,
};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A dining chair.
#[derive(Clone, Copy, Debug)]
pub enum Chair {
    /// A hollowed seat and a bent rail.
    BentRail(BentRail),
    /// A straight frame of wood.
    Wooden(WoodenChair),
    /// A round seat in a frame of bent rods.
    Bentwood(Bentwood),
    /// A frame of steel tube without rear legs.
    Cantilever(Cantilever),
    /// Two crossed frames that fold.
    Folding(FoldingChair),
    /// Padded all over.
    Padded(PaddedChair),
    /// Of one piece of plastic.
    Plastic(PlasticChair),
    /// Without a back.
    Stool(Stool),
}

/// A style: what does not vary between chairs that are of it.
#[derive(Clone, Copy, Debug)]
enum Style {
    BentRail,
    /// Filling of the back, woven or padded seat, height of the back, square legs, finishes.
    Wooden(Filling, Bottom, f32, bool, &'static [Finish]),
    Bentwood,
    Cantilever,
    Folding,
    Padded,
    Plastic,
    Stool,
}

const WOODS: &[Finish] = &[Wood, DarkWood, WhitePaint, Wood];

/// The styles and their weights.
const STYLES: &[(u32, Style)] = &[
    (4, Style::BentRail),
    (2, Style::Wooden(Filling::Ladder, Bottom::Woven, 0.96, false, WOODS)),
    (2, Style::Wooden(Filling::Ladder, Bottom::Board, 0.88, true, WOODS)),
    (2, Style::Wooden(Filling::Slats, Bottom::Board, 0.9, true, &[Wood, DarkWood, WhiteLacquer, ColoredLacquer(0)])),
    (1, Style::Wooden(Filling::Slats, Bottom::Padded(SofaCloth), 1.02, true, &[DarkWood, Wood])),
    (2, Style::Wooden(Filling::Cross, Bottom::Woven, 0.88, false, &[Wood, DarkWood, WhitePaint, BlackMetal])),
    (1, Style::Wooden(Filling::Splat, Bottom::Padded(Velvet), 1.0, false, &[DarkWood, Wood])),
    (1, Style::Wooden(Filling::Padded, Bottom::Padded(Leather), 1.04, true, &[DarkWood, BlackMetal])),
    (2, Style::Wooden(Filling::Padded, Bottom::Padded(ArmchairCloth), 0.86, false, &[Wood, DarkWood])),
    (2, Style::Bentwood),
    (2, Style::Cantilever),
    (2, Style::Folding),
    (2, Style::Padded),
    (1, Style::Plastic),
    (1, Style::Stool),
];

impl Chair {
    fn of(style: Style, rng: &mut Rng) -> Self {
        match style {
            Style::BentRail => Self::BentRail(BentRail::random(rng)),
            Style::Wooden(filling, bottom, top, square, finishes) => {
                let finish = finishes[rng.below(finishes.len())];
                Self::Wooden(WoodenChair { filling, bottom, top: top + rng.range(-0.02, 0.02), finish, square })
            }
            Style::Bentwood => {
                let finish = [Wood, DarkWood, DarkWood, Rattan][rng.below(4)];
                Self::Bentwood(Bentwood { finish, woven: rng.below(2) == 0 })
            }
            Style::Cantilever => {
                let cover = [Wicker, Leather, Leather, ArmchairCloth][rng.below(4)];
                Self::Cantilever(Cantilever { frame: [Chrome, Chrome, BlackMetal][rng.below(3)], cover })
            }
            Style::Folding => {
                let slatted = rng.below(2) == 0;
                let finish =
                    if slatted { [Wood, WhitePaint, DarkWood][rng.below(3)] } else { [BlackMetal, Aluminium, WhiteLacquer][rng.below(3)] };
                Self::Folding(FoldingChair { slatted, finish })
            }
            Style::Padded => Self::Padded(PaddedChair::random(rng)),
            Style::Plastic => Self::Plastic(PlasticChair::random(rng)),
            Style::Stool => Self::Stool(Stool::random(rng)),
        }
    }
}

impl Furniture for Chair {
    fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    fn size(&self) -> Vec3 {
        match self {
            Self::BentRail(chair) => chair.size(),
            Self::Wooden(chair) => chair.size(),
            Self::Bentwood(_) => Bentwood::SIZE,
            Self::Cantilever(_) => Cantilever::SIZE,
            Self::Folding(_) => FoldingChair::SIZE,
            Self::Padded(chair) => chair.size(),
            Self::Plastic(_) => PlasticChair::SIZE,
            Self::Stool(_) => Stool::SIZE,
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        match self {
            Self::BentRail(chair) => chair.build(b, pose, rng),
            Self::Wooden(chair) => chair.build(b, pose, rng),
            Self::Bentwood(chair) => chair.build(b, pose, rng),
            Self::Cantilever(chair) => chair.build(b, pose, rng),
            Self::Folding(chair) => chair.build(b, pose, rng),
            Self::Padded(chair) => chair.build(b, pose, rng),
            Self::Plastic(chair) => chair.build(b, pose, rng),
            Self::Stool(chair) => chair.build(b, pose, rng),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::scene_of;
    use crate::pieces::{Place, style_tests::check};

    fn all() -> Vec<(String, Box<dyn Furniture>)> {
        let mut rng = Rng::new(3);
        let of = |(i, &(_, style)): (usize, &(u32, Style))| [0, 1].map(|k| (format!("{style:?} {i}.{k}"), Chair::of(style, &mut rng)));
        let chairs: Vec<_> = STYLES.iter().enumerate().flat_map(of).collect();
        chairs.into_iter().map(|(name, chair)| (name, Box::new(chair) as Box<dyn Furniture>)).collect()
    }

    #[test]
    fn every_style_stands_and_is_of_one_piece() {
        check(Place::Free, &all());
    }

    #[test]
    fn every_style_fits_under_a_table_and_has_a_seat_at_its_height() {
        for (name, chair) in all() {
            let scene = scene_of(chair.as_ref(), 1);
            let points: Vec<Vec3> = scene.parts.iter().flat_map(|part| scene.world_positions(part).collect::<Vec<_>>()).collect();
            assert!(points.iter().all(|p| p.y < 0.15 || p.z < 0.62), "{name} runs into the table");
            let seats = scene.parts.iter().filter(|part| part.name.ends_with("/seat"));
            let seat = seats.flat_map(|part| scene.world_positions(part).collect::<Vec<_>>()).map(|p| p.z).fold(0.0, f32::max);
            assert!((0.43..0.5).contains(&seat), "{name} has its seat at {seat}");
        }
    }
}
