//! To clean with: a vacuum cleaner, either a canister with its hose or a stick about 110 cm high that leans, and a bucket of 26 to 31 cm
//! with or without a mop; class other prop. Sizes of the vacuum cleaners are fixed, colours vary.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, vessel, wire};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, rounded_box, sphere, tube};
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// A vacuum cleaner: a canister on wheels with its hose, or an upright one on its nozzle.
#[derive(Clone, Copy, Debug)]
pub struct Vacuum {
    /// A stick with its motor in the handle, leaning back, instead of a canister.
    pub stick: bool,
    /// Finish of its body.
    pub finish: Finish,
}

impl Vacuum {
    fn canister(&self, b: &mut Builder, vacuum: &crate::builder::Object) {
        let at = Vec3::new(-0.12, -0.03, 0.0);
        let body = sphere(0.5, 40)
            .deformed(|p| {
                let q = p * Vec3::new(0.29, 0.42, 0.27);
                Vec3::new(q.x, q.y, q.z * if q.z < 0.0 { 0.6 } else { 1.0 - 0.35 * (q.y / 0.21).max(0.0) })
            })
            .smoothed(60.0);
        b.part(vacuum, "body", body.moved(at + Vec3::Z * 0.115), self.finish);
        let band = sphere(0.5, 40).deformed(|p| Vec3::new(p.x * 0.296, p.y * 0.426, (p.z * 0.27).clamp(-0.02, 0.012))).smoothed(40.0);
        b.part(vacuum, "bumper", band.moved(at + Vec3::Z * 0.105), Finish::BlackPlastic);
        let wheels = [-1.0f32, 1.0].map(|s| {
            cylinder(0.07, 0.03, 36)
                .moved(Vec3::Z * -0.015)
                .turned(Vec3::Y, FRAC_PI_2)
                .moved(at + Vec3::new(s * 0.135, -0.10, 0.07 + CONTACT))
        });
        b.part(vacuum, "wheels", all(wheels), Finish::BlackPlastic);
        let front = cylinder(0.022, 0.02, 24).moved(Vec3::Z * -0.01).turned(Vec3::Y, FRAC_PI_2).moved(at + Vec3::new(0.0, 0.14, 0.022));
        b.part(vacuum, "caster", front, Finish::BlackPlastic);
        let grip =
            wire(&[[at.x, -0.12, 0.21], [at.x, -0.10, 0.265], [at.x, -0.02, 0.285], [at.x, 0.06, 0.265], [at.x, 0.08, 0.20]], 0.011, 12);
        b.part(vacuum, "grip", grip, Finish::BlackPlastic);
        let hose = [
            [at.x, 0.12, 0.15],
            [-0.08, 0.20, 0.16],
            [0.06, 0.25, 0.24],
            [0.17, 0.17, 0.45],
            [0.20, 0.02, 0.72],
            [0.20, -0.10, 0.88],
            [0.20, -0.16, 0.90],
        ];
        let ribbed = wire(&hose, 0.0165, 14);
        b.part(vacuum, "hose", ribbed, Finish::BlackPlastic);
        b.part(vacuum, "pipe", rod([0.20, -0.155, 0.90], [0.20, 0.02, 0.06], 0.0165, 18), Finish::Chrome);
        let nozzle = rounded_box(Vec3::new(0.27, 0.08, 0.035), 0.012, 3).moved(Vec3::new(0.17, 0.045, 0.0185));
        b.part(vacuum, "nozzle", nozzle, Finish::BlackPlastic);
    }

    fn upright(&self, b: &mut Builder, vacuum: &crate::builder::Object) {
        // All parts are along one axis, which leans back from the nozzle.
        let (foot, top) = (Vec3::new(0.0, 0.07, 0.05), Vec3::new(0.0, -0.10, 1.08));
        let along = |t: f32| foot.lerp(top, t);
        b.part(
            vacuum,
            "nozzle",
            rounded_box(Vec3::new(0.25, 0.11, 0.055), 0.016, 3).moved(Vec3::new(0.0, 0.08, 0.028)),
            Finish::BlackPlastic,
        );
        b.part(vacuum, "pipe", tube(&[along(0.0), along(0.72)], 0.018, 18), self.finish);
        b.part(vacuum, "motor", tube(&[along(0.70), along(0.71), along(0.93), along(0.94)], 0.042, 32), Finish::BlackPlastic);
        b.part(vacuum, "bin", tube(&[along(0.60) + Vec3::Y * 0.055, along(0.82) + Vec3::Y * 0.055], 0.048, 32), Finish::TintedGlass);
        let grip = [
            along(0.93),
            along(0.97) + Vec3::Y * -0.02,
            along(1.0) + Vec3::Y * 0.01,
            along(0.985) + Vec3::Y * 0.07,
            along(0.90) + Vec3::Y * 0.085,
        ];
        b.part(vacuum, "grip", wire(&grip.map(|p| p.to_array()), 0.013, 14), self.finish);
    }
}

