//! A washbasin with its tap, of class sink: over a cabinet with drawers (60 to 100 cm wide), as a bowl on a cabinet (70 to 120 cm), hung on
//! the wall with its trap in view, or on a pedestal (50 to 65 cm); 45 to 50 cm deep. The cabinet is of class cabinet. The wall is at −y.

use super::ceramic::{Section, hollow, rectangle, rounding, waste};
use super::tap::{TapForm, fittings, stand, trap};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::{plate_with_holes, turned};
use crate::pieces::joinery::{Carcass, Handle, front, pull};
use crate::pieces::{Furniture, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// The support of a washbasin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BasinStand {
    /// The basin covers a cabinet with one or two drawers.
    Vanity,
    /// A bowl on the top of a cabinet.
    Bowl,
    /// The basin hangs on the wall, its trap in view.
    Wall,
    /// A pedestal hides the trap.
    Pedestal,
}

/// A washbasin with its tap.
#[derive(Clone, Copy, Debug)]
pub struct Washbasin {
    /// Width.
    pub width: f32,
    /// Depth from the wall.
    pub depth: f32,
    /// The support of the washbasin.
    pub stand: BasinStand,
    /// A bowl is round instead of rectangular.
    pub round: bool,
    /// Finish of the cabinet.
    pub finish: Finish,
    /// Handle of its drawers.
    pub handle: Handle,
    /// The form of the tap.
    pub tap: TapForm,
    /// Finish of tap and waste.
    pub metal: Finish,
}

/// Height of the rim, metres: 85 cm is usual.
const RIM: f32 = 0.85;
/// Height of a bowl that stands on a cabinet, metres.
const BOWL: f32 = 0.125;
/// Distance of a basin's hollow in front of the middle of its depth, metres: the tap stands behind it.
const FORWARD: f32 = 0.045;
/// Thickness of the cabinet's boards, metres.
const BOARD: f32 = 0.018;

impl Washbasin {
    fn has_cabinet(&self) -> bool {
        matches!(self.stand, BasinStand::Vanity | BasinStand::Bowl)
    }

    /// Height of the cabinet's upper face.
    fn cabinet_top(&self) -> f32 {
        if self.stand == BasinStand::Bowl { RIM - BOWL } else { RIM - 0.12 }
    }

    /// A rectangular basin whose rim is in the plane z = 0; its back is at −depth/2. Behind the bowl there is room for the tap.
    fn slab(&self, below: f32) -> Mesh {
        let (w, d) = (self.width, self.depth);
        let at = |inset: f32, radius: f32, z: f32| rectangle(w - 2.0 * inset, d - 2.0 * inset, radius, 0.0, z);
        let outside = [at(0.01, 0.03, -below), at(0.0, 0.03, -below + 0.02), at(0.0, 0.03, -0.004), at(0.004, 0.03, 0.0)];
        let bowl = |inset: f32, z: f32| {
            let (wide, deep) = ((w - 0.06).min(0.62) - 2.0 * inset, d - 0.15 - 2.0 * inset);
            rectangle(wide, deep, 0.09 - 0.3 * inset, FORWARD, z)
        };
        let (lip, throat) = (bowl(0.0, 0.0), bowl(0.008, -0.01));
        let mut inside = vec![lip.clone()];
        inside.extend(rounding(&lip, &throat, 4, false));
        inside.extend([throat, bowl(0.02, -0.07), bowl(0.10, -0.105)]);
        hollow(&outside, &inside)
    }

