//! Crockery of glazed ceramic, class other prop: stacks of plates of 21 or 27 cm and of bowls, cups on saucers, jugs and teapots, each
//! plate or bowl an object; and a function that fills a shelf with crockery and glasses.

use super::Drinkware;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{turned, vessel, wire};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// Plates, bowls and cups, alone or stacked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crockery {
    /// A pile of this many plates of this radius.
    Plates(usize, f32),
    /// A pile of this many bowls in each other.
    Bowls(usize),
    /// A cup on its saucer.
    Cup,
    /// A jug with a spout.
    Jug,
    /// A teapot with its lid.
    Teapot,
}

/// Distance between the plates of a stack, metres.
const PLATE_STEP: f32 = 0.0075;
/// Distance between the bowls of a stack, metres.
const BOWL_STEP: f32 = 0.017;

/// A plate with a flat rim, on z = 0.
pub fn plate(r: f32) -> Mesh {
    let profile = [
        [0.0, 0.003],
        [0.50 * r, 0.003],
        [0.52 * r, 0.0],
        [0.56 * r, 0.0],
        [0.58 * r, 0.003],
        [0.70 * r, 0.008],
        [0.98 * r, 0.019],
        [r, 0.0205],
        [0.985 * r, 0.022],
        [0.70 * r, 0.0125],
        [0.62 * r, 0.0085],
        [0.0, 0.0075],
    ];
    turned(&profile, 48)
}

fn bowl() -> Mesh {
    vessel(&[[0.034, 0.0], [0.038, 0.006], [0.056, 0.018], [0.070, 0.038], [0.076, 0.062]], 0.0035, 44)
}

fn cup() -> Mesh {
    let body = vessel(&[[0.022, 0.0], [0.025, 0.004], [0.036, 0.022], [0.040, 0.045], [0.041, 0.062]], 0.003, 36);
    body.with(wire(&[[0.037, 0.0, 0.052], [0.056, 0.0, 0.05], [0.060, 0.0, 0.034], [0.034, 0.0, 0.018]], 0.0036, 8))
}

impl Furniture for Crockery {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(6) {
            0 => Self::Plates(2 + rng.below(7), 0.135),
            1 => Self::Plates(2 + rng.below(5), 0.105),
            2 => Self::Bowls(1 + rng.below(5)),
            3 => Self::Jug,
            4 => Self::Teapot,
            _ => Self::Cup,
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Plates(n, r) => Vec3::new(2.0 * r, 2.0 * r, 0.022 + PLATE_STEP * (n.max(1) - 1) as f32),
            Self::Bowls(n) => Vec3::new(0.152, 0.152, 0.064 + BOWL_STEP * (n.max(1) - 1) as f32),
            Self::Cup => Vec3::new(0.144, 0.144, 0.075),
            Self::Jug => Vec3::new(0.19, 0.11, 0.19),
            Self::Teapot => Vec3::new(0.265, 0.16, 0.15),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let glaze = Finish::Ceramic(rng.below(3) as u8);
        let up = |z: f32| Vec3::new(0.0, 0.0, z + CONTACT);
        match *self {
            Self::Plates(n, r) => {
                for k in 0..n {
                    let at = on(pose, Vec3::new(rng.range(-0.002, 0.002), rng.range(-0.002, 0.002), PLATE_STEP * k as f32), 0.0);
                    let object = b.object("plate", Class::OtherProp, at);
                    b.part(&object, "body", plate(r).moved(up(0.0)), glaze);
                }
            }
            Self::Bowls(n) => {
                for k in 0..n {
                    let object = b.object("bowl", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, BOWL_STEP * k as f32), 0.0));
                    b.part(&object, "body", bowl().moved(up(0.0)), glaze);
                }
            }
            Self::Cup => {
                let saucer = b.object("saucer", Class::OtherProp, pose);
                b.part(&saucer, "body", plate(0.072).moved(up(0.0)), glaze);
                let object = b.object("cup", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, 0.008), rng.range(-0.8, 0.8)));
                b.part(&object, "body", cup().moved(up(0.0)), glaze);
                let coffee = turned(&[[0.0370, 0.0], [0.0, 0.0]], 28);
                b.part(&object, "coffee", coffee.moved(up(0.05)), Finish::Soil);
            }
            Self::Jug => {
                let object = b.object("jug", Class::OtherProp, pose);
                let body = vessel(&[[0.044, 0.0], [0.05, 0.008], [0.055, 0.06], [0.043, 0.12], [0.040, 0.15], [0.048, 0.185]], 0.004, 48)
                    .deformed(|p| {
                        // The rim runs out into a spout on one side.
                        let lip = ((p.z - 0.14) / 0.045).clamp(0.0, 1.0) * (-p.x / 0.045).clamp(0.0, 1.0).powi(6);
                        Vec3::new(p.x - 0.028 * lip, p.y * (1.0 - 0.2 * lip), p.z)
                    })
                    .smoothed(40.0);
                b.part(&object, "body", body.moved(up(0.0)), glaze);
                let handle = wire(&[[0.040, 0.0, 0.165], [0.075, 0.0, 0.165], [0.088, 0.0, 0.11], [0.052, 0.0, 0.045]], 0.006, 10);
                b.part(&object, "handle", handle, glaze);
            }
            Self::Teapot => {
                let object = b.object("teapot", Class::OtherProp, pose);
                let body = vessel(&[[0.045, 0.0], [0.062, 0.012], [0.074, 0.05], [0.062, 0.09], [0.036, 0.108]], 0.004, 48);
                b.part(&object, "body", body.moved(up(0.0)), glaze);
                let lid = [
                    [0.0, 0.105],
                    [0.034, 0.105],
                    [0.036, 0.109],
                    [0.025, 0.117],
                    [0.006, 0.121],
                    [0.010, 0.130],
                    [0.007, 0.137],
                    [0.0, 0.138],
                ];
                b.part(&object, "lid", turned(&lid, 36).moved(up(0.0)), glaze);
                let handle = wire(&[[0.058, 0.0, 0.085], [0.10, 0.0, 0.09], [0.105, 0.0, 0.05], [0.066, 0.0, 0.028]], 0.0065, 10);
                let spout = wire(&[[-0.065, 0.0, 0.04], [-0.09, 0.0, 0.055], [-0.10, 0.0, 0.085], [-0.118, 0.0, 0.1]], 0.010, 14);
                b.part(&object, "handle", handle, glaze);
                b.part(&object, "spout", spout, glaze);
            }
        }
    }
}

/// Fills a board of `width` with crockery and glasses in groups; the pose is on the board, in its middle.
pub fn shelf_of_crockery(b: &mut Builder, pose: DAffine3, width: f32, rng: &mut Rng) {
    let mut x = -0.5 * width;
    loop {
        let kind = rng.below(5);
        let thing: Box<dyn Furniture> = match kind {
            0 => Box::new(Crockery::Plates(3 + rng.below(5), rng.range(0.09, 0.105))),
            1 => Box::new(Crockery::Bowls(2 + rng.below(4))),
            2 => Box::new(Crockery::Jug),
            3 => Box::new(Drinkware::Tumbler),
            _ => Box::new(Drinkware::Wine),
        };
        let w = thing.size().x + rng.range(0.012, 0.03);
        let copies = if kind >= 3 { 2 + rng.below(3) } else { 1 };
        for _ in 0..copies {
            if x + w > 0.5 * width {
                return;
            }
            thing.build(b, on(pose, Vec3::new(x + 0.5 * w, 0.0, 0.0), 0.0), rng);
            x += w;
        }
    }
}
