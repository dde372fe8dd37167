//! Pictures of planned trajectories: plan, sections, every view, and statistics, made only from the files of a dataset.
//!
//! [`write_plan_preview`] makes, for every trajectory of a scene, a plan at the height of the camera and two sections as architects draw
//! them (cut surfaces in thick lines, surfaces behind the plane as relief) with the free space, the path of the camera, its frusta and
//! targets; a picture of every view coloured by part, in the format and place of Hypersim's toolkit; the views on one sheet, or a few
//! hundred of them if there are thousands; and the distributions of the frames' measures. One page for a browser shows it all.
//!
//! Every page is a list of shapes (`drawing/`) that is painted as PNG and written as SVG. The same plan gives the same bytes.

mod chart;
mod contact;
mod coverage;
mod cut;
mod figure;
mod floor_plan;
mod html;
mod legend;
mod look;
mod marks;
mod measure;
mod planned;
mod relief;
mod report;
mod rooms;
mod statistics;
mod subject;

use crate::drawing::{Drawing, paint, svg};
use crate::picture::{jpeg, png};
use contact::Thumbnail;
use cut::{Cut, Look};
use enfilade_dataset::{Dataset, DatasetError, remove_folder, write_bytes};
use enfilade_geometry::Voxel;
use enfilade_math::DVec3;
use enfilade_math::quantile;
use enfilade_scene::{Camera, CameraView, Cx, Trajectory};
use figure::figure;
pub use floor_plan::floor_plan_svg;
use html::{Section, Shown};
use look::{Sight, toolkit_colors};
use measure::{FrameMeasures, Measuring};
pub use planned::Planned;
pub use report::Report;
pub use rooms::rooms_svg;
use statistics::Distances;
use std::path::PathBuf;
use subject::Subject;

/// Draws everything planned for a scene into the dataset, and returns the files written. Old previews of the scene are removed.
///
/// # Errors
/// When a file cannot be written or removed.
pub fn write_plan_preview(dataset: &Dataset, planned: &Planned<'_>, cx: &dyn Cx) -> Result<Vec<PathBuf>, DatasetError> {
    remove_plan_preview(dataset, planned.scene)?;
    let colors = toolkit_colors(planned.parts());
    let total = planned.filmed.len() as u64;
    let (mut files, mut sections) = (Vec::new(), Vec::new());
    for (i, (camera, trajectory)) in planned.filmed.iter().enumerate() {
        cx.progress("trajectories drawn", i as u64, total);
        let seen = see(dataset, planned, (camera, trajectory), &colors, &mut files)?;
        sections.push(draw_trajectory(dataset, planned, (camera, trajectory), seen, &mut files)?);
    }
    let page = html::plan_page(planned.scene, &about_scene(planned), &sections);
    files.push(write_page(dataset, planned.scene, "index.html", page.into_bytes())?);
    cx.progress("trajectories drawn", total, total);
    Ok(files)
}

/// Writes the pages of a trajectory, and its statistics where planning has left none; appends the files to `files`.
fn draw_trajectory(
    dataset: &Dataset,
    planned: &Planned<'_>,
    (camera, trajectory): (&Camera, &Trajectory),
    mut seen: Digest,
    files: &mut Vec<PathBuf>,
) -> Result<Section, DatasetError> {
    let report = Report::read(&dataset.layout().plan_report(planned.scene, &trajectory.name));
    let report = report.filter(|report| report.put_into(&mut seen.measures));
    let points = coverage::coverage(planned, camera, trajectory);
    let subject = Subject { planned, camera, trajectory, measures: &seen.measures, points: &points, report: report.as_ref() };
    let mut pictures = Vec::new();
    for page in pages(&subject, &seen) {
        pictures.push(page.write(dataset, &subject, files)?);
    }
    if report.is_none() {
        let table = serde_json::to_string_pretty(&seen.measures).unwrap_or_default() + "\n";
        files.push(write_page(dataset, planned.scene, &format!("{}_statistics.json", trajectory.name), table.into_bytes())?);
    }
    Ok(Section { camera: trajectory.name.clone(), about: about(&subject), pictures })
}

