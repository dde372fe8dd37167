//! Orientations of boxes of least volume, approximately.
//!
//! A box of least volume has two neighbouring sides that touch edges of the convex hull (O'Rourke 1985, "Finding minimal enclosing
//! boxes"); trying all pairs of edges takes cubic time. Here every larger face of the hull proposes the box that lies flush with
//! it, which is best of its kind by rotating calipers, and a spread of rotations proposes boxes that lie flush with none. The
//! best of them are improved: about each axis in turn by calipers, until none gains, and by small random turns (after Chang,
//! Gorissen & Melchior 2011, "Fast oriented bounding box optimization on the rotation group SO(3)", who start from as many).

use super::hull::{Hull, convex_hull};
use super::rectangle::least_rectangle;
use enfilade_math::{DMat3, DQuat, DVec2, DVec3, Rng};

/// Faces that propose a box, by area: furniture has fewer, and on rounder bodies the volume hardly depends on the choice.
const FACES: usize = 300;
/// Normals this close, in radians, propose the same box.
const SAME_NORMAL: f64 = 1e-5;
/// Number of rotations that propose a box for every body.
const ROTATIONS: usize = 256;
/// How many proposals are improved.
const STARTS: usize = 8;
/// Turns tried on each.
const TURNS: usize = 300;
/// Above this number of corners, the hull is built from the corners that are extreme in as many directions.
const CORNERS: usize = 1500;

/// The directions of the sides of a box around `points` of nearly the least volume: columns, orthonormal, right-handed.
///
/// Points in a plane give the rectangle of least area, points on a line its direction.
pub(super) fn least_orientation(points: &[DVec3]) -> DMat3 {
    match convex_hull(points) {
        Hull::Point => DMat3::IDENTITY,
        Hull::Line(along) => flush(points, along).axes,
        Hull::Plane(normal) => flush(points, normal).axes,
        Hull::Body { corners, faces } if corners.len() <= CORNERS => search(&corners, faces),
        Hull::Body { corners, .. } => match convex_hull(&extreme(&corners)) {
            Hull::Body { corners: fewer, faces } => {
                let axes = search(&fewer, faces);
                improve_by_calipers(&corners, Proposal { axes, volume: volume(&corners, axes) }).axes
            }
            _ => DMat3::IDENTITY,
        },
    }
}

/// An orientation, and the volume of the box that it has around the hull's corners.
#[derive(Clone, Copy)]
struct Proposal {
    axes: DMat3,
    volume: f64,
}

fn search(corners: &[DVec3], faces: Vec<(DVec3, f64)>) -> DMat3 {
    let mut proposals: Vec<Proposal> = distinct_normals(faces).into_iter().map(|normal| flush(corners, normal)).collect();
    proposals.extend(rotations().map(|axes| Proposal { axes, volume: volume(corners, axes) }));
    proposals.sort_by(|a, b| a.volume.total_cmp(&b.volume));
    let improved = proposals.into_iter().take(STARTS).map(|start| improve(corners, start));
    improved.min_by(|a, b| a.volume.total_cmp(&b.volume)).map_or(DMat3::IDENTITY, |best| best.axes)
}

/// The normals of the largest faces, each direction once.
fn distinct_normals(mut faces: Vec<(DVec3, f64)>) -> Vec<DVec3> {
    faces.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut normals: Vec<DVec3> = Vec::new();
    for (normal, area) in faces {
        if normals.len() == FACES || area <= 0.0 {
            break;
        }
        if normals.iter().all(|n| n.cross(normal).length_squared() > SAME_NORMAL * SAME_NORMAL) {
            normals.push(normal);
        }
    }
    normals
}

/// Evenly spread rotations (Alexa 2022, "Super-Fibonacci Spirals").
fn rotations() -> impl Iterator<Item = DMat3> {
    let (phi, psi) = (std::f64::consts::SQRT_2, 1.533_751_168_755_204_3);
    (0..ROTATIONS).map(move |i| {
        let s = i as f64 + 0.5;
        let (t, d) = (s / ROTATIONS as f64, std::f64::consts::TAU * s);
        let ((sin_a, cos_a), (sin_b, cos_b)) = ((d / phi).sin_cos(), (d / psi).sin_cos());
        let (r, other) = (t.sqrt(), (1.0 - t).sqrt());
        DMat3::from_quat(DQuat::from_xyzw(r * sin_a, r * cos_a, other * sin_b, other * cos_b))
    })
}

/// The smallest box with a side across `axis`, which is its third.
fn flush(corners: &[DVec3], axis: DVec3) -> Proposal {
    let (u, v) = axis.any_orthonormal_pair();
    let mut flat: Vec<DVec2> = corners.iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
    let (along, area) = least_rectangle(&mut flat);
    let first = (u * along.x + v * along.y).normalize();
    let axes = DMat3::from_cols(first, axis.cross(first), axis);
    Proposal { axes, volume: area * span(corners, axis) }
}

fn span(corners: &[DVec3], axis: DVec3) -> f64 {
    let (min, max) = corners.iter().map(|p| p.dot(axis)).fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), d| (min.min(d), max.max(d)));
    max - min
}

fn volume(corners: &[DVec3], axes: DMat3) -> f64 {
    let turn = axes.transpose();
    let (min, max) = corners.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| {
        let p = turn * p;
        (min.min(p), max.max(p))
    });
    (max - min).element_product()
}

/// Calipers and small turns by turns.
fn improve(corners: &[DVec3], start: Proposal) -> Proposal {
    let mut best = improve_by_calipers(corners, start);
    let mut rng = Rng::new(0);
    let mut step_rad = 0.1;
    for _ in 0..TURNS {
        let turn = DVec3::new(rng.next_f64(), rng.next_f64(), rng.next_f64()) - 0.5;
        let axes = best.axes * DMat3::from_quat(DQuat::from_scaled_axis(step_rad * turn));
        let tried = Proposal { axes, volume: volume(corners, axes) };
        if tried.volume < best.volume {
            best = tried;
            step_rad *= 1.5;
        } else {
            step_rad *= 0.93;
        }
    }
    improve_by_calipers(corners, best)
}

/// Turns the box about each of its axes in turn to where it is smallest, until that gains nothing.
fn improve_by_calipers(corners: &[DVec3], start: Proposal) -> Proposal {
    let mut best = start;
    for _ in 0..50 {
        let before = best.volume;
        for axis in 0..3 {
            let tried = flush(corners, best.axes.col(axis));
            if tried.volume < best.volume {
                best = tried;
            }
        }
        if best.volume >= before * (1.0 - 1e-12) {
            break;
        }
    }
    best
}

/// The corners that are farthest in one of [`CORNERS`] directions, which are evenly spread over the sphere.
fn extreme(corners: &[DVec3]) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let direction = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / CORNERS as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    };
    let farthest = |i: usize| {
        let d = direction(i);
        let far = corners.iter().enumerate().map(|(i, p)| (i, p.dot(d)));
        far.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best }).0
    };
    let mut kept: Vec<usize> = (0..CORNERS).map(farthest).collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|i| corners[i]).collect()
}
