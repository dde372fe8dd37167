//! Pictures of the planned trajectories; made on request, from the files of the dataset.

use super::{Job, carve};
use crate::error::Error;
use crate::report::{Event, StageCx, Stopwatch};
use enfilade_dataset::{counted, counted_as};
use enfilade_geometry::OccupancyTree;
use enfilade_show::planview::{Planned, write_plan_preview};
use std::path::PathBuf;

/// Draws the trajectories of a scene and returns the page that shows them.
pub(crate) fn draw_plan(job: &Job, cx: &StageCx) -> Result<PathBuf, Error> {
    let time = Stopwatch::start();
    cx.event(Event::Started);
    let name = &job.scene.name;
    let filmed = job.filmed()?;
    let starts = carve::starts(job).unwrap_or_default();
    let (bt, _, _) = job.dataset.read_free_space(name).map_err(Error::stage)?;
    let tree = OccupancyTree::from_bt(&bt).map_err(Error::stage)?;
    let world = job.load_world()?;
    let planned = Planned { scene: name, world: &world.mesh, bvh: &world.bvh, tree: &tree, starts: &starts, filmed: &filmed };
    let files = write_plan_preview(job.dataset, &planned, cx).map_err(Error::stage)?;
    let drawn = counted_as(filmed.len(), "trajectory", "trajectories");
    let summary = format!("{drawn} drawn: {}", counted(files.len(), "file"));
    cx.event(Event::Finished { summary: &summary, wall_s: time.wall_s() });
    Ok(job.dataset.layout().plan_preview_dir(name).join("index.html"))
}
