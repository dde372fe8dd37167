//! Bathtubs, of class bathtub: built in with one of three common sizes from 160 × 70 to 180 × 80 cm, or free-standing ovals of about the
//! same size; and showers, of class other structure: closed with a tray of 80 to 100 cm or walk-in with 120 to 150 cm. A shower curtain is
//! an object of its own. Their back, at −y, is at the wall; tub or tray is off the middle of the footprint if taps or a curtain protrude.

use super::ceramic::{Section, hollow, rectangle, rounding, waste};
use super::tap::{fittings, shower_set, wall_mixer};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front, wire};
use crate::pieces::{Furniture, board, on};
use crate::shape::{Reshape, curtain, grid, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// The screen that keeps the water in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TubScreen {
    /// No screen and no curtain.
    None,
    /// A curtain on a rail.
    Curtain,
    /// A pane on the rim.
    Pane,
}

/// A bathtub.
#[derive(Clone, Copy, Debug)]
pub struct Bathtub {
    /// Length and width of the rim.
    pub size: Vec2,
    /// The tub is free-standing and oval; otherwise it is built in, with its back and one end at walls.
    pub free: bool,
    /// The screen that keeps the water in; only built-in tubs have one.
    pub screen: TubScreen,
    /// The panel below the rim is tiled instead of white.
    pub tiled: bool,
    /// Finish of taps and rails.
    pub metal: Finish,
}

/// Height of a tub's rim, metres.
const RIM: f32 = 0.58;
/// Height of a shower curtain's rail, metres: above people's heads.
const RAIL: f32 = 2.0;

impl Bathtub {
    /// The sections of a free-standing tub: of its outside from the floor up to the rim, and of its inside from there down.
    fn oval(&self) -> [Vec<Section>; 2] {
        let [w, d] = self.size.to_array();
        let at = |w: f32, d: f32, z: f32| rectangle(w, d, 0.5 * d - 0.001, 0.0, z);
        let (foot, rim) = (at(0.82 * w, 0.80 * d, 0.0), at(w, d, RIM));
        let inside = vec![
            at(w - 0.012, d - 0.012, RIM + 0.006),
            at(w - 0.04, d - 0.04, RIM + 0.006),
            at(w - 0.052, d - 0.052, RIM),
            at(0.90 * w, d - 0.10, 0.72 * RIM),
            at(0.80 * w - 0.06, 0.80 * d - 0.06, 0.26),
            at(0.66 * w - 0.06, 0.62 * d - 0.06, 0.13),
        ];
        let raised = Section { z: 0.01, ..foot.clone() };
        let mut outside = vec![foot, raised.clone()];
        outside.extend((1..8).map(|k| {
            let t = k as f32 / 8.0;
            let outline = raised.outline.iter().zip(&rim.outline).map(|(a, b)| a.lerp(*b, t.powf(1.4))).collect();
            Section { outline, y: 0.0, z: 0.01 + (RIM - 0.01) * t }
        }));
        outside.push(rim);
        [outside, inside]
    }

    fn free_standing(&self, b: &mut Builder, tub: &Object) {
        let [outside, inside] = self.oval();
        b.part(tub, "body", hollow(&outside, &inside), Finish::Porcelain);
        b.part(tub, "waste", waste(0.033).moved(Vec3::new(0.0, 0.0, 0.1305)), self.metal);
        // A tap on the floor beside it.
        let y = -0.5 * self.size.y - 0.075;
        let x = 0.22 * self.size.x;
        let spout = wire(
            &[[x, y, 0.0], [x, y, 0.86], [x, y + 0.03, 0.91], [x, y + 0.09, 0.93], [x, y + 0.22, 0.92], [x, y + 0.24, 0.89]],
            0.013,
            16,
        );
        let foot = cylinder(0.04, 0.01, 28).moved(Vec3::new(x, y, 0.0));
        let lever = rod([x, y, 0.74], [x + 0.07, y, 0.76], 0.008, 12);
        b.part(tub, "tap", all([spout, foot, lever]), self.metal);
    }

