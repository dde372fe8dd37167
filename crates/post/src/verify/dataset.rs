//! Verification of a dataset on disk.

use super::card::{Card, VerifyReport};
use super::law::Law;
use super::{View, boxes, camera_files, check_frame, check_labels, check_trajectory};
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{BoxKind, Dataset, DatasetError, FrameStatus, InstanceView, Manifest, Node, Partition};
use enfilade_frame::{Frame, LAYERS, LayerSpec};
use enfilade_geometry::{OccupancyTree, Voxel};
use enfilade_scene::{Camera, CameraView, Cx, Labels, PartLabel, Pose, Trajectory};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicU64, Ordering};

/// Checks every law over the given scenes. What cannot be read counts as a violation, not as an error.
///
/// Frames are read in parallel; the report is the same for every number of threads.
///
/// # Errors
/// When the manifest cannot be read.
pub fn verify_dataset(dataset: &Dataset, scenes: &[String], cx: &dyn Cx) -> Result<VerifyReport, DatasetError> {
    let mut card = Card::default();
    let manifest = dataset.read_manifest()?;
    check_manifest(&mut card, dataset, manifest, scenes);
    check_split(&mut card, dataset);
    let facts: Vec<SceneFacts> = scenes.iter().map(|scene| SceneFacts::read(dataset, scene, &mut card)).collect();
    let frames: Vec<(&SceneFacts, &Filmed, usize)> = facts.iter().flat_map(SceneFacts::frames).collect();
    let done = AtomicU64::new(0);
    let check = |&(scene, filmed, index): &(&SceneFacts, &Filmed, usize)| {
        let card = scene.check_frame(dataset, filmed, index);
        cx.progress("frames", done.fetch_add(1, Ordering::Relaxed) + 1, frames.len() as u64);
        card
    };
    let cards: Vec<Card> = frames.par_iter().map(check).collect();
    cards.into_iter().for_each(|frame| card.merge(frame));
    Ok(VerifyReport::new(&card, scenes.len(), frames.len()))
}

/// What the manifest says, and whether the files are what it says.
fn check_manifest(card: &mut Card, dataset: &Dataset, manifest: Option<Manifest>, scenes: &[String]) {
    let Some(mut manifest) = manifest else {
        return card.observe(Law::Manifest, 1.0, || format!("{}: there is none", dataset.layout().manifest().display()));
    };
    for scene in scenes {
        let listed = manifest.scenes.contains_key(scene);
        card.observe(Law::Manifest, if listed { 0.0 } else { 1.0 }, || format!("{scene}: not in the manifest"));
    }
    manifest.scenes.retain(|name, _| scenes.contains(name));
    for (scene, entry) in &manifest.scenes {
        if let Some(reason) = &entry.failed {
            card.observe(Law::HasFrames, 1.0, || format!("{scene}: failed: {reason}"));
        }
        for (camera, frame) in entry.cameras.iter().flat_map(|(name, camera)| camera.frames.iter().map(move |frame| (name, frame))) {
            let reason = frame.reason.as_deref().unwrap_or("planned, but not rendered");
            let broken = if frame.status == FrameStatus::Complete { 0.0 } else { 1.0 };
            card.observe(Law::FramesComplete, broken, || format!("{scene}/{camera}/frame.{:04}: {reason}", frame.frame));
        }
    }
    if let Some(problems) = readable(card, dataset.verify_checksums(&manifest)) {
        card.observe(Law::Checksums, problems.len() as f64, || problems.into_iter().next().unwrap_or_default());
    }
}

/// No scene is on two sides of the split, where there is one.
fn check_split(card: &mut Card, dataset: &Dataset) {
    let Some(rows) = boxes::there(dataset.read_split()).and_then(|read| readable(card, read)) else { return };
    let mut sides: BTreeMap<&str, Partition> = BTreeMap::new();
    let sided = rows.iter().filter_map(|row| Some((row.scene.as_str(), *row.partition.as_ref().ok()?)));
    let torn: BTreeSet<&str> = sided.filter(|&(scene, side)| *sides.entry(scene).or_insert(side) != side).map(|(scene, _)| scene).collect();
    card.observe(Law::SplitWhole, torn.len() as f64, || format!("scenes {torn:?}"));
}

