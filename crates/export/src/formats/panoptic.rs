//! COCO panoptic segmentation: `images/`, a PNG of segments for each, and `annotations/panoptic.json`, as panopticapi reads them: it looks for
//! the PNG files in the folder that is called as the JSON file is.
//!
//! A pixel of the PNG has the number of its segment, R + 256 G + 65536 B, and 0 where it has no class.

use super::coco::{Category, Image, categories, class_of, info, write_image};
use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::instances::{Instance, instances, warn_of_none};
use crate::picture::{SHOWN, rgb_png};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::{Frame, Layer};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Panoptic {
    info: super::coco::Info,
    licenses: Vec<()>,
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    categories: Vec<PanopticCategory>,
}

#[derive(Serialize)]
struct PanopticCategory {
    #[serde(flatten)]
    category: Category,
    isthing: u8,
    color: [u8; 3],
}

#[derive(Serialize)]
struct Annotation {
    image_id: usize,
    file_name: String,
    segments_info: Vec<Segment>,
}

#[derive(Serialize)]
struct Segment {
    id: u32,
    category_id: i16,
    area: usize,
    bbox: [u32; 4],
    iscrowd: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    instance: Option<i16>,
}

/// The meaning of a segment.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Is {
    /// All of a class without instances.
    Stuff { class: i16 },
    /// Pixels of a class of things that belong to no instance.
    Crowd { class: i16 },
    /// An instance.
    Thing { instance: i16, class: i16 },
}

impl Is {
    /// Number of a segment, the same in every frame of a scene: colours that people can tell apart, and no two alike, since multiplication
    /// by an odd number permutes the numbers of 24 bits.
    fn id(self) -> u32 {
        let key = match self {
            Self::Stuff { class } => class as u32,
            Self::Crowd { class } => 0x1_0000 + class as u32,
            Self::Thing { instance, .. } => 0x2_0000 + instance as u32,
        };
        key.wrapping_mul(0x9e_3779) & 0xff_ffff
    }

    fn class(self) -> i16 {
        match self {
            Self::Stuff { class } | Self::Crowd { class } | Self::Thing { class, .. } => class,
        }
    }
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let categories = categories(selected)?;
    let frames = selected.each(|view| write_frame(selected, out, view, &categories))?;
    let category = |category: Category| {
        let [red, green, blue, _] = Is::Stuff { class: category.id }.id().to_le_bytes();
        PanopticCategory { isthing: u8::from(category.is_thing()), color: [red, green, blue], category }
    };
    let mut all = Panoptic {
        info: info(),
        licenses: Vec::new(),
        images: Vec::new(),
        annotations: Vec::new(),
        categories: categories.into_iter().map(category).collect(),
    };
    for (mut image, annotation) in frames {
        let image_id = all.images.len() + 1;
        image.id = image_id;
        all.images.push(image);
        all.annotations.push(Annotation { image_id, ..annotation });
    }
    let is_thing = |segment: &Segment| segment.instance.is_some();
    warn_of_none(selected, all.annotations.iter().flat_map(|annotation| &annotation.segments_info).any(is_thing))?;
    let text = serde_json::to_string(&all).expect("plain data encodes");
    out.write("annotations/panoptic.json", text.as_bytes())
}

/// Writes the frame's picture and segments; returns their entries in the file, without ids.
fn write_frame(
    selected: &SelectedFrames<'_>,
    out: &ExportFolder,
    view: View<'_>,
    categories: &[Category],
) -> Result<(Image, Annotation), ExportError> {
    let [color, entity] = SHOWN;
    let frame = selected.read(view, &[color, entity, Layer::Semantic, Layer::SemanticInstance])?;
    let image = write_image(selected, out, view, &frame)?;
    let segments = segments(&frame, categories);
    let mut ids = vec![0u8; 3 * frame.pixels()];
    for (is, segment) in &segments {
        let [red, green, blue, _] = is.id().to_le_bytes();
        segment.pixels.iter().for_each(|&i| ids[3 * i..3 * i + 3].copy_from_slice(&[red, green, blue]));
    }
    let file_name = format!("{}/frame.{:04}.png", view.track.folder(), view.frame());
    out.write(&format!("annotations/panoptic/{file_name}"), &rgb_png(frame.width, frame.height, &ids))?;
    let segments_info = segments.iter().map(|(&is, segment)| described(is, segment, frame.width)).collect();
    Ok((image, Annotation { image_id: 0, file_name, segments_info }))
}

/// The pixels of each segment. An instance has one class, the most frequent of its pixels.
fn segments(frame: &Frame, categories: &[Category]) -> BTreeMap<Is, Instance> {
    let (Some(classes), Some(numbers)) = (frame.get(Layer::Semantic), frame.get(Layer::SemanticInstance)) else {
        return BTreeMap::new();
    };
    let is_thing = |class: i16| {
        let found = categories.binary_search_by_key(&class, |category| category.id).ok()?;
        Some(categories[found].is_thing())
    };
    let mut of_instance: BTreeMap<i16, Option<Is>> = BTreeMap::new();
    for instance in instances(frame) {
        let is = class_of(frame, &instance, categories).map(|class| match is_thing(class) {
            Some(true) => Is::Thing { instance: instance.number, class },
            _ => Is::Stuff { class },
        });
        of_instance.insert(instance.number, is);
    }
    let mut segments: BTreeMap<Is, Instance> = BTreeMap::new();
    for i in 0..frame.pixels() {
        let (class, number) = (classes.get(i) as i16, numbers.get(i) as i16);
        let of_class = || Some(if is_thing(class)? { Is::Crowd { class } } else { Is::Stuff { class } });
        let is = if number > 0 { of_instance.get(&number).copied().flatten() } else { of_class() };
        if let Some(is) = is {
            let empty = || Instance { number, semantic: is.class(), pixels: Vec::new() };
            segments.entry(is).or_insert_with(empty).pixels.push(i);
        }
    }
    segments
}

fn described(is: Is, segment: &Instance, width: u32) -> Segment {
    let [x_min, y_min, x_max, y_max] = segment.extent(width);
    Segment {
        id: is.id(),
        category_id: is.class(),
        area: segment.pixels.len(),
        bbox: [x_min, y_min, x_max - x_min + 1, y_max - y_min + 1],
        iscrowd: u8::from(matches!(is, Is::Crowd { .. })),
        instance: if let Is::Thing { instance, .. } = is { Some(instance) } else { None },
    }
}
