//! A rectangular woollen rug of 160 to 260 × 110 to 150 cm, class floor mat, its long side along x. Its picture is stretched over the whole
//! of it, and other furniture stands on it at [`Rug::TOP`].

use super::{CONTACT, Furniture};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::Reshape;
use crate::shape::rounded_box;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A rectangular rug, its long side along x.
#[derive(Clone, Copy, Debug)]
pub struct Rug {
    /// Long and short side.
    pub size: Vec2,
}

impl Rug {
    /// Height of its surface above the floor, metres.
    pub const TOP: f32 = 0.0105;
}

impl Furniture for Rug {
    fn random(rng: &mut Rng) -> Self {
        Self { size: Vec2::new(rng.range(1.6, 2.6), rng.range(1.1, 1.5)) }
    }

    fn size(&self) -> Vec3 {
        self.size.extend(Self::TOP)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("rug", Class::FloorMat, pose);
        let thickness = Self::TOP - CONTACT;
        let mut mesh = rounded_box(self.size.extend(thickness), 0.0045, 2).moved(Vec3::new(0.0, 0.0, CONTACT + 0.5 * thickness));
        // The picture covers the whole rug.
        for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
            *uv = p.truncate() / self.size + 0.5;
        }
        b.part(&object, "pile", mesh, Finish::RugWool);
    }
}
