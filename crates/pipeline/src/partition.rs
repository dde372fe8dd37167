//! The partition of a dataset by scene, and the assets that occur on several sides of it.

use crate::error::Error;
use crate::workdir::{CHOICE, Hash, PACKAGE, Workdir, read_json};
use enfilade_dataset::{
    Dataset, Manifest, PartitionConfig, PartitionRow, SceneAssets, SharedAsset, Side, ViewFault, read_package, remove_if_there,
    shared_assets, write_json,
};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Contents of the dataset's `split.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartitionReport {
    /// How scenes were divided.
    pub config: PartitionConfig,
    /// The scenes of each side.
    pub scenes: BTreeMap<String, BTreeSet<String>>,
    /// The variations of scenes, by the names of these: each is on the side of the scene that it varies.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub variations: BTreeMap<String, BTreeSet<String>>,
    /// Number of images on each side, 0 where it is empty, and of those left out (`excluded`).
    pub images: BTreeMap<String, usize>,
    /// Meshes and textures that several scenes have, those on several sides first.
    pub shared_assets: Vec<SharedAsset>,
}

impl PartitionReport {
    /// A line about sides without an image; `None` where all that get a share have some, and before anything is rendered.
    pub fn empty_sides(&self) -> Option<String> {
        let is_empty = |side: &&str| self.images.get(*side).is_none_or(|&images| images == 0);
        let empty: Vec<&str> = self.asked_for().filter(is_empty).collect();
        if empty.is_empty() || Side::ALL.iter().all(|side| is_empty(&side.name())) {
            return None;
        }
        let (sides, are, them) =
            (empty.join(" and "), if empty.len() == 1 { "is" } else { "are" }, if empty.len() == 1 { "it" } else { "them" });
        let or_seed = if self.has_few_scenes() { "" } else { ", or another seed (enfilade partition OUT --seed 1)," };
        Some(format!("{sides} of the partition {are} empty; more scenes{or_seed} fill {them}"))
    }

    /// True where there are fewer scenes, each with its variations, than sides that get a share.
    pub fn has_few_scenes(&self) -> bool {
        let variations: BTreeSet<&String> = self.variations.values().flatten().collect();
        self.scenes.values().flatten().filter(|scene| !variations.contains(scene)).count() < self.asked_for().count()
    }

    /// The sides that get a share.
    fn asked_for(&self) -> impl Iterator<Item = &'static str> {
        Side::ALL.iter().zip(self.config.shares).filter(|(_, share)| *share > 0.0).map(|(side, _)| side.name())
    }

    /// A line about the assets on several sides; `None` where there are none.
    pub fn leaks(&self) -> Option<String> {
        let leaks = self.shared_assets.iter().filter(|asset| asset.leaks).count();
        let first = self.shared_assets.first().filter(|asset| asset.leaks)?;
        let scenes: Vec<&str> = first.scenes.values().flatten().map(String::as_str).take(3).collect();
        Some(format!(
            "{leaks} assets are on several sides of the partition, among them {} {:?} of {}; split.json has all",
            first.kind,
            first.name,
            scenes.join(", ")
        ))
    }
}

/// Assets of a scene package, kept so that they are looked at once.
#[derive(Serialize, Deserialize)]
struct KeptAssets {
    package: Hash,
    assets: SceneAssets,
}

/// Divides the dataset in `out` by scene, with the last choice as modified by `change`, which is stored for the future.
///
/// # Errors
/// If the choice is invalid, `out` is not a dataset made by this program, or a file cannot be read or written.
pub fn partition(out: &Path, change: impl FnOnce(&mut PartitionConfig)) -> Result<PartitionReport, Error> {
    let workdir = Workdir::open(out)?;
    let last = choice(&workdir)?;
    let mut config = last;
    change(&mut config);
    if let Some(problem) = config.problem() {
        return Err(Error::usage(problem, "enfilade partition OUT --seed 0 --shares 80,10,10"));
    }
    if config != last {
        write_json(&workdir.file(CHOICE), &config)?;
    }
    let dataset = Dataset::open(out).map_err(Error::stage)?;
    let Some(manifest) = dataset.read_manifest().map_err(Error::stage)? else {
        return Err(Error::usage(format!("{} has no manifest", out.display()), "run `enfilade run` for this folder first"));
    };
    write_partition(&dataset, &workdir, &manifest)
}

/// The last choice of how the dataset is divided; the default if there is none.
fn choice(workdir: &Workdir) -> Result<PartitionConfig, Error> {
    let path = workdir.file(CHOICE);
    let text = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(PartitionConfig::default()),
        text => text.map_err(Error::io("read", &path))?,
    };
    let unknown = |e| {
        Error::usage(format!("{}: no choice of a partition ({e})", path.display()), "remove it, and choose again: enfilade partition OUT")
    };
    serde_json::from_slice(&text).map_err(unknown)
}

