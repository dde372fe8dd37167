//! V-Ray's scenes, edited file to file.

use crate::common::{fail, folder, succeed};
use std::fs;

const SCENE: &str = "#include \"C:\\assets\\mats.vrscene\"\nSettingsUnitsInfo units {\n  meters_scale=0.5;\n}\n\
    Node chair@node_1 {\n  scene_name=\"a chair\";\n}\nNode gone@node_2 {\n}\nRenderView view {\n  fov=1;\n}\n\
    FilterArea aa {\n}\nSettingsImageSampler is {\n  filter=aa;\n}\n";

#[test]
fn a_scene_goes_through_the_toolkits_steps() {
    let dir = folder();
    let d = dir.path();
    fs::write(d.join("in.vrscene"), SCENE).unwrap();
    fs::write(d.join("objects.csv"), "object_name\ntable\nchair\n").unwrap();
    succeed(d, &["vray", "copy", "in.vrscene", "-o", "same.vrscene"]);
    assert_eq!(fs::read_to_string(d.join("same.vrscene")).unwrap(), SCENE);
    let text = succeed(d, &["vray", "info", "in.vrscene"]);
    assert!(text.contains("0.5 m") && text.contains("2 Node") && text.contains("mats.vrscene (#include, line 1)"), "{text}");

    let step = |verb: &str, rest: &[&str]| succeed(d, &[&["vray", verb, "same.vrscene", "-o", "same.vrscene"], rest].concat());
    step("normalize", &["--policy", "v1"]);
    assert!(step("replace-paths", &["--old", "c:/assets", "--new", "/mnt/a"]).contains("1 paths"));
    let text = step("entities", &["--objects", "objects.csv", "--nodes", "nodes.csv", "--strings", "strings.csv"]);
    assert!(text.contains("2 nodes, of which 1 are not objects"), "{text}");
    assert_eq!(
        fs::read_to_string(d.join("nodes.csv")).unwrap(),
        "node_id,node_name,object_id,object_name\n1,chair@node_1,1,chair\n2,gone@node_2,-1,_NULL_OBJECT\n"
    );
    assert!(fs::read_to_string(d.join("strings.csv")).unwrap().contains("1,<root>.scene_name,a chair"));
    step("layers", &["--denoiser", "--hypersim-surroundings"]);
    step("quality", &[]);
    step("pass", &["--pass", "final", "--light-cache", "/mnt/a.vrlmap", "--irradiance-map", "/mnt/a.vrmap"]);
    step("reduce", &["--size"]);
    step("linear", &[]);
    let done = fs::read_to_string(d.join("same.vrscene")).unwrap();
    for expected in [
        "#include \"/mnt/a/mats.vrscene\"",
        "photometric_scale=0.002094395;",
        "VRayRawTotalLighting",
        "progressive_threshold=0.001;",
        "bg_color=Color(4, 4, 4);",
        "img_width=256;",
    ] {
        assert!(done.contains(expected), "no {expected} in\n{done}");
    }
    assert!(!done.contains("FilterArea") && !done.contains("filter=aa"), "{done}");
}

#[test]
fn what_cannot_be_done_is_said_and_nothing_is_written() {
    let dir = folder();
    let d = dir.path();
    fs::write(d.join("in.vrscene"), SCENE).unwrap();
    fs::write(d.join("cut.vrscene"), &SCENE[..SCENE.len() - 4]).unwrap();
    let out = ["-o", "out.vrscene"];
    let refused = |args: &[&str], words: &[&str]| drop(fail(d, &[&["vray"], args, &out].concat(), 2, words));
    refused(&["copy", "cut.vrscene"], &["cut.vrscene:16:12: expected `;`", "export the scene again"]);
    refused(&["copy", "nothing.vrscene"], &["nothing.vrscene", "check the path"]);
    refused(&["replace-paths", "in.vrscene", "--old", "/x", "--new", "/y"], &["no path begins with", "info IN --files"]);
    refused(&["pass", "in.vrscene", "--pass", "pre"], &["--light-cache"]);
    refused(&["entities", "in.vrscene", "--objects", "in.vrscene"], &["in.vrscene", "metadata_objects.csv"]);
    assert!(!d.join("out.vrscene").exists());
}
