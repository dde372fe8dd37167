//! Soft things: cloth that lies, hangs over edges, is folded back or folded up, by procedural displacement.
//!
//! Cloth coordinates are metres on the cloth as it lies flat; `above` is the height over the side that lies below.

use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Unevenness of cloth: waves in all directions that warp each other, and a few sharper creases.
#[derive(Clone, Debug)]
pub struct Wrinkles {
    waves: [(Vec2, f32); 5],
    creases: [(Vec2, f32); 2],
    height: f32,
}

impl Wrinkles {
    /// Waves about `wavelength` long and up to `height` high, metres.
    pub fn new(wavelength: f32, height: f32, rng: &mut Rng) -> Self {
        let mut wave = |scale: f32| {
            let k = TAU / (wavelength * scale * rng.range(0.7, 1.5));
            (Vec2::from_angle(rng.range(0.0, TAU)) * k, rng.range(0.0, TAU))
        };
        Self { waves: std::array::from_fn(|_| wave(1.0)), creases: std::array::from_fn(|_| wave(1.6)), height }
    }

    /// Height at `q`, on `[0, height]`.
    pub fn at(&self, q: Vec2) -> f32 {
        let mut warp = 0.0;
        let mut sum = 0.0;
        for (k, phase) in self.waves {
            warp = (k.dot(q) + phase + 0.9 * warp).sin();
            sum += warp;
        }
        let crease: f32 = self.creases.iter().map(|(k, phase)| (1.0 - (k.dot(q) + phase + 0.8 * warp).sin().abs()).powi(4)).sum();
        self.height * (0.42 + 0.07 * sum + 0.11 * crease).clamp(0.0, 1.0)
    }
}

/// Cloth that lies on a level rectangle about the origin and hangs down around it.
#[derive(Clone, Copy, Debug)]
pub struct Drape {
    /// Half the size of what carries the cloth.
    pub half: Vec2,
    /// Radius of its edges.
    pub round: f32,
    /// Height of the top.
    pub top: f32,
    /// Depth of the folds of what hangs, where it has hung for 20 cm.
    pub folds: f32,
    /// Folds per metre.
    pub per_metre: f32,
    /// Phase of the folds.
    pub phase: f32,
}

impl Drape {
    /// Position of the cloth point `q`.
    pub fn point(&self, q: Vec2, above: f32) -> Vec3 {
        let core = (self.half - self.round).max(Vec2::ZERO);
        let on = q.clamp(-core, core);
        let over = q - on;
        let reach = over.length();
        if reach < 1e-6 {
            return q.extend(self.top + above);
        }
        let way = over / reach;
        let (sin, cos) = (reach / self.round).min(FRAC_PI_2).sin_cos();
        let down = (reach - FRAC_PI_2 * self.round).max(0.0);
        let along = on.y * way.x - on.x * way.y + 0.15 * way.y.atan2(way.x);
        let wave = 0.5 + 0.5 * (TAU * self.per_metre * along + self.phase + 1.3 * (4.1 * along + self.phase).sin()).sin();
        // At corners there is too much cloth: it protrudes.
        let corner = 4.0 * (way.x * way.y).powi(2);
        let out = (self.round + above) * sin + wave * self.folds * (down / 0.2).min(1.2) + 0.30 * corner * down.min(0.25);
        (on + way * out).extend(self.top - self.round + (self.round + above) * cos - down)
    }
}

/// Folds back the cloth beyond a line: it turns over with radius `round` and lies on itself.
#[derive(Clone, Copy, Debug)]
pub struct Turnback {
    /// A point of the line.
    pub line: Vec2,
    /// Unit vector across it, towards what is folded.
    pub beyond: Vec2,
    /// Radius of the fold; larger than the cloth is thick.
    pub round: f32,
}

impl Turnback {
    /// Distance of `q` beyond the line.
    pub fn distance(&self, q: Vec2) -> f32 {
        (q - self.line).dot(self.beyond)
    }

