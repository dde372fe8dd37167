//! Free space by space carving (Kutulakos & Seitz 2000), as Hypersim does it.

mod cast;
mod config;
mod hypersim;
mod inside;
mod rays;
mod start;

#[cfg(test)]
mod tests;

use crate::armadillo::Armadillo;
use crate::grid::{Leaps, VoxelGrid};
use crate::{CarveReport, ExploreError, FreeSpace, Preset, StartReport};
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::{Cx, Warning, WorldMesh};
use inside::{Enclosure, Inside};
use rays::Rays;

pub use config::{CarveConfig, CarveKeys};
pub use start::is_indoors;

/// When a larger share of the rays than this leaves the domain, there is a warning.
const ESCAPE_WARNING: f64 = 0.01;

/// Finds the free space around `starts` (positions of start cameras).
///
/// A voxel is occupied when any triangle touches it, thin and large ones included, so nothing leaks through a closed wall. It is free when
/// it is on a ray from a carving position, before the first occupied voxel: since every surface is in occupied voxels, the rays need not be
/// tested against the triangles themselves. Everything else stays unknown. The domain is the cube of the configuration, cut down to the box
/// around the scene and the starts; space beyond the scene is never free.
///
/// Where rays leave the domain, free voxels are judged to be inside the building or outside: by the surfaces around them, and by whether
/// they can be reached from the start cameras without going outside. Those outside become unknown again, unless `keep_outside` is set.
///
/// A start that is inside a wall is skipped with a warning as long as another one serves. A start in the open, with almost nothing around
/// it (a sofa under a sky), is used with a warning: all that it sees of the whole cube is then free.
///
/// [`Preset`] lists the differences of Hypersim's preset.
///
/// # Errors
/// A configuration out of its domain, no usable start, or a domain beyond the octree's key space or the memory for it.
pub fn carve(world: &WorldMesh, bvh: &Bvh, starts: &[DVec3], config: &CarveConfig, cx: &dyn Cx) -> Result<FreeSpace, ExploreError> {
    // The grid with the voxels that surfaces touch.
    config.validate()?;
    let total = starts.len() as u64 * u64::from(config.iterations);
    cx.progress("carve", 0, total);
    let mut scene = Carving::new(world, bvh, starts, config)?;

    // Carve from every start camera: from its own position, then from random free ones.
    let mut report = CarveReport::default();
    let mut first_problem = None;
    for (index, &asked) in starts.iter().enumerate() {
        // The original carves once from starts at the same position.
        let earlier = starts[..index].iter().position(|other| *other == asked).filter(|_| config.preset == Preset::Hypersim);
        if let Some(earlier) = earlier {
            let same = report.starts[earlier].clone();
            report.starts.push(same);
            continue;
        }

        // The start's own position, or one nearby when it is in an occupied voxel; a start in a bad place is skipped.
        let mut position = match scene.verify(index, asked) {
            Ok(used) => {
                report.starts.push(StartReport { asked, used: Some(used), problem: None, is_open: scene.stands_open[index] });
                used
            }
            Err(problem) => {
                report.starts.push(StartReport { asked, used: None, problem: Some(problem.to_string()), is_open: false });
                first_problem.get_or_insert(problem);
                continue;
            }
        };

        // Cast all rays, and continue from somewhere in what they freed.
        for iteration in 0..config.iterations {
            scene.carve_from(position)?;
            report.positions.push(position);
            cx.progress("carve", index as u64 * u64::from(config.iterations) + u64::from(iteration) + 1, total);
            position = scene.next_position().ok_or_else(|| no_free_space(asked))?;
        }
    }
    if report.positions.is_empty() {
        return Err(first_problem.unwrap_or(ExploreError::NoStarts));
    }
    cx.progress("carve", total, total);

    // If rays left the domain, distinguish inside from outside.
    report.escaped_share = scene.escaped as f64 / (report.positions.len() as f64 * f64::from(config.rays));
    report.sought_leaks = scene.escaped == 0;
    if scene.escaped > 0 && config.preset == Preset::Default && !scene.stands_open.contains(&true) {
        scene.find_outside(config.keep_outside, &mut report, cx);
    }

    // Count, warn, and make the octree.
    let grid = &scene.grid;
    (report.free_voxels, report.occupied_voxels) = grid.counts();
    report.free_volume_m3 = report.free_voxels as f64 * config.voxel_m.powi(3);
    report.unknown_share = 1.0 - (report.free_voxels + report.occupied_voxels) as f64 / grid.domain_voxels() as f64;
    warn(&report, config, cx);
    let mut space = FreeSpace::new(grid.to_tree(config.voxel_m)?, report)?;
    if let (Preset::Hypersim, Some((min, max))) = (config.preset, hypersim::free_box(grid)) {
        (space.free_min, space.free_max) = (min, max);
    }
    Ok(space)
}

