//! Dining chairs, all of class chair and with a seat about 45 cm high: chairs with spindles after those of Windsor, upholstered chairs with
//! a straight or a tub back, and chairs with a moulded shell. Sizes are fixed for each kind; number of spindles, back, cloth and finishes
//! vary. The sitter looks to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, rod, wire};
use crate::pieces::{CONTACT, Furniture, grained, standing};
use crate::shape::{Reshape, grid, padded_box, rounded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// Height of a seat, metres: common seats are 44 to 47 cm high, for tables of 72 to 76 cm.
const SEAT: f32 = 0.455;

/// A chair with a bow or a comb of spindles for its back, after those of Windsor.
#[derive(Clone, Copy, Debug)]
pub struct SpindleChair {
    /// A bent bow around the spindles instead of a straight rail over them.
    pub bow: bool,
    /// Spindles in the back.
    pub spindles: usize,
    /// Finish of all of it.
    pub finish: Finish,
}

impl Furniture for SpindleChair {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer, Finish::BlackMetal][rng.below(4)];
        Self { bow: rng.below(2) == 0, spindles: 6 + rng.below(3), finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.46, 0.55, 0.92)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("spindle_chair", Class::Chair, pose);
        let half = 0.21;
        let seat = rounded_box(Vec3::new(2.0 * half, 2.0 * half, 0.034), 0.015, 3)
            .deformed(|p| {
                let saddle = 0.012 * (1.0 - (p.x / half).powi(2)).max(0.0) * (1.0 - (p.y / half).powi(2)).max(0.0);
                let round = 1.0 - 0.12 * (p.y / half).powi(2) * (p.x / half).abs().powi(2);
                Vec3::new(p.x * round * (1.0 + 0.1 * p.y), p.y * round, p.z - saddle)
            })
            .smoothed(40.0);
        b.part(&chair, "seat", grained(seat.moved(Vec3::new(0.0, 0.04, SEAT - 0.017)), rng), self.finish);
        let mut frame = Vec::new();
        for s in [-1.0f32, 1.0] {
            for (top, foot) in [([0.14, 0.17], [0.2, 0.235]), ([0.13, -0.1], [0.195, -0.24])] {
                let path = [Vec3::new(s * foot[0], foot[1], 0.0), Vec3::new(s * top[0], top[1], SEAT - 0.018)];
                frame.push(standing(tube(&path, 0.0145, 12)));
            }
            frame.push(rod([s * 0.175, 0.205, 0.2], [s * 0.17, -0.18, 0.2], 0.009, 10));
        }
        frame.push(rod([-0.172, 0.01, 0.2], [0.172, 0.01, 0.2], 0.009, 10));
        b.part(&chair, "legs", grained(all(frame), rng), self.finish);
        b.part(&chair, "back", grained(self.back(), rng), self.finish);
    }
}

impl SpindleChair {
    fn back(&self) -> Mesh {
        let (height, lean) = (0.43, 0.1);
        // A point of the back at t across (−1…1) and height z above the seat.
        let at = |t: f32, z: f32| {
            Vec3::new(t * (0.165 + 0.04 * z / height), -0.135 - lean * z / height - 0.025 * (1.0 - t * t), SEAT - 0.012 + z)
        };
        let top = |t: f32| if self.bow { height * (1.0 - t.abs().powi(4)).max(0.0).sqrt().sqrt() } else { height - 0.03 };
        let spindle = |k: usize| {
            let t = 0.82 * (2.0 * k as f32 / (self.spindles - 1) as f32 - 1.0);
            tube(&[at(t, 0.0), at(t, 0.5 * top(t)), at(t, top(t))], 0.0062, 8)
        };
        let spindles = all((0..self.spindles).map(spindle));
        if self.bow {
            let path: Vec<[f32; 3]> = (0..=16)
                .map(|k| {
                    let a = PI * (k as f32 / 16.0);
                    let (t, z) = (-a.cos().signum() * a.cos().abs().powf(0.5), height * a.sin().max(0.0).sqrt());
                    at(t, z).to_array()
                })
                .collect();
            return spindles.with(wire(&path, 0.0105, 12));
        }
        let rail = rounded_box(Vec3::new(0.42, 0.018, 0.075), 0.008, 3)
            .deformed(|p| {
                let t = (p.x / 0.21).clamp(-1.0, 1.0);
                let base = at(t, height);
                Vec3::new(base.x, base.y + p.y, base.z + p.z)
            })
            .smoothed(40.0);
        let posts = all([-1.0f32, 1.0].map(|s| tube(&[at(s * 0.97, 0.0), at(s * 0.97, 0.5 * height), at(s * 0.97, height)], 0.011, 10)));
        all([spindles, rail, posts])
    }
}

