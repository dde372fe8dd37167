//! ScanNet's mesh, its labels, segments and objects, read by the rules of ScanNet's own scripts and of the usual loaders.

use crate::common::{files, layer, pinhole, write};
use enfilade_dataset::hdf5::{Storage, read_array, write_array};
use enfilade_dataset::mesh_names::{OBJECTS_SEMANTIC, VERTICES};
use enfilade_dataset::{Array, Classes, Dataset, Elements, LabelColors, PartitionRow, Side};
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_frame::{Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::{Heard, Pose, Quiet};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// NYU40 class and instance of floor, wall, table and chair, and their raw categories.
const OBJECTS: [(u16, i64, &str); 4] = [(7, 1, "table"), (5, 2, "chair"), (2, -1, "floor"), (1, -1, "wall")];

/// Exports the scene `room` as ScanNet, and returns the warnings.
fn exported(dataset: &Dataset, out: &Path) -> Result<Vec<String>, String> {
    let heard = Heard::default();
    let config = ExportConfig::new(Format::Scannet, vec!["room".into()]);
    export(dataset, &config, out, Existing::Refuse, &heard).map(|_| heard.lines()).map_err(|error| error.to_string())
}

/// A mesh as plyfile reads it.
struct Ply {
    header: Vec<String>,
    positions: Vec<[f32; 3]>,
    colors: Vec<[u8; 4]>,
    labels: Vec<u16>,
    faces: Vec<[usize; 3]>,
}

fn ply(path: &Path) -> Ply {
    let bytes = std::fs::read(path).unwrap();
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header: Vec<String> = std::str::from_utf8(&bytes[..end]).unwrap().lines().map(String::from).collect();
    let count = |what: &str| header.iter().find_map(|line| line.strip_prefix(what)).unwrap().trim().parse::<usize>().unwrap();
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let has_label = header.iter().any(|line| line == "property ushort label");
    let mut read = Ply { header, positions: Vec::new(), colors: Vec::new(), labels: Vec::new(), faces: Vec::new() };
    let (body, size) = (&bytes[end..], if has_label { 18 } else { 16 });
    for vertex in body[..vertices * size].chunks_exact(size) {
        read.positions.push([0, 4, 8].map(|at| f32::from_le_bytes(vertex[at..at + 4].try_into().unwrap())));
        read.colors.push(vertex[12..16].try_into().unwrap());
        read.labels.extend(vertex.get(16..18).map(|label| u16::from_le_bytes(label.try_into().unwrap())));
    }
    for face in body[vertices * size..].chunks_exact(13) {
        assert_eq!(face[0], 3);
        read.faces.push([1, 5, 9].map(|at| i32::from_le_bytes(face[at..at + 4].try_into().unwrap()) as usize));
    }
    assert!(body.len() == vertices * size + faces * 13 && read.faces.iter().flatten().all(|&corner| corner < vertices));
    read
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Column `value` of ScanNet's table by column `key`, as every loader reads it.
fn table(path: &Path, key: &str, value: &str) -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut rows = text.lines().map(|line| line.split('\t').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    assert_eq!((header[1], header[2], header[7]), ("raw_category", "category", "nyu40class"), "PointGroup counts columns");
    let at = |name: &str| header.iter().position(|column| *column == name).unwrap();
    rows.map(|row| (row[at(key)].to_string(), row[at(value)].to_string())).collect()
}

fn numbers(value: &Value) -> Vec<u64> {
    value.as_array().unwrap().iter().map(|number| number.as_u64().unwrap()).collect()
}

#[test]
fn segments_groups_and_the_table_give_the_labels_of_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    exported(&write(&folder.path().join("dataset"), &pinhole()), &out).unwrap();
    for scan in ["room_cam_00", "room_cam_01"] {
        let file = |suffix: &str| out.join("scans").join(scan).join(format!("{scan}{suffix}"));
        let (mesh, labelled) = (ply(&file("_vh_clean_2.ply")), ply(&file("_vh_clean_2.labels.ply")));
        assert!(mesh.labels.is_empty() && mesh.positions == labelled.positions && mesh.faces == labelled.faces);
        assert_eq!(mesh.header[1], "format binary_little_endian 1.0");
        let kinds = ["float x", "float y", "float z", "uchar red", "uchar green", "uchar blue", "uchar alpha"];
        assert!(mesh.header[3..10].iter().zip(kinds).all(|(line, kind)| *line == format!("property {kind}")), "{:?}", mesh.header);
        assert_eq!(mesh.header[11], "property list uchar int vertex_indices");

        let segments = numbers(&json(&file("_vh_clean_2.0.010000.segs.json"))["segIndices"]);
        let groups = json(&file(".aggregation.json"));
        let nyu40 = table(&out.join("scannetv2-labels.combined.tsv"), "raw_category", "nyu40id");
        let (mut labels, mut instances) = (vec![0u16; segments.len()], vec![0; segments.len()]);
        let mut used = BTreeSet::new();
        for (i, group) in groups["segGroups"].as_array().unwrap().iter().enumerate() {
            assert_eq!((group["id"].as_u64(), group["objectId"].as_u64()), (Some(i as u64), Some(i as u64)), "counted from 0 without gaps");
            let (label, instance, word) = OBJECTS[i];
            assert_eq!((group["label"].as_str(), group["instance"].as_i64().unwrap_or(-1)), (Some(word), instance));
            let own: BTreeSet<u64> = numbers(&group["segments"]).into_iter().collect();
            assert!(own.iter().all(|&segment| used.insert(segment)), "a segment is in one group");
            for (vertex, _) in segments.iter().enumerate().filter(|(_, segment)| own.contains(segment)) {
                (labels[vertex], instances[vertex]) = (nyu40[word].parse().unwrap(), i + 1);
            }
            assert_eq!(nyu40[word], label.to_string());
        }
        assert_eq!(labels, labelled.labels, "both ways to a label lead to the same");
        // The positions identify the things.
        for (label, low, high) in [(7, [-0.5, 0.5, 0.0], [0.3, 1.0, 0.6]), (5, [0.6, 0.8, 0.0], [1.0, 1.2, 0.4])] {
            let on = |p: &[f32; 3]| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&p[axis]));
            let here: Vec<usize> = (0..labels.len()).filter(|&i| labels[i] == label).collect();
            assert!(here.len() > 500 && here.iter().all(|&i| on(&mesh.positions[i])), "{} vertices", here.len());
        }
        let length =
            |a: usize, b: usize| (0..3).map(|axis| (mesh.positions[a][axis] - mesh.positions[b][axis]).powi(2)).sum::<f32>().sqrt();
        assert!(mesh.faces.iter().all(|&[a, b, c]| [length(a, b), length(b, c), length(c, a)].iter().all(|&l| l <= 0.050_001)));
        assert!(mesh.faces.iter().all(|face| face.iter().all(|&corner| instances[corner] == instances[face[0]])), "a face has one object");
    }
}

