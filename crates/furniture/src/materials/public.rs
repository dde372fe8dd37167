//! Surfaces of offices, schools and shops: carpet tiles, vinyl, ceiling tiles, chalkboards, and printed packages.

use super::{Maker, coated, rough};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Material;
use enfilade_textures::noise::{cells, fbm, lattice, noise, smoothstep};
use enfilade_textures::{self as texture, Grain};

/// Edge of a carpet tile, metres.
pub const CARPET_TILE_M: f32 = 0.5;
/// Edge of a ceiling tile, metres (600 mm grids of EN 13964).
pub const CEILING_TILE_M: f32 = 0.6;
/// Packages beside each other, and above each other, in the picture of [`super::Finish::Packages`].
pub const PACKAGE_COLUMNS: usize = 8;

/// Carpets of offices: greys, blues, a green and a brown, as they are sold.
const CARPETS: [Rgb; 7] = [
    Rgb::new(0.13, 0.13, 0.135),
    Rgb::new(0.21, 0.205, 0.20),
    Rgb::new(0.075, 0.10, 0.145),
    Rgb::new(0.06, 0.075, 0.095),
    Rgb::new(0.17, 0.14, 0.11),
    Rgb::new(0.085, 0.12, 0.105),
    Rgb::new(0.29, 0.27, 0.24),
];
/// Grounds of vinyl, and the chips in them.
const VINYLS: [[Rgb; 2]; 6] = [
    [Rgb::new(0.55, 0.53, 0.48), Rgb::new(0.34, 0.31, 0.26)],
    [Rgb::new(0.48, 0.50, 0.51), Rgb::new(0.27, 0.29, 0.31)],
    [Rgb::new(0.36, 0.42, 0.45), Rgb::new(0.20, 0.25, 0.29)],
    [Rgb::new(0.46, 0.48, 0.40), Rgb::new(0.28, 0.30, 0.23)],
    [Rgb::new(0.60, 0.58, 0.55), Rgb::new(0.45, 0.36, 0.27)],
    [Rgb::new(0.33, 0.32, 0.31), Rgb::new(0.52, 0.51, 0.49)],
];
/// Inks of packages.
const INKS: [Rgb; 10] = [
    Rgb::new(0.62, 0.03, 0.03),
    Rgb::new(0.75, 0.46, 0.02),
    Rgb::new(0.02, 0.13, 0.42),
    Rgb::new(0.03, 0.26, 0.09),
    Rgb::new(0.72, 0.71, 0.68),
    Rgb::new(0.04, 0.04, 0.045),
    Rgb::new(0.30, 0.07, 0.24),
    Rgb::new(0.05, 0.36, 0.42),
    Rgb::new(0.68, 0.22, 0.03),
    Rgb::new(0.45, 0.34, 0.20),
];

