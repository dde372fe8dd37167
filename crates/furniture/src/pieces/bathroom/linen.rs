//! Towels and what carries them: rails of 45 to 80 cm and shelves on the wall, ladder-shaped radiators 115 to 170 cm high, piles of folded
//! towels, and bath mats. Each towel is an object of class towel, a mat of class floor mat. The origin of rail and shelf is the middle of
//! their back, on the wall.

use super::tap::fittings;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder, rod, to_front};
use crate::pieces::soft::{Wrinkles, folded, over_rod};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Thickness of towelling folded once, metres.
const TERRY: f32 = 0.009;

/// Hangs a towel over a rod of `radius` along x at the origin of `pose`.
fn hang_towel(b: &mut Builder, pose: DAffine3, width: f32, drop: f32, radius: f32, color: u8, rng: &mut Rng) {
    let towel = b.object("towel", Class::Towel, pose);
    let cloth = over_rod(width, drop, drop * rng.range(0.75, 1.0), radius + TERRY + 0.0005, TERRY, rng);
    b.part(&towel, "terry", cloth, Finish::Towel(color));
}

/// A rail on the wall with one or two towels.
#[derive(Clone, Copy, Debug)]
pub struct TowelRail {
    /// Length of the bar.
    pub length: f32,
    /// Towels on it.
    pub towels: usize,
    /// Finish of the rail.
    pub metal: Finish,
}

/// Distance of a rail from the wall, metres: towels hang free of it.
const RAIL_OUT: f32 = 0.075;
/// Radius of a rail and its arms, metres.
const RAIL_RADIUS: f32 = 0.008;
/// Length by which the longest towel hangs down from a rail, metres.
const TOWEL: f32 = 0.52;

impl Furniture for TowelRail {
    fn random(rng: &mut Rng) -> Self {
        let length = rng.range(0.45, 0.8);
        Self { length, towels: if length > 0.62 { 1 + rng.below(2) } else { 1 }, metal: fittings(rng) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, 0.13, 2.0 * TOWEL + 0.06)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        // The rail is near the upper end of what hangs from it.
        let z = TOWEL;
        let rail = b.object("towel_rail", Class::OtherProp, pose);
        let half = 0.5 * self.length;
        let bar = rod([-half + 0.012, RAIL_OUT, z], [half - 0.012, RAIL_OUT, z], RAIL_RADIUS, 14);
        let arms = [-1.0f32, 1.0].map(|s| {
            let x = s * (half - 0.024);
            to_front(cylinder(0.022, 0.010, 24)).moved(Vec3::new(x, -0.001, z)).with(rod(
                [x, 0.008, z],
                [x, RAIL_OUT + 0.004, z],
                RAIL_RADIUS,
                14,
            ))
        });
        b.part(&rail, "rail", all([bar].into_iter().chain(arms)), self.metal);
        let room = self.length - 0.10;
        let color = rng.below(4) as u8;
        for k in 0..self.towels {
            let wide = (room / self.towels as f32 - 0.03).min(0.5) * rng.range(0.86, 1.0);
            let x = room * ((k as f32 + 0.5) / self.towels as f32 - 0.5);
            let drop = TOWEL * rng.range(0.62, 1.0);
            hang_towel(b, on(pose, Vec3::new(x, RAIL_OUT, z), 0.0), wide, drop, RAIL_RADIUS, color + k as u8, rng);
        }
    }
}

/// A heated ladder of tubes on the wall, with towels.
#[derive(Clone, Copy, Debug)]
pub struct TowelRadiator {
    /// Width.
    pub width: f32,
    /// Height of the ladder.
    pub height: f32,
    /// Towels on it.
    pub towels: usize,
    /// Finish of the tubes.
    pub finish: Finish,
}

/// Height of the lower end of a ladder radiator above the floor, metres.
const LADDER: f32 = 0.25;
/// Distance from rung to rung, metres.
const RUNG: f32 = 0.042;

