//! Chairs of wood with a straight frame, 42 to 45 cm wide and 84 to 106 cm high, class chair: the rear legs go on upward as posts of the back,
//! which is filled in one of several ways. The sitter looks to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::seating::upright;
use crate::pieces::{board, grained, standing};
use crate::shape::{Reshape, bendable_box, padded_box, rounded_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// What is between the posts of the back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    /// Level slats, one above the other.
    Ladder,
    /// Upright slats between two rails.
    Slats,
    /// Two crossed rods below a rail.
    Cross,
    /// One broad upright board, cut like a vase.
    Splat,
    /// A padded panel.
    Padded,
}

/// The seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bottom {
    /// A board.
    Board,
    /// Woven of cord or cane in a frame.
    Woven,
    /// A padded seat.
    Padded(Finish),
}

/// A wooden chair with a straight frame.
#[derive(Clone, Copy, Debug)]
pub struct WoodenChair {
    /// What is between the posts of the back.
    pub filling: Filling,
    /// The seat.
    pub bottom: Bottom,
    /// Height of the back.
    pub top: f32,
    /// Finish of the frame.
    pub finish: Finish,
    /// Square legs instead of round ones.
    pub square: bool,
}

/// Height of the seat's upper side, metres: EN 1729 and common practice have 440 to 470 mm.
const SEAT: f32 = 0.455;
/// Half the width of the seat at its front, metres.
const HALF: f32 = 0.21;
/// Half the distance of the posts, metres.
const POST: f32 = 0.182;

