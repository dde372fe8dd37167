//! Two curtains of linen, drawn aside, on rings on a rod of black metal over a window. The rod with its brackets and each curtain with its
//! rings are objects of class curtain. The window gives their sizes. The rod's space begins on the floor below the middle of the opening,
//! with y = 0 on the wall's face; that of a curtain begins on the rod above its middle.

use super::WallOpening;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::shape::{Reshape, curtain, lathe, sphere, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Two curtains, drawn aside, on a rod before a window.
#[derive(Clone, Copy, Debug)]
pub struct Curtains {
    /// Width of each hanging curtain.
    pub width: f32,
    /// How far the rod reaches beyond the opening at its smaller and at its larger x.
    pub beyond: [f32; 2],
}

/// The rod's distance from the wall, metres: the folds hang before the sill.
const OUT: f32 = 0.105;

impl Curtains {
    /// Depth of the space before the wall that they take, metres.
    pub const DEPTH: f32 = OUT + 0.06;

    /// Adds the curtains of a window; the ceiling is `ceiling` metres above the floor.
    pub fn build(&self, b: &mut Builder, opening: &WallOpening, ceiling: f32, rng: &mut Rng) {
        let rod_z = (opening.z[1] + 0.14).min(ceiling - 0.06);
        let pose = opening.pose(0.0);
        let object = b.object("curtain_rod", Class::Curtain, pose);
        let metal = Finish::BlackMetal;
        let ends = self.beyond.map(|beyond| 0.5 * opening.size().x + beyond);
        b.part(&object, "rod", tube(&[Vec3::new(-ends[0], OUT, rod_z), Vec3::new(ends[1], OUT, rod_z)], 0.0125, 18), metal);
        for (name, s, half) in [("left", -1.0, ends[0]), ("right", 1.0, ends[1])] {
            b.part(&object, &format!("finial_{name}"), sphere(0.023, 20).moved(Vec3::new(s * (half + 0.012), OUT, rod_z)), metal);
            let x = s * (half - 0.03);
            let flange = lathe(&[[0.0, 0.0], [0.028, 0.0], [0.028, 0.006], [0.0, 0.006]].map(Vec2::from_array), 24)
                .turned(Vec3::X, -std::f32::consts::FRAC_PI_2);
            let bracket = tube(&[Vec3::new(x, 0.004, rod_z), Vec3::new(x, OUT - 0.011, rod_z)], 0.007, 12)
                .with(flange.moved(Vec3::new(x, -0.0005, rod_z)));
            b.part(&object, &format!("bracket_{name}"), bracket, metal);
            self.hang(b, super::on(pose, Vec3::new(s * (half - 0.065 - 0.5 * self.width), OUT, rod_z), 0.0), rod_z, rng);
        }
    }

    fn hang(&self, b: &mut Builder, pose: DAffine3, rod_z: f32, rng: &mut Rng) {
        let object = b.object("curtain", Class::Curtain, pose);
        let folds = (self.width / 0.07) as usize;
        let top = -0.034;
        let mesh = curtain(self.width, rod_z + top - 0.012, folds, 0.075, rng).moved(Vec3::new(0.0, 0.0, top));
        b.part(&object, "cloth", mesh, Finish::CurtainLinen);
        let ring: Vec<Vec3> = (0..=24)
            .map(|k| {
                let (sin, cos) = (k as f32 / 24.0 * std::f32::consts::TAU).sin_cos();
                Vec3::new(0.0, 0.0185 * cos, 0.0185 * sin - 0.004)
            })
            .collect();
        for k in 0..folds {
            let x = self.width * ((k as f32 + 0.5) / folds as f32 - 0.5);
            let clip = tube(&ring, 0.0022, 6).with(tube(&[Vec3::new(0.0, 0.0, -0.0225), Vec3::new(0.0, 0.0, top - 0.012)], 0.0025, 6));
            let at = DAffine3::from_translation(Vec3::new(x, 0.0, 0.0).as_dvec3());
            b.part_at(&object, &format!("ring_{}", k + 1), clip, at, Finish::BlackMetal);
        }
    }
}
