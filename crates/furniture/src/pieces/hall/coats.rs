//! Places for coats and umbrellas: hooks on a board on the wall (class other prop), stands 168 to 180 cm high (class other furniture) and
//! umbrella stands. Each coat is an object of class clothes that hangs by the loop of its collar; each umbrella is other prop. The origin
//! of the hooks is the middle of the board's back, on the wall; stands begin on the floor.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::bedroom::Garment;
use crate::pieces::form::{all, around, turned, wire};
use crate::pieces::{Furniture, board, grained, on, standing};
use crate::shape::{Reshape, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// A garment on a hook: a wire of `radius` whose axis goes through the origin of `pose`. All of the garment is before y = `back`, since the
/// wall or a post is behind it.
fn hang_on_hook(b: &mut Builder, pose: DAffine3, radius: f32, back: f32, garment: Garment, rng: &mut Rng) {
    let clothes = b.object("clothes", Class::Clothes, pose);
    let cloth = garment.cloth(0.9, rng);
    let neck = back - cloth.bounds().min.y;
    b.part(&clothes, "cloth", cloth.moved(Vec3::new(0.0, neck, -0.012)), Finish::Clothes(rng.below(8) as u8));
    // The loop in its collar lies over the hook.
    let over = radius + 0.0018;
    let path = [[-0.02, neck, -0.03], [-0.8 * over, 0.0, 0.6 * over], [0.0, 0.0, over], [0.8 * over, 0.0, 0.6 * over], [0.02, neck, -0.03]];
    b.part(&clothes, "loop", wire(&path, 0.0015, 6), Finish::Clothes(0));
}

/// A garment that people hang up in a hall.
fn outdoor(rng: &mut Rng) -> Garment {
    [Garment::Coat, Garment::Jacket, Garment::Jacket, Garment::Coat, Garment::Shirt][rng.below(5)]
}

/// A board with hooks on the wall, some with coats; its origin is the middle of its back.
#[derive(Clone, Copy, Debug)]
pub struct CoatHooks {
    /// Hooks side by side.
    pub hooks: usize,
    /// Number of hooks with a coat.
    pub coats: usize,
    /// A shelf for hats is above the hooks.
    pub shelf: bool,
}

/// Distance from one hook to the next, metres.
const PITCH: f32 = 0.17;
/// Half the height of board, shelf and the longest coat together, metres.
const HALF: f32 = 0.62;

impl CoatHooks {
    /// The hook of coat `k` when the first hangs on hook `first`: coats take every second hook, then those between. The second round is
    /// shifted by one if the number of hooks is even; if it is odd, it meets the free hooks without that.
    fn hook_of(&self, first: usize, k: usize) -> usize {
        let aside = if self.hooks.is_multiple_of(2) { k * 2 / self.hooks } else { 0 };
        (first + 2 * k + aside) % self.hooks
    }

    fn hook() -> Mesh {
        let upper = wire(&[[0.0, 0.002, 0.0], [0.0, 0.03, -0.004], [0.0, 0.055, 0.01], [0.0, 0.06, 0.035]], 0.005, 10);
        let lower = wire(&[[0.0, 0.002, -0.02], [0.0, 0.02, -0.04], [0.0, 0.035, -0.035], [0.0, 0.038, -0.018]], 0.0045, 10);
        let plate = board([-0.011, -0.001, -0.04], [0.011, 0.004, 0.02], 0.0015);
        let ball = crate::shape::sphere(0.0075, 14).moved(Vec3::new(0.0, 0.06, 0.037));
        all([upper, lower, plate, ball])
    }
}

impl Furniture for CoatHooks {
    fn random(rng: &mut Rng) -> Self {
        let hooks = 3 + rng.below(4);
        Self { hooks, coats: 1 + rng.below(hooks - 1), shelf: rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(PITCH * self.hooks as f32 + 0.34, 0.33, 2.0 * HALF)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let rack = b.object("coat_hooks", Class::OtherProp, pose);
        let half = 0.5 * PITCH * self.hooks as f32;
        let z = HALF - 0.14;
        let wood = [Finish::Wood, Finish::DarkWood, Finish::WhiteLacquer][rng.below(3)];
        b.part(&rack, "board", grained(board([-half, 0.0, z - 0.05], [half, 0.018, z + 0.05], 0.003), rng), wood);
        if self.shelf {
            let slats =
                (0..4).map(|k| board([-half, 0.03 + 0.052 * k as f32, z + 0.09], [half, 0.07 + 0.052 * k as f32, z + 0.105], 0.002));
            b.part(&rack, "shelf", grained(all(slats), rng), wood);
            let brackets = [-1.0f32, 1.0].map(|s| {
                let x = s * (half - 0.06);
                board([x - 0.006, 0.0002, z + 0.055], [x + 0.006, 0.012, z + 0.0898], 0.001).with(board(
                    [x - 0.006, 0.0122, z + 0.075],
                    [x + 0.006, 0.22, z + 0.0898],
                    0.001,
                ))
            });
            b.part(&rack, "brackets", all(brackets), Finish::BlackMetal);
        }
        let metal = [Finish::BlackMetal, Finish::Brass, Finish::Steel][rng.below(3)];
        let at = |k: usize| Vec3::new(PITCH * (k as f32 + 0.5) - half, 0.0175, z);
        b.part(&rack, "hooks", all((0..self.hooks).map(|k| Self::hook().moved(at(k)))), metal);
        let first = rng.below(self.hooks);
        for k in 0..self.coats {
            let place = at(self.hook_of(first, k)) + Vec3::new(0.0, 0.03, -0.004);
            hang_on_hook(b, on(pose, place, rng.range(-0.05, 0.05)), 0.005, -0.018, outdoor(rng), rng);
        }
    }
}

/// A stand with hooks around its top.
#[derive(Clone, Copy, Debug)]
pub struct CoatStand {
    /// Height of the stand.
    pub height: f32,
    /// Hooks.
    pub hooks: usize,
    /// Coats on them.
    pub coats: usize,
    /// Black metal instead of wood.
    pub metal: bool,
}

impl CoatStand {
    fn frame(&self, b: &mut Builder, stand: &Object) {
        let (h, finish) = (self.height, if self.metal { Finish::BlackMetal } else { Finish::Wood });
        let r = if self.metal { 0.0135 } else { 0.02 };
        b.part(stand, "post", tube(&[Vec3::new(0.0, 0.0, 0.03), Vec3::new(0.0, 0.0, h)], r, 20), finish);
        if self.metal {
            let base = turned(&[[0.0, 0.0], [0.16, 0.0], [0.163, 0.004], [0.16, 0.014], [0.03, 0.022], [0.016, 0.04], [0.0, 0.04]], 48);
            b.part(stand, "base", base, finish);
        } else {
            let feet = around(4, 0.25 * TAU / 2.0).map(|d| {
                let path = [(d * 0.012).extend(0.16), (d * 0.1).extend(0.085), (d * 0.22).extend(0.0125)];
                standing(tube(&path, 0.014, 12))
            });
            b.part(stand, "feet", all(feet), finish);
        }
        let hooks = around(self.hooks, 0.3).map(|d| {
            let p = |out: f32, z: f32| (d * out).extend(h + z).to_array();
            wire(&[p(0.0, -0.09), p(0.06, -0.075), p(0.1, -0.03), p(0.115, 0.02)], 0.0075, 12)
                .with(crate::shape::sphere(0.0115, 16).moved((d * 0.115).extend(h + 0.022)))
        });
        let knob = crate::shape::sphere(1.6 * r, 24).moved(Vec3::Z * (h + 0.8 * r));
        b.part(stand, "hooks", all(hooks.chain([knob])), finish);
    }
}

impl Furniture for CoatStand {
    fn random(rng: &mut Rng) -> Self {
        let hooks = 4 + 2 * rng.below(2);
        Self { height: rng.range(1.68, 1.8), hooks, coats: 1 + rng.below(3), metal: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        let width = if self.coats > 0 { 0.82 } else { 0.48 };
        Vec3::new(width, width, self.height + 0.06)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stand = b.object("coat_stand", Class::OtherFurniture, pose);
        self.frame(b, &stand);
        for k in 0..self.coats.min(self.hooks) {
            let turn = 0.3 + TAU * (k * (self.hooks / self.coats.max(1))) as f32 / self.hooks as f32;
            let out = Vec2::from_angle(turn) * 0.10;
            let at = out.extend(self.height - 0.03);
            hang_on_hook(b, on(pose, at, turn - 0.25 * TAU), 0.0075, 0.004, outdoor(rng), rng);
        }
    }
}

/// Umbrellas in their stand.
#[derive(Clone, Copy, Debug)]
pub struct UmbrellaStand {
    /// Radius of the stand.
    pub radius: f32,
    /// Umbrellas in it.
    pub umbrellas: usize,
}

/// Radius of a rolled umbrella where it leans on the rim, metres.
const CLOTH: f32 = 0.029;
/// Distance at which each of three umbrellas passes the axis of the stand, metres, so that they do not cut into each other.
const ASIDE: f32 = 0.034;

impl UmbrellaStand {
    /// A rolled umbrella that stands on its tip at the origin, its crook up.
    fn umbrella(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let umbrella = b.object("umbrella", Class::OtherProp, pose);
        let pleat = |mesh: Mesh| {
            mesh.deformed(|p| {
                let turn = p.y.atan2(p.x) + 5.0 * p.z;
                let r = 1.0 + 0.16 * (8.0 * turn).sin();
                Vec3::new(p.x * r, p.y * r, p.z)
            })
            .smoothed(60.0)
        };
        let cloth = turned(&[[0.0, 0.05], [0.008, 0.05], [0.017, 0.2], [0.024, 0.45], [0.021, 0.6], [0.012, 0.63], [0.0, 0.63]], 64);
        b.part(&umbrella, "cloth", pleat(cloth), Finish::Clothes(rng.below(8) as u8));
        let crook = [
            [0.0, 0.0, 0.002],
            [0.0, 0.0, 0.3],
            [0.0, 0.0, 0.74],
            [0.0, 0.0, 0.82],
            [0.012, 0.0, 0.855],
            [0.042, 0.0, 0.868],
            [0.07, 0.0, 0.85],
            [0.076, 0.0, 0.82],
        ];
        b.part(&umbrella, "stick", wire(&crook, 0.007, 10), [Finish::DarkWood, Finish::BlackPlastic, Finish::Wood][rng.below(3)]);
    }
}

impl Furniture for UmbrellaStand {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.1, 0.13), umbrellas: 1 + rng.below(3) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.48, 0.48, 0.90)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let stand = b.object("umbrella_stand", Class::OtherProp, pose);
        let (r, h) = (self.radius, rng.range(0.46, 0.54));
        let shell = crate::pieces::form::vessel(&[[0.97 * r, 0.0], [r, 0.35 * h], [1.02 * r, 0.7 * h], [1.04 * r, h]], 0.004, 48);
        b.part(&stand, "body", shell, [Finish::BlackMetal, Finish::Ceramic(1), Finish::Brass, Finish::Ceramic(0)][rng.below(4)]);
        let start = rng.range(0.0, TAU);
        for k in 0..self.umbrellas {
            let turn = start + TAU * k as f32 / 3.0;
            let d = Vec2::from_angle(turn);
            // Each umbrella passes the axis on its own side and leans against the rim.
            let rim = ((1.04 * r - 0.004 - CLOTH).powi(2) - ASIDE * ASIDE).sqrt();
            let top = 0.87 / h;
            let tip = ((0.14 - rim * top) / (1.0 - top)).clamp(-0.045, rim - 0.01);
            let lean = ((rim - tip) / h).atan();
            let foot = (d * tip + d.perp() * ASIDE).extend(0.0048);
            let tilt = DAffine3::from_axis_angle(Vec3::new(-d.y, d.x, 0.0).as_dvec3(), f64::from(lean));
            Self::umbrella(b, on(pose, foot, 0.0) * tilt * DAffine3::from_rotation_z(f64::from(turn + rng.range(1.0, 2.2))), rng);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_coat_has_a_hook_of_its_own() {
        for hooks in 3..=6 {
            for coats in 1..hooks {
                let rack = CoatHooks { hooks, coats, shelf: false };
                for first in 0..hooks {
                    let taken: BTreeSet<usize> = (0..coats).map(|k| rack.hook_of(first, k)).collect();
                    assert_eq!(taken.len(), coats, "{rack:?} from hook {first}");
                }
            }
        }
    }
}
