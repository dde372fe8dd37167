//! The selection to export: the chosen frames of the dataset, with their cameras, and their layers when they are asked for.

use crate::{ExportError, Format, FormatSpec};
use enfilade_dataset::{Dataset, DatasetError, Side, Window, turn_planar_depth};
use enfilade_frame::{Frame, LAYERS, Layer};
use enfilade_scene::{Camera, CameraView, Counted, Cx, Labels, Pose, Rooms, Warning};
use std::collections::BTreeMap;
use std::ops::Range;

/// The part of a dataset to export.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Names of scenes of the dataset.
    pub scenes: Vec<String>,
    /// Names of cameras; `None`: all.
    pub cameras: Option<Vec<String>>,
    /// Frame numbers, the upper bound excluded; `None`: all.
    pub frames: Option<Range<u32>>,
    /// Layers to use; `None`: all that the format can store.
    pub layers: Option<Vec<Layer>>,
}

/// A camera of a scene with the frames that are exported.
pub(crate) struct Track {
    pub scene: String,
    /// Name of the camera.
    pub name: String,
    pub camera: Camera,
    /// Poses of the whole trajectory.
    pub poses: Vec<Pose>,
    /// Indices into `poses` of the frames that are exported.
    pub chosen: Vec<usize>,
}

/// One frame that is exported.
#[derive(Clone, Copy)]
pub(crate) struct View<'s> {
    pub track: &'s Track,
    /// Index of its pose.
    pub index: usize,
}

/// The chosen frames, by scene, camera and number.
pub(crate) struct SelectedFrames<'d> {
    pub dataset: &'d Dataset,
    pub tracks: Vec<Track>,
    format: Format,
    layers: Vec<Layer>,
    cx: &'d dyn Cx,
}

impl Track {
    /// `<scene>/<camera>`: folder of the track's files in most formats.
    pub fn folder(&self) -> String {
        format!("{}/{}", self.scene, self.name)
    }

    /// The frames that are exported.
    pub fn views(&self) -> impl Iterator<Item = View<'_>> {
        self.chosen.iter().map(|&index| View { track: self, index })
    }
}

impl<'s> View<'s> {
    /// `<camera>_<IIII>`: its name if frames of all cameras of a scene are in one folder.
    pub fn file_stem(&self) -> String {
        format!("{}_{:04}", self.track.name, self.frame())
    }

    /// Frame number.
    pub fn frame(&self) -> u32 {
        self.pose().frame
    }

    /// Pose of the camera.
    pub fn pose(&self) -> &'s Pose {
        &self.track.poses[self.index]
    }

    /// The camera at the moment of the frame.
    pub fn camera(&self) -> CameraView<'s> {
        CameraView::of_frame(&self.track.camera, &self.track.poses, self.index)
    }

    /// For messages.
    pub fn name(&self) -> String {
        format!("{} frame {}", self.track.folder(), self.frame())
    }
}

impl<'d> SelectedFrames<'d> {
    /// Finds the chosen frames that have the layers that the format needs.
    pub fn open(dataset: &'d Dataset, spec: &FormatSpec, selection: &Selection, cx: &'d dyn Cx) -> Result<Self, ExportError> {
        let taken = |layer: &Layer| spec.takes.is_none_or(|takes| takes.contains(layer));
        let wanted = |layer: &Layer| selection.layers.as_ref().is_none_or(|layers| layers.contains(layer));
        let layers: Vec<Layer> = LAYERS.iter().map(|row| row.layer).filter(|layer| taken(layer) && wanted(layer)).collect();
        let mut selected = Self { dataset, tracks: Vec::new(), format: spec.format, layers, cx };
        for scene in &selection.scenes {
            for name in dataset.cameras(scene)? {
                if selection.cameras.as_ref().is_none_or(|names| names.contains(&name)) {
                    selected.tracks.extend(track(dataset, scene, &name, selection.frames.as_ref(), cx)?);
                }
            }
        }
        selected.check(spec, selection)?;
        if spec.needs_still {
            for scene in &selection.scenes {
                if dataset.moves(scene)? {
                    let problem = "things move in it, and the format has a world that stays as it is; take a format of single frames, such as \
                                   coco, bop or exr, or make it without motion";
                    return Err(selected.unsuitable(scene.clone(), problem));
                }
            }
        }
        selected.leave_out_incomplete(spec)?;
        Ok(selected)
    }

