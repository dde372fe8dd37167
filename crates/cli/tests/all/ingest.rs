//! Data sets of others are read by the binary.

use crate::common::{fail, folder, succeed};
use std::fs;
use std::path::Path;

/// Pix3D with one chair, as it is published.
fn write_pix3d(root: &Path) {
    let list = r#"[{"img":"img/chair/0001.png","category":"chair","img_size":[640,480],"mask":"mask/m.png","model":"model/m.obj",
        "voxel":"model/v.mat","rot_mat":[[1,0,0],[0,1,0],[0,0,1]],"trans_mat":[0,0,1.5],"focal_length":35.0,"bbox":[10,20,110,220]}]"#;
    let png = [b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".as_slice(), &640_u32.to_be_bytes(), &480_u32.to_be_bytes()].concat();
    for name in ["img/chair/0001.png", "mask/m.png", "model/m.obj", "model/v.mat"] {
        fs::create_dir_all(root.join(name).parent().unwrap()).unwrap();
        fs::write(root.join(name), &png).unwrap();
    }
    fs::write(root.join("pix3d.json"), list).unwrap();
}

#[test]
fn pix3d_becomes_the_layout_of_mesh_r_cnn() {
    let dir = folder();
    let d = dir.path();
    write_pix3d(&d.join("pix3d"));
    assert!(succeed(d, &["import", "pix3d", "-o", "pix3d/all.json"]).contains("one object each: 1;"));
    let written: serde_json::Value = serde_json::from_slice(&fs::read(d.join("pix3d/all.json")).unwrap()).unwrap();
    assert_eq!(written["annotations"][0]["K"], serde_json::json!([700.0, 320.0, 240.0]));
    // A second time the same file is replaced.
    succeed(d, &["import", "pix3d", "-o", "pix3d/all.json"]);

    fs::remove_file(d.join("pix3d/model/v.mat")).unwrap();
    fail(d, &["import", "pix3d", "-o", "again.json"], 1, &["model/v.mat", "pix3d.json"]);
    fs::create_dir(d.join("elsewhere")).unwrap();
    fail(d, &["import", "elsewhere", "-o", "again.json"], 2, &["elsewhere", "pix3d.json"]);
    fail(d, &["import", "pix3d", "-o", "again.json", "--lamps", "ceiling"], 2, &["--lamps is for scenes, but pix3d is Pix3D"]);
    assert!(!d.join("again.json").exists());
}

#[test]
fn the_files_of_pix3d_are_not_written_over() {
    let dir = folder();
    let d = dir.path();
    write_pix3d(&d.join("pix3d"));
    fs::write(d.join("split.json"), r#"{"images": [{"file_name": "img/chair/0001.png", "id": 7}]}"#).unwrap();
    for file in ["pix3d/pix3d.json", "pix3d/model/m.obj", "split.json"] {
        let before = fs::read(d.join(file)).unwrap();
        fail(d, &["import", "pix3d", "--partition", "split.json", "-o", file], 2, &[file, "choose another file with -o"]);
        assert_eq!(fs::read(d.join(file)).unwrap(), before);
    }
}
