//! Computers and what belongs to them: monitors of 54 to 80 cm, keyboards, mice, laptops of 30 to 36 cm, printers. Screens show a picture
//! where they are on; the person is at +y.
//!
//! All are of class other prop, as in the 40 classes of the NYU labels: `television` is for televisions.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, picture, rounded_rectangle, wire};
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, bevelled_box, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A monitor on its foot.
#[derive(Clone, Copy, Debug)]
pub struct Monitor {
    /// Width of the panel.
    pub width: f32,
    /// Width over height of the panel.
    pub aspect: f32,
    /// What it shows; `None` is off.
    pub shows: Option<u8>,
    /// Foot and back are of aluminium instead of black plastic.
    pub silver: bool,
}

impl Furniture for Monitor {
    fn random(rng: &mut Rng) -> Self {
        let (width, aspect) = [(0.54, 16.0 / 9.0), (0.61, 16.0 / 9.0), (0.80, 21.0 / 9.0)][rng.below(3)];
        Self { width, aspect, shows: (rng.below(3) > 0).then(|| rng.below(4) as u8), silver: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, 0.20, 0.13 + self.width / self.aspect)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let monitor = b.object("monitor", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let body = if self.silver { Finish::Aluminium } else { Finish::BlackPlastic };
        let (w, h) = (self.width, self.width / self.aspect);
        let z = 0.125 + 0.5 * h;
        b.part(&monitor, "panel", rounded_box(Vec3::new(w, 0.022, h), 0.005, 2).moved(Vec3::new(0.0, 0.0, z)), Finish::BlackPlastic);
        b.part(&monitor, "back", rounded_box(Vec3::new(0.6 * w, 0.03, 0.6 * h), 0.012, 3).moved(Vec3::new(0.0, -0.022, z)), body);
        let screen = picture(w - 0.016, h - 0.026).moved(Vec3::new(0.0, 0.0115, z + 0.003));
        b.part(&monitor, "screen", screen, self.shows.map_or(Finish::Screen, Finish::ScreenOn));
        let foot = cut_out(&rounded_rectangle(0.4 * w, 0.18, 0.02, 5), 0.008, 0.002);
        b.part(&monitor, "foot", foot.moved(Vec3::new(0.0, -0.005, 0.0)), body);
        b.part(&monitor, "neck", board([-0.03, -0.05, 0.0078], [0.03, -0.036, z + 0.03], 0.003), body);
    }
}

/// A keyboard, with or without its number block.
#[derive(Clone, Copy, Debug)]
pub struct Keyboard {
    /// Columns of keys.
    pub columns: usize,
    /// Keys are white instead of black.
    pub white: bool,
}

/// From one key to the next, metres: 19 mm is usual.
const KEY: f32 = 0.019;
/// Width of the edge around the keys, metres.
const EDGE: f32 = 0.007;

impl Furniture for Keyboard {
    fn random(rng: &mut Rng) -> Self {
        Self { columns: [15, 22][rng.below(2)], white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.columns as f32 * KEY + 2.0 * EDGE, 6.0 * KEY + 2.0 * EDGE, 0.022)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let keyboard = b.object("keyboard", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (w, d) = (self.columns as f32 * KEY + 2.0 * EDGE, 6.0 * KEY + 2.0 * EDGE);
        let tilt = |mesh: Mesh| {
            mesh.deformed(|p| Vec3::new(p.x, p.y, p.z + 0.05 * (0.5 * d - p.y) * (p.z / 0.012).clamp(0.0, 1.0))).smoothed(30.0)
        };
        let body = cut_out(&rounded_rectangle(w, d, 0.008, 4), 0.010, 0.002);
        b.part(&keyboard, "body", tilt(body), if self.white { Finish::Aluminium } else { Finish::BlackPlastic });
        let mut keys = Vec::new();
        for row in 0..6 {
            let y = 0.5 * d - EDGE - KEY * (row as f32 + 0.5);
            let mut column = 0;
            while column < self.columns {
                // The space bar, and wide keys at the ends of the rows.
                let wide = match (row, column) {
                    (0, 4) => 6,
                    (1..=3, 0 | 13) => 2,
                    _ => 1,
                };
                let wide = wide.min(self.columns - column);
                let x = 0.5 * w - EDGE - KEY * (column as f32 + 0.5 * wide as f32);
                keys.push(bevelled_box(Vec3::new(wide as f32 * KEY - 0.0025, KEY - 0.0025, 0.006), 0.0012).moved(Vec3::new(x, y, 0.0115)));
                column += wide;
            }
        }
        b.part(&keyboard, "keys", tilt(all(keys)), if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic });
    }
}

/// A mouse on its pad or the bare desk.
#[derive(Clone, Copy, Debug)]
pub struct Mouse {
    /// A pad is under the mouse.
    pub pad: bool,
    /// White instead of black.
    pub white: bool,
}

impl Furniture for Mouse {
    fn random(rng: &mut Rng) -> Self {
        Self { pad: rng.below(2) == 0, white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        if self.pad { Vec3::new(0.23, 0.19, 0.042) } else { Vec3::new(0.066, 0.112, 0.039) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let lift = if self.pad { 0.0031 } else { 0.0 };
        if self.pad {
            let pad = b.object("mouse_pad", Class::OtherProp, pose);
            b.part(
                &pad,
                "mat",
                cut_out(&rounded_rectangle(0.23, 0.19, 0.01, 4), 0.003, 0.0008).moved(Vec3::new(0.0, 0.0, CONTACT)),
                Finish::Rubber,
            );
        }
        let mouse = b.object(
            "mouse",
            Class::OtherProp,
            on(pose, Vec3::new(0.0, 0.0, lift + CONTACT), if self.pad { rng.range(-0.3, 0.3) } else { 0.0 }),
        );
        let body = rounded_box(Vec3::new(0.062, 0.108, 0.05), 0.024, 6)
            .deformed(|p| {
                let hump = 1.0 - 0.5 * ((p.y - 0.012) / 0.06).powi(2);
                Vec3::new(p.x * (1.0 - 0.08 * (p.y / 0.054)), p.y, if p.z > 0.0 { p.z * hump.max(0.2) * 1.4 } else { p.z * 0.1 } + 0.0025)
            })
            .smoothed(60.0);
        b.part(&mouse, "body", body, if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic });
        let wheel = cylinder(0.009, 0.007, 18).turned(Vec3::Y, std::f32::consts::FRAC_PI_2).moved(Vec3::new(-0.0035, -0.03, 0.0265));
        b.part(&mouse, "wheel", wheel, Finish::Rubber);
    }
}

/// An open laptop.
#[derive(Clone, Copy, Debug)]
pub struct Laptop {
    /// Width of base and lid.
    pub width: f32,
    /// Angle between base and lid, radians.
    pub open_rad: f32,
    /// What it shows; `None` is off.
    pub shows: Option<u8>,
    /// Aluminium instead of black plastic.
    pub silver: bool,
}

impl Furniture for Laptop {
    fn random(rng: &mut Rng) -> Self {
        Self {
            width: rng.range(0.3, 0.36),
            open_rad: rng.range(1.75, 2.05),
            shows: (rng.below(3) > 0).then(|| rng.below(4) as u8),
            silver: rng.below(3) > 0,
        }
    }

