//! Musical instruments: a guitar that leans back on its stand, and an electric piano of 61 or 88 keys on a stand with sheet music. Guitar
//! and guitar stand are of class other prop, the piano is other furniture, the music paper. The guitar is built upright with its back in
//! the plane y = 0 and then leaned; the pianist sits at +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, cylinder, rod, turned};
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::{Reshape, bevelled_box, disk, rounded_box, spline};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A guitar that leans on its stand.
#[derive(Clone, Copy, Debug)]
pub struct Guitar {
    /// The top is of dark wood instead of light.
    pub dark: bool,
}

/// Half of the body's outline from the end button to the neck: [half width, height], metres.
const BODY: [[f32; 2]; 9] =
    [[0.0, 0.0], [0.11, 0.01], [0.178, 0.07], [0.185, 0.14], [0.135, 0.245], [0.122, 0.28], [0.14, 0.36], [0.115, 0.44], [0.028, 0.478]];
/// How far the guitar leans back, radians.
const LEAN: f32 = 0.24;

impl Furniture for Guitar {
    fn random(rng: &mut Rng) -> Self {
        Self { dark: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.38, 0.50, 1.11)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let guitar = b.object("guitar", Class::OtherProp, pose);
        // Drawn upright, its back at y = 0, then leaned back about its lower end.
        let lean = DAffine3::from_translation(Vec3::new(0.0, 0.10, 0.1125).as_dvec3()) * DAffine3::from_rotation_x(f64::from(LEAN));
        let right = spline(&BODY, 4);
        let outline: Vec<Vec2> =
            right.iter().copied().chain(right.iter().rev().filter(|p| p.x > 1e-4).map(|p| Vec2::new(-p.x, p.y))).collect();
        // Upright: the plate's z becomes depth, its y height; x is mirrored, but the outline is symmetric.
        let upright = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, FRAC_PI_2).turned(Vec3::Z, std::f32::consts::PI);
        let sides = upright(cut_out(&outline, 0.095, 0.003));
        b.part_at(&guitar, "body", grained(sides, rng), lean, Finish::DarkWood);
        let shrunk: Vec<Vec2> = outline.iter().map(|p| (*p - Vec2::new(0.0, 0.24)) * 0.985 + Vec2::new(0.0, 0.24)).collect();
        let top = upright(cut_out(&shrunk, 0.004, 0.001)).moved(Vec3::new(0.0, 0.0945, 0.0));
        b.part_at(&guitar, "top", grained(top, rng), lean, if self.dark { Finish::DarkWood } else { Finish::Wood });
        let face = 0.0987;
        let hole = crate::pieces::form::to_front(disk(0.048, 40)).moved(Vec3::new(0.0, face + 0.0004, 0.325));
        b.part_at(&guitar, "sound_hole", hole, lean, Finish::Soil);
        let rosette = turned(&[[0.049, 0.0], [0.056, 0.0], [0.056, 0.0006], [0.049, 0.0006], [0.049, 0.0]], 40);
        b.part_at(&guitar, "rosette", crate::pieces::form::to_front(rosette).moved(Vec3::new(0.0, face, 0.325)), lean, Finish::Bark);
        b.part_at(&guitar, "bridge", board([-0.07, face - 0.0005, 0.135], [0.07, face + 0.008, 0.16], 0.002), lean, Finish::Bark);
        b.part_at(
            &guitar,
            "neck",
            rounded_box(Vec3::new(0.052, 0.022, 0.40), 0.008, 2).moved(Vec3::new(0.0, face - 0.006, 0.66)),
            lean,
            Finish::DarkWood,
        );
        b.part_at(&guitar, "fingerboard", board([-0.026, face + 0.0045, 0.385], [0.026, face + 0.0105, 0.858], 0.001), lean, Finish::Bark);
        let frets = (0..15).map(|k| {
            let z = 0.15 + 0.705 * 0.5f32.powf(k as f32 / 12.0);
            board([-0.0255, face + 0.0103, z - 0.0008], [0.0255, face + 0.0115, z + 0.0008], 0.0003)
        });
        b.part_at(&guitar, "frets", all(frets), lean, Finish::Brass);
        let head = rounded_box(Vec3::new(0.075, 0.016, 0.14), 0.004, 2).turned(Vec3::X, 0.18).moved(Vec3::new(0.0, face - 0.012, 0.925));
        b.part_at(&guitar, "head", head, lean, Finish::DarkWood);
        let pegs = (0..6).map(|k| {
            let (s, z) = (if k % 2 == 0 { -1.0f32 } else { 1.0 }, 0.885 + 0.038 * (k / 2) as f32);
            rod([s * 0.03, face - 0.014, z], [s * 0.058, face - 0.014, z], 0.0035, 8)
                .with(rounded_box(Vec3::new(0.012, 0.01, 0.016), 0.004, 2).moved(Vec3::new(s * 0.06, face - 0.014, z)))
        });
        b.part_at(&guitar, "pegs", all(pegs), lean, Finish::Chrome);
        let strings = (0..6).map(|k| {
            let x = 0.0085 * (k as f32 - 2.5);
            rod([x * 1.1, face + 0.0095, 0.148], [x * 0.9, face + 0.0135, 0.856], 0.0006, 4)
        });
        b.part_at(&guitar, "strings", all(strings), lean, Finish::Steel);
        self.stand(b, pose);
    }
}

