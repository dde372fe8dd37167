//! The pilot of a forecast: a few squares of pixels of a few frames, and one frame with two samples per pixel that passes through all later
//! stages, in a separate dataset that is removed afterwards.

use super::{FramesByTrajectory, Job, PARTIALS, STAGES, Stage, advance};
use crate::error::Error;
use crate::forecast::{ProbeCost, ScenePilot};
use crate::report::{Event, Silent, StageCx, Stopwatch, machine_is_busy, peak_memory_bytes, thread_cpu_s};
use crate::workdir::{PACKAGE, Workdir};
use enfilade_dataset::{ColorKind, Dataset, FrameInfo, remove_folder};
use enfilade_frame::Frame;
use enfilade_label::boxes::scene_boxes;
use enfilade_label::instances::solids;
use enfilade_render::{FlowTo, FrameRender, Guide, Probe, RenderConfig, RenderScene, add_extra_layers, samples_wanted};
use enfilade_scene::{Camera, CameraView, Cx, FIRST_PACKAGE, Quiet, Trajectory, WorldMesh};
use std::path::Path;

/// Folder within the work folder of a scene.
const FOLDER: &str = "pilot";
/// Samples per pixel of the frame that passes through all stages.
const FRAME_SAMPLES: u32 = 2;
/// Largest number of samples per pixel of a probe: enough to estimate how noisy a place is.
const PROBE_SAMPLES: u32 = 16;
/// Samples per pixel of a probe at most, where noise decides how many are taken.
const NOISE_SAMPLES: u32 = 64;
/// The pilot takes about this share of the run's samples.
const SHARE: f64 = 0.01;
/// Minimum and maximum number of probes of a frame.
const PROBES: [f64; 2] = [12.0, 96.0];
/// Frames of a trajectory that are tried at most, and trajectories of a scene.
const FRAMES: usize = 6;
const TRAJECTORIES: usize = 4;

/// Makes the products of a scene in a dataset of one frame.
pub(crate) type Products<'p> = &'p dyn Fn(&Dataset) -> Result<(), Error>;

/// Tries out the rendering of `frames`, at least one, of a scene whose trajectories are planned.
pub(crate) fn pilot(job: &Job, frames: &FramesByTrajectory, products: Products, cx: &StageCx) -> Result<ScenePilot, Error> {
    cx.event(Event::Started);
    let time = Stopwatch::start();
    job.forget_world();
    let planned = job.filmed()?;
    let filmed: Vec<_> = planned.iter().filter(|(_, trajectory)| frames.contains_key(&trajectory.name)).collect();
    let scene = job.load_scene()?;
    let prepared = RenderScene::new(&scene, &Quiet).map_err(Error::stage)?.settled(&job.scene.render);
    let scene_cpu_s = time.cpu_s();
    let [width, height] = job.scene.size;
    let mut found = ScenePilot {
        frames: frames.values().map(|frames| frames.len() as u64).sum(),
        pixels: u64::from(width) * u64::from(height),
        noise_target: job.scene.render.noise.is_some(),
        time_limit_s: job.scene.time_limit_s,
        threads: rayon::current_num_threads() as u32,
        busy: machine_is_busy(),
        ..ScenePilot::default()
    };
    let tried = spread(filmed.len(), TRAJECTORIES);
    let mut guides_cpu_s = 0.0;
    for (step, &index) in tried.iter().enumerate() {
        cx.progress("trajectories tried", step as u64, tried.len() as u64);
        let (camera, trajectory) = &filmed[index];
        let config = RenderConfig { seed: job.scene.seed_for(&format!("render/{}", trajectory.name)), ..job.scene.render.clone() };
        let views: Vec<CameraView> = (0..trajectory.poses.len()).map(|i| CameraView::of_frame(camera, &trajectory.poses, i)).collect();
        let time = Stopwatch::start();
        let guide = Guide::learn(&prepared, &views, &config);
        guides_cpu_s += time.cpu_s();
        let wanted = &frames[&trajectory.name];
        let wanted: Vec<usize> = (0..views.len()).filter(|&i| wanted.contains(&trajectory.poses[i].frame)).collect();
        for i in spread(wanted.len(), FRAMES) {
            found.probes.push(probe_frame(&prepared, &guide, &views[wanted[i]], &config)?);
        }
        if let (0, Some(&middle)) = (step, wanted.get(wanted.len() / 2)) {
            try_frame(job, (camera, trajectory, middle), (&prepared, &guide, &views), products, &mut found)?;
        }
    }
    found.before_cpu_s = scene_cpu_s + guides_cpu_s * filmed.len() as f64 / tried.len().max(1) as f64;
    found.scene_bytes += folder_bytes(&job.dataset.layout().detail_dir(&job.scene.name));
    // The package is most of the work folder. Frames in the making go again.
    found.scene_bytes += folder_bytes(&job.work_file("")?).saturating_sub(folder_bytes(&job.work_file(PARTIALS)?));
    found.peak_memory_bytes = peak_memory_bytes().unwrap_or(0);
    let summary = format!("a pilot of {} frames took {:.1} processor seconds", found.probes.len(), time.cpu_s());
    cx.event(Event::Finished { summary: &summary, wall_s: time.wall_s() });
    Ok(found)
}

