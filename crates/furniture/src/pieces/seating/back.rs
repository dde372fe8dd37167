//! The backs of upholstered seats: a frame, and what is before it.

use super::quilt::{buttoned, upright};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, padded_box, rounded_box};
use enfilade_math::{Rng, Vec2, Vec3};

/// The back of an upholstered seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Back {
    /// Loose cushions, one for each seat.
    Cushions,
    /// Fixed padding over the whole width.
    Tight,
    /// Fixed padding whose upper edge is curved, high in the middle.
    Camel,
    /// Padding drawn in by buttons.
    Buttoned,
    /// Upright channels.
    Channels,
    /// Two thick pads for each seat, one above the other.
    Pillowed,
}

/// Where the back of a seat is.
#[derive(Clone, Copy, Debug)]
pub struct BackSpan {
    /// Width between the arms.
    pub width: f32,
    /// Places to sit.
    pub seats: usize,
    /// The rear side.
    pub rear: f32,
    /// Lower end of the frame.
    pub low: f32,
    /// Height of the seat.
    pub seat: f32,
    /// Upper end.
    pub top: f32,
}

/// Thickness of the frame, metres.
const FRAME: f32 = 0.1;

impl Back {
    /// Thickness of frame and padding at the height of the seat, metres.
    pub fn thick(self) -> f32 {
        FRAME
            + match self {
                Self::Cushions => 0.05,
                Self::Tight | Self::Camel => 0.12,
                Self::Buttoned | Self::Channels => 0.09,
                Self::Pillowed => 0.15,
            }
    }

    /// Distance of its foremost point from its rear side, metres: loose cushions stand on the seat.
    pub fn front(self) -> f32 {
        self.thick() + if self == Self::Cushions { 0.17 } else { 0.0 }
    }

    /// Adds frame and padding.
    pub fn add(self, b: &mut Builder, object: &Object, span: BackSpan, cover: Finish, rng: &mut Rng) {
        let frame_depth = if self == Self::Cushions { self.thick() } else { FRAME };
        let drop = if self == Self::Cushions { 0.07 } else { 0.01 };
        let high = span.top - drop - span.low;
        let bow = if self == Self::Camel { 0.1 } else { 0.0 };
        let frame = if bow > 0.0 {
            bowed(span.width - 0.004, frame_depth, high, bow)
        } else {
            rounded_box(Vec3::new(span.width - 0.004, frame_depth, high), 0.035, 3)
        };
        b.part(object, "back", frame.moved(Vec3::new(0.0, span.rear + 0.5 * frame_depth, span.low + 0.5 * high)), cover);
        let (low, front) = (span.seat - 0.09, span.rear + FRAME);
        let height = span.top - low;
        let offset = Vec2::splat(rng.next_f32());
        let one = span.width / span.seats as f32;
        let middle = |k: usize| (k as f32 + 0.5) * one - 0.5 * span.width;
        match self {
            Self::Cushions => {
                for k in 0..span.seats {
                    let (tall, fat, lean) = (span.top - span.seat + rng.range(0.03, 0.06), 0.15, rng.range(0.15, 0.2));
                    let mesh = upright(padded_box(Vec3::new(one - 0.01, tall, fat), 0.05, rng.range(0.03, 0.042)));
                    let at = Vec3::new(middle(k), span.rear + frame_depth + 0.5 * fat + 0.035, span.seat + 0.005 + 0.5 * tall * lean.cos());
                    let mesh = mesh.turned(Vec3::X, lean).uv_moved(Vec2::splat(rng.next_f32()));
                    b.part(object, &format!("back_cushion_{}", k + 1), mesh.moved(at), cover);
                }
            }
            Self::Tight => {
                let pad = padded_box(Vec3::new(span.width - 0.006, height, 0.13), 0.045, 0.014);
                let pad = upright(pad).turned(Vec3::X, 0.07).uv_moved(offset);
                b.part(object, "back_pad", pad.moved(Vec3::new(0.0, front + 0.045, low + 0.5 * height - 0.004)), cover);
            }
            Self::Camel => {
                let pad = bowed(span.width - 0.05, 0.12, height - 0.03, bow).uv_moved(offset);
                b.part(object, "back_pad", pad.moved(Vec3::new(0.0, front + 0.05, low + 0.5 * height - 0.02)), cover);
            }
            Self::Buttoned => {
                let [panel, buttons] = buttoned(Vec2::new(span.width - 0.006, height), 0.09, Vec2::new(0.2, 0.13));
                let place = |mesh: enfilade_geometry::Mesh| mesh.moved(Vec3::new(0.0, front - 0.004, low + 0.5 * height));
                b.part(object, "back_pad", place(panel.uv_moved(offset)), cover);
                b.part(object, "back_buttons", place(buttons), cover);
            }
            Self::Channels => {
                let count = (span.width / 0.13).round().max(3.0);
                let wide = span.width / count;
                for k in 0..count as usize {
                    let pad = upright(padded_box(Vec3::new(wide - 0.001, height, 0.08), 0.038, 0.006)).uv_moved(offset);
                    let x = (k as f32 + 0.5) * wide - 0.5 * span.width;
                    b.part(object, &format!("back_pad_{}", k + 1), pad.moved(Vec3::new(x, front + 0.036, low + 0.5 * height)), cover);
                }
            }
            Self::Pillowed => {
                let split = low + 0.58 * height;
                for k in 0..span.seats {
                    for (name, [z0, z1], fat) in [("low", [low, split + 0.01], 0.15), ("high", [split, span.top + 0.015], 0.17)] {
                        let pad = upright(padded_box(Vec3::new(one - 0.008, z1 - z0, fat - 0.03), 0.055, 0.022)).uv_moved(offset);
                        let at = Vec3::new(middle(k), front + 0.5 * fat - 0.012, 0.5 * (z0 + z1));
                        b.part(object, &format!("back_pad_{name}_{}", k + 1), pad.moved(at), cover);
                    }
                }
            }
        }
    }
}

/// A padded block about the origin whose upper edge falls by `bow` towards both ends.
fn bowed(width: f32, depth: f32, height: f32, bow: f32) -> enfilade_geometry::Mesh {
    upright(padded_box(Vec3::new(width, height, depth - 0.02), 0.04, 0.01))
        .deformed(|p| {
            let t = (2.0 * p.x / width).clamp(-1.0, 1.0);
            let fall = bow * 0.5 * (1.0 - (std::f32::consts::PI * t).cos());
            Vec3::new(p.x, p.y, p.z - fall * (p.z / height + 0.5).clamp(0.0, 1.0))
        })
        .smoothed(60.0)
}
