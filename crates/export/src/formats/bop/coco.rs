//! `scene_gt_coco.json`, as bop_toolkit's `calc_gt_coco.py` writes it: masks of visible parts, boxes of whole silhouettes within the image.

use super::records::TruthInfo;
use serde::Serialize;

/// Instances of which less is visible are not to be counted, by `calc_gt_coco.py`.
const LEAST_VISIBLE: f64 = 0.1;

#[derive(Serialize)]
pub(super) struct SceneCoco {
    info: Info,
    licenses: [(); 0],
    categories: Vec<Category>,
    images: Vec<Image>,
    annotations: Vec<Annotation>,
}

#[derive(Serialize)]
struct Info {
    description: String,
    url: &'static str,
    version: &'static str,
}

#[derive(Serialize)]
struct Category {
    id: u32,
    name: String,
    supercategory: &'static str,
}

#[derive(Serialize)]
struct Image {
    id: u32,
    file_name: String,
    width: u32,
    height: u32,
}

/// One visible instance.
#[derive(Serialize)]
struct Annotation {
    id: usize,
    image_id: u32,
    category_id: u32,
    iscrowd: u8,
    area: u64,
    bbox: [u32; 4],
    segmentation: Rle,
    width: u32,
    height: u32,
    ignore: bool,
}

/// Runs down the columns, outside and inside by turns.
#[derive(Clone, Serialize)]
pub(super) struct Rle {
    pub counts: Vec<u32>,
    /// Height and width.
    pub size: [u32; 2],
}

/// What the file says of one instance in one image.
pub(super) struct Silhouette {
    pub visible: Rle,
    /// Left, upper, width and height of the whole silhouette within the image.
    pub bbox: [u32; 4],
}

impl Silhouette {
    /// Of masks row by row, 0 outside.
    pub fn new(visible: &[u8], whole: &[u8], width: u32) -> Self {
        let height = visible.len() as u32 / width.max(1);
        let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
        for i in (0..whole.len() as u32).filter(|i| whole[*i as usize] > 0) {
            for (axis, place) in [i % width, i / width].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(place), high[axis].max(place));
            }
        }
        let places: Vec<u32> = (0..width)
            .flat_map(|x| (0..height).map(move |y| (x, y)))
            .filter(|(x, y)| visible[(y * width + x) as usize] > 0)
            .map(|(x, y)| x * height + y)
            .collect();
        let counts = enfilade_label::instances::run_lengths(&places, width * height);
        Self { visible: Rle { counts, size: [height, width] }, bbox: [low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1] }
    }
}

impl SceneCoco {
    pub fn new(split: &str, ids: impl Iterator<Item = u32>) -> Self {
        let info = Info {
            description: format!("enfilade_{split}"),
            url: "https://github.com/thodan/bop_toolkit",
            version: env!("CARGO_PKG_VERSION"),
        };
        let categories = ids.map(|id| Category { id, name: id.to_string(), supercategory: "enfilade" }).collect();
        Self { info, licenses: [], categories, images: Vec::new(), annotations: Vec::new() }
    }

    pub fn push_image(&mut self, id: u32, file_name: String, [width, height]: [u32; 2]) {
        self.images.push(Image { id, file_name, width, height });
    }

    /// Adds an instance of an object to the last image.
    pub fn push(&mut self, obj_id: u32, info: &TruthInfo, silhouette: Silhouette) {
        let Some(image) = self.images.last() else { return };
        self.annotations.push(Annotation {
            id: self.annotations.len() + 1,
            image_id: image.id,
            category_id: obj_id,
            iscrowd: 0,
            area: info.px_count_visib,
            bbox: silhouette.bbox,
            segmentation: silhouette.visible,
            width: image.width,
            height: image.height,
            ignore: info.visib_fract < LEAST_VISIBLE,
        });
    }
}

/// The objects to be found in an image and how many of each: those of which a tenth is visible, as `enumerate_test_targets.py` counts.
pub(super) fn counted<'a>(seen: impl Iterator<Item = (u32, &'a TruthInfo)>) -> std::collections::BTreeMap<u32, u32> {
    let mut counts = std::collections::BTreeMap::new();
    for (obj_id, _) in seen.filter(|(_, info)| info.visib_fract >= LEAST_VISIBLE) {
        *counts.entry(obj_id).or_default() += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_down_the_columns_and_boxes_count_pixels() {
        // 3 columns, 2 rows; one pixel of the whole is hidden.
        let silhouette = Silhouette::new(&[0, 255, 0, 0, 255, 0], &[0, 255, 255, 0, 255, 0], 3);
        assert_eq!((silhouette.visible.counts, silhouette.visible.size, silhouette.bbox), (vec![2, 2, 2], [2, 3], [1, 0, 2, 2]));
    }
}
