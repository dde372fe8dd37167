//! The styles of sofas and easy chairs: each is a row with its weight. Dimensions are those that makers give for the kind.

use super::arms::Arms::{Box, Flared, None as Armless, Rolled, Wings};
use super::back::Back::{Buttoned, Camel, Channels, Cushions, Pillowed, Tight};
use super::feet::SeatFeet::{Blocks, Buns, Plinth, Runners, Skirt, Tapered};
use super::upholstered::Seat;
use crate::materials::Finish;
use crate::materials::Finish::{
    ArmchairCloth, BlackMetal, Boucle, Brass, Chrome, DarkWood, Felt, Leather, Rattan, SofaCloth, Velvet, WhitePaint, Wood,
};

const CLOTHS: &[Finish] = &[SofaCloth, SofaCloth, ArmchairCloth, Boucle, Felt];
const FINE: &[Finish] = &[Velvet, Velvet, Leather, ArmchairCloth];
const ANY: &[Finish] = &[SofaCloth, ArmchairCloth, Leather, Velvet, Boucle];
const HIDE: &[Finish] = &[Leather, Leather, SofaCloth];

/// A style from which others differ: arms like blocks, loose cushions, tapered legs.
const PLAIN: Seat = Seat {
    arms: Box,
    arm: 0.16,
    arm_height: 0.6,
    back: Cushions,
    top: 0.82,
    bench: false,
    feet: Tapered(Wood),
    leg: 0.12,
    depth: 0.9,
    seat: 0.43,
    reclines: false,
    seats: [2, 3],
    wide: [0.62, 0.72],
    covers: CLOTHS,
};

/// Upholstered sofas.
pub const SOFAS: &[(u32, Seat)] = &[
    // A loveseat.
    (2, Seat { arms: Flared, arm: 0.12, back: Tight, top: 0.8, depth: 0.82, seats: [2, 2], wide: [0.54, 0.6], covers: ANY, ..PLAIN }),
    // Track arms: narrow and low, one cushion on metal runners.
    (2, Seat { arm: 0.09, arm_height: 0.56, top: 0.74, bench: true, feet: Runners(BlackMetal), leg: 0.15, wide: [0.66, 0.76], ..PLAIN }),
    // A tuxedo: arms as high as the back, all of it buttoned.
    (
        2,
        Seat {
            arm: 0.11,
            arm_height: 0.74,
            back: Buttoned,
            top: 0.745,
            bench: true,
            feet: Blocks(DarkWood),
            leg: 0.1,
            covers: FINE,
            ..PLAIN
        },
    ),
    // An English sofa: rolled arms and a skirt.
    (
        2,
        Seat {
            arms: Rolled,
            arm: 0.18,
            arm_height: 0.63,
            top: 0.86,
            feet: Skirt,
            leg: 0.14,
            depth: 0.96,
            covers: &[SofaCloth, ArmchairCloth],
            ..PLAIN
        },
    ),
    // Of the fifties: thin arms, buttoned back, long slanted legs.
    (
        2,
        Seat {
            arm: 0.08,
            arm_height: 0.58,
            back: Buttoned,
            top: 0.8,
            leg: 0.19,
            depth: 0.8,
            seat: 0.42,
            feet: Tapered(DarkWood),
            covers: ANY,
            ..PLAIN
        },
    ),
    // A high back with wings.
    (
        1,
        Seat {
            arms: Wings,
            arm: 0.13,
            arm_height: 0.6,
            back: Tight,
            top: 1.06,
            bench: true,
            feet: Buns(DarkWood),
            leg: 0.11,
            depth: 0.86,
            covers: FINE,
            ..PLAIN
        },
    ),
    // A camelback.
    (
        1,
        Seat {
            arms: Rolled,
            arm: 0.15,
            arm_height: 0.6,
            back: Camel,
            top: 0.92,
            feet: Tapered(DarkWood),
            leg: 0.17,
            depth: 0.84,
            covers: ANY,
            ..PLAIN
        },
    ),
    // Channels of velvet on brass.
    (
        1,
        Seat {
            arms: Flared,
            arm: 0.12,
            arm_height: 0.66,
            back: Channels,
            top: 0.78,
            bench: true,
            feet: Tapered(Brass),
            leg: 0.14,
            depth: 0.84,
            covers: &[Velvet],
            ..PLAIN
        },
    ),
    // Blocks without arms on a plinth.
    (2, Seat { arms: Armless, top: 0.7, feet: Plinth, leg: 0.05, depth: 1.0, seat: 0.39, wide: [0.76, 0.92], ..PLAIN }),
    // Reclining seats.
    (
        2,
        Seat {
            arm: 0.24,
            arm_height: 0.62,
            back: Pillowed,
            top: 1.0,
            feet: Plinth,
            leg: 0.05,
            depth: 0.98,
            seat: 0.47,
            reclines: true,
            wide: [0.56, 0.62],
            covers: HIDE,
            ..PLAIN
        },
    ),
    // Deep and low, with broad arms.
    (
        2,
        Seat {
            arm: 0.26,
            arm_height: 0.54,
            top: 0.76,
            feet: Blocks(DarkWood),
            leg: 0.06,
            depth: 1.06,
            seat: 0.41,
            wide: [0.72, 0.84],
            ..PLAIN
        },
    ),
    // A narrow one for offices and halls: no loose cushions, chromed runners.
    (
        1,
        Seat {
            arm: 0.1,
            arm_height: 0.62,
            back: Tight,
            top: 0.76,
            feet: Runners(Chrome),
            leg: 0.16,
            depth: 0.78,
            wide: [0.56, 0.64],
            covers: HIDE,
            ..PLAIN
        },
    ),
];

