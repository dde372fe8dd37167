//! Blinds before a window, class blinds, 70 to 130 × 120 to 150 cm: Venetian ones with slats of wood or metal, roller blinds, and Roman
//! blinds in flat folds, let down by any share of their height. They hang in the xz plane and face +y; the origin is the middle of their
//! back.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front, turned};
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, bevelled_box, grid, sphere};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A blind before a window; its origin is the middle of its back on the wall's face, or on the plane that it hangs before.
#[derive(Clone, Copy, Debug)]
pub struct Blind {
    /// Width of what it covers.
    pub width: f32,
    /// Height of what it covers, with the box.
    pub height: f32,
    /// Share by which it is lowered, on `[0,1]`.
    pub down: f32,
    /// Finish of the blind, and how it is drawn up.
    pub kind: BlindKind,
}

/// Kinds of blinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlindKind {
    /// Horizontal slats.
    Venetian {
        /// Angle of the slats, radians.
        tilt: f32,
        /// Wood instead of sheet metal.
        wood: bool,
    },
    /// One sheet on a roller.
    Roller,
    /// A sheet that is drawn up in flat folds.
    Roman,
}

impl BlindKind {
    /// Width and pitch of slats: 50 mm of wood, 25 mm of sheet metal.
    fn slats(wood: bool) -> [f32; 2] {
        if wood { [0.05, 0.044] } else { [0.025, 0.0215] }
    }
}

/// A slat about the origin along x: a flat board of wood, or an arched strip of metal.
fn slat(length: f32, width: f32, wood: bool) -> Mesh {
    if wood {
        return bevelled_box(Vec3::new(length, width, 0.0028), 0.001);
    }
    /// Height of the middle of a metal slat above its edges, metres: the arch keeps it straight.
    const ARCH: f32 = 0.0018;
    /// Half the thickness of the metal, metres.
    const SHEET: f32 = 0.0002;
    // The grid runs around the section: over the upper side from back to front, then back below.
    let point = |i: usize, j: usize| {
        let i = i % 10;
        let (t, side) = if i < 5 { (i as f32 / 4.0, 1.0) } else { ((9 - i) as f32 / 4.0, -1.0) };
        let u = 2.0 * t - 1.0;
        Vec3::new(length * (0.5 - j as f32), 0.5 * width * u, ARCH * (0.5 - u * u) + side * SHEET)
    };
    grid(10, 1, point, |i, j| Vec2::new(length * j as f32, 0.25 * width * i as f32)).smoothed(60.0)
}

impl Blind {
    fn venetian(&self, b: &mut Builder, object: &Object, tilt: f32, wood: bool) {
        let [deep, pitch] = BlindKind::slats(wood);
        let (rail, middle) = (deep + 0.01, 0.5 * deep + 0.009);
        let (top, w) = (0.5 * self.height - 0.8 * rail, self.width - 0.01);
        let slats = ((top + 0.5 * self.height - 0.03) / pitch) as usize;
        let open = (slats as f32 * self.down) as usize;
        let finish = if wood { Finish::Wood } else { Finish::CoatedWhite };
        let head = board([-0.5 * self.width, 0.004, top], [0.5 * self.width, 0.004 + rail, 0.5 * self.height], 0.002);
        b.part(object, "box", head, finish);
        let at = |z: f32| Vec3::new(0.0, middle, z);
        let slat = slat(w, deep, wood);
        let hung = (0..open).map(|k| slat.clone().turned(Vec3::X, tilt).moved(at(top - 0.6 * pitch - pitch * k as f32)));
        // The slats that are not lowered lie on each other on the bottom rail.
        let step = if wood { 0.0034 } else { 0.0014 };
        let low = top - 0.4 * pitch - pitch * open as f32;
        let packed = (open..slats).map(|k| slat.clone().moved(at(low - 0.004 - step * (k - open) as f32)));
        b.part(object, "slats", all(hung.chain(packed)), finish);
        let foot = low - 0.006 - step * (slats - open) as f32;
        b.part(object, "rail", bevelled_box(Vec3::new(w, deep, 0.012), 0.003).moved(at(foot - 0.006)), finish);
        let cords = [-0.5f32, 0.5].map(|s| {
            let x = s * (self.width - 0.3).max(0.5 * self.width);
            all([-0.53, 0.53].map(|side| rod([x, middle + side * deep, top + 0.004], [x, middle + side * deep, foot - 0.006], 0.0009, 5)))
        });
        b.part(object, "cords", all(cords), Finish::Paper);
        let (x, y) = (0.5 * self.width - 0.06, 0.004 + rail + 0.003);
        let wand = rod([x, y, top + 0.01], [x, y + 0.002, top - 0.4 * self.height], 0.0035, 6);
        b.part(object, "wand", wand, if wood { Finish::Wood } else { Finish::WhitePlastic });
    }