/// A padded chair on slim legs.
#[derive(Clone, Copy, Debug)]
pub struct UpholsteredChair {
    /// Finish of seat and back.
    pub cloth: Finish,
    /// Finish of the legs.
    pub legs: Finish,
    /// The back reaches around the sides.
    pub tub: bool,
}

impl Furniture for UpholsteredChair {
    fn random(rng: &mut Rng) -> Self {
        Self {
            cloth: [Finish::ArmchairCloth, Finish::Velvet, Finish::Leather, Finish::SofaCloth, Finish::Boucle][rng.below(5)],
            legs: [Finish::Wood, Finish::BlackMetal, Finish::DarkWood][rng.below(3)],
            tub: rng.below(2) == 0,
        }
    }

    fn size(&self) -> Vec3 {
        if self.tub { Vec3::new(0.62, 0.62, 0.82) } else { Vec3::new(0.48, 0.60, 0.90) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("upholstered_chair", Class::Chair, pose);
        let offset = Vec2::splat(rng.next_f32());
        let seat = padded_box(Vec3::new(0.46, 0.45, 0.085), 0.03, 0.014).uv_moved(offset);
        b.part(&chair, "seat", seat.moved(Vec3::new(0.0, 0.045, SEAT - 0.052)), self.cloth);
        let back = if self.tub { tub_back() } else { straight_back() };
        b.part(&chair, "back", back.uv_moved(offset), self.cloth);
        let mut legs = Vec::new();
        for s in [-1.0f32, 1.0] {
            for (top, foot) in [([0.18, 0.21], [0.205, 0.24]), ([0.17, -0.12], [0.2, -0.225])] {
                let path = [Vec3::new(s * foot[0], foot[1], 0.0), Vec3::new(s * top[0], top[1], SEAT - 0.088)];
                legs.push(standing(tube(&path, 0.0125, 12)));
            }
        }
        b.part(&chair, "legs", grained(all(legs), rng), self.legs);
    }
}

/// A padded board that leans back.
fn straight_back() -> Mesh {
    padded_box(Vec3::new(0.45, 0.47, 0.06), 0.028, 0.012)
        .turned(Vec3::X, FRAC_PI_2)
        .deformed(|p| {
            let hollow = 0.035 * (p.x / 0.225).powi(2);
            Vec3::new(p.x * (1.0 - 0.08 * (p.z / 0.235).max(0.0)), p.y + hollow, p.z)
        })
        .turned(Vec3::X, 0.16)
        .moved(Vec3::new(0.0, -0.222, 0.628))
        .smoothed(60.0)
}

/// A padded wall bent around the sitter, lower at its ends.
fn tub_back() -> Mesh {
    const N: usize = 36;
    let section: Vec<Vec2> = (0..16)
        .map(|k| {
            let (sin, cos) = (k as f32 / 16.0 * 2.0 * PI).sin_cos();
            Vec2::new(0.026 * cos.signum() * cos.abs().powf(0.7), sin.signum() * sin.abs().powf(0.5))
        })
        .collect();
    let point = |i: usize, j: usize| {
        let along = 2.0 * (j.clamp(1, N + 1) - 1) as f32 / N as f32 - 1.0;
        let angle = 1.75 * along;
        let (low, high) = (0.40, 0.40 + 0.40 - 0.20 * along.abs().powi(3));
        let center = |z: f32| {
            let r = 0.238 + 0.05 * ((z - low) / 0.4);
            Vec3::new(r * angle.sin(), 0.02 - r * angle.cos(), z)
        };
        let middle = 0.5 * (low + high);
        if j == 0 || j == N + 2 {
            return center(middle);
        }
        let q = section[i % 16];
        center(middle + 0.5 * (high - low) * q.y) + Vec3::new(angle.sin(), -angle.cos(), 0.0) * q.x
    };
    // The section runs backwards, so that the faces look outward.
    grid(16, N + 2, |i, j| point(16 - i, j), |i, j| Vec2::new(j as f32 / N as f32 * 0.9, i as f32 / 16.0 * 0.9)).smoothed(60.0)
}

/// A chair with a moulded shell on a stand of wood or wire.
#[derive(Clone, Copy, Debug)]
pub struct ShellChair {
    /// Finish of the shell.
    pub shell: Finish,
    /// Wooden legs instead of a frame of steel.
    pub wooden: bool,
    /// A pad on the seat.
    pub pad: bool,
}

impl Furniture for ShellChair {
    fn random(rng: &mut Rng) -> Self {
        let shell = [Finish::WhitePlastic, Finish::BlackPlastic, Finish::Plastic(rng.below(5) as u8), Finish::Wood][rng.below(4)];
        Self { shell, wooden: rng.below(3) > 0, pad: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.48, 0.60, 0.86)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("shell_chair", Class::Chair, pose);
        b.part(&chair, "shell", grained(shell(), rng), self.shell);
        let mut legs = Vec::new();
        for s in [-1.0f32, 1.0] {
            // Each ends within the shell, which is higher at the rear.
            for (top, foot) in [([0.11, 0.12, 0.414], [0.2, 0.235]), ([0.11, -0.08, 0.423], [0.2, -0.225])] {
                let path = [Vec3::new(s * foot[0], foot[1], 0.0), Vec3::new(s * top[0], top[1], top[2])];
                legs.push(standing(tube(&path, if self.wooden { 0.0135 } else { 0.0075 }, 12)));
            }
        }
        b.part(&chair, "legs", grained(all(legs), rng), if self.wooden { Finish::Wood } else { Finish::Chrome });
        let (x, y) = (0.118, [-0.086, 0.127]);
        let brace = |from: [f32; 2], to: [f32; 2]| rod([from[0], from[1], 0.392], [to[0], to[1], 0.392], 0.006, 8);
        let braces =
            all([brace([-x, y[0]], [x, y[0]]), brace([-x, y[1]], [x, y[1]]), brace([-x, y[0]], [x, y[1]]), brace([-x, y[1]], [x, y[0]])]);
        b.part(&chair, "braces", braces, Finish::BlackMetal);
        if self.pad {
            let pad = crate::shape::pillow(Vec2::new(0.36, 0.35), 0.035, rng).moved(Vec3::new(0.0, 0.045, SEAT - 0.016 + CONTACT));
            b.part(&chair, "pad", pad, Finish::Accent(2));
        }
    }
}

/// The shell: a sheet of 6 mm bent from seat to back, its sides drawn up.
fn shell() -> Mesh {
    const N: [usize; 2] = [20, 28];
    /// Thickness of the shell, metres.
    const THICK: f32 = 0.006;
    let sheet = |u: f32, v: f32| {
        // From the front edge of the seat (v = 0) around the bend to the top of the back.
        let bend = ((v - 0.42) / 0.2).clamp(0.0, 1.0);
        let turn = 1.38 * bend * bend * (3.0 - 2.0 * bend);
        let seat = 0.37 * (v / 0.5).min(1.0);
        let rise = ((v - 0.5) / 0.5).max(0.0);
        let half = 0.5 * (0.44 - 0.07 * (v - 0.5).abs() - 0.10 * rise * rise);
        let dish = 0.045 * u * u * (0.35 + 0.65 * bend) + 0.03 * (1.0 - v / 0.15).max(0.0).powi(2) * -0.6;
        let y = 0.235 - seat - 0.13 * rise - 0.03 * bend;
        let z = SEAT - 0.03 - 0.012 * (PI * (v / 0.45).min(1.0)).sin() + 0.4 * rise.powf(1.15) + 0.012 * bend;
        let normal = Vec3::new(0.0, turn.sin(), turn.cos());
        let edge = 1.0 - 0.06 * (2.0 * v - 1.0).abs().powi(8);
        Vec3::new(u * half * edge, y, z) + normal * dish
    };
    // The section is a closed strip: over the upper side, back along the lower one.
    let around = 2 * (N[0] + 1);
    let point = |i: usize, j: usize| {
        let i = i % around;
        let v = (j.clamp(1, N[1] + 1) - 1) as f32 / N[1] as f32;
        let upper = i <= N[0];
        let k = if upper { i } else { around - 1 - i };
        let u = 2.0 * k as f32 / N[0] as f32 - 1.0;
        if j == 0 || j == N[1] + 2 {
            return sheet(0.0, v) - Vec3::new(0.0, 0.0, 0.5 * THICK);
        }
        let p = sheet(u, v);
        if upper {
            return p;
        }
        let e = 1e-3;
        let normal = (sheet(u + e, v) - sheet(u - e, v)).cross(sheet(u, v - e) - sheet(u, v + e)).normalize_or(Vec3::Z);
        p - normal * THICK
    };
    grid(around, N[1] + 2, |i, j| point(around - i, j), |i, j| Vec2::new(i as f32 * 0.022, j as f32 * 0.03)).smoothed(50.0)
}