    /// Position on the flat, and height, of the cloth point at `q`, `above` its lower side.
    pub fn point(&self, q: Vec2, above: f32) -> (Vec2, f32) {
        let d = self.distance(q);
        if d <= 0.0 {
            return (q, above);
        }
        let foot = q - self.beyond * d;
        let (sin, cos) = (d / self.round).min(PI).sin_cos();
        let back = (d - PI * self.round).max(0.0);
        let r = self.round - above;
        (foot + self.beyond * (r * sin - back), self.round - r * cos)
    }
}

/// The upper and the lower side of a padded sheet that are sewn together at the border.
///
/// `heights` gives how far both sides are above the sheet's lower face, before they close at the border over `seam` metres;
/// `place` takes a cloth point and its height to space.
pub fn quilt(
    cells: [usize; 2],
    min: Vec2,
    max: Vec2,
    seam: f32,
    heights: impl Fn(Vec2) -> [f32; 2],
    place: impl Fn(Vec2, f32) -> Vec3,
) -> [Mesh; 2] {
    let [nu, nv] = cells;
    // Vertices gather a little towards the seam, where the curvature is.
    let gather = |i: usize, n: usize| {
        let t = i as f32 / n as f32;
        t - 0.5 * (TAU * t).sin() / TAU
    };
    let cloth = |i: usize, j: usize| min + (max - min) * Vec2::new(gather(i, nu), gather(j, nv));
    let vertex = |i: usize, j: usize, side: usize| {
        let q = cloth(i, j);
        let border = (q - min).min(max - q).min_element().max(0.0);
        let open = (1.0 - (1.0 - (border / seam).min(1.0)).powi(2)).sqrt();
        let [low, high] = heights(q);
        let middle = 0.3 * high + 0.7 * low;
        place(q, middle + open * (if side == 0 { high } else { low } - middle))
    };
    let upper = grid(nu, nv, |i, j| vertex(i, j, 0), cloth);
    let lower = grid(nu, nv, |i, j| vertex(nu - i, j, 1), |i, j| cloth(nu - i, j));
    [upper.smoothed(80.0), lower.smoothed(80.0)]
}

/// A piece of cloth folded to a flat parcel that stands on z = 0, its round fold to the front (+y): `layers` of it show at the sides.
pub fn folded(size: Vec3, layers: usize, rng: &mut Rng) -> Mesh {
    let (n, m) = (18, 8 * layers);
    let half = 0.5 * size;
    let one = size.z / layers as f32;
    let wrinkles = Wrinkles::new(0.12, 0.18 * one, rng);
    // The section in the yz plane: round folds at the front, loose ends at the back that step in and out.
    let section: Vec<Vec2> = (0..m)
        .map(|k| {
            let t = k as f32 / m as f32 * TAU;
            let (sin, cos) = t.sin_cos();
            let blunt = |v: f32, p: f32| v.signum() * v.abs().powf(p);
            let y = half.y * blunt(cos, 0.22);
            let z = half.z * blunt(sin, 0.45);
            let dent = (PI * (z / one + 0.5 * layers as f32)).sin().abs();
            Vec2::new(y - 0.35 * one * (1.0 - dent) * cos.signum() * (cos.abs() > 0.6) as u8 as f32, z + half.z)
        })
        .collect();
    let point = |i: usize, j: usize| {
        let k = j.clamp(1, n + 1) - 1;
        let x = half.x * (PI * (k as f32 / n as f32 - 0.5)).sin();
        let q = section[(m - i % m) % m];
        let middle = Vec2::new(0.0, half.z);
        if j == 0 || j == n + 2 {
            return Vec3::new(x, middle.x, middle.y);
        }
        // Towards its ends the parcel is a little thinner.
        let end = 1.0 - 0.12 * (x / half.x).powi(6);
        let sag = wrinkles.at(Vec2::new(x, q.x)) * (q.y / size.z);
        Vec3::new(x, q.x * (0.98 + 0.02 * end), half.z + (q.y - half.z) * end - sag).max(Vec3::new(f32::MIN, f32::MIN, 0.0))
    };
    let uv = |i: usize, j: usize| Vec2::new(j as f32 / n as f32 * size.x, i as f32 / m as f32 * 2.0 * size.y);
    grid(m, n + 2, |i, j| point(m - i, j), uv).smoothed(70.0)
}

