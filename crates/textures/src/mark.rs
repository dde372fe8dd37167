//! Marks of use: what hands, shoes, cups and dust leave on surfaces, as a colour with the share of the surface that it covers.

use super::encode;
use super::noise::{Field, cells, fbm, noise, smoothstep};
use super::{Skin, of_pixels};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::{Image, Pixels};

/// A kind of mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
    /// The dark streaks of shoes and vacuum cleaners, along u.
    Scuffs,
    /// What hands leave around switches and handles.
    Grime,
    /// Paint that was put on again in strokes, and shines or covers otherwise.
    Patch,
    /// What dried after something was spilt: a pale middle in a darker border.
    Spill,
    /// Rings of cups.
    Rings,
    /// Fine scratches in all directions.
    Scratches,
    /// Prints of fingers.
    Fingers,
    /// Dust, thicker towards the border.
    Dust,
}

impl Mark {
    /// All kinds.
    pub const ALL: [Self; 8] =
        [Self::Scuffs, Self::Grime, Self::Patch, Self::Spill, Self::Rings, Self::Scratches, Self::Fingers, Self::Dust];

    /// Share of the surface that is covered at `uv` on the unit square, 0 to 1; 0 at its border.
    pub fn cover(self, uv: Vec2, seed: u32) -> f32 {
        let p = 2.0 * uv - 1.0;
        let uneven = fbm(uv, [5, 5], 4, seed);
        let round = 1.0 - smoothstep(0.35, 0.98, p.length() + 0.28 * uneven);
        let border = (1.0 - p.x.abs()).min(1.0 - p.y.abs()).clamp(0.0, 1.0);
        let inside = smoothstep(0.0, 0.12, border);
        match self {
            Self::Scuffs => {
                let streaks = noise(Vec2::new(uv.x * 5.0, uv.y * 26.0 + 2.0 * uneven), [5, 26], seed ^ 3);
                let gaps = fbm(uv, [9, 4], 3, seed ^ 5);
                smoothstep(0.34, 0.75, streaks) * smoothstep(-0.25, 0.25, gaps) * (1.0 - smoothstep(0.5, 1.0, p.length())) * inside
            }
            Self::Grime => round * inside * (0.55 + 0.45 * fbm(uv, [11, 11], 3, seed ^ 7)).clamp(0.0, 1.0),
            Self::Patch => {
                let edge = border + 0.10 * fbm(uv, [14, 14], 3, seed ^ 9);
                let strokes = 0.8 + 0.2 * noise(Vec2::new(uv.x * 3.0, uv.y * 40.0), [3, 40], seed ^ 11);
                smoothstep(0.06, 0.4, edge) * strokes * inside
            }
            Self::Spill => {
                let distance = p.length() * (1.0 + 0.35 * uneven);
                let rim = (1.0 - (distance - 0.68).abs() / 0.07).clamp(0.0, 1.0);
                (0.35 * (1.0 - smoothstep(0.6, 0.72, distance)) + 0.65 * rim) * inside
            }
            Self::Rings => {
                let ring = |center: Vec2, radius: f32| {
                    let distance = (p - center).length() + 0.012 * uneven;
                    let gap = smoothstep(-0.4, 0.1, noise((p - center).normalize_or(Vec2::X) * 1.7 + 4.0, [9, 9], seed ^ 13));
                    (1.0 - (distance - radius).abs() / 0.035).clamp(0.0, 1.0) * (0.25 + 0.75 * gap)
                };
                ring(Vec2::new(-0.3, -0.22), 0.5).max(ring(Vec2::new(0.34, 0.3), 0.48)) * inside
            }
            Self::Scratches => {
                let scratch = |k: u32| {
                    let way = Vec2::from_angle(2.39 * (k as f32 + (seed % 97) as f32));
                    let q = Vec2::new(p.dot(way), p.dot(way.perp()) - 0.55 * ((k as f32 * 1.7 + seed as f32).sin()));
                    let bent = q.y + 0.06 * (2.3 * q.x + k as f32).sin();
                    (1.0 - bent.abs() / 0.008).clamp(0.0, 1.0) * (1.0 - smoothstep(0.3, 0.7, q.x.abs() + 0.2 * uneven))
                };
                (0..9).map(scratch).fold(0.0f32, f32::max) * inside
            }
            Self::Fingers => {
                let near = cells(uv * 5.0, [5, 5], seed ^ 17);
                let tip = 1.0 - smoothstep(0.16, 0.3, near.first);
                let ridges = 0.6 + 0.4 * (near.first * 130.0).sin();
                tip * ridges * smoothstep(-0.1, 0.25, uneven) * inside
            }
            Self::Dust => {
                let edge = 1.0 - smoothstep(0.05, 0.6, border + 0.2 * uneven);
                (0.35 + 0.65 * edge) * (0.75 + 0.25 * fbm(uv, [30, 30], 3, seed ^ 19)) * smoothstep(0.0, 0.04, border)
            }
        }
        .clamp(0.0, 1.0)
    }
}

