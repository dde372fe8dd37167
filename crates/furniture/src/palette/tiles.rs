//! Tiles of walls and floors in the formats that are sold: metro tiles, large slabs, hand-made squares, terracotta.

use enfilade_math::{Rgb, Rng};
use enfilade_textures::{TileFigure, TileLook};

/// White of glazed tiles.
pub(super) const GLAZE: Rgb = Rgb::new(0.76, 0.755, 0.73);
/// Saturation of tiles that cover whole rooms: their light falls on each other and grows more colourful with every bounce.
const TILED: f32 = 0.22;

/// A colour without more saturation than tiled rooms bear, as light as before.
pub(super) fn quiet(c: Rgb) -> Rgb {
    let (max, min) = (c.max_component(), c.r.min(c.g).min(c.b));
    let saturation = (max - min) / max.max(1e-3);
    c.lerp(Rgb::splat(c.luminance()), 1.0 - (TILED / saturation.max(TILED)))
}

/// A usual wall of tiles.
pub(super) fn wall_tile(kind: usize, [soft, strong]: [Rgb; 2], rng: &mut Rng) -> TileLook {
    let color = [GLAZE, GLAZE, soft, strong][rng.below(4)];
    let plain = TileLook {
        tile: [0.10, 0.10],
        joint: 0.002,
        bond: 0.0,
        colors: [color, strong],
        grout: Rgb::splat(0.55),
        figure: TileFigure::Plain,
        alpha: 0.05,
        handmade: 0.0,
    };
    match kind {
        // Metro tiles.
        0 => TileLook { tile: [0.20, 0.10], bond: 0.5, ..plain },
        // Hand-made squares and bars.
        1 => TileLook { handmade: 0.6, ..plain },
        2 => TileLook { tile: [0.065, 0.20], handmade: 0.45, bond: 0.5, ..plain },
        // Large formats.
        3 => TileLook { tile: [0.30, 0.60], colors: [GLAZE; 2], alpha: 0.12, ..plain },
        4 => TileLook {
            tile: [0.60, 0.30],
            bond: 0.5,
            colors: [Rgb::new(0.50, 0.46, 0.40), strong],
            grout: Rgb::new(0.42, 0.39, 0.34),
            figure: TileFigure::Stone,
            alpha: 0.22,
            ..plain
        },
        _ => TileLook { tile: [0.15, 0.15], handmade: 0.12, ..plain },
    }
}

/// A usual tiled floor.
pub(super) fn floor_tile(kind: usize, [figure, dark]: [Rgb; 2], rng: &mut Rng) -> TileLook {
    let stones = [Rgb::new(0.40, 0.38, 0.35), Rgb::new(0.22, 0.215, 0.21), Rgb::new(0.50, 0.44, 0.35), Rgb::new(0.075, 0.077, 0.08)];
    let stone = stones[rng.below(4)];
    let slabs = TileLook {
        tile: [0.60, 0.60],
        joint: 0.003,
        bond: 0.0,
        colors: [stone, dark],
        grout: (stone * 0.75).lerp(Rgb::splat(0.3), 0.3),
        figure: TileFigure::Stone,
        alpha: 0.25,
        handmade: 0.0,
    };
    let pale = Rgb::new(0.62, 0.59, 0.52);
    match kind {
        0 => slabs,
        1 => TileLook { tile: [0.60, 0.30], bond: 0.5, ..slabs },
        2 => TileLook { tile: [0.30, 0.30], ..slabs },
        3 => TileLook {
            tile: [0.20, 0.20],
            joint: 0.0015,
            colors: [pale, figure.lerp(dark, 0.3)],
            figure: TileFigure::Inlaid,
            alpha: 0.3,
            ..slabs
        },
        4 => {
            let dark = if rng.below(2) == 0 { Rgb::splat(0.035) } else { dark };
            TileLook { tile: [0.20, 0.20], joint: 0.002, colors: [pale, dark], figure: TileFigure::Checker, alpha: 0.12, ..slabs }
        }
        // Terracotta.
        _ => TileLook {
            tile: [0.20, 0.20],
            joint: 0.006,
            colors: [Rgb::new(0.40, 0.17, 0.085), dark],
            grout: Rgb::new(0.42, 0.37, 0.30),
            figure: TileFigure::Plain,
            alpha: 0.35,
            handmade: 0.7,
            ..slabs
        },
    }
}