/// The poses of all frames of the scene, with their planar depth.
fn depths(dataset: &Dataset) -> Vec<(Pose, Values)> {
    let of_camera = |camera: &'static str| {
        let poses = dataset.read_trajectory("room", camera).unwrap().poses;
        poses.into_iter().map(move |pose| (pose, layer(dataset, "room", camera, pose.frame, Layer::DepthZMeters)))
    };
    ["cam_00", "cam_01"].into_iter().flat_map(of_camera).collect()
}

/// Relative differences of depth between a vertex and the pixels that it projects to, in all frames; `None` if it is on the border of two
/// pixels.
fn differences(frames: &[(Pose, Values)], position: [f32; 3]) -> Option<Vec<f64>> {
    let position = DVec3::from(position.map(f64::from));
    let mut differences = Vec::new();
    for (pose, depth) in frames {
        let p = pose.world_from_camera.transpose() * (position - pose.position);
        let (x, y) = (19.25 + 33.0 * p.x / -p.z, 15.75 - 34.5 * p.y / -p.z);
        if p.z >= 0.0 || !(-0.001..40.001).contains(&x) || !(-0.001..30.001).contains(&y) {
            continue;
        }
        if [x, y].iter().any(|v| (v - v.round()).abs() < 0.001) {
            return None;
        }
        differences.push((depth.get(x as usize + 40 * y as usize) + p.z).abs() / -p.z);
    }
    Some(differences)
}

