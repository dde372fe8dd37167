//! Wardrobes, 80 to 250 cm wide and 180 to 220 cm high, class cabinet: with hinged or sliding doors, of which one may be a mirror, or open,
//! with clothes on a rail and folded ones on shelves beside it. Body and doors are of wood or lacquer; the doors face +y.

use super::clothes::{FoldedClothes, hang_garment};
use super::garment::Garment;
use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::rod;
use crate::pieces::joinery::{Carcass, Handle, body_finish, front};
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// The doors of a wardrobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WardrobeDoors {
    /// Hinged doors, each half a metre wide.
    Hinged,
    /// Two or three sliding doors, one before the other.
    Sliding,
    /// None: a rail with clothes and shelves beside it.
    Open,
}

/// A wardrobe.
#[derive(Clone, Copy, Debug)]
pub struct Wardrobe {
    /// Width.
    pub width: f32,
    /// Height.
    pub height: f32,
    /// The doors of the wardrobe.
    pub doors: WardrobeDoors,
    /// One door is a mirror.
    pub mirror: bool,
    /// Doors with a recessed panel.
    pub framed: bool,
    /// Finish of carcass and doors.
    pub finishes: [Finish; 2],
    /// Handle of hinged doors.
    pub handle: Handle,
}

/// Depth of the carcass, metres: a garment on a hanger needs 55 cm.
const DEPTH: f32 = 0.58;
/// Height of the plinth, metres.
const PLINTH: f32 = 0.07;
/// Thickness of boards and hinged doors, metres.
const BOARD: f32 = 0.019;
/// Half the thickness of shelves, metres.
const HALF_SHELF: f32 = 0.009;

impl Wardrobe {
    fn depth(&self) -> f32 {
        match self.doors {
            WardrobeDoors::Hinged => DEPTH + BOARD + Handle::DEPTH,
            WardrobeDoors::Sliding => DEPTH + 0.06,
            WardrobeDoors::Open => DEPTH + 0.04,
        }
    }

    fn carcass(&self) -> Carcass {
        let (x, y) = (0.5 * self.width, 0.5 * self.depth());
        let front = match self.doors {
            WardrobeDoors::Hinged => y - BOARD - Handle::DEPTH - 0.001,
            WardrobeDoors::Sliding | WardrobeDoors::Open => y,
        };
        Carcass { x: [-x, x], y: [-y, front], z: [PLINTH, self.height], thick: BOARD, finish: self.finishes[0] }
    }

    fn mirror_at(&self, b: &mut Builder, object: &Object, rect: [f32; 4], face: f32, name: &str) {
        let ([x0, x1, z0, z1], inset) = (rect, 0.012);
        let glass = board([x0 + inset, face - 0.001, z0 + inset], [x1 - inset, face + 0.003, z1 - inset], 0.0012);
        b.part(object, name, glass, Finish::Mirror);
    }

    fn hinged(&self, b: &mut Builder, object: &Object, carcass: &Carcass, rng: &mut Rng) {
        let count = ((self.width / 0.5).round() as usize).max(2);
        let wide = self.width / count as f32;
        // Half the gap between two doors.
        let gap = 0.0015;
        let back = carcass.y[1] + 0.001;
        let face = back + BOARD;
        let mirrored = if self.mirror { Some(count / 2) } else { None };
        for k in 0..count {
            let x = carcass.x[0] + k as f32 * wide;
            let rect = [x + gap, x + wide - gap, carcass.z[0] + gap, carcass.z[1] - gap];
            let framed = self.framed && mirrored != Some(k);
            let from = b.part_count();
            b.part(object, &format!("door_{}", k + 1), front(rect, back, BOARD, framed, rng), self.finishes[1]);
            if mirrored == Some(k) {
                self.mirror_at(b, object, rect, face, &format!("mirror_{}", k + 1));
            }
            // Doors open in pairs; a single last one has its handle on the left.
            let to_right = k % 2 == 0 && k + 1 < count;
            let inner = if to_right { rect[1] - 0.035 } else { rect[0] + 0.035 };
            let at = Vec3::new(inner, face + if mirrored == Some(k) { 0.003 } else { 0.0 }, 1.05);
            self.handle.add(b, object, &format!("handle_{}", k + 1), at, 0.22, true);
            let (edge, side) = if to_right { (rect[0], -1.0) } else { (rect[1], 1.0) };
            b.joint(object, &format!("door_{}", k + 1), &Joint::cupboard(edge, face, side), from..b.part_count());
        }
        self.inside(b, object, carcass, carcass.y[1] - 0.004);
    }

