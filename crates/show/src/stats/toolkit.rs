//! Histograms as Hypersim's toolkit stores them: one HDF5 array of int64 each, under its names, so that its plots show our datasets
//! and ours show its own.

use super::measure::{CLASSES, Counts, LIGHTS, SIDE};
use enfilade_dataset::hdf5::{Storage, read_array, write_array};
use enfilade_dataset::{Array, DatasetError, Elements, replace_file};
use std::path::{Path, PathBuf};

/// Folder of the histograms.
pub const FOLDER: &str = "image_statistics";

/// A named array of a [`Counts`].
struct Named<'a> {
    stem: String,
    shape: Vec<usize>,
    counts: &'a mut Vec<u64>,
}

/// Every array, under Hypersim's names. Values beyond the bins have no place there.
fn arrays(counts: &mut Counts) -> Vec<Named<'_>> {
    let mut named = Vec::new();
    let mut put = |stem: String, counts| named.push((stem, counts));
    for (light, counts) in LIGHTS.iter().zip(&mut counts.lights) {
        put(format!("{}_brightness_hist_linear", light.stem), &mut counts.linear.counts);
        put(format!("{}_brightness_hist_log", light.stem), &mut counts.log.counts);
        put(format!("{}_hue_saturation_hist", light.stem), &mut counts.hue_saturation.counts);
    }
    put("depth_hist_linear".into(), &mut counts.depth.counts);
    put("depth_hist_log".into(), &mut counts.depth_log.counts);
    put("normal_hist".into(), &mut counts.normals.counts);
    put("pixels_per_class_hist".into(), &mut counts.pixels_per_class);
    put("unique_classes_per_image_hist".into(), &mut counts.classes_per_image);
    put("unique_objects_per_image_hist".into(), &mut counts.objects_per_image);
    put("unique_objects_per_class_hist".into(), &mut counts.objects_per_class);
    put("object_volume_hist_linear".into(), &mut counts.volumes.counts);
    put("object_volume_hist_log".into(), &mut counts.volumes_log.counts);
    let shape = |stem: &str, length: usize| {
        let is_map = stem == "normal_hist" || stem.ends_with("hue_saturation_hist");
        if is_map { vec![SIDE, SIDE] } else { vec![length] }
    };
    named.into_iter().map(|(stem, counts): (String, &mut Vec<u64>)| Named { shape: shape(&stem, counts.len()), stem, counts }).collect()
}

/// Writes the histograms into the folder and returns the files.
///
/// # Errors
/// When a file cannot be written.
pub fn write_histograms(folder: &Path, counts: &Counts) -> Result<Vec<PathBuf>, DatasetError> {
    let mut counts = counts.clone();
    let one = |named: Named<'_>| {
        let path = folder.join(format!("metadata_{}.hdf5", named.stem));
        let values = Elements::I64(named.counts.iter().map(|&count| count as i64).collect());
        let array = Array { shape: named.shape, values };
        replace_file(&path, |aside| write_array(aside, &array, Storage::Contiguous, &[]))?;
        Ok(path)
    };
    arrays(&mut counts).into_iter().map(one).collect()
}

/// The histograms below a folder, added up over its batches; `None` when there are none.
///
/// # Errors
/// When the folder or a file cannot be read, or an array is of another shape.
pub fn read_histograms(folder: &Path) -> Result<Option<Counts>, DatasetError> {
    let folders = folders_below(folder)?;
    let mut counts = Counts::default();
    let mut found = false;
    for Named { stem, shape, counts } in arrays(&mut counts) {
        for folder in &folders {
            let path = folder.join(format!("metadata_{stem}.hdf5"));
            if !path.is_file() {
                continue;
            }
            found = true;
            let array = read_array(&path)?;
            match array.values {
                Elements::I64(values) if array.shape == shape => {
                    counts.iter_mut().zip(values).for_each(|(count, value)| *count += value.max(0) as u64);
                }
                other => {
                    let problem = format!("expected int64 of shape {shape:?}, found {} of {:?}", other.element().name(), array.shape);
                    let problem = format!("{problem}; name a folder of Hypersim's image statistics or of ours");
                    return Err(DatasetError::Hdf5 { path, problem });
                }
            }
        }
    }
    counts.images = counts.classes_per_image.iter().sum();
    counts.valid = counts.pixels_per_class.iter().sum();
    counts.pixels = counts.valid;
    Ok(found.then_some(counts))
}

/// The folder and all below it, sorted.
fn folders_below(folder: &Path) -> Result<Vec<PathBuf>, DatasetError> {
    let unreadable = |source| DatasetError::Io { action: "read", path: folder.into(), source };
    let mut folders = vec![folder.to_path_buf()];
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_dir() {
            folders.extend(folders_below(&path)?);
        }
    }
    folders.sort();
    Ok(folders)
}

/// Share of pixels by class, without those that have none.
pub fn class_shares(counts: &Counts) -> Vec<f64> {
    let labelled: u64 = counts.pixels_per_class[1..].iter().sum();
    (0..CLASSES).map(|i| if i < 2 { 0.0 } else { counts.pixels_per_class[i] as f64 / labelled.max(1) as f64 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom as testroom;

    #[test]
    fn histograms_come_back_and_batches_add_up() {
        let folder = tempfile::tempdir().unwrap();
        let (_, counts, _) = super::super::measure::measure(&testroom::frame(&testroom::pose()), None);
        let files = write_histograms(&folder.path().join("a"), &counts).unwrap();
        assert!(files.iter().any(|file| file.ends_with("metadata_rgb_color_brightness_hist_log.hdf5")));
        let once = read_histograms(folder.path()).unwrap().unwrap();
        assert_eq!((&once.lights[0].log.counts, once.images), (&counts.lights[0].log.counts, 1));
        write_histograms(&folder.path().join("b/c"), &counts).unwrap();
        let twice = read_histograms(folder.path()).unwrap().unwrap();
        assert_eq!((twice.images, twice.normals.counts[5050]), (2, 2 * once.normals.counts[5050]));
        assert_eq!(read_histograms(&tempfile::tempdir().unwrap().path().join("")).unwrap(), None);
    }
}
