//! Visibility of each instance in each frame: `metadata_frame_instances.csv` and the amodal masks beside it.
//!
//! A box is in image coordinates: `x_min`, `y_min` are the left and upper border of its first pixel, `x_max`, `y_max` the right and
//! lower border of its last, so that a box of one pixel is 1 wide. Boxes of whole objects may reach beyond the image.

use crate::atomic::remove_if_there;
use crate::frames::read_json;
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name, write_bytes};
use enfilade_scene::NYU40;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::PathBuf;

const HEADER: [&str; 17] = [
    "frame_id",
    "semantic_instance_id",
    "semantic_id",
    "semantic_name",
    "visible_x_min",
    "visible_y_min",
    "visible_x_max",
    "visible_y_max",
    "full_x_min",
    "full_y_min",
    "full_x_max",
    "full_y_max",
    "visible_pixels",
    "inside_pixels",
    "full_pixels",
    "visibility",
    "truncation",
];

/// A set of pixels: how many, and the box around them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PixelArea {
    /// Number of pixels.
    pub pixels: u64,
    /// Left, upper, right and lower border; all 0 when there are none.
    pub bounds: [i32; 4],
}

impl PixelArea {
    /// The set with pixel (x, y), which it did not have.
    #[must_use]
    pub fn with(self, x: i32, y: i32) -> Self {
        self.union(Self { pixels: 1, bounds: [x, y, x + 1, y + 1] })
    }

    /// The union of two sets that have no pixel in common.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.bounds, other.bounds);
        match (self.pixels, other.pixels) {
            (_, 0) => self,
            (0, _) => other,
            _ => Self { pixels: self.pixels + other.pixels, bounds: [a.min(e), b.min(f), c.max(g), d.max(h)] },
        }
    }
}

/// The visibility of an instance in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InstanceView {
    /// Frame number.
    pub frame: u32,
    /// Instance number.
    pub instance: i16,
    /// Class of the instance.
    pub semantic: i16,
    /// The pixels of `semantic_instance` that have its number.
    pub visible: PixelArea,
    /// The pixels that the whole object covers in an image three times as wide and high, as if nothing else were there.
    pub full: PixelArea,
    /// Number of those pixels that are inside the image.
    pub inside_pixels: u64,
}

impl InstanceView {
    /// Visible share of the whole object, 0 to 1: what others hide and what the image cuts off are both missing.
    pub fn visibility(&self) -> f64 {
        self.visible.pixels as f64 / self.full.pixels.max(1) as f64
    }

    /// Share of the whole object that is outside of the image, 0 to 1.
    pub fn truncation(&self) -> f64 {
        1.0 - self.inside_pixels as f64 / self.full.pixels.max(1) as f64
    }
}

/// The pixels of the image that whole objects cover, hidden ones included, in the uncompressed run lengths of COCO.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AmodalMasks {
    /// Height and width of the image.
    pub size: [u32; 2],
    /// In ascending order of instance number.
    pub instances: Vec<AmodalMask>,
}

/// The mask of one object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AmodalMask {
    /// Instance number.
    pub semantic_instance_id: i16,
    /// Lengths of the runs of pixels outside, inside, outside, … column by column from the left, each from the top.
    pub counts: Vec<u32>,
}

