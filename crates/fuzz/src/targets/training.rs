//! NYUv2 and Pix3D as published, which training reads.

use crate::{Run, Seed};
use enfilade_loader::{NYU_LAYERS, NyuChoice, NyuClasses, NyuV2};
use enfilade_shapes::{Voxels, ingest_pix3d};
use std::path::Path;

const LIST: &str = r#"[{"img":"a.png","category":"sofa","img_size":[1,1],"2d_keypoints":[],"mask":"a.png","img_source":"","model":"a.obj",
"model_raw":0,"model_source":"","3d_keypoints":"","voxel":"a.mat","rot_mat":[[1,0,0],[0,1,0],[0,0,1]],"trans_mat":[0.5,0,1.5],
"focal_length":35.0,"cam_position":[0,0,0],"inplane_rotation":0,"truncated":false,"occluded":false,"slightly_occluded":false,
"bbox":[0,0,1,1]}]"#;
const SPLIT: &str = r#"{"images":[{"file_name":"a.png","id":1,"width":1,"height":1}],"annotations":[]}"#;

/// Opens the bytes as NYUv2's file, and reads every image of it.
pub fn nyuv2(folder: &Path) -> Run {
    let file = folder.join("nyu.mat");
    Box::new(move |bytes| {
        std::fs::write(&file, bytes).expect("a folder that can be written");
        for classes in [NyuClasses::All, NyuClasses::Forty, NyuClasses::Thirteen] {
            let choice = NyuChoice { side: None, classes, layers: NYU_LAYERS.to_vec(), partial: true };
            if let Ok(images) = NyuV2::open(&file, &choice) {
                (0..images.len().min(4)).for_each(|index| drop(images.sample(index)));
            }
        }
    })
}

/// Reads the bytes as voxels, as Pix3D's list of objects, as the picture and the mask of one, and as a split.
pub fn pix3d(folder: &Path) -> Run {
    let file = |name: &str| folder.join(name);
    let (root, list, split, picture) = (folder.to_path_buf(), file("pix3d.json"), file("split.json"), file("a.png"));
    for name in ["a.obj", "a.mat", "a.png"] {
        std::fs::write(file(name), png()).expect("a folder that can be written");
    }
    Box::new(move |bytes| {
        if let Ok(voxels) = Voxels::from_mat(bytes, Path::new("a.mat")) {
            drop((voxels.points(), voxels.to_mat()));
        }
        for (changed, usual) in [(&list, LIST.as_bytes().to_vec()), (&split, SPLIT.into()), (&picture, png())] {
            std::fs::write(&list, LIST).expect("a folder that can be written");
            std::fs::write(changed, bytes).expect("a folder that can be written");
            drop((ingest_pix3d(&root, None), ingest_pix3d(&root, Some(&split))));
            std::fs::write(changed, usual).expect("a folder that can be written");
        }
    })
}

/// A list, a split, a picture, and voxels.
pub fn pix3d_files() -> Vec<Seed> {
    let seed = |name: &str, bytes: Vec<u8>| Seed { name: name.into(), bytes };
    vec![seed("pix3d.json", LIST.into()), seed("split.json", SPLIT.into()), seed("a.png", png()), seed("a.mat", voxels())]
}

fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::GrayImage::from_pixel(1, 1, image::Luma([255]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("writing to memory cannot fail");
    bytes.into_inner()
}

/// A cube of two cells on a side, one of which is occupied; an array of bytes in a file that is not compressed.
fn voxels() -> Vec<u8> {
    let word = |n: u32| n.to_le_bytes().to_vec();
    let element = |kind: u32, data: &[u8]| {
        [word(kind), word(data.len() as u32), data.to_vec(), vec![0; data.len().next_multiple_of(8) - data.len()]].concat()
    };
    let sides = [word(2), word(2), word(2)].concat();
    let body = [element(6, &[word(9), word(0)].concat()), element(5, &sides), element(1, b"voxel"), element(2, &[1, 0, 0, 0, 0, 0, 0, 0])]
        .concat();
    [format!("{:<124}", "MATLAB 5.0 MAT-file").into_bytes(), b"\0\x01IM".to_vec(), element(14, &body)].concat()
}