    fn built_in(&self, b: &mut Builder, tub: &Object) {
        let [w, d] = self.size.to_array();
        let at = |inset: f32, radius: f32, z: f32| rectangle(w - 2.0 * inset, d - 2.0 * inset, radius, 0.0, z);
        let outside = [
            at(0.012, 0.004, 0.0),
            at(0.012, 0.004, RIM - 0.038),
            at(0.0, 0.004, RIM - 0.036),
            at(0.0, 0.004, RIM - 0.004),
            at(0.004, 0.006, RIM),
        ];
        let lip = at(0.055, 0.10, RIM);
        let throat = at(0.075, 0.11, RIM - 0.025);
        let mut inside = vec![lip.clone()];
        inside.extend(rounding(&lip, &throat, 4, false));
        let slope = |dx: f32, dy: f32, z: f32| rectangle(w - dx, d - dy, 0.12, 0.0, z);
        inside.extend([throat, slope(0.24, 0.19, 0.4), slope(0.32, 0.24, 0.25), slope(0.48, 0.38, 0.15)]);
        b.part(tub, "body", hollow(&outside, &inside), Finish::Porcelain);
        if self.tiled {
            let panel = board([-0.5 * w + 0.001, 0.5 * d - 0.0118, 0.0], [0.5 * w - 0.001, 0.5 * d - 0.002, RIM - 0.040], 0.001);
            b.part(tub, "panel", panel, Finish::WallTile);
        }
        b.part(tub, "waste", waste(0.033).moved(Vec3::new(0.0, 0.0, 0.1505)), self.metal);
        // On the inner wall between throat and slope, which is 10.26 cm from the tub's end at this height and leans out by 16 degrees.
        let overflow = waste(0.032).turned(Vec3::Y, 0.2826 - 0.25 * TAU).moved(Vec3::new(0.5 * w - 0.1021, 0.0, 0.46));
        b.part(tub, "overflow", overflow, self.metal);
    }

    fn fittings(&self, b: &mut Builder, tub: &Object, pose: DAffine3, rng: &mut Rng) {
        let [w, d] = self.size.to_array();
        let at = Vec3::new(0.18 * w, -0.5 * d, 0.82);
        match self.screen {
            TubScreen::None => {
                wall_mixer(b, tub, at, self.metal);
                let spout = tube(&[at + Vec3::new(0.0, 0.06, -0.01), at + Vec3::new(0.0, 0.19, -0.035)], 0.014, 16);
                b.part(tub, "spout", spout, self.metal);
            }
            TubScreen::Curtain | TubScreen::Pane => shower_set(b, tub, Vec3::new(0.32 * w, -0.5 * d, 1.0), false, self.metal),
        }
        if self.screen == TubScreen::Pane {
            let (x0, x1, y) = (0.5 * w - 0.85, 0.5 * w - 0.012, 0.5 * d - 0.03);
            let corner = |i: usize, j: usize| Vec3::new(x1 + (x0 - x1) * i as f32, y, RIM + 0.012 + 1.38 * j as f32);
            b.part(tub, "pane", grid(1, 1, corner, |i, j| Vec2::new(i as f32, j as f32)), Finish::Glass);
            let rods = [
                rod([x1, y, RIM], [x1, y, RIM + 1.40], 0.009, 12),
                rod([x0, y, RIM + 0.006], [x1, y, RIM + 0.006], 0.006, 10),
                rod([x0, y, RIM + 1.394], [x1, y, RIM + 1.394], 0.005, 10),
            ];
            b.part(tub, "pane_frame", all(rods), self.metal);
        }
        if self.screen == TubScreen::Curtain {
            self.curtain(b, pose, rng);
        }
    }

    fn curtain(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let [w, d] = self.size.to_array();
        let y = 0.5 * d + 0.045;
        let object = b.object("shower_curtain", Class::ShowerCurtain, pose);
        let ends = [-1.0f32, 1.0]
            .map(|s| to_front(cylinder(0.022, 0.012, 20)).turned(Vec3::Z, s * 0.25 * TAU).moved(Vec3::new(s * 0.5 * w, y, RAIL)));
        let rail = rod([-0.5 * w, y, RAIL], [0.5 * w, y, RAIL], 0.0115, 16);
        b.part(&object, "rail", all([rail].into_iter().chain(ends)), self.metal);
        let wide = rng.range(0.45, 0.95) * w;
        let folds = (wide / 0.085) as usize;
        let middle = -0.5 * w + 0.03 + 0.5 * wide;
        let cloth = curtain(wide, RAIL - 0.33, folds, 0.055, rng).moved(Vec3::new(middle, y, RAIL - 0.04));
        b.part(&object, "cloth", cloth, Finish::ShowerCurtain);
        let ring: Vec<Vec3> =
            (0..=16).map(|k| Vec2::from_angle(TAU * k as f32 / 16.0) * 0.021).map(|p| Vec3::new(0.0, p.x, p.y - 0.008)).collect();
        let rings =
            (0..folds).map(|k| tube(&ring, 0.0018, 6).moved(Vec3::new(middle + wide * ((k as f32 + 0.5) / folds as f32 - 0.5), y, RAIL)));
        b.part(&object, "rings", all(rings), self.metal);
    }
}

