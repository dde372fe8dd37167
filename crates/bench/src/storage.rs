//! The files that `cargo xtask bench storage` compares: layers of real frames, stored in several ways.
//!
//! `storage FOLDER [DATASET...]` takes frame 0 of `cam_00` of every scene in the datasets. Without any it renders a frame of 1024×768 of
//! the demo's room, and of two rooms of `ENFILADE_SCENES` where that is set, to `FOLDER/frames`; a second run renders nothing again. The
//! layers of each are stored in every way of [`ways`] in `FOLDER/files`, and what that took is written to `FOLDER/files.json`.

use anyhow::{Context, Result, ensure};
use enfilade_dataset::hdf5::{Packing, Storage, write_array};
use enfilade_dataset::{Array, Dataset};
use enfilade_frame::Layer;
use enfilade_pipeline::{Config, Overrides, RenderChoices, Silent, Stopwatch};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [1024, 768];
const SAMPLES: u32 = 32;
/// Rooms of `examples/real-rooms`: one with much texture, one with little.
const ROOMS: &str = "bedroom,contemporary-bathroom";
/// Files are written this often; the least time counts.
const WRITES: usize = 5;

const LAYERS: [Layer; 8] = [
    Layer::Color,
    Layer::DiffuseReflectance,
    Layer::DepthMeters,
    Layer::Position,
    Layer::NormalWorld,
    Layer::TexCoord,
    Layer::RenderEntityId,
    Layer::Semantic,
];

/// Runs the instrument.
pub fn run() -> Result<()> {
    let mut words = crate::arguments::arguments().map(PathBuf::from);
    let folder = words.next().context("expected a folder to write to")?;
    let given = words.map(|root| Ok(Dataset::open(root)?)).collect::<Result<Vec<_>>>()?;
    let files = folder.join("files");
    std::fs::create_dir_all(&files)?;
    let mut rows = Vec::new();
    let datasets = if given.is_empty() { frames(&folder.join("frames"))? } else { given };
    for dataset in datasets {
        for scene in dataset.scenes()? {
            println!("storing {scene}");
            for layer in LAYERS {
                rows.extend(store(&dataset, &scene, layer, &files)?);
            }
        }
    }
    let report = json!({ "processor": enfilade_testkit::processor(), "files": rows });
    Ok(std::fs::write(folder.join("files.json"), serde_json::to_string_pretty(&report)?)?)
}

/// The datasets that frames are taken from, made unless they are there.
fn frames(folder: &Path) -> Result<Vec<Dataset>> {
    let render = RenderChoices { samples: Some(SAMPLES), ..RenderChoices::default() };
    let overrides = Overrides { frames: Some(1), size: Some(SIZE), render, ..Overrides::default() };
    let mut wanted = vec![(Config::demo(&overrides)?, folder.join("demo"), None)];
    if std::env::var_os("ENFILADE_SCENES").is_some() {
        let rooms = Config::read(Path::new("examples/real-rooms/dataset.toml"), &overrides)?;
        wanted.push((rooms, folder.join("rooms"), Some(ROOMS)));
    }
    let mut datasets = Vec::new();
    for (config, out, scenes) in wanted {
        println!("rendering {}", out.display());
        ensure!(enfilade_pipeline::run(&config, &out, scenes, &Silent)?.ok(), "{} has failed: run it by itself to see why", out.display());
        datasets.push(Dataset::open(&out)?);
    }
    Ok(datasets)
}

/// The compared ways of storing: ours, the former one, and others that differ in one respect each.
fn ways(layer: Layer) -> Vec<(&'static str, Storage)> {
    let ours = Packing::of_layer(layer);
    let mut ways = vec![
        ("ours", Storage::Image(ours)),
        ("h5py's own chunks, shuffled", Storage::Compressed),
        ("chunks 64x64", Storage::Image(Packing { chunk: [64, 64], ..ours })),
        ("chunks 256x256", Storage::Image(Packing { chunk: [256, 256], ..ours })),
        (if ours.shuffle { "not shuffled" } else { "shuffled" }, Storage::Image(Packing { shuffle: !ours.shuffle, ..ours })),
    ];
    if layer.spec().channels > 1 {
        let other = Packing { channels_together: !ours.channels_together, ..ours };
        ways.push((if ours.channels_together { "channels apart" } else { "channels together" }, Storage::Image(other)));
    }
    let levels = [(1, "level 1"), (6, "level 6"), (9, "level 9"), (12, "level 12")].into_iter().filter(|(level, _)| *level != ours.level);
    ways.extend(levels.map(|(level, name)| (name, Storage::Image(Packing { level, ..ours }))));
    ways
}

fn store(dataset: &Dataset, scene: &str, layer: Layer, folder: &Path) -> Result<Vec<Value>> {
    let spec = layer.spec();
    let frame = dataset.read_frame(scene, "cam_00", 0, &[layer])?;
    let shape = [frame.height as usize, frame.width as usize, spec.channels];
    let values = frame.get(layer).context("a frame has the layers that it was read with")?.clone();
    let array = Array::new(if spec.channels == 1 { &shape[..2] } else { &shape }, values.into());
    let mut rows = Vec::new();
    for (at, (way, storage)) in ways(layer).into_iter().enumerate() {
        let path = folder.join(format!("{scene}.{}.{at}.hdf5", spec.name));
        let mut write_s = f64::INFINITY;
        for _ in 0..WRITES {
            let time = Stopwatch::start();
            write_array(&path, &array, storage, &[])?;
            write_s = write_s.min(time.cpu_s());
        }
        rows.push(json!({ "frame": scene, "layer": spec.name, "way": way, "size": [frame.width, frame.height], "path": path, "write_ms": 1000.0 * write_s }));
    }
    Ok(rows)
}
