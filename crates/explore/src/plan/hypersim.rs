//! Hypersim's random walk as its published program does it, draw by draw: `generate_camera_trajectory_random_walk`.
//!
//! Of the rules of this crate it keeps only what the program keeps: positions and targets are free, and seen from the last ones. The
//! numbers of the configuration that it does not use are those of rules that it does not have.

use super::PlanConfig;
use crate::armadillo::Armadillo;
use crate::view::TestImage;
use crate::{ExploreError, FreeSpace, ViewStats};
use enfilade_geometry::{Bvh, Voxel};
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{Intrinsics, Pose, StartCamera, WorldMesh};
use rayon::prelude::*;

/// Deviation of each component of the up vector, before which it is (0, 0, 1).
const UP_NOISE: f64 = 0.1;

/// A point is seen when a surface along the ray to it is farther away by this share.
const SIGHT_MARGIN: f64 = 0.01;

/// The first target is this many voxels nearer than the surface behind it, ...
const TARGET_MARGIN_VOXELS: f64 = 1.75;

/// ... but at least this far from the camera, metres.
const MIN_TARGET_M: f64 = 1e-4;

/// When the start camera has no target on its axis, its image is searched from this many positions, ...
const TRIES: u32 = 8;

/// ... each this many voxels behind the one before.
const TRY_STEP_VOXELS: f64 = 0.25;

/// The poses of a walk from `start`, and what each shows. The first is the start camera's own.
///
/// # Errors
/// When the program would give up or stop with an assertion: nothing to look at from the start, or no candidate for a step.
pub(super) fn walk(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    name: &str,
    config: &PlanConfig,
    progress: &dyn Fn(u32),
) -> Result<Vec<(Pose, ViewStats)>, ExploreError> {
    let walker = Walker {
        world,
        bvh,
        space,
        config,
        image: TestImage::new(&Intrinsics::from_fov_x(config.test_width, config.test_height, config.fov_x_rad)),
    };

    // The first pose is the start camera's; all noise of the up vectors is drawn before the walk, as in the program.
    let first = walker.first(start)?;
    let mut rng = Armadillo::new(config.seed);
    let noise = Armadillo::rows(config.frames as usize, || rng.normal());
    let mut poses = walker.views(&[first]);
    for frame in 1..config.frames {
        progress(frame);
        let last = poses[poses.len() - 1].0;

        // Free and visible points around the last pose, for the camera and for its target.
        let up = DVec3::Z + UP_NOISE * noise[frame as usize];
        let positions = walker.near(last.position, first.position, &mut rng);
        let targets = walker.near(last.look_at, first.look_at, &mut rng);
        let stuck = || ExploreError::Stuck {
            trajectory: name.to_string(),
            frame,
            position: last.position,
            queries: config.queries,
            look_from: positions.len(),
            look_at: targets.len(),
        };
        if positions.is_empty() || targets.is_empty() {
            return Err(stuck());
        }

        // Random pairs of them, and a choice by score.
        let mut draw = |n: usize| -> Vec<usize> { (0..config.candidates).map(|_| rng.below(n)).collect() };
        let (from, at) = (draw(positions.len()), draw(targets.len()));
        let candidates: Vec<Pose> =
            from.into_iter().zip(at).filter_map(|(from, at)| Pose::look_at(frame, positions[from], targets[at], up)).collect();
        let views = walker.views(&candidates);
        poses.push(choose(views, rng.uniform()).ok_or_else(stuck)?);
    }
    Ok(poses)
}

/// The score of a view: its distinct triangles, "none" counting as one of them, times the square of its share of surface.
fn score(view: &ViewStats) -> f64 {
    let kinds = view.triangles + u32::from(view.hits < view.pixels);
    let valid = f64::from(view.hits as f32 / view.pixels as f32);
    valid * valid * f64::from(kinds)
}

/// The first candidate at which the running share of the scores reaches `u`; `None` when all scores are 0.
fn choose(candidates: Vec<(Pose, ViewStats)>, u: f64) -> Option<(Pose, ViewStats)> {
    let total: f64 = candidates.iter().map(|(_, view)| score(view)).sum();
    if total <= 0.0 {
        return None;
    }
    let mut share = 0.0;
    let last = candidates.last().copied();
    let chosen = candidates.into_iter().find(|(_, view)| {
        share += score(view) / total;
        share >= u
    });
    chosen.or(last)
}

struct Walker<'a> {
    world: &'a WorldMesh,
    bvh: &'a Bvh,
    space: &'a FreeSpace,
    config: &'a PlanConfig,
    image: TestImage,
}

