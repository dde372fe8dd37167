//! A bookcase of one to three columns and five or six rows of compartments, of wood (class bookshelf), and the rows and piles of books in
//! it (class books, each row an object, each book a part with a jacket of its own), which other furniture uses too. 68 to 85 % of the
//! compartments hold a row of books, the others a pile and an ornament.

use super::{Bowl, CONTACT, Candles, Furniture, Plant, Vase, board, grained, on};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::Reshape;
use crate::texture::{BOOK_COLUMNS, BOOK_ROWS};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A bookcase: columns of compartments with books and a few other things.
#[derive(Clone, Copy, Debug)]
pub struct Bookshelf {
    /// Columns of compartments.
    pub columns: usize,
    /// Compartments above each other.
    pub rows: usize,
    /// Share of the compartments that hold books, on `[0,1]`.
    pub books: f32,
}

/// Depth of the case, metres: books are 13 to 19 cm deep.
const DEPTH: f32 = 0.30;
/// Thickness of uprights and boards, metres.
const BOARD: f32 = 0.022;
/// From one upright to the next, left face to left face, metres: a board of this length still carries books.
const COLUMN: f32 = 0.62;
/// From one board to the next, metres: 31 cm are free, and books are up to 27.5 cm high.
const ROW: f32 = 0.335;
/// Height of the plinth below the lowest board, metres.
const PLINTH: f32 = 0.06;
/// How far boards reach into the uprights at each end, metres: no light comes through the joint.
const LAP: f32 = 0.0002;

impl Bookshelf {
    fn case(&self, b: &mut Builder, shelf: &crate::builder::Object, rng: &mut Rng) {
        let wood = Finish::Wood;
        let size = self.size();
        let (half, back, front) = (0.5 * size.x, -0.5 * DEPTH, 0.5 * DEPTH);
        for i in 0..=self.columns {
            let x = i as f32 * COLUMN - half;
            let mesh = board([x, back, 0.0], [x + BOARD, front, size.z], 0.0015);
            b.part(shelf, &format!("upright_{}", i + 1), grained(mesh, rng), wood);
        }
        for column in 0..self.columns {
            let x = column as f32 * COLUMN - half + BOARD;
            for row in 0..=self.rows {
                let z = PLINTH + row as f32 * ROW - if row == 0 { 0.0 } else { BOARD };
                let mesh = board([x - LAP, back + 0.011, z], [x + COLUMN - BOARD + LAP, front - 0.003, z + BOARD], 0.0015);
                b.part(shelf, &format!("board_{}_{}", column + 1, row + 1), grained(mesh, rng), wood);
            }
            let plinth = board([x - LAP, front - 0.03, 0.0], [x + COLUMN - BOARD + LAP, front - 0.012, PLINTH - 0.0002], 0.001);
            b.part(shelf, &format!("plinth_{}", column + 1), grained(plinth, rng), wood);
            let rear = board([x - LAP, back + 0.002, 0.01], [x + COLUMN - BOARD + LAP, back + 0.010, size.z - 0.002], 0.0005);
            b.part(shelf, &format!("rear_{}", column + 1), grained(rear, rng), wood);
        }
    }

    /// Fills one compartment whose floor's left front corner is at `at` (y at the front edge).
    fn fill(&self, b: &mut Builder, pose: DAffine3, at: Vec3, rng: &mut Rng) {
        let width = COLUMN - BOARD;
        let kind = rng.next_f32();
        if kind < self.books {
            // Books fill most of the width; something small stands in the rest now and then.
            let share = if rng.below(3) == 0 { rng.range(0.55, 0.75) } else { rng.range(0.86, 0.99) };
            row_of_books(b, pose, at, share * (width - 0.01), share < 0.95, rng);
            if share < 0.76 {
                let place = Vec3::new(at.x + 0.5 * (1.0 + share) * width, at.y - 0.13, at.z);
                ornament(b, on(pose, place, rng.range(-0.6, 0.6)), 0.5 * (1.0 - share) * width, rng);
            }
        } else {
            let from = if rng.below(2) == 0 { 0.28 } else { 0.72 };
            pile_of_books(b, on(pose, Vec3::new(at.x + from * width, at.y - 0.14, at.z), rng.range(-0.08, 0.08)), 3 + rng.below(3), rng);
            let place = Vec3::new(at.x + (1.0 - from) * width, at.y - 0.14, at.z);
            ornament(b, on(pose, place, rng.range(-0.6, 0.6)), 0.11, rng);
        }
    }
}

/// Something to look at that fits a circle of `radius`.
fn ornament(b: &mut Builder, pose: DAffine3, radius: f32, rng: &mut Rng) {
    match rng.below(4) {
        0 => Vase { height: rng.range(0.16, 0.25), belly: radius.min(0.075), branches: 0 }.build(b, pose, rng),
        1 => Bowl { radius: radius.min(0.1) }.build(b, pose, rng),
        2 => Plant::small(rng.range(0.09, 0.11), (0.5 * radius).min(0.045)).build(b, pose, rng),
        _ => Candles { count: 1 + rng.below(2) }.build(b, pose, rng),
    }
}

/// One book in its own space: spine at y = 0 facing +y, standing on z = 0, from x = 0 to its thickness. `cell` picks its jacket from the
/// picture of all jackets.
fn book(thickness: f32, depth: f32, height: f32, cell: usize) -> Mesh {
    /// Thickness of a cover, metres.
    const COVER: f32 = 0.0022;
    let inset = 0.003;
    let boxed = |min: [f32; 3], max: [f32; 3]| board(min, max, 0.0007);
    let spine = boxed([0.0, -0.004, 0.0], [thickness, 0.0, height]);
    let left = boxed([0.0, -depth, 0.0], [COVER, -0.0041, height]);
    let right = boxed([thickness - COVER, -depth, 0.0], [thickness, -0.0041, height]);
    let pages = boxed([COVER + 0.0001, -depth + inset, inset], [thickness - COVER - 0.0001, -0.0042, height - inset]);
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

impl Furniture for Bookshelf {
    fn random(rng: &mut Rng) -> Self {
        Self { columns: 1 + rng.below(3), rows: 5 + rng.below(2), books: rng.range(0.68, 0.85) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.columns as f32 * COLUMN + BOARD, DEPTH, PLINTH + self.rows as f32 * ROW)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let shelf = b.object("bookshelf", Class::Bookshelf, pose);
        self.case(b, &shelf, rng);
        let half = 0.5 * self.size().x;
        for column in 0..self.columns {
            for row in 0..self.rows {
                let z = PLINTH + row as f32 * ROW + if row == 0 { BOARD } else { 0.0 };
                let at = Vec3::new(column as f32 * COLUMN - half + BOARD, 0.5 * DEPTH - 0.01, z);
                self.fill(b, pose, at, rng);
            }
        }
    }
}
