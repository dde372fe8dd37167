//! Books and magazines that lie about: a row of books 20 to 42 cm long between bookends of stone or brass (class books; the ends are other
//! prop), a book that lies open or face down like a tent, and a rack on the floor, of wood or wire, with three to seven magazines upright
//! in it (class other furniture; the magazines are paper).

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::book::row_of_books;
use crate::pieces::form::{all, cut_out, rod};
use crate::pieces::{CONTACT, Furniture, Magazines, board, grained, on};
use crate::shape::{Reshape, bevelled_box, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::{BOOK_COLUMNS, BOOK_ROWS};

/// Books that stand between two bookends.
#[derive(Clone, Copy, Debug)]
pub struct BookRow {
    /// Width between the bookends.
    pub width: f32,
    /// Bookends are blocks of stone instead of quarters of a brass disk.
    pub stone: bool,
}

impl Furniture for BookRow {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.2, 0.42), stone: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width + 0.21, 0.27, 0.28)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let half = 0.5 * self.width;
        let filled = row_of_books(b, pose, Vec3::new(-half, 0.125, 0.0), self.width, false, rng);
        for (s, x) in [(-1.0f32, 0.002 - half), (1.0, filled - half + 0.001)] {
            let end = b.object("bookend", Class::OtherProp, on(pose, Vec3::new(x, 0.0, CONTACT), 0.0));
            if self.stone {
                let block = bevelled_box(Vec3::new(0.06, 0.1, 0.13), 0.003).moved(Vec3::new(s * 0.031, 0.0, 0.065));
                b.part(&end, "block", block, Finish::MarbleTop);
            } else {
                // A quarter of a disk that stands on one straight edge and leans on the books with the other.
                let arc = (0..=16).map(|k| Vec2::from_angle(std::f32::consts::FRAC_PI_2 * k as f32 / 16.0) * 0.1);
                let outline: Vec<Vec2> = [Vec2::ZERO].into_iter().chain(arc).collect();
                let quarter = cut_out(&outline, 0.07, 0.002).turned(Vec3::X, std::f32::consts::FRAC_PI_2).moved(Vec3::Y * 0.035);
                let turn = if s < 0.0 { std::f32::consts::PI } else { 0.0 };
                b.part(&end, "quarter", quarter.turned(Vec3::Z, turn), Finish::Brass);
            }
        }
    }
}

/// A book that lies open, face up, or face down like a tent.
#[derive(Clone, Copy, Debug)]
pub struct OpenBook {
    /// Width and height of a page.
    pub page: Vec2,
    /// Lies face down, like a tent.
    pub down: bool,
}

impl OpenBook {
    /// The two halves of the open pages as one body; the fold runs along y.
    fn pages(&self) -> Mesh {
        let (w, h) = (self.page.x, self.page.y);
        let rise = |t: f32| 0.004 + 0.016 * (t * 9.0).min(1.0).sqrt() * (1.0 - 0.75 * t);
        // The section runs over the upper side from one edge to the other, then back below.
        let (n, around) = (24, 2 * 25);
        let point = |i: usize, j: usize| {
            let i = i % around;
            let upper = i <= n;
            let k = if upper { n - i } else { i - n - 1 };
            let x = w * (2.0 * k as f32 / n as f32 - 1.0);
            let y = h * ((j.clamp(1, 3) - 1) as f32 / 2.0 - 0.5);
            if j == 0 || j == 4 {
                return Vec3::new(0.0, y, 0.003);
            }
            Vec3::new(x, y, if upper { rise((x / w).abs()) + 0.002 } else { 0.0021 })
        };
        grid(around, 4, |i, j| point(i, 4 - j), |i, j| Vec2::new(i as f32 * 0.01, j as f32 * 0.07)).smoothed(40.0)
    }
}

