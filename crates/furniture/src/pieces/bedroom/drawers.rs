//! Furniture with drawers: nightstands 38 to 56 cm wide and 46 to 60 cm high (class night stand) with one or two drawers and perhaps an
//! open compartment, and chests with one to three columns of three to five drawers (class dresser). Body, fronts, feet and handles are
//! drawn from `joinery`; handles count in the depth.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::joinery::{Carcass, Feet, Handle, body_finish, front, pull, thickness_at_middle};
use crate::pieces::{Furniture, Surface, board, grained};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// What nightstands and chests of drawers share.
#[derive(Clone, Copy, Debug)]
pub struct DrawerBody {
    /// Width, depth and height, with handles and feet.
    pub size: Vec3,
    /// Height of the feet.
    pub feet_height: f32,
    /// Kind of the feet.
    pub feet: Feet,
    /// Finish of the carcass.
    pub body: Finish,
    /// Finish of the fronts.
    pub fronts: Finish,
    /// Fronts with a recessed panel.
    pub framed: bool,
    /// Handle of each drawer.
    pub handle: Handle,
}

/// Gap between fronts, metres.
const GAP: f32 = 0.003;
/// Thickness of fronts, metres.
const FRONT: f32 = 0.019;

impl DrawerBody {
    fn random(size: Vec3, rng: &mut Rng) -> Self {
        let body = body_finish(rng);
        let fronts = if rng.below(4) == 0 { Finish::WhiteLacquer } else { body };
        let feet = Feet::random(rng);
        let feet_height = if feet == Feet::Plinth { rng.range(0.05, 0.08) } else { rng.range(0.1, 0.18) };
        Self { size, feet_height, feet, body, fronts, framed: rng.below(3) == 0, handle: Handle::random(rng) }
    }

    /// The plane of the carcass's front edges.
    fn front(&self) -> f32 {
        0.5 * self.size.y - Handle::DEPTH - FRONT - 0.001
    }

    fn carcass(&self) -> Carcass {
        let x = 0.5 * self.size.x;
        Carcass {
            x: [-x + 0.004, x - 0.004],
            y: [-0.5 * self.size.y, self.front()],
            z: [self.feet_height, self.size.z - 0.0205],
            thick: 0.018,
            finish: self.body,
        }
    }

    fn add(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let carcass = self.carcass();
        carcass.add(b, object, rng);
        let x = 0.5 * self.size.x;
        let top = board([-x, -0.5 * self.size.y, self.size.z - 0.02], [x, self.front() + FRONT + 0.004, self.size.z], 0.0025);
        b.part(object, "table", grained(top, rng), self.body);
        let depth = 0.5 * (self.size.y - Handle::DEPTH - FRONT);
        self.feet.add(b, object, Vec2::new(x, depth), self.feet_height, self.body);
    }

    /// A drawer whose front covers the rectangle `[x0, x1, z0, z1]` but for the gaps.
    fn drawer(&self, b: &mut Builder, object: &Object, name: &str, rect: [f32; 4], rng: &mut Rng) {
        let [x0, x1, z0, z1] = rect;
        let rect = [x0 + 0.5 * GAP, x1 - 0.5 * GAP, z0 + 0.5 * GAP, z1 - 0.5 * GAP];
        // Air between the carcass and its fronts keeps faces out of one plane.
        let back = self.front() + 0.0008;
        let from = b.part_count();
        b.part(object, name, front(rect, back, FRONT, self.framed, rng), self.fronts);
        let wide = x1 - x0;
        let middle = 0.5 * (z0 + z1);
        let face = |x: f32| Vec3::new(x, back + thickness_at_middle(rect, FRONT, self.framed), middle);
        let length = (0.4 * wide).clamp(0.09, 0.32);
        if wide > 0.7 && !matches!(self.handle, Handle::Bar(_)) {
            for (k, s) in [-1.0f32, 1.0].into_iter().enumerate() {
                let at = face(0.5 * (x0 + x1) + s * 0.25 * wide);
                self.handle.add(b, object, &format!("{name}_handle_{}", k + 1), at, length, false);
            }
        } else {
            self.handle.add(b, object, &format!("{name}_handle"), face(0.5 * (x0 + x1)), length, false);
        }
        let depth = self.front() + 0.5 * self.size.y - 0.03;
        pull(b, object, name, from, rect, back, depth, self.body);
    }

    fn top(&self) -> Surface {
        let half = 0.5 * self.size.truncate();
        Surface { min: -half, max: Vec2::new(half.x, half.y - Handle::DEPTH), z: self.size.z, headroom: f32::INFINITY }
    }
}