impl Furniture for Bathtub {
    fn random(rng: &mut Rng) -> Self {
        let free = rng.below(3) == 0;
        let size = if free {
            Vec2::new(rng.range(1.6, 1.8), rng.range(0.74, 0.82))
        } else {
            [Vec2::new(1.7, 0.75), Vec2::new(1.6, 0.7), Vec2::new(1.8, 0.8)][rng.below(3)]
        };
        let screen = [TubScreen::None, TubScreen::Curtain, TubScreen::Pane][rng.below(3)];
        Self { size, free, screen: if free { TubScreen::None } else { screen }, tiled: rng.below(2) == 0, metal: fittings(rng) }
    }

    fn size(&self) -> Vec3 {
        let more = match self.screen {
            _ if self.free => Vec3::new(0.0, 0.24, 0.96),
            TubScreen::None => Vec3::new(0.0, 0.0, 0.85),
            TubScreen::Curtain => Vec3::new(0.0, 0.22, 2.03),
            TubScreen::Pane => Vec3::new(0.0, 0.0, 1.99),
        };
        Vec3::new(self.size.x, self.size.y + more.y, more.z)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        // The rim is off the middle of the footprint if taps protrude behind it or a curtain in front of it.
        let shift = 0.5 * (self.size().y - self.size.y) * if self.free { 1.0 } else { -1.0 };
        let pose = on(pose, Vec3::new(0.0, shift, 0.0), 0.0);
        let tub = b.object("bathtub", Class::Bathtub, pose);
        if self.free {
            self.free_standing(b, &tub);
        } else {
            self.built_in(b, &tub);
            self.fittings(b, &tub, pose, rng);
        }
    }
}

/// A shower: a tray with glass on one or two sides; its back and its left side are at walls.
#[derive(Clone, Copy, Debug)]
pub struct Shower {
    /// Width and depth of the tray.
    pub size: Vec2,
    /// A pane along the front leaves an opening, instead of a door that closes it.
    pub walk_in: bool,
    /// A pane along the right side.
    pub side: bool,
    /// A stone tray, level with the floor, instead of a white one.
    pub stone: bool,
    /// A rain shower above the hand shower.
    pub rain: bool,
    /// Finish of fittings and profiles.
    pub metal: Finish,
}

/// Upper edge of the panes of a shower, metres.
const GLASS_TOP: f32 = 2.0;

impl Shower {
    fn tray(&self, b: &mut Builder, shower: &Object) -> f32 {
        let [w, d] = self.size.to_array();
        let top = if self.stone { 0.022 } else { 0.045 };
        let at = |inset: f32, radius: f32, z: f32| rectangle(w - 2.0 * inset, d - 2.0 * inset, radius, 0.0, z);
        let sections = [
            at(0.0, 0.004, 0.0),
            at(0.0, 0.004, top - 0.003),
            at(0.003, 0.005, top),
            at(0.045, 0.02, top),
            at(0.06, 0.03, top - 0.008),
            at(0.2, 0.05, top - 0.012),
        ];
        b.part(shower, "tray", super::ceramic::body(&sections), if self.stone { Finish::Stone } else { Finish::Porcelain });
        b.part(shower, "waste", waste(0.045).moved(Vec3::new(0.0, 0.0, top - 0.0118)), Finish::Chrome);
        top
    }

