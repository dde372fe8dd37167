//! Hugging Face: Parquet files that `datasets.load_dataset(folder)` loads, and a dataset card.
//!
//! `data/<split>-NNNNN.parquet` has a row per frame. Sides of the partition are `train`, `validation` and `test`, by the dataset's own partition;
//! without one everything is `train`. Pictures are PNG files in the layout of the feature `Image`: tone-mapped colour, depth in millimetres
//! (16 bits, 0 for none), classes and instances (0 for none). K is OpenCV's, poses are camera to world in OpenCV's axes, metres.

use super::parquet_file::{COLUMNS, Column, NamedPicture, PICTURES, ParquetFile, Row};
use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::depth::{DEPTH, distance_m, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::picture::{SHOWN, color_png, grey16_png};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::{Classes, DatasetError, PartitionRow, Side};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_scene::Warning;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The name of a side in `datasets`.
const fn split_name(side: Side) -> &'static str {
    match side {
        Side::Train => "train",
        Side::Val => "validation",
        Side::Test => "test",
    }
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder, shard_bytes: u64) -> Result<(), ExportError> {
    let mut card = Vec::new();
    for (side, views) in sides(selected)? {
        let mut files = Files { out, limit: shard_bytes, name: split_name(side), count: 0, current: None, bytes: 0 };
        // As many frames as threads at a time: the layers of one at 1024 x 768 have some 20 MB.
        for batch in views.chunks(rayon::current_num_threads()) {
            for row in selected.each_of(batch, |view| row(selected, view))? {
                files.add(row)?;
            }
        }
        files.close()?;
        card.push((split_name(side), views.len(), files.bytes));
    }
    out.set_front_matter(front_matter(&card));
    out.write_json("classes.json", &classes(selected)?)
}

/// Names of the classes by number, of every scene: people may have labelled one with a list of their own.
fn classes(selected: &SelectedFrames<'_>) -> Result<BTreeMap<String, BTreeMap<i16, String>>, ExportError> {
    let of_scene = |tracks: &[Track]| {
        let scene = &tracks[0].scene;
        let classes = selected.dataset.mesh_files(scene).read_classes()?.unwrap_or_else(Classes::nyu40);
        Ok((scene.clone(), classes.list().iter().map(|class| (class.id, class.name.clone())).collect()))
    };
    selected.scenes().map(of_scene).collect()
}

/// The frames of each side that has some, in order. Those that the partition does not place are left out, with a warning.
pub(crate) fn sides<'s>(selected: &'s SelectedFrames<'_>) -> Result<BTreeMap<Side, Vec<View<'s>>>, ExportError> {
    let mut sides: BTreeMap<Side, Vec<View<'s>>> = BTreeMap::new();
    let rows: Vec<PartitionRow> = match selected.dataset.read_partition() {
        Err(error) if DatasetError::is_not_found(&error) => {
            sides.insert(Side::Train, selected.views().collect());
            return Ok(sides);
        }
        rows => rows?,
    };
    let placed: BTreeMap<(&str, &str, u32), Side> =
        rows.iter().filter_map(|row| Some(((row.scene.as_str(), row.camera.as_str(), row.frame), *row.side.as_ref().ok()?))).collect();
    let mut lost = Vec::new();
    for view in selected.views() {
        match placed.get(&(view.track.scene.as_str(), view.track.name.as_str(), view.frame())) {
            Some(side) => sides.entry(*side).or_default().push(view),
            None => lost.push(view.name()),
        }
    }
    if let Some(first) = lost.first() {
        let message =
            format!("{first} and {} more are on no side of the partition and left out; divide again: enfilade partition", lost.len() - 1);
        if sides.is_empty() {
            return Err(ExportError::Selection(message));
        }
        selected.warn(Warning { place: selected.dataset.layout().partition().display().to_string(), message });
    }
    Ok(sides)
}

fn row(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<Row, ExportError> {
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::Semantic, Layer::SemanticInstance]].concat())?;
    let calibration = Calibration::of(view.track);
    let planar = calibration.as_ref().filter(|_| view.track.camera.projection.has_image_plane());
    let (model, distortion) = match calibration.as_ref().map(|c| &c.distortion) {
        None => ("rays", Vec::new()),
        Some(Distortion::None) => ("pinhole", Vec::new()),
        Some(Distortion::RadialTangential(d)) => ("opencv", d.to_vec()),
        Some(Distortion::Fisheye(d)) => ("opencv_fisheye", d.to_vec()),
    };
    let pose = calibration.as_ref().map_or_else(|| Calibration::opencv_pose_of(view.pose()), |c| c.opencv_pose(view));
    Ok(Row {
        scene: view.track.scene.clone(),
        camera: view.track.name.clone(),
        frame: view.frame(),
        size: view.track.camera.size(),
        pictures: pictures(selected, view, &frame, planar)?,
        depth_kind: if planar.is_some() { "planar" } else { "distance" },
        model,
        k: calibration.as_ref().map(|c| c.intrinsics.opencv_k()),
        distortion,
        world_from_camera: pose,
    })
}

