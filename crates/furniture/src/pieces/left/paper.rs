//! Paper that lies about: two to six letters on each other, and crumpled sheets (class paper); a pizza's box of 33 cm (class box), shut or
//! with its lid open.

use crate::builder::{Builder, Class};
use crate::materials::{Finish, PACKAGE_COLUMNS};
use crate::pieces::form::all;
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, bevelled_box, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Letters and leaflets that lie on each other askew.
#[derive(Clone, Copy, Debug)]
pub struct Post {
    /// Number of letters.
    pub letters: usize,
}

/// Width and depth of envelopes and leaflets: DIN long, C5, A4 folded in three, A5, metres.
const FORMATS: [[f32; 2]; 4] = [[0.22, 0.11], [0.229, 0.162], [0.21, 0.1], [0.21, 0.148]];
/// Thickness of a letter, metres.
const LETTER: f32 = 0.0016;

impl Furniture for Post {
    fn random(rng: &mut Rng) -> Self {
        Self { letters: 2 + rng.below(5) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.30, 0.26, 0.002 + 0.002 * self.letters as f32)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let post = b.object("post", Class::Paper, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        for k in 0..self.letters {
            let [width, depth] = FORMATS[rng.below(FORMATS.len())];
            let at = Vec3::new(rng.range(-0.018, 0.018), rng.range(-0.02, 0.02), (0.5 + k as f32) * (LETTER + 0.0002));
            let turn = rng.range(-0.35, 0.35);
            let lying = |mesh: Mesh| mesh.turned(Vec3::Z, turn).moved(at);
            let finish = [Finish::Paper, Finish::Paper, Finish::Cardboard, Finish::Packages][rng.below(4)];
            let leaf = bevelled_box(Vec3::new(width, depth, LETTER), 0.0004);
            b.part(&post, &format!("letter_{}", k + 1), lying(printed(leaf, finish, rng)), finish);
            if finish == Finish::Paper {
                // The window of an envelope, and a stamp or a printed mark.
                let mark = |x: f32, y: f32, w: f32, d: f32| {
                    board([x - 0.5 * w, y - 0.5 * d, 0.5 * LETTER - 0.0001], [x + 0.5 * w, y + 0.5 * d, 0.5 * LETTER + 0.0002], 0.0001)
                };
                let lines = (0..3).map(|line| mark(-0.2 * width, -0.14 * depth - 0.008 * line as f32, 0.26 * width, 0.0022));
                b.part(&post, &format!("address_{}", k + 1), lying(all(lines)), Finish::Rubber);
                b.part(
                    &post,
                    &format!("stamp_{}", k + 1),
                    lying(mark(0.4 * width, 0.34 * depth, 0.022, 0.026)),
                    Finish::Accent(rng.below(3) as u8),
                );
            }
        }
    }
}

/// A leaflet shows one of the fronts of packages over all of it.
fn printed(mut leaf: Mesh, finish: Finish, rng: &mut Rng) -> Mesh {
    if finish == Finish::Packages {
        let cell = Vec2::new(rng.below(PACKAGE_COLUMNS) as f32, rng.below(PACKAGE_COLUMNS) as f32);
        let bounds = leaf.bounds();
        let extent = bounds.extent().truncate();
        leaf.uvs = leaf
            .positions
            .iter()
            .map(|p| (p.truncate() - bounds.min.truncate()) / extent)
            .map(|uv| (cell + uv) / PACKAGE_COLUMNS as f32)
            .collect();
    }
    leaf
}

/// A sheet of paper pressed to a ball.
#[derive(Clone, Copy, Debug)]
pub struct CrumpledPaper {
    /// Radius of the ball.
    pub radius: f32,
}

impl Furniture for CrumpledPaper {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.028, 0.042) }
    }

    fn size(&self) -> Vec3 {
        Vec3::splat(2.0 * self.radius)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("crumpled_paper", Class::Paper, pose);
        let facets: Vec<(Vec3, f32)> = (0..26)
            .map(|_| {
                let (z, turn) = (rng.range(-1.0, 1.0f32), rng.range(0.0, TAU));
                ((Vec2::from_angle(turn) * (1.0 - z * z).sqrt()).extend(z), rng.range(0.72, 1.0))
            })
            .collect();
        // A ball with flat facets, each at its own distance from the middle.
        let ball = sphere(1.0, 26).deformed(|p| {
            let most = facets.iter().map(|(n, d)| n.dot(p) / d).fold(0.8f32, f32::max);
            self.radius * p / most
        });
        let low = ball.bounds().min.z;
        let fit = 0.98 * self.radius / ball.bounds().max.abs().max(ball.bounds().min.abs()).max_element();
        b.part(
            &object,
            "ball",
            ball.deformed(|p| fit.min(1.0) * (p - Vec3::Z * low)).smoothed(14.0).moved(Vec3::Z * CONTACT),
            Finish::Paper,
        );
    }
}

/// A box in which a pizza was brought.
#[derive(Clone, Copy, Debug)]
pub struct Pizza {
    /// The lid is open by this angle, radians.
    pub open_rad: f32,
}

impl Furniture for Pizza {
    fn random(rng: &mut Rng) -> Self {
        Self { open_rad: if rng.below(2) == 0 { 0.0 } else { rng.range(1.7, 1.95) } }
    }

    fn size(&self) -> Vec3 {
        if self.open_rad > 0.0 { Vec3::new(0.34, 0.64, 0.38) } else { Vec3::new(0.34, 0.34, 0.046) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("pizza_box", Class::Box, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (half, high, wall) = (0.165, 0.042, 0.0025);
        let side = board([-half, half - wall, 0.0], [half, half, high - wall - 0.0002], 0.0005);
        let sides = all((0..4).map(|k| {
            let narrow = if k % 2 == 0 {
                side.clone()
            } else {
                side.clone().deformed(|p| Vec3::new(p.x * (1.0 - 2.05 * wall / (2.0 * half)), p.y, p.z)).smoothed(30.0)
            };
            narrow.turned(Vec3::Z, FRAC_PI_2 * k as f32)
        }));
        let floor = board([-half + 1.1 * wall, -half + 1.1 * wall, 0.0], [half - 1.1 * wall, half - 1.1 * wall, wall], 0.0005);
        b.part(&object, "tray", sides.with(floor), Finish::Cardboard);
        let hinge = Vec3::new(0.0, -half, high);
        let lid = board([-half, 0.0003, -wall], [half, 2.0 * half, 0.0], 0.0005).turned(Vec3::X, self.open_rad).moved(hinge);
        b.part(&object, "lid", lid, Finish::Cardboard);
        if self.open_rad > 0.0 {
            let crusts = all((0..2 + rng.below(4)).map(|_| {
                let at = Vec2::from_angle(rng.range(0.0, TAU)) * rng.range(0.03, 0.11);
                let crust = sphere(1.0, 12).deformed(|p| Vec3::new(0.035 * p.x, 0.008 * p.y + 0.02 * p.x * p.x, 0.007 * p.z));
                crust.smoothed(50.0).turned(Vec3::Z, rng.range(0.0, TAU)).moved(at.extend(wall + 0.0068))
            }));
            b.part(&object, "crusts", crusts, Finish::Bread);
        }
    }
}
