//! Checks of the dataset as a whole: its manifest, its partition, and the report card beside it.

use super::boxes;
use super::card::Card;
use super::law::Law;
use super::read::readable;
use super::report::VerifyReport;
use enfilade_dataset::{Dataset, DatasetError, FrameStatus, Manifest, SceneEntry, Side, write_changed};
use std::collections::{BTreeMap, BTreeSet};

/// The report of several scenes' reports, with the laws of the dataset as a whole.
pub fn join_reports(dataset: &Dataset, reports: Vec<VerifyReport>) -> VerifyReport {
    let mut card = Card::default();
    check_split(&mut card, dataset);
    VerifyReport::join(reports, card)
}

/// Stores the report beside the data as `verify.json`. A file that is so already is not touched.
///
/// # Errors
/// When the file cannot be written.
pub fn write_report_json(dataset: &Dataset, report: &VerifyReport) -> Result<(), DatasetError> {
    let mut json = serde_json::to_string_pretty(report).unwrap_or_default();
    json.push('\n');
    write_changed(&dataset.layout().verify_report(), &json)
}

/// Checks the manifest's entry of a scene, and whether its files agree with it.
pub(super) fn check_manifest(card: &mut Card, dataset: &Dataset, manifest: Option<&Manifest>, scene: &str) {
    let Some(manifest) = manifest else {
        return card.observe(Law::Manifest, 1.0, || format!("{}: there is none", dataset.layout().manifest().display()));
    };
    let none = SceneEntry::default();
    let listed = manifest.scenes.get(scene);
    card.observe(Law::Manifest, if listed.is_none() { 1.0 } else { 0.0 }, || format!("{scene}: not in the manifest"));
    let entry = listed.unwrap_or(&none);
    if let Some(reason) = &entry.failed {
        card.observe(Law::HasFrames, 1.0, || format!("{scene}: failed: {reason}"));
    }
    for (camera, frame) in entry.cameras.iter().flat_map(|(name, camera)| camera.frames.iter().map(move |frame| (name, frame))) {
        let reason = frame.reason.as_deref().unwrap_or("planned, but not rendered");
        let broken = if matches!(frame.status, FrameStatus::Complete | FrameStatus::Rejected) { 0.0 } else { 1.0 };
        card.observe(Law::FramesComplete, broken, || format!("{scene}/{camera}/frame.{:04}: {reason}", frame.frame));
    }
    if let Some(problems) = readable(card, dataset.verify_checksums_of(scene, entry)) {
        card.observe(Law::Checksums, problems.len() as f64, || problems.into_iter().next().unwrap_or_default());
    }
}

/// No scene is on two sides of the partition, where there is one.
fn check_split(card: &mut Card, dataset: &Dataset) {
    let Some(rows) = boxes::there(dataset.read_partition()).and_then(|read| readable(card, read)) else { return };
    let mut sides: BTreeMap<&str, Side> = BTreeMap::new();
    let sided = rows.iter().filter_map(|row| Some((row.scene.as_str(), *row.side.as_ref().ok()?)));
    let torn: BTreeSet<&str> = sided.filter(|&(scene, side)| *sides.entry(scene).or_insert(side) != side).map(|(scene, _)| scene).collect();
    card.observe(Law::PartitionWhole, torn.len() as f64, || format!("scenes {torn:?}"));
}