    fn size(&self) -> Vec3 {
        let depth = 0.7 * self.width;
        let behind = -depth * self.open_rad.cos();
        Vec3::new(self.width, depth + 2.0 * behind.max(0.0) + 0.012, 0.018 + depth * self.open_rad.sin())
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let laptop = b.object("laptop", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let body = if self.silver { Finish::Aluminium } else { Finish::BlackPlastic };
        let (w, d, t) = (self.width, 0.7 * self.width, 0.014);
        b.part(&laptop, "base", cut_out(&rounded_rectangle(w, d, 0.01, 5), t, 0.002), body);
        let (columns, rows) = (14, 5);
        let pitch = (w - 0.05) / columns as f32;
        let keys = (0..columns * rows).map(|k| {
            let (column, row) = ((k % columns) as f32, (k / columns) as f32);
            let at = Vec3::new((column - 0.5 * (columns - 1) as f32) * pitch, -0.5 * d + 0.035 + (row + 0.5) * pitch, t + 0.0003);
            bevelled_box(Vec3::new(pitch - 0.003, pitch - 0.003, 0.0022), 0.0007).moved(at)
        });
        b.part(&laptop, "keys", all(keys), Finish::BlackPlastic);
        let touch = board([-0.055, 0.5 * d - 0.085, t - 0.0005], [0.055, 0.5 * d - 0.012, t + 0.0003], 0.0003);
        b.part(&laptop, "touch_pad", touch, body);
        // The lid stands on the rear edge; in its own space it is upright and faces +y.
        let hinge = DAffine3::from_translation(Vec3::new(0.0, -0.5 * d + 0.004, t + 0.001).as_dvec3())
            * DAffine3::from_rotation_x(f64::from(self.open_rad - std::f32::consts::FRAC_PI_2));
        let lid = crate::pieces::form::to_front(cut_out(&rounded_rectangle(w, d - 0.004, 0.01, 5), 0.006, 0.0015)).moved(Vec3::new(
            0.0,
            -0.003,
            0.5 * d,
        ));
        b.part_at(&laptop, "lid", lid, hinge, body);
        let bezel = board([-0.5 * w + 0.003, 0.0028, 0.012], [0.5 * w - 0.003, 0.0036, d - 0.006], 0.0003);
        b.part_at(&laptop, "bezel", bezel, hinge, Finish::BlackPlastic);
        let screen = picture(w - 0.02, d - 0.035).moved(Vec3::new(0.0, 0.0038, 0.5 * d + 0.005));
        b.part_at(&laptop, "screen", screen, hinge, self.shows.map_or(Finish::Screen, Finish::ScreenOn));
    }
}

/// A printer with paper in its tray.
#[derive(Clone, Copy, Debug)]
pub struct Printer {
    /// White instead of black.
    pub white: bool,
}

impl Furniture for Printer {
    fn random(rng: &mut Rng) -> Self {
        Self { white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.43, 0.46, 0.28)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let printer = b.object("printer", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let body = if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic };
        b.part(&printer, "body", rounded_box(Vec3::new(0.43, 0.34, 0.12), 0.018, 3).moved(Vec3::new(0.0, -0.02, 0.06)), body);
        b.part(&printer, "scanner", rounded_box(Vec3::new(0.42, 0.33, 0.05), 0.012, 3).moved(Vec3::new(0.0, -0.02, 0.146)), body);
        let panel = rounded_box(Vec3::new(0.2, 0.012, 0.05), 0.003, 2).turned(Vec3::X, -0.5).moved(Vec3::new(0.09, 0.15, 0.115));
        b.part(&printer, "panel", panel, Finish::GlossBlack);
        b.part(&printer, "tray", board([-0.13, 0.10, 0.028], [0.13, 0.23, 0.034], 0.001), Finish::BlackPlastic);
        b.part(&printer, "slot", board([-0.14, 0.148, 0.03], [0.14, 0.1508, 0.075], 0.0005), Finish::Soil);
        let feed = rounded_box(Vec3::new(0.25, 0.008, 0.14), 0.003, 2).turned(Vec3::X, 0.4).moved(Vec3::new(0.0, -0.2, 0.2));
        b.part(&printer, "feed", feed, body);
        let sheets = b.object("paper", Class::Paper, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        b.part(&sheets, "printed", board([-0.105, 0.12, 0.0345], [0.105, 0.225, 0.0375], 0.0004), Finish::Paper);
        b.part(
            &sheets,
            "blank",
            bevelled_box(Vec3::new(0.21, 0.004, 0.15), 0.0006).turned(Vec3::X, 0.4).moved(Vec3::new(0.0, -0.192, 0.205)),
            Finish::Paper,
        );
        let cable = wire(&[[-0.12, -0.185, 0.03], [-0.12, -0.21, 0.025], [-0.14, -0.225, 0.004]], 0.0035, 8);
        b.part(&printer, "cable", cable, Finish::BlackPlastic);
    }
}