    fn roller(&self, b: &mut Builder, object: &Object, cloth: Finish) {
        let (top, w) = (0.5 * self.height - 0.0285, self.width - 0.03);
        let drop = self.down * (self.height - 0.06);
        let tube = cylinder(0.024, w, 24).turned(Vec3::Y, std::f32::consts::FRAC_PI_2).moved(Vec3::new(-0.5 * w, 0.034, top));
        b.part(object, "roller", tube, cloth);
        let cap = |s: f32| {
            board([s * (0.5 * w + 0.008) - 0.006, 0.0005, top - 0.028], [s * (0.5 * w + 0.008) + 0.006, 0.064, top + 0.028], 0.002)
        };
        b.part(object, "brackets", cap(-1.0).with(cap(1.0)), Finish::WhitePlastic);
        b.part(object, "sheet", board([-0.5 * w + 0.002, 0.0095, top - drop], [0.5 * w - 0.002, 0.0107, top + 0.002], 0.0004), cloth);
        b.part(
            object,
            "rail",
            board([-0.5 * w, 0.004, top - drop - 0.022], [0.5 * w, 0.016, top - drop + 0.001], 0.003),
            Finish::WhitePlastic,
        );
        let (x, y, pitch) = (0.5 * w + 0.005, 0.067, 0.012);
        let count = (0.6 * self.height / pitch) as usize;
        let beads = (0..count).map(|k| sphere(0.0022, 6).moved(Vec3::new(x, y, top - pitch * k as f32)));
        let cord = rod([x, y, top], [x, y, top - pitch * count as f32], 0.0006, 4);
        b.part(object, "chain", all(beads).with(cord), Finish::Chrome);
    }

    fn roman(&self, b: &mut Builder, object: &Object, cloth: Finish) {
        let (top, w) = (0.5 * self.height, self.width - 0.004);
        b.part(object, "batten", board([-0.5 * w, 0.001, top - 0.04], [0.5 * w, 0.02, top], 0.002), Finish::Wood);
        let drop = self.down.max(0.25) * self.height;
        let folds = ((self.height - drop) / 0.16) as usize;
        let (low, n) = (top - drop, 40 * (folds + 1));
        // A flat sheet, then folds that hang before each other at its lower end.
        let point = |i: usize, j: usize| {
            let (x, t) = (w * (0.5 - i as f32 / 12.0), j as f32 / n as f32);
            let (y, z) = if t < 0.5 || folds == 0 {
                let t = if folds == 0 { t } else { 2.0 * t };
                (0.022, top + (low - top) * t)
            } else {
                let s = (2.0 * t - 1.0) * folds as f32;
                let wave = 0.5 - 0.5 * (std::f32::consts::TAU * s).cos();
                (0.022 + 0.012 * s + 0.012 * wave, low + 0.075 * wave)
            };
            Vec3::new(x, y, z + 0.002 * (14.0 * x).sin() * t)
        };
        // u runs to −x and v downward, so that the sheet faces the room.
        let sheet = grid(12, n, point, |i, j| Vec2::new(i as f32 / 12.0 * w, j as f32 * 0.01)).smoothed(70.0);
        let rear = Mesh { triangles: sheet.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect(), ..sheet.clone() };
        let rear = rear.deformed(|p| p - Vec3::new(0.0, 0.0012, 0.0)).smoothed(70.0);
        b.part(object, "sheet", sheet.with(rear), cloth);
    }
}

impl Furniture for Blind {
    fn random(rng: &mut Rng) -> Self {
        let kind = match rng.below(4) {
            0 => BlindKind::Roller,
            1 => BlindKind::Roman,
            k => BlindKind::Venetian { tilt: rng.range(-0.9, 0.9), wood: k == 2 },
        };
        Self { width: rng.range(0.7, 1.3), height: rng.range(1.2, 1.5), down: rng.range(0.15, 1.0), kind }
    }

    fn size(&self) -> Vec3 {
        let depth = match self.kind {
            BlindKind::Venetian { wood, .. } => BlindKind::slats(wood)[0] + 0.023,
            BlindKind::Roller => 0.07,
            BlindKind::Roman => 0.05 + 0.012 * ((1.0 - self.down.max(0.25)) * self.height / 0.16),
        };
        Vec3::new(self.width, depth, self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("blind", Class::Blinds, pose);
        let cloth = [Finish::CurtainLinen, Finish::Accent(2), Finish::SheerCurtain, Finish::SheerCurtain][rng.below(4)];
        match self.kind {
            BlindKind::Venetian { tilt, wood } => self.venetian(b, &object, tilt, wood),
            BlindKind::Roller => self.roller(b, &object, cloth),
            BlindKind::Roman => self.roman(b, &object, cloth),
        }
        // Two clips hold the blind on the wall.
        let clip = turned(&[[0.0, 0.0], [0.012, 0.0], [0.012, 0.006], [0.0, 0.006]], 16);
        let clip = to_front(clip);
        let at = |s: f32| Vec3::new(s * 0.4 * self.width, 0.0, 0.5 * self.height - 0.022);
        b.part(&object, "clips", clip.clone().moved(at(-1.0)).with(clip.moved(at(1.0))), Finish::Steel);
    }
}