#[test]
fn vertices_that_pixels_show_have_colours_and_others_are_grey() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (write(&folder.path().join("dataset"), &pinhole()), folder.path().join("out"));
    exported(&dataset, &out).unwrap();
    let file = |suffix: &str| out.join(format!("scans/room_cam_00/room_cam_00{suffix}"));
    let (mesh, labels) = (ply(&file("_vh_clean_2.ply")), ply(&file("_vh_clean_2.labels.ply")).labels);
    let frames = depths(&dataset);
    let (mut seen, mut reds) = ([0, 0], BTreeMap::<u16, Vec<f64>>::new());
    for (i, &[red, green, blue, alpha]) in mesh.colors.iter().enumerate() {
        if alpha == 0 {
            assert_eq!([red, green, blue], [128; 3]);
        } else {
            assert_eq!(alpha, 255);
            reds.entry(labels[i]).or_default().push(f64::from(red));
        }
        let Some(differences) = differences(&frames, mesh.positions[i]) else { continue };
        let is_within = |bound: f64| differences.iter().any(|&difference| difference <= bound);
        assert!(alpha == 255 || !is_within(0.001_99), "a frame shows {:?}", mesh.positions[i]);
        assert!(alpha == 0 || is_within(0.020_01), "no frame shows {:?}", mesh.positions[i]);
        seen[usize::from(alpha == 255)] += 1;
    }
    assert!(seen[0] > 1000 && seen[1] > 500, "{seen:?}");
    // Red grows from floor to wall, table and chair.
    let mean = |label: u16| reds[&label].iter().sum::<f64>() / reds[&label].len() as f64;
    let means = [2, 1, 7, 5].map(mean);
    assert!(means.windows(2).all(|pair| pair[0] < pair[1]), "{means:?}");
}

#[test]
fn the_page_of_a_scan_says_what_loaders_look_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    exported(&write(&folder.path().join("dataset"), &pinhole()), &out).unwrap();
    let text = std::fs::read_to_string(out.join("scans/room_cam_00/room_cam_00.txt")).unwrap();
    let page: BTreeMap<&str, &str> = text.lines().map(|line| line.split_once(" = ").unwrap()).collect();
    let alignment: Vec<f64> = page["axisAlignment"].split(' ').map(|number| number.parse().unwrap()).collect();
    assert_eq!(alignment, (0..16).map(|i| f64::from(u8::from(i % 5 == 0))).collect::<Vec<_>>(), "the identity");
    let expected = [("numDepthFrames", "3"), ("colorWidth", "40"), ("depthHeight", "30"), ("fx_color", "33"), ("mx_depth", "18.75")];
    assert!(expected.iter().all(|(key, value)| page[key] == *value), "{text}");
    assert!(text.ends_with("\nsceneType = Office\n"), "Mask3D takes the last line: {text}");
    let classes = table(&out.join("scannetv2-labels.combined.tsv"), "nyu40id", "nyu40class");
    assert!(classes.len() == 40 && classes["24"] == "refridgerator" && classes["28"] == "shower curtain", "{classes:?}");
}

/// ScanNet's numbers of some of its 200 benchmark classes, as its `scannet200_constants.py` pairs `VALID_CLASS_IDS_200` with
/// `CLASS_LABELS_200`, which Mask3D and Pointcept have too.
const SCANNET200: [(&str, &str); 20] = [
    ("wall", "1"),
    ("chair", "2"),
    ("floor", "3"),
    ("table", "4"),
    ("door", "5"),
    ("couch", "6"),
    ("cabinet", "7"),
    ("shelf", "8"),
    ("desk", "9"),
    ("bed", "11"),
    ("pillow", "13"),
    ("window", "16"),
    ("book", "22"),
    ("tv", "33"),
    ("ceiling", "41"),
    ("shower curtain", "55"),
    ("blinds", "86"),
    ("mat", "140"),
    ("object", "1163"),
    ("structure", "1178"),
];

