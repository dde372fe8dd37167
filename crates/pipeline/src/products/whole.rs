//! What every run makes of the dataset as a whole from the pictures of its scenes: the contact sheet and the statistics.

use super::make::{MakeOptions, update};
use super::product::Product;
use super::record::{MadePart, Part, Place, Record};
use super::request::Request;
use super::sources::Subject;
use super::stale::States;
use super::table::Asked;
use crate::error::Error;
use crate::stages::{Output, Stage, record_key};
use crate::workdir::{Hash, Workdir};
use enfilade_dataset::{Dataset, WORKDIR};
use enfilade_scene::{Cx, Quiet};
use enfilade_show::drivers::write_overview;
use enfilade_show::sheet::SheetConfig;
use enfilade_show::stats::{self, StatsConfig, StatsSummary};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

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

/// Whether what a request asks for was asked for before, and is there.
fn is_fresh(dataset: &Dataset, request: &Request) -> Result<bool, Error> {
    let Some(record) = Record::read(dataset, Place::Dataset, request.product()) else { return Ok(false) };
    let wanted = States::new(dataset, Place::Dataset).wanted_by(request.product(), &record)?;
    Ok(record.requests.contains(request) && wanted.iter().all(|part| part.is_fresh))
}

/// Makes what `request` asks for unless it is there. Files without a record are those of an earlier version, which removed them when pictures were
/// made: they count where none `were_made` in this run.
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
        let key = subject.key(product.spec(), &record.requests[0], &part)?;
        let files = files.iter().map(|path| Output::by_length(dataset.root(), path)).collect::<Result<_, _>>()?;
        record.parts.insert(part.name, MadePart { from: Some(key), files });
    }
    record.write(dataset, Place::Dataset, product)
}

pub(super) fn parts(_subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    Ok(vec![Part { name: String::new(), frames: Vec::new(), settings: Hash::of(request) }])
}

pub(super) fn make(subject: &Subject, asked: &[Asked], _cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let scenes = subject.dataset.scenes().map_err(Error::stage)?;
    for asked in asked {
        match asked.request {
            Request::Sheet { title, .. } => {
                write_overview(subject.dataset, &scenes, title, &SheetConfig::default()).map(drop).map_err(Error::stage)?;
            }
            _ => {
                let config = StatsConfig { scenes: scenes.clone(), ..StatsConfig::default() };
                stats::write_statistics(subject.dataset, &config, &Quiet).map(drop).map_err(Error::stage)?;
            }
        }
    }
    Ok(Vec::new())
}

pub(super) fn sheet_files(subject: &Subject, _part: &Part) -> Result<Vec<PathBuf>, Error> {
    Ok(files(subject, Product::Sheet))
}

pub(super) fn statistics_files(subject: &Subject, _part: &Part) -> Result<Vec<PathBuf>, Error> {
    Ok(files(subject, Product::Statistics))
}

/// The files of a product that are there, the one that is always there first.
fn files(subject: &Subject, product: Product) -> Vec<PathBuf> {
    let layout = subject.dataset.layout();
    let mut found = vec![layout.overview()];
    if product == Product::Statistics {
        found = vec![layout.statistics()];
        found.extend(files_below(&layout.statistics_dir()).into_iter().filter(|path| *path != layout.statistics()));
    }
    found.retain(|path| path.is_file());
    found
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect();
    found.sort();
    found
}

/// Writes statistics of a dataset. Those in its own folder stay as they are asked for here until its frames change.
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
    // From here on the old record must not speak of the new files.
    vouch(dataset, Request::Statistics { pictures: String::new() }, &[])?;
    let summary = stats::write_statistics(dataset, config, cx).map_err(Error::stage)?;
    vouch(dataset, Request::Statistics { pictures: Hash::of(&pictures).0 }, &summary.files)?;
    Ok(summary)
}
