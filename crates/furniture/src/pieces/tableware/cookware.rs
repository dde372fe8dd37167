//! Cookware, all of class other prop: pots and pans, cutting boards of 20 to 28 × 30 to 40 cm that lie or lean, a knife block and a jar
//! of utensils. Knife block and jar have one size each; handles and grips of pans are at +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, around, cut_out, rod, rounded_rectangle, turned, vessel, wire};
use crate::pieces::{CONTACT, Furniture, grained, on};
use crate::shape::{Reshape, rounded_box, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Pots and pans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cookware {
    /// A pot with a lid, by radius and height.
    Pot(f32, f32),
    /// A small pot with one long handle.
    Saucepan,
    /// A frying pan, by its radius.
    FryingPan(f32),
    /// A heavy enamelled pot in a colour of the room.
    Casserole,
}

fn body(r: f32, h: f32) -> Mesh {
    vessel(&[[r - 0.012, 0.0], [r - 0.002, 0.006], [r, 0.02], [r, 0.6 * h], [r, h]], 0.003, 48)
}

fn lid(r: f32, z: f32, knob: f32) -> Mesh {
    let profile = [
        [0.0, z],
        [r + 0.001, z],
        [r + 0.003, z + 0.002],
        [r - 0.004, z + 0.007],
        [0.5 * r, z + 0.016],
        [knob * 0.5, z + 0.02],
        [knob * 0.45, z + 0.032],
        [knob, z + 0.036],
        [knob, z + 0.043],
        [0.0, z + 0.046],
    ];
    turned(&profile, 44)
}

impl Furniture for Cookware {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(4) {
            0 => Self::Pot(rng.range(0.09, 0.125), rng.range(0.1, 0.19)),
            1 => Self::Saucepan,
            2 => Self::FryingPan(rng.range(0.105, 0.145)),
            _ => Self::Casserole,
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Pot(r, h) => Vec3::new(2.0 * r + 0.085, 2.0 * r + 0.008, h + 0.05),
            Self::Saucepan => Vec3::new(0.364, 0.178, 0.10),
            Self::FryingPan(r) => Vec3::new(2.0 * r + 0.205, 2.0 * r + 0.008, 0.08),
            Self::Casserole => Vec3::new(0.344, 0.268, 0.18),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let (name, finish) = match self {
            Self::FryingPan(_) => ("frying_pan", Finish::BlackMetal),
            Self::Casserole => ("casserole", Finish::ColoredMetal(rng.below(3) as u8)),
            _ => ("pot", if rng.below(4) == 0 { Finish::Copper } else { Finish::Steel }),
        };
        let pot = b.object(name, Class::OtherProp, pose);
        let up = Vec3::new(0.0, 0.0, CONTACT);
        let ears = |r: f32, z: f32, out: f32| {
            all([-1.0, 1.0].map(|s: f32| {
                wire(
                    &[
                        [s * (r - 0.001), -0.032, z],
                        [s * (r + out), -0.026, z + 0.002],
                        [s * (r + out), 0.026, z + 0.002],
                        [s * (r - 0.001), 0.032, z],
                    ],
                    0.005,
                    8,
                )
            }))
        };
        match *self {
            Self::Pot(r, h) => {
                b.part(&pot, "body", body(r, h).moved(up), finish);
                b.part(&pot, "ears", ears(r, h - 0.03, 0.032), Finish::Steel);
                b.part(&pot, "lid", lid(r, h + 2.0 * CONTACT, 0.016).moved(up), finish);
            }
            Self::Saucepan => {
                let (r, at) = (0.08, Vec3::new(-0.095, 0.0, 0.0));
                b.part(&pot, "body", body(r, 0.09).moved(up + at), finish);
                let grip = rod([r - 0.002, 0.0, 0.075], [r + 0.19, 0.0, 0.09], 0.0085, 12);
                b.part(&pot, "handle", grip.moved(at), Finish::BlackPlastic);
            }
            Self::FryingPan(r) => {
                let at = Vec3::new(-0.1, 0.0, 0.0);
                let dish = vessel(&[[0.72 * r, 0.0], [0.78 * r, 0.003], [0.92 * r, 0.022], [r, 0.045]], 0.003, 48);
                b.part(&pot, "body", dish.moved(up + at), finish);
                let grip = wire(&[[r - 0.012, 0.0, 0.03], [r + 0.04, 0.0, 0.05], [r + 0.19, 0.0, 0.066]], 0.009, 12);
                b.part(&pot, "handle", grip.moved(at), if rng.below(2) == 0 { Finish::Wood } else { Finish::BlackPlastic });
            }
            Self::Casserole => {
                b.part(&pot, "body", body(0.125, 0.125).moved(up), finish);
                b.part(&pot, "ears", ears(0.125, 0.105, 0.03), finish);
                b.part(&pot, "lid", lid(0.126, 0.125 + 2.0 * CONTACT, 0.018).moved(up), finish);
            }
        }
    }
}

/// A board to cut on, lying, or leaning against the wall behind it.
#[derive(Clone, Copy, Debug)]
pub struct CuttingBoard {
    /// Width, and length without a grip.
    pub size: Vec2,
    /// The board has a grip at one end.
    pub paddle: bool,
    /// Stands and leans against the wall at −y.
    pub leaning: bool,
}

impl Furniture for CuttingBoard {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(0.2, 0.28), rng.range(0.3, 0.4)), paddle: rng.below(2) == 0, leaning: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        let grip = if self.paddle { 0.12 } else { 0.0 };
        if self.leaning { Vec3::new(self.size.x, 0.12, self.size.y + grip) } else { Vec3::new(self.size.x, self.size.y + grip, 0.02) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("cutting_board", Class::OtherProp, pose);
        let grip = if self.paddle { 0.12 } else { 0.0 };
        let thickness = 0.018;
        let mut mesh =
            cut_out(&rounded_rectangle(self.size.x, self.size.y, 0.03, 5), thickness, 0.003).moved(Vec3::new(0.0, -0.5 * grip, 0.0));
        if self.paddle {
            let handle = rounded_box(Vec3::new(0.042, grip + 0.03, thickness - 0.001), 0.006, 3);
            mesh = mesh.with(handle.moved(Vec3::new(0.0, 0.5 * self.size.y - 0.015, 0.5 * thickness)));
        }
        let length = self.size.y + grip;
        let mesh = if self.leaning {
            // The board stands on its edge and leans back by ten degrees.
            let lean = 0.17_f32;
            mesh.moved(Vec3::new(0.0, 0.5 * length, -thickness)).turned(Vec3::X, std::f32::consts::FRAC_PI_2 + lean).moved(Vec3::new(
                0.0,
                -0.06 + length * lean.sin() + 0.001,
                CONTACT,
            ))
        } else {
            mesh.moved(Vec3::new(0.0, 0.0, CONTACT))
        };
        b.part(&object, "body", grained(mesh, rng), if rng.below(3) == 0 { Finish::DarkWood } else { Finish::Wood });
    }
}

