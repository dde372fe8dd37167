//! Turned shapes: a profile of radii and heights that goes round the z axis, with spheres, disks and smooth profiles.

use super::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Turns a profile of (radius, height) about the z axis in `n` steps.
///
/// The profile runs so that the outside is on its right: outward along the bottom, up the outside, down the inside. It does not
/// cross itself: the inside would be outside there. Corners sharper than 40° stay sharp.
pub fn lathe(profile: &[Vec2], n: usize) -> Mesh {
    debug_assert!(!crosses_itself(profile), "a profile crosses itself: {profile:?}");
    let widest = profile.iter().fold(0.0f32, |w, p| w.max(p.x));
    let mut length = vec![0.0];
    for pair in profile.windows(2) {
        length.push(length[length.len() - 1] + pair[0].distance(pair[1]));
    }
    let point = |i: usize, j: usize| {
        let (sin, cos) = ((i % n) as f32 / n as f32 * TAU).sin_cos();
        let p = profile[j];
        if p.x == 0.0 { Vec3::new(0.0, 0.0, p.y) } else { Vec3::new(p.x * cos, p.x * sin, p.y) }
    };
    let uv = |i: usize, j: usize| Vec2::new(i as f32 / n as f32 * TAU * widest, length[j]);
    grid(n, profile.len() - 1, point, uv).smoothed(40.0)
}

/// True when two pieces of a polyline cut each other by more than what rounding does.
fn crosses_itself(line: &[Vec2]) -> bool {
    const ROUNDING: f32 = 1e-5;
    let apart = |[a, b]: [Vec2; 2], ends: [Vec2; 2]| {
        let across = (b - a).perp().normalize_or_zero();
        let [p, q] = ends.map(|end| across.dot(end - a));
        p.min(q) < -ROUNDING && p.max(q) > ROUNDING
    };
    let pieces: Vec<[Vec2; 2]> = line.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    pieces.iter().enumerate().any(|(k, &s)| pieces[k + 1..].iter().any(|&t| apart(s, t) && apart(t, s)))
}

/// A sphere about the origin in `n` × `n`/2 steps.
pub fn sphere(radius: f32, n: usize) -> Mesh {
    let rows = n / 2;
    let profile: Vec<Vec2> = (0..=rows)
        .map(|j| {
            let (sin, cos) = (PI * j as f32 / rows as f32).sin_cos();
            if j == 0 || j == rows { Vec2::new(0.0, -cos.signum() * radius) } else { Vec2::new(radius * sin, -radius * cos) }
        })
        .collect();
    lathe(&profile, n)
}

/// A flat disk at height zero that faces up.
pub fn disk(radius: f32, n: usize) -> Mesh {
    lathe(&[Vec2::new(radius, 0.0), Vec2::ZERO], n)
}

/// A smooth profile through `points`, as [`curve`] makes it; its radii never go negative.
pub fn spline(points: &[[f32; 2]], steps: usize) -> Vec<Vec2> {
    curve(points, steps).into_iter().map(|p| Vec2::new(p.x.max(0.0), p.y)).collect()
}

/// A smooth curve through `points` (Catmull–Rom), `steps` pieces between neighbours.
pub fn curve(points: &[[f32; 2]], steps: usize) -> Vec<Vec2> {
    let p = |i: isize| Vec2::from_array(points[i.clamp(0, points.len() as isize - 1) as usize]);
    let mut curve = Vec::with_capacity((points.len() - 1) * steps + 1);
    for i in 0..points.len() as isize - 1 {
        let (a, b, c, d) = (p(i - 1), p(i), p(i + 1), p(i + 2));
        for k in 0..steps {
            let t = k as f32 / steps as f32;
            let q = 0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t + (3.0 * b - a - 3.0 * c + d) * t * t * t);
            curve.push(q);
        }
    }
    curve.push(p(points.len() as isize - 1));
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_whose_inside_comes_out_crosses_itself() {
        let tub = |inside: f32| [[0.0, 0.0], [0.2, 0.0], [0.24, 0.5], [0.23, 0.5], [inside, 0.25], [0.0, 0.01]].map(Vec2::from_array);
        assert!(!crosses_itself(&tub(0.21)));
        assert!(crosses_itself(&tub(0.23)));
        // It may come back along itself, and close.
        assert!(!crosses_itself(&[[0.1, 0.0], [0.1, 0.3], [0.1, 0.1], [0.1, 0.0]].map(Vec2::from_array)));
    }
}
