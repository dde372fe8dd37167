//! Blankets folded to a parcel of 42 × 32 cm in three to five layers (class other prop), and cushions of 38 to 50 cm that lie flat (class
//! pillow), in an accent colour of the palette; some blankets are knitted.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::soft::folded;
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, pillow};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A blanket folded several times.
#[derive(Clone, Copy, Debug)]
pub struct FoldedBlanket {
    /// Layers on each other.
    pub folds: usize,
    /// Knitted wool instead of woven cloth in an accent colour.
    pub knitted: bool,
}

impl Furniture for FoldedBlanket {
    fn random(rng: &mut Rng) -> Self {
        Self { folds: 3 + rng.below(3), knitted: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.44, 0.34, 0.026 * self.folds as f32 + 0.006)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let blanket = b.object("blanket", Class::OtherProp, pose);
        let finish = if self.knitted { Finish::KnittedThrow } else { Finish::Accent(rng.below(3) as u8) };
        let size = Vec3::new(0.42, 0.32, 0.026 * self.folds as f32);
        let parcel = folded(size, self.folds, rng).uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&blanket, "folds", parcel.moved(Vec3::Z * CONTACT), finish);
    }
}

/// A cushion that lies flat.
#[derive(Clone, Copy, Debug)]
pub struct ScatterCushion {
    /// Length of its edges.
    pub size: Vec2,
    /// Index of its accent colour.
    pub color: u8,
}

impl Furniture for ScatterCushion {
    fn random(rng: &mut Rng) -> Self {
        let edge = rng.range(0.38, 0.5);
        Self { size: Vec2::new(edge, if rng.below(3) == 0 { 0.62 * edge } else { edge }), color: rng.below(3) as u8 }
    }

    fn size(&self) -> Vec3 {
        self.size.extend(0.155)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        /// Where the lower side is flat, below the cushion's middle plane as a share of its thickness.
        const SUNK: f32 = 0.34;
        let thickness = 0.14;
        // Its weight flattens the lower side.
        let mesh = pillow(self.size, thickness, rng).deformed(|p| Vec3::new(p.x, p.y, p.z.max(-SUNK * thickness))).smoothed(70.0);
        let cushion = b.object("cushion", Class::Pillow, on(pose, Vec3::new(0.0, 0.0, CONTACT + SUNK * thickness), 0.0));
        b.part(&cushion, "cover", mesh.uv_moved(Vec2::splat(rng.next_f32())), Finish::Accent(self.color));
    }
}
