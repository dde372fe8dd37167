//! Book jackets: one picture that all books share.

use super::noise::lattice;
use super::paint;
use enfilade_math::{Rgb, Vec2};
use enfilade_scene::Image;

/// Jackets beside each other.
pub const BOOK_COLUMNS: usize = 16;
/// Rows of jackets.
pub const BOOK_ROWS: usize = 4;

/// The picture: cell (column, row) has the spine on the left 60 % of its width, the plain cover on the next 20 % and the pages on
/// the last.
pub fn book_spines(name: &str, colors: &[Rgb], seed: u32) -> Image {
    paint(name, 1024, 1024, |uv| {
        let p = Vec2::new(uv.x * BOOK_COLUMNS as f32, uv.y * BOOK_ROWS as f32);
        let (cell, q) = (p.floor(), p - p.floor());
        let own = seed ^ (cell.x as u32 * 31 + cell.y as u32 * 1009 + 1);
        let random = |k: i32| lattice(k, 3, own);
        let base = colors[(random(0) * colors.len() as f32) as usize % colors.len()] * (0.72 + 0.32 * random(1));
        if q.x > 0.8 {
            let leaf = lattice((q.x * 90.0) as i32, (q.y * 3.0) as i32, own);
            return Rgb::new(0.72, 0.66, 0.54) * (0.82 + 0.2 * leaf);
        }
        if q.x > 0.6 {
            return base;
        }
        let ink = if base.luminance() > 0.22 { Rgb::new(0.05, 0.05, 0.06) } else { Rgb::new(0.78, 0.70, 0.52) };
        let s = Vec2::new(q.x / 0.6, q.y);
        if spine_is_inked(s, &random) {
            base.lerp(ink, 0.88)
        } else {
            base * (0.97 + 0.06 * lattice((s.x * 40.0) as i32, (s.y * 300.0) as i32, own))
        }
    })
}

/// Title, author's name, bands and the publisher's mark of a spine over the unit square.
fn spine_is_inked(s: Vec2, random: &dyn Fn(i32) -> f32) -> bool {
    let inside = s.x > 0.2 && s.x < 0.8;
    // Lettering runs along the spine; at this size words are broken bars.
    let words = |from: f32, to: f32, low: f32, high: f32, key: i32| {
        s.y > from && s.y < to && s.x > low && s.x < high && lattice((s.y * 120.0) as i32, key, (random(key) * 1e6) as u32) > 0.24
    };
    let start = 0.42 + 0.12 * random(4);
    let title = words(start, start + 0.2 + 0.2 * random(5), 0.36, 0.68, 6);
    let author = words(0.14, 0.24 + 0.1 * random(7), 0.42, 0.6, 8);
    let band = random(9) < 0.35 && inside && [0.06, 0.92].iter().any(|y| (s.y - y).abs() < 0.006);
    let mark = random(10) < 0.6 && (s - Vec2::new(0.5, 0.06)).length() < 0.022;
    title || author || band || mark
}
