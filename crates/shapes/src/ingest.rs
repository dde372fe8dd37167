//! Pix3D as it is published, `pix3d.json` and the files that it names, to the JSON that Mesh R-CNN reads.

use crate::ShapesError;
use crate::classes::{CATEGORIES, category_id};
use crate::layout::{Annotation, Document, Image};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;
use std::path::Path;

/// Images whose masks have another size; Mesh R-CNN leaves them out, and so does [`ingest_pix3d`].
pub const MISMATCHED: [&str; 2] = ["img/table/1749.jpg", "img/table/0045.png"];

/// Width of the sensor in millimetres that Pix3D's focal lengths are for.
const SENSOR_MM: f64 = 32.0;

/// One object of `pix3d.json`; Pix3D's README describes the fields.
#[derive(Deserialize)]
struct Entry {
    img: String,
    category: String,
    img_size: [u32; 2],
    mask: String,
    model: String,
    voxel: String,
    rot_mat: [[f64; 3]; 3],
    trans_mat: [f64; 3],
    focal_length: f64,
    bbox: [f64; 4],
}

/// The fields read from a split of Mesh R-CNN.
#[derive(Deserialize)]
struct Split {
    images: Vec<SplitImage>,
}

#[derive(Deserialize)]
struct SplitImage {
    file_name: String,
    id: u64,
}

/// A document, and what is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Ingested {
    /// Images and annotations.
    pub document: Document,
    /// Images of [`MISMATCHED`] that were left out.
    pub mismatched: usize,
    /// Entries of `pix3d.json` that the split does not name.
    pub outside_split: usize,
}

/// Reads `pix3d.json` in the folder `root`. With `split`, one of Mesh R-CNN's files (`pix3d_s1_train.json` and so on), only the images that
/// it names, under its ids. Every named file must exist, and masks must have the stated size of their images.
///
/// The focal length in pixels is focal_length / 32 mm · width, and the principal point is the middle of the image.
///
/// # Errors
/// When a file is missing or not what it should be, or when the split names an image that is not in `pix3d.json`.
pub fn ingest_pix3d(root: &Path, split: Option<&Path>) -> Result<Ingested, ShapesError> {
    let list = root.join("pix3d.json");
    let bytes = std::fs::read(&list).map_err(ShapesError::io("read", &list))?;
    let entries: Vec<Entry> =
        serde_json::from_slice(&bytes).map_err(|e| ShapesError::file(&list, format!("{e}; expected the list of Pix3D's objects")))?;
    let ids = split.map(read_split).transpose()?;
    let wanted = |entry: &&Entry| ids.as_ref().is_none_or(|ids| ids.contains_key(&entry.img));
    let named: Vec<&Entry> = entries.iter().filter(wanted).collect();
    let outside_split = entries.len() - named.len();
    let kept: Vec<&Entry> = named.into_iter().filter(|entry| !MISMATCHED.contains(&entry.img.as_str())).collect();
    if let (Some(ids), Some(path)) = (&ids, split) {
        let known: BTreeSet<&str> = entries.iter().map(|entry| entry.img.as_str()).collect();
        if let Some(missing) = ids.keys().find(|name| !known.contains(name.as_str())) {
            return Err(ShapesError::file(path, format!("it names {missing}, which {} does not", list.display())));
        }
    }
    let mismatched = entries.len() - outside_split - kept.len();
    let object = |index: usize| object(root, &list, kept[index], index as u64 + 1, ids.as_ref());
    let objects: Vec<(Image, Annotation)> = enfilade_parallel::try_map_up_to(kept.len(), object)?;
    let mut document = Document::empty("Pix3D (Sun et al. 2018, CC BY 4.0), for Mesh R-CNN");
    (document.images, document.annotations) = objects.into_iter().unzip();
    document.images.sort_by_key(|image| image.id);
    Ok(Ingested { document, mismatched, outside_split })
}

fn read_split(path: &Path) -> Result<BTreeMap<String, u64>, ShapesError> {
    let bytes = std::fs::read(path).map_err(ShapesError::io("read", path))?;
    let expected = "expected one of Mesh R-CNN's splits, such as pix3d_s1_train.json";
    let split: Split = serde_json::from_slice(&bytes).map_err(|e| ShapesError::file(path, format!("{e}; {expected}")))?;
    Ok(split.images.into_iter().map(|image| (image.file_name, image.id)).collect())
}