/// Removes the previews of what was planned for a scene, as when it is planned again.
///
/// # Errors
/// When a file cannot be removed.
pub fn remove_plan_preview(dataset: &Dataset, scene: &str) -> Result<(), DatasetError> {
    let cameras = dataset.cameras(scene).unwrap_or_default();
    let views = cameras.iter().map(|camera| dataset.layout().plan_views_dir(scene, camera));
    views.chain([dataset.layout().plan_preview_dir(scene)]).try_for_each(|folder| remove_folder(&folder))
}

fn write_page(dataset: &Dataset, scene: &str, file: &str, bytes: Vec<u8>) -> Result<PathBuf, DatasetError> {
    let path = dataset.layout().plan_preview_dir(scene).join(file);
    write_bytes(&path, bytes)?;
    Ok(path)
}

/// Views in memory at a time: one takes megabytes.
const AT_A_TIME: usize = 64;

/// The data kept of the views of a trajectory.
#[derive(Default)]
struct Digest {
    /// Measures of every frame.
    measures: Vec<FrameMeasures>,
    /// Thumbnails of the frames on the sheet.
    thumbnails: Vec<Thumbnail>,
    distances: Distances,
}

/// Looks from every pose, and writes the views coloured by part where the toolkit has them; appends the files to `files`.
fn see(
    dataset: &Dataset,
    planned: &Planned<'_>,
    (camera, trajectory): (&Camera, &Trajectory),
    colors: &[[u8; 3]],
    files: &mut Vec<PathBuf>,
) -> Result<Digest, DatasetError> {
    let poses = &trajectory.poses;
    let shown = contact::shown(poses.len());
    let measuring = Measuring::new(planned, camera, trajectory);
    let mut seen = Digest::default();
    let mut before: Option<Sight> = None;
    for first in (0..poses.len()).step_by(AT_A_TIME) {
        let range = first..poses.len().min(first + AT_A_TIME);
        let sight = |k| look::look(planned.world, planned.bvh, &CameraView::of_frame(camera, poses, first + k));
        let mut sights: Vec<Sight> = enfilade_parallel::map_up_to(range.len(), sight);
        let write = |k: usize| {
            let path = dataset.layout().plan_view(planned.scene, &trajectory.name, poses[first + k].frame);
            write_bytes(&path, jpeg(&sights[k].in_toolkit_colors(colors)))?;
            Ok(path)
        };
        let written: Result<Vec<PathBuf>, DatasetError> = enfilade_parallel::try_map_up_to(range.len(), write);
        files.extend(written?);
        seen.measures.extend(measuring.measures(first, &sights, before.as_ref()));
        let thumbnail = |i: &usize| range.contains(i).then(|| Thumbnail::new(*i, &sights[i - first], shown.len()));
        seen.thumbnails.extend(enfilade_parallel::flat_map(&shown, thumbnail));
        sights.iter().for_each(|sight| seen.distances.add(sight));
        before = sights.pop();
    }
    Ok(seen)
}

/// A page of a trajectory.
struct Page {
    /// In the names of its files.
    name: &'static str,
    /// Caption.
    caption: String,
    drawing: Drawing,
    format: Format,
}

/// How a page is kept.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    /// Lines and writing.
    PngAndSvg,
    /// Mostly pictures.
    Jpeg,
}

impl Page {
    /// Writes the page's files, appends them to `files`, and returns how the page for browsers shows them.
    fn write(&self, dataset: &Dataset, subject: &Subject<'_>, files: &mut Vec<PathBuf>) -> Result<Shown, DatasetError> {
        let file = |extension: &str| format!("{}_{}.{extension}", subject.trajectory.name, self.name);
        let picture = paint(&self.drawing);
        let mut put = |name: String, bytes| -> Result<String, DatasetError> {
            files.push(write_page(dataset, subject.planned.scene, &name, bytes)?);
            Ok(name)
        };
        let (file, svg) = match self.format {
            Format::Jpeg => (put(file("jpg"), jpeg(&picture))?, None),
            Format::PngAndSvg => (put(file("png"), png(&picture, None))?, Some(put(file("svg"), svg(&self.drawing).into_bytes())?)),
        };
        Ok(Shown { file, svg, caption: self.caption.clone() })
    }
}