    fn pane(&self, b: &mut Builder, shower: &Object, name: &str, from: Vec2, to: Vec2, low: f32) {
        let corner = |i: usize, j: usize| from.lerp(to, i as f32).extend(if j == 0 { low + 0.008 } else { GLASS_TOP });
        b.part(shower, name, grid(1, 1, corner, |i, j| Vec2::new(i as f32, j as f32)), Finish::Glass);
        let along = |z: f32, radius: f32| tube(&[from.extend(z), to.extend(z)], radius, 8);
        // The polished edge of the glass shows as a line; a profile holds it below and at its start.
        let upright = tube(&[from.extend(low), from.extend(GLASS_TOP)], 0.009, 10);
        b.part(shower, &format!("{name}_profile"), all([along(low + 0.006, 0.006), along(GLASS_TOP - 0.002, 0.004), upright]), self.metal);
    }
}

impl Furniture for Shower {
    fn random(rng: &mut Rng) -> Self {
        let walk_in = rng.below(2) == 0;
        let size = if walk_in { Vec2::new(rng.range(1.2, 1.5), rng.range(0.85, 1.0)) } else { Vec2::splat([0.8, 0.9, 1.0][rng.below(3)]) };
        Self { size, walk_in, side: true, stone: rng.below(3) == 0, rain: rng.below(3) > 0, metal: fittings(rng) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, self.size.y + 0.04, 2.18)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let pose = on(pose, Vec3::new(0.0, -0.02, 0.0), 0.0);
        let shower = b.object("shower", Class::OtherStructure, pose);
        let low = self.tray(b, &shower);
        let (x, y) = (0.5 * self.size.x - 0.012, 0.5 * self.size.y - 0.012);
        let back = -0.5 * self.size.y;
        // The side pane is at +x, since the wall is at −x.
        if self.side {
            self.pane(b, &shower, "pane_side", Vec2::new(x, back + 0.0095), Vec2::new(x, y), low);
        }
        if self.walk_in {
            self.pane(b, &shower, "pane_front", Vec2::new(x, y), Vec2::new(x - 0.62 * self.size.x, y), low);
            let from = Vec3::new(x - 0.62 * self.size.x, y, GLASS_TOP - 0.004);
            b.part(&shower, "stay", tube(&[from, Vec3::new(from.x, back, from.z)], 0.008, 10), self.metal);
        } else {
            self.pane(b, &shower, "door", Vec2::new(-x, y), Vec2::new(x - 0.012, y), low);
            let handle = rod([0.0, 0.036, -0.15], [0.0, 0.036, 0.15], 0.008, 12)
                .with(all([-0.12f32, 0.12].map(|z| rod([0.0, -0.02, z], [0.0, 0.036, z], 0.006, 10))));
            b.part(&shower, "handle", handle.moved(Vec3::new(x - 0.1, y - 0.01, 1.05)), self.metal);
        }
        shower_set(b, &shower, Vec3::new(-0.05, back, 1.05), self.rain, self.metal);
    }
}

#[cfg(test)]
mod tests {
    use super::super::ceramic::{body, lining};
    use super::*;
    use crate::pieces::piece_tests::{bounds_of, encloses, scene_of, triangles};

    #[test]
    fn the_inside_of_a_free_tub_stays_within_its_outside() {
        for size in [Vec2::new(1.6, 0.74), Vec2::new(1.6, 0.82), Vec2::new(1.8, 0.74), Vec2::new(1.8, 0.82)] {
            let tub = Bathtub { size, free: true, screen: TubScreen::None, tiled: false, metal: Finish::Chrome };
            let [outside, inside] = tub.oval();
            let whole = triangles(&body(&outside));
            // The first sections make the rim.
            for section in lining(&inside[3..]) {
                assert!(section.points().all(|p| encloses(&whole, p)), "{size} at height {}", section.z);
            }
        }
    }

    #[test]
    fn the_overflow_of_a_tub_lies_on_the_wall_inside() {
        for size in [Vec2::new(1.7, 0.75), Vec2::new(1.6, 0.7), Vec2::new(1.8, 0.8)] {
            let tub = Bathtub { size, free: false, screen: TubScreen::None, tiled: false, metal: Finish::Chrome };
            let found = bounds_of(&scene_of(&tub, 0), "bathtub_1/overflow");
            let wall = |z: f32| 0.5 * size.x - 0.075 - 0.045 * (RIM - 0.025 - z) / (RIM - 0.425);
            // Its upper edge touches the wall, and its cover protrudes in the middle.
            assert!((found.max.x - wall(found.max.z)).abs() < 0.003, "{found:?}");
            assert!(found.min.x < wall(found.min.z) - 0.001, "{found:?}");
        }
    }
}
