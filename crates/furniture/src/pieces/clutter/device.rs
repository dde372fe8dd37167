//! Hand-held devices that lie on their backs: remote controls 14 to 21 cm long, phones of 73 × 150 mm, tablets of 250 × 175 mm; class other
//! prop. Phones and tablets show a picture where they are on.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, rounded_rectangle};
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, grid, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A remote control.
#[derive(Clone, Copy, Debug)]
pub struct RemoteControl {
    /// Length along y.
    pub length: f32,
}

impl Furniture for RemoteControl {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(0.14, 0.21) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.046, self.length, 0.023)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let remote = b.object("remote_control", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let body = rounded_box(Vec3::new(0.044, self.length - 0.002, 0.018), 0.006, 3).moved(Vec3::new(0.0, 0.0, 0.009));
        b.part(&remote, "body", body, Finish::BlackPlastic);
        let rows = ((self.length - 0.07) / 0.011) as usize;
        let buttons = (0..3 * rows).map(|k| {
            let (x, y) = (0.0115 * ((k % 3) as f32 - 1.0), 0.4 * self.length - 0.011 * (k / 3) as f32);
            board([x - 0.0038, y - 0.003, 0.0176], [x + 0.0038, y + 0.003, 0.0195], 0.0006)
        });
        b.part(&remote, "buttons", all(buttons), Finish::Rubber);
        let ring = cylinder(0.013, 0.0025, 28).moved(Vec3::new(0.0, -0.5 * self.length + 0.024, 0.0176));
        b.part(&remote, "ring", ring, Finish::Aluminium);
        let power = cylinder(0.0032, 0.002, 14).moved(Vec3::new(0.012, 0.45 * self.length, 0.0176));
        b.part(&remote, "power", power, Finish::Plastic(rng.below(2) as u8 + 2));
    }
}

/// A telephone that lies on its back.
#[derive(Clone, Copy, Debug)]
pub struct Phone {
    /// The screen is lit.
    pub on: bool,
    /// Finish of its case.
    pub case: Finish,
}

/// A flat device with a picture on its upper side.
fn slate(b: &mut Builder, name: &str, pose: DAffine3, size: Vec2, round: f32, thickness: f32, case: Finish, screen: Finish) {
    let object = b.object(name, Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
    b.part(&object, "case", cut_out(&rounded_rectangle(size.x, size.y, round, 6), thickness, 0.0015), case);
    let glass = cut_out(&rounded_rectangle(size.x - 0.004, size.y - 0.004, round - 0.001, 6), 0.0008, 0.0002);
    b.part(&object, "glass", glass.moved(Vec3::new(0.0, 0.0, thickness - 0.0003)), Finish::GlossBlack);
    let shown = size - 0.012;
    let corner = |i: usize, j: usize| Vec2::new(i as f32, j as f32);
    let picture = grid(1, 1, |i, j| ((corner(i, j) - 0.5) * shown).extend(thickness + 0.0007), corner);
    b.part(&object, "screen", picture, screen);
}

impl Furniture for Phone {
    fn random(rng: &mut Rng) -> Self {
        Self { on: rng.below(3) == 0, case: [Finish::BlackPlastic, Finish::Aluminium, Finish::Plastic(rng.below(5) as u8)][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.073, 0.15, 0.0095)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let screen = if self.on { Finish::ScreenOn(rng.below(4) as u8) } else { Finish::Screen };
        slate(b, "phone", pose, Vec2::new(0.073, 0.15), 0.011, 0.0078, self.case, screen);
    }
}

/// A tablet that lies on its back.
#[derive(Clone, Copy, Debug)]
pub struct Tablet {
    /// The screen is lit.
    pub on: bool,
}

impl Furniture for Tablet {
    fn random(rng: &mut Rng) -> Self {
        Self { on: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.25, 0.175, 0.0085)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let screen = if self.on { Finish::ScreenOn(rng.below(4) as u8) } else { Finish::Screen };
        slate(b, "tablet", pose, Vec2::new(0.25, 0.175), 0.01, 0.0065, Finish::Aluminium, screen);
    }
}
