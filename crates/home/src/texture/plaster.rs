//! Mineral surfaces.

use super::noise::{fbm, lattice, smoothstep};
use super::{measure, paint};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// Painted plaster: a nearly white factor with faint clouds (first), and its rolled relief as heights (second). Both tile.
pub fn plaster(name: &str, seed: u32) -> (Image, Image) {
    let tint = paint(name, 512, 512, |uv| {
        let cloud = 0.020 * fbm(uv, [4, 4], 4, seed) + 0.008 * fbm(uv, [60, 60], 2, seed ^ 5);
        Rgb::new(0.975, 0.974, 0.972) * (1.0 + cloud).min(1.02)
    });
    let relief =
        measure(&format!("{name} relief"), 512, 512, |uv| 0.5 + 0.32 * fbm(uv, [70, 70], 3, seed ^ 17) + 0.12 * fbm(uv, [9, 9], 2, seed));
    (tint, relief)
}

/// Honed stone with speckles and a few soft veins, as a factor. Tiles.
pub fn stone(name: &str, seed: u32) -> Image {
    paint(name, 512, 512, |uv| {
        let warped = uv + 0.05 * Vec2::new(fbm(uv, [4, 4], 3, seed), fbm(uv, [4, 4], 3, seed ^ 3));
        let vein = 1.0 - smoothstep(0.0, 0.07, fbm(warped, [3, 3], 3, seed ^ 7).abs());
        let speck = lattice((uv.x * 512.0) as i32, (uv.y * 512.0) as i32, seed) - 0.5;
        let value = 0.90 + 0.07 * fbm(uv, [5, 5], 4, seed ^ 11) - 0.16 * vein + 0.05 * speck;
        Rgb::new(1.0, 0.985, 0.955) * value
    })
}
