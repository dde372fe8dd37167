use crate::error::require;
use crate::grid::{VoxelGrid, WalkEnd};
use crate::{CarveReport, ExploreError, FreeSpace, StartReport, start};
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Rng, warp};
use enfilade_scene::{Cx, Warning, WorldMesh};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// More escaping rays than this are worth a warning.
const ESCAPE_WARNING: f64 = 0.01;

/// How free space is carved. The defaults are Hypersim's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CarveConfig {
    /// Edge of a voxel, metres.
    pub voxel_m: f64,
    /// Side of the cube to be carved, metres. It is centred on the box around the start cameras.
    pub extent_m: f64,
    /// Rays cast from each position, spread evenly over the sphere.
    pub rays: u32,
    /// Positions to carve from for each start camera: its own, then random free ones.
    pub iterations: u32,
    /// Seed of the random positions.
    pub seed: u64,
}

impl Default for CarveConfig {
    fn default() -> Self {
        Self { voxel_m: 0.1, extent_m: 30.0, rays: 512 * 512, iterations: 5, seed: 0 }
    }
}

impl CarveConfig {
    fn validate(&self) -> Result<(), ExploreError> {
        let positive = |v: f64| v > 0.0 && v.is_finite();
        require(positive(self.voxel_m), "voxel_m", self.voxel_m, "a positive length in metres")?;
        require(positive(self.extent_m) && self.extent_m >= self.voxel_m, "extent_m", self.extent_m, "a length of at least one voxel")?;
        require(self.rays >= 64, "rays", self.rays, "64 or more")?;
        require(self.iterations >= 1, "iterations", self.iterations, "1 or more")
    }
}

/// Finds the free space around `starts` (positions of start cameras).
///
/// A voxel is occupied when any triangle touches it, thin and large ones included, so nothing leaks through a wall that is closed.
/// It is free when it lies on a ray from a carving position, before the first occupied voxel: since every surface lies in occupied
/// voxels, the rays need not be tested against the triangles themselves. Everything else stays unknown. The domain is the cube of
/// the configuration, cut down to the box around the scene and the starts; space beyond the scene is never free.
///
/// A start that is outside or inside a wall is skipped with a warning as long as another one serves.
///
/// # Errors
/// A configuration out of its domain, no usable start, or a domain beyond the octree's key space or the memory for it.
pub fn carve(world: &WorldMesh, bvh: &Bvh, starts: &[DVec3], config: &CarveConfig, cx: &dyn Cx) -> Result<FreeSpace, ExploreError> {
    config.validate()?;
    let (min, max) = domain(world, starts, config)?;
    let grid = VoxelGrid::new(min, max, config.voxel_m)?;
    let total = starts.len() as u64 * u64::from(config.iterations);
    cx.progress("carve", 0, total);
    grid.occupy(&world.corners);

    let directions: Vec<DVec3> = (0..config.rays as usize).map(|k| warp::fibonacci_sphere(k, config.rays as usize)).collect();
    let mut rng = Rng::new(config.seed);
    let mut report = CarveReport::default();
    let mut first_problem = None;
    let mut escaped = 0;
    for (index, &asked) in starts.iter().enumerate() {
        let mut position = match start::verify(world, bvh, &grid, config.voxel_m, index, asked) {
            Ok(used) => {
                report.starts.push(StartReport { asked, used: Some(used), problem: None });
                used
            }
            Err(problem) => {
                report.starts.push(StartReport { asked, used: None, problem: Some(problem.to_string()) });
                first_problem.get_or_insert(problem);
                continue;
            }
        };
        for iteration in 0..config.iterations {
            escaped += carve_from(&grid, position, &directions);
            report.positions.push(position);
            cx.progress("carve", index as u64 * u64::from(config.iterations) + u64::from(iteration) + 1, total);
            position = match grid.random_free(grid.counts().0, &mut rng) {
                Some(next) => next,
                None => return Err(no_free_space(asked)),
            };
        }
    }
    if report.positions.is_empty() {
        return Err(first_problem.unwrap_or(ExploreError::NoStarts));
    }
    cx.progress("carve", total, total);

    (report.free_voxels, report.occupied_voxels) = grid.counts();
    report.free_volume_m3 = report.free_voxels as f64 * config.voxel_m.powi(3);
    report.escaped_share = escaped as f64 / (report.positions.len() * directions.len()) as f64;
    warn(&report, cx);
    FreeSpace::new(grid.to_tree(), report)
}

