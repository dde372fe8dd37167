//! Where a visitor would stand to look at the room.

use crate::layout::Plan;
use enfilade_math::{Bounds3, DMat3, Vec2, Vec3};
use enfilade_scene::{Scene, StartCamera, WorldMesh};

/// Distance that a camera keeps from every part's box.
pub const CLEARANCE: f32 = 0.5;

const FOV_X_RAD: f64 = std::f64::consts::FRAC_PI_3;

/// Four views across the room, each from the free place nearest to where one would like to stand; a view without one is left out.
pub fn cameras(scene: &Scene, plan: &Plan) -> Vec<StartCamera> {
    let half = plan.half();
    let views = [
        ("door", Vec3::new(half.x - 0.62, 0.62 - half.y, 1.45), Vec3::new(-1.2, 0.16, 0.86)),
        ("window", Vec3::new(half.x - 1.0, half.y - 0.75, 1.5), Vec3::new(-1.2, -0.95, 0.82)),
        ("sofa", Vec3::new(1.0 - half.x, half.y - 0.7, 1.5), Vec3::new(1.5, -0.85, 0.86)),
        ("bookshelf", Vec3::new(-0.45, 0.95 - half.y, 1.4), Vec3::new(half.x, 0.55, 0.9)),
    ];
    let boxes = part_boxes(scene);
    let views = views.into_iter().filter_map(|(name, eye, target)| {
        let world = |p: Vec3| plan.direction(p.truncate()).extend(p.z);
        let eye = free_place(&boxes, plan, world(eye))?;
        let z = (eye - world(target)).as_dvec3().try_normalize()?;
        let x = enfilade_math::DVec3::Z.cross(z).try_normalize()?;
        let world_from_camera = DMat3::from_cols(x, z.cross(x), z);
        Some(StartCamera { name: name.into(), position: eye.as_dvec3(), world_from_camera, fov_x_rad: FOV_X_RAD, aspect: 4.0 / 3.0 })
    });
    views.collect()
}

/// World boxes of all parts.
pub fn part_boxes(scene: &Scene) -> Vec<Bounds3> {
    let world = WorldMesh::new(scene);
    let mut boxes = vec![Bounds3::EMPTY; scene.parts.len()];
    for (corners, source) in world.corners.iter().zip(&world.sources) {
        let part = &mut boxes[source.part as usize];
        *part = corners.iter().fold(*part, |b, &p| b.include(p));
    }
    boxes
}

fn free_place(boxes: &[Bounds3], plan: &Plan, wish: Vec3) -> Option<Vec3> {
    let inside = 0.5 * plan.room.size.truncate() - CLEARANCE;
    let mut places: Vec<Vec2> = (-12i32..=12).flat_map(|i| (-12i32..=12).map(move |j| 0.1 * Vec2::new(i as f32, j as f32))).collect();
    places.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    places
        .into_iter()
        .map(|d| wish + d.extend(0.0))
        .find(|p| p.truncate().abs().cmple(inside).all() && boxes.iter().all(|b| p.distance(p.clamp(b.min, b.max)) >= CLEARANCE))
}