/// Cloth over a rod along x at the origin, of `radius` over the cloth: it hangs down `front` and `back` metres. It is `thickness` thick.
pub fn over_rod(width: f32, front: f32, back: f32, radius: f32, thickness: f32, rng: &mut Rng) -> Mesh {
    let (nu, nv) = (20, 40);
    let arc = PI * radius;
    let total = front + arc + back;
    let wrinkles = Wrinkles::new(0.25, 0.012, rng);
    let phase = rng.range(0.0, TAU);
    let place = |q: Vec2, above: f32| {
        let s = q.y + 0.5 * total;
        let r = radius - thickness + above;
        let hang = (front - s).max(s - front - arc).max(0.0);
        let loose = (hang / 0.3).min(1.0);
        let wave = loose * (0.006 * (1.0 + (TAU * q.x / (0.45 * width) + phase).sin()) + wrinkles.at(q));
        // x is reversed, so that the outer side of the cloth faces outward.
        let x = -q.x * (1.0 - 0.05 * loose);
        if s < front {
            Vec3::new(x, r + wave, s - front)
        } else if s < front + arc {
            let (sin, cos) = ((s - front) / radius).sin_cos();
            Vec3::new(x, r * cos, r * sin)
        } else {
            Vec3::new(x, -r - 0.3 * wave, front + arc - s)
        }
    };
    let half = 0.5 * Vec2::new(width, total);
    let [outer, inner] = quilt([nu, nv], -half, half, 0.004, |_| [0.0, thickness], place);
    outer.with(inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draped_cloth_stays_outside_of_what_carries_it() {
        let drape = Drape { half: Vec2::new(0.8, 1.0), round: 0.06, top: 0.5, folds: 0.03, per_metre: 3.0, phase: 1.0 };
        for i in -40..=40 {
            for j in -40..=40 {
                let q = Vec2::new(0.03, 0.034) * Vec2::new(i as f32, j as f32);
                let p = drape.point(q, 0.0);
                // Cloth is above the top or beside it, at least the radius of the edge away.
                let over = (p.truncate().abs() - (drape.half - drape.round)).max(Vec2::ZERO);
                let edge = over.length().hypot((p.z - drape.top + drape.round).max(0.0));
                assert!(p.z <= drape.top + 1e-6 && edge >= drape.round - 1e-5, "{q} lies at {p}");
            }
        }
    }

    #[test]
    fn what_is_turned_back_lies_on_the_rest() {
        let turn = Turnback { line: Vec2::new(0.0, 0.5), beyond: Vec2::Y, round: 0.05 };
        assert_eq!(turn.point(Vec2::new(0.2, 0.4), 0.03), (Vec2::new(0.2, 0.4), 0.03));
        let (q, height) = turn.point(Vec2::new(0.2, 0.5 + 0.05 * PI + 0.1), 0.0);
        assert!((q - Vec2::new(0.2, 0.4)).length() < 1e-5 && (height - 0.1).abs() < 1e-6, "{q} at {height}");
    }

    #[test]
    fn a_quilt_is_closed_and_its_padding_is_outside() {
        let [upper, lower] = quilt([20, 20], Vec2::ZERO, Vec2::ONE, 0.05, |_| [0.0, 0.1], Vec2::extend);
        let whole = upper.with(lower);
        let volume: f32 = (0..whole.triangles.len()).map(|t| whole.corners(t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        assert!((0.08..0.1).contains(&volume), "{volume}");
    }
}