impl Walker<'_> {
    fn is_free(&self, p: DVec3) -> bool {
        self.space.tree.state(p) == Voxel::Free
    }

    /// Distance to the first surface, metres; infinite when there is none.
    fn distance_m(&self, from: DVec3, direction: DVec3) -> f64 {
        self.bvh.closest(&Ray::new(from.as_vec3(), direction.as_vec3())).map_or(f64::INFINITY, |hit| f64::from(hit.t))
    }

    fn views(&self, poses: &[Pose]) -> Vec<(Pose, ViewStats)> {
        let look = |sight: &mut crate::view::Sight, pose: &Pose| {
            sight.look(self.bvh, &self.image, pose);
            (*pose, sight.judge(self.world, &self.config.saliency))
        };
        poses.par_iter().map_init(|| self.image.sight(self.world), look).collect()
    }

    /// Free points around `last`, near the height of `first`, that are seen from `last`.
    fn near(&self, last: DVec3, first: DVec3, rng: &mut Armadillo) -> Vec<DVec3> {
        let half = DVec3::from(self.config.step_m);
        let offsets = Armadillo::rows(self.config.queries as usize, || rng.uniform());
        let points = offsets.into_iter().map(|u| last + (u * (2.0 * half) - half));
        let in_range = |p: &DVec3| (p.z - first.z).abs() <= self.config.height_range_m;
        let seen = |p: &DVec3| {
            let Some(direction) = (*p - last).try_normalize() else { return true };
            let distance = (*p - last).length();
            let mut ray = Ray::new(last.as_vec3(), direction.as_vec3());
            ray.t_max = (distance / (1.0 - SIGHT_MARGIN)) as f32;
            !self.bvh.occluded(&ray)
        };
        points.filter(|p| in_range(p) && self.is_free(*p) && seen(p)).collect()
    }

    /// The start camera's pose, looking at the free point before the surface on its axis; where that is not free, at the free point
    /// nearest to the image centre.
    fn first(&self, start: &StartCamera) -> Result<Pose, ExploreError> {
        let voxel_m = self.space.tree.resolution_m();
        let pose = |look_at| Pose { frame: 0, position: start.position, look_at, world_from_camera: start.world_from_camera };
        let axis = -start.world_from_camera.z_axis;
        let distance = (self.distance_m(start.position, axis) - TARGET_MARGIN_VOXELS * voxel_m).max(MIN_TARGET_M);
        let target = start.position + distance * axis;
        if target.is_finite() && self.is_free(target) {
            return Ok(pose(target));
        }
        let directions: Vec<DVec3> = self.image.center_first().into_iter().map(|d| start.world_from_camera * d).collect();
        for k in 0..TRIES {
            let origin = start.position + f64::from(k) * TRY_STEP_VOXELS * voxel_m * start.world_from_camera.z_axis;
            // As in the program: the distance is measured from the moved origin, but the target is that far from the camera itself.
            let reach = |d: &DVec3| {
                let hit = self.distance_m(origin, *d);
                let clipped = (hit.min(self.leaves_m(origin, *d)) - TARGET_MARGIN_VOXELS * voxel_m).max(MIN_TARGET_M);
                (hit.is_finite() && self.is_free(origin + clipped * *d)).then_some(start.position + clipped * *d)
            };
            if let Some(target) = directions.iter().find_map(reach) {
                return Ok(pose(target));
            }
        }
        let distance_m = TARGET_MARGIN_VOXELS * voxel_m;
        Err(ExploreError::NothingToLookAt { name: start.name.clone(), position: start.position, distance_m })
    }

    /// Distance at which a ray leaves the box of free space, metres.
    fn leaves_m(&self, origin: DVec3, direction: DVec3) -> f64 {
        let border = DVec3::select(direction.cmpgt(DVec3::ZERO), self.space.free_max, self.space.free_min);
        let t = (border - origin) / direction;
        (0..3).filter(|a| direction[*a].abs() > 1e-6).map(|a| t[a]).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DMat3;

    #[test]
    fn the_choice_follows_the_running_share_of_the_scores() {
        let pose = |frame| Pose { frame, position: DVec3::ZERO, look_at: DVec3::X, world_from_camera: DMat3::IDENTITY };
        let view = |triangles| ViewStats { pixels: 10, hits: 10, triangles, ..ViewStats::default() };
        let candidates = || vec![(pose(0), view(1)), (pose(1), view(0)), (pose(2), view(3))];
        let chosen = |u: f64| choose(candidates(), u).unwrap().0.frame;
        assert_eq!([0.0, 0.25, 0.26, 0.99].map(chosen), [0, 0, 2, 2]);
        assert!(choose(vec![(pose(0), view(0))], 0.5).is_none());
    }

    #[test]
    fn emptiness_counts_as_one_triangle_and_squared() {
        let view = ViewStats { pixels: 100, hits: 50, triangles: 11, ..ViewStats::default() };
        assert_eq!(score(&view), 3.0);
        assert_eq!(score(&ViewStats { hits: 100, ..view }), 11.0);
    }
}
