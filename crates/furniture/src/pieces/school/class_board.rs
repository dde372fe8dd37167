//! A board to write on, 1.2 to 4 m wide, class whiteboard: white enamel, or green or black for chalk, in a frame of aluminium or wood with a
//! tray for pens, chalk and a sponge; some have two wings. It shows writing, sums and a drawing. The origin is the middle of the back.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, to_front};
use crate::pieces::{Furniture, board, grained};
use crate::shape::{Reshape, picture_frame, rounded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// A board on the wall to write on.
#[derive(Clone, Copy, Debug)]
pub struct ClassBoard {
    /// Width and height over the frame.
    pub size: Vec2,
    /// What one writes on.
    pub sheet: BoardSheet,
    /// Sheets beside each other: one or three.
    pub panels: usize,
    /// The frame is of wood, and there is no tray: a board with the day's dishes.
    pub menu: bool,
}

/// What one writes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoardSheet {
    /// White enamel, with pens.
    White,
    /// Green enamel, with chalk.
    Green,
    /// Slate, with chalk.
    Black,
}

/// Plane of the sheet before the wall, metres.
const SHEET: f32 = 0.0122;

impl ClassBoard {
    /// A board of a café or shop with the day's dishes.
    pub fn menu(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(0.7, 1.5), rng.range(0.7, 1.0)), sheet: BoardSheet::Black, panels: 1, menu: true }
    }

    fn panel_width(&self) -> f32 {
        self.size.x / self.panels as f32
    }

    fn sheets(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let finish = match self.sheet {
            BoardSheet::White => Finish::WhiteEnamel,
            BoardSheet::Green => Finish::Chalkboard(0),
            BoardSheet::Black => Finish::Chalkboard(1),
        };
        let (w, half) = (self.panel_width(), 0.5 * self.size);
        let section = [[0.0, 0.0], [0.0, 0.019], [0.001, 0.02], [0.023, 0.02], [0.024, 0.019], [0.024, 0.0]];
        for k in 0..self.panels {
            let x = w * (k as f32 - 0.5 * (self.panels - 1) as f32);
            let frame = picture_frame(w - 0.001, self.size.y, &section).moved(Vec3::new(x, 0.0, 0.0));
            let rim = if self.menu { Finish::Wood } else { Finish::Aluminium };
            b.part(object, &format!("frame_{}", k + 1), grained(frame, rng), rim);
            let sheet = board([x - 0.5 * w + 0.022, 0.001, 0.022 - half.y], [x + 0.5 * w - 0.022, 0.012, half.y - 0.022], 0.0005);
            b.part(object, &format!("sheet_{}", k + 1), sheet, finish);
        }
    }

    fn tray(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let half = 0.5 * self.size;
        let reach = if self.panels > 1 { 0.45 * self.panel_width() } else { 0.8 * half.x };
        let z = 0.004 - half.y;
        let tray = board([-reach, 0.0195, z], [reach, 0.085, z + 0.004], 0.001).with(board(
            [-reach, 0.0812, z + 0.0042],
            [reach, 0.085, z + 0.014],
            0.001,
        ));
        b.part(object, "tray", tray, Finish::Aluminium);
        let white = self.sheet == BoardSheet::White;
        for k in 0..5u8 {
            let x = reach * rng.range(-0.2, 0.2) + 0.17 * (f32::from(k) - 2.0);
            if x.abs() > reach - 0.1 || rng.below(4) == 0 {
                continue;
            }
            let (radius, length) = if white { (0.009, 0.125) } else { (0.005, rng.range(0.03, 0.08)) };
            let stick =
                cylinder(radius, length, 12).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(x - 0.5 * length, 0.05, z + 0.0042 + radius));
            let finish = if white { [Finish::Plastic(k), Finish::BlackPlastic][usize::from(k % 2)] } else { Finish::Paper };
            b.part(object, &format!("pen_{}", k + 1), stick, finish);
        }
        let sponge = rounded_box(Vec3::new(0.13, 0.05, 0.032), 0.006, 2).moved(Vec3::new(0.86 * reach - 0.06, 0.05, z + 0.0204));
        b.part(object, "sponge", sponge, if white { Finish::BlackPlastic } else { Finish::Accent(0) });
    }

    /// Lines of writing, sums and a drawing, on all panels.
    fn writing(&self, rng: &mut Rng) -> Mesh {
        let (w, h) = (self.panel_width(), self.size.y);
        let thick = if self.sheet == BoardSheet::White { 0.0019 } else { 0.003 };
        let mut strokes = Vec::new();
        for panel in 0..self.panels {
            let x = w * (panel as f32 - 0.5 * (self.panels - 1) as f32);
            // As it is seen, +x is to the left.
            let at = |u: f32, v: f32| Vec3::new(x - u, SHEET, v);
            let text = 0.5 * w - 0.08;
            let columns = if w > 1.9 { 2 } else { 1 };
            for column in 0..columns {
                let (from, to) =
                    (-text + 2.0 * text * column as f32 / columns as f32, -text + 2.0 * text * (column as f32 + 0.86) / columns as f32);
                if rng.below(4) == 0 && !self.menu {
                    figure(&mut strokes, &at, 0.5 * (from + to), rng.range(0.1, 0.25) * h, thick, rng);
                    continue;
                }
                let lines = 2 + rng.below(if self.menu { 5 } else { 4 });
                let size = if self.menu { 0.026 } else { rng.range(0.03, 0.055) };
                for line in 0..lines {
                    let v = 0.5 * h - 0.14 - (3.4 * size) * line as f32;
                    if v < 0.16 - 0.5 * h {
                        break;
                    }
                    write(&mut strokes, &at, [from, from + (to - from) * rng.range(0.45, 1.0)], v, size, thick, rng);
                    if line == 0 && rng.below(2) == 0 {
                        let end = from + 0.5 * (to - from);
                        strokes.push(tube(&[at(from, v - 1.3 * size), at(end, v - 1.25 * size)], thick, 5));
                    }
                }
            }
        }
        all(strokes)
    }
}

