//! The arms of upholstered seats.

use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::form::turned;
use crate::shape::{Reshape, bendable_box, rounded_box};
use enfilade_math::Vec3;
use std::f32::consts::FRAC_PI_2;

/// The shape of both arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arms {
    /// None: people sit down from three sides.
    None,
    /// Blocks with round edges.
    Box,
    /// Blocks with a roll on top that shows as a scroll in front.
    Rolled,
    /// Blocks that lean outward towards their upper end.
    Flared,
    /// Blocks, and wings beside the back up to its upper end.
    Wings,
}

/// Distance by which flared arms lean out, metres.
const FLARE: f32 = 0.07;
/// Distance by which rolls protrude on either side of their arm, metres.
const ROLL: f32 = 0.025;

/// Where the arms of a seat are.
#[derive(Clone, Copy, Debug)]
pub struct ArmSpan {
    /// Distance of their inner sides from the middle.
    pub inner: f32,
    /// Width of an arm.
    pub wide: f32,
    /// Rear and front ends.
    pub y: [f32; 2],
    /// Lower and upper ends.
    pub z: [f32; 2],
    /// Upper end of the back.
    pub top: f32,
}

impl Arms {
    /// Distance by which arms protrude beyond their width on the outer side, metres.
    pub fn overhang(self) -> f32 {
        match self {
            Self::None | Self::Box | Self::Wings => 0.0,
            Self::Rolled => ROLL,
            Self::Flared => FLARE,
        }
    }

    /// Adds both arms.
    pub fn add(self, b: &mut Builder, object: &Object, span: ArmSpan, cover: Finish) {
        if self == Self::None {
            return;
        }
        let ([y0, y1], [z0, z1]) = (span.y, span.z);
        let size = Vec3::new(span.wide, y1 - y0, z1 - z0);
        let round = (0.4 * span.wide).min(0.045);
        for (name, s) in [("arm_left", -1.0f32), ("arm_right", 1.0)] {
            let at = Vec3::new(s * (span.inner + 0.5 * span.wide), 0.5 * (y0 + y1), 0.5 * (z0 + z1));
            let mut block = rounded_box(size, round, 3);
            if self == Self::Flared {
                block = bendable_box(size, round, [1, 1, 6])
                    .deformed(|p| p + Vec3::X * s * FLARE * (p.z / size.z + 0.5).clamp(0.0, 1.0).powi(2))
                    .smoothed(60.0);
            }
            b.part(object, name, block.moved(at), cover);
            if self == Self::Rolled {
                let (r, half) = (0.5 * span.wide + ROLL, 0.5 * size.y);
                let profile = [
                    [0.0, -half],
                    [r - 0.02, -half],
                    [r, 0.02 - half],
                    [r, half - 0.03],
                    [r - 0.012, half - 0.004],
                    [r - 0.03, half],
                    [0.6 * r, half - 0.006],
                    [0.0, half - 0.001],
                ];
                let roll = turned(&profile, 40).turned(Vec3::X, -FRAC_PI_2);
                b.part(object, &format!("roll_{}", &name[4..]), roll.moved(Vec3::new(at.x, at.y + 0.004, z1 - 0.6 * r)), cover);
            }
            if self == Self::Wings {
                let (depth, low) = (0.3, z1 - 0.06);
                let height = span.top - low;
                let wing = bendable_box(Vec3::new(0.09, depth, height), 0.035, [1, 4, 8]).deformed(|p| {
                    // Towards its upper end the front edge curves back.
                    let up = (p.z / height + 0.5).clamp(0.0, 1.0);
                    let front = (p.y / depth + 0.5).clamp(0.0, 1.0);
                    Vec3::new(p.x, p.y - front * 0.13 * up.powi(3), p.z)
                });
                let wing = wing.smoothed(60.0).moved(Vec3::new(s * (span.inner + 0.046), y0 + 0.5 * depth + 0.002, low + 0.5 * height));
                b.part(object, &format!("wing_{}", &name[4..]), wing, cover);
            }
        }
    }
}
