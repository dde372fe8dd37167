//! To listen and play: a record player with a record and perhaps an open lid, loudspeakers for a shelf (26 to 36 cm) or the floor (85 to
//! 105 cm), and a game console with its controller; all of class other prop, their fronts to +y.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front, turned};
use crate::pieces::{CONTACT, Furniture, board, grained, on};
use crate::shape::{Reshape, bevelled_box, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec3};

/// A record player with a record on it.
#[derive(Clone, Copy, Debug)]
pub struct RecordPlayer {
    /// Finish of the plinth.
    pub finish: Finish,
    /// A cover of clear plastic is on it, open.
    pub lid: bool,
}

impl Furniture for RecordPlayer {
    fn random(rng: &mut Rng) -> Self {
        Self { finish: [Finish::Wood, Finish::BlackPlastic, Finish::WhiteLacquer, Finish::DarkWood][rng.below(4)], lid: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        if self.lid { Vec3::new(0.44, 0.47, 0.46) } else { Vec3::new(0.44, 0.36, 0.16) }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let forward = if self.lid { 0.05 } else { 0.0 };
        let player = b.object("record_player", Class::OtherProp, on(pose, Vec3::new(0.0, forward, CONTACT), 0.0));
        let feet = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| cylinder(0.022, 0.021, 20).moved(Vec3::new(0.18 * x, 0.14 * y, 0.0)));
        b.part(&player, "feet", all(feet), Finish::Rubber);
        b.part(&player, "plinth", grained(board([-0.22, -0.18, 0.02], [0.22, 0.18, 0.08], 0.003), rng), self.finish);
        // Where things on the plinth begin: half a millimetre inside it.
        let top = 0.0795;
        let at = Vec3::new(0.045, 0.0, 0.0);
        b.part(&player, "platter", cylinder(0.152, 0.018, 64).moved(at + Vec3::new(0.0, 0.0, top)), Finish::Aluminium);
        let z = 0.0977;
        let record =
            [[0.0, z], [0.15, z], [0.1505, z + 0.001], [0.149, z + 0.002], [0.052, z + 0.0018], [0.05, z + 0.0015], [0.0, z + 0.0015]];
        b.part(&player, "record", turned(&record, 72).moved(at), Finish::GlossBlack);
        b.part(
            &player,
            "label",
            cylinder(0.049, 0.0006, 40).moved(at + Vec3::new(0.0, 0.0, z + 0.0014)),
            Finish::Plastic(rng.below(5) as u8),
        );
        b.part(&player, "spindle", cylinder(0.0035, 0.02, 12).moved(at + Vec3::new(0.0, 0.0, z)), Finish::Chrome);
        let pivot = Vec3::new(-0.165, -0.11, top);
        let arm = crate::pieces::form::wire(
            &[[pivot.x, -0.15, 0.12], [pivot.x, -0.09, 0.12], [-0.15, 0.04, 0.119], [-0.075, 0.115, 0.108]],
            0.0045,
            10,
        );
        let rest = cylinder(0.028, 0.03, 28).moved(pivot).with(cylinder(0.012, 0.02, 20).moved(pivot + Vec3::new(0.0, 0.0, 0.0298)));
        let weight = cylinder(0.016, 0.028, 20).turned(Vec3::X, std::f32::consts::FRAC_PI_2).moved(Vec3::new(pivot.x, -0.142, 0.12));
        b.part(&player, "arm", all([arm, rest, weight]), Finish::Chrome);
        b.part(
            &player,
            "head",
            bevelled_box(Vec3::new(0.016, 0.03, 0.01), 0.002).turned(Vec3::Z, 0.6).moved(Vec3::new(-0.067, 0.121, 0.105)),
            Finish::BlackPlastic,
        );
        b.part(&player, "speed", cylinder(0.014, 0.012, 24).moved(Vec3::new(-0.18, 0.14, top)), Finish::Aluminium);
        if self.lid {
            let pane = |size: Vec3, at: Vec3| bevelled_box(size, 0.001).moved(at);
            let (w, d, h, t) = (0.43, 0.35, 0.06, 0.003);
            let lid = all([
                pane(Vec3::new(w, t, d), Vec3::new(0.0, 0.0, 0.5 * d)),
                pane(Vec3::new(t, h - t, d), Vec3::new(0.5 * (w - t), 0.5 * h, 0.5 * d)),
                pane(Vec3::new(t, h - t, d), Vec3::new(-0.5 * (w - t), 0.5 * h, 0.5 * d)),
                pane(Vec3::new(w - 2.0 * t, h - t, t), Vec3::new(0.0, 0.5 * h, d - 0.5 * t)),
            ]);
            b.part(&player, "lid", lid.turned(Vec3::X, 0.2).moved(Vec3::new(0.0, -0.178, 0.08)), Finish::DrinkingGlass);
        }
    }
}

/// A loudspeaker for a shelf, or a tall one for the floor.
#[derive(Clone, Copy, Debug)]
pub struct Speaker {
    /// Height of the box.
    pub height: f32,
    /// Finish of the box.
    pub finish: Finish,
    /// A cloth hides the drivers.
    pub grille: bool,
}

impl Speaker {
    /// A random one that stands on the floor.
    pub fn tall(rng: &mut Rng) -> Self {
        Self { height: rng.range(0.85, 1.05), ..Self::random(rng) }
    }
}

impl Furniture for Speaker {
    fn random(rng: &mut Rng) -> Self {
        Self {
            height: rng.range(0.26, 0.36),
            finish: [Finish::Wood, Finish::BlackPlastic, Finish::WhiteLacquer, Finish::DarkWood][rng.below(4)],
            grille: rng.below(3) == 0,
        }
    }

