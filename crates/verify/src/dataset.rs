//! Verification of a dataset on disk.

use super::card::Card;
use super::frame_values::FrameValues;
use super::law::Law;
use super::many_views::Listed;
use super::not_judged::NotJudged;
use super::read::{SceneLabels, Stored, check_mesh, read_frame, read_labels, read_tree, readable};
use super::relations;
use super::release::{self, Excused};
use super::report::VerifyReport;
use super::scan::Scan;
use super::sensed;
use super::trajectory::PlanRules;
use super::two_views::{self, PairValues, Sight};
use super::walk::{self, Walls};
use super::whole;
use super::worth;
use super::{View, boxes, camera_files, check_frame, check_trajectory, described, fixtures, plane_ids, rooms, surfaces};
use enfilade_dataset::{
    BodyPlaces, BoxKind, ColorKind, Dataset, DatasetError, FilmedBodies, FrameRecord, InstanceView, Manifest, MeshGeometry, StereoRecord,
    StereoSide, loader_problem,
};
use enfilade_explore::WalkBoxes;
use enfilade_frame::{LAYERS, Layer};
use enfilade_geometry::OccupancyTree;
use enfilade_scene::{Camera, CameraView, Counted, Cx, DEFORM, NYU40, Pose, Rooms, Trajectory};
use std::collections::BTreeMap;

/// Checks every law of a scene; [`join_reports`](super::join_reports) adds the laws of the dataset as a whole. Unreadable files count as
/// violations, not as errors.
///
/// Frames are read in parallel, at most two per thread at a time; the report is the same for every number of threads.
///
/// # Errors
/// When the manifest cannot be read.
pub fn verify_scene(dataset: &Dataset, scene: &str, cx: &dyn Cx) -> Result<VerifyReport, DatasetError> {
    Ok(verify_listed_scene(dataset, dataset.read_manifest()?.as_ref(), scene, &NotJudged::default(), cx))
}

/// [`verify_scene`] with the dataset's manifest, which takes long to read if there are many scenes, and without files that are
/// `not_judged`.
pub fn verify_listed_scene(
    dataset: &Dataset,
    manifest: Option<&Manifest>,
    scene: &str,
    not_judged: &NotJudged,
    cx: &dyn Cx,
) -> VerifyReport {
    let mut card = Card::default();
    if !dataset.is_released(scene) {
        whole::check_manifest(&mut card, dataset, manifest, scene);
    }
    let facts = SceneFacts::read(dataset, scene, not_judged, &mut card);
    facts.check(dataset, &mut card);
    let frames: Vec<(&Filmed, usize)> = facts.frames().collect();
    let counted = Counted::new(cx, "frames", frames.len());
    let check = |&(filmed, index): &(&Filmed, usize)| counted.unit(|| facts.check_frame(dataset, filmed, index));
    let found: Vec<Found> = enfilade_parallel::map(&frames, check);
    facts.check_relations(dataset, &mut card);
    let unchecked = facts.check_sensed(dataset, &mut card);
    let (mut values, mut pairs, mut excused) = (Vec::new(), Vec::new(), Vec::new());
    for frame in found {
        card.merge(frame.card);
        excused.extend(frame.excused);
        values.extend(frame.values);
        pairs.extend(frame.pairs);
    }
    worth::check_light(scene, &values, &mut card);
    if facts.released {
        excused.extend(release::excuse(&mut card));
    }
    let notes = facts
        .camera_notes()
        .chain(facts.note_of_deforming())
        .chain(note_of_what_is_gone(dataset, &values))
        .chain(unchecked)
        .chain(not_judged.note(scene))
        .collect();
    VerifyReport::new(&card, 1, values, pairs, excused).with_notes(notes)
}

/// Laws that cannot be checked where what was rendered was not kept beside what is denoised.
fn note_of_what_is_gone(dataset: &Dataset, values: &[FrameValues]) -> Option<String> {
    let is_denoised = |frame: &FrameValues| frame.color.as_ref().is_some_and(|color| color.starts_with("denoised"));
    let is_gone =
        |frame: &&FrameValues| is_denoised(frame) && !dataset.has_layer(&frame.scene, &frame.camera, frame.frame, Layer::ColorRendered);
    values.iter().find(is_gone).map(|_| {
        "some frames keep only denoised color (keep_rendered = false): standard errors, light in parts and saturation belong to what was \
         rendered, so the laws standard_error and light_splits were not checked there, and reason_codes only in part"
            .into()
    })
}

