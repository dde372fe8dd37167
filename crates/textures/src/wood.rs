//! Wood: veneer for furniture, strips for floors, herringbone.

use super::noise::{fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};

/// Planks beside each other in the picture of a floor; each has its own tone and grain.
pub const FLOOR_STRIPS: usize = 8;

/// A kind of wood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WoodTone {
    /// Spring wood, linear reflectance.
    pub light: Rgb,
    /// Summer wood and pores.
    pub dark: Rgb,
    /// How much the growth rings show, 0 to 1.
    pub rings: f32,
    /// How much the pores show.
    pub pores: f32,
    /// Share of floorboards with a knot.
    pub knots: f32,
}

impl WoodTone {
    /// Oak under clear oil.
    pub const OAK: Self =
        Self { light: Rgb::new(0.53, 0.37, 0.22), dark: Rgb::new(0.33, 0.205, 0.105), rings: 0.5, pores: 0.45, knots: 0.35 };
    /// White-oiled oak.
    pub const WHITE_OAK: Self =
        Self { light: Rgb::new(0.60, 0.49, 0.36), dark: Rgb::new(0.44, 0.33, 0.225), rings: 0.45, pores: 0.4, knots: 0.3 };
    /// Pale ash.
    pub const ASH: Self = Self { light: Rgb::new(0.60, 0.47, 0.33), dark: Rgb::new(0.42, 0.30, 0.19), rings: 0.6, pores: 0.3, knots: 0.1 };
    /// American walnut.
    pub const WALNUT: Self =
        Self { light: Rgb::new(0.21, 0.115, 0.062), dark: Rgb::new(0.085, 0.042, 0.024), rings: 0.55, pores: 0.35, knots: 0.2 };
    /// Smoked oak.
    pub const SMOKED: Self =
        Self { light: Rgb::new(0.26, 0.175, 0.105), dark: Rgb::new(0.13, 0.08, 0.045), rings: 0.5, pores: 0.45, knots: 0.35 };
    /// Pine under clear lacquer: wide rings, many knots.
    pub const PINE: Self =
        Self { light: Rgb::new(0.66, 0.46, 0.25), dark: Rgb::new(0.47, 0.26, 0.10), rings: 0.75, pores: 0.05, knots: 0.8 };
    /// Birch: pale and quiet.
    pub const BIRCH: Self =
        Self { light: Rgb::new(0.66, 0.53, 0.37), dark: Rgb::new(0.53, 0.40, 0.255), rings: 0.25, pores: 0.15, knots: 0.0 };
    /// Cherry: red and fine.
    pub const CHERRY: Self =
        Self { light: Rgb::new(0.42, 0.215, 0.105), dark: Rgb::new(0.28, 0.12, 0.052), rings: 0.35, pores: 0.2, knots: 0.1 };
    /// All kinds.
    pub const ALL: [Self; 8] = [Self::OAK, Self::WHITE_OAK, Self::ASH, Self::WALNUT, Self::SMOKED, Self::PINE, Self::BIRCH, Self::CHERRY];
}

/// Far more lattice points than a board has across.
const NO_PERIOD: i32 = 1 << 20;

/// Rings and pores at `p`: x along the board, repeating after 1, y across it in board widths. `stretch` is how long the picture is
/// in units of 1.6 m. 0 is spring wood, 1 a ring or pore; second, the pores alone.
fn rings_and_pores(p: Vec2, tone: &WoodTone, stretch: i32, seed: u32) -> (f32, f32) {
    let wave = |along: i32, across: f32, key: u32| {
        let period = along * stretch;
        noise(Vec2::new(p.x * period as f32, p.y * across), [period, NO_PERIOD], seed ^ key)
    };
    let wander = 0.6 * wave(3, 0.9, 0) + 0.16 * wave(11, 2.4, 1) + 0.05 * wave(30, 6.0, 5);
    // Rings are cones about the heart of the tree; a board cuts them in arches near the heart and in straight lines beside it.
    let heart = 0.5 + 1.9 * (lattice(3, 1, seed) - 0.5);
    let depth = 0.10 + 0.5 * lattice(4, 1, seed);
    let across = p.y - heart + 0.12 * wander;
    let count = 7.0 + 5.0 * lattice(5, 1, seed);
    let rings = count * across.hypot(depth) + (2.0 * p.x * stretch as f32) + 0.75 * wander;
    let phase = rings - rings.floor();
    let ring = smoothstep(0.1, 0.9, phase) * (1.0 - smoothstep(0.9, 1.0, phase));
    let fibre = 0.5 + 0.5 * wave(26, 60.0, 2);
    let streak = smoothstep(0.45, 0.95, wave(44, 110.0, 3)) * (0.35 + 0.65 * (1.0 - smoothstep(0.2, 0.6, phase)));
    let shade = tone.rings * ring + 0.30 * fibre + tone.pores * streak;
    (shade.clamp(0.0, 1.0), streak)
}

/// A knot's darkness at a distance from it, in its own radii.
fn knot(distance: f32) -> f32 {
    let rim = (-(distance - 0.9).powi(2) * 18.0).exp();
    (0.65 * (-distance * distance * 1.2).exp() + 0.35 * rim).min(1.0)
}

