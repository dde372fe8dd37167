//! Forms that recur in small things: vessels, rods, bent wires, flat shapes cut from an outline.

use crate::shape::{Reshape, grid, lathe, spline, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// [`lathe`] of a profile given as plain numbers.
pub fn turned(profile: &[[f32; 2]], n: usize) -> Mesh {
    let profile: Vec<Vec2> = profile.iter().copied().map(Vec2::from_array).collect();
    lathe(&profile, n)
}

/// An upright cylinder on z = 0 with chamfered edges.
pub fn cylinder(radius: f32, height: f32, n: usize) -> Mesh {
    let c = (0.12 * radius).min(0.2 * height).min(0.003);
    turned(&[[0.0, 0.0], [radius - c, 0.0], [radius, c], [radius, height - c], [radius - c, height], [0.0, height]], n)
}

/// A vessel that is open at the top: its outside is a smooth curve through `outside`, from the edge of the foot up to the rim; its
/// wall and its floor are `wall` thick.
pub fn vessel(outside: &[[f32; 2]], wall: f32, n: usize) -> Mesh {
    let mut outer = spline(outside, 5);
    let (foot, rim) = (outer[0], outer[outer.len() - 1]);
    // A spline that leaves the foot at a slant dips below it first.
    outer.iter_mut().for_each(|p| p.y = p.y.clamp(foot.y, rim.y));
    let mut profile = vec![Vec2::new(0.0, foot.y)];
    profile.extend(&outer);
    profile.push(Vec2::new(rim.x - 0.5 * wall, rim.y + 0.3 * wall));
    let floor = foot.y + wall;
    profile.extend(outer.iter().rev().filter(|p| p.y > floor).map(|p| Vec2::new((p.x - wall).max(0.001), p.y)));
    let last = profile[profile.len() - 1];
    profile.extend([Vec2::new(0.85 * last.x, floor), Vec2::new(0.0, floor)]);
    lathe(&profile, n)
}

/// A smooth rod through `points`.
pub fn wire(points: &[[f32; 3]], radius: f32, n: usize) -> Mesh {
    const STEPS: usize = 5;
    let p = |i: isize| Vec3::from_array(points[i.clamp(0, points.len() as isize - 1) as usize]);
    let mut path = Vec::with_capacity(points.len() * STEPS);
    for i in 0..points.len() as isize - 1 {
        let (a, b, c, d) = (p(i - 1), p(i), p(i + 1), p(i + 2));
        for k in 0..STEPS {
            let t = k as f32 / STEPS as f32;
            path.push(0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t + (3.0 * b - a - 3.0 * c + d) * t * t * t));
        }
    }
    path.push(p(points.len() as isize - 1));
    tube(&path, radius, n)
}

/// A straight rod.
pub fn rod(from: [f32; 3], to: [f32; 3], radius: f32, n: usize) -> Mesh {
    tube(&[Vec3::from_array(from), Vec3::from_array(to)], radius, n)
}

/// A plate from z = 0 to `thickness` with this outline, counter-clockwise and star-shaped about its middle, its edges chamfered.
pub fn cut_out(outline: &[Vec2], thickness: f32, chamfer: f32) -> Mesh {
    let n = outline.len();
    let middle = outline.iter().sum::<Vec2>() / n as f32;
    let inset = |p: Vec2| p - (p - middle).normalize_or_zero() * chamfer;
    let rings = [(0.0, true), (chamfer, false), (thickness - chamfer, false), (thickness, true)];
    let point = |i: usize, j: usize| {
        if j == 0 || j == 5 {
            return middle.extend(if j == 0 { 0.0 } else { thickness });
        }
        let (z, inside) = rings[j - 1];
        let p = outline[i % n];
        (if inside { inset(p) } else { p }).extend(z)
    };
    let uv = |i: usize, j: usize| {
        let p = point(i, j);
        Vec2::new(p.x, p.y + p.z)
    };
    grid(n, 5, point, uv).smoothed(40.0)
}

/// A rectangle about the origin with round corners, counter-clockwise.
pub fn rounded_rectangle(width: f32, depth: f32, radius: f32, steps: usize) -> Vec<Vec2> {
    let mut outline: Vec<Vec2> = crate::shape::rounded_loop(width, depth, radius, steps).into_iter().map(Vec3::truncate).collect();
    outline.pop();
    outline
}

/// A body whose horizontal sections are the rounded rectangles `rings`, given as [width, depth, corner radius, z] and closed at both
/// ends. The rings are in the order of a profile of [`lathe`]: up the outside and, if the body is hollow, down the inside.
pub fn loft(rings: &[[f32; 4]], steps: usize) -> Mesh {
    let outlines: Vec<Vec<Vec3>> = rings
        .iter()
        .map(|&[w, d, r, z]| {
            let r = r.min(0.499 * w.min(d)).max(1e-5);
            rounded_rectangle(w, d, r, steps).into_iter().map(|p| p.extend(z)).collect()
        })
        .collect();
    let (n, last) = (outlines[0].len(), rings.len() + 1);
    let point = |i: usize, j: usize| match j {
        0 => Vec3::new(0.0, 0.0, rings[0][3]),
        j if j == last => Vec3::new(0.0, 0.0, rings[rings.len() - 1][3]),
        j => outlines[j - 1][i % n],
    };
    let uv = |i: usize, j: usize| {
        let p = point(i, j);
        Vec2::new(p.x + 0.37 * p.y, p.y + p.z)
    };
    grid(n, last, point, uv).smoothed(40.0)
}

/// Turns a mesh on z = 0 so that it protrudes from the wall behind it: up becomes +y.
pub fn to_front(mesh: Mesh) -> Mesh {
    mesh.turned(Vec3::X, -FRAC_PI_2)
}

