//! A bar stool for a kitchen island, of class chair: a round seat 63 to 68 cm high, padded or of wood, on four legs with a foot ring or on
//! a chromed column with a plate; some have a low back. The sitter looks to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, around, cylinder, turned};
use crate::pieces::{Furniture, grained, standing};
use crate::shape::{Reshape, grid, rounded_loop, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A bar stool for a kitchen island.
#[derive(Clone, Copy, Debug)]
pub struct BarStool {
    /// Height of the seat: 0.65 m before a worktop of 0.91 m.
    pub seat: f32,
    /// Stands on one column with a foot plate instead of four legs.
    pub column: bool,
    /// The seat has a low back.
    pub back: bool,
    /// The seat is padded.
    pub padded: bool,
}

impl Furniture for BarStool {
    fn random(rng: &mut Rng) -> Self {
        Self { seat: rng.range(0.63, 0.68), column: rng.below(3) == 0, back: rng.below(2) == 0, padded: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.43, 0.43, self.seat + if self.back { 0.2 } else { 0.0 })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stool = b.object("bar_stool", Class::Chair, pose);
        let (h, r) = (self.seat, 0.175);
        let metal = if self.column { Finish::Chrome } else { Finish::BlackMetal };
        if self.padded {
            let pad = turned(
                &[[0.0, h - 0.06], [r - 0.01, h - 0.06], [r, h - 0.05], [r, h - 0.02], [r - 0.012, h - 0.005], [0.5 * r, h], [0.0, h]],
                48,
            );
            b.part(&stool, "seat", pad, [Finish::Leather, Finish::ArmchairCloth, Finish::Velvet][rng.below(3)]);
        } else {
            let top = turned(
                &[
                    [0.0, h - 0.03],
                    [r - 0.006, h - 0.03],
                    [r, h - 0.022],
                    [r, h - 0.006],
                    [r - 0.008, h],
                    [0.6 * r, h - 0.006],
                    [0.0, h - 0.008],
                ],
                48,
            );
            let mut top = top;
            top.uvs.iter_mut().zip(&top.positions).for_each(|(uv, p)| *uv = Vec2::new(p.x, p.y + p.z));
            b.part(&stool, "seat", grained(top, rng), Finish::Wood);
        }
        let under = h - if self.padded { 0.0602 } else { 0.0302 };
        if self.column {
            let plate = turned(&[[0.0, 0.0], [0.205, 0.0], [0.21, 0.004], [0.2, 0.012], [0.05, 0.022], [0.026, 0.04], [0.0, 0.04]], 48);
            b.part(&stool, "foot", plate, metal);
            b.part(&stool, "column", cylinder(0.024, under - 0.0395, 24).moved(Vec3::new(0.0, 0.0, 0.0395)), metal);
            b.part(&stool, "mount", cylinder(0.09, 0.012, 32).moved(Vec3::new(0.0, 0.0, under - 0.012)), metal);
            let ring = tube(&rounded_loop(0.3, 0.3, 0.1499, 12), 0.009, 10).moved(Vec3::new(0.0, 0.0, 0.24));
            let arms = around(2, 0.0).map(|d| tube(&[(d * 0.02).extend(0.24), (d * 0.15).extend(0.24)], 0.008, 8));
            b.part(&stool, "foot_ring", ring.with(all(arms)), metal);
        } else {
            let legs = around(4, 0.785).map(|d| standing(tube(&[(d * 0.21).extend(0.0), (d * 0.12).extend(under)], 0.0125, 12)));
            b.part(&stool, "legs", grained(all(legs), rng), if self.padded { metal } else { Finish::Wood });
            let side = 2.0 * 0.21_f32.mul_add(1.0 - 0.22 / under, 0.12 * 0.22 / under) * std::f32::consts::FRAC_1_SQRT_2;
            let ring = tube(&rounded_loop(side + 0.012, side + 0.012, 0.02, 4), 0.0075, 8).moved(Vec3::new(0.0, 0.0, 0.22));
            b.part(&stool, "foot_ring", ring, metal);
        }
        if self.back {
            b.part(&stool, "back", low_back(h), if self.padded { Finish::Leather } else { Finish::Wood });
            let posts = [-0.55f32, 0.55].map(|a| {
                let d = Vec2::new(a.sin(), -a.cos());
                tube(&[(d * 0.155).extend(under + 0.004), (d * 0.178).extend(h + 0.03), (d * 0.178).extend(h + 0.12)], 0.007, 8)
            });
            b.part(&stool, "posts", all(posts), metal);
        }
    }
}

/// A bent band above the rear half of the seat.
fn low_back(seat: f32) -> enfilade_geometry::Mesh {
    const N: usize = 20;
    let loop_of = [[0.0, 0.09], [0.009, 0.098], [0.018, 0.09], [0.018, 0.015], [0.009, 0.007], [0.0, 0.015]];
    let point = |i: usize, j: usize| {
        let a = 1.25 * (2.0 * (j.clamp(1, N + 1) - 1) as f32 / N as f32 - 1.0);
        let d = Vec2::new(a.sin(), -a.cos());
        let z = seat + 0.1;
        if j == 0 || j == N + 2 {
            return (d * 0.189).extend(z + 0.05);
        }
        let [out, up] = loop_of[i % 6];
        (d * (0.18 + out)).extend(z + up)
    };
    grid(6, N + 2, point, |i, j| Vec2::new(j as f32 * 0.022, i as f32 * 0.03)).smoothed(50.0)
}