/// The pictures that the frame has layers for, with their names.
fn pictures(
    selected: &SelectedFrames<'_>,
    view: View<'_>,
    frame: &Frame,
    planar: Option<&Calibration>,
) -> Result<[Option<NamedPicture>; 4], ExportError> {
    let named = |what: &str, bytes: Vec<u8>| (bytes, format!("{}/{:04}.{what}.png", view.track.folder(), view.frame()));
    let grey = |values: &[u16]| grey16_png(frame.width, frame.height, values);
    let color = frame.get(Layer::Color).map(|_| color_png(selected, view, frame)).transpose()?;
    let depth = match (DEPTH.iter().any(|&layer| frame.get(layer).is_some()), planar) {
        (false, _) => None,
        (true, Some(calibration)) => Some(planar_m(selected, view, calibration, frame)?),
        (true, None) => Some(distance_m(selected, view, frame)?),
    };
    let depth = depth.map(|depth_m| grey(&depth_m.into_iter().map(millimetres).collect::<Vec<_>>()));
    let [semantic, instance] = [Layer::Semantic, Layer::SemanticInstance].map(|layer| frame.get(layer).map(|ids| grey(&numbers(ids))));
    let [a, b, c, d] = PICTURES;
    Ok([color.map(|v| named(a, v)), depth.map(|v| named(b, v)), semantic.map(|v| named(c, v)), instance.map(|v| named(d, v))])
}

/// Labels from 1, and 0 where there is none.
fn numbers(labels: &Values) -> Vec<u16> {
    (0..labels.len()).map(|i| labels.get(i).max(0.0) as u16).collect()
}

/// The part of the card that the library and the hub read: names, frames and bytes of the splits, and the features; and how to load the
/// first split.
fn front_matter(splits: &[(&str, usize, u64)]) -> String {
    let mut text = String::from("---\npretty_name: enfilade\ntask_categories:\n- depth-estimation\n- image-segmentation\nconfigs:\n");
    text.push_str("- config_name: default\n  data_files:\n");
    for (name, ..) in splits {
        let _ = write!(text, "  - split: {name}\n    path: data/{name}-*\n");
    }
    text.push_str("dataset_info:\n  features:\n");
    for (name, column) in COLUMNS {
        let _ = match column {
            Column::Text(_) => writeln!(text, "  - name: {name}\n    dtype: string"),
            Column::Number(_) => writeln!(text, "  - name: {name}\n    dtype: int32"),
            Column::Picture(_) => writeln!(text, "  - name: {name}\n    dtype: image"),
            Column::List(_) => writeln!(text, "  - name: {name}\n    sequence: float64"),
            Column::Matrix(_) => writeln!(text, "  - name: {name}\n    sequence:\n      sequence: float64"),
        };
    }
    text.push_str("  splits:\n");
    for (name, frames, bytes) in splits {
        let _ = writeln!(text, "  - name: {name}\n    num_bytes: {bytes}\n    num_examples: {frames}");
    }
    let first = splits.first().map_or("train", |(name, ..)| name);
    let _ = write!(text, "---\n\n# Frames with depth, classes, instances and cameras\n\n    from datasets import load_dataset\n\n");
    let _ = write!(text, "    frames = load_dataset(\"this-folder\", split=\"{first}\")\n    frame = frames[0]\n");
    text + "    depth_m = numpy.asarray(frame[\"depth\"]) / 1000.0\n\n"
}

/// The files of one side, one after the other.
struct Files<'p> {
    out: &'p ExportFolder,
    limit: u64,
    name: &'static str,
    count: usize,
    current: Option<ParquetFile>,
    /// Bytes of all pictures.
    bytes: u64,
}

impl Files<'_> {
    /// Adds a row, to a new file where the current one would become too large.
    fn add(&mut self, row: Row) -> Result<(), ExportError> {
        if self.current.as_ref().is_some_and(|file| file.bytes + row.bytes() > self.limit) {
            self.close()?;
        }
        self.bytes += row.bytes();
        let file = match self.current.take() {
            Some(file) => file,
            None => {
                self.count += 1;
                ParquetFile::create(self.out.path(&format!("data/{}-{:05}.parquet", self.name, self.count - 1))?)?
            }
        };
        self.current.insert(file).add(row)
    }

    fn close(&mut self) -> Result<(), ExportError> {
        let Some(file) = self.current.take() else { return Ok(()) };
        self.out.count(file.close()?);
        Ok(())
    }
}