/// A small table beside a bed, with one or two drawers and perhaps an open compartment.
#[derive(Clone, Copy, Debug)]
pub struct Nightstand {
    /// The body with the drawers.
    pub body: DrawerBody,
    /// Drawers above each other.
    pub drawers: usize,
    /// An open compartment below them.
    pub open: bool,
}

impl Nightstand {
    /// Floor of the open compartment, and the height of its ceiling.
    fn compartment(&self) -> [f32; 2] {
        let [_, _, low, high] = self.body.carcass().inside();
        let share = if self.drawers == 1 { 0.55 } else { 0.4 };
        [low, low + share * (high - low)]
    }
}

impl Furniture for Nightstand {
    fn random(rng: &mut Rng) -> Self {
        let size = Vec3::new(rng.range(0.38, 0.56), rng.range(0.37, 0.44), rng.range(0.46, 0.6));
        let drawers = 1 + rng.below(2);
        Self { body: DrawerBody::random(size, rng), drawers, open: drawers == 1 || rng.below(3) == 0 }
    }

    fn size(&self) -> Vec3 {
        self.body.size
    }

    fn reach(&self) -> f32 {
        0.35
    }

    fn surfaces(&self) -> Vec<Surface> {
        let mut all = vec![self.body.top()];
        if self.open {
            let ([x0, x1, ..], [low, high], carcass) = (self.body.carcass().inside(), self.compartment(), self.body.carcass());
            let (min, max) = (Vec2::new(x0 + 0.01, carcass.y[0] + 0.02), Vec2::new(x1 - 0.01, carcass.y[1] - 0.01));
            all.push(Surface { min, max, z: low, headroom: high - low });
        }
        all
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("nightstand", Class::NightStand, pose);
        self.body.add(b, &object, rng);
        let carcass = self.body.carcass();
        let mut low = carcass.z[0];
        if self.open {
            let [x0, x1, ..] = carcass.inside();
            let half = 0.009;
            low = self.compartment()[1] + half;
            let shelf = board([x0 - 0.0001, carcass.y[0] + 0.0105, low - half], [x1 + 0.0001, carcass.y[1] - 0.001, low + half], 0.0015);
            b.part(&object, "shelf", grained(shelf, rng), self.body.body);
        }
        let each = (carcass.z[1] - low) / self.drawers as f32;
        for k in 0..self.drawers {
            let z = low + k as f32 * each;
            self.body.drawer(b, &object, &format!("drawer_{}", k + 1), [carcass.x[0], carcass.x[1], z, z + each], rng);
        }
    }
}

/// A chest of drawers.
#[derive(Clone, Copy, Debug)]
pub struct Dresser {
    /// The body with the drawers.
    pub body: DrawerBody,
    /// Columns of drawers.
    pub columns: usize,
    /// Drawers above each other; the upper ones are lower.
    pub rows: usize,
}

impl Furniture for Dresser {
    fn random(rng: &mut Rng) -> Self {
        let columns = 1 + rng.below(3).min(1) + usize::from(rng.below(6) == 0);
        let rows = if columns == 1 { 4 + rng.below(2) } else { 3 + rng.below(2) };
        let width = if columns == 1 { rng.range(0.45, 0.85) } else { columns as f32 * rng.range(0.52, 0.68) };
        let size = Vec3::new(width, rng.range(0.44, 0.52), 0.2 * rows as f32 + rng.range(0.1, 0.24));
        Self { body: DrawerBody::random(size, rng), columns, rows }
    }

    fn size(&self) -> Vec3 {
        self.body.size
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn surfaces(&self) -> Vec<Surface> {
        vec![self.body.top()]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("dresser", Class::Dresser, pose);
        self.body.add(b, &object, rng);
        let carcass = self.body.carcass();
        // Heights fall by 8 % from row to row.
        let shares: Vec<f32> = (0..self.rows).map(|k| 1.0 - 0.08 * k as f32).collect();
        let unit = (carcass.z[1] - carcass.z[0]) / shares.iter().sum::<f32>();
        let wide = (carcass.x[1] - carcass.x[0]) / self.columns as f32;
        let mut z = carcass.z[0];
        for (row, share) in shares.iter().enumerate() {
            for column in 0..self.columns {
                let x = carcass.x[0] + column as f32 * wide;
                let rect = [x, x + wide, z, z + share * unit];
                self.body.drawer(b, &object, &format!("drawer_{}_{}", column + 1, row + 1), rect, rng);
            }
            z += share * unit;
        }
    }
}
