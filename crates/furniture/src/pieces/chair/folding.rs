//! A folding chair, 45 × 48 cm and 82 cm high, class chair: two frames that cross below the seat, which rests on both. Slats of wood, or panels
//! of metal.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{board, grained, standing};
use crate::shape::{Reshape, bendable_box, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A folding chair.
#[derive(Clone, Copy, Debug)]
pub struct FoldingChair {
    /// Seat and back of slats instead of one panel each.
    pub slatted: bool,
    /// Finish of all of it.
    pub finish: Finish,
}

/// Half the width over the outer frame's middle, and over the inner one's, metres.
const HALF: [f32; 2] = [0.205, 0.175];

impl FoldingChair {
    /// Size of the box around it.
    pub const SIZE: Vec3 = Vec3::new(0.45, 0.52, 0.85);

    /// A point of the outer frame, which is front legs and posts of the back, at a height.
    fn outer(z: f32) -> f32 {
        0.235 - 0.46 * z / 0.82
    }

    /// A point of the inner frame, which is the rear legs, at a height.
    fn inner(z: f32) -> f32 {
        -0.235 + 0.42 * z / 0.43
    }

    /// Adds its parts.
    pub fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let chair = b.object("chair", Class::Chair, pose);
        let (r, n) = if self.slatted { (0.0145, 4) } else { (0.011, 12) };
        let leg = |x: f32, y: fn(f32) -> f32, top: f32| {
            standing(tube(&[Vec3::new(x, y(0.0), 0.0), Vec3::new(x, y(0.5 * top), 0.5 * top), Vec3::new(x, y(top), top)], r, n))
        };
        let bar = |half: f32, y: f32, z: f32| tube(&[Vec3::new(-half, y, z), Vec3::new(half, y, z)], 0.7 * r, 10);
        let mut frame = Vec::new();
        for s in [-1.0f32, 1.0] {
            frame.extend([leg(s * HALF[0], Self::outer, 0.82), leg(s * HALF[1], Self::inner, 0.425)]);
            // A rail below the seat runs from frame to frame.
            frame.push(board([s * 0.175 - 0.008, -0.165, 0.418], [s * 0.175 + 0.008, 0.2, 0.4385], 0.001));
        }
        frame.extend([
            bar(HALF[0], Self::outer(0.13), 0.13),
            bar(HALF[1], Self::inner(0.09), 0.09),
            bar(HALF[0], Self::outer(0.428), 0.428),
            bar(HALF[1], Self::inner(0.42), 0.42),
        ]);
        // The frames are riveted to each other where they cross.
        let cross = 0.47 / (0.46 / 0.82 + 0.42 / 0.43);
        frame.push(bar(HALF[0], Self::outer(cross), cross));
        b.part(&chair, "frame", grained(all(frame), rng), self.finish);
        b.part(&chair, "seat", grained(self.seat(), rng), self.finish);
        b.part(&chair, "back", grained(self.back(), rng), self.finish);
    }

    fn seat(&self) -> Mesh {
        let (y0, y1, z) = (-0.175, 0.215, [0.4382, 0.4535]);
        if self.slatted {
            let wide = (y1 - y0) / 6.0;
            return all((0..6).map(|k| {
                let y = y0 + wide * k as f32;
                board([-0.19, y + 0.004, z[0]], [0.19, y + wide - 0.004, z[1]], 0.002)
            }));
        }
        bendable_box(Vec3::new(0.38, y1 - y0, 0.014), 0.006, [6, 6, 1])
            .deformed(|p| {
                let dish = 0.008 * (1.0 - (p.x / 0.19).powi(2)) * (1.0 - (p.y / 0.195).powi(2));
                Vec3::new(p.x, p.y + 0.5 * (y0 + y1), p.z - dish + 0.4455)
            })
            .smoothed(40.0)
    }

    fn back(&self) -> Mesh {
        // A board between the posts, bent back by 1.5 cm.
        let slat = |low: f32, high: f32| {
            bendable_box(Vec3::new(2.0 * HALF[0], 0.011, high - low), 0.003, [10, 1, 1])
                .deformed(|p| {
                    let z = 0.5 * (low + high) + p.z;
                    Vec3::new(p.x, Self::outer(z) + p.y - 0.015 * (1.0 - (p.x / HALF[0]).powi(2)), z)
                })
                .smoothed(40.0)
        };
        if self.slatted { all([slat(0.6, 0.65), slat(0.675, 0.725), slat(0.75, 0.8)]) } else { slat(0.62, 0.8) }
    }
}
