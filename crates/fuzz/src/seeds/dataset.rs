//! A small dataset with every kind of file, and its tables, records and arrays as seeds.

use super::seed;
use crate::Seed;
use enfilade_dataset::hdf5::{Packing, Storage, write_array};
use enfilade_dataset::{
    AmodalMask, AmodalMasks, Array, BoxKind, Dataset, DescribedInstance, Elements, InstanceRelation, InstanceView, JudgedView,
    ManifestInfo, PartitionRow, PixelArea, RelationKind, Side, ToneMapRow, ViewFault, ViewVerdict,
};
use enfilade_math::{DMat3, DVec2, DVec3, OrientedBox};
use enfilade_scene::Intrinsics;
use std::path::{Path, PathBuf};

#[allow(dead_code, reason = "made for other tests, of which a part is used")]
#[path = "../../../dataset/tests/all/analytic/mod.rs"]
mod analytic;
#[path = "../../../dataset/tests/all/damaged/mod.rs"]
mod damaged;

pub use analytic::{CAMERA, SCENE};

/// Seeds longer than this make searching slow and show nothing that shorter ones do not.
const MAX_SEED: usize = 6 << 10;

/// Writes the dataset.
pub fn write(root: &Path) -> Dataset {
    let dataset = Dataset::create(root).expect("a folder that can be written");
    let camera = Intrinsics { width: 8, height: 6, fx: 7.0, fy: 7.5, cx: 4.0, cy: 3.5, skew: 0.0 };
    analytic::write(&dataset, &camera, 2);
    more(&dataset).expect("a folder that can be written");
    dataset
}

/// Adds the optional files of a dataset.
fn more(dataset: &Dataset) -> Result<(), enfilade_dataset::DatasetError> {
    let split = |partition| PartitionRow { scene: SCENE.into(), camera: CAMERA.into(), frame: 0, side: partition };
    dataset.write_partition(&[split(Ok(Side::Train)), split(Err("blank".into()))])?;
    let fault = Some(ViewFault { gate: "blocked".into(), value: 0.75, limit: 0.5 });
    let view = |verdict, fault| (JudgedView { frame: 1, verdict, fault }, vec![0.25]);
    dataset.write_view_gates(SCENE, CAMERA, &["void_share"], &[view(ViewVerdict::Rejected, fault), view(ViewVerdict::Passed, None)])?;
    let row = ToneMapRow {
        frame: 0,
        percentile: 90.0,
        brightness: Some(0.7),
        scale: 0.3,
        gamma: 0.45,
        display_scale: 0.25,
        display_white: [1.0; 3],
    };
    dataset.write_tone_maps(SCENE, CAMERA, &[row])?;
    let area = PixelArea { pixels: 4, bounds: [1, 2, 3, 4] };
    let shown = InstanceView { frame: 0, instance: 1, semantic: 5, visible: area, full: area, inside_pixels: 4 };
    dataset.write_instance_views(SCENE, CAMERA, &[shown])?;
    let mask = AmodalMask { semantic_instance_id: 1, counts: vec![3, 4, 41] };
    dataset.write_amodal_masks(SCENE, CAMERA, 0, &AmodalMasks { size: [6, 8], instances: vec![mask] })?;
    let made = OrientedBox { center: DVec3::ONE, world_from_box: DMat3::IDENTITY, extents: DVec3::splat(2.0) };
    BoxKind::ALL.iter().try_for_each(|&kind| dataset.write_boxes(SCENE, kind, &[None, Some(made)]))?;
    let tree = super::octrees().swap_remove(0).bytes;
    dataset.write_free_space(SCENE, &tree, DVec3::ZERO, DVec3::ONE)?;
    let lamp = DescribedInstance {
        instance: 1,
        semantic: 35,
        semantic_name: "lamp".into(),
        name: "lamp_1".into(),
        noun: "table lamp".into(),
        room: "study_1".into(),
        color: "white".into(),
        material: "linen".into(),
        center: DVec3::ONE,
        size_m: DVec3::splat(0.3),
        front: Some(DVec2::X),
    };
    dataset.write_described_instances(SCENE, &[lamp])?;
    let stands = InstanceRelation { subject: 1, kind: RelationKind::On, object: -1, object_semantic: 2, distance_m: 0.001 };
    dataset.write_instance_relations(SCENE, &[stands])?;
    dataset.write_manifest(&dataset.collect_manifest(&ManifestInfo::default())?)
}

/// All files below a folder with this extension, sorted.
pub fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder that can be listed");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder that can be listed").path()).collect();
    paths.sort();
    let below = |path: PathBuf| if path.is_dir() { files(&path, extension) } else { vec![path] };
    paths.into_iter().flat_map(below).filter(|path| path.extension().is_some_and(|found| found == extension)).collect()
}

/// The dataset's files with this extension, those that are not long.
fn seeds(extension: &str) -> Vec<Seed> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(folder.path());
    let read = |file: PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        seed(&name, std::fs::read(&file).expect("a file that can be read"))
    };
    files(folder.path(), extension).into_iter().map(read).filter(|seed| seed.bytes.len() <= MAX_SEED).collect()
}

/// Every table.
pub fn tables() -> Vec<Seed> {
    seeds("csv")
}

/// Every record.
pub fn records() -> Vec<Seed> {
    seeds("json")
}

/// Every array, one for each way of storing, and one whose tree of chunks could be walked for ever.
pub fn arrays() -> Vec<Seed> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.hdf5");
    let array = Array::new(&[9, 7, 3], Elements::I16((0..189).collect()));
    let image = |channels_together| Storage::Image(Packing { chunk: [4, 4], channels_together, shuffle: true, level: 6 });
    let stored = [
        ("one_run", Storage::Contiguous),
        ("compressed", Storage::Compressed),
        ("channels_together", image(true)),
        ("planes", image(false)),
    ];
    let stored = stored.map(|(name, storage)| {
        write_array(&path, &array, storage, &[("unit", "m")]).expect("a folder that can be written");
        seed(name, std::fs::read(&path).expect("a file that can be read"))
    });
    let list = Array::i64(&[9], (0..9).collect());
    write_array(&path, &list, Storage::Compressed, &[]).expect("a folder that can be written");
    let branching = damaged::branching_tree(&std::fs::read(&path).expect("a file that can be read"), 1, 32);
    stored.into_iter().chain([seed("branching_tree", branching)]).chain(seeds("hdf5")).collect()
}