    /// Leaves out the frames that lack what the format needs, with a warning; an error where it is all of them.
    fn leave_out_incomplete(&mut self, spec: &FormatSpec) -> Result<(), ExportError> {
        let missing = |view: View<'_>| spec.needs.iter().find(|group| !group.iter().any(|&layer| self.has(view, layer)));
        let lacking: Vec<(String, usize, usize, String)> = (self.tracks.iter().enumerate())
            .flat_map(|(number, track)| track.views().map(move |view| (number, view)))
            .filter_map(|(number, view)| Some((view.name(), number, view.index, names(missing(view)?))))
            .collect();
        let Some((first, _, _, layer)) = lacking.first() else { return Ok(()) };
        if lacking.len() == self.views().count() {
            let problem = format!("it has no layer {layer}; make it (label, render), or leave the frame out");
            return Err(self.unsuitable(first.clone(), problem));
        }
        let others = if lacking.len() > 1 { format!(" and {} more are", lacking.len() - 1) } else { " is".into() };
        let message = format!("{first}{others} left out: no layer {layer}, which {} needs", spec.name);
        self.cx.warn(Warning { place: self.dataset.root().display().to_string(), message });
        for (_, number, index, _) in &lacking {
            self.tracks[*number].chosen.retain(|chosen| chosen != index);
        }
        self.tracks.retain(|track| !track.chosen.is_empty());
        Ok(())
    }

    fn check(&self, spec: &FormatSpec, selection: &Selection) -> Result<(), ExportError> {
        if let Some(group) = spec.needs.iter().find(|group| !group.iter().any(|layer| self.layers.contains(layer))) {
            return Err(ExportError::Selection(format!("{} needs the layer {}; add it to --layers", spec.name, names(group))));
        }
        if self.layers.is_empty() {
            let takes = spec.takes.map_or("any layer".into(), names);
            return Err(ExportError::Selection(format!("none of the layers of --layers can be in {}: it takes {takes}", spec.name)));
        }
        if self.tracks.is_empty() {
            let known = selection.scenes.iter().map(|scene| self.dataset.cameras(scene)).collect::<Result<Vec<_>, _>>()?.concat();
            let problem = "no finished frame is selected; widen --scene, --camera or --frames";
            return Err(ExportError::Selection(format!("{problem} (cameras here: {})", known.join(", "))));
        }
        Ok(())
    }

