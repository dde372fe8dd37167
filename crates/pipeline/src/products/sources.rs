//! The inputs of parts of products, by content: hashes that are equal as long as the inputs are the same.

use super::record::{Part, Place, Record};
use crate::error::Error;
use crate::request::{Product, Scope};
use crate::workdir::Hash;
use enfilade_dataset::{CLASS_LIST, ChosenFrames, Dataset, FrameRecord, LabelRecord, mesh_names};
use enfilade_frame::{Layer, Pass};
use enfilade_scene::{Cx, Quiet};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The four arrays of a trajectory.
const KEYFRAMES: [&str; 4] = ["frame_indices", "positions", "look_at_positions", "orientations"];

/// Something that parts are made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The layers of the part's frames that the product reads, and the camera's pose.
    Frames,
    /// All files of the part's frames.
    WholeFrames,
    /// The trajectories and cameras of the part's frames.
    Poses,
    /// The scene package.
    Package,
    /// The tables of labels.
    Labels,
    /// How the pictures of the part's frames are exposed.
    Exposures,
    /// The fixtures that light the scene.
    Fixtures,
    /// The files of another product.
    Product(Product),
    /// The pictures of all scenes: the request names what they were made from.
    Pictures,
    /// Another product that may decide which parts exist, but not their contents.
    ListedBy(Product),
}

/// A scene whose products are looked at, with what is known of its files: hashes are taken once.
pub(crate) struct Subject<'a> {
    pub dataset: &'a Dataset,
    /// Name of the scene; empty for the dataset as a whole.
    pub scene: &'a str,
    frames: OnceCell<Vec<(String, Vec<u32>)>>,
    records: RefCell<BTreeMap<(String, u32), Rc<Recorded>>>,
    contents: RefCell<BTreeMap<PathBuf, Hash>>,
    listed: RefCell<BTreeMap<PathBuf, Vec<String>>>,
}

/// The records of a frame.
struct Recorded {
    frame: Option<FrameRecord>,
    labels: Option<LabelRecord>,
}

impl<'a> Subject<'a> {
    pub fn new(dataset: &'a Dataset, place: Place<'a>) -> Self {
        Self {
            dataset,
            scene: place.scene().unwrap_or_default(),
            frames: OnceCell::new(),
            records: RefCell::default(),
            contents: RefCell::default(),
            listed: RefCell::default(),
        }
    }

    /// The finished frames of the scene, by camera; `cx` hears of those that are damaged, the first time.
    pub fn frames(&self, cx: &dyn Cx) -> Result<&[(String, Vec<u32>)], Error> {
        if let Some(frames) = self.frames.get() {
            return Ok(frames);
        }
        let found = ChosenFrames::default().of_scene(self.dataset, self.scene, cx).map_err(Error::stage)?;
        Ok(self.frames.get_or_init(|| found))
    }

    /// Warns of frames that are damaged, and left out.
    pub fn warn_of_damaged_frames(&self, cx: &dyn Cx) -> Result<(), Error> {
        if self.scene.is_empty() { Ok(()) } else { self.frames(cx).map(drop) }
    }

    /// The finished frames that `is_chosen`.
    pub fn chosen(&self, is_chosen: impl Fn(&str, u32) -> bool) -> Result<Vec<(String, u32)>, Error> {
        let all = self.frames(&Quiet)?.iter().flat_map(|(camera, frames)| frames.iter().map(move |&frame| (camera, frame)));
        Ok(all.filter(|(camera, frame)| is_chosen(camera, *frame)).map(|(camera, frame)| (camera.clone(), frame)).collect())
    }

    /// The files of a frame in a folder: those whose names begin with its number.
    pub fn files_of_frame(&self, folder: &Path, frame: u32) -> Vec<PathBuf> {
        let mut listed = self.listed.borrow_mut();
        let names = listed.entry(folder.into()).or_insert_with(|| {
            let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
            let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
            names.sort();
            names
        });
        let prefix = format!("frame.{frame:04}.");
        let first = names.partition_point(|name| name.as_str() < prefix.as_str());
        names[first..].iter().take_while(|name| name.starts_with(&prefix)).map(|name| folder.join(name)).collect()
    }

    /// Forgets what was read of files, because some are made anew.
    pub fn forget_contents(&self) {
        self.contents.borrow_mut().clear();
        self.listed.borrow_mut().clear();
    }

