//! Goods on shelves: blocks of equal cartons, tins, bottles and bags, each block an object, and dense rows of books. Cartons and bags show
//! printed fronts; books share the picture of jackets.

use crate::builder::{Builder, Class};
use crate::materials::{Finish, PACKAGE_COLUMNS};
use crate::pieces::form::{all, turned};
use crate::pieces::{CONTACT, on};
use crate::shape::{Reshape, bevelled_box, padded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::{BOOK_COLUMNS, BOOK_ROWS};

/// A kind of goods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goods {
    /// Cartons.
    Cartons,
    /// Tins with printed labels.
    Tins,
    /// Bottles of plastic with a band.
    Bottles,
    /// Bags that are filled with air.
    Bags,
}

/// Air between goods beside and behind each other, metres.
const AIR: f32 = 0.004;

impl Goods {
    /// A random kind; cartons are most frequent.
    pub fn random(rng: &mut Rng) -> Self {
        [Self::Cartons, Self::Cartons, Self::Cartons, Self::Tins, Self::Bottles, Self::Bags][rng.below(6)]
    }

    /// Width, depth and height of one of them, at most `height` high.
    fn one(self, height: f32, rng: &mut Rng) -> Vec3 {
        let size = match self {
            Self::Cartons => Vec3::new(rng.range(0.06, 0.19), rng.range(0.05, 0.1), rng.range(0.09, 0.3)),
            Self::Tins => {
                let width = rng.range(0.066, 0.1);
                Vec3::new(width, width, rng.range(0.08, 0.14))
            }
            Self::Bottles => {
                let width = rng.range(0.06, 0.09);
                Vec3::new(width, width, rng.range(0.2, 0.31))
            }
            Self::Bags => Vec3::new(rng.range(0.13, 0.2), rng.range(0.06, 0.09), rng.range(0.18, 0.28)),
        };
        size * (height / size.z).min(1.0)
    }

    fn mesh(self, size: Vec3, cell: usize) -> Mesh {
        match self {
            Self::Cartons => printed(bevelled_box(size, 0.0012), size, cell),
            Self::Bags => {
                let bag = padded_box(Vec3::new(size.x, size.z, 0.35 * size.y), 0.1 * size.y, 0.3 * size.y);
                let bag = bag.turned(Vec3::X, std::f32::consts::FRAC_PI_2);
                // Its seams are drawn in: it stands on the lower one.
                let low = bag.bounds().min.z;
                printed(bag.moved(Vec3::new(0.0, 0.0, -0.5 * size.z - low)), size, cell)
            }
            Self::Tins => {
                let (r, h) = (0.5 * size.x, size.z);
                let mesh = turned(&[[0.0, 0.0], [r - 0.002, 0.0], [r, 0.003], [r, h - 0.003], [r - 0.002, h], [0.0, h - 0.002]], 20);
                printed(mesh.moved(Vec3::new(0.0, 0.0, -0.5 * h)), size, cell)
            }
            Self::Bottles => {
                let (r, h) = (0.5 * size.x, size.z);
                let outline = [
                    [0.0, 0.0],
                    [0.9 * r, 0.0],
                    [r, 0.04 * h],
                    [r, 0.58 * h],
                    [0.8 * r, 0.72 * h],
                    [0.4 * r, 0.84 * h],
                    [0.36 * r, 0.93 * h],
                    [0.42 * r, 0.935 * h],
                    [0.42 * r, h],
                    [0.0, h],
                ];
                turned(&outline, 18).moved(Vec3::new(0.0, 0.0, -0.5 * h))
            }
        }
    }

    fn finish(self, rng: &mut Rng) -> Finish {
        match self {
            Self::Bottles => [Finish::Plastic(rng.below(8) as u8), Finish::WhitePlastic][rng.below(2)],
            Self::Cartons | Self::Tins | Self::Bags => Finish::Packages,
        }
    }

    const fn labelled(self) -> (&'static str, Class) {
        match self {
            Self::Cartons => ("goods_carton", Class::Box),
            Self::Tins => ("goods_tin", Class::OtherProp),
            Self::Bottles => ("goods_bottle", Class::OtherProp),
            Self::Bags => ("goods_bag", Class::Bag),
        }
    }
}

/// A mesh whose front over the xz plane shows the package of this number; what is behind the front continues its edges.
fn printed(mut mesh: Mesh, size: Vec3, cell: usize) -> Mesh {
    let corner = Vec2::new((cell % PACKAGE_COLUMNS) as f32, (cell / PACKAGE_COLUMNS % PACKAGE_COLUMNS) as f32);
    for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
        // Seen from the front, +x is to the left.
        let q = Vec2::new(0.5 - p.x / size.x, 0.5 + p.z / size.z).clamp(Vec2::splat(0.01), Vec2::splat(0.99));
        *uv = (corner + q) / PACKAGE_COLUMNS as f32;
    }
    mesh
}