/// The wood at `p` of a board (x on [0,1] of the picture, y across) with its own tone.
fn board(p: Vec2, aspect: f32, tone: &WoodTone, stretch: i32, own: u32) -> Grain {
    let mut at = p;
    let mut dark = 0.0;
    if lattice(7, 7, own) < tone.knots {
        let mut away = Vec2::new(p.x - lattice(1, 5, own), 0.0);
        away.x -= away.x.round();
        let away = Vec2::new(away.x * aspect, p.y - (0.25 + 0.5 * lattice(2, 5, own)));
        let radius = 0.07 + 0.10 * lattice(3, 5, own);
        let distance = (away / Vec2::new(1.4, 1.0)).length() / radius;
        // Fibres flow around it.
        at.y += 0.5 * radius * away.y.signum() * (-distance * distance * 0.12).exp() * (1.0 - (-distance * 2.0).exp());
        dark = knot(distance);
    }
    let (shade, streak) = rings_and_pores(at, tone, stretch, own);
    let bright = 0.88 + 0.22 * lattice(5, 11, own);
    let warm = 0.05 * (lattice(6, 23, own) - 0.5);
    let color = tone.light.lerp(tone.dark, (0.95 * shade).min(1.0)).lerp(tone.dark * 0.45, 0.85 * dark);
    Grain {
        color: color * Rgb::new(1.0 + warm, 1.0, 1.0 - 1.5 * warm) * bright,
        alpha: 0.22 + 0.12 * shade + 0.10 * streak,
        height: 0.75 - 0.5 * streak * (0.3 + tone.pores) - 0.1 * shade,
    }
}

/// A sheet of veneer, 1024 × 512 pixels over 1.6 × 0.8 m: five leaves, grain along u.
pub fn veneer(name: &str, tone: &WoodTone, seed: u32) -> Skin {
    /// Leaves of veneer above each other.
    const LEAVES: f32 = 5.0;
    let calm = WoodTone { knots: 0.0, ..*tone };
    skin(name, [1024, 512], |uv| {
        let leaf = (uv.y * LEAVES).floor().min(LEAVES - 1.0);
        let cloud = 1.0 + 0.05 * fbm(uv, [3, 2], 2, seed ^ 9);
        // Neighbouring leaves come from one log: one tone, and every other one is turned over.
        let across = uv.y * LEAVES - leaf;
        let across = if leaf as i32 % 2 == 1 { 1.0 - across } else { across };
        let own = seed ^ (leaf as u32 / 2).wrapping_mul(0x517c);
        let grain = board(Vec2::new(uv.x, across), 10.0, &calm, 1, own);
        let tone = 1.0 / (0.88 + 0.22 * lattice(5, 11, own)) * (0.97 + 0.05 * lattice(leaf as i32, 0, seed));
        Grain { color: grain.color * (cloud * tone), ..grain }
    })
}

/// [`FLOOR_STRIPS`] floorboards one above the other, 1024 pixels square over 2 × 1 m; grain along u.
pub fn floor_planks(name: &str, tone: &WoodTone, seed: u32) -> Skin {
    skin(name, [1024, 1024], |uv| {
        let strip = (uv.y * FLOOR_STRIPS as f32).floor();
        board(Vec2::new(uv.x, uv.y * FLOOR_STRIPS as f32 - strip), 16.0, tone, 1, seed.wrapping_add(strip as u32 * 7919))
    })
}

/// Blocks of a herringbone floor: six times as long as wide.
const BLOCK: i32 = 6;
/// Widths of blocks across the picture.
const WIDTHS: i32 = 4 * BLOCK;

/// Herringbone parquet with its joints, 1024 pixels square over [`HERRINGBONE_M`] metres.
pub fn herringbone(name: &str, tone: &WoodTone, seed: u32) -> Skin {
    let calm = WoodTone { knots: 0.12, ..*tone };
    skin(name, [1024, 1024], |uv| {
        let p = uv * WIDTHS as f32;
        let (i, j) = (p.x.floor() as i32, p.y.floor() as i32);
        let f = Vec2::new(p.x - i as f32, p.y - j as f32);
        let k = (i - j).rem_euclid(2 * BLOCK);
        // Along and across the block, in its widths, and the cell where it begins.
        let (along, across, start) = if k < BLOCK {
            (k as f32 + f.x, f.y, [i - k, j])
        } else {
            let step = 2 * BLOCK - 1 - k;
            (step as f32 + f.y, f.x, [i, j - step])
        };
        let own = seed ^ (lattice(start[0].rem_euclid(WIDTHS), start[1].rem_euclid(WIDTHS), seed) * 16_777_216.0) as u32;
        // A block shows a piece of its board.
        let piece = Vec2::new(along / 24.0 + lattice(9, 1, own), 0.25 + 0.6 * across);
        let grain = board(piece, 18.0, &calm, 1, own);
        let edge = across.min(1.0 - across).min(along).min(BLOCK as f32 - along);
        let joint = 1.0 - smoothstep(0.0, 0.028, edge);
        Grain { color: grain.color * (1.0 - 0.62 * joint), height: grain.height * (1.0 - 0.8 * joint), alpha: grain.alpha + 0.2 * joint }
    })
}

/// Metres that [`herringbone`] covers: blocks of 70 × 420 mm.
pub const HERRINGBONE_M: f32 = 0.07 * WIDTHS as f32;