    fn bowl(&self) -> Mesh {
        let r = 0.5 * (self.depth - 0.09);
        if self.round {
            let outside = [[0.0, 0.0], [0.55 * r, 0.0], [0.80 * r, 0.03], [0.95 * r, 0.08], [r, BOWL - 0.004], [r - 0.004, BOWL]];
            let inside = [[r - 0.011, BOWL - 0.003], [0.93 * r - 0.012, 0.08], [0.76 * r - 0.012, 0.036], [0.5 * r, 0.02], [0.0, 0.016]];
            let smooth: Vec<[f32; 2]> = outside.into_iter().chain(inside).collect();
            return turned(&smooth, 64);
        }
        let at = |inset: f32, z: f32| rectangle(0.50 - 2.0 * inset, 2.0 * r - 0.04 - 2.0 * inset, 0.06, 0.0, z);
        let outside: [Section; 4] = [at(0.03, 0.0), at(0.012, 0.05), at(0.0, BOWL - 0.003), at(0.003, BOWL)];
        hollow(&outside, &[at(0.009, BOWL), at(0.012, BOWL - 0.004), at(0.028, 0.05), at(0.09, 0.017)])
    }

    fn basin(&self, b: &mut Builder, sink: &Object) {
        let tap = |b: &mut Builder, y: f32, z: f32, out: f32, rise: f32| {
            stand(b, sink, "tap", self.tap.pieces(out, rise), Vec3::new(0.0, y, z), self.metal);
        };
        match self.stand {
            BasinStand::Bowl => {
                let y = 0.035;
                b.part(sink, "bowl", self.bowl().moved(Vec3::new(0.0, y, self.cabinet_top() + 0.0005)), Finish::Porcelain);
                let floor = self.cabinet_top() + if self.round { 0.0165 } else { 0.0175 };
                b.part(sink, "waste", waste(0.03).moved(Vec3::new(0.0, y, floor)), self.metal);
                tap(b, -0.5 * self.depth + 0.045, self.cabinet_top(), 0.15, 0.235);
            }
            BasinStand::Vanity | BasinStand::Wall | BasinStand::Pedestal => {
                let below = if self.stand == BasinStand::Vanity { 0.12 } else { 0.135 };
                b.part(sink, "basin", self.slab(below - 0.0005).moved(Vec3::Z * RIM), Finish::Porcelain);
                b.part(sink, "waste", waste(0.03).moved(Vec3::new(0.0, FORWARD, RIM - 0.1048)), self.metal);
                tap(b, -0.5 * self.depth + 0.055, RIM, 0.13, 0.11);
            }
        }
        if self.stand == BasinStand::Wall {
            let at = Vec3::new(0.0, FORWARD, RIM - 0.135);
            b.part(sink, "trap", trap(-0.5 * self.depth - FORWARD).moved(at), self.metal);
        }
        if self.stand == BasinStand::Pedestal {
            let y = -0.06;
            let ring = |w: f32, d: f32, z: f32| rectangle(w, d, 0.45 * d, y, z);
            let sections =
                [ring(0.2, 0.2, 0.0), ring(0.2, 0.2, 0.02), ring(0.15, 0.16, 0.12), ring(0.145, 0.16, 0.45), ring(0.21, 0.24, RIM - 0.134)];
            b.part(sink, "pedestal", super::ceramic::body(&sections), Finish::Porcelain);
        }
    }