/// The value of a read; what cannot be read goes on the card.
pub(super) fn readable<T>(card: &mut Card, read: Result<T, DatasetError>) -> Option<T> {
    let problem = read.as_ref().err().map(ToString::to_string);
    card.observe(Law::Readable, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
    read.ok()
}

/// Everything about a scene that its frames are checked against.
struct SceneFacts {
    name: String,
    meters_per_unit: f64,
    entities: usize,
    labels: Option<Labels>,
    boxes: Vec<(BoxKind, boxes::Boxes)>,
    filmed: Vec<Filmed>,
}

/// A trajectory, what it was filmed with, and the numbers of the frames that are there.
struct Filmed {
    trajectory: Trajectory,
    frames: Vec<u32>,
    camera: Option<Camera>,
    /// What its frames show of instances, where there is a table of it.
    views: Option<Vec<InstanceView>>,
}

impl SceneFacts {
    /// Reads them, and checks the laws that concern no single frame.
    fn read(dataset: &Dataset, name: &str, card: &mut Card) -> Self {
        let nodes = dataset.read_nodes(name);
        let problem = nodes.as_ref().err().map(ToString::to_string);
        card.observe(Law::Nodes, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
        let nodes = nodes.unwrap_or_default();
        let facts = Self {
            name: name.to_string(),
            meters_per_unit: readable(card, dataset.meters_per_asset_unit(name)).unwrap_or(1.0),
            entities: nodes.len(),
            labels: read_labels(dataset, name, &nodes, card),
            boxes: boxes::read_boxes(dataset, name, card),
            filmed: read_filmed(dataset, name, card),
        };
        facts.filmed.iter().filter_map(|f| Some((f, f.camera.as_ref()?))).for_each(|(f, camera)| {
            facts.check_matrices(dataset, camera, card);
            camera_files::check(dataset, name, &f.trajectory, camera, card);
        });
        facts.check_trajectories(dataset, card);
        boxes::check_boxes(&facts.boxes, name, card);
        facts
    }

    /// `M_cam_from_uv` and `M_proj` describe the camera where they can, and are not there where they cannot.
    fn check_matrices(&self, dataset: &Dataset, camera: &Camera, card: &mut Card) {
        let name = &self.name;
        if !camera.projection.is_linear() {
            let there = dataset.table_projection(name).is_ok();
            let at = || format!("{name}: M_cam_from_uv describes a pinhole, which the camera is not");
            return card.observe(Law::Calibration, if there { f64::INFINITY } else { 0.0 }, at);
        }
        let Some(table) = readable(card, dataset.table_projection(name)) else { return };
        let Some(matrix) = readable(card, dataset.projection_matrix(name)) else { return };
        let (width, height) = camera.size().map(f64::from).into();
        for (x, y) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height), (0.5 * width, 0.25 * height)] {
            let Some(ray) = camera.projection.ray(x, y) else { continue };
            let clip = matrix * (2.0 * ray).extend(1.0);
            let off = (0.5 * (clip.x / clip.w + 1.0) * width - x).hypot(0.5 * (1.0 - clip.y / clip.w) * height - y);
            card.observe(Law::Calibration, off, || format!("{name}: M_proj and the camera disagree at image point ({x}, {y})"));
            let off = table.project(ray).map_or(f64::INFINITY, |p| table.image_distance(p, (x, y)));
            card.observe(Law::Calibration, off, || format!("{name}: M_cam_from_uv and the camera disagree at image point ({x}, {y})"));
        }
    }

    fn check_trajectories(&self, dataset: &Dataset, card: &mut Card) {
        let name = &self.name;
        let tree = read_tree(dataset, name, card);
        let rendered: usize = self.filmed.iter().map(|filmed| filmed.frames.len()).sum();
        card.observe(Law::HasFrames, if rendered == 0 { 1.0 } else { 0.0 }, || format!("{name}: no rendered frame"));
        for filmed in &self.filmed {
            let Filmed { trajectory, frames, camera, .. } = filmed;
            let place = format!("{name}/{}", trajectory.name);
            card.merge(check_trajectory(trajectory, &place));
            let missing: Vec<u32> = trajectory.poses.iter().map(|pose| pose.frame).filter(|frame| !frames.contains(frame)).collect();
            card.observe(Law::FramesComplete, missing.len() as f64, || format!("{place}: frames {missing:?} are missing"));
            for pose in &trajectory.poses {
                self.check_record(dataset, &trajectory.name, camera.as_ref(), pose, card);
                if let Some(tree) = &tree {
                    let state = tree.state(pose.position);
                    let at = || format!("{place}/frame.{:04}: {:.3} m is {state:?}", pose.frame, pose.position);
                    card.observe(Law::FreeCamera, if state == Voxel::Free { 0.0 } else { 1.0 }, at);
                }
            }
        }
    }

    /// The frame's record states the pose and calibration that the tables state.
    fn check_record(&self, dataset: &Dataset, name: &str, camera: Option<&Camera>, pose: &Pose, card: &mut Card) {
        let Some(Some(record)) = readable(card, dataset.frame_record(&self.name, name, pose.frame)) else { return };
        let at = || format!("{}/{name}/frame.{:04}", self.name, pose.frame);
        let then = record.pose.to_pose(pose.frame);
        let turned = (then.world_from_camera - pose.world_from_camera).to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        card.observe(Law::RenderedPose, turned.max((then.position - pose.position).abs().max_element()), at);
        if let Some(camera) = camera {
            card.observe(Law::Calibration, record.camera_differs_by(camera), at);
        }
    }

    /// The frames on disk that belong to a trajectory.
    fn frames(&self) -> impl Iterator<Item = (&Self, &Filmed, usize)> {
        self.filmed.iter().flat_map(move |filmed| {
            let poses = filmed.trajectory.poses.iter().enumerate();
            poses.filter(|(_, pose)| filmed.frames.contains(&pose.frame)).map(move |(index, _)| (self, filmed, index))
        })
    }

    /// Checks the frame of pose `index`.
    fn check_frame(&self, dataset: &Dataset, filmed: &Filmed, index: usize) -> Card {
        let mut card = Card::default();
        let (name, poses) = (&filmed.trajectory.name, &filmed.trajectory.poses);
        let place = format!("{}/{name}/frame.{:04}", self.name, poses[index].frame);
        let frame = read_frame(dataset, &self.name, name, poses[index].frame, &mut card);
        if let (Some(frame), Some(camera)) = (frame, &filmed.camera) {
            let camera = CameraView::of_frame(camera, poses, index);
            let (meters_per_unit, entities, labels) = (self.meters_per_unit, self.entities, self.labels.as_ref());
            card.merge(check_frame(&frame, &View { camera, meters_per_unit, entities, labels }, &place));
            boxes::check_positions(&self.boxes, &frame, &camera, &place, &mut card);
            if let Some(views) = &filmed.views {
                boxes::check_views(views, &frame, poses[index].frame, &place, &mut card);
            }
        }
        card
    }
}

