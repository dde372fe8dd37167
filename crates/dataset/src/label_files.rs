//! The label tables of the mesh folder: which class and which instance every object belongs to, and their display colours.

use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::mesh_names::{INSTANCE_COLORS, OBJECTS_INSTANCE, OBJECTS_SEMANTIC, SEMANTIC_COLORS};
use crate::{Dataset, DatasetError, MeshFiles, check_name, replace_file};
use enfilade_math::Rng;
use enfilade_scene::{Labels, NYU40, PartLabel};
use std::path::{Path, PathBuf};

/// Display colours of labels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelColors {
    /// sRGB by class: row `i` is class `i`; row 0 and numbers without a class are −1.
    pub semantic: Vec<[i64; 3]>,
    /// Number of instance numbers that were given out, whether or not they are in use: one colour each.
    pub instances: usize,
}

impl LabelColors {
    /// NYU40's colours, and as many of instances as the labels have.
    pub fn nyu40(labels: &Labels) -> Self {
        let instances = labels.parts.iter().map(|l| l.instance).max().unwrap_or(0).max(0) as usize;
        Self { semantic: semantic_colors(), instances }
    }
}

impl Dataset {
    /// Writes the label tables `mesh_objects_{si,sii}.hdf5` (one row per part) and both colour tables.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_label_tables(&self, scene: &str, labels: &Labels) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        self.mesh_files(scene).write_labels(labels, &LabelColors::nyu40(labels)).map(drop)
    }

    /// The label tables: `parts[i]` belongs to object `i`, which in our datasets is part `i` unless parts were split.
    ///
    /// # Errors
    /// When a table is missing or damaged, or the two differ in length.
    pub fn read_label_tables(&self, scene: &str) -> Result<Labels, DatasetError> {
        self.mesh_files(scene).read_labels()
    }
}

impl MeshFiles {
    /// Writes the label tables `mesh_objects_{si,sii}.hdf5` (one row per object) and both colour tables; returns the files.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_labels(&self, labels: &Labels, colors: &LabelColors) -> Result<Vec<PathBuf>, DatasetError> {
        let column =
            |of: fn(&PartLabel) -> i16| Array::i64(&[labels.parts.len(), 1], labels.parts.iter().map(|l| i64::from(of(l))).collect());
        let rows = |colors: &[[i64; 3]]| Array::i64(&[colors.len(), 3], colors.iter().flatten().copied().collect());
        let files = [
            (OBJECTS_SEMANTIC, column(|label| label.semantic)),
            (OBJECTS_INSTANCE, column(|label| label.instance)),
            (SEMANTIC_COLORS, rows(&colors.semantic)),
            (INSTANCE_COLORS, rows(&instance_colors(colors.instances))),
        ];
        let write = |(name, array): &(&str, Array)| {
            let path = self.file(name);
            replace_file(&path, |aside| write_array(aside, array, Storage::Contiguous, &[])).map(|()| path)
        };
        files.iter().map(write).collect()
    }

    /// The greatest class of the list that the labels choose from, by the table of colours; 40 where that is missing.
    ///
    /// # Errors
    /// When the table is damaged.
    pub fn read_last_class(&self) -> Result<i16, DatasetError> {
        match read_array(&self.file(SEMANTIC_COLORS)) {
            Ok(array) => Ok(array.shape.first().map_or(0, |rows| rows.saturating_sub(1)).try_into().unwrap_or(i16::MAX)),
            Err(error) if error.is_not_found() => Ok(NYU40.len() as i16),
            Err(error) => Err(error),
        }
    }

    /// The label tables: `parts[i]` belongs to object `i`.
    ///
    /// # Errors
    /// When a table is missing or damaged, or the two differ in length.
    pub fn read_labels(&self) -> Result<Labels, DatasetError> {
        let semantic = read_column(&self.file(OBJECTS_SEMANTIC))?;
        let path = self.file(OBJECTS_INSTANCE);
        let instance = read_column(&path)?;
        if semantic.len() != instance.len() {
            let problem = format!(
                "{} rows, but {OBJECTS_SEMANTIC} has {}; run the label stage again, or open the folder in `enfilade annotate`, if that wrote both",
                instance.len(),
                semantic.len()
            );
            return Err(DatasetError::hdf5(&path, problem));
        }
        let parts = semantic.into_iter().zip(instance).map(|(semantic, instance)| PartLabel { semantic, instance }).collect();
        Ok(Labels { parts })
    }
}