/// Fills a shelf whose front edge begins at `at` (right end as it is seen, smallest x) over a width, a depth and a height with blocks of
/// goods; their fronts face +y.
pub fn stock(b: &mut Builder, pose: DAffine3, at: Vec3, [width, depth, height]: [f32; 3], rng: &mut Rng) {
    let mut x = 0.01;
    while x < width - 0.06 {
        let goods = Goods::random(rng);
        let size = goods.one(0.92 * height, rng);
        let span = rng.range(0.16, 0.42).min(width - x);
        let across = ((span + AIR) / (size.x + AIR)) as usize;
        if across == 0 {
            x += 0.05;
            continue;
        }
        let behind = (((depth - 0.02) / (size.y + AIR)) as usize).clamp(1, 2);
        let stacked = if goods == Goods::Bottles || goods == Goods::Bags { 1 } else { ((0.95 * height / size.z) as usize).clamp(1, 3) };
        if rng.below(14) > 0 {
            block(b, on(pose, Vec3::new(at.x + x, at.y, at.z), 0.0), goods, size, [across, behind, stacked], rng);
        }
        x += across as f32 * (size.x + AIR) + 0.008;
    }
}

/// A block of equal goods whose front right lower corner is the origin.
fn block(b: &mut Builder, pose: DAffine3, goods: Goods, size: Vec3, [across, behind, stacked]: [usize; 3], rng: &mut Rng) {
    let (name, class) = goods.labelled();
    let object = b.object(name, class, pose);
    let one = goods.mesh(size, rng.below(PACKAGE_COLUMNS * PACKAGE_COLUMNS));
    let mut items = Vec::new();
    let set_back = rng.range(0.004, 0.03);
    for column in 0..across {
        // Some were taken from the front.
        let taken = usize::from(behind > 1 && rng.below(7) == 0);
        for row in taken..behind {
            let high = if row == behind - 1 && rng.below(4) == 0 { stacked.saturating_sub(1).max(1) } else { stacked };
            for level in 0..high {
                let place = Vec3::new(
                    (column as f32 + 0.5) * (size.x + AIR),
                    -set_back - (row as f32 + 0.5) * (size.y + AIR),
                    CONTACT + (size.z + CONTACT) * level as f32 + 0.5 * size.z,
                );
                let jitter = Vec3::new(0.0, -0.003 * rng.next_f32(), 0.0);
                items.push(one.clone().moved(place + jitter));
            }
        }
    }
    b.part(&object, "goods", all(items), goods.finish(rng));
}

/// A dense row of books from `at` (smallest x, front edge) over `width`, with backs that face +y; one part for all.
pub fn shelved_books(b: &mut Builder, pose: DAffine3, at: Vec3, width: f32, height: f32, rng: &mut Rng) {
    let object = b.object("books", Class::Books, on(pose, Vec3::new(0.0, 0.0, at.z + CONTACT), 0.0));
    let (mut x, mut row) = (0.004, Vec::new());
    let usual = rng.range(0.72, 0.86) * height;
    while x < width - 0.012 {
        let thick = rng.range(0.012, 0.045).min(width - x);
        let (high, deep) = ((usual * rng.range(0.82, 1.12)).min(0.95 * height), rng.range(0.13, 0.18));
        let cell = rng.below(BOOK_COLUMNS * BOOK_ROWS);
        let size = Vec3::new(thick - 0.0008, deep, high);
        let middle = Vec3::new(at.x + x + 0.5 * thick, at.y - rng.range(0.008, 0.03) - 0.5 * deep, 0.5 * high);
        row.push(jacketed(bevelled_box(size, 0.001), size, cell).moved(middle));
        x += thick;
    }
    b.part(&object, "row", all(row), Finish::BookJackets);
}

/// A book as one box: the spine in front, covers at the sides, pages above.
fn jacketed(mut mesh: Mesh, size: Vec3, cell: usize) -> Mesh {
    let corner = Vec2::new((cell % BOOK_COLUMNS) as f32, (cell / BOOK_COLUMNS % BOOK_ROWS) as f32);
    let half = 0.5 * size;
    for ((uv, p), n) in mesh.uvs.iter_mut().zip(&mesh.positions).zip(&mesh.normals) {
        let v = 0.01 + 0.98 * (0.5 + p.z / size.z);
        let q = if n.z > 0.8 {
            Vec2::new(0.83 + 0.14 * (0.5 + p.x / size.x), 0.02 + 0.96 * (0.5 + p.y / size.y))
        } else if p.y > half.y - 0.0015 {
            Vec2::new(0.02 + 0.56 * (0.5 - p.x / size.x), v)
        } else {
            Vec2::new(0.64 + 0.12 * (0.5 - p.y / size.y), v)
        };
        *uv = (corner + q) / Vec2::new(BOOK_COLUMNS as f32, BOOK_ROWS as f32);
    }
    mesh
}