/// A block of wood with knives in it.
#[derive(Clone, Copy, Debug)]
pub struct KnifeBlock;

impl Furniture for KnifeBlock {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.11, 0.28, 0.29)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("knife_block", Class::OtherProp, on(pose, Vec3::new(0.0, -0.035, 0.0), 0.0));
        let outline = [[-0.10, 0.0], [0.08, 0.0], [0.11, 0.09], [0.02, 0.225], [-0.07, 0.17]].map(Vec2::from_array);
        let block = cut_out(&outline, 0.1, 0.003).moved(Vec3::new(0.0, 0.0, -0.05));
        // The outline is drawn in the plane of y and z.
        let block = block.turned(Vec3::X, std::f32::consts::FRAC_PI_2).turned(Vec3::Z, std::f32::consts::FRAC_PI_2);
        b.part(&object, "block", grained(block.moved(Vec3::new(0.0, 0.0, CONTACT)), rng), Finish::Wood);
        // Knives stick out of the upper front face, square to it.
        let (low, high) = (Vec2::new(0.11, 0.09), Vec2::new(0.02, 0.225));
        let out = (low - high).perp().normalize();
        for k in 0..6 {
            let (column, row) = ((k % 2) as f32, (k / 2) as f32);
            let foot = low.lerp(high, 0.22 + 0.27 * row);
            let (x, length) = (0.045 * (column - 0.5), 0.085 + 0.018 * row);
            let tip = foot + out * length;
            let grip = rod([x, foot.x - 0.004 * out.x, foot.y - 0.004 * out.y], [x, tip.x, tip.y], 0.0085, 10)
                .deformed(|p| Vec3::new(x + (p.x - x) * 0.75, p.y, p.z))
                .smoothed(50.0);
            b.part(&object, &format!("knife_{}", k + 1), grip.moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::BlackPlastic);
        }
    }
}

/// A jar with spoons and spatulas.
#[derive(Clone, Copy, Debug)]
pub struct UtensilJar;

impl Furniture for UtensilJar {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.276, 0.276, 0.35)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("utensil_jar", Class::OtherProp, pose);
        let up = Vec3::new(0.0, 0.0, CONTACT);
        let jar = vessel(&[[0.05, 0.0], [0.054, 0.006], [0.055, 0.08], [0.055, 0.155]], 0.004, 40);
        b.part(&object, "jar", jar.moved(up), Finish::Ceramic(rng.below(3) as u8));
        for (k, out) in around(5, rng.next_f32()).enumerate() {
            let (foot, rim) = (-0.025 * out, 0.045 * out);
            let tip = rim + out * 0.014 + (rim - foot) * 0.4;
            let z = rng.range(0.24, 0.27);
            let stick = rod([foot.x, foot.y, 0.012], [tip.x, tip.y, z], 0.0045, 8);
            let head = match k % 3 {
                0 => rounded_box(Vec3::new(0.05, 0.006, 0.075), 0.003, 2),
                1 => sphere(1.0, 18).deformed(|p| Vec3::new(0.022 * p.x, 0.007 * p.y, 0.033 * p.z)).smoothed(60.0),
                _ => all((0..4).map(|i| {
                    let (sin, cos) = (i as f32 * 0.785).sin_cos();
                    let w = 0.026;
                    wire(
                        &[[0.0, 0.0, -0.03], [w * cos, w * sin, 0.015], [0.0, 0.0, 0.045], [-w * cos, -w * sin, 0.015], [0.0, 0.0, -0.03]],
                        0.001,
                        5,
                    )
                })),
            };
            let finish = if k % 3 == 2 { Finish::Chrome } else { Finish::Wood };
            // A head continues its stick, turned at random about it.
            let way = Vec3::new(tip.x - foot.x, tip.y - foot.y, z - 0.012).normalize();
            let lean = way.z.clamp(-1.0, 1.0).acos();
            let head = head.turned(Vec3::Z, rng.range(0.0, 3.0)).turned(Vec3::Y, lean).turned(Vec3::Z, out.to_angle());
            let head = head.moved(Vec3::new(tip.x, tip.y, z) + 0.028 * way);
            b.part(&object, &format!("utensil_{}", k + 1), stick.with(head).moved(up), finish);
        }
    }
}