/// The sides of an open frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Two posts, and a flat board on which the arm rests.
    Planks,
    /// Square posts and upright slats below the arm, after those of the Mission style.
    Slats,
    /// A bent tube that is front leg, arm and rear leg.
    Hoops,
    /// A bent tube, and thin sticks below it, as of rattan.
    Sticks,
    /// Two posts and an arm on curved runners, on which the chair rocks.
    Rockers,
}

/// Sides, finish of the frame, covers, and one mattress over all seats.
pub type Frame = (Sides, Finish, &'static [Finish], bool);

/// Sofas with an open frame.
pub const SOFA_FRAMES: &[(u32, Frame)] = &[
    (2, (Sides::Planks, Wood, CLOTHS, false)),
    // Sofa beds with one mattress.
    (2, (Sides::Slats, Wood, CLOTHS, true)),
    (1, (Sides::Hoops, BlackMetal, &[SofaCloth, ArmchairCloth], true)),
    (2, (Sides::Sticks, Rattan, CLOTHS, false)),
    (1, (Sides::Slats, WhitePaint, CLOTHS, false)),
];

/// Upholstered easy chairs: one seat, mostly in the style of a sofa.
pub const EASY_CHAIRS: &[(u32, Seat)] = &[
    // A wing chair.
    (
        3,
        Seat {
            arms: Wings,
            arm: 0.11,
            arm_height: 0.62,
            back: Tight,
            top: 1.06,
            bench: true,
            feet: Tapered(DarkWood),
            leg: 0.16,
            depth: 0.8,
            covers: ANY,
            ..EASY
        },
    ),
    // A slipper chair.
    (2, Seat { arms: Armless, back: Tight, top: 0.78, leg: 0.2, depth: 0.74, wide: [0.58, 0.66], covers: ANY, ..EASY }),
    (2, Seat { arms: Rolled, arm: 0.14, arm_height: 0.6, top: 0.86, feet: Skirt, leg: 0.14, ..EASY }),
    (2, Seat { arms: Flared, arm: 0.1, back: Channels, top: 0.78, feet: Tapered(Brass), depth: 0.78, covers: &[Velvet], ..EASY }),
    (
        2,
        Seat {
            arm: 0.2,
            arm_height: 0.62,
            back: Pillowed,
            top: 1.02,
            feet: Plinth,
            leg: 0.05,
            depth: 0.94,
            seat: 0.47,
            reclines: true,
            covers: HIDE,
            ..EASY
        },
    ),
    (2, Seat { arm: 0.12, arm_height: 0.64, top: 0.8, feet: Runners(BlackMetal), leg: 0.13, ..EASY }),
    (1, Seat { arm: 0.12, arm_height: 0.72, back: Buttoned, top: 0.74, feet: Buns(DarkWood), leg: 0.11, covers: FINE, ..EASY }),
];

/// An easy chair from which the others differ.
const EASY: Seat = Seat { depth: 0.84, seats: [1, 1], wide: [0.54, 0.62], ..PLAIN };

/// Easy chairs with an open frame.
pub const EASY_FRAMES: &[(u32, Frame)] = &[
    (2, (Sides::Planks, Wood, ANY, false)),
    (1, (Sides::Slats, DarkWood, HIDE, false)),
    (1, (Sides::Hoops, Chrome, HIDE, false)),
    (2, (Sides::Sticks, Rattan, CLOTHS, false)),
    (2, (Sides::Rockers, Wood, CLOTHS, false)),
];
