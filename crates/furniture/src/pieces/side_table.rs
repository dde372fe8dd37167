//! A small round table beside a sofa, 40 to 46 cm across and 48 to 54 cm high, class table: a wooden top on a foot of black metal or on
//! three wooden legs.

use super::dining_table::round_top;
use super::{Furniture, grained, standing};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, lathe, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A small round table beside the sofa, on one foot or on three legs.
#[derive(Clone, Copy, Debug)]
pub struct SideTable {
    /// Diameter of the top.
    pub diameter: f32,
    /// Height of the top's surface.
    pub height: f32,
    /// On one foot instead of three legs.
    pub pedestal: bool,
}

impl Furniture for SideTable {
    fn random(rng: &mut Rng) -> Self {
        Self { diameter: rng.range(0.40, 0.46), height: rng.range(0.48, 0.54), pedestal: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.diameter, self.diameter, self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("side_table", Class::Table, pose);
        let radius = 0.5 * self.diameter;
        b.part(&table, "top", grained(round_top(radius, 0.02).moved(Vec3::new(0.0, 0.0, self.height)), rng), Finish::Wood);
        if self.pedestal {
            let h = self.height - 0.0195;
            let profile = [
                [0.0, 0.0],
                [0.15, 0.0],
                [0.153, 0.004],
                [0.15, 0.009],
                [0.03, 0.016],
                [0.014, 0.03],
                [0.014, h - 0.02],
                [0.05, h],
                [0.0, h],
            ];
            b.part(&table, "foot", lathe(&profile.map(Vec2::from_array), 40), Finish::BlackMetal);
        } else {
            for i in 0..3 {
                let out = Vec2::from_angle(0.5 + i as f32 * std::f32::consts::TAU / 3.0) * radius;
                let path = [(out * 0.92).extend(0.0), (out * 0.55).extend(self.height - 0.0195)];
                b.part(&table, &format!("leg_{}", i + 1), grained(standing(tube(&path, 0.013, 14)), rng), Finish::Wood);
            }
        }
    }
}
