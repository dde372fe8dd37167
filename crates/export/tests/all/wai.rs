//! WAI: the matrix of covisibility, in the order of the frames that are exported.

use enfilade_dataset::{Covisibility, CovisibleFrame, HiddenBy};
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_scene::{Heard, Quiet};
use serde_json::Value;

#[test]
fn covisibility_has_the_rows_and_columns_of_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = crate::common::write(&folder.path().join("dataset"), &crate::common::pinhole());
    let config = ExportConfig::new(Format::Wai, vec!["room".into()]);
    let heard = Heard::default();
    export(&dataset, &config, &folder.path().join("without"), Existing::Refuse, &heard).unwrap();
    assert!(heard.lines().iter().any(|line| line.contains("enfilade make OUT pairs")), "{:?}", heard.lines());

    // The matrix lists the frames in another order.
    let mut frames: Vec<CovisibleFrame> = Vec::new();
    for camera in dataset.cameras("room").unwrap() {
        let numbers = dataset.frame_numbers("room", &camera).unwrap();
        let frame = |frame| CovisibleFrame { camera: camera.clone(), frame, grid_step_px: 4, surface_pixels: 70 };
        frames.extend(numbers.into_iter().map(frame));
    }
    frames.reverse();
    let n = frames.len();
    let share = |row: usize, column: usize| if row == column { 1.0 } else { (10 * row + column) as f32 / 100.0 };
    let mut shares: Vec<f32> = (0..n * n).map(|i| share(i / n, i % n)).collect();
    shares[1] = f32::NAN;
    dataset.write_covisibility("room", &Covisibility { frames, hidden_by: HiddenBy::Distances, shares }).unwrap();
    let out = folder.path().join("with");
    export(&dataset, &config, &out, Existing::Refuse, &Quiet).unwrap();
    let meta: Value = serde_json::from_slice(&std::fs::read(out.join("room/scene_meta.json")).unwrap()).unwrap();
    assert_eq!(meta["frames"].as_array().unwrap().len(), n);
    let key = meta["scene_modalities"]["pairwise_covisibility"]["scene_key"].as_str().unwrap();
    assert!(n > 1 && key.ends_with(&format!("--{n}x{n}.npy")), "{key}");
    let bytes = std::fs::read(out.join("room").join(key)).unwrap();
    // Its loaders skip 128 bytes.
    let found: Vec<f32> = bytes[128..].as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    let expected = |row: usize, column: usize| if (row, column) == (n - 1, n - 2) { 0.0 } else { share(n - 1 - row, n - 1 - column) };
    assert_eq!(found, (0..n * n).map(|i| expected(i / n, i % n)).collect::<Vec<f32>>());
}