/// At most `most` of `count` indices, evenly spread.
fn spread(count: usize, most: usize) -> Vec<usize> {
    let n = count.min(most);
    (0..n).map(|i| (2 * i + 1) * count / (2 * n)).collect()
}

/// Upper left corners of squares, one at a place of its own in each cell of a grid of about `probes` cells.
fn corners([width, height]: [u32; 2], probes: f64) -> Vec<[u32; 2]> {
    let columns = (probes * f64::from(width) / f64::from(height)).sqrt().ceil().max(1.0) as u32;
    let rows = (probes / f64::from(columns)).ceil().max(1.0) as u32;
    let mut rng = enfilade_math::Rng::new(0);
    let mut place = |cell: u32, cells: u32, length: u32| {
        let at = (f64::from(cell) + rng.next_f64()) / f64::from(cells) * f64::from(length);
        (at as u32).saturating_sub(Probe::SIDE / 2)
    };
    (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| [place(column, columns, width), place(row, rows, height)])
        .collect()
}

/// The cost of squares of a frame.
fn probe_frame(scene: &RenderScene<'_>, guide: &Guide, view: &CameraView<'_>, config: &RenderConfig) -> Result<Vec<ProbeCost>, Error> {
    let [width, height] = view.camera().size();
    let samples = if config.noise.is_some() { NOISE_SAMPLES } else { PROBE_SAMPLES }.min(config.samples);
    let pixels = f64::from(Probe::SIDE * Probe::SIDE);
    let planned = f64::from(width) * f64::from(height) * f64::from(config.samples);
    let probes = (SHARE * planned / (pixels * f64::from(samples))).clamp(PROBES[0], PROBES[1]);
    let one = |&corner: &[u32; 2]| -> Result<(Probe<'_, '_>, f64), Error> {
        let mut probe = Probe::new(scene, guide, view, config, corner).map_err(Error::stage)?;
        // The first sample warms the caches, as earlier tiles do in a whole frame.
        let first = if samples > 1 { 1 } else { 0 };
        probe.take(first);
        let before_s = thread_cpu_s();
        probe.take(samples);
        Ok((probe, (thread_cpu_s() - before_s) / (pixels * f64::from(samples - first))))
    };
    let tried: Vec<(Probe<'_, '_>, f64)> = enfilade_parallel::try_map(&corners([width, height], probes), one)?;
    let (probes, costs): (Vec<_>, Vec<_>) = tried.into_iter().unzip();
    let wanted = samples_wanted(config, &probes);
    Ok(wanted.into_iter().zip(costs).map(|(samples, cpu_s)| ProbeCost { samples, cpu_s }).collect())
}

/// Renders the frame of a pose with few samples and takes it through all stages, in a dataset of its own.
fn try_frame(
    job: &Job,
    filmed: (&Camera, &Trajectory, usize),
    (prepared, guide, views): (&RenderScene<'_>, &Guide, &[CameraView<'_>]),
    products: Products,
    found: &mut ScenePilot,
) -> Result<(), Error> {
    let folder = job.work_file(FOLDER)?;
    remove_folder(&folder)?;
    let result = try_frame_in(job, &folder, filmed, (prepared, guide, views), products, found);
    remove_folder(&folder)?;
    result
}

fn try_frame_in(
    job: &Job,
    folder: &Path,
    (camera, trajectory, index): (&Camera, &Trajectory, usize),
    (prepared, guide, views): (&RenderScene<'_>, &Guide, &[CameraView<'_>]),
    products: Products,
    found: &mut ScenePilot,
) -> Result<(), Error> {
    let name = &job.scene.name;
    let pose = &trajectory.poses[index];
    let config =
        RenderConfig { samples: FRAME_SAMPLES.min(job.scene.render.samples), adaptive: false, noise: None, ..job.scene.render.clone() };
    let mut rendering = FrameRender::new(prepared, guide, &views[index], &config).map_err(Error::stage)?;
    while !rendering.is_done() {
        rendering.pass(&Quiet);
    }
    let scratch = Workdir::create(folder)?;
    let dataset = Dataset::create(folder).map_err(Error::stage)?;
    let time = Stopwatch::start();
    let mut frame = rendering.frame();
    if config.extra {
        add_extra_layers(prepared, &views[index], views.get(index + 1).map(FlowTo::still), &mut frame);
    }
    let info = FrameInfo {
        seed: 0,
        samples: config.samples,
        config_hash: "pilot".into(),
        pose: *pose,
        camera: camera.clone(),
        sampling: None,
        recipe: None,
    };
    dataset.write_rendered(name, &trajectory.name, &frame, &info, time.of_frame()).map_err(Error::stage)?;
    found.frame_cpu_s = time.cpu_s();
    found.layers_bytes = layers_bytes(&frame);
    drop((rendering, frame));
    let alone = Trajectory { name: trajectory.name.clone(), poses: vec![*pose] };
    let scene = job.load_scene()?;
    dataset.write_scene(name, &scene).map_err(Error::stage)?;
    dataset.write_trajectory(name, &alone, camera, None).map_err(Error::stage)?;
    dataset.write_camera_parameters(name, camera).map_err(Error::stage)?;
    let folder = dataset.layout().scene_dir(name);
    let before_bytes = bytes_below(&folder, &|file| !is_of_frame(file));
    later_stages(job, &dataset, &scratch, products, found)?;
    let layout = dataset.layout();
    // If colour is as rendered, its files have two names.
    let is_second_name = |file: &str| job.scene.color == ColorKind::Rendered && file.ends_with("_rendered.hdf5");
    found.frame_bytes = bytes_below(&folder, &|file| is_of_frame(file) && !is_second_name(file));
    found.frame_bytes += folder_bytes(&layout.sensors_dir()) + folder_bytes(&layout.relit_dir());
    // Tables and contact sheets: another frame adds only a row or a small picture.
    found.scene_bytes = bytes_below(&folder, &|file| !is_of_frame(file)).saturating_sub(before_bytes);
    // The parts of `boxes` that do not depend on frames.
    let labels = dataset.read_label_tables(name).unwrap_or_default();
    let time = Stopwatch::start();
    let _ = (scene_boxes(&scene, &labels), solids(&WorldMesh::new(&scene), &labels));
    found.later_cpu_s = time.cpu_s();
    found.later_frame_cpu_s = (found.later_frame_cpu_s - found.later_cpu_s).max(0.0);
    Ok(())
}

