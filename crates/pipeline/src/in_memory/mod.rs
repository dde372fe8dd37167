//! A scene in memory, and pictures of it without a dataset: the work of `import`, `render`, `denoise` and `label`, without files between
//! them.
//!
//! A frame has the values that a run writes for the same scene, views, settings and seed, where the seed is the one in the frame's record.
//! The data for rays is prepared for the first picture and used for all others.

mod edits;

pub use edits::FilePlace;

use crate::assets;
use crate::config::{FileSource, LabelSource, Quality, RenderChoices};
use crate::error::Error;
use crate::intake::{self, Look, labelled};
use crate::look::{named_camera, place};
use crate::single::write_files;
use crate::stages::{FrameCx, add_extra, assign_table, describe};
use enfilade_dataset::ColorKind;
use enfilade_denoise::{Denoiser, denoise};
use enfilade_frame::{DENOISED, Frame, Layer, Values};
use enfilade_home::HomeConfig;
use enfilade_import::scene_name;
use enfilade_label::join;
use enfilade_render::{FrameRender, Guide, RenderConfig, RenderScene};
use enfilade_scene::{
    Camera, CameraView, Cx, EncodedScene, LabelledScene, Labels, PictureFiles, Pose, Scene, SceneError, StartCamera, Warning, WorldMesh,
};
use enfilade_show::planview::floor_plan_svg;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

self_cell::self_cell!(
    /// A scene with what rays need of it.
    struct Prepared {
        owner: Arc<LabelledScene>,
        #[covariant]
        dependent: RenderScene,
    }
);

/// A scene in memory. It is a value: [`LoadedScene::edited`] gives a new one, which shares what did not change.
pub struct LoadedScene {
    name: String,
    contents: Arc<LabelledScene>,
    warnings: Vec<Warning>,
    report: serde_json::Value,
    /// Made for the first picture, and again if a later one changes the option for Lambertian surfaces.
    prepared: Mutex<Option<(bool, Arc<Prepared>)>>,
    /// The view that was found on the first request.
    found: OnceLock<(StartCamera, String)>,
}

/// How pictures of a [`LoadedScene`] are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Transport.
    pub render: RenderConfig,
    /// Kind of the colour layers. Denoised frames have the rendered layers too.
    pub color: ColorKind,
}

impl Shot {
    /// A shot as a run makes it with this quality and these choices, except that the seed is used unchanged. A time limit is ignored.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn new(quality: Quality, choices: &RenderChoices, seed: u64) -> Result<Self, Error> {
        let (render, color) = quality.settings(choices)?;
        Ok(Self { render: RenderConfig { seed, ..render }, color })
    }
}

impl LoadedScene {
    /// Reads the file of `source` (its path is used unchanged), with the labels of a table (also a path) or the file's own.
    ///
    /// # Errors
    /// If the file cannot be imported, or the table cannot be read.
    pub fn read(source: &FileSource, labels: Option<&LabelSource>, cx: &dyn Cx) -> Result<Self, Error> {
        let file = Path::new(&source.file);
        let imported = intake::read(source, file, &|path| Ok(path.into()), cx)?;
        let report = serde_json::to_value(&imported.report).unwrap_or_default();
        let warnings = imported.report.warnings.clone();
        let mut contents = labelled(imported);
        if let Some(table) = labels {
            contents.labels = assign_table(Path::new(&table.table), &table.scene, &contents.scene, cx)?.0;
        }
        Ok(Self::new(scene_name(file), contents, warnings, report))
    }

    /// Makes the home of `config`; the paths of its libraries are used unchanged.
    ///
    /// # Errors
    /// When a library of models cannot be used, see [`HomeConfig::assets`].
    pub fn home(config: &HomeConfig, cx: &dyn Cx) -> Result<Self, Error> {
        let home = assets::home(config, &|path| Ok(path.into()), cx)?;
        let rooms = home.plan.rooms.iter().map(|room| {
            let (kind, area_m2) = (room.kind.name(), room.area);
            serde_json::json!({ "kind": kind, "area_m2": area_m2 })
        });
        let report = serde_json::json!({ "rooms": rooms.collect::<Vec<_>>(), "credits": home.credits });
        let contents = LabelledScene { scene: home.scene, labels: home.labels, picture_files: PictureFiles::new() };
        Ok(Self::new("home".into(), contents, Vec::new(), report))
    }