    /// A rail for clothes below a shelf, where doors can be opened; both end before the depth `face`.
    fn inside(&self, b: &mut Builder, object: &Object, carcass: &Carcass, face: f32) {
        if !b.has_joints() {
            return;
        }
        let ([x0, x1, _, high], y) = (carcass.inside(), carcass.y[0] + 0.5 * DEPTH);
        let (z, rail) = (high - 0.3, high - 0.36);
        let shelf = board([x0 - 0.0001, carcass.y[0] + 0.0105, z - HALF_SHELF], [x1 + 0.0001, face, z + HALF_SHELF], 0.0015);
        b.part(object, "shelf", shelf, carcass.finish);
        b.part(object, "rail", rod([x0 - 0.001, y, rail], [x1 + 0.001, y, rail], 0.0125, 16), Finish::Steel);
    }

    fn sliding(&self, b: &mut Builder, object: &Object, carcass: &Carcass, rng: &mut Rng) {
        let [x0, x1, low, high] = carcass.inside();
        let count = if self.width > 2.3 { 3 } else { 2 };
        let overlap = 0.03;
        let wide = (x1 - x0 + (count - 1) as f32 * overlap) / count as f32;
        let outer = carcass.y[1];
        for (name, z) in [("track_low", [low + 0.0001, low + 0.012]), ("track_high", [high - 0.035, high - 0.0001])] {
            b.part(object, name, board([x0 + 0.0001, outer - 0.085, z[0]], [x1 - 0.0001, outer - 0.004, z[1]], 0.001), Finish::Aluminium);
        }
        for k in 0..count {
            let x = x0 + k as f32 * (wide - overlap);
            let back = outer - if k % 2 == 0 { 0.032 } else { 0.062 };
            let rect = [x + 0.001, x + wide - 0.001, low + 0.0125, high - 0.0355];
            let from = b.part_count();
            b.part(object, &format!("door_{}", k + 1), front(rect, back, 0.016, false, rng), self.finishes[1]);
            if self.mirror && k == count / 2 {
                self.mirror_at(b, object, rect, back + 0.016, &format!("mirror_{}", k + 1));
            }
            for (side, px) in [("left", rect[0]), ("right", rect[1] - 0.022)] {
                let strip = board([px, back + 0.0162, rect[2]], [px + 0.022, back + 0.026, rect[3]], 0.002);
                b.part(object, &format!("profile_{}_{side}", k + 1), strip, Finish::Aluminium);
            }
            // Before or behind its neighbour, the one at the right or, of the last door, at the left.
            let by = if k + 1 < count { wide - overlap } else { overlap - wide };
            b.joint(object, &format!("door_{}", k + 1), &Joint::sliding(by), from..b.part_count());
        }
        self.inside(b, object, carcass, outer - 0.09);
    }

    /// The board between clothes and shelves.
    fn divider(&self) -> f32 {
        let [x0, x1, ..] = self.carcass().inside();
        if self.width < 0.95 { x1 } else { x0 + 0.62 * (x1 - x0) }
    }

    fn shelves(&self) -> Vec<f32> {
        let [_, _, low, high] = self.carcass().inside();
        let count = ((high - low) / 0.36) as usize;
        (1..count).map(|k| low + (high - low) * k as f32 / count as f32).collect()
    }

