//! Low soft seats: poufs, knitted, as an upholstered drum, or as a footstool of 50 to 80 cm (class other furniture), and floor cushions of
//! 55 to 70 cm, one or two on each other (class pillow). A drum also carries things.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, turned};
use crate::pieces::{CONTACT, Furniture, Surface, leg};
use crate::shape::{Reshape, padded_box, pillow, spline, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Height of a drum, metres.
const DRUM: f32 = 0.42;
/// A soft stool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pouf {
    /// A knitted ball of this radius.
    Knitted(f32),
    /// A drum of this radius on a plinth.
    Drum(f32),
    /// A padded box of this length on feet.
    Footstool(f32),
}

impl Furniture for Pouf {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(3) {
            0 => Self::Knitted(rng.range(0.23, 0.29)),
            1 => Self::Drum(rng.range(0.2, 0.3)),
            _ => Self::Footstool(rng.range(0.5, 0.8)),
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Knitted(r) => Vec3::new(2.0 * r + 0.016, 2.0 * r + 0.016, 1.36 * r),
            Self::Drum(r) => Vec3::new(2.0 * r + 0.008, 2.0 * r + 0.008, DRUM),
            Self::Footstool(w) => Vec3::new(w, 0.48, 0.415),
        }
    }

    fn surfaces(&self) -> Vec<Surface> {
        match *self {
            Self::Drum(r) => vec![Surface { min: Vec2::splat(-0.55 * r), max: Vec2::splat(0.55 * r), z: DRUM, headroom: f32::INFINITY }],
            _ => Vec::new(),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pouf = b.object("pouf", Class::OtherFurniture, pose);
        match *self {
            Self::Knitted(r) => {
                let outline = spline(
                    &[[0.0, 0.0], [0.7 * r, 0.0], [0.97 * r, 0.36 * r], [0.985 * r, 0.8 * r], [0.72 * r, 1.26 * r], [0.0, 1.34 * r]],
                    6,
                );
                let profile: Vec<[f32; 2]> = outline.iter().map(|p| [p.x, p.y.max(0.0)]).collect();
                // Cords of wool run from pole to pole.
                let body = turned(&profile, 96)
                    .deformed(|p| {
                        let cord = 0.012 * (24.0 * p.y.atan2(p.x)).cos() * (p.truncate().length() / r).min(1.0);
                        Vec3::new(p.x, p.y, p.z) + (p.truncate().normalize_or_zero() * cord.min(0.0)).extend(0.0)
                    })
                    .smoothed(60.0);
                b.part(&pouf, "cover", body, [Finish::KnittedThrow, Finish::Boucle, Finish::Accent(rng.below(3) as u8)][rng.below(3)]);
            }
            Self::Drum(r) => {
                let plinth = [[0.0, 0.0], [r - 0.02, 0.0], [r - 0.02, 0.031], [0.0, 0.031]];
                b.part(&pouf, "plinth", turned(&plinth, 56), Finish::DarkWood);
                let drum = [[0.0, 0.0315], [r - 0.014, 0.0315], [r, 0.045], [r, 0.39], [r - 0.012, 0.408], [0.7 * r, 0.419], [0.0, DRUM]];
                let cover = [Finish::Velvet, Finish::Boucle, Finish::Leather, Finish::ArmchairCloth][rng.below(4)];
                b.part(&pouf, "cover", turned(&drum, 64), cover);
                let ring: Vec<Vec3> = (0..=64).map(|k| (Vec2::from_angle(TAU * k as f32 / 64.0) * (r - 0.001)).extend(0.385)).collect();
                b.part(&pouf, "piping", tube(&ring, 0.004, 6), cover);
            }
            Self::Footstool(w) => {
                let pad = padded_box(Vec3::new(w - 0.018, 0.465, 0.2), 0.05, 0.02).uv_moved(Vec2::splat(rng.next_f32()));
                b.part(
                    &pouf,
                    "cover",
                    pad.moved(Vec3::new(0.0, 0.0, 0.28)),
                    [Finish::SofaCloth, Finish::ArmchairCloth, Finish::Leather][rng.below(3)],
                );
                let places = [(1.0f32, 1.0f32), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
                let legs = places
                    .map(|(x, y)| leg(0.175, [0.013, 0.02], Vec2::new(x, y) * 0.015).moved(Vec3::new(x * (0.5 * w - 0.07), y * 0.17, 0.0)));
                b.part(&pouf, "legs", all(legs), Finish::Wood);
            }
        }
    }
}

/// Flat cushions on the floor to sit on, one or two on each other.
#[derive(Clone, Copy, Debug)]
pub struct FloorCushion {
    /// Cushions on each other.
    pub count: usize,
    /// Edge length.
    pub width: f32,
}

impl Furniture for FloorCushion {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(2), width: rng.range(0.55, 0.7) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(1.16 * self.width, 1.16 * self.width, 0.15 * self.count as f32 + 0.01)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        for k in 0..self.count {
            let cushion = b.object("floor_cushion", Class::Pillow, pose);
            let thickness = 0.14;
            let mesh = pillow(Vec2::splat(self.width), thickness, rng).turned(Vec3::Z, rng.range(-0.15, 0.15));
            // A cushion is flat where it lies on the floor or on another one.
            let mesh = mesh.deformed(|p| Vec3::new(p.x, p.y, p.z.max(-0.32 * thickness))).smoothed(60.0);
            let z = 0.32 * thickness + CONTACT + 0.115 * k as f32;
            b.part(
                &cushion,
                "cover",
                mesh.uv_moved(Vec2::splat(rng.next_f32())).moved(Vec3::new(0.0, 0.0, z)),
                Finish::Accent((k + rng.below(3)) as u8),
            );
        }
    }
}
