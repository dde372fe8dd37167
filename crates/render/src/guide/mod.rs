//! The guide, learned before a trajectory's frames are rendered: which lights reach where, and where indirect light comes from.
//!
//! It only steers samples. Every direction and every light keeps a positive probability, so a poor guide means more noise, never another
//! mean.

mod aim;
mod bright;
mod cells;
mod field;
mod mirrored;
mod patch;
mod rays;
mod spots;
mod square;

pub(crate) use field::{CellLight, Field};

use crate::config::RenderConfig;
use crate::light::LightChoice;
use crate::prepared::RenderScene;
use crate::walk::{pixel_samples, walk};
use cells::Site;
use enfilade_math::{Rng, hash_u64};
use enfilade_scene::CameraView;
use field::Effort;

/// The most random walks, and the most photons; frames with few samples learn from fewer.
const PATHS: u64 = 1 << 16;
/// One cell for this many samples. A cell costs about as much as a hundred.
const SAMPLES_PER_CELL: u64 = 1024;
/// Largest number of cells: more give no further information about a room.
const MAX_CELLS: u64 = 1 << 14;
/// One ray through each bin of a cell for this many samples per cell. Such a round of rays costs about as much as fifty.
const SAMPLES_PER_ROUND: u64 = 4096;
/// Largest number of rounds: more rays give no further information about a cell.
const MAX_ROUNDS: u64 = 16;
/// Surfaces that a walk visits.
const VERTICES: usize = 4;

/// The learned light of a scene, for all frames of a trajectory: which lights reach where, and where indirect light comes from.
#[derive(Debug)]
pub struct Guide {
    pub(crate) choice: LightChoice,
    pub(crate) field: Option<Field>,
}

impl Guide {
    /// Learns from `views` of a whole trajectory or of some of its frames. The effort grows with the total number of samples of these
    /// views; without views nothing is learned, which is a valid guide. The result depends only on the arguments, not on the number of
    /// threads.
    pub fn learn(scene: &RenderScene<'_>, views: &[CameraView<'_>], config: &RenderConfig) -> Self {
        // Learn which light sources reach which places.
        let choice = LightChoice::learn(scene, views, config);

        // Walk from the cameras to the places that scatter light diffusely: there the field is to be known.
        let samples = pixel_samples(views, config);
        let paths = if views.is_empty() { 0 } else { (samples / 64).clamp(256, PATHS) };
        let seed = hash_u64(config.seed ^ 0x6_1d3);
        let sites: Vec<Site> = enfilade_parallel::flat_map_up_to(paths as usize, |path| {
            let view = &views[path % views.len()];
            let mut sites = Vec::new();
            walk(scene, view, VERTICES, Rng::new(hash_u64(seed ^ hash_u64(path as u64))), |surface, bsdf, _| {
                if !bsdf.reflectance.is_black() {
                    sites.push(Site { p: surface.p, n: surface.ns_smooth });
                }
            });
            sites
        });

        // Solve for the light there, with an effort in proportion to the samples that will profit.
        let cells = (samples / SAMPLES_PER_CELL).clamp(64, MAX_CELLS);
        let rounds = (samples / cells / SAMPLES_PER_ROUND).clamp(1, MAX_ROUNDS);
        let effort = Effort { cells: cells as usize, photons: paths as usize, rounds: rounds as usize };
        let field = if config.guiding { Field::solve(scene, &choice, &sites, effort, seed) } else { None };
        Self { choice, field }
    }
}