#[test]
fn label_images_and_the_table_have_scannets_own_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (write(&folder.path().join("dataset"), &pinhole()), folder.path().join("out"));
    exported(&dataset, &out).unwrap();
    let ids = table(&out.join("scannetv2-labels.combined.tsv"), "raw_category", "id");
    assert!(ids.len() == 40 && SCANNET200.iter().all(|(word, id)| ids[*word] == *id), "{ids:?}");
    assert_eq!(ids.values().collect::<BTreeSet<_>>().len(), 40);
    let picture = image::open(out.join("scans/room_cam_00/label-filt/0.png")).unwrap().into_luma16();
    let semantic = layer(&dataset, "room", "cam_00", 0, Layer::Semantic);
    // Floor, wall, table and chair by NYU40, and by ScanNet.
    let raw: BTreeMap<i16, u16> = [(-1, 0), (2, 3), (1, 1), (7, 4), (5, 2)].into();
    let expected: Vec<u16> = (0..semantic.len()).map(|i| raw[&(semantic.get(i) as i16)]).collect();
    assert!(*picture.as_raw() == expected && expected.contains(&3) && expected.contains(&4));
}

#[test]
fn a_list_of_ones_own_keeps_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (dataset, out) = (write(&folder.path().join("dataset"), &pinhole()), folder.path().join("out"));
    // Number 2 is ScanNet's chair: beside NYU40's own wall the list stays what it is.
    let own = [(1, "wall"), (2, "rug"), (5, "chair"), (7, "table")];
    let list = own.map(|(id, name)| format!("{id},{name},{id},{id},{id}\n")).concat();
    let file = folder.path().join("list.csv");
    std::fs::write(&file, format!("semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b\n{list}")).unwrap();
    dataset.mesh_files("room").write_classes(&Classes::read(&file).unwrap()).unwrap();
    let labels = dataset.read_label_tables("room").unwrap();
    dataset.mesh_files("room").write_labels(&labels, &LabelColors { semantic: vec![[-1; 3]; 8], instances: 2 }).unwrap();
    exported(&dataset, &out).unwrap();
    let ids = table(&out.join("scannetv2-labels.combined.tsv"), "raw_category", "id");
    assert_eq!(ids, own.map(|(id, name)| (name.to_string(), id.to_string())).into());
    let picture = image::open(out.join("scans/room_cam_00/label-filt/0.png")).unwrap().into_luma16();
    let semantic = layer(&dataset, "room", "cam_00", 0, Layer::Semantic);
    assert!((0..semantic.len()).all(|i| picture.as_raw()[i] == semantic.get(i).max(0.0) as u16));
}

#[test]
fn lists_are_those_of_the_split_and_a_torn_scan_is_in_none() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = write(&folder.path().join("dataset"), &pinhole());
    let lists =
        |out: &Path| ["train", "val", "test"].map(|side| std::fs::read_to_string(out.join(format!("scannetv2_{side}.txt"))).unwrap());
    let out = folder.path().join("without");
    exported(&dataset, &out).unwrap();
    assert_eq!(lists(&out), ["room_cam_00\nroom_cam_01\n", "", ""]);
    let row = |camera: &str, frame, partition| PartitionRow { scene: "room".into(), camera: camera.into(), frame, side: Ok(partition) };
    let mut rows = vec![row("cam_00", 0, Side::Val), row("cam_00", 1, Side::Val), row("cam_01", 0, Side::Test)];
    dataset.write_partition(&rows).unwrap();
    let out = folder.path().join("split");
    let said = exported(&dataset, &out).unwrap();
    assert_eq!(lists(&out), ["", "room_cam_00\n", "room_cam_01\n"]);
    assert!(said.iter().any(|line| line.contains("no scan is in scannetv2_train.txt")), "{said:?}");
    rows.push(row("cam_00", 3, Side::Train));
    dataset.write_partition(&rows).unwrap();
    let out = folder.path().join("torn");
    let said = exported(&dataset, &out).unwrap();
    assert_eq!(lists(&out), ["", "", "room_cam_01\n"]);
    assert!(said.iter().any(|line| line.contains("room_cam_00") && line.contains("in no list")), "{said:?}");
}

