//! Products that every run brings up to date, and statistics by the verb of that name.

use super::record::{MadePart, Place, Record};
use super::sources::Subject;
use super::stale::{States, key};
use super::update::{MakeOptions, described, update};
use super::whole::{files, parts};
use crate::error::Error;
use crate::request::Request;
use crate::stages::{Stage, record_key};
use crate::workdir::{Hash, Workdir};
use enfilade_dataset::{Dataset, WORKDIR};
use enfilade_scene::{Cx, Quiet};
use enfilade_show::sheet::SheetConfig;
use enfilade_show::stats::{self, StatsConfig, StatsSummary};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Scenes by name, each with what names the inputs of its pictures; `None` where it has none.
pub(crate) type Pictures = BTreeMap<String, Option<Hash>>;

/// The pictures of all scenes of a dataset: `known` are those whose stage has just run or was found up to date.
pub(crate) fn pictures(dataset: &Dataset, workdir: &Workdir, known: &BTreeMap<String, Hash>) -> Result<Pictures, Error> {
    let of_scene = |scene: String| {
        let hash = match known.get(&scene) {
            Some(hash) => Some(hash.clone()),
            None => record_key(&workdir.scene_file(&scene, &Stage::Preview.record())?),
        };
        Ok((scene, hash))
    };
    dataset.scenes().map_err(Error::stage)?.into_iter().map(of_scene).collect()
}

/// Brings the contact sheet up to date, unless there is no frame to show.
pub(crate) fn update_sheet(
    dataset: &Dataset,
    title: &str,
    (pictures, were_made): (&Pictures, bool),
    has_frames: impl Fn() -> Result<bool, Error>,
) -> Result<(), Error> {
    let settings = Hash::of(&SheetConfig::default());
    let request = Request::Sheet { title: title.into(), pictures: Hash::of(&(settings, pictures)).0 };
    if is_fresh(dataset, &request)? || !has_frames()? { Ok(()) } else { bring(dataset, request, were_made) }
}

/// Brings the statistics up to date, without costs, which would differ between two runs.
pub(crate) fn update_statistics(dataset: &Dataset, pictures: &Pictures, were_made: bool) -> Result<(), Error> {
    bring(dataset, Request::Statistics { pictures: Hash::of(pictures).0 }, were_made)
}

/// Whether the product of a request was requested before, and exists.
fn is_fresh(dataset: &Dataset, request: &Request) -> Result<bool, Error> {
    let Some(record) = Record::read(dataset, Place::Dataset, request.product()) else { return Ok(false) };
    let wanted = States::new(dataset, Place::Dataset).wanted_by(request.product(), &record)?;
    Ok(record.requests.contains(request) && wanted.iter().all(|part| part.is_fresh))
}

/// Makes the product of `request` unless it exists. Files without a record are from an earlier version, which removed them when pictures
/// were made: they are up to date if no pictures `were_made` in this run.
fn bring(dataset: &Dataset, request: Request, were_made: bool) -> Result<(), Error> {
    let product = request.product();
    if Record::read(dataset, Place::Dataset, product).is_none() && !were_made {
        let subject = Subject::new(dataset, Place::Dataset);
        let (found, layout) = (files(&subject, product), dataset.layout());
        if found.first().is_some_and(|path| [layout.overview(), layout.statistics()].contains(path)) {
            return vouch(dataset, request, &found);
        }
    }
    update(dataset, Place::Dataset, product, &[request], MakeOptions::default(), &Quiet).map(drop)
}

/// Writes the record of files as `request` has made them.
fn vouch(dataset: &Dataset, request: Request, files: &[PathBuf]) -> Result<(), Error> {
    let (subject, product) = (Subject::new(dataset, Place::Dataset), request.product());
    let mut record = Record { requests: vec![request], ..Record::default() };
    for part in parts(&subject, &record.requests[0])? {
        let key = key(&subject, product.spec(), &record.requests[0], &part)?;
        let files = files.iter().map(|path| described(product, dataset, path)).collect::<Result<_, _>>()?;
        record.parts.insert(part.name, MadePart { from: Some(key), files });
    }
    record.write(dataset, Place::Dataset, product)
}

/// Writes statistics of a dataset. Those in its own folder keep the options given here until its frames change.
///
/// # Errors
/// When a file cannot be read or written, or there is nothing to compare with.
pub fn write_statistics(dataset: &Dataset, config: &StatsConfig, cx: &dyn Cx) -> Result<StatsSummary, Error> {
    // Data of others have no work folder.
    if config.folder.is_some() || !dataset.root().join(WORKDIR).is_dir() {
        return stats::write_statistics(dataset, config, cx).map_err(Error::stage);
    }
    let workdir = Workdir::open(dataset.root())?;
    let pictures = pictures(dataset, &workdir, &BTreeMap::new())?;
    // From here on the old record must not vouch for the new files.
    vouch(dataset, Request::Statistics { pictures: String::new() }, &[])?;
    let summary = stats::write_statistics(dataset, config, cx).map_err(Error::stage)?;
    vouch(dataset, Request::Statistics { pictures: Hash::of(&pictures).0 }, &summary.files)?;
    Ok(summary)
}
