//! What is drawn of a bed: its measures, its frame and what lies on it.

use super::bedding::Cover;

/// The frame under the mattress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BedFrame {
    /// Wooden rails with a headboard of one panel.
    Panel,
    /// Wooden rails with a headboard of upright slats.
    Slats,
    /// An upholstered box with a padded headboard of upright channels.
    Upholstered,
    /// An upholstered box with a plain, tall padded headboard.
    BoxSpring,
    /// Black metal tubes.
    Metal,
    /// An upholstered box with a headboard drawn in by buttons.
    Buttoned,
    /// An upholstered box with a tall headboard between two wings.
    Winged,
    /// An upholstered box without a headboard.
    Divan,
    /// Wooden rails with an arch of bent rattan and sticks.
    Rattan,
    /// Four posts joined at their upper ends.
    FourPoster,
    /// Curved boards at head and foot.
    Sleigh,
    /// A low platform that is wider than the mattress.
    Platform,
    /// Drawers below the mattress and shelves in the headboard.
    Storage,
    /// Ornate metal with arches and bars.
    Iron,
    /// A back along one side and both ends.
    Sided,
    /// Two beds, one above the other.
    Bunk,
}

/// A bed, its head to the wall.
#[derive(Clone, Copy, Debug)]
pub struct Bed {
    /// Width of the mattress: 0.9 m for one, 1.4 to 1.8 m for two.
    pub width: f32,
    /// Length of the mattress.
    pub length: f32,
    /// The frame under the mattress.
    pub frame: BedFrame,
    /// The cover of the bed.
    pub cover: Cover,
    /// Scatter cushions.
    pub cushions: usize,
    /// A throw across the foot.
    pub throw: bool,
    /// Height of the headboard.
    pub headboard: f32,
}

/// Thickness of headboards of wood or metal, metres.
pub(super) const BOARD: f32 = 0.04;
/// Thickness of padded headboards, metres.
pub(super) const PADDED: f32 = 0.09;
/// Height of the rails' upper edge, metres.
pub(super) const RAIL: f32 = 0.32;
/// How far rails protrude beyond the mattress, metres.
pub(super) const OUT: f32 = 0.03;