#[test]
fn scenes_that_are_called_as_scannets_give_scans_called_as_scannets() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("dataset"), &pinhole());
    let scenes = folder.path().join("dataset/scenes");
    std::fs::rename(scenes.join("room"), scenes.join("scene0007")).unwrap();
    let cameras = folder.path().join("dataset/metadata_camera_parameters.csv");
    let text = std::fs::read_to_string(&cameras).unwrap();
    std::fs::write(&cameras, text.replace("\nroom,", "\nscene0007,")).unwrap();
    let dataset = Dataset::open(folder.path().join("dataset")).unwrap();
    let out = folder.path().join("out");
    let config = ExportConfig::new(Format::Scannet, vec!["scene0007".into(), "room-two".into()]);
    export(&dataset, &config, &out, Existing::Refuse, &Quiet).unwrap();
    let list = std::fs::read_to_string(out.join("scannetv2_train.txt")).unwrap();
    assert_eq!(list, "scene0007_00\nscene0007_01\nroom-two_cam_00\n");
    let mesh = out.join("scans/scene0007_01/scene0007_01_vh_clean_2.ply");
    assert!(mesh.is_file() && out.join("scans/scene0007_00/color/3.jpg").is_file());
}

#[test]
fn a_dataset_without_a_mesh_gets_images_alone_and_a_damaged_one_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = write(&folder.path().join("dataset"), &pinhole());
    let vertices = dataset.layout().mesh_file("room", VERTICES);
    let array = read_array(&vertices).unwrap();
    let Elements::F64(mut values) = array.values else { panic!("vertices are float64") };
    values[4] = f64::NAN;
    write_array(&vertices, &Array::f64(&array.shape, values), Storage::Contiguous, &[]).unwrap();
    let error = exported(&dataset, &folder.path().join("damaged")).unwrap_err();
    assert!(error.contains("mesh_vertices.hdf5") && error.contains("vertex 1 ") && error.contains("import"), "{error}");

    std::fs::remove_file(dataset.layout().mesh_file("room", OBJECTS_SEMANTIC)).unwrap();
    let out = folder.path().join("images");
    let said = exported(&dataset, &out).unwrap();
    assert!(said.iter().any(|line| line.contains("room") && line.contains(OBJECTS_SEMANTIC) && line.contains("no mesh")), "{said:?}");
    let names: Vec<String> = files(&out).into_keys().map(|name| name.display().to_string()).collect();
    assert!(names.iter().all(|name| !name.ends_with(".ply") && !name.contains("segs") && !name.contains("aggregation")), "{names:?}");
    assert!(names.contains(&"scans/room_cam_00/color/0.jpg".to_string()));
}

#[test]
fn what_has_no_label_is_zero_and_in_no_group() {
    let folder = tempfile::tempdir().unwrap();
    let dataset = write(&folder.path().join("dataset"), &pinhole());
    let mut labels = dataset.read_label_tables("room").unwrap();
    labels.parts[3].semantic = -1;
    dataset.write_label_tables("room", &labels).unwrap();
    let out = folder.path().join("out");
    exported(&dataset, &out).unwrap();
    let file = |suffix: &str| out.join(format!("scans/room_cam_00/room_cam_00{suffix}"));
    let labelled = ply(&file("_vh_clean_2.labels.ply"));
    let none: Vec<usize> = (0..labelled.labels.len()).filter(|&i| labelled.labels[i] == 0).collect();
    assert!(none.len() > 500 && none.iter().all(|&i| labelled.colors[i] == [0, 0, 0, 255] && labelled.positions[i][0] > 0.59));
    let groups = json(&file(".aggregation.json"))["segGroups"].as_array().unwrap().clone();
    let segments = numbers(&json(&file("_vh_clean_2.0.010000.segs.json"))["segIndices"]);
    let grouped: BTreeSet<u64> = groups.iter().flat_map(|group| numbers(&group["segments"])).collect();
    assert!(groups.len() == 3 && none.iter().all(|&i| !grouped.contains(&segments[i])));
}
