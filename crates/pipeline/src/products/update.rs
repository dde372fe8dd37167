//! Bringing one product up to date in one place.

use super::record::{Asked, MadePart, Place, Record};
use super::sources::Subject;
use super::stale::{States, Wanted};
use crate::error::Error;
use crate::request::{Product, Request, Scope};
use crate::stages::Output;
use enfilade_dataset::{Dataset, remove_if_there};
use enfilade_scene::Cx;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// How products are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MakeOptions {
    /// Makes also what is up to date.
    pub force: bool,
}

/// Result of making a product in a scene, or in the dataset as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Made {
    /// Which.
    pub product: Product,
    /// The scene; `None` for the dataset as a whole.
    pub scene: Option<String>,
    /// Parts that were made.
    pub made: usize,
    /// Parts that were up to date.
    pub kept: usize,
    /// Lines about what was made; none if nothing was to be done.
    pub lines: Vec<String>,
}

/// Result of updating a product in a place.
#[derive(Debug, Default)]
pub(super) struct Updated {
    pub made: usize,
    pub kept: usize,
    pub lines: Vec<String>,
}

/// Makes the parts of a product in a place that `asked` requests; without any request, all parts ever requested. Parts that are up to date
/// are kept, unless forced.
pub(super) fn update(
    dataset: &Dataset,
    place: Place,
    product: Product,
    asked: &[Request],
    options: MakeOptions,
    cx: &dyn Cx,
) -> Result<Updated, Error> {
    let found = Record::read(dataset, place, product);
    if found.is_none() && asked.is_empty() {
        return Ok(Updated::default());
    }
    let before = found.unwrap_or_default();
    let mut record = before.clone();
    asked.iter().for_each(|request| record.ask(request));
    update_inputs(dataset, place, product, &record, cx)?;

    // Find what is to be made.
    let mut states = States::new(dataset, place);
    states.subject.warn_of_damaged_frames(cx)?;
    let wanted = states.wanted_by(product, &record)?;
    let is_meant = |wanted: &&Wanted| asked.is_empty() || asked.contains(&record.requests[wanted.request]);
    let (todo, fresh): (Vec<&Wanted>, Vec<&Wanted>) = wanted.iter().filter(is_meant).partition(|part| options.force || !part.is_fresh);
    if todo.is_empty() && fresh.is_empty() {
        return Ok(Updated::default());
    }
    let names: BTreeSet<&str> = wanted.iter().map(|wanted| wanted.part.name.as_str()).collect();
    if todo.is_empty() && record.parts.keys().all(|name| names.contains(name.as_str())) {
        if record.requests != before.requests {
            record.write(dataset, place, product)?;
        }
        return Ok(Updated { kept: fresh.len(), ..Updated::default() });
    }

    // Make it, and remove what was made of frames that are gone, and under other names.
    let old = files_of(&record);
    let lines = make_parts(&states.subject, (place, product), &mut record, &before.requests, &todo, cx)?;
    record.parts.retain(|name, _| names.contains(name.as_str()));
    old.difference(&files_of(&record)).try_for_each(|path| remove_with_folder(&dataset.root().join(path)))?;
    record.write(dataset, place, product)?;
    Ok(Updated { made: todo.len(), kept: fresh.len(), lines })
}

/// Makes parts, and puts what they were made from into the record, which is written before; `before` are the requests that were there.
fn make_parts(
    subject: &Subject,
    (place, product): (Place, Product),
    record: &mut Record,
    before: &[Request],
    todo: &[&Wanted],
    cx: &dyn Cx,
) -> Result<Vec<String>, Error> {
    // From here on the record must not vouch for the files that are about to change.
    let dataset = subject.dataset;
    todo.iter().for_each(|part| record.parts.entry(part.part.name.clone()).or_default().from = None);
    record.write(dataset, place, product)?;
    let parts: Vec<Asked> = todo.iter().map(|part| Asked { part: &part.part, request: States::request(record, part) }).collect();
    let made = if parts.is_empty() { Ok(Vec::new()) } else { (product.spec().make)(subject, &parts, cx) };
    if made.is_err() {
        // Requests that cannot be fulfilled are not repeated by every run.
        record.requests = before.to_vec();
        record.write(dataset, place, product)?;
        return made;
    }
    subject.forget_contents();
    for part in todo {
        let files = (product.spec().files)(subject, &part.part)?;
        let files = files.iter().map(|path| described(product, dataset, path)).collect::<Result<_, _>>()?;
        record.parts.insert(part.part.name.clone(), MadePart { from: Some(part.key.clone()), files });
    }
    made
}

/// A file of a product: of the dataset as a whole with its content, of scenes by its length, since those are many.
pub(super) fn described(product: Product, dataset: &Dataset, path: &Path) -> Result<Output, Error> {
    if product.scope() == Scope::Dataset { Output::of(dataset.root(), path) } else { Output::by_length(dataset.root(), path) }
}

/// Removes a file, and its folder where that is empty then.
fn remove_with_folder(path: &Path) -> Result<(), Error> {
    remove_if_there(path)?;
    if let Some(folder) = path.parent() {
        let _ = std::fs::remove_dir(folder); // one that is not empty stays
    }
    Ok(())
}

fn files_of(record: &Record) -> BTreeSet<PathBuf> {
    record.parts.values().flat_map(|part| &part.files).map(|file| file.path.clone()).collect()
}

/// Brings what a product is made from up to date.
fn update_inputs(dataset: &Dataset, place: Place, product: Product, record: &Record, cx: &dyn Cx) -> Result<(), Error> {
    for input in product.spec().after().filter(|input| record.requests.iter().any(|request| request.is_made_after(*input))) {
        match (place, input.scope()) {
            (_, Scope::Dataset) => drop(update(dataset, Place::Dataset, input, &[], MakeOptions::default(), cx)?),
            (Place::Scene(_), _) => drop(update(dataset, place, input, &[], MakeOptions::default(), cx)?),
            (Place::Dataset, _) => {
                for scene in dataset.scenes().map_err(Error::stage)? {
                    update(dataset, Place::Scene(&scene), input, &[], MakeOptions::default(), cx)?;
                }
            }
        }
    }
    Ok(())
}
