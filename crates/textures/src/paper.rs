//! Cardboard, leaves of plants, and what screens show.

use super::noise::{fbm, lattice, noise, smoothstep};
use super::{Grain, PaintingStyle, Skin, paint, painting, skin};
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// Corrugated board as a factor, 512 pixels square over 0.3 m. Tiles.
pub fn cardboard(name: &str, seed: u32) -> Skin {
    skin(name, [512, 512], |uv| {
        let flute = (uv.y * 42.0 * std::f32::consts::TAU).sin();
        let fibre = noise(Vec2::new(uv.x * 60.0, uv.y * 240.0), [60, 240], seed);
        let tone = 0.93 + 0.012 * flute + 0.04 * fibre + 0.03 * fbm(uv, [4, 4], 3, seed ^ 3);
        Grain { color: Rgb::splat(tone), alpha: 0.6, height: 0.5 + 0.3 * flute + 0.05 * fibre }
    })
}

/// A leaf over the unit square, its midrib along u in the middle: 128 × 128 pixels.
pub fn leaf(name: &str, blade: Rgb, vein: Rgb, seed: u32) -> Skin {
    skin(name, [128, 128], |uv| {
        let away = (uv.y - 0.5).abs();
        let rib = smoothstep(0.03, 0.008, away * (1.0 + 0.6 * uv.x));
        let side = ((uv.x * 9.0 - away * 5.0).fract() - 0.5).abs();
        let veins = 0.5 * smoothstep(0.42, 0.5, side) * smoothstep(0.5, 0.1, away);
        let mottled = 1.0 + 0.16 * fbm(uv, [6, 6], 3, seed) + 0.10 * (0.5 - away);
        let show = (rib + veins).min(1.0);
        Grain { color: blade.lerp(vein, 0.75 * show) * mottled, alpha: 0.28 + 0.12 * show, height: 0.6 - 0.4 * show }
    })
}

/// Contents of a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Display {
    /// A landscape, as on an idle television.
    Landscape,
    /// A desktop with windows of text.
    Desktop,
    /// Code or text on a dark ground.
    Text,
    /// Cards of a home page, as on a telephone.
    Cards,
}

impl Display {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Landscape, Self::Desktop, Self::Text, Self::Cards];
}

/// Picture of a screen over the unit square, 512 × 288 pixels, as radiance relative to its white.
pub fn display(name: &str, shown: Display, colors: &[Rgb; 5], seed: u32) -> Image {
    if shown == Display::Landscape {
        return painting(name, PaintingStyle::Hills, colors, seed);
    }
    let (ground, window) = match shown {
        Display::Text => (Rgb::new(0.012, 0.014, 0.02), Rgb::new(0.018, 0.02, 0.03)),
        _ => (colors[3].lerp(colors[4], 0.5), Rgb::splat(0.86)),
    };
    paint(name, 512, 288, |uv| {
        let p = Vec2::new(uv.x, 1.0 - uv.y);
        if shown == Display::Cards {
            return cards(p, colors, window, seed);
        }
        let panes: &[[f32; 4]] = if shown == Display::Text {
            &[[0.0, 0.0, 0.18, 1.0], [0.19, 0.03, 1.0, 1.0]]
        } else {
            &[[0.06, 0.10, 0.58, 0.86], [0.50, 0.22, 0.94, 0.92]]
        };
        let inside = |b: &&[f32; 4]| p.x > b[0] && p.x < b[2] && p.y > b[1] && p.y < b[3];
        let Some(pane) = panes.iter().rev().find(inside) else {
            return if p.y > 0.955 { Rgb::splat(0.05) } else { ground * (0.7 + 0.6 * (1.0 - p.y)) };
        };
        let q = Vec2::new((p.x - pane[0]) / (pane[2] - pane[0]), (p.y - pane[1]) / (pane[3] - pane[1]));
        text(q, window, shown == Display::Text, colors, seed ^ (pane[0] * 64.0) as u32)
    })
}

/// Lines of words, as bars.
fn text(q: Vec2, page: Rgb, dark: bool, colors: &[Rgb; 5], seed: u32) -> Rgb {
    if q.y < 0.06 && !dark {
        return Rgb::splat(0.62);
    }
    let row = (q.y * 34.0).floor() as i32;
    let indent = 0.05 + if dark { 0.05 * (4.0 * lattice(row / 3, 3, seed)).floor() } else { 0.0 };
    let end = indent + 0.25 + 0.6 * lattice(row, 5, seed);
    let word = lattice((q.x * 46.0) as i32, row, seed);
    let inked = (q.y * 34.0).fract() > 0.45 && q.x > indent && q.x < end.min(0.95) && word > 0.22 && lattice(row, 7, seed) > 0.15;
    let ink = if dark { colors[1 + (word * 17.0) as usize % 3] * 0.8 } else { Rgb::splat(0.09) };
    if inked { ink } else { page }
}

/// Rows of pictures with captions.
fn cards(p: Vec2, colors: &[Rgb; 5], page: Rgb, seed: u32) -> Rgb {
    let q = p * Vec2::new(3.0, 2.0);
    let f = q - q.floor();
    let key = q.x.floor() as i32 + 3 * q.y.floor() as i32;
    if f.x < 0.07 || f.x > 0.93 || f.y < 0.08 {
        return page;
    }
    if f.y < 0.66 {
        let tone = colors[1 + (lattice(key, 1, seed) * 4.0) as usize % 4];
        return tone.lerp(Rgb::splat(0.8), 0.3 * fbm(f * 0.5, [4, 4], 3, seed ^ key as u32).abs());
    }
    if f.y < 0.90 && (f.y * 14.0).fract() > 0.5 && f.x < 0.4 + 0.5 * lattice(key, (f.y * 14.0) as i32, seed) {
        Rgb::splat(0.2)
    } else {
        page
    }
}