/// Every layer that is there, exactly as stored: other types or sizes than the table's go on the card.
fn read_frame(dataset: &Dataset, scene: &str, camera: &str, number: u32, card: &mut Card) -> Option<Frame> {
    let mut frame: Option<Frame> = None;
    for spec in LAYERS.iter().filter(|spec| dataset.has_layer(scene, camera, number, spec.layer)) {
        let path = dataset.layout().layer(scene, camera, number, spec.layer);
        let Some(array) = readable(card, read_array(&path)) else { continue };
        let shape = array.shape.clone();
        let size = image_size(&shape, spec);
        let values = array.values.into_values().ok().filter(|values| values.dtype() == spec.dtype);
        let (Some((width, height)), Some(values)) = (size, values) else {
            let expected =
                format!("expected an image of {} channels of {:?}, found shape {shape:?} or another type", spec.channels, spec.dtype);
            card.observe(Law::Readable, 1.0, || format!("{}: {expected}", path.display()));
            continue;
        };
        let frame = frame.get_or_insert_with(|| Frame::new(width, height));
        if (frame.width, frame.height) == (width, height) {
            frame.insert(spec.layer, values);
        } else {
            let other = format!("{width}x{height} pixels, but other layers of the frame have {}x{}", frame.width, frame.height);
            card.observe(Law::Readable, 1.0, || format!("{}: {other}", path.display()));
        }
    }
    if frame.is_none() {
        card.observe(Law::LayersPresent, LAYERS.len() as f64, || format!("{scene}/{camera}/frame.{number:04}: no layer can be read"));
    }
    frame
}

