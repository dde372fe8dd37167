//! COCO object detection: `images/`, and `annotations/instances.json` as pycocotools loads it.
//!
//! A mask is run-length encoded down the columns, first run of background, and stored as COCO's compressed string: differences to
//! the run before the last in groups of five bits (`rleToString` of `maskApi.c`). Boxes are `[x, y, width, height]` in pixels from
//! the upper left corner of the image and fit the mask exactly, like those of `toBbox`.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::instances::{Instance, instances, warn_of_none};
use crate::picture::{SHOWN, color_jpeg};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_dataset::{Class, Classes};
use enfilade_frame::{Frame, Layer};
use enfilade_label::instances::run_lengths;
use enfilade_scene::{NYU40, is_stuff};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Annotations {
    info: Info,
    licenses: Vec<()>,
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    categories: Vec<Category>,
}

#[derive(Serialize)]
pub(super) struct Info {
    description: &'static str,
    version: &'static str,
}

/// A picture, as all files of COCO list them.
#[derive(Serialize)]
pub(super) struct Image {
    pub id: usize,
    file_name: String,
    width: u32,
    height: u32,
    scene: String,
    camera: String,
    frame: u32,
}

#[derive(Serialize)]
struct Annotation {
    id: usize,
    image_id: usize,
    category_id: i16,
    segmentation: Rle,
    area: usize,
    bbox: [u32; 4],
    iscrowd: u8,
    instance: i16,
}

#[derive(Serialize)]
struct Rle {
    /// Height and width.
    size: [u32; 2],
    counts: String,
}

/// A class.
#[derive(PartialEq, Serialize)]
pub(super) struct Category {
    pub id: i16,
    name: String,
    supercategory: &'static str,
}

impl Category {
    /// True for classes whose instances are counted.
    pub fn is_thing(&self) -> bool {
        self.supercategory == "thing"
    }
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut all =
        Annotations { info: info(), licenses: Vec::new(), images: Vec::new(), annotations: Vec::new(), categories: categories(selected)? };
    let frames = selected.each(|view| write_frame(selected, out, view, &all.categories))?;
    for (image, annotations) in frames {
        let image_id = all.images.len() + 1;
        for annotation in annotations {
            all.annotations.push(Annotation { id: all.annotations.len() + 1, image_id, ..annotation });
        }
        all.images.push(Image { id: image_id, ..image });
    }
    warn_of_none(selected, !all.annotations.is_empty())?;
    let text = serde_json::to_string(&all).expect("plain data encodes");
    out.write("annotations/instances.json", text.as_bytes())
}

/// The program that made the file.
pub(super) fn info() -> Info {
    Info { description: "Rendered by enfilade; see README.md", version: env!("CARGO_PKG_VERSION") }
}

/// The classes of the scenes: of all the same, because a number has one meaning in a file.
pub(super) fn categories(selected: &SelectedFrames<'_>) -> Result<Vec<Category>, ExportError> {
    let mut all: Option<(&str, Vec<Category>)> = None;
    for tracks in selected.scenes() {
        let scene = tracks[0].scene.as_str();
        let here = categories_of(selected, scene)?;
        match &all {
            None => all = Some((scene, here)),
            Some((_, known)) if *known == here => {}
            Some((first, _)) => {
                let problem = format!("its classes are not those of {first:?}, and a file has one list; export scenes apart with --scene");
                return Err(selected.unsuitable(scene, problem));
            }
        }
    }
    Ok(all.map(|(_, categories)| categories).unwrap_or_default())
}

/// The classes of a scene, by number.
fn categories_of(selected: &SelectedFrames<'_>, scene: &str) -> Result<Vec<Category>, ExportError> {
    let classes = selected.dataset.mesh_files(scene).read_classes()?.unwrap_or_else(Classes::nyu40);
    let stuff = |name: &str| NYU40.iter().any(|class| is_stuff(class.id) && class.name == name);
    let category = |Class { id, name, .. }: &Class| Category {
        id: *id,
        supercategory: if stuff(name) { "stuff" } else { "thing" },
        name: name.clone(),
    };
    Ok(classes.list().iter().map(category).collect())
}

/// Writes the frame's picture; returns its entries in the file, without ids.
fn write_frame(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    view: View<'_>,
    categories: &[Category],
) -> Result<(Image, Vec<Annotation>), ExportError> {
    let [color, entity] = SHOWN;
    let frame = selected.read(view, &[color, entity, Layer::Semantic, Layer::SemanticInstance])?;
    let image = write_image(selected, out, view, &frame)?;
    let classed = |instance: Instance| Some(annotation(&frame, &instance, class_of(&frame, &instance, categories)?));
    Ok((image, instances(&frame).into_iter().filter_map(classed).collect()))
}