/// Checks the laws about single frames as soon as they are finished, on a machine that has no other data.
pub struct FrameVerifier(SceneFacts);

impl FrameVerifier {
    /// For frames of a scene whose tables and trajectories are there. What is wrong with these is left to [`verify_scene`].
    pub fn new(dataset: &Dataset, scene: &str) -> Self {
        Self(SceneFacts::read(dataset, scene, &NotJudged::default(), &mut Card::default()))
    }

    /// The statements of the laws that a frame breaks; normally none.
    pub fn broken_laws(&self, dataset: &Dataset, camera: &str, frame: u32) -> Vec<&'static str> {
        let Some(filmed) = self.0.filmed.iter().find(|filmed| filmed.trajectory.name == camera) else { return Vec::new() };
        let Some(index) = filmed.trajectory.poses.iter().position(|pose| pose.frame == frame) else { return Vec::new() };
        self.0.check_frame(dataset, filmed, index).card.failures().iter().map(|law| law.spec().statement).collect()
    }
}

/// The findings about one frame.
#[derive(Default)]
struct Found {
    card: Card,
    values: Option<FrameValues>,
    pairs: Vec<PairValues>,
    excused: Vec<Excused>,
}

/// Everything about a scene that its frames are checked against.
struct SceneFacts {
    name: String,
    /// True for Hypersim's release.
    released: bool,
    meters_per_unit: f64,
    /// By entity: true if it is partly transparent.
    partly_there: Vec<bool>,
    labels: Option<SceneLabels>,
    boxes: Vec<(BoxKind, boxes::Boxes)>,
    /// Rooms of scenes that have them and whose classes are NYU40's.
    rooms: Option<Rooms>,
    filmed: Vec<Filmed>,
    /// Files of products that are out of date.
    not_judged: NotJudged,
}

/// A trajectory, what it was filmed with, and the numbers of the frames that are there.
struct Filmed {
    /// With rotations as orientations.
    trajectory: Trajectory,
    /// The trajectory with the stored orientations.
    stored: Trajectory,
    frames: Vec<u32>,
    camera: Option<Camera>,
    /// What its frames show of instances, if there is a table of it.
    views: Option<Vec<InstanceView>>,
    /// Record of the other camera of a stereo rig.
    stereo: Option<StereoRecord>,
    rules: PlanRules,
    /// What moves in the scene, in the frames of the camera.
    bodies: Option<FilmedBodies>,
}

impl Filmed {
    /// Where what moves is in a frame.
    fn places(&self, frame: u32) -> BodyPlaces<'_> {
        self.bodies.as_ref().map_or_else(BodyPlaces::default, |bodies| bodies.at(frame))
    }
}

