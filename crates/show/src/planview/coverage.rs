//! Which surfaces a trajectory sees, and how often: points spread over the surfaces by area, so that tessellation does not count.

use super::planned::Planned;
use enfilade_geometry::Voxel;
use enfilade_math::{DVec3, Distribution1, Ray, Rng};
use enfilade_scene::{Camera, CameraView, Trajectory};

/// Points spread over all surfaces; a share of them is known to within half a per cent.
const POINTS: usize = 40_000;
/// Distance from a surface within which free space is searched, voxels: within the first, surfaces make their voxel occupied.
const REACH_VOXELS: [f64; 3] = [1.0, 1.5, 2.0];
/// A surface this much nearer than a point does not hide it, metres: the points are on surfaces in single precision.
const SLACK_M: f64 = 2e-3;

/// A point of a surface that borders free space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfacePoint {
    pub p_world: DVec3,
    /// Number of frames that see it.
    pub times: u32,
    /// Index of the first of them.
    pub first: Option<usize>,
}

/// Looks from every pose at points of all surfaces that border free space. The points are the same for every trajectory.
pub(super) fn coverage(planned: &Planned<'_>, camera: &Camera, trajectory: &Trajectory) -> Vec<SurfacePoint> {
    let poses = &trajectory.poses;
    let views: Vec<CameraView<'_>> = (0..poses.len()).map(|i| CameraView::of_frame(camera, poses, i)).collect();
    let seen = |&p_world: &DVec3| {
        let mut point = SurfacePoint { p_world, times: 0, first: None };
        for (i, _) in views.iter().enumerate().filter(|(_, view)| sees(planned, view, p_world)) {
            point.times += 1;
            point.first.get_or_insert(i);
        }
        point
    };
    enfilade_parallel::map(&points(planned), seen)
}

/// Points by area, in an order that does not matter, without those that free space does not touch.
fn points(planned: &Planned<'_>) -> Vec<DVec3> {
    let triangles = &planned.world.corners;
    let areas: Vec<f32> = triangles.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).length()).collect();
    let Some(by_area) = Distribution1::new(&areas) else { return Vec::new() };
    let mut rng = Rng::new(0);
    let point = |i: usize| {
        let (triangle, _, _) = by_area.sample((i as f32 + rng.next_f32()) / POINTS as f32);
        let [a, b, c] = triangles[triangle].map(|p| p.as_dvec3());
        let (root, along) = (rng.next_f64().sqrt(), rng.next_f64());
        let p = (1.0 - root) * a + root * (1.0 - along) * b + root * along * c;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        borders_free_space(planned, p, normal).then_some(p)
    };
    (0..POINTS).filter_map(point).collect()
}

/// True when there is free space near `p`, on either side, and nothing between.
fn borders_free_space(planned: &Planned<'_>, p: DVec3, normal: DVec3) -> bool {
    let step = planned.tree.resolution_m() * normal;
    let near = REACH_VOXELS.iter().flat_map(|reach| [p + *reach * step, p - *reach * step]);
    near.into_iter().any(|q| planned.tree.state(q) == Voxel::Free && in_sight(planned, q, p))
}

/// True when no surface hides `p` from `origin`.
fn in_sight(planned: &Planned<'_>, origin: DVec3, p: DVec3) -> bool {
    let distance_m = origin.distance(p);
    let mut ray = Ray::new(origin.as_vec3(), ((p - origin) / distance_m).as_vec3());
    ray.t_max = (distance_m - SLACK_M) as f32;
    !planned.bvh.occluded(&ray)
}

fn sees(planned: &Planned<'_>, view: &CameraView<'_>, p: DVec3) -> bool {
    let [width, height] = view.camera().size().map(f64::from);
    let Some((x, y)) = view.project(p) else { return false };
    if !(0.0..width).contains(&x) || !(0.0..height).contains(&y) {
        return false;
    }
    in_sight(planned, view.row_placement(y).0, p)
}

/// Share of `points` seen by the first 1, 2, … of `frames` frames.
pub(super) fn seen_so_far(points: &[SurfacePoint], frames: usize) -> Vec<f64> {
    let mut new = vec![0usize; frames];
    points.iter().filter_map(|point| point.first).for_each(|first| new[first] += 1);
    let mut sum = 0;
    let share = |count: usize| {
        sum += count;
        sum as f64 / points.len().max(1) as f64
    };
    new.into_iter().map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SIZE, with_planned};
    use super::*;

    #[test]
    fn a_camera_in_a_box_sees_the_share_of_its_surface_that_is_in_view() {
        with_planned(|planned| {
            let (camera, trajectory) = &planned.filmed[0];
            let points = coverage(planned, camera, trajectory);
            assert!(points.len() == POINTS, "all of the box borders free space: {}", points.len());
            // Nothing hides anything in a box: what projects into the image is seen.
            let view = CameraView::still(camera, &trajectory.poses[0]);
            let inside = |p: DVec3| view.project_in_row(p, 24.0).is_some_and(|(x, y)| (0.0..64.0).contains(&x) && (0.0..48.0).contains(&y));
            assert!(points.iter().all(|point| inside(point.p_world) == (point.first == Some(0))));
            let floor = points.iter().filter(|point| point.p_world.z < 1e-6).count() as f64 / POINTS as f64;
            let expected = SIZE.x * SIZE.y / (2.0 * (SIZE.x * SIZE.y + SIZE.y * SIZE.z + SIZE.z * SIZE.x));
            assert!((floor - expected).abs() < 0.002, "points are spread by area: {floor} of {expected}");
            let shares = seen_so_far(&points, trajectory.poses.len());
            assert!(shares.windows(2).all(|pair| pair[0] <= pair[1]) && shares[0] > 0.05 && shares[2] < 0.9, "{shares:?}");
        });
    }
}