/// A picture of `width` × `height` that faces +y, its texture upright over the unit square as seen from the front.
pub fn picture(width: f32, height: f32) -> Mesh {
    let corner = |i: usize, j: usize| Vec2::new(i as f32, j as f32);
    grid(1, 1, |i, j| Vec3::new(width * (0.5 - corner(i, j).x), 0.0, height * (corner(i, j).y - 0.5)), corner)
}

/// Joins meshes into one.
pub fn all(meshes: impl IntoIterator<Item = Mesh>) -> Mesh {
    meshes.into_iter().fold(Mesh::default(), Reshape::with)
}

/// The directions of `n` things around a circle, from `start` radians.
pub fn around(n: usize, start: f32) -> impl Iterator<Item = Vec2> {
    (0..n).map(move |k| Vec2::from_angle(start + TAU * k as f32 / n as f32))
}

/// The corners of a rectangle of this half width and half depth, counter-clockwise from the front right one.
pub fn corners(half: Vec2) -> [Vec2; 4] {
    [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].map(|s| s * half)
}

/// A level plate whose surface is z = 0, with rectangular holes `[x0, x1, y0, y1]` that go through; its outer upper edge is chamfered.
pub fn plate_with_holes(min: Vec2, max: Vec2, thickness: f32, chamfer: f32, holes: &[[f32; 4]]) -> Mesh {
    let cuts = |low: f32, high: f32, of: [usize; 2]| {
        let mut all = vec![low, low + chamfer, high - chamfer, high];
        all.extend(holes.iter().flat_map(|h| of.map(|k| h[k])));
        all.sort_by(f32::total_cmp);
        all.dedup();
        all
    };
    let (xs, ys) = (cuts(min.x, max.x, [0, 1]), cuts(min.y, max.y, [2, 3]));
    let solid = |i: usize, j: usize| {
        // An index below zero has wrapped around to a large number and is out of range too.
        if i >= xs.len() - 1 || j >= ys.len() - 1 {
            return false;
        }
        let (x, y) = (0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1]));
        !holes.iter().any(|h| x > h[0] && x < h[1] && y > h[2] && y < h[3])
    };
    let top = |x: f32, y: f32| if x == min.x || x == max.x || y == min.y || y == max.y { -chamfer } else { 0.0 };
    let mut mesh = Mesh::default();
    let mut face = |quad: [Vec3; 4], uv: fn(Vec3) -> Vec2| {
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(quad);
        mesh.uvs.extend(quad.map(uv));
        mesh.triangles.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
    };
    let flat = |p: Vec3| Vec2::new(p.x, p.y);
    for j in 0..ys.len() - 1 {
        for i in 0..xs.len() - 1 {
            if !solid(i, j) {
                continue;
            }
            let (x0, x1, y0, y1) = (xs[i], xs[i + 1], ys[j], ys[j + 1]);
            let up = |x: f32, y: f32| Vec3::new(x, y, top(x, y));
            let down = |x: f32, y: f32| Vec3::new(x, y, -thickness);
            face([up(x0, y0), up(x1, y0), up(x1, y1), up(x0, y1)], flat);
            face([down(x0, y0), down(x0, y1), down(x1, y1), down(x1, y0)], flat);
            let mut side = |open: bool, a: [f32; 2], b: [f32; 2], uv: fn(Vec3) -> Vec2| {
                if open {
                    face([down(a[0], a[1]), down(b[0], b[1]), up(b[0], b[1]), up(a[0], a[1])], uv);
                }
            };
            side(!solid(i, j.wrapping_sub(1)), [x0, y0], [x1, y0], |p| Vec2::new(p.x, p.z));
            side(!solid(i, j + 1), [x1, y1], [x0, y1], |p| Vec2::new(p.x, p.z));
            side(!solid(i.wrapping_sub(1), j), [x0, y1], [x0, y0], |p| Vec2::new(p.y, p.z));
            side(!solid(i + 1, j), [x1, y0], [x1, y1], |p| Vec2::new(p.y, p.z));
        }
    }
    mesh.smoothed(20.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::volume;

    #[test]
    fn forms_are_closed_and_face_outward() {
        let square = [Vec2::new(-0.1, -0.2), Vec2::new(0.1, -0.2), Vec2::new(0.1, 0.2), Vec2::new(-0.1, 0.2)];
        let holes = [[-0.3, 0.1, -0.1, 0.1]];
        let forms = [
            ("cylinder", cylinder(0.05, 0.3, 64), std::f32::consts::PI * 0.0025 * 0.3),
            ("cut out", cut_out(&square, 0.02, 0.001), 0.2 * 0.4 * 0.02),
            ("plate", plate_with_holes(Vec2::new(-1.0, -0.3), Vec2::new(1.0, 0.3), 0.04, 0.002, &holes), (1.2 - 0.08) * 0.04),
            ("vessel", vessel(&[[0.05, 0.0], [0.05, 0.05], [0.05, 0.1]], 0.005, 64), 0.000_785 - 0.000_604),
            ("loft", loft(&[[0.2, 0.1, 0.01, 0.0], [0.2, 0.1, 0.01, 0.3]], 8), 0.3 * (0.02 - 0.000_086)),
            ("wire", wire(&[[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.4, 0.0, 0.0]], 0.01, 24), 0.4 * 0.000_314),
        ];
        for (name, mesh, expected) in forms {
            assert_eq!(mesh.validate(), Ok(()), "{name}");
            let found = volume(&mesh);
            assert!((found - expected).abs() < 0.08 * expected, "{name}: {found} instead of {expected}");
        }
    }
}