/// The state of carving: the grid as carved so far, and what is needed to carve on.
struct Carving<'a> {
    world: &'a WorldMesh,
    bvh: &'a Bvh,
    rays: Rays,
    grid: VoxelGrid,
    leaps: Leaps,
    enclosure: Enclosure<'a>,
    random: Random,
    /// Random positions are enclosed ones where rays have left the domain, if any is soon found.
    prefers_enclosed: bool,
    /// Whether each start has almost nothing around it.
    stands_open: Vec<bool>,
    /// Rays that left the domain so far.
    escaped: usize,
}

/// Source of the random positions.
enum Random {
    Default(Rng),
    Hypersim(Box<Armadillo>),
}

impl<'a> Carving<'a> {
    fn new(world: &'a WorldMesh, bvh: &'a Bvh, starts: &[DVec3], config: &CarveConfig) -> Result<Self, ExploreError> {
        let (min, max) = cube(starts, config)?;
        let stands_open: Vec<bool> = starts.iter().map(|start| config.preset != Preset::Hypersim && start::is_open(bvh, *start)).collect();
        let (grid, random) = match config.preset {
            Preset::Default | Preset::Paper => {
                let (min, max) = if stands_open.contains(&true) { (min, max) } else { cut_to_scene(min, max, world, starts, config) };
                let grid = VoxelGrid::new(min, max, config.voxel_m)?;
                grid.occupy(&world.corners);
                (grid, Random::Default(Rng::new(config.seed)))
            }
            Preset::Hypersim => (hypersim::grid(world, min, max, config)?, Random::Hypersim(Box::new(Armadillo::new(config.seed)))),
        };
        grid.check_memory()?;
        let enclosure = Enclosure::new(bvh, config.extent_m);
        let (rays, prefers_enclosed) = (Rays::new(config.rays as usize), config.preset == Preset::Default);
        Ok(Self { world, bvh, rays, grid, leaps: Leaps::default(), enclosure, random, prefers_enclosed, stands_open, escaped: 0 })
    }

    fn verify(&self, index: usize, asked: DVec3) -> Result<DVec3, ExploreError> {
        match self.random {
            Random::Default(_) => start::verify(self.world, self.bvh, &self.grid, index, asked),
            Random::Hypersim(_) => hypersim::verify(self.bvh, &self.grid, &self.rays.directions, index, asked),
        }
    }

    /// Casts all rays from one position.
    fn carve_from(&mut self, position: DVec3) -> Result<(), ExploreError> {
        let (grid, leaps, rays) = (&self.grid, &mut self.leaps, &self.rays);
        self.escaped += match self.random {
            Random::Default(_) => cast::cast(grid, leaps, rays, position, |_| f64::INFINITY),
            Random::Hypersim(_) => cast::cast(grid, leaps, rays, position, |d| hypersim::hit(self.bvh, grid, position, d)),
        };
        grid.check_memory()
    }