/// A line of words: each letter is a stroke of its own height and turn.
fn write(strokes: &mut Vec<Mesh>, at: &dyn Fn(f32, f32) -> Vec3, [from, to]: [f32; 2], v: f32, size: f32, thick: f32, rng: &mut Rng) {
    let mut u = from;
    while u < to {
        let letters = 2 + rng.below(7);
        let mut path = Vec::new();
        for letter in 0..=3 * letters {
            let high = match (letter % 3, rng.below(5)) {
                (1, 0) => 1.7,
                (1, _) => 1.0,
                (2, 0) => -0.6,
                _ => 0.0,
            };
            let wobble = 0.12 * rng.range(-1.0, 1.0);
            path.push(at(u + size * (0.26 * letter as f32 + wobble), v + size * (high + wobble)));
        }
        u += size * 0.26 * (3 * letters) as f32 + 0.9 * size;
        if u > to + 4.0 * size {
            break;
        }
        strokes.push(tube(&path, thick, 4));
    }
}

/// A triangle, a circle, or axes with a curve.
fn figure(strokes: &mut Vec<Mesh>, at: &dyn Fn(f32, f32) -> Vec3, u: f32, r: f32, thick: f32, rng: &mut Rng) {
    let line = |points: Vec<(f32, f32)>| tube(&points.into_iter().map(|(x, y)| at(u + x, y)).collect::<Vec<_>>(), thick, 5);
    match rng.below(3) {
        0 => {
            let top = rng.range(-0.5, 0.5) * r;
            strokes.push(line(vec![(-r, -r), (1.2 * r, -r)]));
            strokes.push(line(vec![(1.2 * r, -r), (top, r)]));
            strokes.push(line(vec![(top, r), (-r, -r)]));
            strokes.push(line(vec![(top, r), (top, -r)]));
        }
        1 => {
            strokes.push(line(
                (0..=40)
                    .map(|k| {
                        let a = TAU * k as f32 / 40.0;
                        (r * a.cos(), r * a.sin())
                    })
                    .collect(),
            ));
            strokes.push(line(vec![(0.0, 0.0), (0.8 * r, 0.6 * r)]));
        }
        _ => {
            strokes.push(line(vec![(-r, -r), (1.4 * r, -r)]));
            strokes.push(line(vec![(-r, -r), (-r, 1.1 * r)]));
            let bend = rng.range(0.6, 2.0);
            strokes.push(line(
                (0..=24)
                    .map(|k| {
                        let t = k as f32 / 24.0;
                        (-r + 2.2 * r * t, -r + 1.9 * r * t.powf(bend))
                    })
                    .collect(),
            ));
        }
    }
}

impl Furniture for ClassBoard {
    fn random(rng: &mut Rng) -> Self {
        let panels = [1, 1, 3][rng.below(3)];
        let size = Vec2::new(if panels > 1 { rng.range(3.2, 4.0) } else { rng.range(1.8, 3.2) }, rng.range(1.0, 1.25));
        Self {
            size,
            sheet: [BoardSheet::White, BoardSheet::White, BoardSheet::Green, BoardSheet::Black][rng.below(4)],
            panels,
            menu: false,
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, if self.menu { 0.022 } else { 0.087 }, self.size.y)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("class_board", Class::Whiteboard, pose);
        self.sheets(b, &object, rng);
        if !self.menu {
            self.tray(b, &object, rng);
        }
        let ink = match self.sheet {
            BoardSheet::White => [Finish::BlackPlastic, Finish::Plastic(2), Finish::Plastic(0)][rng.below(3)],
            BoardSheet::Green | BoardSheet::Black => Finish::Paper,
        };
        b.part(&object, "writing", self.writing(rng), ink);
        if self.panels > 1 {
            let hinges = [-0.5f32, 0.5]
                .map(|k| to_front(cylinder(0.008, 0.006, 12)).moved(Vec3::new(k * self.panel_width(), 0.0195, 0.3 * self.size.y)));
            b.part(&object, "hinges", all(hinges), Finish::Steel);
        }
    }
}