/// Definitions of the statistics.
const DEFINITIONS: &str = "Step, turn and overlap are those since the frame before, clearance is the distance to the nearest surface, and \
                           the void share counts pixels that see no surface. Surfaces are those that border free space";

/// The pages of a trajectory, in reading order.
fn pages(subject: &Subject<'_>, seen: &Digest) -> Vec<Page> {
    let through = median_position(subject.trajectory);
    let cuts = [
        ("plan", "Plan", Look::Down, "seen from above"),
        ("section_xz", "Section along x", Look::AlongY, "seen along +y"),
        ("section_yz", "Section along y", Look::AgainstX, "seen along -x"),
    ];
    let mut pages: Vec<Page> = enfilade_parallel::map(&cuts, |&(name, title, look, from)| {
        let cut = Cut { look, through };
        let caption = format!("{title} at {}, {from}", cut.name());
        Page { name, caption, drawing: figure(subject, cut, title), format: Format::PngAndSvg }
    });
    let cut = Cut { look: Look::Down, through };
    pages.push(Page {
        name: "coverage",
        caption: format!("Points of all surfaces up to {} that border free space, by the number of frames that see them", cut.name()),
        drawing: figure::coverage_figure(subject, cut),
        format: Format::PngAndSvg,
    });
    let which = contact::which(seen.thumbnails.len(), seen.measures.len(), "Every view");
    pages.push(Page {
        name: "contact_sheet",
        caption: format!("{which}, coloured by part and lit from the camera"),
        drawing: contact::contact_sheet(subject, &seen.thumbnails),
        format: Format::Jpeg,
    });
    pages.push(Page {
        name: "statistics",
        caption: format!("Statistics. {DEFINITIONS}; the score is {}", subject.score_name()),
        drawing: statistics::statistics(subject, &seen.distances),
        format: Format::PngAndSvg,
    });
    pages
}

/// The median of the camera centres along each axis.
fn median_position(trajectory: &Trajectory) -> DVec3 {
    let median = |axis: usize| {
        let mut values: Vec<f64> = trajectory.poses.iter().map(|pose| pose.position[axis]).collect();
        quantile(&mut values, 0.5).unwrap_or(0.0)
    };
    DVec3::new(median(0), median(1), median(2))
}

fn about(subject: &Subject<'_>) -> String {
    let way_m: f64 = subject.measures.iter().filter_map(|m| m.step_m).sum();
    let [width, height] = subject.camera.size();
    let mode = subject.report.map_or(String::new(), |report| format!("{}, ", report.mode));
    format!("{mode}{} frames of {width} x {height} pixels, {way_m:.1} m of way", subject.trajectory.poses.len())
}

