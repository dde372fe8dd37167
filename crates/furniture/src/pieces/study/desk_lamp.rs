//! Desk lamps, class lamp: a bell on an arm with two joints, or a bar of light on a post. The length of an arm, 26 to 32 cm, varies. The
//! bell reaches to +y, the bar to one side.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, turned};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, rounded_box, sphere};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A lamp on a jointed arm, or a bar of light on a post; it reaches to the front (+y).
#[derive(Clone, Copy, Debug)]
pub struct DeskLamp {
    /// A bar of light on a post instead of a bell on an arm.
    pub bar: bool,
    /// Length of either arm.
    pub arm: f32,
    /// What foot, arms and bell are made of.
    pub finish: Finish,
}

impl DeskLamp {
    /// Foot, elbow and head of the arm, as (y, z).
    fn joints(&self) -> [Vec2; 3] {
        let foot = Vec2::new(-0.5 * self.size().y + 0.105, 0.03);
        let elbow = foot + Vec2::from_angle(1.85) * self.arm;
        [foot, elbow, elbow + Vec2::from_angle(0.42) * self.arm]
    }
}

impl Furniture for DeskLamp {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::BlackMetal, Finish::CoatedWhite, Finish::Brass, Finish::ColoredMetal(rng.below(4) as u8)][rng.below(4)];
        Self { bar: rng.below(3) == 0, arm: rng.range(0.26, 0.32), finish }
    }

    fn size(&self) -> Vec3 {
        let a = self.arm;
        if self.bar { Vec3::new(0.46, 0.17, a + 0.17) } else { Vec3::new(0.17, 0.25 + 0.64 * a, 0.05 + 1.37 * a + 0.09) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("desk_lamp", Class::Lamp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let foot = turned(&[[0.0, 0.0], [0.08, 0.0], [0.083, 0.004], [0.08, 0.016], [0.02, 0.024], [0.0, 0.024]], 44);
        if self.bar {
            // The bar reaches out to one side.
            let x = -0.14;
            b.part(&lamp, "foot", foot.moved(Vec3::X * x), self.finish);
            let z = self.arm + 0.14;
            b.part(&lamp, "post", rod([x, 0.0, 0.02], [x, 0.0, z], 0.009, 16), self.finish);
            b.part(&lamp, "head", rounded_box(Vec3::new(0.46, 0.035, 0.018), 0.006, 3).moved(Vec3::new(0.0, 0.0, z + 0.008)), self.finish);
            b.part(
                &lamp,
                "light",
                rounded_box(Vec3::new(0.43, 0.02, 0.004), 0.001, 1).moved(Vec3::new(0.0, 0.0, z - 0.0025)),
                Finish::OpalGlobe,
            );
            return;
        }
        let [p, q, r] = self.joints();
        b.part(&lamp, "foot", foot.moved(Vec3::new(0.0, p.x, 0.0)), self.finish);
        let rods = |from: Vec2, to: Vec2| all([-0.011, 0.011].map(|x| rod([x, from.x, from.y], [x, to.x, to.y], 0.0042, 8)));
        let joint = |at: Vec2| cylinder(0.014, 0.034, 20).turned(Vec3::Y, std::f32::consts::FRAC_PI_2).moved(Vec3::new(-0.017, at.x, at.y));
        b.part(&lamp, "arms", all([rods(p, q), rods(q, r), joint(p), joint(q), joint(r)]), self.finish);
        // The bell hangs from the head, turned towards the desk.
        let rim = [0.062, -0.095];
        let wall = [[0.016, 0.0], [0.03, -0.005], [0.045, -0.045], rim];
        let mut bell: Vec<[f32; 2]> = vec![rim];
        bell.extend(wall.iter().rev().skip(1).copied());
        bell.extend([[0.0, 0.002], [0.0, -0.001], [0.015, -0.003]]);
        bell.extend(wall.iter().skip(1).map(|p| [p[0] - 0.0018, p[1] - 0.0005]));
        bell.push(rim);
        let place = |mesh: enfilade_geometry::Mesh| mesh.turned(Vec3::X, -0.35).moved(Vec3::new(0.0, r.x + 0.004, r.y + 0.014));
        b.part(&lamp, "bell", place(turned(&bell, 36)), self.finish);
        b.part(&lamp, "bulb", place(sphere(0.026, 18).moved(Vec3::new(0.0, 0.0, -0.058))), Finish::Bulb);
        b.part(&lamp, "socket", place(cylinder(0.013, 0.034, 16).moved(Vec3::new(0.0, 0.0, -0.036))), Finish::BlackPlastic);
    }
}