/// Casts all rays from one position and returns how many left the domain.
fn carve_from(grid: &VoxelGrid, position: DVec3, directions: &[DVec3]) -> usize {
    directions.par_iter().with_min_len(1024).filter(|d| grid.walk(position, **d) == WalkEnd::Left).count()
}

/// The box to be carved: the configured cube around the starts, cut down to the scene and the starts, and two voxels more.
fn domain(world: &WorldMesh, starts: &[DVec3], config: &CarveConfig) -> Result<(DVec3, DVec3), ExploreError> {
    if starts.is_empty() {
        return Err(ExploreError::NoStarts);
    }
    if let Some(index) = starts.iter().position(|p| !p.is_finite()) {
        return Err(ExploreError::StartNotFinite { index, position: starts[index] });
    }
    let low = starts.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
    let high = starts.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
    let spread_m = (high - low).max_element();
    if spread_m > config.extent_m {
        return Err(ExploreError::ExtentTooSmall { spread_m, extent_m: config.extent_m });
    }
    let (center, half) = (0.5 * (low + high), DVec3::splat(0.5 * config.extent_m));
    let margin = DVec3::splat(2.0 * config.voxel_m);
    let (scene_min, scene_max) = (low.min(world.bounds.min.as_dvec3()), high.max(world.bounds.max.as_dvec3()));
    Ok(((center - half).max(scene_min - margin), (center + half).min(scene_max + margin)))
}

fn no_free_space(start: DVec3) -> ExploreError {
    ExploreError::NoFreeSpace(format!("rays from the start camera at {start} end in its own voxel; move the camera or lower voxel_m"))
}

