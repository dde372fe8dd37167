//! Flat-sawn wood: veneer for furniture and strips for floors.

use super::noise::{fbm, lattice, noise, smoothstep};
use super::paint;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// Planks beside each other in the picture of a floor; each has its own tone and grain.
pub const FLOOR_STRIPS: usize = 8;

/// Colours of a kind of wood: between the growth rings and in them, linear reflectance.
#[derive(Clone, Copy, Debug)]
pub struct WoodTone {
    /// Spring wood.
    pub light: Rgb,
    /// Summer wood and pores.
    pub dark: Rgb,
}

impl WoodTone {
    /// Oak under clear oil.
    pub const OAK: Self = Self { light: Rgb::new(0.53, 0.37, 0.22), dark: Rgb::new(0.35, 0.22, 0.115) };
    /// Pale, white-oiled ash.
    pub const ASH: Self = Self { light: Rgb::new(0.58, 0.45, 0.31), dark: Rgb::new(0.42, 0.30, 0.19) };
    /// American walnut.
    pub const WALNUT: Self = Self { light: Rgb::new(0.21, 0.115, 0.062), dark: Rgb::new(0.10, 0.05, 0.028) };
    /// Smoked oak.
    pub const SMOKED: Self = Self { light: Rgb::new(0.27, 0.185, 0.115), dark: Rgb::new(0.15, 0.095, 0.055) };
}

/// Grain at `p`: x along the board on [0,1] of its picture, y across it in board widths. 0 is spring wood, 1 pore or ring.
fn grain(p: Vec2, seed: u32) -> f32 {
    let wander = 0.55 * noise(Vec2::new(p.x * 5.0, p.y * 0.8), [1 << 20; 2], seed)
        + 0.16 * noise(Vec2::new(p.x * 17.0, p.y * 2.2), [1 << 20; 2], seed ^ 1);
    // The heart of the board lies off its middle; rings are parabolas around it, as in a flat-sawn board.
    let heart = 0.5 + 0.5 * (lattice(3, 1, seed) - 0.5);
    let across = p.y - heart + 0.35 * wander;
    let rings = 9.0 * (across.abs() + 0.25 * across * across) + 1.3 * p.x + wander;
    let phase = rings.fract();
    let ring = smoothstep(0.25, 0.92, phase) * (1.0 - smoothstep(0.92, 1.0, phase));
    let fibre = 0.5 + 0.5 * noise(Vec2::new(p.x * 46.0, p.y * 74.0), [1 << 20; 2], seed ^ 2);
    let pore = smoothstep(0.55, 0.95, noise(Vec2::new(p.x * 80.0, p.y * 130.0), [1 << 20; 2], seed ^ 3));
    (0.46 * ring + 0.34 * fibre + 0.35 * pore * (0.4 + 0.6 * ring)).clamp(0.0, 1.0)
}

/// A sheet of veneer, 1024 × 512 pixels: grain along u. Tiles with a seam across the grain, where boards end anyway.
pub fn wood(name: &str, tone: WoodTone, seed: u32) -> Image {
    paint(name, 1024, 512, |uv| {
        let boards = 5.0;
        let board = (uv.y * boards).floor();
        let g = grain(Vec2::new(uv.x, (uv.y * boards).fract()), seed ^ (board as u32).wrapping_mul(0x517c));
        let cloud = 1.0 + 0.07 * fbm(uv, [3, 2], 3, seed ^ 9);
        tone.light.lerp(tone.dark, 0.85 * g) * (cloud * (0.95 + 0.1 * lattice(board as i32, 0, seed)))
    })
}

/// [`FLOOR_STRIPS`] floor planks one above the other, 1024 pixels square; grain along u.
pub fn floor_planks(name: &str, tone: WoodTone, seed: u32) -> Image {
    paint(name, 1024, 1024, |uv| {
        let strip = (uv.y * FLOOR_STRIPS as f32).floor();
        let own = seed.wrapping_add(strip as u32 * 7919);
        let across = (uv.y * FLOOR_STRIPS as f32).fract();
        let g = grain(Vec2::new(uv.x, across), own);
        // A knot here and there.
        let knot = Vec2::new(lattice(1, 5, own), 0.25 + 0.5 * lattice(2, 5, own));
        let away = ((uv - Vec2::new(knot.x, uv.y)) * 26.0).x.hypot((across - knot.y) * 3.2);
        let dark = if lattice(7, 7, own) < 0.4 { 0.75 * (-away * away * 1.8).exp() } else { 0.0 };
        let bright = 0.90 + 0.22 * lattice(strip as i32, 11, seed) + 0.05 * fbm(uv, [4, 8], 3, own);
        let warm = 0.04 * (lattice(strip as i32, 23, seed) - 0.5);
        tone.light.lerp(tone.dark, (0.8 * g + dark).min(1.0)) * bright * Rgb::new(1.0 + warm, 1.0, 1.0 - 1.5 * warm)
    })
}
