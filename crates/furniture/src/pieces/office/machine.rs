//! Machines that people share or have below the desk: a copier on the floor, a water dispenser with its bottle, and a computer's case; all of
//! class other prop.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, picture, to_front, turned};
use crate::pieces::{Furniture, board};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A copier on the floor.
#[derive(Clone, Copy, Debug)]
pub struct Copier {
    /// Paper trays below each other.
    pub trays: usize,
    /// Grey instead of white.
    pub dark: bool,
}

impl Furniture for Copier {
    fn random(rng: &mut Rng) -> Self {
        Self { trays: 2 + rng.below(3), dark: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.62, 0.66, 1.13)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("copier", Class::OtherProp, pose);
        let [body, trim] =
            if self.dark { [Finish::WhitePlastic, Finish::BlackPlastic] } else { [Finish::CoatedWhite, Finish::WhitePlastic] };
        let (x, y) = (0.31, 0.31);
        b.part(&object, "cabinet", board([-x, -y, 0.03], [x, y - 0.03, 0.62], 0.012), body);
        let foot = |sx: f32, sy: f32| cylinder(0.025, 0.033, 16).moved(Vec3::new(sx * 0.25, sy * 0.24 - 0.01, 0.0));
        b.part(&object, "castors", all([foot(-1.0, -1.0), foot(1.0, -1.0), foot(1.0, 1.0), foot(-1.0, 1.0)]), Finish::BlackPlastic);
        let tray = |k: usize| {
            let step = 0.56 / self.trays as f32;
            let z = 0.05 + step * k as f32;
            let front =
                rounded_box(Vec3::new(2.0 * x - 0.03, 0.03, step - 0.006), 0.006, 2).moved(Vec3::new(0.0, y - 0.0152, z + 0.5 * step));
            let grip = board([-0.09, y - 0.0006, z + 0.62 * step], [0.09, y + 0.006, z + 0.62 * step + 0.02], 0.003);
            [front, grip]
        };
        let [fronts, grips] = [0, 1].map(|i| all((0..self.trays).map(|k| tray(k)[i].clone())));
        b.part(&object, "trays", fronts, body);
        b.part(&object, "grips", grips, Finish::BlackPlastic);
        // The gap above the cabinet takes the printed sheets.
        let spine = board([-x, -y, 0.6202], [x, -0.12, 0.86], 0.004).with(board([0.12, -0.1202, 0.6202], [x, y - 0.06, 0.8598], 0.004));
        b.part(&object, "spine", spine, body);
        b.part(&object, "scanner", rounded_box(Vec3::new(0.62, 0.6, 0.09), 0.014, 3).moved(Vec3::new(0.0, -0.01, 0.9048)), trim);
        let feeder = rounded_box(Vec3::new(0.56, 0.5, 0.13), 0.025, 4).moved(Vec3::new(-0.02, -0.055, 1.0146));
        b.part(&object, "feeder", feeder, body);
        let slot = rounded_box(Vec3::new(0.3, 0.34, 0.03), 0.008, 2).turned(Vec3::Y, -0.12).moved(Vec3::new(0.09, -0.05, 1.093));
        b.part(&object, "paper_tray", slot, trim);
        let tilt = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, 0.9).moved(Vec3::new(0.17, 0.265, 0.93));
        b.part(&object, "panel", tilt(rounded_box(Vec3::new(0.26, 0.018, 0.13), 0.006, 2)), Finish::BlackPlastic);
        b.part(&object, "display", tilt(picture(0.13, 0.085).moved(Vec3::new(0.04, 0.0096, 0.0))), Finish::ScreenOn(3));
        let sheets = b.object("paper", Class::Paper, pose);
        b.part(&sheets, "printed", board([-0.24, -0.1, 0.6206], [0.06, 0.11, 0.634], 0.0005), Finish::Paper);
    }
}

/// A water dispenser with a bottle on it.
#[derive(Clone, Copy, Debug)]
pub struct WaterDispenser;

impl Furniture for WaterDispenser {
    fn random(_rng: &mut Rng) -> Self {
        Self
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.32, 0.36, 1.38)
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("water_dispenser", Class::OtherProp, pose);
        b.part(&object, "body", board([-0.155, -0.175, 0.0], [0.155, 0.12, 0.98], 0.014), Finish::WhitePlastic);
        b.part(&object, "head", board([-0.15, 0.1195, 0.74], [0.15, 0.15, 0.97], 0.008), Finish::WhitePlastic);
        b.part(&object, "niche", board([-0.12, 0.1194, 0.5], [0.12, 0.1216, 0.738], 0.001), Finish::BlackPlastic);
        b.part(&object, "drip_tray", board([-0.11, 0.1212, 0.5], [0.11, 0.178, 0.52], 0.003), Finish::BlackPlastic);
        for (name, x, color) in [("hot", -0.05f32, 0u8), ("cold", 0.05, 2)] {
            let tap = cylinder(0.013, 0.05, 16).moved(Vec3::new(x, 0.148, 0.71));
            b.part(
                &object,
                &format!("tap_{name}"),
                tap.with(board([x - 0.012, 0.1498, 0.745], [x + 0.012, 0.172, 0.765], 0.003)),
                Finish::Plastic(color),
            );
        }
        let ring = [[0.125, 0.0], [0.132, 0.0], [0.134, 0.02], [0.126, 0.14], [0.134, 0.16], [0.126, 0.28], [0.06, 0.36]];
        let mut profile = vec![[0.0, -0.036], [0.04, -0.036], [0.05, -0.02]];
        profile.extend(ring);
        profile.push([0.0, 0.362]);
        let bottle = turned(&profile, 48).moved(Vec3::new(0.0, -0.02, 1.016));
        b.part(&object, "bottle", bottle, Finish::BottleGlass(3));
    }
}

/// A computer's case on the floor or on a desk.
#[derive(Clone, Copy, Debug)]
pub struct ComputerCase {
    /// Grey and black instead of black alone.
    pub light: bool,
}

impl Furniture for ComputerCase {
    fn random(rng: &mut Rng) -> Self {
        Self { light: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.18, 0.43, 0.40)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let object = b.object("computer_case", Class::OtherProp, pose);
        let body = if self.light { Finish::CoatedWhite } else { Finish::BlackMetal };
        b.part(&object, "body", board([-0.088, -0.21, 0.012], [0.088, 0.185, 0.398], 0.004), body);
        b.part(&object, "front", board([-0.089, 0.1852, 0.01], [0.089, 0.212, 0.4], 0.008), Finish::BlackPlastic);
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let feet = feet.map(|(x, y)| cylinder(0.014, 0.0125, 14).moved(Vec3::new(0.065 * x, 0.15 * y, 0.0)));
        b.part(&object, "feet", all(feet), Finish::Rubber);
        let drive = board([-0.072, 0.2118, 0.33], [0.072, 0.2142, 0.362], 0.001);
        let grille = (0..9).map(|k| board([-0.07, 0.2118, 0.06 + 0.014 * k as f32], [0.07, 0.2136, 0.066 + 0.014 * k as f32], 0.0006));
        b.part(&object, "drive", drive, Finish::CoatedWhite);
        b.part(&object, "grille", all(grille), Finish::Aluminium);
        b.part(&object, "switch", to_front(cylinder(0.009, 0.003, 18)).moved(Vec3::new(0.05, 0.2118, 0.285)), Finish::Aluminium);
    }
}
