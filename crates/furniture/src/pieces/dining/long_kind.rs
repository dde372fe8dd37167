//! What is drawn of a long table: its measures, the outline of its top, its stand and finishes.

use crate::materials::Finish;
use crate::pieces::tableware::PlaceSetting;

/// A rectangular dining table.
#[derive(Clone, Copy, Debug)]
pub struct LongTable {
    /// Length along x.
    pub length: f32,
    /// Width along y.
    pub width: f32,
    /// The outline of the top.
    pub outline: Outline,
    /// The stand of the table.
    pub stand: Stand,
    /// The top is cut for a leaf in the middle, to be pulled out.
    pub extends: bool,
    /// Finish of the top.
    pub finish: Finish,
    /// Finish of the stand.
    pub below: Finish,
    /// The setting of every place along the long sides, if the table is laid.
    pub laid: Option<PlaceSetting>,
}

/// The outline of a table's top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// A rectangle.
    Rectangle,
    /// A rectangle with round corners.
    Rounded,
    /// An oval: a superellipse with the exponent 2.6.
    Oval,
    /// Planks side by side between two across their ends.
    Planks,
}

/// The stand of a long table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// Square legs in the corners and an apron.
    Corners,
    /// Round legs that slant outward.
    Slanted,
    /// Two frames of metal.
    Frames,
    /// Crossed beams at either end, with a beam between them.
    Trestle,
    /// Two turned columns on feet.
    Columns,
    /// Thick turned legs and an apron, as of farm kitchens.
    Turned,
    /// Two crosses of metal.
    Crosses,
    /// Legs of bent wire.
    Hairpins,
    /// Two boards and a rail between them.
    Panels,
    /// One thick column on a broad foot.
    Column,
    /// Two trestles that fold: each a pair of frames that lean against each other.
    Folding,
}

/// Height of the top's surface, metres: EN 1729 and common practice have 720 to 760 mm.
pub(super) const TOP: f32 = 0.75;
/// Thickness of the top, metres.
pub(super) const BOARD: f32 = 0.032;
