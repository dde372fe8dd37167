//! Products of the dataset as a whole that every run makes from the pictures of its scenes: the contact sheet and the statistics.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::{Product, Request};
use crate::workdir::Hash;
use enfilade_scene::{Cx, Quiet};
use enfilade_show::drivers::write_overview;
use enfilade_show::sheet::SheetConfig;
use enfilade_show::stats::{self, StatsConfig};
use std::path::{Path, PathBuf};

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
pub(super) fn files(subject: &Subject, product: Product) -> Vec<PathBuf> {
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
