//! The share of each frame's surfaces that each other frame of a scene sees.
//!
//! A grid of each frame's pixels is carried into every other frame by stored distance, camera and pose. A point that falls outside of the
//! image is not seen. A point is seen if none of the four pixels around it shows anything nearer. For all other points a ray through the
//! scene decides whether they are hidden; without the scene, a point counts as hidden if all four pixels show something clearly nearer. So
//! the shares agree with `flow_visibility`, except for details finer than the pixels of the other frame.

use crate::filmed::SurfacePoint;
use crate::surroundings::{Around, Surroundings};
use crate::{Filmed, MultiviewError, ScenePackage};
use enfilade_dataset::{Covisibility, CovisibleFrame, HiddenBy};
use enfilade_math::DVec3;
use enfilade_render::Lookout;
use enfilade_scene::{Counted, Cx, Warning};

/// How covisibility is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CovisibilityConfig {
    /// Approximate number of pixels of each frame that are projected into the others, evenly over the image; at least 1. A share of one half is known to
    /// 0.009 (one standard error) with 3000.
    pub grid_pixels: u32,
}

impl Default for CovisibilityConfig {
    fn default() -> Self {
        Self { grid_pixels: 3000 }
    }
}

impl CovisibilityConfig {
    /// Pixels of an image of `size` per pixel of its grid, in both directions.
    fn step_px(self, [width, height]: [u32; 2]) -> u32 {
        let per_cell = f64::from(width) * f64::from(height) / f64::from(self.grid_pixels.max(1));
        (per_cell.sqrt().round() as u32).max(1)
    }
}

/// The grid of a frame's pixels in the world.
struct Grid {
    step_px: u32,
    /// Points of the pixels that show a surface, metres.
    points: Vec<SurfacePoint>,
}

/// Measures the share of each frame's surfaces that each other frame sees. Without a package, only the frames' distances decide what is
/// hidden.
///
/// Distances are read twice, and at most one frame per thread is in memory at a time; only the grid of each frame is kept.
///
/// # Errors
/// When a frame or the scene cannot be used.
pub fn covisibility(
    filmed: &Filmed<'_>,
    package: Option<&ScenePackage>,
    config: CovisibilityConfig,
    cx: &dyn Cx,
) -> Result<Covisibility, MultiviewError> {
    if package.is_none() && filmed.deforms() {
        let message = "parts of it deform, and without its package their points cannot be followed; they were left out";
        cx.warn(Warning { place: filmed.scene.clone(), message: message.into() });
    }
    let n = filmed.len();
    let counted = Counted::new(cx, "grids", n);
    let grid = |frame: usize| counted.unit(|| read_grid(filmed, package, frame, config));
    let grids: Vec<Grid> = enfilade_parallel::try_map_up_to(n, grid)?;
    // Of a scene that moves each frame has its own.
    let lookout = package.filter(|package| package.scene.is_still()).map(ScenePackage::lookout).transpose()?;

    let counted = Counted::new(cx, "frames", n);
    let column = |by: usize| counted.unit(|| column(filmed, &grids, (package, lookout.as_ref()), by));
    let columns: Vec<Vec<f32>> = enfilade_parallel::try_map_up_to(n, column)?;
    let listed = |(frame, grid): (usize, &Grid)| {
        let (camera, number) = filmed.name(frame);
        let surface_pixels = grid.points.len() as u32;
        CovisibleFrame { camera: camera.into(), frame: number, grid_step_px: grid.step_px, surface_pixels }
    };
    Ok(Covisibility {
        frames: grids.iter().enumerate().map(listed).collect(),
        hidden_by: if package.is_some() { HiddenBy::Scene } else { HiddenBy::Distances },
        shares: (0..n).flat_map(|of| columns.iter().map(move |column| column[of])).collect(),
    })
}

fn read_grid(
    filmed: &Filmed<'_>,
    package: Option<&ScenePackage>,
    frame: usize,
    config: CovisibilityConfig,
) -> Result<Grid, MultiviewError> {
    let size = filmed.view(frame).camera().size();
    let step_px = config.step_px(size);
    let shown = (&*filmed.distances_m(frame)?, &*filmed.parts(frame)?);
    let deforming = package.filter(|_| filmed.deforms());
    let moment = deforming.map(|package| filmed.moments(&package.scene, frame));
    let lookout = deforming.zip(moment.as_ref()).map(|(package, moment)| package.ready(moment)).transpose()?;
    let points = filmed.points(frame, shown, lookout.as_ref(), CovisibleFrame::grid(size, step_px));
    Ok(Grid { step_px, points })
}

/// The share of each frame's grid that the frame `by` sees.
fn column(
    filmed: &Filmed<'_>,
    grids: &[Grid],
    (package, still): (Option<&ScenePackage>, Option<&Lookout<'_>>),
    by: usize,
) -> Result<Vec<f32>, MultiviewError> {
    let moving = package.filter(|_| still.is_none());
    let moment = moving.map(|package| filmed.moments(&package.scene, by));
    let own = moving.zip(moment.as_ref()).map(|(package, moment)| package.ready(moment)).transpose()?;
    let lookout = still.or(own.as_ref());
    let surroundings = Surroundings::new(filmed.view(by), filmed.distances_m(by)?);
    let share = |(of, grid): (usize, &Grid)| {
        // A frame sees what it shows.
        let is_seen = |point: &&SurfacePoint| is_seen(&surroundings, lookout, filmed.carry([of, by], point, lookout));
        let seen = if of == by { grid.points.len() } else { grid.points.iter().filter(is_seen).count() };
        (seen as f64 / grid.points.len() as f64) as f32
    };
    Ok(grids.iter().enumerate().map(share).collect())
}

/// Whether a frame sees a surface point of the world.
fn is_seen(frame: &Surroundings<'_>, lookout: Option<&Lookout<'_>>, p_world: DVec3) -> bool {
    match frame.around(p_world) {
        Around::Outside => false,
        Around::Free => true,
        Around::Before { all } => lookout.map_or(!all, |lookout| lookout.shows(frame.view(), p_world)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_about_as_many_pixels_as_asked_for() {
        let config = CovisibilityConfig::default();
        for (size, step_px, pixels) in [([1024, 768], 16, 3072), ([320, 240], 5, 3072), ([64, 48], 1, 3072), ([8, 4], 1, 32)] {
            assert_eq!((config.step_px(size), CovisibleFrame::grid(size, step_px).count()), (step_px, pixels), "{size:?}");
        }
    }
}