/// Image and annotation of an entry; `id` is its number.
fn object(
    root: &Path,
    list: &Path,
    entry: &Entry,
    id: u64,
    ids: Option<&BTreeMap<String, u64>>,
) -> Result<(Image, Annotation), ShapesError> {
    let wrong = |problem: String| ShapesError::file(list, format!("{}: {problem}", entry.img));
    let category = category_id(&entry.category);
    let category_id = category.ok_or_else(|| wrong(format!("category {:?}, expected one of {}", entry.category, CATEGORIES.join(", "))))?;
    for (what, name) in [("img", &entry.img), ("mask", &entry.mask), ("model", &entry.model), ("voxel", &entry.voxel)] {
        if !root.join(name).is_file() {
            return Err(wrong(format!("its {what} {name} is not there; unpack pix3d.zip whole")));
        }
    }
    let [width, height] = entry.img_size;
    let mask = png_size(&root.join(&entry.mask))?;
    if mask != [width, height] {
        return Err(wrong(format!("its mask has {}x{} pixels, the image {width}x{height}; leave it out", mask[0], mask[1])));
    }
    let [x0, y0, x1, y1] = entry.bbox;
    if !(x1 > x0 && y1 > y0 && entry.focal_length > 0.0) {
        return Err(wrong(format!(
            "bbox {:?} and focal length {}: expected a box with area and a length above 0",
            entry.bbox, entry.focal_length
        )));
    }
    let image_id = ids.and_then(|ids| ids.get(&entry.img).copied()).unwrap_or(id);
    let image = Image { id: image_id, file_name: entry.img.clone(), width, height, scene: None, camera: None, frame: None };
    let annotation = Annotation {
        id,
        image_id,
        category_id,
        iscrowd: 0,
        area: (x1 - x0) * (y1 - y0),
        bbox: [x0, y0, x1 - x0, y1 - y0],
        segmentation: entry.mask.clone(),
        model: entry.model.clone(),
        voxel: entry.voxel.clone(),
        k: [entry.focal_length / SENSOR_MM * f64::from(width), f64::from(width) / 2.0, f64::from(height) / 2.0],
        rot_mat: entry.rot_mat,
        trans_mat: entry.trans_mat,
        rendered: None,
    };
    Ok((image, annotation))
}

