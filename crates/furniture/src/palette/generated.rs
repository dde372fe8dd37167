//! Palettes made by rule: one leading hue and its companions, in Oklab's lightness, chroma and hue.

use super::colors::{Palette, WHITE};
use super::oklch::oklch;
use super::tiles::{floor_tile, wall_tile};
use enfilade_math::Rng;
use enfilade_textures::{PaperPattern, Pattern, SlabLook, WoodTone};

/// A palette of one leading hue and its companions.
///
/// Walls are pale and nearly neutral in three of four homes, tinted in one of eight, dark in one of eight; cloth has medium lightness and
/// small chroma; accents have larger chroma, and hues that are near to the leading one, opposite, or a third of the circle away.
pub(super) fn palette(rng: &mut Rng) -> Palette {
    let hue = rng.next_f32();
    let companion = hue + [0.08, 0.5, 0.333, -0.333][rng.below(4)] + rng.range(-0.03, 0.03);
    let warm = rng.range(0.17, 0.28);
    let wall = match rng.below(8) {
        0 => oklch(rng.range(0.30, 0.45), rng.range(0.015, 0.05), hue),
        1 => oklch(rng.range(0.78, 0.88), rng.range(0.03, 0.06), hue),
        2..=4 => WHITE,
        _ => oklch(rng.range(0.88, 0.92), rng.range(0.005, 0.02), warm),
    };
    let accent_wall = oklch(rng.range(0.42, 0.82), rng.range(0.03, 0.07), hue);
    let cloth = |rng: &mut Rng, hue: f32, max_chroma: f32| oklch(rng.range(0.35, 0.82), max_chroma * rng.next_f32(), hue);
    let art = [
        oklch(0.92, 0.015, warm),
        oklch(rng.range(0.75, 0.84), 0.06, companion),
        oklch(rng.range(0.60, 0.70), 0.13, companion),
        oklch(rng.range(0.50, 0.60), 0.07, hue),
        oklch(rng.range(0.28, 0.36), 0.04, hue),
    ];
    let kitchen = [oklch(rng.range(0.35, 0.88), rng.range(0.0, 0.06), hue), oklch(rng.range(0.84, 0.92), 0.008, warm)];
    let mut palette = Palette {
        wall,
        accent_wall,
        floor: WoodTone::ALL[rng.below(8)],
        wood: WoodTone::ALL[rng.below(8)],
        sofa: cloth(rng, hue, 0.07),
        armchair: cloth(rng, companion, 0.11),
        rug: [oklch(rng.range(0.72, 0.88), 0.02, warm), oklch(rng.range(0.35, 0.6), 0.07, hue)],
        curtain: oklch(rng.range(0.80, 0.92), 0.015, warm),
        accents: [oklch(rng.range(0.62, 0.78), 0.13, companion), oklch(rng.range(0.45, 0.6), 0.11, hue), oklch(0.88, 0.02, warm)],
        art,
        kitchen,
        slab: [SlabLook::CARRARA, SlabLook::QUARTZ, SlabLook::GRANITE, SlabLook::LIMESTONE, SlabLook::MARQUINA][rng.below(5)],
        floor_tile: floor_tile(0, [art[3], art[4]], rng),
        wall_tile: wall_tile(0, [art[1], art[3]], rng),
        linen: [WHITE; 2],
        linen_pattern: Pattern::Plain,
        paper: PaperPattern::Grass,
        leather: oklch(rng.range(0.3, 0.52), 0.07, 0.15),
    };
    palette.details(rng);
    palette
}
