//! Round rods along a path, and the closed paths that piping and wire frames follow.

use super::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{Quat, Vec2, Vec3};
use std::f32::consts::TAU;

/// A round rod of `radius` along `path`, closed by flat ends, `n` steps around.
///
/// # Panics
/// When the path has fewer than two points.
pub fn tube(path: &[Vec3], radius: f32, n: usize) -> Mesh {
    assert!(path.len() >= 2, "a tube needs two points, found {}", path.len());
    let last = path.len() - 1;
    let tangent = |j: usize| (path[(j + 1).min(last)] - path[j.max(1) - 1]).normalize_or(Vec3::Z);
    let mut normal = tangent(0).any_orthonormal_vector();
    let mut frames = Vec::with_capacity(path.len());
    let mut length = vec![0.0];
    for j in 0..=last {
        if j > 0 {
            normal = Quat::from_rotation_arc(tangent(j - 1), tangent(j)) * normal;
            length.push(length[j - 1] + path[j].distance(path[j - 1]));
        }
        frames.push((normal, tangent(j).cross(normal)));
    }
    // Two more rings at either end collapse to the centre and close the tube.
    let ring = |j: usize| (j.saturating_sub(1)).min(last);
    let point = |i: usize, j: usize| {
        if j == 0 || j == last + 2 {
            return path[ring(j)];
        }
        let (sin, cos) = ((i % n) as f32 / n as f32 * TAU).sin_cos();
        let (x, y) = frames[ring(j)];
        path[ring(j)] + radius * (x * cos + y * sin)
    };
    let uv = |i: usize, j: usize| Vec2::new(length[ring(j)], i as f32 / n as f32 * TAU * radius);
    grid(n, last + 2, point, uv).smoothed(50.0)
}

/// A closed path around a rectangle of `width` × `depth` in the plane z = 0 with round corners: piping and wire frames. The last
/// point repeats the first.
pub fn rounded_loop(width: f32, depth: f32, radius: f32, steps: usize) -> Vec<Vec3> {
    let mut path = Vec::new();
    for (corner, [sx, sy]) in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].into_iter().enumerate() {
        let center = Vec3::new(sx * (0.5 * width - radius), sy * (0.5 * depth - radius), 0.0);
        for k in 0..=steps {
            let (sin, cos) = ((corner as f32 + k as f32 / steps as f32) * 0.25 * TAU).sin_cos();
            path.push(center + radius * Vec3::new(cos, sin, 0.0));
        }
    }
    path.push(path[0]);
    path
}
