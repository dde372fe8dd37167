//! Doors and passages from room to room: a passage has a lining, casings and a threshold, a door also a leaf with two panels on each
//! face, its stop, its lever handles and its hinges. All is painted white but for the wooden threshold and steel fittings; doors are of
//! class door, passages of class other structure. The room gives the sizes and how far the door is open.
//!
//! The space of both begins on the floor at the middle of the opening: x is along the wall, y = 0 on the wall's inner face and positive
//! into the room.

use super::{WallOpening, board};
use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::shape::{Reshape, lathe, picture_frame, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};

/// The leaf of a door.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// Hinges at the end with the smaller (−1) or larger (+1) x.
    pub hinge: f32,
    /// Opening angle, radians; 0 is shut.
    pub open_rad: f32,
    /// Thickness of the wall that it hangs in.
    pub back: f32,
}

/// A door in its opening: lining, casings, leaf with mouldings and handles, threshold.
#[derive(Clone, Copy, Debug)]
pub struct Door {
    /// The leaf of the door.
    pub leaf: Leaf,
}

/// An opening without a door: lining, casings, threshold.
#[derive(Clone, Copy, Debug)]
pub struct Passage;

/// Thickness of the boards that line the opening, metres.
const LINING: f32 = 0.03;
/// Back and front of the closed leaf as y from the wall's inner face, metres: the leaf is 40 mm thick.
const LEAF: [f32; 2] = [-0.058, -0.018];
/// Air between the leaf and the lining, metres.
const PLAY: f32 = 0.0025;
/// How far casings protrude from the wall, metres.
const CASING: f32 = 0.017;

/// Boards around an opening through a wall that is `back` thick, and casings on its faces.
fn lining(b: &mut Builder, object: &Object, size: Vec2, back: f32, casing_behind: bool) {
    let white = Finish::WhitePaint;
    let (half, top) = (0.5 * size.x, size.y);
    let faces: &[(&str, f32, f32)] =
        if casing_behind { &[("", -0.002, CASING), ("_back", -back - CASING, -back + 0.002)] } else { &[("", -0.002, CASING)] };
    for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
        let span = |from: f32, to: f32| if s < 0.0 { [-to, -from] } else { [from, to] };
        let [x0, x1] = span(half - LINING, half + 0.003);
        b.part(object, &format!("lining_{name}"), board([x0, -back - 0.002, -0.01], [x1, 0.002, top], 0.0015), white);
        let [x0, x1] = span(half - 0.012, half + 0.052);
        for (face, y0, y1) in faces {
            b.part(object, &format!("casing_{name}{face}"), board([x0, *y0, -0.002], [x1, *y1, top + 0.0523], 0.004), white);
        }
    }
    let head = board([-half - 0.002, -back - 0.0025, top - LINING], [half + 0.002, 0.0025, top + 0.003], 0.0015);
    b.part(object, "lining_top", head, white);
    for (face, y0, y1) in faces {
        let mesh = board([-half + 0.0118, *y0 + 0.0005, top - 0.012], [half - 0.0118, *y1 - 0.0005, top + 0.052], 0.004);
        b.part(object, &format!("casing_top{face}"), mesh, white);
    }
    let threshold = board([-half - 0.001, -back - 0.012, -0.03], [half + 0.001, 0.012, 0.004], 0.002);
    b.part(object, "threshold", threshold, Finish::Wood);
}

impl Passage {
    /// Adds the passage in its opening.
    pub fn build(self, b: &mut Builder, opening: &WallOpening) {
        let pose = opening.pose(0.0);
        let passage = b.object("passage", Class::OtherStructure, pose);
        lining(b, &passage, Vec2::new(opening.size().x, opening.z[1]), opening.thickness, true);
    }
}