    fn cabinet(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let vanity = b.object("vanity", Class::Cabinet, pose);
        let (x, y) = (0.5 * self.width - 0.004, 0.5 * self.depth);
        let plate = if self.stand == BasinStand::Bowl { 0.03 } else { 0.0 };
        // The cabinet hangs on the wall: the floor stays free.
        let z = [0.32, self.cabinet_top() - plate - 0.0005];
        let face = y - 0.02 - Handle::DEPTH;
        let carcass = Carcass { x: [-x, x], y: [-y, face], z, thick: BOARD, finish: self.finish };
        // The basin hangs into the carcass, which is open at the top.
        let e = 0.0002;
        for (name, min, max) in [
            ("bottom", [-x, -y, z[0]], [x, face, z[0] + BOARD]),
            ("side_left", [-x, -y, z[0] + BOARD + e], [-x + BOARD, face, z[1]]),
            ("side_right", [x - BOARD, -y, z[0] + BOARD + e], [x, face, z[1]]),
            ("rear", [-x + 0.0181, -y + 0.004, z[0] + BOARD + e], [x - 0.0181, -y + 0.012, z[1]]),
        ] {
            b.part(&vanity, name, grained(board(min, max, 0.0015), rng), self.finish);
        }
        if plate > 0.0 {
            let top = plate_with_holes(Vec2::new(-x - 0.004, -y), Vec2::new(x + 0.004, y - 0.006), plate - 0.0005, 0.002, &[]);
            let finish = [Finish::Wood, Finish::MarbleTop, Finish::Stone][rng.below(3)];
            b.part(&vanity, "top", grained(top.moved(Vec3::Z * self.cabinet_top()), rng), finish);
        }
        let rows = if carcass.z[1] - carcass.z[0] > 0.36 { 2 } else { 1 };
        let high = (z[1] - z[0]) / rows as f32;
        for k in 0..rows {
            let low = z[0] + k as f32 * high;
            let rect = [-x + 0.0015, x - 0.0015, low + 0.0015, low + high - 0.0025];
            let from = b.part_count();
            b.part(&vanity, &format!("drawer_{}", k + 1), front(rect, face + 0.0008, 0.019, false, rng), self.finish);
            let at = Vec3::new(0.0, face + 0.0198, low + 0.72 * high);
            self.handle.add(b, &vanity, &format!("handle_{}", k + 1), at, (0.45 * self.width).min(0.4), false);
            pull(b, &vanity, &format!("drawer_{}", k + 1), from, rect, face + 0.0008, face + y - 0.03, self.finish);
        }
    }
}

impl Furniture for Washbasin {
    fn random(rng: &mut Rng) -> Self {
        let stand = [BasinStand::Vanity, BasinStand::Vanity, BasinStand::Bowl, BasinStand::Bowl, BasinStand::Wall, BasinStand::Pedestal]
            [rng.below(6)];
        let width = match stand {
            BasinStand::Vanity => [0.6, 0.8, 0.8, 1.0][rng.below(4)],
            BasinStand::Bowl => rng.range(0.7, 1.2),
            BasinStand::Wall | BasinStand::Pedestal => rng.range(0.5, 0.65),
        };
        let finish = [Finish::Wood, Finish::WhiteLacquer, Finish::DarkWood, Finish::ColoredLacquer(1)][rng.below(4)];
        let metal = fittings(rng);
        let handle = [Handle::Bar(metal), Handle::Knob(metal), Handle::None][rng.below(3)];
        Self { width, depth: rng.range(0.45, 0.5), stand, round: rng.below(2) == 0, finish, handle, tap: TapForm::random(rng), metal }
    }

    fn size(&self) -> Vec3 {
        let tap = if self.stand == BasinStand::Bowl { RIM + 0.30 } else { RIM + 0.25 };
        Vec3::new(self.width.max(0.5), self.depth + 0.004, tap)
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn surfaces(&self) -> Vec<Surface> {
        let (x, y) = (0.5 * self.width, 0.5 * self.depth);
        // Things stand beside the bowl, where there is room.
        let (inner, z) = match self.stand {
            BasinStand::Bowl => (0.27, self.cabinet_top()),
            BasinStand::Vanity => (0.5 * (self.width - 0.06).min(0.62), RIM),
            BasinStand::Wall | BasinStand::Pedestal => return Vec::new(),
        };
        if x - inner < 0.10 {
            return Vec::new();
        }
        let side = |x0: f32, x1: f32| Surface { min: Vec2::new(x0, -y + 0.01), max: Vec2::new(x1, y - 0.08), z, headroom: f32::INFINITY };
        vec![side(-x + 0.02, -inner), side(inner, x - 0.02)]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let pose = on(pose, Vec3::ZERO, 0.0);
        let sink = b.object("washbasin", Class::Sink, pose);
        self.basin(b, &sink);
        if self.has_cabinet() {
            self.cabinet(b, pose, rng);
        }
    }
}
