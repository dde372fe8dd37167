//! A small dining table of wood, round (two in three) or square, 82 to 95 cm across, of class table: a top, four splayed legs and the rails
//! between them. [`round_top`] also makes the tops of other tables.

use super::{Furniture, board, grained, leg, on};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, lathe};
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3};

/// A small dining table, round or square.
#[derive(Clone, Copy, Debug)]
pub struct DiningTable {
    /// Diameter, or edge length.
    pub width: f32,
    /// Round instead of square.
    pub round: bool,
}

/// Height of the top's surface, metres: dining tables are 72 to 76 cm high.
pub const TOP: f32 = 0.74;

impl DiningTable {
    /// Height of the surface that things stand on.
    pub const TOP: f32 = TOP;
}

impl Furniture for DiningTable {
    fn random(rng: &mut Rng) -> Self {
        Self { width: rng.range(0.82, 0.95), round: rng.below(3) > 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, self.width, TOP)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("dining_table", Class::Table, pose);
        let half = 0.5 * self.width;
        let wood = Finish::Wood;
        let top = if self.round { round_top(half, 0.028) } else { board([-half, -half, -0.028], [half, half, 0.0], 0.004) };
        b.part(&table, "top", grained(top.moved(Vec3::new(0.0, 0.0, TOP)), rng), wood);
        let stand = if self.round { 0.56 * half } else { half - 0.06 };
        for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
            let mesh = leg(TOP - 0.0275, [0.015, 0.026], s * 0.044);
            let at = on(DAffine3::IDENTITY, (s * stand).extend(0.0), 0.0);
            b.part_at(&table, &format!("leg_{}", i + 1), grained(mesh, rng), at, wood);
        }
        let apron = stand - 0.012;
        for i in 0..4 {
            // Two run into the legs, the others end at them.
            let end = if i % 2 == 0 { apron } else { apron - 0.0092 };
            let rail = board([-end, -0.009, -0.085], [end, 0.009, -0.0275], 0.002);
            let at = DAffine3::from_rotation_z(f64::from(i) * std::f64::consts::FRAC_PI_2)
                * DAffine3::from_translation(DVec3::new(0.0, f64::from(apron), f64::from(TOP)));
            b.part_at(&table, &format!("rail_{}", i + 1), grained(rail, rng), at, wood);
        }
    }
}

/// A round board with a chamfered edge, its surface at z = 0; the grain runs along x.
pub fn round_top(radius: f32, thickness: f32) -> enfilade_geometry::Mesh {
    let profile =
        [[0.0, -thickness], [radius - 0.02, -thickness], [radius - 0.002, -0.009], [radius, -0.006], [radius - 0.004, 0.0], [0.0, 0.0]];
    let mut mesh = lathe(&profile.map(Vec2::from_array), 72);
    for (uv, p) in mesh.uvs.iter_mut().zip(&mesh.positions) {
        *uv = Vec2::new(p.x, p.y + p.z);
    }
    mesh
}
