//! Chairs of bent rods and tubes, class chair: bentwood with a round seat, after the coffee house chairs of the 19th century, 42 × 50 cm and
//! 88 cm high; and steel tube without rear legs, after those of the 1920s, 46 × 55 cm and 82 cm high.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, turned, wire};
use crate::pieces::seating::upright;
use crate::pieces::{grained, standing};
use crate::shape::{Reshape, padded_box, rounded_box, rounded_loop, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Height of a seat, metres.
const SEAT: f32 = 0.455;

/// A chair of bent wooden rods with a round seat.
#[derive(Clone, Copy, Debug)]
pub struct Bentwood {
    /// Finish of the frame.
    pub finish: Finish,
    /// The seat is woven of cane instead of a board.
    pub woven: bool,
}

impl Bentwood {
    /// Size of the box around it.
    pub const SIZE: Vec3 = Vec3::new(0.5, 0.54, 0.91);

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let r = 0.2;
        let ring = [[0.0, SEAT - 0.04], [r - 0.008, SEAT - 0.04], [r, SEAT - 0.032], [r, SEAT - 0.01], [r - 0.01, SEAT - 0.002]];
        let rim = turned(&[&ring[..], &[[r - 0.035, SEAT - 0.006], [r - 0.035, SEAT - 0.012], [0.0, SEAT - 0.012]]].concat(), 48);
        let place = |mesh: enfilade_geometry::Mesh| mesh.moved(Vec3::new(0.0, 0.01, 0.0));
        b.part(&chair, "seat_ring", grained(place(rim), rng), self.finish);
        let q = r - 0.036;
        let panel = turned(&[[0.0, SEAT - 0.013], [q, SEAT - 0.013], [q, SEAT - 0.009], [0.5 * q, SEAT - 0.007], [0.0, SEAT - 0.006]], 40);
        b.part(&chair, "seat", place(panel), if self.woven { Finish::Wicker } else { self.finish });
        let mut frame = Vec::new();
        for s in [-1.0f32, 1.0] {
            let front = [Vec3::new(s * 0.17, 0.185, 0.0), Vec3::new(s * 0.148, 0.15, 0.3), Vec3::new(s * 0.135, 0.13, SEAT - 0.03)];
            frame.push(standing(tube(&front, 0.0145, 14)));
        }
        // The rear legs and the back are one rod.
        let half = [[0.175, -0.21, 0.0], [0.158, -0.165, 0.3], [0.165, -0.135, SEAT - 0.02], [0.19, -0.175, 0.66], [0.15, -0.225, 0.83]];
        let mut path: Vec<[f32; 3]> = half.to_vec();
        path.push([0.0, -0.24, 0.882]);
        path.extend(half.iter().rev().map(|[x, y, z]| [-x, *y, *z]));
        frame.push(standing(wire(&path, 0.0145, 14)));
        let inner = [[0.085, -0.165, SEAT - 0.02], [0.1, -0.175, 0.6], [0.075, -0.2, 0.72], [0.0, -0.212, 0.77]];
        let mut path: Vec<[f32; 3]> = inner.to_vec();
        path.extend(inner.iter().rev().skip(1).map(|[x, y, z]| [-x, *y, *z]));
        frame.push(wire(&path, 0.009, 12));
        // The inner hoop is fixed to the outer one by two short pieces.
        frame.extend([-1.0f32, 1.0].map(|s| rod([s * 0.095, -0.181, 0.63], [s * 0.188, -0.171, 0.645], 0.006, 8)));
        let brace = tube(&rounded_loop(0.43, 0.43, 0.2149, 14), 0.009, 10).moved(Vec3::new(0.0, -0.01, 0.235));
        frame.push(brace);
        b.part(&chair, "frame", grained(all(frame), rng), self.finish);
    }
}

/// A chair whose seat is carried by the front legs alone, of steel tube.
#[derive(Clone, Copy, Debug)]
pub struct Cantilever {
    /// Finish of the tube.
    pub frame: Finish,
    /// Finish of seat and back: cane in wooden frames, or padding.
    pub cover: Finish,
}

impl Cantilever {
    /// Size of the box around it.
    pub const SIZE: Vec3 = Vec3::new(0.48, 0.56, 0.85);

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let (x, r) = (0.215, 0.0115);
        let side = [[-0.245, 0.82], [-0.2, 0.56], [-0.165, 0.452], [-0.08, 0.424], [0.16, 0.432], [0.232, 0.4], [0.245, 0.33]];
        let lower = [[0.245, 0.09], [0.23, 0.028], [0.16, r], [-0.1, r], [-0.245, r]];
        let path: Vec<[f32; 2]> = side.into_iter().chain(lower).collect();
        let smooth: Vec<[f32; 3]> = path.iter().map(|[y, z]| [x, *y, *z]).collect();
        let tubes = [-1.0f32, 1.0].map(|s| {
            let points: Vec<[f32; 3]> = smooth.iter().map(|[x, y, z]| [s * x, *y, *z]).collect();
            standing(wire(&points, r, 12))
        });
        let bars = [rod([-x, -0.245, r], [x, -0.245, r], r, 12), rod([-x, 0.05, 0.426], [x, 0.05, 0.426], 0.008, 10)];
        b.part(&chair, "frame", all(tubes.into_iter().chain(bars)), self.frame);
        let on_back = |p: Vec3| {
            let t = (p.z - 0.56) / 0.26;
            Vec3::new(p.x, p.y - 0.2 - 0.045 * t + 0.35 * p.x * p.x, p.z)
        };
        if self.cover == Finish::Wicker {
            let seat = rounded_box(Vec3::new(0.46, 0.4, 0.024), 0.009, 3).moved(Vec3::new(0.0, 0.03, 0.4495));
            b.part(&chair, "seat_frame", grained(seat, rng), Finish::Wood);
            let cane = rounded_box(Vec3::new(0.38, 0.32, 0.004), 0.001, 1).moved(Vec3::new(0.0, 0.03, 0.4625));
            b.part(&chair, "seat", cane, self.cover);
            let panel = |w: f32, h: f32, d: f32| crate::shape::bendable_box(Vec3::new(w, d, h), 0.3 * d, [10, 1, 3]).moved(Vec3::Z * 0.71);
            let back = panel(0.45, 0.2, 0.022).deformed(on_back).smoothed(40.0);
            b.part(&chair, "back_frame", grained(back, rng), Finish::Wood);
            b.part(&chair, "back", panel(0.37, 0.13, 0.027).deformed(on_back).smoothed(40.0), self.cover);
            return;
        }
        let offset = Vec2::splat(rng.next_f32());
        let seat = padded_box(Vec3::new(0.45, 0.41, 0.036), 0.016, 0.008).uv_moved(offset);
        b.part(&chair, "seat", seat.moved(Vec3::new(0.0, 0.03, 0.452)), self.cover);
        let back = upright(padded_box(Vec3::new(0.45, 0.25, 0.03), 0.013, 0.004)).uv_moved(offset);
        let back = back.moved(Vec3::Z * 0.705).deformed(on_back).smoothed(60.0);
        b.part(&chair, "back", back, self.cover);
    }
}