/// Width and height of an image of the layer's channels.
fn image_size(shape: &[usize], spec: &LayerSpec) -> Option<(u32, u32)> {
    match (shape, spec.channels) {
        (&[height, width], 1) => Some((width as u32, height as u32)),
        (&[height, width, channels], expected) if channels == expected && expected > 1 => Some((width as u32, height as u32)),
        _ => None,
    }
}

/// The labels by render entity.
fn read_labels(dataset: &Dataset, scene: &str, nodes: &[Node], card: &mut Card) -> Option<Labels> {
    let tables = match dataset.read_label_tables(scene) {
        Ok(tables) => tables,
        Err(error) => {
            card.observe(Law::LabelTables, 1.0, || error.to_string());
            return None;
        }
    };
    let objects = nodes.iter().filter_map(|node| node.object_id).max().map_or(0, |id| id as usize + 1);
    let enough = tables.parts.len() >= objects;
    card.observe(Law::LabelTables, if enough { 0.0 } else { 1.0 }, || {
        format!("{scene}: {} rows for {objects} objects", tables.parts.len())
    });
    card.merge(check_labels(&tables, scene));
    let label = |node: &Node| node.object_id.and_then(|id| tables.parts.get(id as usize)).copied().unwrap_or(PartLabel::NONE);
    Some(Labels { parts: nodes.iter().map(label).collect() })
}

fn read_filmed(dataset: &Dataset, scene: &str, card: &mut Card) -> Vec<Filmed> {
    let mut filmed = Vec::new();
    for name in readable(card, dataset.cameras(scene)).unwrap_or_default() {
        let Some(trajectory) = readable(card, dataset.read_trajectory(scene, &name)) else { continue };
        let frames = readable(card, dataset.frame_numbers(scene, &name)).unwrap_or_default();
        let camera = readable(card, dataset.read_camera(scene, &name));
        let views = boxes::there(dataset.read_instance_views(scene, &name)).and_then(|read| readable(card, read));
        filmed.push(Filmed { trajectory, frames, camera, views });
    }
    filmed
}