    /// All frames, in order.
    pub fn views(&self) -> impl Iterator<Item = View<'_>> {
        self.tracks.iter().flat_map(Track::views)
    }

    /// The tracks of each scene.
    pub fn scenes(&self) -> impl Iterator<Item = &[Track]> {
        self.tracks.chunk_by(|a, b| a.scene == b.scene)
    }

    /// True when the frame has the layer, or it can be computed, and it is not left out.
    pub fn has(&self, view: View<'_>, layer: Layer) -> bool {
        self.layers.contains(&layer) && self.dataset.gives_layer(&view.track.scene, &view.track.name, view.frame(), layer)
    }

    /// True when the frame has a file for the layer and it is not left out.
    pub fn stores(&self, view: View<'_>, layer: Layer) -> bool {
        self.layers.contains(&layer) && self.dataset.has_layer(&view.track.scene, &view.track.name, view.frame(), layer)
    }

    /// Reads the `wanted` layers that the frame has and that are not left out, as a frame; one of 0 × 0 pixels when there are none.
    pub fn read(&self, view: View<'_>, wanted: &[Layer]) -> Result<Frame, ExportError> {
        let there: Vec<Layer> = wanted.iter().copied().filter(|&layer| self.has(view, layer)).collect();
        if there.is_empty() {
            return Ok(Frame::new(0, 0));
        }
        let frame = self.dataset.read_frame(&view.track.scene, &view.track.name, view.frame(), &there)?;
        let ([width, height], found) = (view.track.camera.size(), [frame.width, frame.height]);
        if found != [width, height] {
            let problem =
                format!("its layers have {}x{} pixels, its camera {width}x{height}; plan and render it again", found[0], found[1]);
            return Err(self.unsuitable(view.name(), problem));
        }
        Ok(frame)
    }

    /// Every layer that the frame has and that is not left out, with planar depth along the axis of K; where it is stored, it is along the
    /// camera's own.
    pub fn read_all(&self, view: View<'_>) -> Result<Frame, ExportError> {
        let mut frame = self.read(view, &LAYERS.map(|spec| spec.layer))?;
        if frame.pixels() == 0 {
            return Err(self.unsuitable(view.name(), "it has none of the layers asked for; choose others with --layers"));
        }
        let stored = frame.get(Layer::DepthZMeters).filter(|_| self.stores(view, Layer::DepthZMeters)).cloned();
        if let Some(mut depth_z) = stored {
            let whole = Window { top: 0, left: 0, height: frame.height as usize, width: frame.width as usize };
            turn_planar_depth(&view.track.camera.projection, whole, &mut depth_z);
            frame.insert(Layer::DepthZMeters, depth_z);
        }
        Ok(frame)
    }

    /// Class and instance of every object of a scene; none where the dataset has no label tables (Hypersim's public files).
    pub fn labels(&self, scene: &str) -> Result<Labels, ExportError> {
        match self.dataset.read_label_tables(scene) {
            Err(error) if error.is_not_found() => Ok(Labels::default()),
            labels => Ok(labels?),
        }
    }

    /// Rooms, walls, doors and windows of a scene, for formats that are about these.
    pub fn rooms(&self, scene: &str) -> Result<Rooms, ExportError> {
        let unknown = || {
            let problem = "it has no _detail/layout.json, which generated homes come with";
            let remedy = format!(
                "`enfilade make {} rooms` makes it of scenes with labelled walls, floors and ceilings",
                self.dataset.root().display()
            );
            self.unsuitable(scene, format!("{problem}; {remedy}"))
        };
        self.dataset.read_rooms(scene)?.ok_or_else(unknown)
    }

    /// The side of the partition of every scene that is on one, by the first of its frames; none where the dataset has no partition.
    pub fn sides_of_scenes(&self) -> Result<BTreeMap<String, Side>, ExportError> {
        let rows = match self.dataset.read_partition() {
            Err(error) if DatasetError::is_not_found(&error) => Vec::new(),
            rows => rows?,
        };
        let mut sides = BTreeMap::new();
        for row in rows {
            if let Ok(side) = row.side {
                sides.entry(row.scene).or_insert(side);
            }
        }
        Ok(sides)
    }

    /// Does `work` for every frame, on all threads, and gives the results in the frames' order.
    pub fn each<T: Send>(&self, work: impl Fn(View<'_>) -> Result<T, ExportError> + Sync) -> Result<Vec<T>, ExportError> {
        self.each_of(&self.views().collect::<Vec<_>>(), work)
    }

    /// Works on some of the frames, as [`SelectedFrames::each`] does on all.
    pub fn each_of<T: Send>(
        &self,
        views: &[View<'_>],
        work: impl Fn(View<'_>) -> Result<T, ExportError> + Sync,
    ) -> Result<Vec<T>, ExportError> {
        self.each_counted(&self.counted(views.len()), views, work)
    }

    /// A counter of the given number of frames, none of them done.
    pub fn counted(&self, frames: usize) -> Counted<'d> {
        Counted::new(self.cx, "frames", frames)
    }

    /// Works on some of the frames, as [`SelectedFrames::each_of`] does, where these are not all that are counted.
    pub fn each_counted<T: Send>(
        &self,
        counted: &Counted<'_>,
        views: &[View<'_>],
        work: impl Fn(View<'_>) -> Result<T, ExportError> + Sync,
    ) -> Result<Vec<T>, ExportError> {
        enfilade_parallel::try_map(views, |&view| counted.unit(|| work(view)))
    }

    /// Warns the caller of something that is left out.
    pub fn warn(&self, warning: Warning) {
        self.cx.warn(warning);
    }

    /// An error of the dataset's content.
    pub fn unsuitable(&self, place: impl Into<String>, problem: impl Into<String>) -> ExportError {
        ExportError::Unsuitable { place: place.into(), format: self.format, problem: problem.into() }
    }
}

/// Names of layers of which one is enough.
fn names(layers: &[Layer]) -> String {
    layers.iter().map(|layer| layer.spec().name).collect::<Vec<_>>().join(" or ")
}

/// A camera with its finished frames within `range`, with a warning of those that have lost a file; `None` when there are none.
fn track(dataset: &Dataset, scene: &str, name: &str, range: Option<&Range<u32>>, cx: &dyn Cx) -> Result<Option<Track>, ExportError> {
    let finished = dataset.whole_frames([scene, name], range, cx)?;
    let poses = dataset.read_trajectory(scene, name)?.poses;
    let wanted = |pose: &Pose| finished.binary_search(&pose.frame).is_ok() && range.is_none_or(|range| range.contains(&pose.frame));
    let chosen: Vec<usize> = (0..poses.len()).filter(|&i| wanted(&poses[i])).collect();
    if chosen.is_empty() {
        return Ok(None);
    }
    let camera = dataset.read_camera(scene, name)?;
    Ok(Some(Track { scene: scene.into(), name: name.into(), camera, poses, chosen }))
}