    fn open(&self, b: &mut Builder, object: &Object, carcass: &Carcass, pose: DAffine3, rng: &mut Rng) {
        let ([x0, x1, low, high], divider) = (carcass.inside(), self.divider());
        let (rear, face) = (carcass.y[0] + 0.0105, carcass.y[1] - 0.004);
        if divider < x1 {
            let upright = board([divider, rear, low + 0.0002], [divider + BOARD, face, high - 0.0002], 0.0015);
            b.part(object, "divider", grained(upright, rng), carcass.finish);
            for (k, z) in self.shelves().into_iter().enumerate() {
                let shelf = board([divider + BOARD - 0.0001, rear, z - HALF_SHELF], [x1 + 0.0001, face, z + HALF_SHELF], 0.0015);
                b.part(object, &format!("shelf_{}", k + 1), grained(shelf, rng), carcass.finish);
            }
        }
        let z = high - 0.07;
        let y = 0.5 * (rear + face);
        b.part(object, "rail", rod([x0 - 0.0005, y, z], [divider + 0.0005, y, z], 0.0125, 18), Finish::Steel);
        let mut x = x0 + 0.06;
        while x < divider - 0.06 {
            let garment = Garment::random(rng);
            let yaw = std::f32::consts::FRAC_PI_2 + rng.range(-0.06, 0.06);
            hang_garment(b, on(pose, Vec3::new(x, y, z), yaw), garment, rng);
            x += rng.range(0.085, 0.15) + if rng.below(7) == 0 { 0.2 } else { 0.0 };
        }
        let mut levels = vec![low];
        levels.extend(self.shelves().iter().map(|z| z + HALF_SHELF));
        if divider < x1 {
            for z in levels {
                let middle = Vec3::new(0.5 * (divider + BOARD + x1), y + 0.06, z + CONTACT);
                if rng.below(5) > 0 && x1 - divider - BOARD > 0.36 {
                    FoldedClothes { count: 2 + rng.below(4) }.build(b, on(pose, middle, 0.0), rng);
                }
            }
        }
    }
}

impl Furniture for Wardrobe {
    fn random(rng: &mut Rng) -> Self {
        let doors = [WardrobeDoors::Hinged, WardrobeDoors::Hinged, WardrobeDoors::Sliding, WardrobeDoors::Open][rng.below(4)];
        let width = match doors {
            WardrobeDoors::Hinged => [1.0, 1.5, 2.0][rng.below(3)],
            WardrobeDoors::Sliding => [1.5, 1.8, 2.0, 2.5][rng.below(4)],
            WardrobeDoors::Open => rng.range(0.8, 1.7),
        };
        let body = body_finish(rng);
        let fronts = [body, body, Finish::WhiteLacquer][rng.below(3)];
        let handle = [Handle::Bar(Finish::BlackMetal), Handle::Bar(Finish::Steel), Handle::Knob(Finish::Brass)][rng.below(3)];
        let height = if doors == WardrobeDoors::Open { rng.range(1.8, 2.0) } else { rng.range(1.98, 2.2) };
        Self { width, height, doors, mirror: rng.below(3) == 0, framed: rng.below(3) == 0, finishes: [body, fronts], handle }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.depth(), self.height)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn surfaces(&self) -> Vec<Surface> {
        let c = self.carcass();
        vec![Surface { min: Vec2::new(c.x[0], c.y[0]), max: Vec2::new(c.x[1], c.y[1]), z: self.height, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("wardrobe", Class::Cabinet, pose);
        let carcass = self.carcass();
        carcass.add(b, &object, rng);
        let plinth = rounded_box(Vec3::new(self.width - 0.002, carcass.y[1] - carcass.y[0] - 0.04, PLINTH - 0.0002), 0.001, 1);
        b.part(&object, "plinth", plinth.moved(Vec3::new(0.0, 0.5 * (carcass.y[0] + carcass.y[1]) - 0.02, 0.5 * PLINTH)), carcass.finish);
        match self.doors {
            WardrobeDoors::Hinged => self.hinged(b, &object, &carcass, rng),
            WardrobeDoors::Sliding => self.sliding(b, &object, &carcass, rng),
            WardrobeDoors::Open => self.open(b, &object, &carcass, pose, rng),
        }
    }
}
