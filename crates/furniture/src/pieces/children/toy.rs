//! Toys that lie on the floor or on a shelf, of class other prop: wooden blocks in a tower and around it, a ball, a wooden train of three
//! cars, a car, a tower of rings. Sizes are fixed; colours and the places of loose blocks vary. The train heads for +x.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, turned};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, bevelled_box, rounded_box, sphere};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Toys that lie on the floor or on a shelf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Toy {
    Blocks,
    Ball,
    Train,
    Car,
    RingTower,
}

/// Edge of a building block, metres.
const BLOCK: f32 = 0.04;
/// Radius of the ball, metres.
const BALL: f32 = 0.105;

fn color(k: usize) -> Finish {
    if k % 4 == 3 { Finish::Wood } else { Finish::ColoredLacquer(k as u8) }
}

/// A wheel of radius `r` whose axle is along y.
fn wheel(r: f32, at: Vec3) -> enfilade_geometry::Mesh {
    cylinder(r, 0.012, 24).turned(Vec3::X, FRAC_PI_2).moved(at + Vec3::new(0.0, 0.006, r))
}

impl Toy {
    fn blocks(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        // A small tower, and blocks strewn around it.
        let tower: [[f32; 3]; 6] = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [-0.5, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, 0.0, 2.0]];
        let strewn = (0..6).map(|k| {
            let d = Vec2::from_angle(1.05 * k as f32 + 0.4) * rng.clone().fork(k).range(0.13, 0.17);
            [d.x / BLOCK, d.y / BLOCK, 0.0]
        });
        let places: Vec<[f32; 3]> = tower.into_iter().chain(strewn).collect();
        for (k, [x, y, z]) in places.into_iter().enumerate() {
            let loose = k >= 6;
            let yaw = if loose { rng.range(0.0, 1.5) } else { rng.range(-0.06, 0.06) };
            let gap = if loose { 1.0 } else { 1.06 };
            let object = b.object("toy_block", Class::OtherProp, on(pose, Vec3::new(x * gap, y * gap, z * 1.012) * BLOCK, yaw));
            let shape = match k % 5 {
                4 if k >= 5 => cylinder(0.5 * BLOCK, BLOCK, 28),
                _ => rounded_box(Vec3::splat(BLOCK), 0.003, 2).moved(Vec3::new(0.0, 0.0, 0.5 * BLOCK)),
            };
            b.part(&object, "wood", shape.moved(Vec3::new(0.0, 0.0, CONTACT)), color(k));
        }
    }

    fn train(b: &mut Builder, pose: DAffine3) {
        let base = |w: f32| rounded_box(Vec3::new(w, 0.05, 0.014), 0.004, 2).moved(Vec3::new(0.0, 0.0, 0.024));
        let wheels = |w: f32| {
            let places = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
            all(places.map(|(x, y)| wheel(0.014, Vec3::new(x * (0.5 * w - 0.018), y * 0.026, 0.0))))
        };
        for k in 0..3usize {
            let x = 0.13 - 0.125 * k as f32;
            let object = b.object("toy_train", Class::OtherProp, on(pose, Vec3::new(x, 0.0, CONTACT), 0.0));
            let w = 0.105;
            b.part(&object, "base", base(w), Finish::Wood);
            b.part(&object, "wheels", wheels(w), Finish::BlackPlastic);
            if k == 0 {
                let boiler = cylinder(0.021, 0.07, 28).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(-0.018, 0.0, 0.052));
                b.part(&object, "boiler", boiler, color(0));
                let cab = bevelled_box(Vec3::new(0.034, 0.046, 0.05), 0.003).moved(Vec3::new(-0.035, 0.0, 0.056));
                let roof = bevelled_box(Vec3::new(0.044, 0.054, 0.008), 0.003).moved(Vec3::new(-0.035, 0.0, 0.085));
                b.part(&object, "cab", cab, color(1));
                b.part(&object, "roof", roof, color(2));
                b.part(
                    &object,
                    "chimney",
                    turned(&[[0.0, 0.07], [0.007, 0.07], [0.007, 0.09], [0.011, 0.098], [0.0, 0.098]], 20)
                        .moved(Vec3::new(0.032, 0.0, 0.0)),
                    color(2),
                );
            } else {
                let load = bevelled_box(Vec3::new(w - 0.012, 0.046, 0.034), 0.003).moved(Vec3::new(0.0, 0.0, 0.0482));
                b.part(&object, "wagon", load, color(k + 3));
                b.part(&object, "hook", rod([0.5 * w - 0.004, 0.0, 0.024], [0.5 * w + 0.012, 0.0, 0.024], 0.0025, 8), Finish::Brass);
            }
        }
    }

    fn car(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("toy_car", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let paint = color(rng.below(3));
        let body = rounded_box(Vec3::new(0.2, 0.085, 0.042), 0.014, 4).moved(Vec3::new(0.0, 0.0, 0.041));
        let cabin = rounded_box(Vec3::new(0.1, 0.075, 0.045), 0.016, 4)
            .deformed(|p| Vec3::new(p.x * (1.0 - 5.0 * p.z.max(-0.01)), p.y, p.z))
            .smoothed(50.0)
            .moved(Vec3::new(-0.012, 0.0, 0.074));
        b.part(&object, "body", body, paint);
        b.part(&object, "cabin", cabin, Finish::GlossBlack);
        let places = [(-1.0f32, -1.0f32), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        b.part(&object, "wheels", all(places.map(|(x, y)| wheel(0.022, Vec3::new(x * 0.06, y * 0.04, 0.0)))), Finish::Rubber);
    }
}

impl Furniture for Toy {
    fn random(rng: &mut Rng) -> Self {
        [Self::Blocks, Self::Ball, Self::Train, Self::Car, Self::RingTower][rng.below(5)]
    }

    fn size(&self) -> Vec3 {
        Vec3::from_array(match self {
            Self::Blocks => [0.4, 0.4, 0.125],
            Self::Ball => [2.0 * BALL; 3],
            Self::Train => [0.37, 0.066, 0.1],
            Self::Car => [0.2, 0.094, 0.1],
            Self::RingTower => [0.15, 0.15, 0.225],
        })
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        match self {
            Self::Blocks => Self::blocks(b, pose, rng),
            Self::Train => Self::train(b, pose),
            Self::Car => Self::car(b, pose, rng),
            Self::Ball => {
                let object = b.object("ball", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, BALL), 0.0));
                // Six gores in two colours; the axis is tilted, as a ball comes to rest in any direction.
                let tilt = rng.range(0.3, 1.2);
                for (name, k) in [("gores_1", 0), ("gores_2", 1)] {
                    let gores = (0..3).map(|g| {
                        let from = (2 * g + k) as f32 / 6.0;
                        crate::shape::grid(
                            6,
                            20,
                            |i, j| {
                                let (a, t) = (std::f32::consts::TAU * (from + i as f32 / 36.0), std::f32::consts::PI * j as f32 / 20.0);
                                let ring = if j == 0 || j == 20 { 0.0 } else { t.sin() };
                                BALL * Vec3::new(ring * a.cos(), ring * a.sin(), -t.cos())
                            },
                            |i, j| Vec2::new(i as f32 * 0.018, j as f32 * 0.016),
                        )
                    });
                    let mesh = all(gores);
                    let mesh = enfilade_geometry::Mesh { normals: mesh.positions.iter().map(|p| *p / BALL).collect(), ..mesh };
                    b.part(&object, name, mesh.turned(Vec3::X, tilt), Finish::Plastic(k as u8 + rng.below(2) as u8));
                }
            }
            Self::RingTower => {
                let object = b.object("ring_tower", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
                b.part(
                    &object,
                    "foot",
                    turned(&[[0.0, 0.0], [0.07, 0.0], [0.072, 0.004], [0.07, 0.014], [0.011, 0.016], [0.0, 0.016]], 36),
                    Finish::Wood,
                );
                b.part(&object, "pin", cylinder(0.0095, 0.185, 16).moved(Vec3::new(0.0, 0.0, 0.0158)), Finish::Wood);
                for k in 0..5usize {
                    let (r, z) = (0.068 - 0.008 * k as f32, 0.0165 + 0.031 * k as f32);
                    let ring = [
                        [0.012, z + 0.002],
                        [0.014, z],
                        [r - 0.012, z],
                        [r, z + 0.01],
                        [r, z + 0.02],
                        [r - 0.012, z + 0.03],
                        [0.014, z + 0.03],
                        [0.012, z + 0.028],
                        [0.012, z + 0.002],
                    ];
                    b.part(&object, &format!("ring_{}", k + 1), turned(&ring, 36), Finish::ColoredLacquer(k as u8));
                }
                b.part(&object, "head", sphere(0.02, 20).moved(Vec3::new(0.0, 0.0, 0.203)), Finish::ColoredLacquer(2));
            }
        }
    }
}
