//! A table of a classroom for one or two, 70 or 130 cm wide and 76 cm high, class desk: a laminated top on four legs or two feet of steel, some
//! with a tray for books below. The pupil sits at +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, wire};
use crate::pieces::{Furniture, Surface, board, grained};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A pupil's table.
#[derive(Clone, Copy, Debug)]
pub struct StudentDesk {
    /// Pupils beside each other.
    pub seats: usize,
    /// Two feet below columns instead of four legs.
    pub feet: bool,
    /// A tray for books is below the top.
    pub tray: bool,
    /// Finish of the top.
    pub top: Finish,
    /// Finish of the frame.
    pub metal: Finish,
}

/// Height of the top (EN 1729, size 6), its thickness, and the depth of the table, metres.
const TOP: f32 = 0.76;
const BOARD: f32 = 0.022;
const DEPTH: f32 = 0.52;

impl StudentDesk {
    /// Width over its top.
    pub fn width(&self) -> f32 {
        0.62 * self.seats as f32 + 0.08
    }

    /// Where pupils sit, along x from the middle.
    pub fn places(&self) -> Vec<f32> {
        (0..self.seats).map(|k| 0.62 * (k as f32 - 0.5 * (self.seats - 1) as f32)).collect()
    }
}

impl Furniture for StudentDesk {
    fn random(rng: &mut Rng) -> Self {
        Self {
            seats: 1 + rng.below(2),
            feet: rng.below(2) == 0,
            tray: rng.below(2) == 0,
            top: [Finish::Wood, Finish::Wood, Finish::WhiteLacquer, Finish::DarkWood][rng.below(4)],
            metal: [Finish::BlackMetal, Finish::Aluminium, Finish::ColoredMetal(1), Finish::CoatedWhite][rng.below(4)],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width(), DEPTH, TOP)
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * Vec2::new(self.width(), DEPTH) - 0.03;
        vec![Surface { min: -half, max: half, z: TOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let desk = b.object("student_desk", Class::Desk, pose);
        let (x, under) = (0.5 * self.width(), TOP - BOARD);
        b.part(
            &desk,
            "top",
            grained(rounded_box(Vec3::new(2.0 * x, DEPTH, BOARD), 0.008, 3).moved(Vec3::new(0.0, 0.0, TOP - 0.5 * BOARD)), rng),
            self.top,
        );
        let z = under - 0.0152;
        let frame = |mut parts: Vec<enfilade_geometry::Mesh>| {
            parts.extend([-1.0f32, 1.0].map(|s| rod([0.06 - x, s * 0.2, z], [x - 0.06, s * 0.2, z], 0.015, 12)));
            all(parts)
        };
        let side = |s: f32| {
            let at = s * (x - 0.06);
            if self.feet {
                let foot =
                    wire(&[[at, 0.23, 0.012], [at, 0.19, 0.022], [at, 0.0, 0.028], [at, -0.19, 0.022], [at, -0.23, 0.012]], 0.0115, 10);
                let column = board([at - 0.014, -0.03, 0.024], [at + 0.014, 0.03, z], 0.004);
                vec![foot, column, rod([at, -0.2, z], [at, 0.2, z], 0.015, 12)]
            } else {
                let leg = |q: f32| rod([at, 0.2 * q, 0.0], [at, 0.2 * q, z], 0.014, 12);
                vec![leg(-1.0), leg(1.0), rod([at, -0.2, z], [at, 0.2, z], 0.013, 12)]
            }
        };
        b.part(&desk, "frame", frame(side(-1.0).into_iter().chain(side(1.0)).collect()), self.metal);
        if self.tray {
            for (k, at) in self.places().into_iter().enumerate() {
                let wires = (0..7).map(|i| {
                    let wx = at - 0.2 + 0.4 * i as f32 / 6.0;
                    wire(&[[wx, 0.2, z], [wx, 0.14, under - 0.11], [wx, -0.16, under - 0.11], [wx, -0.2, z]], 0.003, 6)
                });
                let across = [0.12f32, -0.14].map(|wy| rod([at - 0.203, wy, under - 0.11], [at + 0.203, wy, under - 0.11], 0.003, 6));
                b.part(&desk, &format!("tray_{}", k + 1), all(wires.chain(across)), self.metal);
            }
        }
    }
}