/// Reads a column of int64 labels.
fn read_column(path: &Path) -> Result<Vec<i16>, DatasetError> {
    let Array { values, shape } = read_array(path)?;
    let Elements::I64(values) = values else {
        return Err(DatasetError::hdf5(path, format!("expected int64, found {} of shape {shape:?}", values.element().name())));
    };
    let label = |(row, value): (usize, i64)| {
        i16::try_from(value).map_err(|_| DatasetError::hdf5(path, format!("row {row}: the label {value} does not fit the images' int16")))
    };
    values.into_iter().enumerate().map(label).collect()
}

/// Display colours of the semantic classes, sRGB: row `i` is class `i`, row 0 is −1.
pub fn semantic_colors() -> Vec<[i64; 3]> {
    std::iter::once([-1; 3]).chain(NYU40.iter().map(|class| class.color.map(i64::from))).collect()
}

/// Display colours of instances 1 to `instances`, sRGB: row `i` is instance `i`, row 0 is −1. Neighbouring numbers differ by at
/// least 45° of hue: Hypersim's rule, of saturated colours but for the first. A longer table begins like a shorter one.
pub fn instance_colors(instances: usize) -> Vec<[i64; 3]> {
    let mut rng = Rng::new(0);
    let mut previous: Option<f64> = None;
    let mut colors = vec![[-1; 3]];
    for _ in 0..instances {
        let mut hue_deg = 360.0 * rng.next_f64();
        while previous.is_some_and(|previous| hue_distance_deg(hue_deg, previous) < 45.0) {
            hue_deg = 360.0 * rng.next_f64();
        }
        let (saturation, value) = if previous.is_none() { (0.8, 1.0) } else { (1.0, 0.8) };
        colors.push(rgb_from_hsv(hue_deg, saturation, value));
        previous = Some(hue_deg);
    }
    colors
}

fn hue_distance_deg(a: f64, b: f64) -> f64 {
    let d = (a - b).abs();
    d.min(360.0 - d)
}

/// sRGB on 0 to 255.
fn rgb_from_hsv(hue_deg: f64, saturation: f64, value: f64) -> [i64; 3] {
    [5.0, 3.0, 1.0].map(|n| {
        let k = (n + hue_deg / 60.0) % 6.0;
        let channel = value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0);
        (255.0 * channel).round() as i64
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_come_back_with_their_colours() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let label = |semantic, instance| PartLabel { semantic, instance };
        let labels = Labels { parts: vec![label(1, -1), label(5, 1), label(5, 3), PartLabel::NONE] };
        dataset.write_label_tables("room", &labels).unwrap();
        assert_eq!(dataset.read_label_tables("room").unwrap(), labels);
        let read = |name: &str| read_array(&dataset.layout().mesh_file("room", name)).unwrap();
        assert_eq!(read("mesh_objects_si.hdf5"), Array::i64(&[4, 1], vec![1, 5, 5, -1]));
        assert_eq!(read("metadata_semantic_colors.hdf5").shape, [41, 3]);
        assert_eq!(read("metadata_semantic_instance_colors.hdf5").shape, [4, 3]);
    }

    #[test]
    fn colours_are_the_same_for_every_length_and_neighbours_differ() {
        let colors = instance_colors(200);
        assert_eq!(colors[..11], instance_colors(10)[..]);
        assert_eq!(colors[0], [-1; 3]);
        assert_eq!(colors[1].iter().max(), Some(&255));
        for pair in colors[2..].windows(2) {
            assert_eq!((pair[0].iter().min(), pair[0].iter().max()), (Some(&0), Some(&204)));
            assert!(pair[0].iter().zip(&pair[1]).any(|(a, b)| (a - b).abs() > 75), "{pair:?}");
        }
        assert_eq!(rgb_from_hsv(0.0, 1.0, 1.0), [255, 0, 0]);
        assert_eq!(rgb_from_hsv(120.0, 1.0, 0.8), [0, 204, 0]);
        assert_eq!(rgb_from_hsv(210.0, 1.0, 1.0), [0, 128, 255]);
    }

    #[test]
    fn hypersims_own_tables_are_read() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let mesh = Path::new(&scenes).join("../golden/post/_detail/mesh");
        if !mesh.is_dir() {
            return eprintln!("skipped: no golden results beside the scenes");
        }
        let labels = read_column(&mesh.join("mesh_objects_si.hdf5")).unwrap();
        assert_eq!((labels.len(), &labels[..4]), (86, &[35, 26, 21, 11][..]));
        assert_eq!(read_column(&mesh.join("mesh_objects_sii.hdf5")).unwrap()[..3], [1, 2, 3]);
    }
}