impl WoodenChair {
    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        Vec3::new(0.45, 0.56, self.top + 0.01)
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        self.seat(b, &chair, rng);
        let mut frame = Vec::new();
        for s in [-1.0f32, 1.0] {
            if self.square {
                frame.push(board([s * 0.187 - 0.018, 0.19, 0.0], [s * 0.187 + 0.018, 0.226, SEAT - 0.03], 0.002));
            } else {
                let path = [Vec3::new(s * 0.195, 0.215, 0.0), Vec3::new(s * 0.18, 0.19, SEAT - 0.03)];
                frame.push(standing(tube(&path, 0.0165, 14)));
            }
            frame.push(self.post(s));
            let (x, z) = (s * 0.184, SEAT - 0.058);
            frame.push(board([x - 0.009, -0.17, z - 0.028], [x + 0.009, 0.2, z + 0.0275], 0.0015));
            frame.push(board([x - 0.0075, -0.185, 0.17], [x + 0.0075, 0.2, 0.192], 0.0015));
        }
        let across = |y: f32, low: f32, high: f32| board([-POST, y - 0.008, low], [POST, y + 0.008, high], 0.0015);
        frame.extend([
            across(0.203, SEAT - 0.085, SEAT - 0.0312),
            across(-0.168, SEAT - 0.084, SEAT - 0.0314),
            across(0.02, 0.1715, 0.1905),
        ]);
        b.part(&chair, "frame", grained(all(frame), rng), self.finish);
        if self.filling == Filling::Padded {
            let (low, high) = (SEAT + 0.1, self.top - 0.02);
            let pad = upright(padded_box(Vec3::new(2.0 * POST + 0.02, high - low, 0.045), 0.02, 0.008));
            let mesh = pad.deformed(|p| self.on_back(p.x, 0.5 * (low + high) + p.z, p.y + 0.006)).smoothed(60.0);
            let cloth = if let Bottom::Padded(cloth) = self.bottom { cloth } else { Finish::ArmchairCloth };
            b.part(&chair, "back", mesh.uv_moved(Vec2::splat(rng.next_f32())), cloth);
        } else {
            b.part(&chair, "back", grained(self.filled(), rng), self.finish);
        }
    }

    /// A point of the back's plane at a height above the floor, `out` before it.
    fn on_back(&self, x: f32, z: f32, out: f32) -> Vec3 {
        let t = ((z - SEAT) / 0.45).max(0.0);
        Vec3::new(x, -0.182 - 0.045 * t * t.min(1.3) + out, z)
    }

    /// A rear leg that goes on upward to the top of the back.
    fn post(&self, s: f32) -> Mesh {
        let mut path = vec![Vec3::new(s * 0.19, -0.225, 0.0), Vec3::new(s * POST, -0.184, SEAT - 0.1)];
        path.extend((0..=6).map(|k| self.on_back(s * POST, SEAT + (self.top - 0.005 - SEAT) * k as f32 / 6.0, 0.0)));
        standing(tube(&path, if self.square { 0.0165 } else { 0.0155 }, if self.square { 4 } else { 14 }))
    }

    fn seat(&self, b: &mut Builder, chair: &crate::builder::Object, rng: &mut Rng) {
        let narrow = |p: Vec3| Vec3::new(p.x * (1.0 - 0.1 * (0.5 - p.y / 0.42)), p.y, p.z);
        let at = Vec3::new(0.0, 0.022, 0.0);
        match self.bottom {
            Bottom::Board => {
                let seat = rounded_box(Vec3::new(2.0 * HALF, 0.42, 0.03), 0.01, 3).deformed(narrow).smoothed(40.0);
                b.part(chair, "seat", grained(seat.moved(at + Vec3::Z * (SEAT - 0.016)), rng), self.finish);
            }
            Bottom::Woven => {
                let seat = padded_box(Vec3::new(2.0 * HALF - 0.01, 0.41, 0.026), 0.012, 0.004).deformed(narrow).smoothed(60.0);
                // Cord is laid around four rails: its strands meet in the diagonals.
                let seat = seat.deformed(|p| {
                    let groove = (p.x.abs() - p.y.abs()).abs().min(0.02) / 0.02;
                    Vec3::new(p.x, p.y, p.z - if p.z > 0.0 { 0.006 * (1.0 - groove) } else { 0.0 })
                });
                b.part(chair, "seat", seat.smoothed(40.0).moved(at + Vec3::Z * (SEAT - 0.018)), Finish::Wicker);
            }
            Bottom::Padded(cloth) => {
                let seat = padded_box(Vec3::new(2.0 * HALF + 0.01, 0.42, 0.05), 0.022, 0.012).deformed(narrow).smoothed(60.0);
                b.part(chair, "seat", seat.uv_moved(Vec2::splat(rng.next_f32())).moved(at + Vec3::Z * (SEAT - 0.006)), cloth);
            }
        }
    }

    /// What is between the posts, if it is of wood.
    fn filled(&self) -> Mesh {
        // A board between the posts, bent back in its middle by 2 cm.
        let slat = |low: f32, high: f32, bow: f32| {
            bendable_box(Vec3::new(2.0 * POST, 0.012, high - low), 0.004, [12, 1, 1])
                .deformed(|p| {
                    let t = (p.x / POST).clamp(-1.0, 1.0);
                    self.on_back(p.x, 0.5 * (low + high) + p.z * (1.0 - bow * t * t), p.y - 0.02 * (1.0 - t * t))
                })
                .smoothed(40.0)
        };
        let (low, top) = (SEAT + 0.11, self.top - 0.02);
        match self.filling {
            Filling::Ladder => {
                let count = ((top - low) / 0.115).round().max(3.0);
                all((0..count as usize).map(|k| {
                    let z = low + (top - low) * (k as f32 + 0.5) / count;
                    slat(z - 0.027, z + 0.027, 0.25)
                }))
            }
            Filling::Slats => {
                let slats = (-3..=3).map(|k| {
                    let x = 0.045 * k as f32;
                    let path: Vec<Vec3> = (0..=5).map(|j| self.on_back(x, low + (top - 0.03 - low) * j as f32 / 5.0, -0.019)).collect();
                    tube(&path, 0.008, 8)
                });
                all(slats.chain([slat(top - 0.07, top, 0.15), slat(low - 0.02, low + 0.02, 0.0)]))
            }
            Filling::Cross => {
                let cross = [-1.0f32, 1.0].map(|s| {
                    let path: Vec<Vec3> = (0..=8)
                        .map(|j| {
                            let t = j as f32 / 8.0;
                            let x = s * POST * (1.0 - 2.0 * t) * (1.0 - 0.25 * (1.0 - (1.0 - 2.0 * t).abs()));
                            self.on_back(x, low - 0.02 + (top - 0.07 - low) * t, -0.012 * (std::f32::consts::PI * t).sin())
                        })
                        .collect();
                    tube(&path, 0.009, 10)
                });
                all(cross.into_iter().chain([slat(top - 0.055, top, 0.3)]))
            }
            Filling::Splat => {
                let (from, to) = (SEAT - 0.04, top - 0.05);
                let splat = bendable_box(Vec3::new(0.13, 0.01, to - from), 0.003, [1, 1, 16]).deformed(|p| {
                    let t = p.z / (to - from) + 0.5;
                    let wide = 0.62 + 0.38 * (std::f32::consts::PI * (1.6 * t + 0.2)).sin().abs();
                    self.on_back(p.x * wide, 0.5 * (from + to) + p.z, p.y - 0.012)
                });
                splat.smoothed(40.0).with(slat(top - 0.065, top, -0.2))
            }
            Filling::Padded => Mesh::default(),
        }
    }
}