impl Furniture for TowelRadiator {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::WhiteEnamel, Finish::WhiteEnamel, Finish::Chrome, Finish::BlackMetal][rng.below(4)];
        Self { width: [0.45, 0.5, 0.6][rng.below(3)], height: [1.15, 1.4, 1.7][rng.below(3)], towels: 1 + rng.below(2), finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width + 0.03, 0.17, LADDER + self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let ladder = b.object("towel_radiator", Class::OtherStructure, pose);
        let y = -0.025;
        let (half, low, high) = (0.5 * self.width - 0.018, LADDER, LADDER + self.height);
        let posts = [-1.0f32, 1.0].map(|s| rod([s * half, y, low], [s * half, y, high], 0.018, 18));
        let mounts = [-1.0f32, 1.0]
            .into_iter()
            .flat_map(|s| [low + 0.12, high - 0.12].map(|z| rod([s * half, -0.5 * 0.17 - 0.001, z], [s * half, y, z], 0.011, 12)));
        // Rungs are in groups of six; between groups two are left out, to put towels through.
        let count = (self.height / RUNG) as usize;
        let levels: Vec<f32> =
            (0..count).filter(|k| k % 8 < 6).map(|k| low + 0.03 + RUNG * k as f32).filter(|z| *z < high - 0.02).collect();
        let rungs = levels.iter().map(|&z| rod([-half, y + 0.012, z], [half, y + 0.012, z], 0.0115, 14));
        b.part(&ladder, "tubes", all(posts.into_iter().chain(mounts).chain(rungs)), self.finish);
        let valves = [-1.0f32, 1.0].map(|s| {
            rod([s * half, y, low + 0.001], [s * half, y, low - 0.05], 0.013, 16).with(rod(
                [s * half, y, low - 0.04],
                [s * half, -0.085, low - 0.04],
                0.008,
                10,
            ))
        });
        b.part(&ladder, "valves", all(valves), Finish::Chrome);
        let color = rng.below(4) as u8;
        // Towels hang over the uppermost rung of a group, down before the ladder; their short end is hidden behind the rung.
        let tops: Vec<f32> = levels.iter().copied().filter(|z| !levels.iter().any(|w| (w - z - RUNG).abs() < 1e-3)).collect();
        for k in 0..self.towels {
            let Some(&z) = tops.iter().rev().nth(2 * k) else { continue };
            let towel = b.object("towel", Class::Towel, on(pose, Vec3::new(rng.range(-0.02, 0.02), y + 0.012, z), 0.0));
            let cloth = over_rod(self.width * rng.range(0.6, 0.8), rng.range(0.3, 0.42), 0.0, 0.0115 + TERRY + 0.0005, TERRY, rng);
            b.part(&towel, "terry", cloth, Finish::Towel(color + k as u8));
        }
    }
}

/// Folded towels on each other.
#[derive(Clone, Copy, Debug)]
pub struct FoldedTowels {
    /// Number of towels.
    pub count: usize,
    /// Width and depth of the largest.
    pub size: Vec2,
}

impl Furniture for FoldedTowels {
    fn random(rng: &mut Rng) -> Self {
        Self { count: 1 + rng.below(4), size: Vec2::new(rng.range(0.26, 0.38), rng.range(0.2, 0.26)) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x + 0.03, self.size.y + 0.03, 0.072 * self.count as f32 + 0.002)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let (mut z, color) = (CONTACT, rng.below(4) as u8);
        for k in 0..self.count {
            let size = (self.size * rng.range(0.92, 1.0)).extend(rng.range(0.045, 0.07));
            let towel = b.object("towel", Class::Towel, on(pose, Vec3::new(0.0, 0.0, z), rng.range(-0.04, 0.04)));
            b.part(&towel, "terry", folded(size, 3, rng), Finish::Towel(color + (k % 2) as u8));
            z += size.z + CONTACT;
        }
    }
}

/// A mat to step on from bath or shower.
#[derive(Clone, Copy, Debug)]
pub struct BathMat {
    /// Width and depth.
    pub size: Vec2,
}

impl Furniture for BathMat {
    fn random(rng: &mut Rng) -> Self {
        Self { size: [Vec2::new(0.8, 0.5), Vec2::new(0.9, 0.6), Vec2::new(0.6, 0.5)][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        self.size.extend(0.026)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let mat = b.object("bath_mat", Class::FloorMat, pose);
        let pile = Wrinkles::new(0.03, 0.004, rng);
        let lie = Wrinkles::new(0.3, 0.004, rng);
        let [upper, lower] = crate::pieces::soft::quilt(
            [56, 40],
            -0.5 * self.size,
            0.5 * self.size,
            0.014,
            |q| [0.0, 0.016 + pile.at(q) + lie.at(q)],
            |q, above| q.extend(CONTACT + above),
        );
        b.part(&mat, "pile", upper.with(lower), Finish::Towel(rng.below(4) as u8));
    }
}

/// A shelf on the wall for towels: a board on two brackets.
#[derive(Clone, Copy, Debug)]
pub struct TowelShelf {
    /// Length of the board.
    pub length: f32,
}

impl Furniture for TowelShelf {
    fn random(rng: &mut Rng) -> Self {
        Self { length: rng.range(0.5, 0.8) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, 0.24, 0.40)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let shelf = b.object("towel_shelf", Class::Shelves, pose);
        let z = -0.1;
        let board = rounded_box(Vec3::new(self.length, 0.235, 0.022), 0.003, 2).moved(Vec3::new(0.0, 0.1175, z));
        b.part(&shelf, "board", crate::pieces::grained(board, rng), Finish::Wood);
        let brackets = [-1.0f32, 1.0].map(|s| {
            let x = s * (0.5 * self.length - 0.08);
            rod([x, 0.003, z - 0.0105], [x, 0.003, z - 0.1], 0.005, 10).with(rod([x, 0.003, z - 0.095], [x, 0.2, z - 0.012], 0.005, 10))
        });
        b.part(&shelf, "brackets", all(brackets), Finish::BlackMetal);
        let towels = FoldedTowels { count: 2 + rng.below(2), size: Vec2::new(0.3, 0.2) };
        towels.build(b, on(pose, Vec3::new(rng.range(-0.06, 0.06), 0.12, z + 0.011), 0.0), rng);
    }
}