impl Door {
    /// Adds the door in its opening.
    pub fn build(&self, b: &mut Builder, opening: &WallOpening) {
        let pose = opening.pose(0.0);
        let door = b.object("door", Class::Door, pose);
        let white = Finish::WhitePaint;
        let (half, top) = (0.5 * opening.size().x, opening.z[1]);
        lining(b, &door, Vec2::new(2.0 * half, top), self.leaf.back, !opening.outer);
        // The stop behind the leaf overlaps it on three sides.
        let stop = half - LINING;
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            let [x0, x1] = if s < 0.0 { [-stop - 0.002, 0.014 - stop] } else { [stop - 0.014, stop + 0.002] };
            let mesh = board([x0, LEAF[0] - 0.03, 0.002], [x1, LEAF[0] - 0.0005, top - LINING + 0.001], 0.001);
            b.part(&door, &format!("stop_{name}"), mesh, white);
        }
        let mesh =
            board([-stop - 0.001, LEAF[0] - 0.0295, top - LINING - 0.014], [stop + 0.001, LEAF[0] - 0.0005, top - LINING + 0.002], 0.001);
        b.part(&door, "stop_top", mesh, white);
        self.hang(b, &door, Vec2::new(half - LINING - PLAY, top - LINING - PLAY), opening.outer);
    }

    /// The leaf about its hinges; `size` is half its width and its height. An `outer` one stays shut: nothing is behind it.
    fn hang(&self, b: &mut Builder, door: &Object, size: Vec2, outer: bool) {
        let Leaf { hinge, open_rad, .. } = self.leaf;
        // Hinges sit at the front edge of the leaf, which turns about them into the room.
        let pivot = Vec3::new(hinge * size.x, LEAF[1], 0.0).as_dvec3();
        let swing = DAffine3::from_translation(pivot)
            * DAffine3::from_rotation_z(f64::from(-hinge * open_rad))
            * DAffine3::from_translation(-pivot);
        let white = Finish::WhitePaint;
        let from = b.part_count();
        b.part_at(door, "leaf", board([-size.x, LEAF[0], 0.007], [size.x, LEAF[1], size.y], 0.002), swing, white);
        for (side, front) in [("", true), ("_back", false)] {
            // Both faces are alike; the back one is the front one turned about the leaf's middle.
            let onto_face = |mesh: Mesh| {
                if front {
                    mesh.moved(Vec3::new(0.0, LEAF[1], 0.0))
                } else {
                    mesh.turned(Vec3::Z, std::f32::consts::PI).moved(Vec3::new(0.0, LEAF[0], 0.0))
                }
            };
            for (name, z0, z1) in [("panel_lower", 0.18, 0.84), ("panel_upper", 1.0, size.y - 0.15)] {
                let frame = picture_frame(2.0 * size.x - 0.26, z1 - z0, &MOULDING).moved(Vec3::new(0.0, 0.0, 0.5 * (z0 + z1)));
                b.part_at(door, &format!("{name}{side}"), onto_face(frame), swing, white);
            }
            let hand = if front { -hinge } else { hinge };
            b.part_at(door, &format!("handle{side}"), onto_face(handle(hand * (size.x - 0.065), hand)), swing, Finish::Steel);
        }
        if !outer {
            b.joint(door, "leaf", &Joint::leaf(hinge * size.x, LEAF[1], hinge, open_rad), from..b.part_count());
        }
        for (i, z) in [0.24, size.y - 0.24].into_iter().enumerate() {
            let knuckle = tube(&[Vec3::new(0.0, 0.0, z - 0.04), Vec3::new(0.0, 0.0, z + 0.04)], 0.006, 12);
            let at = Vec3::new(hinge * (size.x + 0.5 * PLAY), LEAF[1] + 0.004, 0.0);
            b.part(door, &format!("hinge_{}", i + 1), knuckle.moved(at), Finish::Steel);
        }
    }
}

/// Section of the mouldings on a leaf whose face is y = 0: [distance from the outer edge, height over the face], metres.
const MOULDING: [[f32; 2]; 5] = [[0.0, -0.001], [0.002, 0.006], [0.012, 0.009], [0.022, 0.003], [0.024, -0.001]];

/// A lever at `x` on a leaf whose face is y = 0, reaching away from the side that `hand` names.
fn handle(x: f32, hand: f32) -> Mesh {
    let at = Vec3::new(x, 0.0, 1.02);
    let rose = [[0.0, 0.0], [0.026, 0.0], [0.0255, 0.006], [0.022, 0.009], [0.0, 0.009]];
    let plate =
        lathe(&rose.map(Vec2::from_array), 32).turned(Vec3::X, -std::f32::consts::FRAC_PI_2).moved(at - Vec3::new(0.0, 0.0005, 0.0));
    let path: Vec<Vec3> = [[0.0, 0.0], [0.0, 0.035], [0.004, 0.046], [0.012, 0.052], [0.03, 0.054], [0.125, 0.054]]
        .iter()
        .map(|[x, y]| at + Vec3::new(-hand * x, *y, 0.0))
        .collect();
    plate.with(tube(&path, 0.0085, 16))
}
