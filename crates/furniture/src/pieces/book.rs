//! Books: one with its jacket, rows of them standing and piles of them lying. Each row or pile is an object (class books), each book a
//! part with a jacket of its own.
//!
//! All share one picture of jackets, [`BOOK_COLUMNS`] by [`BOOK_ROWS`] cells; the texture coordinates of a book choose its cell.

use super::{CONTACT, board};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::{BOOK_COLUMNS, BOOK_ROWS};

/// One book in its own space: spine at y = 0 facing +y, standing on z = 0, from x = 0 to its thickness. `cell` picks its jacket.
fn book(thickness: f32, depth: f32, height: f32, cell: usize) -> Mesh {
    /// Thickness of a cover, metres.
    const COVER: f32 = 0.0022;
    /// How far the covers protrude around the pages, metres.
    const INSET: f32 = 0.003;
    let boxed = |min: [f32; 3], max: [f32; 3]| board(min, max, 0.0007);
    let spine = boxed([0.0, -0.004, 0.0], [thickness, 0.0, height]);
    let left = boxed([0.0, -depth, 0.0], [COVER, -0.0041, height]);
    let right = boxed([thickness - COVER, -depth, 0.0], [thickness, -0.0041, height]);
    let pages = boxed([COVER + 0.0001, -depth + INSET, INSET], [thickness - COVER - 0.0001, -0.0042, height - INSET]);
    let (column, row) = ((cell % BOOK_COLUMNS) as f32, (cell / BOOK_COLUMNS % BOOK_ROWS) as f32);
    let to_cell = |u: f32, v: f32| Vec2::new((column + u) / BOOK_COLUMNS as f32, (row + v) / BOOK_ROWS as f32);
    let picture = |mut mesh: Mesh, f: &dyn Fn(Vec3) -> Vec2| {
        for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
            let q = f(*p);
            *uv = to_cell(q.x, q.y);
        }
        mesh
    };
    // The spine's picture reads from the front, where +x of the book is to the left.
    let lettering = |p: Vec3| Vec2::new(0.02 + 0.56 * (1.0 - p.x / thickness), 0.01 + 0.98 * p.z / height);
    let plain = |p: Vec3| Vec2::new(0.64 + 0.12 * (-p.y / depth).clamp(0.0, 1.0), 0.02 + 0.96 * p.z / height);
    let paper = |p: Vec3| Vec2::new(0.83 + 0.14 * p.x / thickness, 0.02 + 0.96 * (-p.y / depth).clamp(0.0, 1.0));
    picture(spine, &lettering).with(picture(left, &plain)).with(picture(right, &plain)).with(picture(pages, &paper))
}

fn any_cell(rng: &mut Rng) -> usize {
    rng.below(BOOK_COLUMNS * BOOK_ROWS)
}

/// Standing books from `at` (left front corner) over at most `width`; the last ones may lean. Returns the width that they fill.
pub fn row_of_books(b: &mut Builder, pose: DAffine3, at: Vec3, width: f32, leans: bool, rng: &mut Rng) -> f32 {
    let books = b.object("books", Class::Books, pose);
    let material = Finish::BookJackets;
    let mut x = 0.004;
    let mut count = 0;
    let mut series: Option<(f32, f32, usize, usize)> = None;
    loop {
        // Now and then a few volumes of a series stand together.
        let (height, depth, cell) = match series {
            Some((height, depth, cell, left)) if left > 0 => {
                series = Some((height, depth, cell, left - 1));
                (height, depth, cell)
            }
            _ => {
                let fresh = (rng.range(0.185, 0.275), rng.range(0.13, 0.19), any_cell(rng));
                series = (rng.below(6) == 0).then(|| (fresh.0, fresh.1, fresh.2, 1 + rng.below(3)));
                fresh
            }
        };
        let thickness = rng.range(0.014, 0.042);
        let last = x + thickness + 0.05 > width;
        let lean = if last && leans { rng.range(0.14, 0.22) } else { rng.range(0.0, 0.006) };
        let room = thickness + height * lean.sin();
        if x + room > width {
            break;
        }
        let setback = rng.range(0.012, 0.04);
        let place = Vec3::new(at.x + x + height * lean.sin(), at.y - setback, at.z + CONTACT);
        // Leaning to the left, against the others, about its lower left edge.
        let local = DAffine3::from_translation(place.as_dvec3()) * DAffine3::from_rotation_y(-f64::from(lean));
        count += 1;
        b.part_at(&books, &format!("book_{count:02}"), book(thickness, depth, height, cell), local, material);
        x += room + 0.0008;
        if last {
            break;
        }
    }
    x
}

/// Books lying on each other, spines to the front.
pub fn pile_of_books(b: &mut Builder, pose: DAffine3, count: usize, rng: &mut Rng) {
    let books = b.object("books", Class::Books, pose);
    let mut z = CONTACT;
    for i in 0..count {
        let shrink = 1.0 - 0.06 * i as f32;
        let (thickness, depth, height) = (rng.range(0.016, 0.034), rng.range(0.155, 0.18) * shrink, rng.range(0.21, 0.25) * shrink);
        // Laid on its side: the height of the book runs along x.
        let lying = book(thickness, depth, height, any_cell(rng))
            .moved(Vec3::new(0.0, 0.5 * depth, -0.5 * height))
            .turned(Vec3::Y, -std::f32::consts::FRAC_PI_2)
            .moved(Vec3::new(0.0, 0.0, z));
        b.part(&books, &format!("book_{:02}", i + 1), lying.turned(Vec3::Z, rng.range(-0.14, 0.14)), Finish::BookJackets);
        z += thickness + CONTACT;
    }
}