impl Guitar {
    fn stand(&self, b: &mut Builder, pose: DAffine3) {
        let stand = b.object("guitar_stand", Class::OtherProp, pose);
        let mut rods = Vec::new();
        for s in [-1.0f32, 1.0] {
            rods.push(rod([s * 0.02, -0.04, 0.3], [s * 0.16, 0.17, 0.008], 0.0075, 8));
            rods.push(rod([s * 0.09, 0.069, 0.113], [s * 0.09, 0.235, 0.103], 0.0065, 8));
            rods.push(rod([s * 0.09, 0.235, 0.1], [s * 0.09, 0.24, 0.135], 0.0065, 8));
        }
        rods.push(rod([0.0, -0.04, 0.3], [0.0, -0.19, 0.008], 0.0075, 8));
        // The bar on which the guitar leans.
        let (y, z) = (0.0165, 0.43);
        rods.push(rod([0.0, -0.04, 0.29], [0.0, y, z], 0.0075, 8));
        rods.push(rod([-0.1, y, z], [0.1, y, z], 0.0065, 8));
        let feet = [[0.16, 0.17], [-0.16, 0.17], [0.0, -0.19]].map(|[x, y]| cylinder(0.011, 0.016, 12).moved(Vec3::new(x, y, 0.0)));
        rods.extend(feet);
        b.part(&stand, "frame", all(rods), Finish::BlackMetal);
    }
}

/// An electric piano of 61 or 88 keys on a stand, its player at +y.
#[derive(Clone, Copy, Debug)]
pub struct MusicKeyboard {
    /// White keys: 36 or 52.
    pub white_keys: usize,
}

/// Width of a white key, metres: seven of them make an octave of 164.5 mm.
const WHITE: f32 = 0.0235;
/// Height of the keys above the floor, metres.
const KEYS: f32 = 0.72;

impl MusicKeyboard {
    fn width(&self) -> f32 {
        self.white_keys as f32 * WHITE + 0.07
    }
}