/// A picture over the unit square, of 256 × 256 pixels where the mark has fine lines, else of 128 × 128: `color`, and how much of the surface
/// it covers as opacity.
pub fn mark(name: &str, kind: Mark, color: Rgb, seed: u32) -> Image {
    let side = if matches!(kind, Mark::Fingers | Mark::Scratches | Mark::Rings) { 256 } else { 128 };
    let color = [color.r, color.g, color.b].map(encode);
    let texels = of_pixels([side; 2], |uv| {
        let [r, g, b] = color;
        [r, g, b, (kind.cover(uv, seed) * 255.0 + 0.5) as u8]
    });
    Image { name: name.into(), width: side, height: side, pixels: Pixels::Rgba8 { srgb: true, texels } }
}

/// A varnished surface that has been used: where hands and feet go it is rougher by up to `wear` times its roughness, in patches and fine
/// scratches. Colours and heights stay.
#[must_use]
pub fn worn(mut skin: Skin, wear: f32, seed: u32) -> Skin {
    const SIDE: usize = 128;
    let Pixels::Rgba8 { texels, .. } = &mut skin.color.pixels else { return skin };
    let patches = Field::new(SIDE, |uv| smoothstep(-0.12, 0.42, fbm(uv, [3, 3], 3, seed ^ 23)));
    let scratches = Field::new(2 * SIDE, |uv| smoothstep(0.5, 0.9, noise(uv * Vec2::new(9.0, 48.0), [9, 48], seed ^ 29)));
    let (width, height) = (skin.color.width as f32, skin.color.height as f32);
    for (k, texel) in texels.iter_mut().enumerate() {
        let (x, y) = (k as u32 % skin.color.width, k as u32 / skin.color.width);
        let uv = Vec2::new((x as f32 + 0.5) / width, 1.0 - (y as f32 + 0.5) / height);
        let more = 1.0 + wear * (0.75 * patches.at(uv) + 0.25 * scratches.at(uv));
        texel[3] = (f32::from(texel[3]) * more).round().min(255.0) as u8;
    }
    skin
}

/// The roughness of lacquer that has been used, as a share of twice that of new lacquer, over the unit square; see [`worn`].
pub fn worn_gloss(name: &str, wear: f32, seed: u32) -> Image {
    const SIDE: u32 = 256;
    let even = Image {
        name: name.into(),
        width: SIDE,
        height: SIDE,
        pixels: Pixels::Rgba8 { srgb: true, texels: vec![[255, 255, 255, 128]; (SIDE * SIDE) as usize] },
    };
    worn(Skin { height: even.clone(), color: even }, wear, seed).color
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wear_makes_varnish_rougher_here_and_there_and_nothing_else() {
        let Pixels::Rgba8 { texels, .. } = worn_gloss("gloss", 0.8, 5).pixels else { panic!("bytes") };
        let rough: Vec<u8> = texels.iter().map(|texel| texel[3]).collect();
        let (least, most) = (rough.iter().min().unwrap(), rough.iter().max().unwrap());
        assert!((128..132).contains(least) && (190..=231).contains(most), "{least} {most}");
        assert!(texels.iter().all(|texel| texel[..3] == [255; 3]));
        let Pixels::Rgba8 { texels, .. } = worn_gloss("gloss", 0.0, 5).pixels else { panic!("bytes") };
        assert!(texels.iter().all(|texel| texel[3] == 128));
    }

    #[test]
    fn marks_cover_some_of_their_square_and_end_before_its_border() {
        for kind in Mark::ALL {
            for seed in [1, 7, 40] {
                let at = |i: u32, j: u32| kind.cover(Vec2::new(i as f32 / 64.0, j as f32 / 64.0), seed);
                let whole = (0..=64).flat_map(|j| (0..=64).map(move |i| (i, j)));
                let covered = whole.map(|(i, j)| at(i, j)).sum::<f32>() / (65.0 * 65.0);
                assert!((0.002..0.9).contains(&covered), "{kind:?}, seed {seed}: {covered}");
                let border = (0..=64).flat_map(|k| [at(k, 0), at(k, 64), at(0, k), at(64, k)]).fold(0.0, f32::max);
                assert!(border < 0.12, "{kind:?}, seed {seed}: {border}");
            }
        }
    }
}
