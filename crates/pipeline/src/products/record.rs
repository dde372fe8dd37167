//! The record of a product in the work folder: the requests, and what each of its parts was made from.

use crate::error::Error;
use crate::request::{Product, Request};
use crate::stages::Output;
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{Dataset, WORKDIR, write_json};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Folder of the records in the work folder of a scene; in the dataset's work folder it has a leading dot, which no scene's name has.
const FOLDER: &str = "products";

/// Place of a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place<'a> {
    /// The dataset as a whole.
    Dataset,
    /// A scene of it.
    Scene(&'a str),
}

impl<'a> Place<'a> {
    /// The scene, if it is one.
    pub fn scene(self) -> Option<&'a str> {
        if let Self::Scene(scene) = self { Some(scene) } else { None }
    }
}

/// A part of a product, which is made or not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// Name among the parts of the product in its place: of a camera, a frame or a pair.
    pub name: String,
    /// Frames that it is made from.
    pub frames: Vec<(String, u32)>,
    /// Options that its content depends on.
    pub settings: Hash,
}

impl Part {
    /// A part of one frame.
    pub fn of_frame(frame: (String, u32), settings: Hash) -> Self {
        Self { name: format!("{}/{:04}", frame.0, frame.1), frames: vec![frame], settings }
    }
}

/// A part to make, and its request.
pub(crate) struct Asked<'a> {
    pub part: &'a Part,
    pub request: &'a Request,
}

/// The record of a product.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Record {
    /// The requests, the oldest first: of two requests for one part the later is used.
    pub requests: Vec<Request>,
    /// The requests of the configuration when it was last read.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub configured: Vec<Request>,
    /// The parts that were made, by name.
    pub parts: BTreeMap<String, MadePart>,
}

/// A part that was made.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct MadePart {
    /// Names everything that it was made from; `None` while it is being made.
    pub from: Option<Hash>,
    pub files: Vec<Output>,
}

impl MadePart {
    /// True when its files are there in full length and, where that was noted, with the same content.
    pub fn is_whole(&self, root: &Path) -> bool {
        self.files.iter().all(|file| file.is_there(root))
    }
}

impl Record {
    /// The record of a product; `None` where there is none, or it cannot be read: then nothing is known of the product.
    pub fn read(dataset: &Dataset, place: Place, product: Product) -> Option<Self> {
        read_json(&path(dataset, place, product))
    }

    /// Writes the record, where the dataset has a work folder: data of others have none.
    pub fn write(&self, dataset: &Dataset, place: Place, product: Product) -> Result<(), Error> {
        if !dataset.root().join(WORKDIR).is_dir() {
            return Ok(());
        }
        Ok(write_json(&path(dataset, place, product), self)?)
    }

    /// Adds a request, and drops requests that it replaces completely.
    pub fn ask(&mut self, request: &Request) {
        self.requests.retain(|older| !request.replaces(older));
        self.requests.push(request.clone());
    }
}

/// True when a place has any record. Looking for each product's own costs more in datasets of many scenes.
pub(crate) fn has_records(dataset: &Dataset, place: Place) -> bool {
    folder(dataset, place).is_dir()
}

fn folder(dataset: &Dataset, place: Place) -> PathBuf {
    let workdir = dataset.root().join(WORKDIR);
    match place {
        Place::Dataset => workdir.join(format!(".{FOLDER}")),
        Place::Scene(scene) => workdir.join(scene).join(FOLDER),
    }
}

fn path(dataset: &Dataset, place: Place, product: Product) -> PathBuf {
    folder(dataset, place).join(format!("{}.json", product.name()))
}