impl Furniture for MusicKeyboard {
    fn random(rng: &mut Rng) -> Self {
        Self { white_keys: [36, 52][rng.below(2)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width(), 0.34, KEYS + 0.24)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let piano = b.object("music_keyboard", Class::OtherFurniture, pose);
        let (w, low) = (self.width(), KEYS - 0.095);
        let half = 0.5 * w;
        b.part(&piano, "bed", board([-half, -0.16, low], [half, 0.16, low + 0.06], 0.004), Finish::BlackPlastic);
        b.part(&piano, "panel", board([-half, -0.16, low + 0.0598], [half, -0.0, low + 0.115], 0.006), Finish::BlackPlastic);
        let cheek = |x: f32| board([x, 0.0002, low + 0.0598], [x + 0.034, 0.16, low + 0.112], 0.004);
        b.part(&piano, "cheeks", cheek(-half).with(cheek(half - 0.034)), Finish::BlackPlastic);
        let x = |k: f32| half - 0.035 - WHITE * k;
        let whites = (0..self.white_keys)
            .map(|k| bevelled_box(Vec3::new(WHITE - 0.001, 0.148, 0.02), 0.001).moved(Vec3::new(x(k as f32 + 0.5), 0.078, KEYS - 0.018)));
        b.part(&piano, "white_keys", all(whites), Finish::WhitePlastic);
        let blacks = (1..self.white_keys)
            .filter(|k| !matches!(k % 7, 0 | 3))
            .map(|k| bevelled_box(Vec3::new(0.011, 0.09, 0.016), 0.002).moved(Vec3::new(x(k as f32), 0.049, KEYS - 0.0005)));
        b.part(&piano, "black_keys", all(blacks), Finish::BlackPlastic);
        let knobs = (0..6).map(|k| cylinder(0.008, 0.01, 16).moved(Vec3::new(half - 0.12 - 0.05 * k as f32, -0.08, low + 0.1148)));
        b.part(&piano, "knobs", all(knobs), Finish::Aluminium);
        b.part(&piano, "display", board([-0.08, -0.11, low + 0.1146], [0.08, -0.05, low + 0.1158], 0.0004), Finish::Screen);
        let rest = board([-0.22, -0.004, 0.0], [0.22, 0.0, 0.16], 0.001).turned(Vec3::X, 0.3).moved(Vec3::new(0.0, -0.11, low + 0.1145));
        b.part(&piano, "music_rest", rest, Finish::BlackPlastic);
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let (y, at, radius) = (0.13, s * (half - 0.2), 0.0125);
            let cross = rod([at, -y, 0.012], [at, y, low - 0.01], radius, 10).with(rod(
                [at + 0.03, y, 0.012],
                [at + 0.03, -y, low - 0.01],
                radius,
                10,
            ));
            let bars = all([-y, y].map(|y| rod([at - 0.04, y, low - 0.0127], [at + 0.07, y, low - 0.0127], radius, 10)));
            let feet = all([-y, y].map(|y| rod([at - 0.05, y, radius], [at + 0.08, y, radius], radius, 10)));
            b.part(&piano, &format!("stand_{}", i + 1), all([cross, bars, feet]), Finish::BlackMetal);
        }
        let music = b.object("sheet_music", Class::Paper, on(pose, Vec3::new(0.0, -0.11, low + 0.1145), 0.0));
        for (i, s) in [-1.0f32, 1.0].into_iter().enumerate() {
            let sheet = bevelled_box(Vec3::new(0.205, 0.001, 0.15), 0.0003)
                .moved(Vec3::new(s * 0.104, 0.001 + CONTACT, 0.077))
                .turned(Vec3::X, 0.3);
            b.part(&music, &format!("sheet_{}", i + 1), sheet, Finish::Paper);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::scene_of;
    use enfilade_math::place;

    #[test]
    fn a_guitar_leans_on_the_bar_of_its_stand() {
        let scene = scene_of(&Guitar { dark: false }, 0);
        let [body, frame] = ["guitar_1/body", "guitar_stand_1/frame"]
            .map(|name| scene.parts.iter().find(|part| part.name == name).expect("the scene has the part"));
        // The back is the plane y = 0 of the upright guitar, and the bar is the highest part of the stand.
        let upright = body.world_from_mesh.inverse();
        let bar = scene.world_positions(frame).filter(|p| p.z > 0.42).map(|p| place(&upright, p).y).fold(f32::NEG_INFINITY, f32::max);
        assert!(bar.abs() < 0.003, "{bar} m before the back");
    }
}
