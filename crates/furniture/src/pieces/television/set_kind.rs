//! What is drawn of a television set: its case and measures, and what it shows.

use crate::materials::Finish;

/// What a flat set stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetStand {
    /// A foot across the depth below either end.
    Feet,
    /// Two blades of metal that spread below either end.
    Blades,
    /// A neck in the middle on a plate.
    Plate,
    /// A neck in the middle on a bent bar.
    Bar,
    /// A case of loudspeakers below the screen, on a plate: sets of about 2005.
    Speakers,
    /// None: the whole set is a box with a picture tube, 4:3.
    Tube,
}

/// A television set.
#[derive(Clone, Copy, Debug)]
pub struct TelevisionSet {
    /// What it stands on.
    pub stand: SetStand,
    /// Width of the set.
    pub width: f32,
    /// Width of the frame beside the screen.
    pub bezel: f32,
    /// Finish of the case.
    pub finish: Finish,
    /// What it shows; `None` is off.
    pub shows: Option<u8>,
}

impl TelevisionSet {
    /// Width and height of the screen.
    pub fn screen(&self) -> [f32; 2] {
        let width = self.width - 2.0 * self.bezel;
        [width, width * if self.stand == SetStand::Tube { 0.75 } else { 0.5625 }]
    }

    /// Depth of the set.
    pub fn depth(&self) -> f32 {
        match self.stand {
            SetStand::Feet | SetStand::Blades => 0.24,
            SetStand::Plate | SetStand::Bar | SetStand::Speakers => 0.23,
            SetStand::Tube => 0.42 + 0.16 * (self.width - 0.46) / 0.28,
        }
    }
}
