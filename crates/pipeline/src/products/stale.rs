//! Which products are out of date.

use super::record::{Part, Place, Record, has_records};
use super::sources::Subject;
use super::table::{PRODUCTS, ProductSpec};
use crate::error::Error;
use crate::request::{Product, Request, Scope};
use crate::stages::HASHED_AS;
use crate::workdir::Hash;
use enfilade_dataset::{Dataset, quoted};
use enfilade_verify::NotJudged;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// A product that is not as its inputs would have it now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutOfDate {
    /// Which.
    pub product: Product,
    /// The scene; `None` for the dataset as a whole.
    pub scene: Option<String>,
    /// How many of its parts are to be made again.
    pub parts: usize,
}

/// Names everything that a part of a product is made from.
pub(super) fn key(subject: &Subject, spec: &ProductSpec, request: &Request, part: &Part) -> Result<Hash, Error> {
    let layers = (spec.layers)(request);
    let hashes = spec.reads.iter().map(|&source| subject.hash(source, &layers, part)).collect::<Result<Vec<_>, _>>()?;
    Ok(Hash::of(&(HASHED_AS, spec.name, spec.version, &part.settings, hashes)))
}

/// A requested part.
pub(super) struct Wanted {
    pub part: Part,
    /// Index of the request in the record.
    pub request: usize,
    pub key: Hash,
    /// False where what it is made from has changed, and where it was never made.
    pub is_of_inputs: bool,
    /// True when its files are there, too, in full length.
    pub is_fresh: bool,
}

/// The products of `scenes`, and of the dataset as a whole, that are out of date.
///
/// # Errors
/// If an input file of a product cannot be read.
pub fn out_of_date(dataset: &Dataset, scenes: &[String]) -> Result<Vec<OutOfDate>, Error> {
    let mut found = Vec::new();
    for place in scenes.iter().map(|scene| Place::Scene(scene)).chain([Place::Dataset]) {
        let mut states = States::new(dataset, place);
        for spec in specs_in(place) {
            let parts = states.wanted(spec.product)?.iter().filter(|wanted| !wanted.is_fresh).count();
            if parts > 0 {
                found.push(OutOfDate { product: spec.product, scene: place.scene().map(String::from), parts });
            }
        }
    }
    Ok(found)
}

/// A line about products that are out of date; `None` where none is.
pub(crate) fn told_out_of_date(dataset: &Dataset, scenes: &[String]) -> Result<Option<String>, Error> {
    let products: BTreeSet<Product> = out_of_date(dataset, scenes)?.iter().map(|stale| stale.product).collect();
    if products.is_empty() {
        return Ok(None);
    }
    let names: Vec<&str> = products.iter().map(|product| product.spec().name).collect();
    let are = if names.len() == 1 { "product is" } else { "products are" };
    let out = quoted(dataset.root().display());
    Ok(Some(format!("{} {are} out of date: {}; `enfilade make {out} --stale` makes them again", names.len(), names.join(", "))))
}

/// The files of a scene's products whose inputs have changed: no law is about them until they are made again. Those that were damaged are
/// judged.
pub(crate) fn not_judged(dataset: &Dataset, scene: &str) -> Result<NotJudged, Error> {
    let place = Place::Scene(scene);
    let mut states = States::new(dataset, place);
    let mut not_judged = NotJudged::default();
    for spec in specs_in(place) {
        let Some(record) = Record::read(dataset, place, spec.product).filter(|_| states.is_any) else { continue };
        let wanted = states.wanted(spec.product)?;
        let judged: BTreeSet<&str> = wanted.iter().filter(|part| part.is_of_inputs).map(|part| part.part.name.as_str()).collect();
        let stale = record.parts.iter().filter(|(name, _)| !judged.contains(name.as_str()));
        let files: Vec<PathBuf> = stale.flat_map(|(_, part)| &part.files).map(|file| dataset.root().join(&file.path)).collect();
        not_judged.leave_out(spec.name, files);
    }
    Ok(not_judged)
}

/// The products of such a place.
pub(super) fn specs_in(place: Place) -> impl Iterator<Item = &'static ProductSpec> {
    PRODUCTS.iter().filter(move |spec| (spec.scope == Scope::Dataset) == (place == Place::Dataset))
}

/// The states of the products of a place, each looked at once.
pub(super) struct States<'a> {
    pub subject: Subject<'a>,
    place: Place<'a>,
    /// False if there was never a request.
    is_any: bool,
    /// Whether all wanted parts of a product are fresh.
    known: BTreeMap<Product, bool>,
}

impl<'a> States<'a> {
    pub fn new(dataset: &'a Dataset, place: Place<'a>) -> Self {
        Self { subject: Subject::new(dataset, place), place, is_any: has_records(dataset, place), known: BTreeMap::new() }
    }

    /// The requested parts of a product; none if there is no record of it.
    pub fn wanted(&mut self, product: Product) -> Result<Vec<Wanted>, Error> {
        let record = if self.is_any { Record::read(self.subject.dataset, self.place, product) } else { None };
        record.map_or(Ok(Vec::new()), |record| self.wanted_by(product, &record))
    }

    /// The parts that a record requests.
    pub fn wanted_by(&mut self, product: Product, record: &Record) -> Result<Vec<Wanted>, Error> {
        let spec = product.spec();
        let mut inputs_are_fresh = true;
        for input in spec.products() {
            inputs_are_fresh &= self.is_fresh(input)?;
        }
        let mut parts: BTreeMap<String, (usize, Part)> = BTreeMap::new();
        let mut order = Vec::new();
        for (index, request) in record.requests.iter().enumerate() {
            for part in (spec.parts)(&self.subject, request)? {
                let name = part.name.clone();
                if parts.insert(name.clone(), (index, part)).is_none() {
                    order.push(name);
                }
            }
        }
        let root = self.subject.dataset.root().to_path_buf();
        let wanted = |name: String| {
            let (request, part) = parts.remove(&name).expect("each name is in the order once");
            let key = key(&self.subject, spec, &record.requests[request], &part)?;
            let made = record.parts.get(&name).filter(|made| inputs_are_fresh && made.from.as_ref() == Some(&key));
            let is_fresh = made.is_some_and(|made| made.is_whole(&root));
            Ok(Wanted { part, request, key, is_of_inputs: made.is_some(), is_fresh })
        };
        order.into_iter().map(wanted).collect()
    }

    /// True if all requested parts of a product exist and are up to date with their inputs.
    fn is_fresh(&mut self, product: Product) -> Result<bool, Error> {
        if let Some(&known) = self.known.get(&product) {
            return Ok(known);
        }
        let fresh = match (self.place, product.scope()) {
            (Place::Dataset, Scope::Dataset) | (Place::Scene(_), Scope::Scene | Scope::Camera | Scope::Frame) => {
                self.wanted(product)?.iter().all(|wanted| wanted.is_fresh)
            }
            (Place::Scene(_), Scope::Dataset) => States::new(self.subject.dataset, Place::Dataset).is_fresh(product)?,
            (Place::Dataset, _) => self.is_fresh_in_all_scenes(product)?,
        };
        self.known.insert(product, fresh);
        Ok(fresh)
    }

    fn is_fresh_in_all_scenes(&self, product: Product) -> Result<bool, Error> {
        for scene in self.subject.dataset.scenes().map_err(Error::stage)? {
            if !States::new(self.subject.dataset, Place::Scene(&scene)).is_fresh(product)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The request of a part.
    pub fn request<'r>(record: &'r Record, wanted: &Wanted) -> &'r Request {
        &record.requests[wanted.request]
    }
}
