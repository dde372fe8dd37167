//! PLY files as scenes.

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, UpAxis};
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::Bsdf;

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";

#[test]
fn a_mesh_is_a_scene_of_one_part_with_the_mean_of_its_colours() {
    let folder = Folder::new();
    let text = format!(
        "{HEADER}property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n\
         0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 255 0 0\n0 1 0 255 0 0\n4 0 1 2 3\n"
    );
    let imported = folder.write("hall.ply", text).load("hall.ply").unwrap();
    let scene = &imported.scene;
    assert_eq!((scene.parts[0].name.as_str(), imported.report.format, imported.report.counts.triangles), ("hall", "ply", 2));
    assert_eq!(scene.world_corners(&scene.parts[0], 0)[2], Vec3::new(1.0, 0.0, 1.0));
    assert_eq!(scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() });
    assert!(warnings(&imported).contains("colours of vertices are not supported"));
    let options = ImportOptions { up_axis: Some(UpAxis::Z), meters_per_unit: 2.0, ..ImportOptions::default() };
    let scene = folder.load_with("hall.ply", &options).unwrap().scene;
    assert_eq!(scene.world_corners(&scene.parts[0], 0)[2], Vec3::new(2.0, 2.0, 0.0));
}

#[test]
fn clouds_of_points_are_refused_and_other_elements_reported() {
    let folder = Folder::new();
    let points = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let message = folder.write("a.ply", format!("{HEADER}{points}")).error("a.ply");
    assert!(message.contains("the file has 4 vertices but no faces: a cloud of points has no surface"), "{message}");
    let text =
        format!("{HEADER}element edge 1\nproperty int a\nelement face 1\nproperty list uchar int vertex_index\n{points}7\n3 0 1 2\n");
    let imported = folder.write("a.ply", text).load("a.ply").unwrap();
    assert!(warnings(&imported).contains("element edge: only vertices and faces are read"), "{}", warnings(&imported));
    assert!(folder.write("a.ply", "obj").error("a.ply").contains("a.ply: line 1"));
}

#[test]
fn pictures_are_those_that_comments_name() {
    let folder = Folder::new();
    let file = |comment: &str, texcoord: &str, values: &str| {
        let text = HEADER.replace("element", &format!("comment TextureFile {comment}\nelement"));
        let end = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2";
        folder.write("a.ply", format!("{text}element face 1\nproperty list uchar int vertex_index\n{texcoord}{end}{values}\n"));
    };
    folder.write("my oak.png", png(2, 2, [150, 100, 60, 255]));
    file("C:\\scans\\my oak.png", "property list uchar float texcoord\nproperty int texnumber\n", " 6 0 0 1 0 1 1 0");
    let imported = folder.load("a.ply").unwrap();
    assert!(matches!(&imported.scene.materials[0].bsdf, Bsdf::Diffuse { reflectance } if reflectance.texture.is_some()));
    assert_eq!(warnings(&imported), "a.ply: element face: the properties texnumber are not read\n");
    file("my oak.png", "", "");
    assert!(warnings(&folder.load("a.ply").unwrap()).contains("my oak.png was not used"));
}