impl Maker<'_> {
    /// Loops of two tones; every other tile is turned by a quarter.
    pub(super) fn carpet_tile(&mut self) -> Material {
        let palette = self.palette();
        let own = self.seed("carpet tiles", &(palette.rug, palette.sofa));
        let quiet = CARPETS[own as usize % CARPETS.len()];
        let color = if own.is_multiple_of(5) { quiet.lerp(palette.sofa, 0.25) } else { quiet };
        let covers = 2.0 * CARPET_TILE_M;
        let layers = self
            .skin("carpet tiles", &color, [covers, covers], |seed| texture::skin("carpet tiles", [1024, 1024], |uv| pile(uv, color, seed)));
        layers.relieved(rough("carpet tiles", layers.tinted(Rgb::WHITE), 1.0), 0.002)
    }

    /// Tiles of 305 mm, waxed.
    pub(super) fn vinyl(&mut self) -> Material {
        let palette = self.palette();
        let own = self.seed("vinyl tiles", &(palette.rug, palette.wall)) as usize;
        let [ground, chips] = VINYLS[own % VINYLS.len()];
        let second = if (own / 7).is_multiple_of(4) { VINYLS[(own / 28) % VINYLS.len()][0] } else { ground };
        let layers = self.varnished("vinyl tiles", &(ground, second), [1.22, 1.22], |seed| {
            texture::skin("vinyl tiles", [1024, 1024], |uv| chipped(uv, [ground, second], chips, seed))
        });
        layers.relieved(coated("vinyl tiles", layers.tinted(Rgb::WHITE), layers.alpha(1.0)), 0.000_3)
    }

    /// White fibre with pinholes and short fissures.
    pub(super) fn mineral_tile(&mut self) -> Material {
        let fissured = !self.seed("ceiling tiles", &()).is_multiple_of(3);
        let covers = 2.0 * CEILING_TILE_M;
        let layers = self.skin("ceiling tiles", &fissured, [covers, covers], |seed| {
            texture::skin("ceiling tiles", [1024, 1024], |uv| fibre(uv, fissured, seed))
        });
        layers.relieved(rough("ceiling tiles", layers.tinted(Rgb::new(0.82, 0.815, 0.79)), 0.6), 0.001)
    }

    /// A board with traces of what was wiped off.
    pub(super) fn chalkboard(&mut self, i: u8) -> Material {
        let color = [Rgb::new(0.022, 0.058, 0.04), Rgb::new(0.022, 0.023, 0.024)][usize::from(i) % 2];
        let layers = self.skin("chalkboard", &(), [2.4, 1.2], |seed| texture::skin("chalkboard", [1024, 512], |uv| wiped(uv, seed)));
        let chalk = layers.tinted(color * 4.0);
        rough("chalkboard", chalk, 0.5)
    }

    /// Fronts of packages of many makers.
    pub(super) fn packages(&mut self) -> Material {
        let colors = self.palette().accents;
        let prints =
            self.picture("packages", &colors, [1.0, 1.0], |seed| texture::paint("packages", 1024, 1024, |uv| printed(uv, &colors, seed)));
        coated("printed carton", prints.tinted(Rgb::WHITE), 0.16)
    }
}

fn pile(uv: Vec2, color: Rgb, seed: u32) -> Grain {
    let (cell, q) = ((uv * 2.0).floor(), (uv * 2.0).fract());
    let turned = (cell.x as i32 + cell.y as i32) % 2 == 1;
    let p = if turned { Vec2::new(q.y, q.x) } else { q };
    let own = seed ^ (cell.x as u32 * 7 + cell.y as u32 * 13);
    let streak = noise(Vec2::new(p.x * 90.0, p.y * 7.0), [90, 7], own) + 0.6 * noise(Vec2::new(p.x * 40.0, p.y * 3.0), [40, 3], own ^ 5);
    let loops = noise(p * 128.0, [128, 128], own ^ 9);
    let tone = 1.0 + 0.16 * streak + 0.22 * loops + 0.05 * (lattice(cell.x as i32, cell.y as i32, seed) - 0.5);
    let edge = q.x.min(1.0 - q.x).min(q.y.min(1.0 - q.y));
    let seam = smoothstep(0.006, 0.0, edge);
    Grain { color: color * (tone * (1.0 - 0.25 * seam)).max(0.1), alpha: 1.0, height: (0.6 + 0.3 * loops - 0.5 * seam).clamp(0.0, 1.0) }
}

fn chipped(uv: Vec2, grounds: [Rgb; 2], chips: Rgb, seed: u32) -> Grain {
    let (cell, q) = ((uv * 4.0).floor(), (uv * 4.0).fract());
    let number = cell.x as i32 + cell.y as i32;
    let ground = grounds[(number % 2) as usize];
    let tone = 1.0 + 0.035 * (lattice(cell.x as i32, cell.y as i32, seed) - 0.5);
    let p = if lattice(cell.x as i32, cell.y as i32, seed ^ 3) < 0.5 { q } else { Vec2::new(q.y, q.x) };
    let own = seed ^ (cell.x as u32 * 31 + cell.y as u32 * 57);
    let near = cells(Vec2::new(p.x * 34.0, p.y * 17.0), [34, 17], own);
    let is_chip = near.first < 0.24 && near.id.is_multiple_of(3);
    let shade = if is_chip { if near.id.is_multiple_of(2) { chips } else { ground.lerp(Rgb::splat(0.8), 0.3) } } else { ground };
    let cloud = fbm(p, [4, 4], 3, own ^ 1);
    let edge = q.x.min(1.0 - q.x).min(q.y.min(1.0 - q.y));
    let joint = smoothstep(0.004, 0.0015, edge);
    let wear = fbm(uv, [3, 3], 3, seed ^ 11);
    Grain { color: shade * tone * (1.0 + 0.03 * cloud) * (1.0 - 0.35 * joint), alpha: 0.2 + 0.05 * wear, height: 0.7 - 0.5 * joint }
}