impl Dataset {
    /// Writes the table of a camera.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_instance_views(&self, scene: &str, camera: &str, views: &[InstanceView]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let mut table = Table::new(&self.layout().frame_instances(scene, camera), &HEADER);
        table.rows = views.iter().map(row_of).collect();
        table.write()
    }

    /// The table of a camera.
    ///
    /// # Errors
    /// When it is missing or damaged.
    pub fn read_instance_views(&self, scene: &str, camera: &str) -> Result<Vec<InstanceView>, DatasetError> {
        let table = Table::read(&self.layout().frame_instances(scene, camera))?;
        let columns = HEADER.map(|name| table.column(name));
        let mut at = [0; HEADER.len()];
        for (at, column) in at.iter_mut().zip(columns) {
            *at = column?;
        }
        let view = |row: usize| {
            let count = |column: usize| table.parse::<u64>(row, at[column]);
            let bounds = |first: usize, pixels: u64| -> Result<[i32; 4], DatasetError> {
                let mut bounds = [0; 4];
                for (i, bound) in bounds.iter_mut().enumerate().filter(|_| pixels > 0) {
                    *bound = table.parse(row, at[first + i])?;
                }
                Ok(bounds)
            };
            let (visible, full) = (count(12)?, count(14)?);
            Ok(InstanceView {
                frame: table.parse(row, at[0])?,
                instance: table.parse(row, at[1])?,
                semantic: table.parse(row, at[2])?,
                visible: PixelArea { pixels: visible, bounds: bounds(4, visible)? },
                full: PixelArea { pixels: full, bounds: bounds(8, full)? },
                inside_pixels: count(13)?,
            })
        };
        (0..table.rows.len()).map(view).collect()
    }

    /// Writes the amodal masks of a frame.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_amodal_masks(&self, scene: &str, camera: &str, frame: u32, masks: &AmodalMasks) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        write_bytes(&self.layout().amodal_masks(scene, camera, frame), serde_json::to_vec(masks).expect("plain data encodes"))
    }

    /// Removes the amodal masks of a camera but for those of the frames `kept`, so that none of an older trajectory stays.
    ///
    /// # Errors
    /// When a file cannot be removed.
    pub fn remove_amodal_masks(&self, scene: &str, camera: &str, kept: impl Iterator<Item = u32>) -> Result<(), DatasetError> {
        let folder = self.layout().amodal_masks_dir(scene, camera);
        let kept: BTreeSet<PathBuf> = kept.map(|frame| self.layout().amodal_masks(scene, camera, frame)).collect();
        let entries = match std::fs::read_dir(&folder) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(DatasetError::at("read", &folder))?,
        };
        for entry in entries {
            let path = entry.map_err(DatasetError::at("read", &folder))?.path();
            if !kept.contains(&path) {
                remove_if_there(&path)?;
            }
        }
        Ok(())
    }

    /// The amodal masks of a frame; `None` when it has none.
    ///
    /// # Errors
    /// When the file cannot be read or understood.
    pub fn read_amodal_masks(&self, scene: &str, camera: &str, frame: u32) -> Result<Option<AmodalMasks>, DatasetError> {
        read_json(&self.layout().amodal_masks(scene, camera, frame), "delete it and run the boxes stage again")
    }
}

fn row_of(view: &InstanceView) -> Vec<String> {
    let name = NYU40.iter().find(|class| class.id == view.semantic).map_or("unlabelled", |class| class.name);
    let mut row = vec![view.frame.to_string(), view.instance.to_string(), view.semantic.to_string(), name.to_string()];
    for area in [&view.visible, &view.full] {
        row.extend(area.bounds.map(|bound| if area.pixels > 0 { bound.to_string() } else { String::new() }));
    }
    row.extend([view.visible.pixels, view.inside_pixels, view.full.pixels].map(|count| count.to_string()));
    row.extend([view.visibility(), view.truncation()].map(|share| format!("{share:.6}")));
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_come_back_and_their_shares_are_written_out() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let full = PixelArea { pixels: 40, bounds: [-5, 2, 5, 6] };
        let seen = InstanceView { frame: 3, instance: 2, semantic: 5, visible: PixelArea::default().with(0, 4), full, inside_pixels: 10 };
        let hidden = InstanceView { frame: 3, instance: 4, semantic: -1, visible: PixelArea::default(), ..seen };
        dataset.write_instance_views("room", "cam_00", &[seen, hidden]).unwrap();
        assert_eq!(dataset.read_instance_views("room", "cam_00").unwrap(), [seen, hidden]);
        let text = std::fs::read_to_string(dataset.layout().frame_instances("room", "cam_00")).unwrap();
        assert!(text.contains("\n3,2,5,chair,0,4,1,5,-5,2,5,6,1,10,40,0.025000,0.750000\n"), "{text}");
        assert!(text.contains("\n3,4,-1,unlabelled,,,,,-5,2,5,6,0,10,40,0.000000,0.750000\n"), "{text}");
    }

    #[test]
    fn masks_come_back_until_they_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert_eq!(dataset.read_amodal_masks("room", "cam_00", 7).unwrap(), None);
        let masks = AmodalMasks { size: [4, 3], instances: vec![AmodalMask { semantic_instance_id: 2, counts: vec![3, 2, 7] }] };
        dataset.write_amodal_masks("room", "cam_00", 7, &masks).unwrap();
        assert_eq!(dataset.read_amodal_masks("room", "cam_00", 7).unwrap(), Some(masks));
        dataset.write_amodal_masks("room", "cam_00", 8, &AmodalMasks::default()).unwrap();
        dataset.remove_amodal_masks("room", "cam_00", [8].into_iter()).unwrap();
        dataset.remove_amodal_masks("room", "cam_01", [8].into_iter()).unwrap();
        assert!(dataset.read_amodal_masks("room", "cam_00", 8).unwrap().is_some());
        assert_eq!(dataset.read_amodal_masks("room", "cam_00", 7).unwrap(), None);
    }
}
