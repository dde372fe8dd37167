//! Blinds in the reveals of windows.

use super::Furnisher;
use crate::room::kind::{self, Blinds};
use crate::room::{Filling, Opening};
use enfilade_furniture::{Blind, BlindKind, Window, on};
use enfilade_math::{Rng, Vec3};

/// Position of the backs of blinds, measured from the wall's inner face, metres: just before the handles of the sashes.
const BACK: f32 = -0.058;
/// Air beside a blind, metres.
const BESIDE: f32 = 0.006;
/// Air above it: contact without faces in one plane.
const ABOVE: f32 = 0.0005;
/// Air below one that is let down.
const BELOW: f32 = 0.004;

/// A usual blind of a room, and how far it is let down: far where people undress, else so that daylight comes in.
fn usual(purpose: Blinds, rng: &mut Rng) -> (BlindKind, [f32; 2]) {
    let venetian = |wood: bool, rng: &mut Rng| BlindKind::Venetian { tilt: rng.range(-0.5, 0.5), wood };
    match purpose {
        Blinds::Slats => (venetian(rng.below(2) == 0, rng), [0.15, 0.8]),
        Blinds::Sleeping => [(BlindKind::Roller, [0.1, 0.6]), (BlindKind::Roman, [0.45, 0.7])][rng.below(2)],
        Blinds::Private if rng.below(2) == 0 => (BlindKind::Roller, [0.3, 0.9]),
        _ if rng.below(3) == 0 => (BlindKind::Roller, [0.1, 0.5]),
        _ => (venetian(false, rng), [0.2, 0.9]),
    }
}

impl Furnisher<'_> {
    /// Hangs blinds in the reveal of a window now and then, one before each sash; returns the free height between sill and blinds.
    pub fn blinds(&mut self, window: &Opening, mut rng: Rng) -> f32 {
        let size = window.size();
        let Filling::Window { sashes } = window.filling else { return size.y };
        let fittings = &kind::row(self.room.kind).fittings;
        if rng.next_f32() >= fittings.blinds {
            return size.y;
        }
        let (sort, [min, max]) = usual(fittings.blind, &mut rng);
        let height = size.y - Window::SILL - BELOW - ABOVE;
        let cell = size.x / sashes as f32;
        let usual = rng.range(min, max);
        let mut lowest = 0.0f32;
        for k in 0..sashes {
            // Some people let down each as they like.
            let down = if rng.below(4) == 0 { rng.range(min, max) } else { usual };
            lowest = lowest.max(down);
            let blind = Blind { width: cell - 2.0 * BESIDE, height, down, kind: sort };
            let at = Vec3::new(window.x[0] + cell * (k as f32 + 0.5), BACK, window.z[1] - ABOVE - 0.5 * height);
            self.build(&blind, on(self.room.wall_pose(window.wall), at, 0.0));
        }
        (1.0 - lowest) * height - 0.1
    }
}