impl SceneFacts {
    /// Reads them. Unreadable files are added to the card.
    fn read(dataset: &Dataset, name: &str, not_judged: &NotJudged, card: &mut Card) -> Self {
        let nodes = dataset.read_nodes(name);
        // Parts of archives are often downloaded without tables.
        let left_out = dataset.is_released(name) && nodes.as_ref().is_err_and(DatasetError::is_not_found);
        let problem = nodes.as_ref().err().filter(|_| !left_out).map(ToString::to_string);
        card.observe(Law::Nodes, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
        let nodes = nodes.unwrap_or_default();
        let labels = read_labels(dataset, name, &nodes, card);
        let is_judged = !not_judged.has(&dataset.layout().rooms(name));
        let rooms = if is_judged { readable(card, dataset.read_rooms(name)).flatten() } else { None };
        Self {
            name: name.to_string(),
            released: dataset.is_released(name),
            meters_per_unit: readable(card, dataset.meters_per_asset_unit(name)).unwrap_or(1.0),
            partly_there: nodes.iter().map(|node| node.is_partly_there).collect(),
            rooms: rooms.filter(|_| labels.as_ref().is_some_and(|labels| labels.last_class == NYU40.len() as i16)),
            labels,
            boxes: boxes::read_boxes(dataset, name, card),
            filmed: read_filmed(dataset, name, card),
            not_judged: not_judged.clone(),
        }
    }

    /// Checks the laws that concern no single frame.
    fn check(&self, dataset: &Dataset, card: &mut Card) {
        let name = &self.name;
        self.filmed.iter().filter_map(|f| Some((f, f.camera.as_ref()?))).for_each(|(f, camera)| {
            self.check_matrices(dataset, camera, card);
            camera_files::check(dataset, name, &f.trajectory, camera, card);
        });
        let tree = read_tree(dataset, name, card);
        self.check_trajectories(dataset, tree.as_ref(), card);
        let mesh = check_mesh(dataset, name, card);
        boxes::check_boxes(&self.boxes, name, card);
        self.check_walks(mesh.as_ref(), tree.as_ref(), card);
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

    fn check_trajectories(&self, dataset: &Dataset, tree: Option<&OccupancyTree>, card: &mut Card) {
        let name = &self.name;
        let rendered: usize = self.filmed.iter().map(|filmed| filmed.frames.len()).sum();
        card.observe(Law::HasFrames, if rendered == 0 { 1.0 } else { 0.0 }, || format!("{name}: no rendered frame"));
        let (mut planned, mut faults) = (0, BTreeMap::new());
        for filmed in &self.filmed {
            let Filmed { trajectory, stored, frames, camera, rules, .. } = filmed;
            let place = format!("{name}/{}", trajectory.name);
            card.merge(check_trajectory(stored, rules, &place));
            let rejected = readable(card, dataset.rejected_views(name, &trajectory.name)).unwrap_or_default();
            planned += trajectory.poses.len();
            rejected.values().for_each(|fault| *faults.entry(fault.gate.clone()).or_default() += 1);
            let there = |frame: &u32| frames.contains(frame) || rejected.contains_key(frame);
            let missing: Vec<u32> = trajectory.poses.iter().map(|pose| pose.frame).filter(|frame| !there(frame)).collect();
            card.observe(Law::FramesComplete, missing.len() as f64, || format!("{place}: frames {missing:?} are missing"));
            for pose in trajectory.poses.iter().filter(|pose| !rejected.contains_key(&pose.frame)) {
                self.check_record(dataset, &trajectory.name, camera.as_ref(), pose, card);
                if let Some(tree) = tree {
                    let state = tree.state(pose.position);
                    let at = || format!("{place}/frame.{:04}: {:.3} m is {state:?}", pose.frame, pose.position);
                    card.observe(Law::FreeCamera, if rules.may_stand_in(state, pose.frame) { 0.0 } else { 1.0 }, at);
                }
            }
        }
        worth::check_views(name, planned, &faults, card);
    }

    /// A note on parts that the laws of two frames leave out; `None` where there are none.
    fn note_of_deforming(&self) -> Option<String> {
        let bodies = self.filmed.iter().find_map(|filmed| filmed.bodies.as_ref())?;
        let deforming: Vec<&str> = bodies.bodies.iter().filter(|body| body.joint == DEFORM).map(|body| body.name.as_str()).collect();
        let (first, count) = (deforming.first()?, deforming.len());
        Some(format!("{}: {count} parts deform, the first is {first:?}; their points are not compared between frames", self.name))
    }

    /// Notes on how Hypersim's loaders treat the cameras; they expect its own cameras.
    fn camera_notes(&self) -> impl Iterator<Item = String> {
        let cameras = self.filmed.iter().filter(|_| !self.released).filter_map(|filmed| filmed.camera.as_ref());
        cameras.filter_map(loader_problem)
    }

    /// The laws of walks, for which the scene's mesh is needed.
    fn check_walks(&self, mesh: Option<&MeshGeometry>, tree: Option<&OccupancyTree>, card: &mut Card) {
        let walks = self.filmed.iter().filter(|filmed| !filmed.rules.is_second);
        let walks: Vec<(&Filmed, &WalkBoxes)> = walks.filter_map(|filmed| Some((filmed, filmed.rules.walk.as_ref()?))).collect();
        if walks.is_empty() {
            return;
        }
        let walls = mesh.and_then(Walls::new);
        for (filmed, boxes) in walks {
            let place = format!("{}/{}", self.name, filmed.trajectory.name);
            card.merge(walk::check(&filmed.trajectory, boxes, walls.as_ref(), tree, &place));
        }
    }

    /// Checks the relations between frames, and between instances.
    fn check_relations(&self, dataset: &Dataset, card: &mut Card) {
        let cameras: Vec<&str> = self.filmed.iter().map(|filmed| filmed.trajectory.name.as_str()).collect();
        if !self.not_judged.has(&dataset.layout().instance_relations(&self.name)) {
            described::check(dataset, &self.name, card);
        }
        let listed = |camera: &str, number| self.listed(dataset, camera, number);
        relations::check(dataset, (&self.name, &cameras), &self.not_judged, &listed, card);
    }

    /// Checks the readings of sensors; returns notes on what could not be checked.
    fn check_sensed(&self, dataset: &Dataset, card: &mut Card) -> Vec<String> {
        let cameras = self.filmed.iter().filter_map(|filmed| Some((filmed.trajectory.name.as_str(), filmed.camera.as_ref()?)));
        sensed::check(dataset, &self.name, &cameras.collect::<Vec<_>>(), &self.not_judged, card)
    }

    /// A frame's distances, where it is there.
    fn listed<'a>(&'a self, dataset: &Dataset, camera: &str, number: u32) -> Option<Listed<'a>> {
        let filmed = self.filmed.iter().find(|filmed| filmed.trajectory.name == camera)?;
        let poses = &filmed.trajectory.poses;
        let index = poses.iter().position(|pose| pose.frame == number && filmed.frames.contains(&pose.frame))?;
        let view = CameraView::of_frame(filmed.camera.as_ref()?, poses, index);
        // Unreadable files are reported where that frame itself is checked.
        let layers = if filmed.bodies.is_some() { &[Layer::DepthMeters, Layer::RenderEntityId][..] } else { &[Layer::DepthMeters] };
        let (read, _) = read_frame(self.stored(dataset), camera, number, layers, &mut Card::default())?;
        let distances = read.get(Layer::DepthMeters).filter(|_| view.camera().size() == [read.width, read.height])?.clone();
        let moving = read.get(Layer::RenderEntityId).map(|parts| (parts.clone(), filmed.places(number)));
        let mut listed = Listed::new(view, distances);
        listed.moving = moving;
        Some(listed)
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
    fn frames(&self) -> impl Iterator<Item = (&Filmed, usize)> {
        self.filmed.iter().flat_map(move |filmed| {
            let poses = filmed.trajectory.poses.iter().enumerate();
            poses.filter(|(_, pose)| filmed.frames.contains(&pose.frame)).map(move |(index, _)| (filmed, index))
        })
    }

    /// Checks the frame of pose `index`, and how it agrees with its neighbours.
    fn check_frame(&self, dataset: &Dataset, filmed: &Filmed, index: usize) -> Found {
        let mut found = Found::default();
        let (name, poses) = (&filmed.trajectory.name, &filmed.trajectory.poses);
        let number = poses[index].frame;
        let place = format!("{}/{name}/frame.{number:04}", self.name);
        let all = LAYERS.map(|spec| spec.layer);
        let Some((frame, rounding)) = read_frame(self.stored(dataset), name, number, &all, &mut found.card) else {
            found.card.observe(Law::LayersPresent, LAYERS.len() as f64, || format!("{place}: no layer can be read"));
            return found;
        };
        let record: Option<FrameRecord> = dataset.frame_record(&self.name, name, number).ok().flatten();
        found.values = Some(FrameValues::new([&self.name, name], number, &frame, filmed.camera.as_ref(), record.as_ref()));
        let Some(camera) = &filmed.camera else { return found };
        let camera = CameraView::of_frame(camera, poses, index);
        let known = self.labels.as_ref();
        let view = View {
            camera,
            rounding,
            denoised: record.as_ref().is_some_and(|record| record.color == ColorKind::Denoised),
            released: self.released,
            entities: self.partly_there.len(),
            labels: known.map(|known| &known.labels),
            pieces: known.map_or(&[], |known| &known.pieces),
            last_class: known.map_or(NYU40.len() as i16, |known| known.last_class),
        };
        found.card.merge(check_frame(&frame, &view, &place));
        if !self.not_judged.has_of_frame(&dataset.layout().surfaces_dir(&self.name, name), number) {
            surfaces::check(dataset, [&self.name, name], number, &frame, &view, &mut found.card);
        }
        let fixtures = record.as_ref().map_or(0, FrameRecord::fixtures);
        if fixtures > 0 {
            let mut scan = Scan::new(&frame, &view, &place);
            found.card.merge(fixtures::check(dataset, [&self.name, name], number, fixtures, &mut scan));
            found.card.merge(scan.card);
        }
        boxes::check_positions(&self.boxes, &frame, (&view, filmed.places(number)), &place, &mut found.card);
        if let Some(rooms) = &self.rooms {
            rooms::check(rooms, &frame, &place, &mut found.card);
            if !self.not_judged.has(&dataset.layout().plane_ids(&self.name, name, number)) {
                plane_ids::check(dataset, [&self.name, name], number, rooms, &frame, &mut found.card);
            }
        }
        if let Some(views) = &filmed.views {
            boxes::check_views(views, &frame, number, &place, &mut found.card);
        }
        let sight = Sight { frame: &frame, view: camera, rounding, partly_there: &self.partly_there, places: filmed.places(number) };
        for (other, there) in self.neighbours(filmed, index) {
            let mut card = Card::default();
            found.pairs.extend(self.compare(dataset, (name, &sight), (other, there), &mut card));
            let off = other.stored.poses[there].orthonormality_error();
            if self.released && off > release::STRETCHED {
                found.excused.extend(release::excuse_stretched(&mut card, off));
            }
            found.card.merge(card);
        }
        let off = filmed.stored.poses[index].orthonormality_error();
        if self.released && off > release::STRETCHED {
            found.excused.extend(release::excuse_stretched(&mut found.card, off));
        }
        found
    }

    fn stored<'a>(&'a self, dataset: &'a Dataset) -> Stored<'a> {
        Stored { dataset, scene: &self.name, meters_per_unit: self.meters_per_unit, released: self.released }
    }

    /// The frames that a frame is compared with: the next one of its trajectory, and for the left camera of a stereo rig the right one's.
    fn neighbours<'a>(&'a self, filmed: &'a Filmed, index: usize) -> impl Iterator<Item = (&'a Filmed, usize)> {
        let left = filmed.stereo.as_ref().filter(|stereo| stereo.side == StereoSide::Left);
        let partner = left.and_then(|stereo| self.filmed.iter().find(|other| other.trajectory.name == stereo.partner));
        let pairs = [Some((filmed, index + 1)), partner.map(|partner| (partner, index))];
        let there = |(filmed, index): &(&Filmed, usize)| {
            filmed.trajectory.poses.get(*index).is_some_and(|pose| filmed.frames.contains(&pose.frame))
        };
        pairs.into_iter().flatten().filter(there)
    }

