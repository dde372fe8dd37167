//! Taps, mixers, showers and traps, as parts of the tub, shower or basin that has them. Spouts reach to +y; what is on a wall has its
//! origin on the wall's face. One metal is drawn for all fittings of an object.

use crate::builder::{Builder, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front, turned, wire};
use crate::shape::{Reshape, rounded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// Forms of taps that stand beside or behind a basin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TapForm {
    /// A slanting spout with a lever on top.
    Lever,
    /// A high round arc with a lever at its side.
    Arc,
    /// A square spout.
    Square,
}

/// Angle by which a lever opens a tap, radians.
pub const LIFT: f64 = 0.44;

/// Finish of taps: chrome three times in five.
pub fn fittings(rng: &mut Rng) -> Finish {
    [Finish::Chrome, Finish::Chrome, Finish::Chrome, Finish::BlackMetal, Finish::Brass][rng.below(5)]
}

impl TapForm {
    /// A random form.
    pub fn random(rng: &mut Rng) -> Self {
        [Self::Lever, Self::Arc, Self::Square][rng.below(3)]
    }

    /// A tap that stands on the origin, without its lever, the lever, and how that moves; the spout reaches `out` to the front, its mouth
    /// `rise` up.
    pub fn pieces(self, out: f32, rise: f32) -> (Mesh, Mesh, Joint) {
        let base = cylinder(0.025, 0.008, 28);
        let lever = |at: Vec3, tilt: f32| {
            rounded_box(Vec3::new(0.014, 0.085, 0.008), 0.0035, 3).moved(Vec3::new(0.0, 0.03, 0.0)).turned(Vec3::X, tilt).moved(at)
        };
        match self {
            Self::Lever => {
                let column = turned(
                    &[[0.0, 0.0], [0.022, 0.0], [0.020, rise + 0.02], [0.021, rise + 0.045], [0.012, rise + 0.05], [0.0, rise + 0.05]],
                    28,
                );
                let spout = tube(&[Vec3::new(0.0, 0.0, 0.7 * rise), Vec3::new(0.0, out, rise)], 0.0115, 18);
                let aerator = rod([0.0, out - 0.012, rise - 0.016], [0.0, out - 0.012, rise + 0.002], 0.0095, 16);
                let at = Vec3::new(0.0, 0.0, rise + 0.053);
                (all([base, column, spout, aerator]), lever(at, 0.25), Joint::tap(at.y, at.z, LIFT, true))
            }
            Self::Arc => {
                let r = 0.5 * out;
                let top = rise + 0.06;
                let mut path = vec![Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 0.0, top)];
                path.extend((1..=16).map(|k| {
                    let (sin, cos) = (PI * k as f32 / 16.0).sin_cos();
                    Vec3::new(0.0, r - r * cos, top + r * sin)
                }));
                path.push(Vec3::new(0.0, out, rise));
                let column = cylinder(0.021, 0.09, 28);
                let side = rod([0.0, 0.0, 0.06], [0.045, 0.0, 0.06], 0.012, 18);
                let pin = rod([0.04, 0.0, 0.06], [0.048, 0.02, 0.12], 0.0035, 10);
                (all([base, column, tube(&path, 0.0105, 18)]), side.with(pin), Joint::tap(0.0, 0.06, LIFT, false))
            }
            Self::Square => {
                let column = rounded_box(Vec3::new(0.04, 0.04, rise + 0.03), 0.003, 2).moved(Vec3::new(0.0, 0.0, 0.5 * (rise + 0.03)));
                let spout = rounded_box(Vec3::new(0.034, out + 0.02, 0.016), 0.003, 2).moved(Vec3::new(0.0, 0.5 * out, rise + 0.012));
                let at = Vec3::new(0.0, 0.0, rise + 0.036);
                (all([base, column, spout]), lever(at, 0.1), Joint::tap(at.y, at.z, LIFT, true))
            }
        }
    }
}

/// Adds a tap at a place in the object's space: its body, lever and joint. All is one part unless things have joints.
pub fn stand(b: &mut Builder, object: &Object, name: &str, (body, lever, joint): (Mesh, Mesh, Joint), at: Vec3, metal: Finish) {
    if !b.has_joints() {
        return b.part(object, name, body.with(lever).moved(at), metal);
    }
    b.part(object, name, body.moved(at), metal);
    b.part(object, &format!("{name}_lever"), lever.moved(at), metal);
    b.joint(object, &format!("{name}_lever"), &joint.moved(at), [b.part_count() - 1]);
}

