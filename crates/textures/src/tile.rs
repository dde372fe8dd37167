//! Tiled walls and floors: the bond of the tiles, their joints, their glaze and what they show.

use super::noise::{fbm, lattice, noise, smoothstep};
use super::{Grain, Skin, skin};
use enfilade_math::{Rgb, Vec2};

/// Pattern of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileFigure {
    /// One glaze.
    Plain,
    /// Stoneware with the clouds and veins of limestone.
    Stone,
    /// Cement tiles with an inlaid figure that four of them complete.
    Inlaid,
    /// Two colours in turn.
    Checker,
}

/// A wall or floor of tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileLook {
    /// Width and height of a tile, metres.
    pub tile: [f32; 2],
    /// Width of the joints, metres: 2 mm on walls, 3 mm on floors.
    pub joint: f32,
    /// By which share of a tile each row is shifted against the one below: 0 stacked, 0.5 half bond.
    pub bond: f32,
    /// Tiles and, for [`TileFigure::Inlaid`] and [`TileFigure::Checker`], the second colour: linear reflectances.
    pub colors: [Rgb; 2],
    /// Joints.
    pub grout: Rgb,
    /// Their pattern.
    pub figure: TileFigure,
    /// GGX roughness of the glaze.
    pub alpha: f32,
    /// How uneven hand-made tiles are in tone and surface: 0 to 1.
    pub handmade: f32,
}

impl TileLook {
    /// Tiles across and up in the picture: enough that rows repeat out of sight, and even, for checkers and half bonds.
    fn count(&self) -> [i32; 2] {
        self.tile.map(|side| (2 * (1.3 / (2.0 * side)).round() as i32).max(2))
    }

    /// Metres that the picture covers.
    pub fn covers(&self) -> [f32; 2] {
        let [nx, ny] = self.count();
        [self.tile[0] * nx as f32, self.tile[1] * ny as f32]
    }

    /// Depth of the relief, metres: from the bottom of the joints to the highest tile.
    pub const RELIEF_M: f32 = 0.002;
}

/// The picture of a tiled surface, 1024 pixels square; tiles are in its lower 0.9 of height, joints below.
pub fn tiles(name: &str, look: &TileLook, seed: u32) -> Skin {
    let [nx, ny] = look.count();
    let size = Vec2::from_array(look.tile);
    let texel = look.covers()[0].max(look.covers()[1]) / 1024.0;
    skin(name, [1024, 1024], |uv| {
        let row = (uv.y * ny as f32).floor().min(ny as f32 - 1.0);
        let shift = look.bond * (row % 2.0);
        let x = uv.x * nx as f32 + shift;
        let (i, j) = ((x.floor() as i32).rem_euclid(nx), row as i32);
        let f = Vec2::new(x - x.floor(), uv.y * ny as f32 - row);
        let p = (f - 0.5) * size;
        let random = |k: i32| lattice(i * 16 + k, j, seed);
        let edge = (0.5 * size - p.abs()).min_element() - 0.5 * look.joint;
        let glazed = smoothstep(-0.5 * texel, 0.5 * texel, edge);
        let pillow = smoothstep(0.0, 0.0012 + 0.004 * look.handmade, edge);
        let tilt = (Vec2::new(random(1), random(2)) - 0.5).dot(f - 0.5) * 1.4 * look.handmade;
        let wave = if look.handmade > 0.0 { 0.25 * look.handmade * fbm(uv, [nx * 2, ny * 2], 2, seed ^ 7) } else { 0.0 };
        let tone = 1.0 + (0.03 + 0.22 * look.handmade) * (random(3) - 0.5) + 0.08 * look.handmade * wave;
        let (color, rough) = figure(look, f, uv, [i, j], [nx, ny], seed);
        let sand = noise(uv * 512.0, [512, 512], seed ^ 3);
        let grout = look.grout * (0.97 + 0.10 * sand + 0.06 * fbm(uv, [6, 6], 2, seed ^ 5));
        Grain {
            color: grout.lerp(color * tone, glazed),
            alpha: 0.6 + (look.alpha + rough - 0.6) * glazed,
            height: (0.1 + 0.05 * sand) * (1.0 - glazed) + glazed * (0.35 + 0.4 * pillow + 0.2 * tilt + 0.15 * wave),
        }
    })
}

/// Colour of a tile at `f` on [0,1]², and what is added to its roughness.
fn figure(look: &TileLook, f: Vec2, uv: Vec2, [i, j]: [i32; 2], [nx, ny]: [i32; 2], seed: u32) -> (Rgb, f32) {
    let [first, second] = look.colors;
    match look.figure {
        TileFigure::Plain => (first, 0.0),
        TileFigure::Checker => (if (i + j) % 2 == 0 { first } else { second }, 0.0),
        TileFigure::Stone => {
            // Each tile is cut from another place of the slab.
            let own = seed ^ ((i * 31 + j * 17) as u32).wrapping_mul(0x9e37);
            let cloud = fbm(f * 0.94, [3, 3], 4, own);
            let vein = 1.0 - smoothstep(0.0, 0.10, (fbm(f * 0.94, [2, 2], 3, own ^ 3) + 0.25 * cloud).abs());
            let speck = noise(uv * 512.0, [512, 512], seed);
            (first * (1.0 + 0.09 * cloud + 0.05 * vein + 0.025 * speck), 0.06 * cloud)
        }
        TileFigure::Inlaid => {
            // Mirrored in every other tile, so that four make a rosette.
            let q = Vec2::new(if i % 2 == 0 { f.x } else { 1.0 - f.x }, if j % 2 == 0 { f.y } else { 1.0 - f.y });
            let corner = q.length();
            let ring = (corner - 0.62).abs() < 0.055 || corner < 0.22;
            let petal = (q - 1.0).abs().max_element() < 0.30 && (q - 1.0).abs().dot(Vec2::ONE) < 0.42;
            let leaf = (q.x - q.y).abs() < 0.09 * (1.0 - ((corner - 0.85) / 0.22).powi(2)).max(0.0).sqrt();
            let faded = 0.04 * fbm(uv, [nx, ny], 4, seed ^ 11);
            let color = if ring || petal || leaf { second } else { first };
            (color * (1.0 + faded), 0.1 * faded.abs())
        }
    }
}