/// Writes a frame's picture; returns its entry in the file, without the id.
pub(super) fn write_image(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>, frame: &Frame) -> Result<Image, ExportError> {
    let name = format!("{}/frame.{:04}.jpg", view.track.folder(), view.frame());
    out.write(&format!("images/{name}"), &color_jpeg(selected, view, frame)?)?;
    let (scene, camera) = (view.track.scene.clone(), view.track.name.clone());
    Ok(Image { id: 0, file_name: name, width: frame.width, height: frame.height, scene, camera, frame: view.frame() })
}

/// The class of most of an instance's pixels, the lowest of several; `None` where they have none of the list.
pub(super) fn class_of(frame: &Frame, instance: &Instance, categories: &[Category]) -> Option<i16> {
    let semantic = frame.get(Layer::Semantic)?;
    let mut counts: BTreeMap<i16, usize> = BTreeMap::new();
    instance.pixels.iter().for_each(|&i| *counts.entry(semantic.get(i) as i16).or_default() += 1);
    counts.retain(|class, _| categories.binary_search_by_key(class, |category| category.id).is_ok());
    counts.into_iter().max_by_key(|&(class, count)| (count, -class)).map(|(class, _)| class)
}

fn annotation(frame: &Frame, instance: &Instance, category_id: i16) -> Annotation {
    let [x_min, y_min, x_max, y_max] = instance.extent(frame.width);
    Annotation {
        id: 0,
        image_id: 0,
        category_id,
        segmentation: Rle { size: [frame.height, frame.width], counts: compress(&runs(instance, frame.width, frame.height)) },
        area: instance.pixels.len(),
        bbox: [x_min, y_min, x_max - x_min + 1, y_max - y_min + 1],
        iscrowd: 0,
        instance: instance.number,
    }
}

/// Lengths of runs down the columns, of background and mask in turn.
fn runs(instance: &Instance, width: u32, height: u32) -> Vec<i64> {
    let mut places: Vec<u32> = instance.pixels.iter().map(|&i| i as u32 % width * height + i as u32 / width).collect();
    places.sort_unstable();
    run_lengths(&places, width * height).into_iter().map(i64::from).collect()
}

/// COCO's string of runs: from the fourth on, each is stored as its difference to the run before the last.
fn compress(runs: &[i64]) -> String {
    let mut text = String::new();
    for (i, &run) in runs.iter().enumerate() {
        let mut rest = if i > 2 { run - runs[i - 2] } else { run };
        loop {
            let low = (rest & 0x1f) as u8;
            rest >>= 5;
            let ends = if low & 0x10 == 0 { rest == 0 } else { rest == -1 };
            text.push(char::from(48 + low + if ends { 0 } else { 0x20 }));
            if ends {
                break;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse of [`compress`], after `rleFrString`.
    fn decompress(text: &str) -> Vec<i64> {
        let mut runs: Vec<i64> = Vec::new();
        let mut bytes = text.bytes().map(|b| i64::from(b) - 48);
        while let Some(mut group) = bytes.next() {
            let (mut value, mut shift) = (0, 0);
            loop {
                value |= (group & 0x1f) << shift;
                shift += 5;
                if group & 0x20 == 0 {
                    break;
                }
                group = bytes.next().unwrap();
            }
            if group & 0x10 != 0 {
                value |= -1 << shift;
            }
            if runs.len() > 2 {
                value += runs[runs.len() - 2];
            }
            runs.push(value);
        }
        runs
    }

    #[test]
    fn runs_come_back_from_their_string() {
        for runs in [vec![0, 5], vec![3, 1, 4, 1, 5, 92, 65], vec![100_000, 1, 31, 32, 33, 1000, 1, 16, 15, 17]] {
            assert_eq!(decompress(&compress(&runs)), runs);
        }
        // pycocotools: encode(asfortranarray([[0, 1], [1, 1]])) has the counts b"13".
        assert_eq!(compress(&[1, 3]), "13");
    }

    #[test]
    fn runs_go_down_the_columns_and_fill_the_image() {
        let instance = |pixels: &[usize]| Instance { number: 1, semantic: 1, pixels: pixels.to_vec() };
        // 3 columns, 2 rows.
        assert_eq!(runs(&instance(&[0, 3, 5]), 3, 2), [0, 2, 3, 1]);
        assert_eq!(runs(&instance(&[1]), 3, 2), [2, 1, 3]);
        assert_eq!(runs(&instance(&[0, 1, 2, 3, 4, 5]), 3, 2), [0, 6]);
    }
}