    fn new(name: String, contents: LabelledScene, warnings: Vec<Warning>, report: serde_json::Value) -> Self {
        Self { name, contents: Arc::new(contents), warnings, report, prepared: Mutex::default(), found: OnceLock::new() }
    }

    /// Name of the scene: the file's name without the extension of its format.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.contents.scene
    }

    /// The scene with its labels, to be shared.
    pub fn contents(&self) -> &Arc<LabelledScene> {
        &self.contents
    }

    /// Labels of its parts.
    pub fn labels(&self) -> &Labels {
        &self.contents.labels
    }

    /// Everything that was dropped, guessed or fixed.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The report of the import, or rooms and credits of a home.
    pub fn report(&self) -> &serde_json::Value {
        &self.report
    }

    /// One line about it.
    pub fn summary(&self) -> String {
        describe(self.scene())
    }

    /// The walls and everything else cut at two fifths of the scene's height, as a drawing in SVG of this many pixels across.
    pub fn plan_svg(&self, width: u32) -> String {
        floor_plan_svg(&WorldMesh::new(self.scene()), width)
    }

    /// The camera of that name; without a name, the view that `look` takes: a camera of the file that is in a room or sees something, else
    /// a place that is searched, which takes seconds the first time. Also returns which, in words.
    ///
    /// # Errors
    /// If there is no camera of that name, or nothing in the scene.
    pub fn view(&self, name: Option<&str>, cx: &dyn Cx) -> Result<(StartCamera, String), Error> {
        if let Some(name) = name {
            return named_camera(self.scene(), name).map(|camera| (camera.clone(), format!("camera {name:?} of the file")));
        }
        if let Some(found) = self.found.get() {
            return Ok(found.clone());
        }
        self.refuse_empty()?;
        let found = place(self.scene(), &Look::at(self.scene()), None, cx)?;
        Ok(self.found.get_or_init(|| found).clone())
    }

    /// Renders the views, which are the frames of one trajectory: light is learned from all of them, flow leads from one to the next, and
    /// their poses have ascending frame numbers. A frame has every layer that a run writes, labels included.
    ///
    /// # Errors
    /// When the scene has no parts, no light or too many parts, or a camera is not usable.
    pub fn render(&self, views: &[(Camera, Pose)], shot: &Shot, cx: &dyn Cx) -> Result<Vec<Frame>, Error> {
        let prepared = self.prepared(&shot.render, cx)?;
        let scene = prepared.borrow_dependent();
        let views: Vec<CameraView> = views.iter().map(|(camera, pose)| CameraView::still(camera, pose)).collect();
        cx.progress("learning where light comes from", 0, views.len() as u64);
        let guide = Guide::learn(scene, &views, &shot.render);
        let frame = |index: usize| {
            let frame_cx = FrameCx { outer: cx, done: index, total: views.len() };
            let mut rendering = FrameRender::new(scene, &guide, &views[index], &shot.render).map_err(Error::stage)?;
            while !rendering.is_done() {
                rendering.pass(&frame_cx);
            }
            let mut frame = rendering.frame();
            add_extra(scene, &views, index, &shot.render, &mut frame);
            self.finish(frame, shot.color)
        };
        (0..views.len()).map(frame).collect()
    }

    /// Denoises if requested, and joins the labels.
    fn finish(&self, mut frame: Frame, color: ColorKind) -> Result<Frame, Error> {
        if color == ColorKind::Denoised {
            let denoised = denoise(&frame, |noisy| Denoiser::built_in().filter(noisy)).map_err(Error::stage)?;
            for (plain, kept) in DENOISED {
                let rendered = frame.get(plain).cloned();
                rendered.into_iter().for_each(|values| frame.insert(kept, values));
            }
            denoised.iter().for_each(|(layer, values)| frame.insert(layer, values.clone()));
        }
        if let Some(Values::I16(ids)) = frame.get(Layer::RenderEntityId) {
            let (semantic, instance) = join(ids, self.labels()).map_err(Error::stage)?;
            frame.insert(Layer::Semantic, Values::I16(semantic));
            frame.insert(Layer::SemanticInstance, Values::I16(instance));
        }
        Ok(frame)
    }

    /// Writes the scene to `output`; `encode` returns its files and what they cannot represent.
    ///
    /// # Errors
    /// When the scene has no parts, or the file cannot be written.
    pub fn save(
        &self,
        output: &Path,
        encode: impl FnOnce(&Scene, Option<&Labels>, &PictureFiles) -> EncodedScene,
    ) -> Result<Vec<String>, Error> {
        self.refuse_empty()?;
        let LabelledScene { scene, labels, picture_files } = &*self.contents;
        write_files(output, encode(scene, Some(labels), picture_files).map_err(Error::Stage)?)
    }

    /// Refuses a scene without parts as its file would be.
    fn refuse_empty(&self) -> Result<(), Error> {
        if self.scene().parts.is_empty() { Err(Error::stage(SceneError::NoParts)) } else { Ok(()) }
    }

    fn prepared(&self, config: &RenderConfig, cx: &dyn Cx) -> Result<Arc<Prepared>, Error> {
        // One that was interrupted while it prepared has left nothing.
        let mut prepared = self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, prepared)) = prepared.as_ref().filter(|(lambertian, _)| *lambertian == config.lambertian) {
            return Ok(prepared.clone());
        }
        self.refuse_empty()?;
        let contents = self.contents.clone();
        let made = Prepared::try_new(contents, |contents| RenderScene::new(&contents.scene, cx).map(|ready| ready.settled(config)));
        let made = Arc::new(made.map_err(Error::stage)?);
        *prepared = Some((config.lambertian, made.clone()));
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_home::RoomKind;
    use enfilade_scene::{Intrinsics, Quiet};

    fn bathroom() -> LoadedScene {
        LoadedScene::home(&HomeConfig { rooms: vec![RoomKind::Bathroom], ..HomeConfig::default() }, &Quiet).unwrap()
    }

    #[test]
    fn what_rays_need_is_prepared_once_and_pictures_repeat() {
        let scene = bathroom();
        let (start, how) = scene.view(None, &Quiet).unwrap();
        assert_eq!(scene.view(None, &Quiet).unwrap(), (start.clone(), how));
        let view = (Camera::from(Intrinsics::from_fov_x(16, 12, start.fov_x_rad)), start.pose(0));
        let choices = RenderChoices { samples: Some(2), ..RenderChoices::default() };
        let shot = Shot::new(Quality::Draft, &choices, 7).unwrap();
        let [first, second] = [0, 1].map(|_| scene.render(std::slice::from_ref(&view), &shot, &Quiet).unwrap().remove(0));
        let rendered = |frame: &Frame| frame.iter().map(|(layer, values)| (layer, values.as_bytes().to_vec())).collect::<Vec<_>>();
        assert!(rendered(&first) == rendered(&second), "the same bytes");
        assert!(first.get(Layer::Semantic).is_some() && first.get(Layer::ColorRendered).is_some());
        let kept = scene.prepared(&shot.render, &Quiet).unwrap();
        assert!(Arc::ptr_eq(&kept, &scene.prepared(&shot.render, &Quiet).unwrap()));
        assert!(first != scene.render(&[view], &Shot { color: ColorKind::Rendered, ..shot }, &Quiet).unwrap()[0]);
    }

    #[test]
    fn numbers_out_of_range_and_unknown_cameras_are_usage() {
        let choices = RenderChoices { samples: Some(0), ..RenderChoices::default() };
        let error = Shot::new(Quality::Normal, &choices, 0).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("samples must be at least 1"), "{error}");
        let error = bathroom().view(Some("nobody"), &Quiet).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("no camera \"nobody\""), "{error}");
    }
}
