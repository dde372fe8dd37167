//! Paper and pens on a desk: heaps of A4 sheets up to 4.5 cm high or in two or three letter trays (class paper; the trays are other prop),
//! and a cup with three to eight pens (class other prop).

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{around, cylinder, turned, vessel};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, bevelled_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// Sheets of paper, heaped, or in a letter tray.
#[derive(Clone, Copy, Debug)]
pub struct PaperStack {
    /// Height of the heap.
    pub height: f32,
    /// Wire trays above each other that hold the sheets; 0 for a heap.
    pub trays: usize,
}

/// A sheet of DIN A4, metres.
const SHEET: [f32; 2] = [0.21, 0.297];
/// From one letter tray to the next, metres.
const TRAY: f32 = 0.075;

impl Furniture for PaperStack {
    fn random(rng: &mut Rng) -> Self {
        Self { height: rng.range(0.004, 0.045), trays: [0, 0, 2, 3][rng.below(4)] }
    }

    fn size(&self) -> Vec3 {
        if self.trays > 0 { Vec3::new(0.25, 0.33, TRAY * self.trays as f32) } else { Vec3::new(0.28, 0.36, self.height + 0.012) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        if self.trays == 0 {
            heap(b, pose, self.height, 0.12, rng);
            return;
        }
        for k in 0..self.trays {
            heap(b, on(pose, Vec3::new(0.0, 0.0, 0.006 + TRAY * k as f32), 0.0), rng.range(0.004, 0.035), 0.02, rng);
        }
        let tray = b.object("letter_tray", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        for k in 0..self.trays {
            let z = TRAY * k as f32;
            let wall = |size: Vec3, at: Vec3| bevelled_box(size, 0.0008).moved(at + Vec3::new(0.0, 0.0, z));
            let mesh = wall(Vec3::new(0.244, 0.325, 0.004), Vec3::new(0.0, 0.0, 0.003))
                .with(wall(Vec3::new(0.003, 0.325, 0.05), Vec3::new(-0.1225, 0.0, 0.026)))
                .with(wall(Vec3::new(0.003, 0.325, 0.05), Vec3::new(0.1225, 0.0, 0.026)))
                .with(wall(Vec3::new(0.242, 0.003, 0.05), Vec3::new(0.0, -0.161, 0.026)));
            b.part(&tray, &format!("tray_{}", k + 1), mesh, Finish::BlackMetal);
            if k > 0 {
                let posts = [[-0.1215, -0.15], [0.1215, -0.15], [-0.1215, 0.14], [0.1215, 0.14]];
                let posts = posts.map(|[x, y]| cylinder(0.0025, 0.03, 8).moved(Vec3::new(x, y, z - 0.0265)));
                b.part(&tray, &format!("posts_{k}"), crate::pieces::form::all(posts), Finish::BlackMetal);
            }
        }
    }
}

/// A few packs of sheets on each other, turned by up to `disorder` radians.
fn heap(b: &mut Builder, pose: DAffine3, height: f32, disorder: f32, rng: &mut Rng) {
    let paper = b.object("paper", Class::Paper, pose);
    let packs = 1 + (height / 0.008) as usize;
    let step = height / packs as f32;
    for k in 0..packs {
        let pack = bevelled_box(Vec3::new(SHEET[0], SHEET[1], step - 0.0003), 0.0002).turned(Vec3::Z, disorder * rng.range(-1.0, 1.0));
        let at = Vec3::new(0.1 * disorder * rng.range(-1.0, 1.0), 0.1 * disorder * rng.range(-1.0, 1.0), CONTACT + (k as f32 + 0.5) * step);
        b.part(&paper, &format!("sheets_{}", k + 1), pack.moved(at), Finish::Paper);
    }
}

/// Pens and pencils in a cup.
#[derive(Clone, Copy, Debug)]
pub struct PenCup {
    /// Number of pens.
    pub pens: usize,
}

impl Furniture for PenCup {
    fn random(rng: &mut Rng) -> Self {
        Self { pens: 3 + rng.below(6) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.135, 0.135, 0.19)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let cup = b.object("pen_cup", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let body = vessel(&[[0.037, 0.0], [0.039, 0.004], [0.04, 0.05], [0.04, 0.1]], 0.003, 32);
        b.part(&cup, "body", body, [Finish::Ceramic(0), Finish::BlackMetal, Finish::Wood, Finish::Leather][rng.below(4)]);
        for (k, d) in around(self.pens, rng.next_f32()).enumerate() {
            let length = rng.range(0.14, 0.175);
            // A pen stands on the floor at one side and leans on the rim at the other; each passes the axis on its own side.
            let tilt = rng.range(0.45, 0.47);
            let pencil = k % 2 == 0;
            let pen = if pencil {
                turned(&[[0.0, 0.0], [0.0036, 0.0], [0.0036, length - 0.016], [0.0008, length], [0.0, length]], 6)
            } else {
                turned(&[[0.0, 0.0], [0.0045, 0.0], [0.0045, length - 0.03], [0.0038, length - 0.004], [0.0, length]], 12)
            };
            let foot = d * -0.018 + d.perp() * 0.014;
            let lean = pen.turned(Vec3::Y, tilt).turned(Vec3::Z, d.to_angle()).moved(foot.extend(0.0045));
            b.part(&cup, &format!("pen_{}", k + 1), lean, if pencil { Finish::Wood } else { Finish::Plastic(k as u8) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::{bodies_of, scene_of};

    #[test]
    fn no_pen_in_a_cup_runs_through_another() {
        for (pens, seed) in (3..=8).flat_map(|pens| [0, 1, 2].map(|seed| (pens, seed))) {
            let found = bodies_of(&scene_of(&PenCup { pens }, seed), "/pen_");
            assert_eq!(found.len(), pens);
            for (k, a) in found.iter().enumerate() {
                for b in &found[k + 1..] {
                    assert!(!a.meets(b, Vec3::ZERO), "{pens} pens: {} meets {}", a.name, b.name);
                }
            }
        }
    }
}