/// The free space, if there is one.
fn read_tree(dataset: &Dataset, scene: &str, card: &mut Card) -> Option<OccupancyTree> {
    let path = dataset.layout().octomap(scene);
    let bytes = match dataset.read_free_space(scene) {
        Err(error) if error.is_not_found() => return None,
        read => readable(card, read)?.0,
    };
    let tree = OccupancyTree::from_bt(&bytes);
    let problem = tree.as_ref().err().map(|error| format!("{}: {error}", path.display()));
    card.observe(Law::Readable, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
    tree.ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use enfilade_dataset::hdf5::{Storage, write_array};
    use enfilade_dataset::{Array, Elements, FrameInfo, FrameTime, ManifestInfo, write_bytes};
    use enfilade_frame::{Layer, f16};
    use enfilade_scene::{Intrinsics, Quiet};

    fn verify(dataset: &Dataset) -> VerifyReport {
        verify_dataset(dataset, &["room".to_string()], &Quiet).unwrap()
    }

    /// The laws that fail after `change`, and the card.
    fn failures(change: impl Fn(&Dataset)) -> (Vec<Law>, String) {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testing::dataset(folder.path());
        change(&dataset);
        let report = verify(&dataset);
        (report.failures().map(|law| law.law).collect(), report.to_text())
    }

    /// Writes the manifest anew, so that it agrees with what was changed on purpose.
    fn refresh(dataset: &Dataset) {
        dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    }

    #[test]
    fn a_good_dataset_passes_and_every_law_was_checked() {
        let folder = tempfile::tempdir().unwrap();
        let report = verify(&testing::dataset(folder.path()));
        assert!(report.passed, "{}", report.to_text());
        assert_eq!((report.frames, report.scenes), (2, 1));
        assert_eq!(report.laws.len(), super::super::LAWS.len());
        assert!(report.to_text().ends_with("laws hold over 2 frames of 1 scene\n"));
    }

    #[test]
    fn reports_do_not_depend_on_the_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testing::dataset(folder.path());
        let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| verify(&dataset));
        assert_eq!(with(1), with(7));
    }

    #[test]
    fn damaged_changed_and_missing_files_are_found() {
        let damage = |d: &Dataset| write_bytes(&d.layout().layer("room", "cam_00", 1, Layer::TexCoord), b"not hdf5").unwrap();
        let (laws, text) = failures(damage);
        // A file of another length also makes the frame incomplete, so that its layers are not looked at.
        assert_eq!(laws, [Law::FramesComplete, Law::Checksums], "{text}");
        assert!(text.contains("frame.0001.tex_coord.hdf5"), "{text}");
        let (laws, text) = failures(|d| std::fs::remove_file(d.layout().manifest()).unwrap());
        assert_eq!(laws, [Law::Manifest], "{text}");
        let (laws, _) = failures(|d| std::fs::remove_file(d.layout().frame_record("room", "cam_00", 1)).unwrap());
        assert_eq!(laws, [Law::FramesComplete]);
        let (laws, _) = failures(|d| std::fs::remove_file(d.layout().mesh_file("room", "mesh_objects_si.hdf5")).unwrap());
        assert_eq!(laws, [Law::LabelTables]);
        let (laws, text) = failures(|d| {
            let path = d.layout().layer("room", "cam_00", 1, Layer::TexCoord);
            let length = std::fs::metadata(&path).unwrap().len() as usize;
            write_bytes(&path, vec![0; length]).unwrap();
        });
        assert_eq!(laws, [Law::Readable, Law::LayersPresent, Law::Checksums], "{text}");
        let (laws, _) = failures(|d| write_bytes(&d.layout().metadata_nodes("room"), "node_id,node_name,object_id,object_name\n").unwrap());
        assert_eq!(laws, [Law::EntityIds, Law::SemanticJoin, Law::InstanceJoin]);
        let swapped = "node_id,node_name,object_id,object_name\n2,a,0,a\n1,b,1,b\n3,c,2,c\n";
        let (laws, text) = failures(|d| write_bytes(&d.layout().metadata_nodes("room"), swapped).unwrap());
        assert!(laws.contains(&Law::Nodes) && text.contains("node_id is 2, expected 1"), "{text}");
        let (laws, text) = failures(|d| write_bytes(&d.layout().octomap("room"), b"# not a tree").unwrap());
        assert_eq!(laws, [Law::Readable]);
        assert!(text.contains("octomap.bt"), "{text}");
        let unlabelled = |d: &Dataset| {
            for name in [Layer::Semantic, Layer::SemanticInstance] {
                std::fs::remove_file(d.layout().layer("room", "cam_00", 0, name)).unwrap();
            }
            refresh(d);
        };
        assert_eq!(failures(unlabelled).0, [Law::LayersPresent]);
    }

    #[test]
    fn a_scene_on_two_sides_of_the_split_is_found() {
        let torn = |d: &Dataset| {
            let mut rows = d.read_split().unwrap();
            rows[1].partition = Ok(Partition::Val);
            d.write_split(&rows).unwrap();
        };
        let (laws, text) = failures(torn);
        assert_eq!(laws, [Law::SplitWhole], "{text}");
    }

    #[test]
    fn layers_of_another_type_are_found() {
        let half = |d: &Dataset| {
            let path = d.layout().layer("room", "cam_00", 0, Layer::DepthMeters);
            let depth = read_array(&path).unwrap();
            let Elements::F32(values) = depth.values else { panic!("depth is float32") };
            let values = Elements::F16(values.into_iter().map(f16::from_f32).collect());
            write_array(&path, &Array { values, ..depth }, Storage::Compressed, &[]).unwrap();
            // Without records a frame counts when it has files, as in Hypersim's own data.
            std::fs::remove_dir_all(d.layout().records_dir("room", "cam_00")).unwrap();
            refresh(d);
        };
        let (laws, text) = failures(half);
        assert_eq!(laws, [Law::Readable, Law::FramesComplete, Law::LayersPresent], "{text}");
        assert!(text.contains("frame.0000.depth_meters.hdf5: expected an image of 1 channels of F32"), "{text}");
    }

    #[test]
    fn poses_calibration_and_free_space_are_checked_against_the_frames() {
        let replanned = |d: &Dataset| {
            let mut trajectory = d.read_trajectory("room", "cam_00").unwrap();
            trajectory.poses[1].frame = 2;
            d.write_trajectory("room", &trajectory, &testing::intrinsics().into(), None).unwrap();
            refresh(d);
        };
        assert_eq!(failures(replanned).0, [Law::FramesComplete, Law::FrameNumbers]);
        let wall = |d: &Dataset| {
            let tree = OccupancyTree::new(0.1);
            d.write_free_space("room", &tree.to_bt(), enfilade_math::DVec3::ZERO, enfilade_math::DVec3::ZERO).unwrap();
        };
        let (laws, text) = failures(wall);
        assert_eq!(laws, [Law::FreeCamera]);
        assert!(text.contains("room/cam_00/frame.0000: [0.300, -3.000, 1.500] m is Unknown"), "{text}");
        let recorded_elsewhere = |d: &Dataset| {
            let record = d.frame_record("room", "cam_00", 1).unwrap().unwrap();
            let mut pose = record.pose.to_pose(1);
            pose.position.x += 1e-6;
            let frame = testing::frame(&pose);
            let info =
                FrameInfo { seed: 1, samples: 1, config_hash: "test".into(), pose, camera: testing::intrinsics().into(), sampling: None };
            d.write_frame("room", "cam_00", &frame, &info, FrameTime::default()).unwrap();
            refresh(d);
        };
        assert_eq!(failures(recorded_elsewhere).0, [Law::RenderedPose]);
        let other_lens = |d: &Dataset| {
            let k = Intrinsics { fx: testing::intrinsics().fx + 1e-5, ..testing::intrinsics() };
            d.write_camera_parameters("room", &k.into()).unwrap();
        };
        assert_eq!(failures(other_lens).0, [Law::Calibration]);
    }

    #[test]
    fn frames_that_failed_are_named_with_their_reason() {
        let failed = |d: &Dataset| {
            std::fs::remove_file(d.layout().frame_record("room", "cam_00", 0)).unwrap();
            let failed_frames = [(("room".to_string(), "cam_00".to_string(), 0), "disk full".to_string())].into();
            let info = ManifestInfo { failed_frames, ..ManifestInfo::default() };
            d.write_manifest(&d.collect_manifest(&info).unwrap()).unwrap();
        };
        let (laws, text) = failures(failed);
        assert_eq!(laws, [Law::FramesComplete]);
        assert!(text.contains("room/cam_00/frame.0000: disk full"), "{text}");
        let none = |d: &Dataset| {
            (0..2).for_each(|i| std::fs::remove_file(d.layout().frame_record("room", "cam_00", i)).unwrap());
            refresh(d);
        };
        let (laws, text) = failures(none);
        assert_eq!(laws, [Law::FramesComplete, Law::HasFrames]);
        assert!(text.contains("nothing was verified"), "{text}");
    }
}