fn warn(report: &CarveReport, cx: &dyn Cx) {
    for (index, start) in report.starts.iter().enumerate() {
        if let Some(problem) = &start.problem {
            cx.warn(Warning { place: format!("start camera {index}"), message: format!("skipped: {problem}") });
        }
        if let Some(used) = start.used.filter(|used| *used != start.asked) {
            let moved = used.distance(start.asked);
            let message = format!("lies in an occupied voxel; carving starts {moved:.2} m away, at {used:.2}");
            cx.warn(Warning { place: format!("start camera {index}"), message });
        }
    }
    if report.escaped_share > ESCAPE_WARNING {
        let percent = 100.0 * report.escaped_share;
        let message =
            format!("{percent:.1} % of the rays left the scene: it is open or a wall has a gap, and free space reaches to its border");
        cx.warn(Warning { place: "free space".into(), message });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::{Room, house_with_thin_wall};
    use enfilade_geometry::Voxel;
    use enfilade_scene::Quiet;

    fn quick() -> CarveConfig {
        CarveConfig { rays: 40_000, ..CarveConfig::default() }
    }

    #[test]
    fn free_volume_of_a_box_room_is_its_interior_less_a_shell() {
        // Walls 3 cm off the voxel borders: each occupies one layer of voxels, and the 39x29x24 within are free.
        let room = Room::new(DVec3::new(-0.03, -0.03, -0.03), DVec3::new(3.93, 2.93, 2.43));
        let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
        assert_eq!(space.report.free_voxels, 39 * 29 * 24);
        assert!((space.report.free_volume_m3 - 3.9 * 2.9 * 2.4).abs() < 1e-9);
        assert_eq!(space.report.occupied_voxels, 41 * 31 * 26 - 39 * 29 * 24);
        assert_eq!((space.free_min, space.free_max), (DVec3::ZERO, DVec3::new(39.0, 29.0, 24.0) * 0.1));
        assert_eq!(
            (space.tree.count(Voxel::Free), space.tree.count(Voxel::Occupied)),
            (space.report.free_voxels, space.report.occupied_voxels)
        );
        assert_eq!((space.report.escaped_share, space.report.positions.len()), (0.0, 5));
    }

    #[test]
    fn walls_on_voxel_borders_are_two_voxels_thick_whatever_the_rounding() {
        for nudge in [-1e-6, 0.0, 1e-6] {
            let room = Room::new(DVec3::splat(nudge), DVec3::new(4.0, 3.0, 2.5) + DVec3::splat(nudge));
            let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
            assert_eq!(space.report.free_voxels, 38 * 28 * 23);
        }
    }

    #[test]
    fn a_wall_thinner_than_a_voxel_does_not_leak() {
        // Two rooms share one plane that slants through the voxels; only one has a camera.
        let room = house_with_thin_wall();
        let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
        assert_eq!(space.report.escaped_share, 0.0);
        let beyond = |p: DVec3| room.beyond_wall(p);
        let leaked = space.tree.leaves().filter(|l| l.state == Voxel::Free && beyond(space.tree.center(l.key))).count();
        assert_eq!(leaked, 0);
        assert!(space.report.free_voxels > 8000);
    }

    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        let room = house_with_thin_wall();
        let starts = [DVec3::new(1.0, 1.5, 1.4), DVec3::new(3.6, 1.2, 1.0)];
        let carve_on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let space = pool.install(|| carve(&room.world, &room.bvh, &starts, &quick(), &Quiet)).unwrap();
            (space.tree.to_bt(), space.report)
        };
        let one = carve_on(1);
        assert_eq!(one, carve_on(2));
        assert_eq!(one, carve_on(7));
    }

    #[test]
    fn an_open_side_is_reported_as_escaping_rays() {
        let mut room = Room::new(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43));
        room.remove_ceiling();
        let space = carve(&room.world, &room.bvh, &[DVec3::new(1.0, 1.5, 1.4)], &quick(), &Quiet).unwrap();
        assert!(space.report.escaped_share > 0.05 && space.report.escaped_share < 0.4, "{}", space.report.escaped_share);
        assert!(space.free_max.z < 2.8, "space beyond the scene is never free: {}", space.free_max);
    }

    #[test]
    fn a_camera_near_a_surface_is_moved_out_of_its_voxel() {
        let room = Room::new(DVec3::splat(-0.03), DVec3::new(3.93, 2.93, 2.43));
        let asked = DVec3::new(-0.01, 1.5, 1.4);
        let space = carve(&room.world, &room.bvh, &[asked], &quick(), &Quiet).unwrap();
        let used = space.report.starts[0].used.unwrap();
        assert!(used != asked && used.distance(asked) < 0.2 && used.x > 0.0, "{used}");
        assert_eq!(space.report.free_voxels, 39 * 29 * 24);
    }

    #[test]
    fn bad_starts_are_named() {
        let walls = Room::with_walls(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), 0.4);
        let run = |starts: &[DVec3]| carve(&walls.world, &walls.bvh, starts, &quick(), &Quiet);
        let inside = DVec3::new(2.0, 1.5, 1.4);
        assert!(run(&[inside]).is_ok());
        assert_eq!(run(&[]).unwrap_err(), ExploreError::NoStarts);
        assert!(matches!(run(&[DVec3::new(-0.21, 1.5, 1.4)]).unwrap_err(), ExploreError::StartInWall { index: 0, .. }));
        assert!(matches!(run(&[DVec3::new(-0.35, 1.5, 1.4)]).unwrap_err(), ExploreError::StartInWall { index: 0, .. }));
        assert!(matches!(run(&[DVec3::new(20.0, 1.5, 1.4)]).unwrap_err(), ExploreError::StartOutside { index: 0, .. }));
        assert!(matches!(run(&[inside, DVec3::new(99.0, 1.5, 1.4)]).unwrap_err(), ExploreError::ExtentTooSmall { .. }));
        assert!(matches!(run(&[DVec3::NAN]).unwrap_err(), ExploreError::StartNotFinite { index: 0, .. }));
        let skipped = run(&[DVec3::new(-0.21, 1.5, 1.4), inside]).unwrap().report.starts;
        assert!(skipped[0].used.is_none() && skipped[0].problem.as_ref().unwrap().contains("inside a wall"));
        assert_eq!(skipped[1].used, Some(inside));
    }

    #[test]
    fn bad_configurations_are_named() {
        let room = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let run = |config| carve(&room.world, &room.bvh, &[DVec3::new(2.0, 1.5, 1.4)], &config, &Quiet).unwrap_err().to_string();
        assert!(run(CarveConfig { voxel_m: 0.0, ..quick() }).starts_with("voxel_m = 0: expected"));
        assert!(run(CarveConfig { iterations: 0, ..quick() }).starts_with("iterations = 0: expected"));
        assert!(run(CarveConfig { voxel_m: 1e-5, ..quick() }).contains("raise voxel_m"));
    }
}
