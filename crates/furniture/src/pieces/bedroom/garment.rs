//! Coats, jackets, shirts and dresses as they hang: a collar, shoulders that slope from it, sleeves, and folds that deepen to the hem. A
//! garment hangs in the xz plane with its neck at the origin and its front towards +y; length is fixed for each kind but for 6 %, while
//! shoulders, folds and creases vary.

use crate::pieces::soft::Wrinkles;
use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Something to wear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Garment {
    /// A shirt or blouse.
    Shirt,
    /// A jacket.
    Jacket,
    /// A coat.
    Coat,
    /// A dress without sleeves.
    Dress,
    /// Trousers over the bar of the hanger.
    Trousers,
}

/// Half the width of a collar, and half its depth, metres.
const COLLAR: Vec2 = Vec2::new(0.058, 0.045);
/// Length of a lapel, metres.
const LAPEL: f32 = 0.34;
/// Length of a sleeve, metres.
const SLEEVE: f32 = 0.58;
/// Vertices around a garment.
const AROUND: usize = 72;
/// Rows of vertices from the neck down to the hem.
const DOWN: usize = 40;

impl Garment {
    /// A random kind, as they hang in a wardrobe.
    pub fn random(rng: &mut Rng) -> Self {
        [Self::Shirt, Self::Shirt, Self::Jacket, Self::Coat, Self::Dress, Self::Trousers][rng.below(6)]
    }

    /// Length from the shoulders to the hem, metres.
    pub fn length(self) -> f32 {
        match self {
            Self::Shirt => 0.72,
            Self::Jacket => 0.76,
            Self::Coat => 1.04,
            Self::Dress => 1.0,
            Self::Trousers => 0.62,
        }
    }

    fn thickness(self) -> f32 {
        match self {
            Self::Coat | Self::Jacket => 0.045,
            Self::Shirt | Self::Dress => 0.026,
            Self::Trousers => 0.016,
        }
    }

    fn sleeves(self) -> bool {
        matches!(self, Self::Shirt | Self::Jacket | Self::Coat)
    }

    /// Width of the hem over the width of the shoulders.
    fn flare(self) -> f32 {
        match self {
            Self::Dress => 1.35,
            Self::Coat => 1.12,
            Self::Shirt | Self::Jacket => 1.02,
            Self::Trousers => 1.0,
        }
    }

    /// The cloth as it hangs in the xz plane, its neck at the origin, its front towards y. `droop` is 0 on a hanger, 1 on a hook.
    pub fn cloth(self, droop: f32, rng: &mut Rng) -> Mesh {
        let fall = Fall {
            garment: self,
            length: self.length() * rng.range(0.94, 1.04),
            shoulder: rng.range(0.19, 0.22) * (1.0 - 0.28 * droop),
            slope: 0.06 + 0.09 * droop,
            droop,
            folds: 4.0 + rng.below(3) as f32,
            phase: rng.range(0.0, TAU),
            wrinkles: Wrinkles::new(0.16, 0.010, rng),
        };
        let uv = |i: usize, j: usize| Vec2::new(i as f32 / AROUND as f32 * 4.0 * fall.shoulder, -fall.length * j as f32 / DOWN as f32);
        // Rows from the top down and counter-clockwise around turn faces inward, so the way around is reversed.
        let body = grid(AROUND, DOWN, |i, j| fall.point(AROUND - i, j), uv).smoothed(70.0);
        if !self.sleeves() {
            return body;
        }
        [-1.0f32, 1.0].into_iter().fold(body, |mesh, side| mesh.with(fall.sleeve(side, rng)))
    }
}

/// The drape of one garment.
struct Fall {
    garment: Garment,
    length: f32,
    /// Half the width over the shoulders.
    shoulder: f32,
    /// Slope of the shoulders from the collar outward.
    slope: f32,
    droop: f32,
    folds: f32,
    phase: f32,
    wrinkles: Wrinkles,
}

impl Fall {
    /// Height of the collar.
    fn stand(&self) -> f32 {
        if self.garment.sleeves() { 0.035 } else { 0.012 }
    }