fn fibre(uv: Vec2, fissured: bool, seed: u32) -> Grain {
    let (cell, q) = ((uv * 2.0).floor(), (uv * 2.0).fract());
    let own = seed ^ (cell.x as u32 * 5 + cell.y as u32 * 3);
    let near = cells(q * 96.0, [96, 96], own);
    let hole = if near.id.is_multiple_of(5) { smoothstep(0.3, 0.14, near.first) } else { 0.0 };
    let worm = noise(Vec2::new(q.x * 40.0 + 1.5 * noise(q * 9.0, [9, 9], own), q.y * 110.0), [40, 110], own ^ 2);
    let fissure = if fissured { smoothstep(0.74, 0.84, worm) } else { 0.0 };
    let deep = hole.max(fissure);
    Grain { color: Rgb::splat(0.985 - 0.3 * deep + 0.01 * fbm(q, [6, 6], 2, own)), alpha: 1.0, height: 0.8 - 0.6 * deep }
}

fn wiped(uv: Vec2, seed: u32) -> Grain {
    let sweep = fbm(Vec2::new(uv.x, uv.y), [3, 9], 4, seed);
    let dust = 0.25 + 0.09 * sweep + 0.05 * noise(Vec2::new(uv.x * 60.0, uv.y * 240.0), [60, 240], seed ^ 4);
    Grain { color: Rgb::splat(dust.max(0.12)), alpha: 1.0, height: 0.5 }
}

/// A package's front: a ground, a band with the name in it, a figure, and small print.
fn printed(uv: Vec2, colors: &[Rgb; 3], seed: u32) -> Rgb {
    let p = uv * PACKAGE_COLUMNS as f32;
    let (cell, q) = (p.floor(), p - p.floor());
    let own = seed ^ (cell.x as u32 * 97 + cell.y as u32 * 1013 + 1);
    let random = |k: i32| lattice(k, 5, own);
    let ink = |k: i32| {
        let i = (random(k) * (INKS.len() + 3) as f32) as usize;
        if i < INKS.len() { INKS[i] } else { colors[i - INKS.len()] }
    };
    let (ground, band) = (ink(1), ink(2));
    let paper = Rgb::new(0.76, 0.75, 0.72);
    let letters = if band.luminance() > 0.25 { Rgb::splat(0.03) } else { paper };
    let band_y = 0.52 + 0.26 * random(3);
    let band_h = 0.09 + 0.07 * random(4);
    let in_band = (q.y - band_y).abs() < band_h && random(5) < 0.8;
    // The name: a few upright strokes.
    let name =
        (q.y - band_y).abs() < 0.45 * band_h && (q.x - 0.5).abs() < 0.2 + 0.18 * random(6) && lattice((q.x * 34.0) as i32, 1, own) > 0.36;
    if name {
        return letters;
    }
    if in_band {
        return band;
    }
    let middle = Vec2::new(0.5 + 0.1 * (random(7) - 0.5), 0.27 + 0.06 * random(8));
    let d = (q - middle) / Vec2::new(0.9 + 0.8 * random(9), 1.0);
    let radius = 0.13 + 0.07 * random(10);
    let figure = match (random(11) * 3.0) as u32 {
        0 => d.length() < radius,
        1 => d.abs().max_element() < 0.8 * radius,
        _ => d.y > -radius && d.y + 2.2 * d.x.abs() < radius,
    };
    if figure {
        return ink(12).lerp(paper, 0.25 * (d.y / radius).clamp(0.0, 1.0));
    }
    let small = q.y < 0.1 && q.y > 0.04 && lattice((q.x * 60.0) as i32, (q.y * 90.0) as i32 / 2, own ^ 3) > 0.5 && (q.x - 0.5).abs() < 0.4;
    if small { letters } else { ground.lerp(paper, if random(13) < 0.4 { 0.75 * smoothstep(0.75, 0.2, q.y) } else { 0.0 }) }
}
