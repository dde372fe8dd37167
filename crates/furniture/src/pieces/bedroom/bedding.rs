//! What lies on a bed's frame: the mattress and a duvet or bedspread (parts of the bed), and pillows and cushions (class pillow) and a
//! throw across the foot (class other prop) as objects of their own. A cover is a padded sheet that hangs over mattress and frame, computed
//! with `furniture::soft`. The head is at −y.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::soft::{Drape, Turnback, Wrinkles, quilt};
use crate::pieces::{CONTACT, form, on};
use crate::shape::{Reshape, pillow, rounded_box, rounded_loop, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// The cover of a bed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cover {
    /// A duvet whose upper end is turned back below the pillows.
    Duvet,
    /// A duvet with one upper corner turned back.
    OpenCorner,
    /// A quilted bedspread that hangs low.
    Bedspread,
}

/// What lies on a bed's frame, its head at −y.
#[derive(Clone, Copy, Debug)]
pub struct Bedding {
    /// Width and length of the mattress.
    pub mattress: Vec2,
    /// Height of the mattress's lower face.
    pub base: f32,
    /// Thickness of the mattress.
    pub thickness: f32,
    /// Half the width and length over the frame, around which the cover hangs.
    pub around: Vec2,
    /// Length by which the cover hangs down, metres.
    pub hang: f32,
    /// The cover of the bed.
    pub cover: Cover,
    /// Sleeping places: 1 or 2.
    pub sleepers: usize,
    /// Scatter cushions before the pillows.
    pub cushions: usize,
    /// A throw across the foot.
    pub throw: bool,
}

impl Bedding {
    fn top(&self) -> f32 {
        self.base + self.thickness
    }

    fn head(&self) -> f32 {
        -0.5 * self.mattress.y
    }

    /// Adds mattress and cover to `bed`, and pillows, cushions and throw as things of their own.
    pub fn build(&self, b: &mut Builder, bed: &Object, pose: DAffine3, rng: &mut Rng) {
        self.mattress(b, bed);
        self.cover(b, bed, pose, rng);
        self.pillows(b, pose, rng);
    }

    fn mattress(&self, b: &mut Builder, bed: &Object) {
        let size = self.mattress.extend(self.thickness - CONTACT);
        let middle = Vec3::new(0.0, 0.0, self.base + CONTACT + 0.5 * size.z);
        b.part(bed, "mattress", rounded_box(size, 0.045, 3).moved(middle), Finish::BedLinen(0));
        let rim = rounded_loop(size.x - 0.004, size.y - 0.004, 0.045, 4);
        let piping = form::all([-1.0f32, 1.0].map(|s| tube(&rim, 0.005, 6).moved(middle + Vec3::Z * s * (0.5 * size.z - 0.03))));
        b.part(bed, "mattress_piping", piping, Finish::Mattress);
    }

    /// The shape of cloth that hangs over mattress and frame.
    fn drape(&self, rng: &mut Rng) -> Drape {
        Drape {
            half: self.around + 0.006,
            round: 0.065,
            top: self.top() + CONTACT,
            folds: if self.cover == Cover::Bedspread { 0.03 } else { 0.022 },
            per_metre: rng.range(2.6, 3.6),
            phase: rng.range(0.0, TAU),
        }
    }