    /// Vertex `i` around row `j`: the first rows line the collar, the last closes the hem from within.
    fn point(&self, i: usize, j: usize) -> Vec3 {
        if j == 0 {
            return Vec3::new(0.0, 0.0, -0.06);
        }
        if j == DOWN {
            return Vec3::new(0.0, 0.0, -self.length + 0.04);
        }
        let (sin, cos) = ((i % AROUND) as f32 / AROUND as f32 * TAU).sin_cos();
        let down = (j.saturating_sub(2) as f32 / (DOWN - 3) as f32).powf(1.25);
        let z = -self.length * down;
        // The collar is upright, the shoulders round off from it, then the sides fall.
        let out = ((-z - self.stand()) / self.slope).clamp(0.0, 1.0);
        let yoke = (FRAC_PI_2 * out).sin();
        let flare = 1.0 + (self.garment.flare() - 1.0) * down - 0.10 * (PI * down).sin();
        let half = (COLLAR.x + (self.shoulder - COLLAR.x) * yoke) * if out > 0.0 { flare } else { 1.0 };
        let thick = self.garment.thickness() * (1.0 + 0.6 * self.droop);
        let depth = COLLAR.y + (thick - COLLAR.y) * yoke;
        let swing = 0.35 * (5.0 * z + self.phase).sin();
        let wave = (self.folds * sin.atan2(cos) + self.phase + 1.2 * down + swing).sin();
        // Valleys are sharper than ridges.
        let fold = (wave + 0.35 * (2.0 * wave).sin()) * (0.05 + 0.20 * self.droop) * yoke * (0.25 + down);
        let uneven = self.wrinkles.at(Vec2::new(half * cos + sin, z)) * (0.3 + 0.7 * yoke);
        let x = half * (1.0 + 0.35 * fold) * cos.signum() * cos.abs().powf(0.8);
        let y = (depth * (1.0 + fold) + 0.6 * thick * fold + uneven) * sin + self.front(half * cos, z) * sin.max(0.0).sqrt();
        // The neck is cut lower at the front, and lined.
        let cut = 0.045 * sin.max(0.0) * (1.0 - yoke);
        if j == 1 { Vec3::new(0.86 * x, 0.82 * y, z - cut - 0.012) } else { Vec3::new(x, y, z - cut) }
    }

    /// Height of the button band and the lapels above the cloth below them at (x, z), metres.
    fn front(&self, x: f32, z: f32) -> f32 {
        if !self.garment.sleeves() {
            return 0.0;
        }
        let edge = |width: f32| ((width - x.abs()) / 0.012).clamp(0.0, 1.0);
        let along = (-z / LAPEL).clamp(0.0, 1.0);
        let lapel = if self.garment == Garment::Shirt { 0.0 } else { edge(0.02 + 0.26 * along * (1.0 - along)) * 0.010 };
        lapel.max(edge(0.025) * 0.005)
    }

    /// The sleeve on one side: it hangs from the shoulder, creased about the elbow, and its cuff is open.
    fn sleeve(&self, side: f32, rng: &mut Rng) -> Mesh {
        const ROWS: usize = 30;
        const TURNS: usize = 22;
        let top = -(self.stand() + 0.62 * self.slope);
        let wide = if self.garment == Garment::Shirt { 0.05 } else { 0.058 };
        let (bend, phase) = (rng.range(0.01, 0.035), rng.range(0.0, TAU));
        let crumple = Wrinkles::new(0.10, 0.010, rng);
        let axis = |t: f32| {
            let x = self.shoulder - 0.035 + 0.03 * (3.0 * t).min(1.0) + (1.0 - self.droop) * bend * (PI * t).sin();
            Vec3::new(side * x, bend * t * t + 0.006 * (4.0 * t + phase).sin(), top - SLEEVE * t)
        };
        let point = |i: usize, j: usize| {
            let (sin, cos) = ((i % TURNS) as f32 / TURNS as f32 * TAU).sin_cos();
            if j == 0 {
                return axis(0.0) + Vec3::Z * 0.012;
            }
            if j == ROWS {
                return axis(1.0) + Vec3::Z * 0.05;
            }
            let t = (j - 1) as f32 / (ROWS - 2) as f32;
            // Round over the shoulder, narrower to the cuff.
            let radius = (wide - 0.014 * t) * (FRAC_PI_2 * (0.45 + 6.0 * t).min(1.0)).sin();
            let elbow = (-((t - 0.45) / 0.22).powi(2)).exp();
            let crease = 1.0 + 0.07 * elbow * (TAU * 9.0 * t + 1.5 * cos + phase).sin();
            let lump = crumple.at(Vec2::new(0.12 * cos + side, t + 0.1 * sin));
            axis(t) + Vec3::new(radius * crease * cos, (0.62 * radius * crease + lump) * sin, 0.0)
        };
        let uv = |i: usize, j: usize| Vec2::new(i as f32 / TURNS as f32 * TAU * wide, -SLEEVE * j as f32 / ROWS as f32);
        grid(TURNS, ROWS, |i, j| point(TURNS - i, j), uv).smoothed(70.0)
    }
}