    fn size(&self) -> Vec3 {
        let w = if self.height > 0.5 { 0.2 } else { 0.6 * self.height };
        Vec3::new(w, if self.height > 0.5 { 0.3 } else { 0.24 }, self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let speaker = b.object("speaker", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let size = self.size() - Vec3::new(0.0, 0.0, CONTACT);
        let y = 0.5 * size.y - 0.018;
        let low = if self.height > 0.5 { 0.03 } else { 0.0 };
        b.part(&speaker, "box", grained(board([-0.5 * size.x, -0.5 * size.y, low], [0.5 * size.x, y, size.z], 0.004), rng), self.finish);
        if low > 0.0 {
            let foot = board([-0.5 * size.x, -0.5 * size.y, 0.0], [0.5 * size.x, y, low - 0.0003], 0.003);
            b.part(&speaker, "foot", foot.deformed(|p| Vec3::new(0.92 * p.x, 0.95 * p.y, p.z)).smoothed(20.0), Finish::BlackMetal);
        }
        if self.grille {
            let cloth = rounded_box(Vec3::new(size.x - 0.016, 0.014, size.z - low - 0.02), 0.005, 2);
            b.part(&speaker, "grille", cloth.moved(Vec3::new(0.0, y + 0.0072, 0.5 * (low + size.z))), Finish::Felt);
            return;
        }
        let r = 0.40 * size.x;
        let ring = |r: f32| {
            to_front(turned(&[[r - 0.012, 0.0], [r, 0.0], [r, 0.004], [r - 0.006, 0.006], [r - 0.012, 0.004], [r - 0.012, 0.0]], 44))
        };
        let cone = |r: f32| {
            // Small cones are narrow beside their surround.
            let dip = (0.36 * r).min(r - 0.022);
            let cap = (0.3 * r).min(dip - 0.001);
            to_front(turned(
                &[[0.0, 0.0], [r - 0.011, 0.0], [r - 0.012, 0.004], [r - 0.02, 0.006], [dip, 0.0022], [cap, 0.006], [0.0, 0.009]],
                44,
            ))
        };
        let tweeter = Vec3::new(0.0, y - 0.0002, size.z - 0.5 * size.x);
        let mut drivers = vec![(tweeter, 0.45 * r), (tweeter - Vec3::new(0.0, 0.0, 1.6 * r), r)];
        if low > 0.0 {
            drivers.push((tweeter - Vec3::new(0.0, 0.0, 3.8 * r), r));
            drivers.push((tweeter - Vec3::new(0.0, 0.0, 6.0 * r), r));
        }
        b.part(&speaker, "cones", all(drivers.iter().map(|&(at, r)| cone(r).moved(at))), Finish::BlackPlastic);
        b.part(&speaker, "rings", all(drivers.iter().map(|&(at, r)| ring(r).moved(at))), Finish::Aluminium);
    }
}

/// A game console with its controller before it.
#[derive(Clone, Copy, Debug)]
pub struct GameConsole {
    /// Console and controller are white instead of black.
    pub white: bool,
}

impl Furniture for GameConsole {
    fn random(rng: &mut Rng) -> Self {
        Self { white: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.30, 0.38, 0.068)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let body = if self.white { Finish::WhitePlastic } else { Finish::BlackPlastic };
        let console = b.object("game_console", Class::OtherProp, on(pose, Vec3::new(0.0, -0.085, CONTACT), 0.0));
        b.part(
            &console,
            "core",
            rounded_box(Vec3::new(0.285, 0.19, 0.046), 0.006, 2).moved(Vec3::new(0.0, 0.0, 0.032)),
            Finish::BlackPlastic,
        );
        for (name, z) in [("lower", 0.005), ("upper", 0.059)] {
            b.part(&console, name, rounded_box(Vec3::new(0.30, 0.2, 0.0098), 0.004, 2).moved(Vec3::new(0.0, 0.0, z)), body);
        }
        b.part(&console, "slot", board([-0.08, 0.0945, 0.036], [0.08, 0.0956, 0.04], 0.0003), Finish::Soil);
        let pad =
            b.object("controller", Class::OtherProp, on(pose, Vec3::new(rng.range(-0.06, 0.06), 0.12, CONTACT), rng.range(-0.3, 0.3)));
        let grips = [-1.0f32, 1.0].map(|s| {
            rounded_box(Vec3::new(0.04, 0.085, 0.036), 0.0175, 4).turned(Vec3::Z, s * 0.35).moved(Vec3::new(s * 0.056, 0.015, 0.0185))
        });
        let bridge = rounded_box(Vec3::new(0.12, 0.055, 0.03), 0.013, 4).moved(Vec3::new(0.0, -0.008, 0.022));
        b.part(&pad, "grips", all(grips).with(bridge), body);
        let sticks = [-1.0f32, 1.0].map(|s| {
            cylinder(0.0045, 0.01, 12).moved(Vec3::new(s * 0.026, 0.006, 0.0365)).with(cylinder(0.0095, 0.005, 20).moved(Vec3::new(
                s * 0.026,
                0.006,
                0.046,
            )))
        });
        let cross = rod([0.046, -0.014, 0.038], [0.062, -0.014, 0.038], 0.003, 6).with(rod(
            [0.054, -0.022, 0.038],
            [0.054, -0.006, 0.038],
            0.003,
            6,
        ));
        let buttons = [(0.0f32, 1.0f32), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
            .map(|(x, y)| cylinder(0.004, 0.003, 12).moved(Vec3::new(-0.054 + 0.009 * x, -0.014 + 0.009 * y, 0.0365)));
        b.part(&pad, "controls", all(sticks.into_iter().chain(buttons).chain([cross])), Finish::Rubber);
    }
}