/// Width and height of a PNG file, from its first chunk.
fn png_size(path: &Path) -> Result<[u32; 2], ShapesError> {
    let mut head = [0; 24];
    let mut file = std::fs::File::open(path).map_err(ShapesError::io("read", path))?;
    file.read_exact(&mut head).map_err(ShapesError::io("read", path))?;
    if !head.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Err(ShapesError::file(path, "it is no PNG file"));
    }
    Ok([16, 20].map(|at| u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    /// The first bytes of a PNG file.
    fn png(width: u32, height: u32) -> Vec<u8> {
        [b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".as_slice(), &width.to_be_bytes(), &height.to_be_bytes(), b"\x08\0\0\0\0"].concat()
    }

    fn entry(img: &str, category: &str) -> Value {
        json!({
            "img": img, "category": category, "img_size": [640, 480], "mask": "mask/m.png", "model": "model/m.obj", "voxel": "model/v.mat",
            "rot_mat": [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], "trans_mat": [0.1, -0.2, 1.5], "focal_length": 35.0,
            "bbox": [10, 20, 110, 220], "truncated": false, "occluded": true, "slightly_occluded": false, "2d_keypoints": [[[-1.0, -1.0]]],
        })
    }

    fn folder(entries: &[Value]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in entries.iter().map(|entry| entry["img"].as_str().unwrap()).chain(["model/m.obj", "model/v.mat", "mask/m.png"]) {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, png(640, 480)).unwrap();
        }
        std::fs::write(folder.path().join("pix3d.json"), serde_json::to_vec(entries).unwrap()).unwrap();
        folder
    }

    #[test]
    fn entries_become_annotations_with_cameras_in_pixels() {
        let folder = folder(&[entry("img/chair/0001.png", "chair"), entry("img/bed/0002.png", "bed")]);
        let found = ingest_pix3d(folder.path(), None).unwrap().document;
        let written: Value = serde_json::from_slice(&found.to_json()).unwrap();
        assert_eq!(written["images"][1], json!({ "id": 2, "file_name": "img/bed/0002.png", "width": 640, "height": 480 }));
        let annotation = &written["annotations"][0];
        assert_eq!(annotation["K"], json!([700.0, 320.0, 240.0]));
        assert_eq!((&annotation["bbox"], &annotation["category_id"]), (&json!([10.0, 20.0, 100.0, 200.0]), &json!(3)));
        assert_eq!((&annotation["trans_mat"], &annotation["rot_mat"][1]), (&json!([0.1, -0.2, 1.5]), &json!([0.0, 0.0, 1.0])));
        assert_eq!([&annotation["segmentation"], &annotation["model"], &annotation["voxel"]], ["mask/m.png", "model/m.obj", "model/v.mat"]);
        assert_eq!(written["categories"].as_array().unwrap().len(), 9);
        let path = folder.path().join("out.json");
        std::fs::write(&path, found.to_json()).unwrap();
        assert_eq!(Document::read(&path).unwrap(), found);
    }

    #[test]
    fn two_images_with_masks_of_other_images_are_left_out() {
        let folder =
            folder(&[entry("img/table/1749.jpg", "table"), entry("img/table/0045.png", "table"), entry("img/table/0046.png", "table")]);
        let found = ingest_pix3d(folder.path(), None).unwrap();
        assert_eq!((found.mismatched, found.document.images.len()), (2, 1));
        assert_eq!(found.document.images[0].file_name, "img/table/0046.png");
    }

    #[test]
    fn a_split_chooses_images_and_gives_their_ids() {
        let folder = folder(&[entry("img/sofa/1.png", "sofa"), entry("img/sofa/2.png", "sofa"), entry("img/sofa/3.png", "sofa")]);
        let split = folder.path().join("pix3d_s2_test.json");
        let images = json!([{ "file_name": "img/sofa/3.png", "id": 77, "width": 640 }, { "file_name": "img/sofa/1.png", "id": 80 }]);
        std::fs::write(&split, json!({ "images": images, "annotations": [] }).to_string()).unwrap();
        let found = ingest_pix3d(folder.path(), Some(&split)).unwrap();
        assert_eq!((found.outside_split, found.document.images.iter().map(|i| i.id).collect::<Vec<_>>()), (1, vec![77, 80]));
        assert!(found.document.annotations.iter().all(|a| found.document.images.iter().any(|i| i.id == a.image_id)));
        std::fs::write(&split, json!({ "images": [{ "file_name": "img/sofa/9.png", "id": 1 }] }).to_string()).unwrap();
        assert!(ingest_pix3d(folder.path(), Some(&split)).unwrap_err().to_string().contains("it names img/sofa/9.png"));
    }

    #[test]
    fn broken_folders_are_explained() {
        let refused = |change: &dyn Fn(&Path)| {
            let folder = folder(&[entry("img/chair/1.png", "chair")]);
            change(folder.path());
            ingest_pix3d(folder.path(), None).unwrap_err().to_string()
        };
        assert!(refused(&|root| std::fs::remove_file(root.join("pix3d.json")).unwrap()).contains("cannot read"));
        assert!(refused(&|root| std::fs::write(root.join("pix3d.json"), "{}").unwrap()).contains("the list of Pix3D's objects"));
        assert!(refused(&|root| std::fs::remove_file(root.join("model/v.mat")).unwrap()).contains("its voxel model/v.mat is not there"));
        assert!(refused(&|root| std::fs::write(root.join("mask/m.png"), png(640, 481)).unwrap()).contains("640x481"));
        let lamp = json!([entry("img/chair/1.png", "lamp")]).to_string();
        assert!(refused(&|root| std::fs::write(root.join("pix3d.json"), &lamp).unwrap()).contains("category \"lamp\""));
    }
}
