//! The split of a dataset by scene, and the assets that lie on several sides of it.

use crate::error::Error;
use crate::workdir::{CHOICE, Hash, PACKAGE, Workdir, read_json};
use enfilade_dataset::{Dataset, Manifest, Partition, SplitRow, ViewFault, remove_if_there, write_json};
use enfilade_label::split::{SceneAssets, SharedAsset, SplitConfig, shared_assets};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What stands in the dataset's `split.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitReport {
    /// How scenes were divided.
    pub config: SplitConfig,
    /// The scenes of each side.
    pub scenes: BTreeMap<String, BTreeSet<String>>,
    /// Number of images on each side, and of those left out (`excluded`).
    pub images: BTreeMap<String, usize>,
    /// Meshes and textures that several scenes have, those on several sides first.
    pub shared_assets: Vec<SharedAsset>,
}

impl SplitReport {
    /// One line about the assets on several sides; `None` when there are none.
    pub fn warning(&self) -> Option<String> {
        let leaks = self.shared_assets.iter().filter(|asset| asset.leaks).count();
        let first = self.shared_assets.first().filter(|asset| asset.leaks)?;
        let scenes: Vec<&str> = first.scenes.values().flatten().map(String::as_str).take(3).collect();
        Some(format!(
            "{leaks} assets are on several sides of the split, among them {} {:?} of {}",
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

/// Divides the dataset in `out` by scene, as it was divided last but for what `change` changes, which holds from now on.
///
/// # Errors
/// When the choice means nothing, `out` is no dataset that was begun here, or a file cannot be read or written.
pub fn split(out: &Path, change: impl FnOnce(&mut SplitConfig)) -> Result<SplitReport, Error> {
    let workdir = Workdir::open(out)?;
    let last = choice(&workdir)?;
    let mut config = last;
    change(&mut config);
    if let Some(problem) = config.problem() {
        return Err(Error::usage(problem, "enfilade split OUT --seed 0 --shares 80,10,10"));
    }
    if config != last {
        write_json(&workdir.file(CHOICE), &config)?;
    }
    let dataset = Dataset::open(out).map_err(Error::stage)?;
    let Some(manifest) = dataset.read_manifest().map_err(Error::stage)? else {
        return Err(Error::usage(format!("{} has no manifest", out.display()), "run `enfilade run` for this folder first"));
    };
    write_split(&dataset, &workdir, &manifest)
}

/// How the dataset was divided last; the usual way where nobody chose.
fn choice(workdir: &Workdir) -> Result<SplitConfig, Error> {
    let path = workdir.file(CHOICE);
    let text = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(SplitConfig::default()),
        text => text.map_err(Error::io("read", &path))?,
    };
    let unknown =
        |e| Error::usage(format!("{}: no choice of a split ({e})", path.display()), "remove it, and choose again: enfilade split OUT");
    serde_json::from_slice(&text).map_err(unknown)
}

/// Writes the split of what `manifest` lists.
pub(crate) fn write_split(dataset: &Dataset, workdir: &Workdir, manifest: &Manifest) -> Result<SplitReport, Error> {
    let config = choice(workdir)?;
    let rows = config.rows(manifest, &rejected(dataset, manifest)?);
    // A run that changes nothing touches no file.
    if dataset.read_split().ok().as_ref() != Some(&rows) {
        dataset.write_split(&rows).map_err(Error::stage)?;
    }
    let mut assets = BTreeMap::new();
    for scene in manifest.scenes.keys() {
        assets.extend(scene_assets(workdir, scene)?.map(|found| (scene.clone(), found)));
    }
    let mut scenes: BTreeMap<String, BTreeSet<String>> = Partition::ALL.iter().map(|p| (p.name().into(), BTreeSet::new())).collect();
    for scene in manifest.scenes.keys() {
        scenes.entry(config.partition(scene).name().into()).or_default().insert(scene.clone());
    }
    let mut images: BTreeMap<String, usize> = BTreeMap::new();
    for SplitRow { partition, .. } in &rows {
        *images.entry(partition.as_ref().map_or("excluded", |p| p.name()).into()).or_default() += 1;
    }
    let shared_assets = shared_assets(&assets, |scene| config.partition(scene));
    let report = SplitReport { config, scenes, images, shared_assets };
    let path = dataset.layout().split_report();
    if read_json::<SplitReport>(&path).as_ref() != Some(&report) {
        write_json(&path, &report)?;
    }
    Ok(report)
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
    let Ok(decoded) = enfilade_scene::from_bytes(&bytes) else { return Ok(None) };
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
        let report =
            |shared_assets| SplitReport { config: SplitConfig::default(), scenes: BTreeMap::new(), images: BTreeMap::new(), shared_assets };
        let expected = "1 assets are on several sides of the split, among them mesh \"vase\" of hall, bedroom";
        assert_eq!(report(vec![shared(true), shared(false)]).warning().as_deref(), Some(expected));
        assert_eq!(report(vec![shared(false)]).warning(), None);
    }

    #[test]
    fn a_choice_that_means_nothing_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        drop(Workdir::create(folder.path()).unwrap());
        let error = split(folder.path(), |config| config.shares = [0.0; 3]).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("expected three numbers"), "{error}");
    }
}