    /// Compares a frame of camera `name` with the frame of pose `index` of `other`.
    fn compare(
        &self,
        dataset: &Dataset,
        (name, sight): (&str, &Sight<'_>),
        (other, index): (&Filmed, usize),
        card: &mut Card,
    ) -> Option<PairValues> {
        let (partner, poses) = (&other.trajectory.name, &other.trajectory.poses);
        let number = poses[index].frame;
        // Unreadable files are reported where that frame itself is checked.
        let (frame, rounding) = read_frame(self.stored(dataset), partner, number, &two_views::COMPARED, &mut Card::default())?;
        let view = CameraView::of_frame(other.camera.as_ref()?, poses, index);
        let names = [(name, sight.view.pose().frame), (partner.as_str(), number)];
        let there = Sight { frame: &frame, view, rounding, partly_there: &self.partly_there, places: other.places(number) };
        two_views::compare(&self.name, names, [sight, &there], card)
    }
}

fn read_filmed(dataset: &Dataset, scene: &str, card: &mut Card) -> Vec<Filmed> {
    let mut filmed = Vec::new();
    for name in readable(card, dataset.cameras(scene)).unwrap_or_default() {
        let Some(trajectory) = readable(card, dataset.read_trajectory(scene, &name)) else { continue };
        let Some(stored) = readable(card, dataset.read_stored_trajectory(scene, &name)) else { continue };
        let frames = readable(card, dataset.frame_numbers(scene, &name)).unwrap_or_default();
        let camera = readable(card, dataset.read_camera(scene, &name));
        let views = boxes::there(dataset.read_instance_views(scene, &name)).and_then(|read| readable(card, read));
        let stereo = dataset.read_stereo(scene, &name).ok().flatten();
        // The plan of a rig is its left camera's.
        let second = stereo.as_ref().filter(|stereo| stereo.side == StereoSide::Right);
        let planned = dataset.layout().plan_report(scene, second.map_or(&name, |stereo| &stereo.partner));
        let rules = PlanRules { is_second: second.is_some(), ..PlanRules::of(&planned) };
        let bodies = readable(card, dataset.read_filmed_bodies(scene, &name)).flatten();
        filmed.push(Filmed { trajectory, stored, frames, camera, views, stereo, rules, bodies });
    }
    filmed
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::hdf5::{Storage, read_array, write_array};
    use enfilade_dataset::{Array, Elements, FrameInfo, FrameTime, JudgedView, ManifestInfo, Side, ViewFault, ViewVerdict, write_bytes};
    use enfilade_frame::f16;
    use enfilade_geometry::Voxel;
    use enfilade_label::rooms::write_planes;
    use enfilade_scene::Intrinsics;
    use enfilade_testroom as testroom;

    /// The laws that fail after `change`, and the card.
    fn failures(change: impl Fn(&Dataset)) -> (Vec<Law>, String) {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        change(&dataset);
        let report = verified(&dataset);
        (report.failures().map(|law| law.law).collect(), report.to_text())
    }

    /// Writes the manifest again, so that it agrees with what was changed on purpose.
    fn refresh(dataset: &Dataset) {
        dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default()).unwrap()).unwrap();
    }

    fn verified(dataset: &Dataset) -> VerifyReport {
        let report = super::verify_scene(dataset, "room", &enfilade_scene::Quiet).unwrap();
        crate::join_reports(dataset, vec![report])
    }

    #[test]
    fn a_good_dataset_passes_and_every_law_was_checked() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        sensed(&dataset);
        write_planes(&dataset, ["room", "cam_00"], &testroom::rooms(), &[0, 1], &enfilade_scene::Quiet).unwrap();
        let report = verified(&dataset);
        assert!(report.passed, "{}", report.to_text());
        assert_eq!((report.frames, report.scenes), (2, 1));
        assert_eq!(report.laws.len(), super::super::LAWS.len());
        assert!(report.to_text().contains("laws hold over 2 frames of 1 scene\n"));
    }

    #[test]
    fn black_frames_and_views_that_gates_reject_are_found_where_they_are_most() {
        let black = |dataset: &Dataset, frames: &[u32]| {
            for &frame in frames {
                let path = dataset.layout().layer("room", "cam_00", frame, Layer::Color);
                let color = read_array(&path).unwrap();
                let values = Elements::F16(vec![f16::ZERO; color.shape.iter().product()]);
                write_array(&path, &Array { values, ..color }, Storage::Compressed, &[]).unwrap();
            }
            // Without records a frame counts when it has files, however long they are.
            std::fs::remove_dir_all(dataset.layout().records_dir("room", "cam_00")).unwrap();
            refresh(dataset);
        };
        for (frames, is_found) in [(&[][..], false), (&[0], false), (&[0, 1], true)] {
            let (laws, text) = failures(|dataset| black(dataset, frames));
            assert_eq!(laws.contains(&Law::Lit), is_found, "{frames:?}: {text}");
        }
        let rejected = |frames: &[u32]| {
            let (laws, text) = failures(|dataset| {
                let view = |frame: u32| {
                    let fault = frames.contains(&frame).then(|| ViewFault { gate: "buried".into(), value: 1.0, limit: 0.5 });
                    let verdict = if fault.is_some() { ViewVerdict::Rejected } else { ViewVerdict::Passed };
                    (JudgedView { frame, verdict, fault }, Vec::new())
                };
                dataset.write_view_gates("room", "cam_00", &[], &[view(0), view(1)]).unwrap();
            });
            (laws.contains(&Law::Worthwhile), text)
        };
        assert!(!rejected(&[1]).0);
        let (is_found, text) = rejected(&[0, 1]);
        assert!(is_found && text.contains("room: 2 of 2 views: 2 buried"), "{text}");
    }

    /// Shows the frames to a sensor.
    fn sensed(dataset: &Dataset) {
        let sensors: enfilade_sensors::Sensors =
            serde_json::from_str(r#"{"time_of_flight": [{"name": "tof", "noise_m": 0.01, "step_m": 0.001}]}"#).unwrap();
        let chosen = enfilade_dataset::ChosenFrames { scenes: vec!["room".into()], ..Default::default() };
        assert_eq!(enfilade_sensors::sense(dataset, &sensors, &chosen, &enfilade_scene::Quiet).unwrap(), 2);
    }

    #[test]
    fn readings_of_sensors_that_are_not_of_their_frames_are_found() {
        let (laws, text) = failures(|dataset| {
            sensed(dataset);
            let path = |frame| dataset.layout().sensed("tof", ("room", "cam_00", frame), "depth_meters.hdf5");
            std::fs::copy(path(0), path(1)).unwrap();
        });
        assert_eq!(laws, [Law::Sensed], "{text}");
        assert!(text.contains("sensors/tof/room/cam_00/frame.0001"), "{text}");
        let (laws, text) = failures(|dataset| {
            sensed(dataset);
            std::fs::rename(dataset.layout().sensor_dir("tof"), dataset.layout().sensor_dir("other")).unwrap();
        });
        assert_eq!(laws, [Law::Sensed], "{text}");
    }

    #[test]
    fn rooms_of_another_scene_are_found() {
        let (laws, text) = failures(|dataset| {
            let mut rooms = testroom::rooms();
            rooms.walls[2].from[1] += 0.1;
            dataset.write_rooms("room", &rooms).unwrap();
        });
        assert_eq!(laws, [Law::LayoutPlanes], "{text}");
        let (laws, _) = failures(|dataset| write_bytes(&dataset.layout().rooms("room"), "{}").unwrap());
        assert!(laws.contains(&Law::Readable), "{laws:?}");
    }

    #[test]
    fn what_cannot_be_checked_without_what_was_rendered_is_noted() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let is_noted = || verified(&dataset).notes.iter().any(|note| note.contains("keep_rendered = false"));
        assert!(!is_noted());
        let layers = enfilade_frame::DENOISED.map(|(layer, _)| layer);
        for frame in 0..2 {
            let denoised = dataset.read_frame("room", "cam_00", frame, &layers).unwrap();
            dataset.write_denoised(["room", "cam_00"], frame, &denoised, ["Smoother 3.1", "test"], false).unwrap();
        }
        refresh(&dataset);
        assert!(is_noted());
    }

    #[test]
    fn reports_do_not_depend_on_the_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| verified(&dataset));
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
        assert_eq!(laws, [Law::EntityIds, Law::SemanticJoin, Law::InstanceJoin, Law::RaySurfaces]);
        let swapped = "node_id,node_name,object_id,object_name\n2,a,0,a\n1,b,1,b\n3,c,2,c\n";
        let (laws, text) = failures(|d| write_bytes(&d.layout().metadata_nodes("room"), swapped).unwrap());
        assert!(laws.contains(&Law::Nodes) && text.contains("node_id is 2, expected 1"), "{text}");
        let (laws, text) = failures(|d| write_bytes(&d.layout().octomap("room"), b"# not a tree").unwrap());
        assert_eq!(laws, [Law::Readable]);
        assert!(text.contains("octomap.bt"), "{text}");
        let meshless = |d: &Dataset| std::fs::remove_file(d.layout().mesh_file("room", "mesh_normals.hdf5")).unwrap();
        let (laws, text) = failures(meshless);
        assert_eq!(laws, [Law::Readable]);
        assert!(text.contains("mesh_normals.hdf5"), "{text}");
        let nameless = |d: &Dataset| write_bytes(&d.layout().mesh_file("room", "metadata_objects.csv"), "object_name\n").unwrap();
        assert_eq!(failures(nameless).0, [Law::Readable]);
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
            let mut rows = d.read_partition().unwrap();
            rows[1].side = Ok(Side::Val);
            d.write_partition(&rows).unwrap();
        };
        let (laws, text) = failures(torn);
        assert_eq!(laws, [Law::PartitionWhole], "{text}");
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
        // They are looked at nevertheless, and are not as exact as they should be.
        assert_eq!(
            laws,
            [Law::Readable, Law::FramesComplete, Law::ExtraLayers, Law::Distance, Law::PlanarDepth, Law::RaySurfaces],
            "{text}"
        );
        assert!(text.contains("frame.0000.depth_meters.hdf5: expected an image of 1 channels of F32"), "{text}");
    }

    #[test]
    fn poses_calibration_and_free_space_are_checked_against_the_frames() {
        let replanned = |d: &Dataset| {
            let mut trajectory = d.read_trajectory("room", "cam_00").unwrap();
            trajectory.poses[1].frame = 2;
            d.write_trajectory("room", &trajectory, &testroom::intrinsics().into(), None).unwrap();
            refresh(d);
        };
        assert_eq!(failures(replanned).0, [Law::FramesComplete, Law::FrameNumbers]);
        let wall = |d: &Dataset| {
            let tree = OccupancyTree::new(0.1);
            d.write_free_space("room", &tree.to_bt(), enfilade_math::DVec3::ZERO, enfilade_math::DVec3::ZERO).unwrap();
        };
        let (laws, text) = failures(wall);
        assert_eq!(laws, [Law::FreeTarget, Law::FreeCamera]);
        assert!(text.contains("room/cam_00/frame.0000: [0.300, -3.000, 1.500] m is Unknown"), "{text}");
        let recorded_elsewhere = |d: &Dataset| {
            let record = d.frame_record("room", "cam_00", 1).unwrap().unwrap();
            let mut pose = record.pose.to_pose(1);
            pose.position.x += 1e-6;
            let frame = testroom::frame(&pose);
            let info = FrameInfo {
                seed: 1,
                samples: 1,
                config_hash: "test".into(),
                pose,
                camera: testroom::intrinsics().into(),
                sampling: None,
                recipe: None,
            };
            d.write_frame("room", "cam_00", &frame, &info, FrameTime::default()).unwrap();
            refresh(d);
        };
        assert_eq!(failures(recorded_elsewhere).0, [Law::RenderedPose]);
        let other_lens = |d: &Dataset| {
            let k = Intrinsics { fx: testroom::intrinsics().fx + 1e-5, ..testroom::intrinsics() };
            d.write_camera_parameters("room", &k.into()).unwrap();
        };
        assert_eq!(failures(other_lens).0, [Law::Calibration]);
    }

    #[test]
    fn given_poses_may_stand_in_a_wall_and_planned_ones_may_not() {
        let in_a_wall = |report: &'static str, frame: usize| {
            let wall = move |d: &Dataset| {
                write_bytes(&d.layout().plan_report("room", "cam_00"), report).unwrap();
                let free = d.read_trajectory("room", "cam_00").unwrap().poses[1 - frame].position;
                let mut tree = OccupancyTree::new(0.1);
                tree.set(tree.key(free).unwrap(), Voxel::Free);
                d.write_free_space("room", &tree.to_bt(), free, free).unwrap();
            };
            failures(wall).0
        };
        let preset = r#"{"mode": "walk", "roll_limit_deg": null}"#;
        assert_eq!([in_a_wall(preset, 0), in_a_wall(preset, 1)], [vec![], vec![Law::FreeCamera]]);
        let by_hand = r#"{"mode": "keyframes", "roll_limit_deg": null}"#;
        assert_eq!([in_a_wall(by_hand, 0), in_a_wall(by_hand, 1)], [vec![], vec![]]);
        assert_eq!(in_a_wall(r#"{"mode": "walk", "roll_limit_deg": 5.0}"#, 0), [Law::FreeCamera]);
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
