//! Marks on cushions, seats and covers: films that follow what they are on.

use super::super::stage::Stage;
use super::place::Place;
use crate::room::Footprint;
use enfilade_furniture::meet::{Body, Triangle, around};
use enfilade_furniture::shape::Reshape;
use enfilade_furniture::{object_of, pose};
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Points of a film along each side.
const POINTS: usize = 13;
/// Distance from the surface: more than the surface is bent between two points of the film, metres.
const FILM: f32 = 0.0012;
/// Greatest unevenness below a mark, and from one point of the film to the next, metres.
const UNEVEN: [f32; 2] = [0.06, 0.012];
/// Free height over a mark, metres.
const FREE: f32 = 0.03;
/// Lowest seats, metres.
const LOW: f32 = 0.25;

/// A place on the upper side of something soft, if it is free there, with the film on it.
pub(super) fn on_soft(stage: &mut Stage, host: &str, half: Vec2, rng: &mut Rng) -> Option<(usize, Place)> {
    let ground = stage.over(host, false)?;
    let [min, max] = ground.window();
    let center = min + (max - min) * Vec2::new(rng.next_f32(), rng.next_f32());
    let place = Footprint { center, half, yaw: rng.range(0.0, TAU) };
    let level = ground.level(&place, FREE).filter(|level| level.spread < UNEVEN[0] && level.top > LOW)?;
    let mesh = film(stage.body(host)?, &place, level.top)?;
    let part = stage.home.scene.parts.iter().position(|part| object_of(&part.name) == host)?;
    let at = DVec3::new(f64::from(center.x), f64::from(center.y), f64::from(level.top));
    Some((part, Place { pose: pose(at.x, at.y, at.z, 0.0), half, film: Some(mesh) }))
}

/// A film over a rectangle on the upper side of a body, around the rectangle's middle at height `top`, if that has no gaps and no steps.
fn film(body: &Body, place: &Footprint, top: f32) -> Option<Mesh> {
    let turn = Vec2::from_angle(place.yaw);
    let reach = place.half.length();
    let near: Vec<&Triangle> = body.parts().flatten().filter(|t| is_near(t, place.center, reach)).collect();
    let mut mesh = Mesh::default();
    for k in 0..POINTS * POINTS {
        let uv = Vec2::new((k % POINTS) as f32, (k / POINTS) as f32) / (POINTS - 1) as f32;
        let p = turn.rotate((2.0 * uv - 1.0) * place.half);
        let z = near.iter().filter_map(|t| height(t, place.center + p)).reduce(f32::max)?;
        mesh.positions.push(p.extend(z + FILM - top));
        mesh.uvs.push(uv);
    }
    let step = |a: usize, b: usize| (mesh.positions[a].z - mesh.positions[b].z).abs() < UNEVEN[1];
    let inner = |k: usize| k % POINTS + 1 < POINTS;
    let even = (0..POINTS * POINTS).all(|k| (!inner(k) || step(k, k + 1)) && (k + POINTS >= POINTS * POINTS || step(k, k + POINTS)));
    for k in (0..POINTS * (POINTS - 1)).filter(|&k| inner(k)) {
        let [a, b, c, d] = [k, k + 1, k + POINTS + 1, k + POINTS].map(|k| k as u32);
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    even.then(|| mesh.smoothed(60.0))
}

fn is_near(triangle: &Triangle, center: Vec2, reach: f32) -> bool {
    let bounds = around(triangle);
    bounds.min.truncate().cmple(center + reach).all() && bounds.max.truncate().cmpge(center - reach).all()
}

/// Height of a triangle over a point of the floor, if it is over it.
fn height([a, b, c]: &Triangle, p: Vec2) -> Option<f32> {
    let [ab, ac, ap] = [b.truncate() - a.truncate(), c.truncate() - a.truncate(), p - a.truncate()];
    let area = ab.perp_dot(ac);
    if area.abs() < 1e-12 {
        return None;
    }
    let (v, w) = (ap.perp_dot(ac) / area, ab.perp_dot(ap) / area);
    (v >= 0.0 && w >= 0.0 && v + w <= 1.0).then(|| Vec3::new(a.z, b.z, c.z).dot(Vec3::new(1.0 - v - w, v, w)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::shape::rounded_box;

    #[test]
    fn a_film_follows_a_cushion_and_ends_at_a_gap() {
        let mut body = Body::new("sofa_1");
        for x in [-0.31f32, 0.31] {
            let mesh = rounded_box(Vec3::new(0.6, 0.6, 0.2), 0.08, 4).moved(Vec3::new(x, 0.0, 0.4));
            body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect());
        }
        let at = |x: f32| Footprint { center: Vec2::new(x, 0.0), half: Vec2::new(0.1, 0.06), yaw: 0.4 };
        let mesh = film(&body, &at(0.3), 0.5).unwrap();
        assert!(mesh.positions.iter().all(|p| (p.z - FILM).abs() < 1e-4));
        assert!(mesh.normals.iter().all(|n| n.z > 0.99) && mesh.validate() == Ok(()));
        // Over the border its points are lower, between the cushions there is none.
        let border = film(&body, &at(0.45), 0.5).unwrap();
        assert!(border.positions.iter().any(|p| p.z < -0.001));
        assert!(film(&body, &at(0.0), 0.5).is_none());
    }
}