impl Furniture for OpenBook {
    fn random(rng: &mut Rng) -> Self {
        Self { page: Vec2::new(rng.range(0.12, 0.17), rng.range(0.18, 0.24)), down: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.page.x + 0.008, self.page.y + 0.008, if self.down { 0.064 } else { 0.024 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let book = b.object("open_book", Class::Books, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let jacket = |mut mesh: Mesh, cell: usize| {
            let corner = Vec2::new((cell % BOOK_COLUMNS) as f32 + 0.64, (cell / BOOK_COLUMNS % BOOK_ROWS) as f32 + 0.1);
            mesh.uvs.iter_mut().zip(&mesh.positions).for_each(|(uv, p)| {
                *uv = (corner + Vec2::new(0.4, 2.0) * Vec2::new(p.x.abs(), 0.2 + p.y)) / Vec2::new(BOOK_COLUMNS as f32, BOOK_ROWS as f32);
            });
            mesh
        };
        let cell = rng.below(BOOK_COLUMNS * BOOK_ROWS);
        if self.down {
            // A roof of two covers with the pages below them.
            let slope = 0.32_f32;
            let halves = |t: f32, z: f32, inset: f32| {
                all([-1.0f32, 1.0].map(|s| {
                    let half = bevelled_box(Vec3::new(self.page.x - inset, self.page.y - inset, t), 0.0007).moved(Vec3::new(
                        s * 0.5 * (self.page.x - inset),
                        0.0,
                        z,
                    ));
                    half.turned(Vec3::Y, s * slope)
                }))
            };
            let lift = Vec3::new(0.0, 0.0, self.page.x * slope.sin() + 0.006);
            b.part(&book, "cover", jacket(halves(0.0022, 0.0, 0.0).moved(lift), cell), Finish::BookJackets);
            b.part(&book, "pages", halves(0.007, -0.0048, 0.012).moved(lift - Vec3::new(0.0, 0.0, 0.0002)), Finish::Paper);
            return;
        }
        let cover =
            bevelled_box(Vec3::new(2.0 * self.page.x + 0.008, self.page.y + 0.008, 0.002), 0.0007).moved(Vec3::new(0.0, 0.0, 0.001));
        b.part(&book, "cover", jacket(cover, cell), Finish::BookJackets);
        b.part(&book, "pages", self.pages(), Finish::Paper);
        let line = |s: f32, k: i32| {
            board(
                [s * 0.55 * self.page.x - 0.36 * self.page.x, -0.0012, 0.0],
                [s * 0.55 * self.page.x + 0.36 * self.page.x, 0.0012, 0.0003],
                0.0001,
            )
            .moved(Vec3::new(0.0, 0.011 * k as f32, 0.0))
            .deformed(|p| {
                let t = (p.x / self.page.x).abs();
                Vec3::new(p.x, p.y, p.z + 0.0062 + 0.016 * (t * 9.0).min(1.0).sqrt() * (1.0 - 0.75 * t))
            })
            .smoothed(30.0)
        };
        // Printing is drawn as lines where the page is gently sloped.
        let rows = (0.36 * self.page.y / 0.011) as i32;
        let lines = (-rows..=rows).flat_map(|k| [line(-1.0, k), line(1.0, k)]);
        b.part(&book, "printing", all(lines), Finish::Rubber);
    }
}

/// A rack of wire or wood with magazines in it, on the floor.
#[derive(Clone, Copy, Debug)]
pub struct MagazineRack {
    /// Wood instead of wire.
    pub wood: bool,
    /// Magazines in it.
    pub count: usize,
}

impl Furniture for MagazineRack {
    fn random(rng: &mut Rng) -> Self {
        Self { wood: rng.below(2) == 0, count: 3 + rng.below(5) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.36, 0.28, 0.40)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let rack = b.object("magazine_rack", Class::OtherFurniture, pose);
        // Half the length between the ends of wires and floor.
        let half = 0.165;
        let side = |s: f32| -> Mesh {
            let plain = if self.wood {
                board([-0.17, -0.005, 0.0], [0.17, 0.005, 0.27], 0.002)
            } else {
                let wires = (0..9).map(|k| rod([0.04 * (k as f32 - 4.0), 0.0, 0.0], [0.04 * (k as f32 - 4.0), 0.0, 0.27], 0.002, 6));
                all(wires
                    .chain([rod([-half, 0.0, 0.27], [half, 0.0, 0.27], 0.004, 8), rod([-half, 0.0, 0.004], [half, 0.0, 0.004], 0.004, 8)]))
            };
            plain.turned(Vec3::X, -s * 0.16).moved(Vec3::new(0.0, s * 0.075, 0.06))
        };
        let finish = if self.wood { Finish::Wood } else { Finish::BlackMetal };
        b.part(&rack, "sides", grained(side(-1.0).with(side(1.0)), rng), finish);
        b.part(&rack, "floor", board([-half, -0.074, 0.056], [half, 0.074, 0.064], 0.001), finish);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| rod([0.15 * x, 0.1 * y, 0.0], [0.14 * x, 0.06 * y, 0.06], 0.006, 8));
        b.part(&rack, "feet", crate::pieces::standing(all(feet)), finish);
        // Their lower edges end above the rack's floor, which turned ones would cut into.
        for k in 0..self.count {
            let y = 0.1 * ((k as f32 + 0.5) / self.count as f32 - 0.5);
            let place = on(pose, Vec3::new(rng.range(-0.015, 0.015), y, 0.2275), 0.0)
                * DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2 - f64::from(1.4 * y));
            Magazines { count: 1 }.build(b, place, &mut Rng::new(rng.next_u64() | 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::{bounds_of, scene_of};

    #[test]
    fn magazines_in_a_rack_are_upright_and_show_their_covers() {
        for count in [3, 7] {
            let scene = scene_of(&MagazineRack { wood: true, count }, 0);
            for k in 1..=count {
                let of = |part: &str| bounds_of(&scene, &format!("magazines_{k}/{part}")).center();
                let (issue, photo, title) = (of("issue_1"), of("photo"), of("title"));
                assert!(title.z > photo.z && photo.y > issue.y, "{issue} {photo} {title}");
            }
        }
    }
}
