//! An easy chair on two bent frames of laminated wood that spring, 68 cm wide, class chair: seat and back are one padded sheet that hangs in
//! the frame, with a head rest. Its measures are those of common models of the kind.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{board, grained};
use crate::shape::{Reshape, grid, padded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// An easy chair on bent frames that spring.
#[derive(Clone, Copy, Debug)]
pub struct BentwoodChair {
    /// Finish of the frames.
    pub wood: Finish,
    /// Finish of the padding.
    pub cloth: Finish,
    /// The back ends at the shoulders instead of above the head.
    pub low: bool,
}

/// Half the width over the frames, metres.
const HALF: f32 = 0.34;
/// Width and thickness of the bent strips, metres.
const STRIP: [f32; 2] = [0.05, 0.022];
/// Points of the padding's middle line, (y, z), from the front edge of the seat to the top of the back.
const LINE: [[f32; 2]; 5] = [[0.33, 0.43], [0.08, 0.36], [-0.16, 0.37], [-0.28, 0.62], [-0.39, 0.98]];

impl BentwoodChair {
    /// A random one.
    pub fn random(rng: &mut Rng) -> Self {
        Self {
            wood: [Finish::Wood, Finish::Wood, Finish::DarkWood, Finish::BlackPlastic][rng.below(4)],
            cloth: [Finish::ArmchairCloth, Finish::Leather, Finish::SofaCloth, Finish::Felt][rng.below(4)],
            low: rng.below(3) == 0,
        }
    }

    /// Size of the box around it.
    pub fn size(&self) -> Vec3 {
        Vec3::new(2.0 * HALF, 0.9, if self.low { 0.92 } else { 1.04 })
    }

    /// Adds its parts, as an object of `family`.
    pub fn build(&self, b: &mut Builder, family: &str, pose: DAffine3, rng: &mut Rng) {
        let object = b.object(family, Class::Chair, pose);
        let x = HALF - 0.5 * STRIP[0];
        for (name, s) in [("frame_left", -1.0f32), ("frame_right", 1.0)] {
            // From the rear end of the runner forward, up the front and back along the arm.
            let path = [[-0.4, 0.011], [0.0, 0.011], [0.24, 0.011], [0.36, 0.06], [0.4, 0.3], [0.36, 0.5], [0.22, 0.57], [-0.36, 0.5]];
            // A spline that rises dips below the floor first.
            let line: Vec<Vec2> = smooth(&path).into_iter().map(|p| p.max(Vec2::new(f32::MIN, 0.5 * STRIP[1]))).collect();
            let mesh = strip(&line, STRIP[0], STRIP[1]).moved(Vec3::new(s * x, 0.0, 0.0));
            b.part(&object, name, grained(mesh, rng), self.wood);
        }
        let line = smooth(&LINE);
        let end = if self.low { line.len() - 2 } else { line.len() };
        let line = &line[..end];
        let below: Vec<Vec2> = line.iter().enumerate().map(|(k, p)| *p - normal(line, k) * 0.045).collect();
        for (name, s) in [("rail_left", -1.0f32), ("rail_right", 1.0)] {
            let mesh = strip(&below, 0.03, 0.02).moved(Vec3::new(s * (x - 0.045), 0.0, 0.0));
            b.part(&object, name, grained(mesh, rng), self.wood);
        }
        let bar = |y: f32, z: f32| board([-x, y - 0.02, z - 0.01], [x, y + 0.02, z + 0.01], 0.002);
        // Bars tie the rails to the frames: at the front below the seat, at the back where the arms end, and on the floor.
        let tie = |y: f32| below.iter().copied().min_by(|p, q| (p.x - y).abs().total_cmp(&(q.x - y).abs())).unwrap_or(Vec2::ZERO);
        let (front, rear) = (tie(0.33), below.iter().copied().min_by(|p, q| (p.y - 0.51).abs().total_cmp(&(q.y - 0.51).abs())));
        let rear = rear.unwrap_or(front);
        let bars = [bar(front.x + 0.04, front.y - 0.002), bar(rear.x, rear.y), bar(-0.3, 0.011)];
        b.part(&object, "bars", grained(all(bars), rng), self.wood);
        let pad = pad(line, 2.0 * (x - 0.03), 0.07).uv_moved(Vec2::splat(rng.next_f32()));
        b.part(&object, "pad", pad, self.cloth);
        if !self.low {
            let roll = padded_box(Vec3::new(0.46, 0.06, 0.16), 0.028, 0.006).turned(Vec3::X, 0.3);
            b.part(&object, "head_rest", roll.moved(Vec3::new(0.0, -0.30, 0.9)), self.cloth);
        }
    }
}

/// A smooth curve through points, in steps of a fifth.
fn smooth(points: &[[f32; 2]]) -> Vec<Vec2> {
    crate::shape::curve(points, 5)
}

/// Up from the curve at a point, where it runs from the front to the rear and up.
fn normal(line: &[Vec2], k: usize) -> Vec2 {
    let along = line[(k + 1).min(line.len() - 1)] - line[k.saturating_sub(1)];
    -along.normalize_or(Vec2::NEG_X).perp()
}

/// A strip of this width along x that follows a curve in the plane of y and z, `thick` across it.
fn strip(line: &[Vec2], wide: f32, thick: f32) -> Mesh {
    section(line, wide, |_| 0.5 * thick, 4)
}

/// A padded sheet along a curve: quilted across every 12 cm.
fn pad(line: &[Vec2], wide: f32, thick: f32) -> Mesh {
    let mut finer = Vec::new();
    for pair in line.windows(2) {
        finer.extend((0..4).map(|k| pair[0].lerp(pair[1], 0.25 * k as f32)));
    }
    finer.extend(line.last());
    let mut along = 0.0;
    let length: Vec<f32> = finer
        .iter()
        .enumerate()
        .map(|(k, p)| {
            along += if k == 0 { 0.0 } else { p.distance(finer[k - 1]) };
            along
        })
        .collect();
    let quilted = |k: usize| 0.5 * thick * (0.62 + 0.38 * (std::f32::consts::PI * length[k] / 0.12).sin().abs().sqrt());
    section(&finer, wide, quilted, 24)
}

/// A closed body along a curve, `wide` along x and `half(k)` thick to either side of the curve's point k; `n` is 4 for sharp edges.
fn section(line: &[Vec2], wide: f32, half: impl Fn(usize) -> f32, n: usize) -> Mesh {
    let last = line.len() - 1;
    let ring = |i: usize, half: f32| {
        if n == 4 {
            return [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, out]| Vec2::new(0.5 * wide * x, half * out))[i % 4];
        }
        let (sin, cos) = (std::f32::consts::TAU * (i % n) as f32 / n as f32).sin_cos();
        let round = |v: f32, power: f32| v.signum() * v.abs().powf(power);
        Vec2::new(0.5 * wide * round(cos, 0.3), half * round(sin, 0.6))
    };
    let point = |i: usize, j: usize| {
        let k = j.clamp(1, last + 1) - 1;
        let q = if j == 0 || j == last + 2 { Vec2::ZERO } else { ring(i, half(k)) };
        let p = line[k] + normal(line, k) * q.y;
        Vec3::new(q.x, p.x, p.y)
    };
    let uv = |i: usize, j: usize| Vec2::new(j as f32 * 0.03, i as f32 / n as f32 * wide);
    let mesh = grid(n, last + 2, |i, j| point(n - i, j), uv);
    let mesh = if volume(&mesh) < 0.0 { grid(n, last + 2, point, uv) } else { mesh };
    mesh.smoothed(if n == 4 { 30.0 } else { 60.0 })
}

/// Six times the volume of a closed mesh: positive when its faces look outward.
fn volume(mesh: &Mesh) -> f32 {
    (0..mesh.triangles.len())
        .map(|t| {
            let [a, b, c] = mesh.corners(t);
            a.dot(b.cross(c))
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_back_leans_behind_the_middle() {
        let line = smooth(&LINE);
        for [y, z] in LINE {
            assert!(line.iter().any(|p| p.distance(Vec2::new(y, z)) < 1e-6), "{y} {z}");
        }
        // It rises all the way, and leans further the higher it is.
        let back: Vec<&Vec2> = line.iter().skip_while(|p| p.x > -0.16).collect();
        assert!(back.len() > 8 && back.windows(2).all(|pair| pair[1].x < pair[0].x && pair[1].y > pair[0].y), "{back:?}");
    }
}
