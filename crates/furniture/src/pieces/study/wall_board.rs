//! Boards on the wall in three common sizes from 60 × 45 to 120 × 90 cm: a whiteboard with writing and pens (class whiteboard), or a pin
//! board of cork with notes (class other structure; each note is of class paper). The origin is the middle of the back, on the wall.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front};
use crate::pieces::{Furniture, board, grained, on};
use crate::shape::{Reshape, picture_frame, sphere, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A board on the wall to write on, or of cork to pin notes to; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct WallBoard {
    /// Width and height over the frame.
    pub size: Vec2,
    /// Cork with notes, instead of white enamel.
    pub cork: bool,
}

impl Furniture for WallBoard {
    fn random(rng: &mut Rng) -> Self {
        let size = [Vec2::new(0.9, 0.6), Vec2::new(1.2, 0.9), Vec2::new(0.6, 0.45)][rng.below(3)];
        Self { size, cork: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, if self.cork { 0.03 } else { 0.075 }, self.size.y)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let (name, class) = if self.cork { ("pin_board", Class::OtherStructure) } else { ("whiteboard", Class::Whiteboard) };
        let object = b.object(name, class, pose);
        let half = 0.5 * self.size;
        let section = [[0.0, 0.0], [0.0, 0.017], [0.001, 0.018], [0.017, 0.018], [0.018, 0.017], [0.018, 0.0]];
        let frame = picture_frame(self.size.x, self.size.y, &section);
        b.part(&object, "frame", grained(frame, rng), if self.cork { Finish::Wood } else { Finish::Aluminium });
        let inset = 0.016;
        let panel = board([inset - half.x, 0.001, inset - half.y], [half.x - inset, 0.012, half.y - inset], 0.0005);
        b.part(&object, "panel", panel, if self.cork { Finish::Cork } else { Finish::WhiteEnamel });
        if self.cork {
            self.notes(b, pose, rng);
            return;
        }
        let tray = board([-0.4 * half.x, 0.0178, 0.002 - half.y], [0.4 * half.x, 0.073, 0.006 - half.y], 0.001);
        b.part(&object, "tray", tray, Finish::Aluminium);
        for k in 0..3u8 {
            let x = 0.14 * (f32::from(k) - 1.0) * half.x.min(0.6) / 0.6;
            let pen =
                cylinder(0.008, 0.11, 14).turned(Vec3::Y, std::f32::consts::FRAC_PI_2).moved(Vec3::new(x - 0.055, 0.048, 0.0145 - half.y));
            b.part(&object, &format!("pen_{}", k + 1), pen, Finish::Plastic(k));
        }
        // A few strokes of handwriting and a sketch.
        let mut strokes = Vec::new();
        for line in 0..4 {
            let (length, z) = (rng.range(0.8, 1.4) * half.x, half.y * (0.6 - 0.24 * line as f32));
            let phase = rng.range(0.0, 6.0);
            // Words of five to nine strokes with gaps between them.
            let mut k = 0;
            while k < 90 {
                let word = 5 + rng.below(5);
                let stroke = |k: usize| {
                    let (t, high) = (k as f32 / 90.0, if k % 7 == 3 { 1.8 } else { 1.0 });
                    Vec3::new(0.75 * half.x - length * t, 0.0122, z + 0.011 * high * (k as f32 * 2.6 + phase).sin())
                };
                let path: Vec<Vec3> = (k..=k + word).map(stroke).collect();
                strokes.push(tube(&path, 0.0012, 4));
                k += word + 3;
            }
        }
        b.part(&object, "writing", all(strokes), [Finish::BlackPlastic, Finish::Plastic(6)][rng.below(2)]);
    }
}

impl WallBoard {
    fn notes(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let columns = (self.size.x / 0.2) as usize;
        let rows = (self.size.y / 0.2) as usize;
        for k in 0..columns * rows {
            if rng.below(3) == 0 {
                continue;
            }
            let cell = Vec2::new((k % columns) as f32 + 0.5, (k / columns) as f32 + 0.5) / Vec2::new(columns as f32, rows as f32) - 0.5;
            let (w, h) = (rng.range(0.065, 0.11), rng.range(0.07, 0.12));
            let off = 0.012 * Vec2::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0));
            let at = Vec3::new(cell.x * (self.size.x - 0.12) + off.x, 0.0125, cell.y * (self.size.y - 0.12) + off.y);
            let note = b.object("note", Class::Paper, on(pose, at, 0.0) * DAffine3::from_rotation_y(f64::from(rng.range(-0.09, 0.09))));
            let sheet = board([-0.5 * w, 0.0, -0.5 * h], [0.5 * w, 0.0005, 0.5 * h], 0.0001);
            b.part(&note, "sheet", sheet, [Finish::Paper, Finish::Paper, Finish::Accent(k as u8)][rng.below(3)]);
            let pin = to_front(cylinder(0.0012, 0.01, 6)).with(sphere(0.0045, 12).moved(Vec3::new(0.0, 0.012, 0.0)));
            b.part(&note, "pin", pin.moved(Vec3::new(0.0, 0.0, 0.5 * h - 0.012)), Finish::Plastic(k as u8));
        }
    }
}