impl Furniture for Vacuum {
    fn random(rng: &mut Rng) -> Self {
        Self {
            stick: rng.below(2) == 0,
            finish: [Finish::Plastic(rng.below(6) as u8), Finish::ColoredLacquer(0), Finish::BlackPlastic][rng.below(3)],
        }
    }

    fn size(&self) -> Vec3 {
        if self.stick { Vec3::new(0.26, 0.30, 1.11) } else { Vec3::new(0.63, 0.56, 0.94) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let vacuum = b.object("vacuum_cleaner", Class::OtherProp, pose);
        if self.stick {
            self.upright(b, &vacuum);
        } else {
            self.canister(b, &vacuum);
        }
    }
}

/// A bucket with a mop beside it, or alone.
#[derive(Clone, Copy, Debug)]
pub struct Bucket {
    /// Radius of the rim.
    pub radius: f32,
    /// A mop stands in it.
    pub mop: bool,
    /// Finish of the bucket.
    pub finish: Finish,
}

impl Furniture for Bucket {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Plastic(rng.below(6) as u8), Finish::WhiteEnamel, Finish::Steel][rng.below(3)];
        Self { radius: rng.range(0.13, 0.155), mop: rng.below(2) == 0, finish }
    }

    fn size(&self) -> Vec3 {
        let width = 2.0 * self.radius + 0.03;
        if self.mop { Vec3::new(width, width + 0.26, 1.24) } else { Vec3::new(width, width, 2.0 * self.radius + 0.02) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let bucket = b.object("bucket", Class::OtherProp, pose);
        let (r, h) = (self.radius, 1.8 * self.radius);
        b.part(
            &bucket,
            "body",
            vessel(&[[0.74 * r, 0.0], [0.82 * r, 0.3 * h], [0.91 * r, 0.65 * h], [r, h]], 0.003, 48).moved(Vec3::Z * CONTACT),
            self.finish,
        );
        let rim: Vec<Vec3> = (0..=40).map(|k| (enfilade_math::Vec2::from_angle(TAU * k as f32 / 40.0) * (r + 0.002)).extend(h)).collect();
        b.part(&bucket, "rim", tube(&rim, 0.005, 8), self.finish);
        // The handle has fallen to one side.
        let arc: Vec<Vec3> = (0..=20)
            .map(|k| {
                let (sin, cos) = (0.5 * TAU * k as f32 / 20.0).sin_cos();
                Vec3::new((r + 0.008) * cos, (r + 0.004) * sin * 0.985, h - 0.005 - 0.057 * sin)
            })
            .collect();
        b.part(&bucket, "handle", tube(&arc, 0.003, 8), Finish::Steel);
        if self.mop {
            let mop = b.object("mop", Class::OtherProp, on(pose, Vec3::ZERO, 0.0));
            // The tip stands on the floor of the bucket, the stick leans against its rim.
            let (tip, top) = (Vec3::new(0.0, 0.3 * r, 0.07), Vec3::new(0.0, -r - 0.10, 1.23));
            b.part(&mop, "stick", tube(&[tip, top], 0.011, 14), [Finish::Wood, Finish::Aluminium][rng.below(2)]);
            let head = sphere(0.5, 28)
                .deformed(|p| {
                    let turn = p.y.atan2(p.x);
                    let strand = 1.0 + 0.10 * (22.0 * turn + 6.0 * p.z).sin();
                    Vec3::new(p.x * 0.56 * r * 2.0 * 0.9 * strand, p.y * 0.5 * r * 2.0 * 0.9 * strand, (p.z + 0.5) * 0.13)
                })
                .smoothed(70.0);
            b.part(&mop, "head", head.moved(Vec3::new(0.0, 0.12 * r, 0.0042)), Finish::Towel(0));
        }
    }
}
