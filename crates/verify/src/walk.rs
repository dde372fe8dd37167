//! Laws of walks: equations 2 and 3 of Hypersim's supplement, free space, and what sees what.

use super::card::Card;
use super::law::Law;
use enfilade_dataset::MeshGeometry;
use enfilade_explore::{WalkBox, WalkBoxes};
use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_math::{DVec3, Ray, Vec3};
use enfilade_scene::{Pose, Trajectory};

/// Lines of sight are checked up to this share of their length: the end may be on a surface that has moved by rounding.
const SIGHT_SHARE: f64 = 1.0 - 1e-4;

/// The surfaces among which a walk was planned.
pub(super) struct Walls(Bvh);

impl Walls {
    /// Walls from a mesh whose unit is a metre; `None` where a face has a vertex that the mesh lacks.
    pub(super) fn new(mesh: &MeshGeometry) -> Option<Self> {
        let corner = |i: u32| mesh.vertices.get(i as usize).map(|p| p.as_vec3());
        let corners = |face: &[u32; 3]| Some([corner(face[0])?, corner(face[1])?, corner(face[2])?]);
        let corners: Option<Vec<[Vec3; 3]>> = mesh.faces.iter().map(corners).collect();
        Some(Self(Bvh::new(&corners?, &|_| false)))
    }

    fn sees(&self, from: DVec3, to: DVec3) -> bool {
        let Some(direction) = (to - from).try_normalize() else { return true };
        let mut ray = Ray::new(from.as_vec3(), direction.as_vec3());
        ray.t_max = (from.distance(to) * SIGHT_SHARE) as f32;
        !self.0.occluded(&ray)
    }
}

/// Checks the laws of a walk. Without `walls` or `tree`, visibility or free space cannot be checked.
pub(super) fn check(trajectory: &Trajectory, boxes: &WalkBoxes, walls: Option<&Walls>, tree: Option<&OccupancyTree>, place: &str) -> Card {
    let mut card = Card::default();
    let finite = |pose: &&Pose| pose.position.is_finite() && pose.look_at.is_finite();
    let poses: Vec<&Pose> = trajectory.poses.iter().filter(finite).collect();
    for pair in poses.windows(2) {
        let (first, last, pose) = (poses[0], pair[0], pair[1]);
        let at = || format!("{place}/frame.{:04}", pose.frame);
        let position = beyond(&boxes.position, first.position, last.position, pose.position);
        let target = beyond(&boxes.target, first.look_at, last.look_at, pose.look_at);
        card.observe(Law::WalkBox, position.max(target), at);
        if let Some(walls) = walls {
            let is_seen = walls.sees(last.position, pose.position) && walls.sees(last.look_at, pose.look_at);
            card.observe(Law::WalkSight, if is_seen { 0.0 } else { 1.0 }, at);
        }
        if let Some(tree) = tree {
            let state = tree.state(pose.look_at);
            let at = || format!("{}: its target {:.3} m is {state:?}", at(), pose.look_at);
            card.observe(Law::FreeTarget, if state == Voxel::Free { 0.0 } else { 1.0 }, at);
        }
    }
    card
}

/// Distance of a point beyond its box, metres.
fn beyond(bounds: &WalkBox, first: DVec3, last: DVec3, point: DVec3) -> f64 {
    let step = (point - last).abs() - DVec3::from(bounds.step_m);
    let height = bounds.height_range_m.map_or(0.0, |range| (point.z - first.z).abs() - range);
    step.max_element().max(height).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Trajectory;

    const PAPER: WalkBox = WalkBox { step_m: [1.5, 1.5, 0.25], height_range_m: Some(0.25) };

    /// A walk along x, before a wall at x = 2 with y below 0 that nothing in it passes.
    fn walk() -> (Trajectory, Walls) {
        let pose = |frame: u32| {
            let position = DVec3::new(f64::from(frame), 1.0, 1.5);
            Pose::look_at(frame, position, position + 2.0 * DVec3::Y, DVec3::Z).unwrap()
        };
        let corner = |y: f64, z: f64| DVec3::new(2.5, y, z);
        let mesh = MeshGeometry {
            vertices: vec![corner(0.0, -9.0), corner(-9.0, 0.0), corner(0.0, 9.0)],
            faces: vec![[0, 1, 2]],
            object_of_face: vec![0],
            material_of_face: vec![None],
            objects: vec!["wall".into()],
            materials: Vec::new(),
        };
        (Trajectory { name: "cam_00".into(), poses: (0..5).map(pose).collect() }, Walls::new(&mesh).unwrap())
    }

    fn failures(change: impl Fn(&mut Trajectory)) -> Vec<Law> {
        let (mut trajectory, walls) = walk();
        let mut tree = OccupancyTree::new(0.1);
        for pose in &trajectory.poses {
            tree.set(tree.key(pose.look_at).unwrap(), Voxel::Free);
        }
        change(&mut trajectory);
        check(&trajectory, &WalkBoxes { position: PAPER, target: PAPER }, Some(&walls), Some(&tree), "room/cam_00").failures()
    }

    #[test]
    fn a_walk_by_the_rules_passes() {
        assert_eq!(failures(|_| ()), []);
    }

    #[test]
    fn each_broken_rule_fails_its_law() {
        // Beyond the box around the last position, around the first position, and the same for targets.
        assert_eq!(failures(|t| t.poses[4].position.x += 0.6), [Law::WalkBox]);
        assert_eq!(failures(|t| t.poses[3..].iter_mut().zip([0.2, 0.4]).for_each(|(pose, z)| pose.position.z += z)), [Law::WalkBox]);
        assert_eq!(failures(|t| t.poses[4].look_at.y += 1.6), [Law::WalkBox, Law::FreeTarget]);
        // A target in no free voxel.
        assert_eq!(failures(|t| t.poses[2].look_at.z += 0.11), [Law::FreeTarget]);
        // Positions and targets that the wall hides from the last ones.
        let behind = |t: &mut Trajectory| t.poses.iter_mut().for_each(|pose| pose.position.y -= 2.0);
        assert_eq!(failures(behind), [Law::WalkSight]);
        let hidden = |t: &mut Trajectory| t.poses.iter_mut().for_each(|pose| pose.look_at.y -= 4.0);
        assert_eq!(failures(hidden), [Law::WalkSight, Law::FreeTarget]);
    }

    #[test]
    fn heights_above_a_floor_have_no_range_around_the_first() {
        let bounds = WalkBox { height_range_m: None, ..PAPER };
        assert_eq!(beyond(&bounds, DVec3::ZERO, DVec3::Z, 1.2 * DVec3::Z), 0.0);
        assert!((beyond(&PAPER, DVec3::ZERO, DVec3::Z, 1.2 * DVec3::Z) - 0.95).abs() < 1e-12);
    }
}
