//! A kitchen island, 1.2 to 2.6 m long: units that open to the back (−y), where the cook stands, and a worktop that overhangs the front by
//! 28 to 38 cm for people on stools. The body and its fronts are of class cabinet, the worktop of class counter; it may have a sink or a
//! hob.

use super::front::{FRONT, KitchenStyle, Opening, front};
use super::{BOX, DEPTH, HANDLES, PLINTH, THICKNESS, WORKTOP, appliance, sink};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::plate_with_holes;
use crate::pieces::joinery::body_box;
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Thickness of the panels that clad the sides and the overhung front, metres.
const PANEL: f32 = 0.0195;
/// Distance of box and fronts from the ends, metres: a panel, and air that keeps faces out of one plane.
const INNER: f32 = 0.02;
/// Width of a unit with a sink or a hob, metres.
const FIXTURE: f32 = 0.6;

/// A kitchen island: units that open to the back (−y), a worktop that overhangs the front for people on stools.
#[derive(Clone, Copy, Debug)]
pub struct KitchenIsland {
    /// Length along x.
    pub length: f32,
    /// Overhang of the worktop at its front, metres.
    pub overhang: f32,
    /// Fixture that is built into it.
    pub fixture: Fixture,
    /// Style of the kitchen that it belongs to.
    pub style: KitchenStyle,
}

/// Fixtures of an island's worktop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Fixture {
    Nothing,
    Sink,
    Hob,
}

impl KitchenIsland {
    /// A random island in the style of its kitchen.
    pub fn in_style(style: KitchenStyle, rng: &mut Rng) -> Self {
        let fixture = [Fixture::Nothing, Fixture::Nothing, Fixture::Sink, Fixture::Hob][rng.below(4)];
        Self { length: 0.6 * (2 + rng.below(3)) as f32 + rng.range(0.0, 0.2), overhang: rng.range(0.28, 0.38), fixture, style }
    }

    fn depth(&self) -> f32 {
        DEPTH + self.overhang
    }
}

impl Furniture for KitchenIsland {
    fn random(rng: &mut Rng) -> Self {
        let style = KitchenStyle::random(rng);
        Self::in_style(style, rng)
    }

    fn size(&self) -> Vec3 {
        // A mixer's spout and a gas hob's grid rise above the worktop.
        let rise = match self.fixture {
            Fixture::Nothing => 0.0,
            Fixture::Sink => 0.38,
            Fixture::Hob => 0.05,
        };
        Vec3::new(self.length, self.depth() + HANDLES, WORKTOP + rise)
    }

    fn reach(&self) -> f32 {
        0.9
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * Vec2::new(self.length, self.depth());
        let back = if self.fixture == Fixture::Nothing { 0.04 } else { DEPTH };
        let min = Vec2::new(0.04 - half.x, back - half.y);
        vec![Surface { min, max: half - 0.04, z: WORKTOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("kitchen_island", Class::Cabinet, pose);
        // Units face −y: their space is turned by half a circle, and its origin is at the far corner.
        let units = on(pose, Vec3::new(0.5 * self.length, DEPTH - 0.5 * self.depth(), 0.0), std::f32::consts::PI);
        let local = DAffine3::from_translation(Vec3::new(0.5 * self.length, DEPTH - 0.5 * self.depth(), 0.0).as_dvec3())
            * DAffine3::from_rotation_z(std::f64::consts::PI);
        let [low, top] = [PLINTH[0], WORKTOP - THICKNESS - CONTACT];
        let under = if self.fixture == Fixture::Sink { top - 0.22 } else { top };
        let body = body_box(b, [INNER, INNER, low], [self.length - INNER, BOX, under], 0.001);
        b.part_at(&object, "box", body, local, Finish::WhiteLacquer);
        let plinth = board([0.06, 0.06, 0.0], [self.length - 0.06, BOX - 0.04, low], 0.001);
        b.part_at(&object, "plinth", plinth, local, self.style.lower);
        for (name, x) in [("side_1", 0.0), ("side_2", self.length - PANEL)] {
            let side = board([x, 0.0, 0.0], [x + PANEL, BOX + FRONT, top], 0.0015);
            b.part_at(&object, name, grained(side, rng), local, self.style.lower);
        }
        let back = board([INNER, 0.0, 0.0], [self.length - INNER, PANEL, top], 0.001);
        b.part_at(&object, "back", grained(back, rng), local, self.style.lower);
        let fronts = b.object("kitchen_unit", Class::Cabinet, units);
        let count = (self.length / 0.55) as usize;
        // Beside a sink the upper fronts hide its bowl.
        let upper = if self.fixture == Fixture::Sink { Opening::Fixed } else { Opening::Drawer };
        for k in 0..count {
            let x = [k, k + 1].map(|k| INNER + (self.length - 2.0 * INNER) * k as f32 / count as f32);
            let split = low + 0.5 * (top - low);
            if k % 2 == 0 {
                front(
                    b,
                    &fronts,
                    &format!("drawer_{}_1", k + 1),
                    [x[0], x[1], low, split],
                    BOX + CONTACT,
                    Opening::Drawer,
                    &self.style,
                    self.style.lower,
                    rng,
                );
                front(
                    b,
                    &fronts,
                    &format!("drawer_{}_2", k + 1),
                    [x[0], x[1], split, top],
                    BOX + CONTACT,
                    upper,
                    &self.style,
                    self.style.lower,
                    rng,
                );
            } else {
                front(
                    b,
                    &fronts,
                    &format!("door_{}", k + 1),
                    [x[0], x[1], low, top],
                    BOX + CONTACT,
                    Opening::Below(1.0),
                    &self.style,
                    self.style.lower,
                    rng,
                );
            }
        }
        self.worktop(b, pose, units, rng);
    }
}

impl KitchenIsland {
    fn worktop(&self, b: &mut Builder, pose: DAffine3, units: DAffine3, rng: &mut Rng) {
        let counter = b.object("worktop", Class::Counter, pose);
        let half = 0.5 * Vec2::new(self.length, self.depth());
        let mut holes = Vec::new();
        if self.fixture == Fixture::Sink {
            let [w, back, front] = sink::cut_out(FIXTURE);
            holes.push([-w, w, DEPTH - front - half.y, DEPTH - back - half.y]);
        }
        let top = plate_with_holes(-half, half, THICKNESS, 0.002, &holes).moved(Vec3::new(0.0, 0.0, WORKTOP));
        b.part(&counter, "top", grained(top, rng), self.style.worktop);
        let fixture = on(units, Vec3::new(0.5 * self.length, 0.0, WORKTOP), 0.0);
        match self.fixture {
            Fixture::Nothing => {}
            Fixture::Sink => sink::build(b, fixture, FIXTURE, &self.style, rng),
            Fixture::Hob => appliance::hob(b, fixture, FIXTURE, &self.style, rng),
        }
    }
}