fn about_scene(planned: &Planned<'_>) -> String {
    let voxel_m3 = planned.tree.resolution_m().powi(3);
    let (free, occupied) = (planned.tree.count(Voxel::Free) as f64 * voxel_m3, planned.tree.count(Voxel::Occupied));
    let (triangles, parts) = (planned.world.corners.len(), planned.parts());
    format!("{free:.1} m³ of free space, {occupied} occupied voxels, {triangles} triangles in {parts} parts")
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::VoxelKey;
    use enfilade_geometry::{Bvh, OccupancyTree};
    use enfilade_scene::StartCamera;
    use enfilade_scene::{Intrinsics, Pose, Quiet};
    use enfilade_testroom::box_room;
    use std::collections::BTreeMap;
    use std::path::Path;

    pub(super) const SIZE: DVec3 = DVec3::new(4.0, 3.0, 2.5);

    /// The box room with all of its inside free, and a trajectory of three poses.
    pub(super) fn with_planned<T>(run: impl FnOnce(&Planned<'_>) -> T) -> T {
        let world = box_room(DVec3::ZERO, SIZE);
        let bvh = Bvh::new(&world.corners, &|_| false);
        let mut tree = OccupancyTree::new(0.25);
        for (x, y, z) in (0..16).flat_map(|x| (0..12).flat_map(move |y| (0..10).map(move |z| (x, y, z)))) {
            let p = 0.25 * (DVec3::new(f64::from(x), f64::from(y), f64::from(z)) + DVec3::splat(0.5));
            tree.set(VoxelKey::at(p, 0.25).unwrap(), Voxel::Free);
        }
        let pose = |frame| {
            let from = DVec3::new(1.0 + 0.5 * f64::from(frame), 1.0, 1.4);
            Pose::look_at(frame, from, DVec3::new(3.5, 2.5, 1.0), DVec3::Z).unwrap()
        };
        let trajectory = Trajectory { name: "cam_00".into(), poses: (0..3).map(pose).collect() };
        let camera: Camera = Intrinsics::from_fov_x(64, 48, 1.0).into();
        let start = StartCamera {
            name: "door".into(),
            position: trajectory.poses[0].position,
            world_from_camera: trajectory.poses[0].world_from_camera,
            fov_x_rad: 1.0,
            aspect: 4.0 / 3.0,
        };
        let (starts, filmed) = ([start], [(camera, trajectory)]);
        run(&Planned { scene: "room", world: &world, bvh: &bvh, tree: &tree, starts: &starts, filmed: &filmed })
    }

    fn draw(folder: &Path) -> Vec<PathBuf> {
        let dataset = Dataset::create(folder).unwrap();
        with_planned(|planned| {
            let (camera, trajectory) = &planned.filmed[0];
            dataset.write_trajectory("room", trajectory, camera, None).unwrap();
            write_plan_preview(&dataset, planned, &Quiet).unwrap()
        })
    }

    fn contents(root: &Path, files: &[PathBuf]) -> BTreeMap<PathBuf, Vec<u8>> {
        files.iter().map(|file| (file.strip_prefix(root).unwrap().to_path_buf(), std::fs::read(file).unwrap())).collect()
    }

    #[test]
    fn every_page_and_view_is_made_and_shown() {
        let folder = tempfile::tempdir().unwrap();
        let files = contents(folder.path(), &draw(folder.path()));
        let names: Vec<String> = files.keys().map(|path| path.display().to_string()).collect();
        let detail = "scenes/room/_detail";
        for frame in 0..3 {
            assert!(names.contains(&format!("{detail}/cam_00/preview/frame.{frame:04}.jpg")), "{names:?}");
        }
        let page = String::from_utf8(files[Path::new(&format!("{detail}/plan_preview/index.html"))].clone()).unwrap();
        for name in ["plan.png", "coverage.png", "section_xz.png", "section_yz.png", "contact_sheet.jpg", "statistics.png"] {
            let picture = image::load_from_memory(&files[Path::new(&format!("{detail}/plan_preview/cam_00_{name}"))]).unwrap();
            assert!(picture.width() == 1600 && page.contains(&format!("src=\"cam_00_{name}\"")), "{name}");
        }
        let table = &files[Path::new(&format!("{detail}/plan_preview/cam_00_statistics.json"))];
        let rows: serde_json::Value = serde_json::from_slice(table).unwrap();
        let at = |row: usize, field: &str| rows[row][field].as_f64().unwrap();
        assert!((at(0, "height_m") - 1.4).abs() < 1e-6 && at(0, "roll_deg").abs() < 1e-9 && at(0, "void_share") == 0.0);
        assert!((at(0, "clearance_m") - 1.0).abs() < 1e-6 && (at(1, "step_m") - 0.5).abs() < 1e-9 && at(1, "overlap") > 0.6);
        assert_eq!((at(0, "parts"), at(0, "score")), (1.0, at(0, "triangles")));
        assert!(rows[0]["step_m"].is_null());
        remove_plan_preview(&Dataset::open(folder.path()).unwrap(), "room").unwrap();
        assert!(!folder.path().join(detail).join("plan_preview").exists() && !folder.path().join(detail).join("cam_00/preview").exists());
    }

    #[test]
    fn the_bytes_are_the_same_on_any_number_of_threads() {
        let on = |threads| {
            let folder = tempfile::tempdir().unwrap();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let files = pool.install(|| draw(folder.path()));
            contents(folder.path(), &files)
        };
        assert!(on(1) == on(5));
    }
}
