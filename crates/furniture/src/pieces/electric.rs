//! Light switches with one or two rockers and sockets with two round pins (CEE 7/3), one to three in a frame, all in frames of the size
//! that is usual after DIN 49075. White plastic, with pins of black plastic and clips of steel; class other prop. The origin is the middle
//! of the back, on the wall's face.

use super::form::{all, cylinder, plate_with_holes, to_front};
use super::{Furniture, board};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, bevelled_box, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Outer edge of a frame of one, metres: usual after DIN 49075, as are the next two.
const FRAME: f32 = 0.081;
/// Between the middles of neighbours in one frame, metres.
const PITCH: f32 = 0.071;
/// Edge of a frame's opening, metres.
const INSERT: f32 = 0.055;
/// How far a frame protrudes from the wall, metres.
const THICKNESS: f32 = 0.009;
/// How far rockers are tipped, radians.
const TIP: f32 = 0.055;

/// A light switch on a wall; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct Switch {
    /// Rockers beside each other: one or two.
    pub rockers: usize,
}

/// Sockets on a wall, of the round sort with two pins (CEE 7/3), in one frame; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct Socket {
    /// Number of inserts, beside each other.
    pub count: usize,
}

/// Positions of the inserts of a frame along x.
fn places(count: usize) -> impl Iterator<Item = f32> {
    (0..count).map(move |k| PITCH * (k as f32 - 0.5 * (count - 1) as f32))
}

/// Adds the frame around `count` inserts.
fn frame(b: &mut Builder, object: &Object, count: usize) {
    let half = Vec2::new(0.5 * (FRAME + PITCH * (count - 1) as f32), 0.5 * FRAME);
    let inner = 0.5 * INSERT;
    let holes: Vec<[f32; 4]> = places(count).map(|x| [x - inner, x + inner, -inner, inner]).collect();
    let plate = plate_with_holes(-half, half, THICKNESS, 0.002, &holes).moved(Vec3::Z * THICKNESS);
    b.part(object, "frame", to_front(plate), Finish::WhitePlastic);
}

impl Furniture for Switch {
    fn random(rng: &mut Rng) -> Self {
        Self { rockers: if rng.below(4) == 0 { 2 } else { 1 } }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(FRAME, 0.014, FRAME)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let switch = b.object("switch", Class::OtherProp, pose);
        frame(b, &switch, 1);
        let half = 0.5 * INSERT - 0.0004;
        b.part(&switch, "insert", board([-half, 0.0005, -half], [half, 0.006, half], 0.0005), Finish::WhitePlastic);
        let width = (INSERT - 0.0015) / self.rockers as f32;
        let rockers = (0..self.rockers).map(|k| {
            let tip = if rng.below(2) == 0 { TIP } else { -TIP };
            let rocker = bevelled_box(Vec3::new(width - 0.0006, 0.005, INSERT - 0.0015), 0.0012).turned(Vec3::X, tip);
            rocker.moved(Vec3::new(width * (k as f32 - 0.5 * (self.rockers - 1) as f32), 0.009, 0.0))
        });
        b.part(&switch, "rockers", all(rockers), Finish::WhitePlastic);
    }
}

/// The insert of a socket: a square face with a round cup in it.
fn cup() -> Mesh {
    const N: usize = 48;
    // [radius, distance from the wall], metres; the square edge is around the first of them.
    const RINGS: [[f32; 2]; 5] = [[0.0215, THICKNESS], [0.0198, THICKNESS - 0.0012], [0.0195, 0.0015], [0.017, 0.001], [0.0, 0.001]];
    let half = 0.5 * INSERT - 0.0003;
    let point = |i: usize, j: usize| {
        let d = Vec2::from_angle(TAU * (i % N) as f32 / N as f32);
        let (p, y) = match j {
            0 => (d * half / d.abs().max_element(), 0.001),
            1 => (d * half / d.abs().max_element(), THICKNESS),
            j => (d * RINGS[j - 2][0], RINGS[j - 2][1]),
        };
        Vec3::new(p.x, y, -p.y)
    };
    grid(N, RINGS.len() + 1, point, |i, j| Vec2::new(i as f32 * 0.003, j as f32 * 0.005)).smoothed(30.0)
}

impl Furniture for Socket {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(3) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(FRAME + PITCH * (self.count - 1) as f32, THICKNESS, FRAME)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let socket = b.object("socket", Class::OtherProp, pose);
        frame(b, &socket, self.count);
        b.part(&socket, "cups", all(places(self.count).map(|x| cup().moved(Vec3::X * x))), Finish::WhitePlastic);
        let pins = places(self.count)
            .flat_map(|x| [-0.0095, 0.0095].map(|s| to_front(cylinder(0.0027, 0.001, 14)).moved(Vec3::new(x + s, 0.0006, 0.0))));
        b.part(&socket, "pins", all(pins), Finish::BlackPlastic);
        let clips = places(self.count)
            .flat_map(|x| [-0.0182, 0.0182].map(|z| bevelled_box(Vec3::new(0.005, 0.006, 0.0022), 0.0006).moved(Vec3::new(x, 0.0042, z))));
        b.part(&socket, "clips", all(clips), Finish::Steel);
    }
}