/// Runs the stages after rendering on the frame, makes its products, and notes the time. That a frame of two samples breaks a law does not matter here.
fn later_stages(job: &Job, dataset: &Dataset, scratch: &Workdir, products: Products, found: &mut ScenePilot) -> Result<(), Error> {
    let name = &job.scene.name;
    for file in [PACKAGE, FIRST_PACKAGE, "labels.json"] {
        let (from, to) = (job.work_file(file)?, scratch.scene_file(name, file)?);
        // Only variations have the package of their first scene.
        if file == FIRST_PACKAGE && !from.is_file() {
            continue;
        }
        std::fs::hard_link(&from, &to).or_else(|_| std::fs::copy(&from, &to).map(drop)).map_err(Error::io("copy", &from))?;
    }
    let once = Job::new(job.config, job.scene, dataset, scratch, true);
    let time = Stopwatch::start();
    for spec in STAGES.iter().filter(|spec| spec.stage > Stage::Render) {
        match advance(spec, &once, || Ok(()), StageCx::new(name, spec.stage, &Silent)) {
            Err(error) if spec.stage != Stage::Verify => return Err(error),
            _ => {}
        }
    }
    products(dataset)?;
    found.later_frame_cpu_s = time.cpu_s();
    Ok(())
}

fn layers_bytes(frame: &Frame) -> u64 {
    frame.iter().map(|(_, values)| values.as_bytes().len() as u64).sum()
}

/// True for the files that every frame has: layers, records, pictures, masks.
fn is_of_frame(file: &str) -> bool {
    file.starts_with("frame.")
}

/// Bytes of all files below a folder.
fn folder_bytes(folder: &Path) -> u64 {
    bytes_below(folder, &|_| true)
}

/// Bytes of the files below a folder whose names are wanted.
fn bytes_below(folder: &Path, is_wanted: &dyn Fn(&str) -> bool) -> u64 {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    let size = |entry: std::fs::DirEntry| match entry.metadata() {
        Ok(data) if data.is_dir() => bytes_below(&entry.path(), is_wanted),
        Ok(data) if is_wanted(&entry.file_name().to_string_lossy()) => data.len(),
        _ => 0,
    };
    entries.filter_map(Result::ok).map(size).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_spread_over_the_trajectory() {
        assert_eq!(spread(4, 6), [0, 1, 2, 3]);
        assert_eq!(spread(100, 4), [12, 37, 62, 87]);
        assert_eq!(spread(0, 4), Vec::<usize>::new());
    }

    #[test]
    fn files_of_frames_are_counted_apart_from_those_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        for (file, bytes) in [("images/frame.0003.color.hdf5", 100), ("frame.0003.json", 20), ("images/contact_sheet.jpg", 3)] {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, vec![0u8; bytes]).unwrap();
        }
        assert_eq!(bytes_below(folder.path(), &is_of_frame), 120);
        assert_eq!(folder_bytes(folder.path()), 123);
    }

    #[test]
    fn probes_lie_in_all_parts_of_the_image() {
        let places = corners([640, 480], 48.0);
        assert_eq!(places.len(), 48);
        for quarter in [[0, 0], [320, 0], [0, 240], [320, 240]] {
            let inside = places.iter().filter(|p| (0..2).all(|a| (quarter[a]..quarter[a] + [320, 240][a]).contains(&p[a]))).count();
            assert!((10..=14).contains(&inside), "{inside} near {quarter:?}");
        }
    }
}