    fn cover(&self, b: &mut Builder, bed: &Object, pose: DAffine3, rng: &mut Rng) {
        let drape = self.drape(rng);
        let spread = self.cover == Cover::Bedspread;
        let thickness = if spread { 0.012 } else { 0.038 };
        let lumps = Wrinkles::new(0.42, if spread { 0.004 } else { 0.034 }, rng);
        let creases = Wrinkles::new(0.13, if spread { 0.003 } else { 0.011 }, rng);
        // The largest height of the padding.
        let most = thickness + lumps.at(Vec2::ZERO).max(0.034) + 0.011;
        let side = if rng.below(2) == 0 { 1.0 } else { -1.0 };
        let foot = drape.half.y + self.hang;
        let reach = drape.half.x + self.hang;
        let fold_y = self.head() + 0.60;
        let (start, turn) = match self.cover {
            Cover::Duvet => (fold_y - rng.range(0.3, 0.42), Some((Vec2::new(0.0, fold_y), Vec2::new(0.03 * side, -1.0)))),
            Cover::OpenCorner => {
                let beyond = Vec2::new(0.72 * side, -1.0).normalize();
                (fold_y - 0.06, Some((Vec2::new(side * reach, fold_y - 0.06) - beyond * rng.range(0.5, 0.62), beyond)))
            }
            Cover::Bedspread => (fold_y - 0.12, None),
        };
        let turn = turn.map(|(line, beyond)| Turnback { line, beyond: beyond.normalize(), round: 0.5 * most + 0.02 });
        let padding = |q: Vec2| thickness + lumps.at(q) + creases.at(q) + if spread { stitches(q) } else { 0.0 };
        let heights = |q: Vec2| {
            let back = turn.map_or(0.0, |t| (t.distance(q) / (PI * t.round) - 0.5).clamp(0.0, 1.0));
            [0.5 * back * (padding(q + 3.0) - thickness), padding(q)]
        };
        let place = |q: Vec2, above: f32| {
            let (q, above) = turn.map_or((q, above), |t| t.point(q, above));
            drape.point(q, above)
        };
        let cells = [(self.mattress.x * 20.0) as usize + 14, 58];
        let [upper, lower] = quilt(cells, Vec2::new(-reach, start), Vec2::new(reach, foot), 0.03, heights, place);
        let [outside, lining] = if spread { [3, 3] } else { [1, 2] };
        let name = if spread { "bedspread" } else { "duvet" };
        b.part(bed, name, upper, Finish::BedLinen(outside));
        b.part(bed, &format!("{name}_lining"), lower, Finish::BedLinen(lining));
        if self.throw {
            let object = b.object("throw", Class::OtherProp, pose);
            let wide = rng.range(0.42, 0.6);
            let from = Vec2::new(-drape.half.x - 0.75 * self.hang, 0.5 * self.mattress.y - 0.16 - wide);
            let to = Vec2::new(drape.half.x + 0.75 * self.hang, from.y + wide);
            let ripple = Wrinkles::new(0.16, 0.008, rng);
            let lie = |q: Vec2, above: f32| place(q, padding(q) + 0.004 + ripple.at(q) + above);
            let [upper, lower] = quilt([64, 20], from, to, 0.006, |_| [0.0, 0.006], lie);
            b.part(&object, "knit", upper.with(lower), Finish::KnittedThrow);
        }
    }

    fn pillows(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let share = self.mattress.x / self.sleepers as f32;
        let wide = share.min(0.8) - 0.06;
        let tall = if rng.below(2) == 0 { 0.50 } else { 0.58 };
        let (mut front, upright) = (0.0f32, rng.below(2) == 0);
        for k in 0..self.sleepers {
            let x = (k as f32 + 0.5) * share - 0.5 * self.mattress.x;
            let layers = 1 + rng.below(2);
            for layer in 0..layers {
                let thickness = rng.range(0.13, 0.16);
                let mesh = pillow(Vec2::new(wide, tall), thickness, rng).uv_moved(Vec2::splat(rng.next_f32()));
                let y = self.head() + 0.5 * tall;
                let local = if upright {
                    // Pillows lean against the headboard, one before the other.
                    let lean = 0.95 - 0.12 * layer as f32;
                    let at = Vec3::new(x, self.head() + 0.16 + 0.15 * layer as f32, self.top() + 0.03 + 0.5 * tall * lean.sin());
                    front = front.max(0.16 + 0.15 * layer as f32 + 0.36 * tall);
                    on(pose, at, 0.0) * DAffine3::from_rotation_x(f64::from(-(PI - lean))) * DAffine3::from_rotation_z(std::f64::consts::PI)
                } else {
                    let at = Vec3::new(x, y + 0.012 * layer as f32, self.top() + 0.55 * thickness + 0.108 * layer as f32);
                    front = front.max(tall);
                    on(pose, at, 0.0) * DAffine3::from_rotation_x(-0.10)
                };
                let local = local * DAffine3::from_rotation_z(f64::from(rng.range(-0.04, 0.04)));
                let object = b.object("pillow", Class::Pillow, local);
                b.part(&object, "case", mesh, Finish::BedLinen(if layer == 0 { 2 } else { 1 }));
            }
        }
        for k in 0..self.cushions {
            let size = if k == 0 { rng.range(0.42, 0.48) } else { rng.range(0.34, 0.4) };
            let x = (k as f32 - 0.5 * (self.cushions as f32 - 1.0)) * 0.45 + rng.range(-0.05, 0.05);
            let lean = rng.range(0.75, 0.9);
            let mesh = pillow(Vec2::splat(size), rng.range(0.12, 0.15), rng).uv_moved(Vec2::splat(rng.next_f32()));
            let at = Vec3::new(x, self.head() + front + 0.02 + 0.03 * k as f32, self.top() + 0.09 + 0.5 * size * lean.sin());
            let local = on(pose, at, rng.range(-0.15, 0.15))
                * DAffine3::from_rotation_x(f64::from(-(PI - lean)))
                * DAffine3::from_rotation_z(f64::from(PI + rng.range(-0.06, 0.06)));
            let object = b.object("cushion", Class::Pillow, local);
            b.part(&object, "cover", mesh, Finish::Accent(k as u8));
        }
    }
}

/// Diamond quilting: a groove every 12 cm.
fn stitches(q: Vec2) -> f32 {
    let groove = |v: f32| (PI * v / 0.12).sin().abs().sqrt();
    0.008 * groove(q.x + q.y).min(groove(q.x - q.y))
}