/// Writes the partition of what `manifest` lists.
pub(crate) fn write_partition(dataset: &Dataset, workdir: &Workdir, manifest: &Manifest) -> Result<PartitionReport, Error> {
    let config = choice(workdir)?;
    let rejected = rejected(dataset, manifest)?;
    let first_of = first_of(dataset, manifest)?;
    let (sides, rows) = (config.sides(manifest, &rejected, &first_of), config.rows(manifest, &rejected, &first_of));
    // A run that changes nothing touches no file.
    if dataset.read_partition().ok().as_ref() != Some(&rows) {
        dataset.write_partition(&rows).map_err(Error::stage)?;
    }
    let mut assets = BTreeMap::new();
    for scene in manifest.scenes.keys() {
        assets.extend(scene_assets(workdir, scene)?.map(|found| (scene.clone(), found)));
    }
    let mut scenes: BTreeMap<String, BTreeSet<String>> = Side::ALL.iter().map(|p| (p.name().into(), BTreeSet::new())).collect();
    for (scene, side) in &sides {
        scenes.entry(side.name().into()).or_default().insert(scene.to_string());
    }
    let mut images: BTreeMap<String, usize> = Side::ALL.iter().map(|p| (p.name().into(), 0)).collect();
    for PartitionRow { side, .. } in &rows {
        *images.entry(side.as_ref().map_or("excluded", |p| p.name()).into()).or_default() += 1;
    }
    let shared_assets = shared_assets(&assets, |scene| sides.get(scene).copied().unwrap_or_else(|| config.side(scene)));
    let mut variations: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (variation, first) in first_of {
        variations.entry(first).or_default().insert(variation);
    }
    let report = PartitionReport { config, scenes, variations, images, shared_assets };
    let path = dataset.layout().partition_report();
    if read_json::<PartitionReport>(&path).as_ref() != Some(&report) {
        write_json(&path, &report)?;
    }
    Ok(report)
}

/// The scenes that variations vary, by the names of these.
fn first_of(dataset: &Dataset, manifest: &Manifest) -> Result<BTreeMap<String, String>, Error> {
    let mut first_of = BTreeMap::new();
    for scene in manifest.scenes.keys() {
        let variation = dataset.read_variation(scene).map_err(Error::stage)?;
        first_of.extend(variation.map(|variation| (scene.clone(), variation.of)));
    }
    Ok(first_of)
}

/// The views that gates reject, in Hypersim's manner of giving reasons: "BARE WALL".
fn rejected(dataset: &Dataset, manifest: &Manifest) -> Result<BTreeMap<(String, String, u32), String>, Error> {
    let mut reasons = BTreeMap::new();
    for (scene, entry) in &manifest.scenes {
        for camera in entry.cameras.keys() {
            let views = dataset.rejected_views(scene, camera).map_err(Error::stage)?;
            let reason = |fault: ViewFault| fault.gate.replace('_', " ").to_uppercase();
            reasons.extend(views.into_iter().map(|(frame, fault)| ((scene.clone(), camera.clone(), frame), reason(fault))));
        }
    }
    Ok(reasons)
}

/// The assets of a scene's package; `None` when there is no package.
fn scene_assets(workdir: &Workdir, scene: &str) -> Result<Option<SceneAssets>, Error> {
    let package = workdir.scene_file(scene, PACKAGE)?;
    let kept_at = workdir.scene_file(scene, "assets.json")?;
    if !package.is_file() {
        remove_if_there(&kept_at)?;
        return Ok(None);
    }
    let hash = Hash::of_file(&package)?;
    if let Some(kept) = read_json::<KeptAssets>(&kept_at).filter(|kept| kept.package == hash) {
        return Ok(Some(kept.assets));
    }
    let bytes = std::fs::read(&package).map_err(Error::io("read", &package))?;
    // A package of another version is made again by the next import.
    let Ok(decoded) = read_package(&package, &bytes) else { return Ok(None) };
    let kept = KeptAssets { package: hash, assets: SceneAssets::of(&decoded) };
    write_json(&kept_at, &kept)?;
    Ok(Some(kept.assets))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_warning_names_the_first_asset_on_several_sides() {
        let shared = |leaks| SharedAsset {
            kind: "mesh".into(),
            name: "vase".into(),
            scenes: [("train".to_string(), BTreeSet::from(["hall".to_string()])), ("val".into(), BTreeSet::from(["bedroom".into()]))]
                .into(),
            leaks,
        };
        let report = |shared_assets| PartitionReport {
            config: PartitionConfig::default(),
            scenes: BTreeMap::new(),
            variations: BTreeMap::new(),
            images: BTreeMap::new(),
            shared_assets,
        };
        let expected = "1 assets are on several sides of the partition, among them mesh \"vase\" of hall, bedroom; split.json has all";
        assert_eq!(report(vec![shared(true), shared(false)]).leaks().as_deref(), Some(expected));
        assert_eq!(report(vec![shared(false)]).leaks(), None);
    }

    #[test]
    fn sides_without_an_image_are_told_unless_nobody_asked_for_them() {
        let scenes: BTreeMap<String, BTreeSet<String>> = [("train".to_string(), BTreeSet::from(["room".to_string()]))].into();
        let report = |shares, images: &[(&str, usize)]| PartitionReport {
            config: PartitionConfig { shares, ..PartitionConfig::default() },
            scenes: scenes.clone(),
            variations: BTreeMap::new(),
            images: images.iter().map(|(side, count)| (side.to_string(), *count)).collect(),
            shared_assets: Vec::new(),
        };
        let told = report([80.0, 10.0, 10.0], &[("train", 4), ("val", 0)]).empty_sides().unwrap();
        assert_eq!(told, "val and test of the partition are empty; more scenes fill them");
        assert_eq!(report([1.0, 0.0, 0.0], &[("train", 4)]).empty_sides(), None);
        assert_eq!(report([80.0, 10.0, 10.0], &[]).empty_sides(), None, "nothing is rendered yet");
        assert_eq!(report([80.0, 10.0, 10.0], &[("train", 4), ("val", 1), ("test", 2)]).empty_sides(), None);
    }

    #[test]
    fn a_choice_that_means_nothing_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        drop(Workdir::create(folder.path()).unwrap());
        let error = partition(folder.path(), |config| config.shares = [0.0; 3]).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("expected three numbers"), "{error}");
    }
}