    /// A random free position.
    fn next_position(&mut self) -> Option<DVec3> {
        const TRIES: usize = 100;
        match &mut self.random {
            Random::Hypersim(rng) => hypersim::random_free(&self.grid, rng),
            Random::Default(rng) if self.escaped == 0 || !self.prefers_enclosed => self.grid.random_free(rng),
            Random::Default(rng) => {
                let first = self.grid.random_free(rng)?;
                let more = (0..TRIES).filter_map(|_| self.grid.random_free(rng));
                Some(std::iter::once(first).chain(more).find(|p| self.enclosure.encloses(*p)).unwrap_or(first))
            }
        }
    }

    /// Finds what is outside the building, and makes it unknown unless it is to be kept.
    fn find_outside(&self, keep_outside: bool, report: &mut CarveReport, cx: &dyn Cx) {
        let starts: Vec<DVec3> = report.starts.iter().filter_map(|start| start.used).collect();
        let Some(inside) = Inside::find(&self.grid, &self.enclosure, &starts) else {
            let message = "no start camera stands inside a building: too few directions around them meet a wall or a roof. All space that \
                they see is taken for inside";
            return cx.warn(Warning { place: "free space".into(), message: message.into() });
        };
        report.leaks = inside.leaks(&self.grid);
        report.outside_voxels = inside.for_outside(&self.grid, |cube, voxels| {
            if !keep_outside {
                self.grid.forget(cube, voxels);
            }
        });
        report.sought_leaks = true;
    }
}

/// The configured cube around the starts.
fn cube(starts: &[DVec3], config: &CarveConfig) -> Result<(DVec3, DVec3), ExploreError> {
    if starts.is_empty() {
        return Err(ExploreError::NoStarts);
    }
    if let Some(index) = starts.iter().position(|p| !p.is_finite()) {
        return Err(ExploreError::StartNotFinite { index, position: starts[index] });
    }
    let (low, high) = bounds(starts);
    let spread_m = (high - low).max_element();
    if spread_m > config.extent_m {
        return Err(ExploreError::ExtentTooSmall { spread_m, extent_m: config.extent_m });
    }
    let (center, half) = (0.5 * (low + high), DVec3::splat(0.5 * config.extent_m));
    Ok((center - half, center + half))
}

/// The part of a box around the scene and the starts, and two voxels more.
fn cut_to_scene(min: DVec3, max: DVec3, world: &WorldMesh, starts: &[DVec3], config: &CarveConfig) -> (DVec3, DVec3) {
    let (low, high) = bounds(starts);
    let margin = DVec3::splat(2.0 * config.voxel_m);
    let (scene_min, scene_max) = (low.min(world.bounds.min.as_dvec3()), high.max(world.bounds.max.as_dvec3()));
    (min.max(scene_min - margin), max.min(scene_max + margin))
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
}

fn no_free_space(start: DVec3) -> ExploreError {
    ExploreError::NoFreeSpace(format!("rays from the start camera at {start} end in its own voxel; move the camera or lower voxel_m"))
}

fn warn(report: &CarveReport, config: &CarveConfig, cx: &dyn Cx) {
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
    for (index, start) in report.starts.iter().enumerate().filter(|(_, start)| start.is_open) {
        let message = format!(
            "is in the open, at {:.2}: hardly any direction around it meets a surface. What it sees within {} m counts as free space",
            start.asked,
            0.5 * config.extent_m
        );
        cx.warn(Warning { place: format!("start camera {index}"), message });
    }
    if report.escaped_share > ESCAPE_WARNING && !report.starts.iter().any(|start| start.is_open) {
        let percent = 100.0 * report.escaped_share;
        let left = format!("{percent:.1} % of the rays left the scene: it is open or a wall has a gap");
        let places: Vec<String> = report.leaks.iter().map(|leak| format!("{:.1} ({:.1} m2)", leak.position, leak.area_m2)).collect();
        let message = match (report.outside_voxels, config.keep_outside) {
            (0, _) => format!("{left}, and free space reaches to its border"),
            (_, true) => format!("{left}. What is outside is kept; free space leads out at {}", places.join(", ")),
            (_, false) => format!("{left}. What is outside is left out; free space ends at {}", places.join(", ")),
        };
        cx.warn(Warning { place: "free space".into(), message });
    }
}
