//! Lights of suspended ceilings, class lamp: luminous panels of 60 × 60 and 120 × 60 cm, and louvred lights of these sizes with three or four
//! tubes above blades of aluminium. The origin is on the ceiling, and everything hangs below it at negative z.

use crate::builder::{Builder, Class, Object};
use crate::lamplight::Glow;
use crate::materials::{CEILING_TILE_M, Finish};
use crate::pieces::form::{all, cylinder, picture};
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, picture_frame};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A light as large as one or two tiles of a suspended ceiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CeilingPanel {
    /// Tiles along x: one or two.
    pub tiles: u8,
    /// Tubes above louvres instead of a luminous sheet.
    pub louvred: bool,
}

/// Width of the edge that rests on the grid, less than that of the tiles, metres.
const LESS: f32 = 0.006;
/// Depth of a luminous sheet in its frame, and of a louvred light, metres.
const DEPTH: [f32; 2] = [0.011, 0.036];
/// From one blade to the next, metres.
const BLADES: f32 = 0.1;
/// Light of one tube of 60 and of 120 cm: T5 of 14 and 28 W, lumens.
const TUBE_LM: [f32; 2] = [1200.0, 2600.0];
/// Radius of such a tube, metres.
const TUBE: f32 = 0.008;

impl CeilingPanel {
    /// Width and depth.
    fn across(self) -> [f32; 2] {
        [CEILING_TILE_M * f32::from(self.tiles) - LESS, CEILING_TILE_M - LESS]
    }

    fn sheet(self, b: &mut Builder, lamp: &Object) {
        let [w, d] = self.across();
        let frame = picture_frame(w, d, &[[0.0, 0.0], [0.0, DEPTH[0]], [0.016, DEPTH[0]], [0.016, 0.0]]);
        b.part(lamp, "frame", down(frame), Finish::WhiteLacquer);
        let sheet = down(picture(w - 0.03, d - 0.03)).moved(Vec3::new(0.0, 0.0, -0.009));
        let lumens = Glow::WORK.lumens * f32::from(self.tiles);
        b.glow(lamp, "sheet", sheet, Glow { lumens, ..Glow::WORK });
    }

    fn louvre(self, b: &mut Builder, lamp: &Object) {
        let ([w, d], depth) = (self.across(), DEPTH[1]);
        let frame = picture_frame(w, d, &[[0.0, 0.0], [0.0, depth], [0.014, depth], [0.014, 0.0]]);
        let top = board([0.004 - 0.5 * w, 0.004 - 0.5 * d, -0.003], [0.5 * w - 0.004, 0.5 * d - 0.004, -0.0002], 0.0005);
        b.part(lamp, "body", down(frame).with(top), Finish::WhiteLacquer);
        let count = 4 - usize::from(self.tiles > 1);
        let y = |k: usize| d * ((k as f32 + 0.5) / count as f32 - 0.5);
        let length = w - 0.028;
        let tube = |k: usize| cylinder(TUBE, length, 16).turned(Vec3::Y, FRAC_PI_2).moved(Vec3::new(-0.5 * length, y(k), -0.012));
        let lumens = TUBE_LM[usize::from(self.tiles > 1)] * count as f32;
        b.glow(lamp, "tubes", all((0..count).map(tube)), Glow { lumens, ..Glow::WORK });
        let (low, high) = (-depth + 0.002, -0.0215);
        let steps = (w / BLADES).round() as usize;
        let across = (1..steps).map(|k| {
            let x = w * (k as f32 / steps as f32 - 0.5);
            board([x - 0.0006, 0.013 - 0.5 * d, low], [x + 0.0006, 0.5 * d - 0.013, high], 0.0002)
        });
        let along = (1..count).map(|k| {
            let y = d * (k as f32 / count as f32 - 0.5);
            board([0.013 - 0.5 * w, y - 0.001, low - 0.0006], [0.5 * w - 0.013, y + 0.001, high + 0.001], 0.0003)
        });
        b.part(lamp, "louvres", all(across.chain(along)), Finish::Aluminium);
    }
}

/// Turns what faces +y so that it faces down.
fn down(mesh: Mesh) -> Mesh {
    mesh.turned(Vec3::X, -FRAC_PI_2)
}

impl Furniture for CeilingPanel {
    fn random(rng: &mut Rng) -> Self {
        Self { tiles: 1 + rng.below(2) as u8, louvred: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        let [w, d] = self.across();
        Vec3::new(w, d, DEPTH[usize::from(self.louvred)])
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("ceiling_panel", Class::Lamp, pose);
        if self.louvred { self.louvre(b, &lamp) } else { self.sheet(b, &lamp) }
    }
}