    /// Names what a part takes from a source; `layers` are those that it reads of its frames.
    pub fn hash(&self, source: Source, layers: &[Layer], part: &Part) -> Result<Hash, Error> {
        let (layout, scene) = (self.dataset.layout(), self.scene);
        let cameras = || -> Vec<&String> {
            let mut names: Vec<&String> = part.frames.iter().map(|(camera, _)| camera).collect();
            names.dedup();
            names
        };
        match source {
            Source::Frames => self.of_frames(part, |recorded| recorded.of_layers(self, layers)),
            Source::WholeFrames => self.of_frames(part, |recorded| Hash::of(&recorded.frame)),
            Source::Poses => self.of_files(cameras().into_iter().flat_map(|camera| self.pose_files(camera)).collect()),
            Source::Package => self.of_files(vec![layout.scene_package(scene)]),
            Source::Labels => self.of_files(self.label_files()),
            Source::Exposures => self.of_files(cameras().into_iter().map(|camera| layout.tone_maps(scene, camera)).collect()),
            Source::Fixtures => self.of_files(vec![layout.metadata_fixtures(scene)]),
            Source::Product(Product::Rooms) => self.of_files(vec![layout.rooms(scene)]),
            Source::Product(product) => self.of_product(product),
            Source::Pictures | Source::ListedBy(_) => Ok(Hash::of(&())),
        }
    }

    fn of_frames(&self, part: &Part, hash: impl Fn(&Recorded) -> Hash) -> Result<Hash, Error> {
        let one = |of: &(String, u32)| Ok((of.clone(), hash(&*self.recorded(of)?)));
        Ok(Hash::of(&part.frames.iter().map(one).collect::<Result<Vec<_>, Error>>()?))
    }

    fn recorded(&self, of: &(String, u32)) -> Result<Rc<Recorded>, Error> {
        if let Some(known) = self.records.borrow().get(of) {
            return Ok(known.clone());
        }
        let (camera, frame) = of;
        let frame_record = self.dataset.frame_record(self.scene, camera, *frame).map_err(Error::stage)?;
        let labels = self.dataset.label_record(self.scene, camera, *frame).map_err(Error::stage)?;
        let recorded = Rc::new(Recorded { frame: frame_record, labels });
        self.records.borrow_mut().insert(of.clone(), recorded.clone());
        Ok(recorded)
    }

    /// The contents of files, of which any may be missing.
    fn of_files(&self, paths: Vec<PathBuf>) -> Result<Hash, Error> {
        let content = |path: PathBuf| -> Result<Option<Hash>, Error> {
            if !path.is_file() {
                return Ok(None);
            }
            if let Some(known) = self.contents.borrow().get(&path) {
                return Ok(Some(known.clone()));
            }
            let hash = Hash::of_file(&path)?;
            self.contents.borrow_mut().insert(path, hash.clone());
            Ok(Some(hash))
        };
        Ok(Hash::of(&paths.into_iter().map(content).collect::<Result<Vec<_>, _>>()?))
    }

    /// The contents of all files of a product, in all scenes where it is made by scene.
    fn of_product(&self, product: Product) -> Result<Hash, Error> {
        let scenes = self.dataset.scenes().map_err(Error::stage)?;
        let places: Vec<Place> = match product.scope() {
            Scope::Dataset => vec![Place::Dataset],
            _ if self.scene.is_empty() => scenes.iter().map(|scene| Place::Scene(scene)).collect(),
            _ => vec![Place::Scene(self.scene)],
        };
        let mut paths = Vec::new();
        for place in places {
            let record = Record::read(self.dataset, place, product).unwrap_or_default();
            paths.extend(record.parts.values().flat_map(|part| &part.files).map(|file| self.dataset.root().join(&file.path)));
        }
        let names: Vec<PathBuf> = paths.iter().filter_map(|path| Some(path.strip_prefix(self.dataset.root()).ok()?.into())).collect();
        Ok(Hash::of(&(names, self.of_files(paths)?)))
    }

    fn pose_files(&self, camera: &str) -> Vec<PathBuf> {
        let layout = self.dataset.layout();
        let keyframes = KEYFRAMES.iter().map(|what| layout.keyframes(self.scene, camera, what));
        keyframes.chain(self.dataset.camera_model_files(self.scene, camera)).collect()
    }

    fn label_files(&self) -> Vec<PathBuf> {
        let files = self.dataset.mesh_files(self.scene);
        let tables = [
            mesh_names::OBJECTS_SEMANTIC,
            mesh_names::OBJECTS_INSTANCE,
            mesh_names::FACES_OBJECTS,
            mesh_names::OBJECTS,
            mesh_names::OBJECT_PIECES,
            CLASS_LIST,
        ];
        tables.into_iter().map(|name| files.file(name)).collect()
    }
}

impl Recorded {
    /// The checksums of layers, and the camera's pose.
    fn of_layers(&self, subject: &Subject, layers: &[Layer]) -> Hash {
        let Some(frame) = &self.frame else { return Hash::of(&None::<u8>) };
        let checksum = |layer: &Layer| {
            let path = subject.dataset.layout().layer(&frame.scene, &frame.camera, frame.frame, *layer);
            let name =
                path.strip_prefix(subject.dataset.layout().scene_dir(&frame.scene)).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            let files =
                if layer.spec().pass == Pass::Label { self.labels.as_ref().map(|labels| &labels.files) } else { Some(&frame.files) };
            files.and_then(|files| files.get(&name)).map(|file| file.blake3.clone())
        };
        let checksums: Vec<Option<String>> = layers.iter().map(checksum).collect();
        Hash::of(&(&frame.pose, &frame.intrinsics, &frame.camera_model, checksums))
    }
}