/// A mixer on the wall with a spout below and a hand shower on its hose; its origin is on the wall's face.
pub fn wall_mixer(b: &mut Builder, object: &Object, at: Vec3, metal: Finish) {
    // Distance of the mixer's axis from the wall.
    let out = 0.055;
    let body = rod([-0.13, out, 0.0], [0.13, out, 0.0], 0.02, 22);
    let rosettes = [-0.075f32, 0.075].map(|x| {
        to_front(cylinder(0.032, 0.008, 28)).moved(Vec3::new(x, -0.001, 0.0)).with(rod([x, 0.006, 0.0], [x, out, 0.0], 0.013, 16))
    });
    let grips = [-1.0f32, 1.0].map(|s| rod([s * 0.128, out, 0.0], [s * 0.165, out, 0.0], 0.022, 22));
    b.part(object, "mixer", all([body].into_iter().chain(rosettes).chain(grips)).moved(at), metal);
}

/// A rail on the wall with a hand shower, its hose, and, if `rain`, a rain shower above; the mixer is at `at` on the wall's face.
pub fn shower_set(b: &mut Builder, object: &Object, at: Vec3, rain: bool, metal: Finish) {
    wall_mixer(b, object, at, metal);
    let top = if rain { 2.12 } else { 1.85 } - at.z;
    // Distance of the rail from the wall.
    let out = 0.06;
    let rail = rod([0.0, out, 0.02], [0.0, out, top], 0.0105, 16);
    let holder = all([
        rod([0.0, -0.001, top - 0.12], [0.0, out, top - 0.12], 0.009, 12),
        rounded_box(Vec3::new(0.03, 0.05, 0.04), 0.006, 2).moved(Vec3::new(0.0, 0.075, 0.62)),
    ]);
    b.part(object, "rail", rail.with(holder).moved(at), metal);
    let head = turned(&[[0.0, 0.0], [0.05, 0.0], [0.052, 0.006], [0.045, 0.016], [0.012, 0.026], [0.0, 0.027]], 32).turned(Vec3::X, 0.5);
    let grip = rod([0.0, 0.085, 0.52], [0.0, 0.125, 0.76], 0.0105, 14);
    b.part(object, "hand_shower", grip.with(head.moved(Vec3::new(0.0, 0.14, 0.765))).moved(at), metal);
    let hose =
        [[0.03, 0.055, -0.02], [0.07, 0.07, -0.35], [0.10, 0.085, -0.52], [0.08, 0.10, -0.35], [0.02, 0.095, 0.2], [0.0, 0.085, 0.52]];
    b.part(object, "hose", wire(&hose, 0.0065, 10).moved(at), metal);
    if rain {
        let arm = wire(
            &[
                [0.0, out, top - 0.001],
                [0.0, 0.075, top + 0.03],
                [0.0, 0.13, top + 0.045],
                [0.0, 0.36, top + 0.045],
                [0.0, 0.385, top + 0.03],
            ],
            0.010,
            14,
        );
        let disk = turned(&[[0.0, 0.0], [0.122, 0.0], [0.125, 0.004], [0.122, 0.008], [0.03, 0.012], [0.014, 0.03], [0.0, 0.03]], 48);
        b.part(object, "rain_shower", arm.with(disk.moved(Vec3::new(0.0, 0.39, top + 0.004))).moved(at), metal);
    }
}

/// A bottle trap below a wall-hung basin and its pipe to the wall at y = `wall`; the waste is at the origin.
pub fn trap(wall: f32) -> Mesh {
    let bottle = turned(&[[0.0, -0.24], [0.026, -0.24], [0.028, -0.235], [0.028, -0.15], [0.018, -0.14], [0.016, 0.0], [0.0, 0.0]], 24);
    let level = -0.17;
    let pipe = rod([0.0, 0.0, level], [0.0, wall, level], 0.016, 18);
    let rosette = turned(&[[0.0, 0.0], [0.036, 0.0], [0.03, 0.012], [0.0, 0.012]], 24).turned(Vec3::X, -FRAC_PI_2);
    all([bottle, pipe, rosette.moved(Vec3::new(0.0, wall - 0.001, level))])
}
