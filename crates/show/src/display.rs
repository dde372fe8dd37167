//! Display of a picture for people, as a photographer would: exposed for the room, balanced to its light, and without hard white.
//!
//! Hypersim's tone map cuts every channel off at white, so that sunlit floors lose their texture and lamps change their hue, and keeps the
//! colour of the light, which eyes and cameras take back. Here the highlights are compressed by Khronos' PBR Neutral tone mapper
//! (2024, "Khronos PBR Neutral Tone Mapper", constants as published), which does not change darker values, except for the 4 % that it
//! takes for reflections. Then comes the same gamma.

use enfilade_frame::tonemap::{BLACK, ToneMap, encode};

/// Linear brightness that the median of the room is shown at, unless the next two limits change it.
const MIDDLE: f64 = 0.25;
/// Linear brightness that the bright end of the room, its 90th percentile, is shown at: at least as bright as by Hypersim's tone map, so
/// that a white room is not grey, and at most what the curve can still distinguish.
const BRIGHT: [f64; 2] = [0.612, 1.2];
/// Share of the light's colour that white balance removes: a lamp stays warm, and the sky at dusk blue.
const BALANCED: f64 = 0.5;

/// Start of the compression, the share taken for reflections, and how fast highlights lose their colour; as published.
const START: f64 = 0.8 - REFLECTION;
const REFLECTION: f64 = 0.04;
const DESATURATION: f64 = 0.15;

/// Exposure and white balance of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    /// Multiplies radiance.
    pub scale: f64,
    /// Multiplies red, green and blue besides; their mean, weighed as brightness is, differs little from 1.
    pub white: [f64; 3],
}

impl Default for Display {
    fn default() -> Self {
        Self { scale: 1.0, white: [1.0; 3] }
    }
}

impl Display {
    /// For a room with this brightness in the middle and at the bright end, lit by light of this colour, which has a brightness of 1.
    pub fn of_room(middle: f64, bright: f64, light: [f64; 3]) -> Self {
        let shown = (MIDDLE * bright / middle.max(f64::MIN_POSITIVE)).clamp(BRIGHT[0], BRIGHT[1]);
        let scale = if bright < BLACK { 0.0 } else { shown / bright };
        Self { scale, white: light.map(|channel| channel.powf(-BALANCED)) }
    }

    /// Radiance to displayed values on `[0,1]`.
    pub fn apply(&self, radiance: [f64; 3]) -> [f64; 3] {
        let balanced = [0, 1, 2].map(|c| (self.scale * self.white[c] * radiance[c]).max(0.0));
        compressed(balanced).map(encode)
    }

    /// Hypersim's curve with this exposure, for layers that are shown beside the picture.
    pub const fn tone(&self) -> ToneMap {
        ToneMap { scale: self.scale }
    }
}

/// The PBR Neutral tone mapper.
fn compressed(color: [f64; 3]) -> [f64; 3] {
    let darkest = color[0].min(color[1]).min(color[2]);
    // Below 2 × 4 % the offset is blended out, without an edge.
    let offset = if darkest < 2.0 * REFLECTION { darkest - darkest * darkest / (4.0 * REFLECTION) } else { REFLECTION };
    let color = color.map(|channel| channel - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let lowered = 1.0 - room * room / (peak + room - START);
    let colored = 1.0 / (DESATURATION * (peak - lowered) + 1.0);
    color.map(|channel| colored * channel * lowered / peak + (1.0 - colored) * lowered)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_room_is_shown_as_stated_and_white_light_changes_no_color() {
        let display = Display::of_room(2.0, 8.0, [1.0; 3]);
        assert_eq!(display, Display { scale: 0.125, white: [1.0; 3] });
        let [r, g, b] = display.apply([2.0, 2.0, 2.0]);
        assert!(r == g && g == b && (r - encode(MIDDLE - REFLECTION)).abs() < 1e-12);
        assert_eq!(Display::of_room(0.01, 4.0, [1.0; 3]).scale, 0.3, "the bright end decides where the room is dark beside it");
        assert_eq!(Display::of_room(1.5, 2.0, [1.0; 3]).scale, 0.306, "and where the room is white");
        assert_eq!(Display::of_room(0.0, 0.0, [1.0; 3]).scale, 0.0);
    }

    #[test]
    fn warm_light_is_balanced_in_part() {
        let display = Display::of_room(1.0, 1.0, [1.2, 1.0, 0.6]);
        let [r, g, b] = display.apply([1.2, 1.0, 0.6]);
        assert!(r > g && g > b && r / b < encode(1.2) / encode(0.6));
    }

    #[test]
    fn highlights_stay_below_white_in_their_order_and_lose_colour() {
        let shown: Vec<[f64; 3]> = [0.5, 1.0, 2.0, 8.0, 1e4].iter().map(|v| compressed([*v, 0.5 * v, 0.25 * v])).collect();
        assert!(shown.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[1][0] <= 1.0));
        let last = shown[4];
        assert!(last[2] > 0.9 && shown[0][2] < 0.3, "{shown:?}");
        // The published curve at a grey of 1: 1 − 0.24²/(0.96 + 0.24 − 0.76).
        assert!((compressed([1.0; 3])[0] - (1.0 - 0.24 * 0.24 / 0.44)).abs() < 1e-12);
        assert_eq!(compressed([0.0; 3]), [0.0; 3]);
    }
}
