//! ScanNet's mesh of a scan: `<scan>_vh_clean_2.ply`, the same with labels, its segments and the groups that objects are made of.
//!
//! Binary PLY, little-endian; the dataset's world, metres. A vertex belongs to one part, so vertices at the border of two parts are there
//! twice, and class, segment and group of a vertex are exact. Every scan of a scene has the scene's whole mesh.

use super::classes::{Named, classes};
use super::segments::{FEWEST_VERTICES, THRESHOLD, segments};
use super::subdivide::{LONGEST_M, edge_length_m, subdivide, welded};
use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::mesh::{SurfaceMesh, object_meshes};
use crate::selected_frames::SelectedFrames;
use enfilade_math::DVec3;
use enfilade_scene::{PartLabel, Warning};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Colours of classes where there is none.
const UNLABELLED: [u8; 4] = [0, 0, 0, 255];

/// The mesh of a scene.
pub(super) struct SceneMesh {
    /// World, metres.
    pub vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// Class of every vertex, 0 for none.
    labels: Vec<u16>,
    /// Segment of every vertex.
    segments: Vec<u32>,
    groups: Vec<Group>,
    classes: BTreeMap<i16, Named>,
}

/// An object: the segments of an instance, or of a part that has a class and is no instance.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Group {
    id: usize,
    object_id: usize,
    segments: Vec<u32>,
    label: String,
    /// Number of the instance in `instance-filt`; our addition to the format.
    #[serde(skip_serializing_if = "Option::is_none")]
    instance: Option<i16>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Aggregation<'m> {
    scene_id: &'m str,
    app_id: String,
    seg_groups: &'m [Group],
    segments_file: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Segmentation<'m> {
    params: Parameters,
    scene_id: &'m str,
    seg_indices: &'m [u32],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Parameters {
    k_thresh: String,
    seg_min_verts: String,
}

/// The mesh of a scene whose mesh folder is whole.
pub(super) fn scene_mesh(selected: &SelectedFrames<'_>, scene: &str) -> Result<SceneMesh, ExportError> {
    let labels = selected.dataset.read_label_tables(scene)?.parts;
    let parts: Vec<(usize, SurfaceMesh)> =
        object_meshes(selected.dataset, scene)?.iter().map(|(&object, mesh)| (object, welded(mesh))).collect();
    let longest_m = edge_length_m(parts.iter().map(|(_, mesh)| mesh));
    if longest_m > LONGEST_M {
        let message = format!("its mesh is large: edges are cut to {longest_m:.2} m instead of {LONGEST_M} m, which bounds its vertices");
        selected.warn(Warning { place: scene.into(), message });
    }
    let cut = |(object, mut mesh): (usize, SurfaceMesh)| {
        subdivide(&mut mesh, longest_m);
        let segments = segments(&mesh);
        (labels.get(object).copied().unwrap_or(PartLabel::NONE), object, mesh, segments)
    };
    let parts: Vec<_> = parts.into_par_iter().map(cut).collect();
    if i32::try_from(parts.iter().map(|(_, _, mesh, _)| mesh.vertices.len()).sum::<usize>()).is_err() {
        return Err(selected.unsuitable(scene, "its mesh has more vertices than a PLY file can count (2147483647); leave the scene out"));
    }
    Ok(joined(parts, classes(selected, scene)?))
}

/// The label, number, surface and segments of a part.
type Part = (PartLabel, usize, SurfaceMesh, (Vec<u32>, u32));

fn joined(parts: Vec<Part>, classes: BTreeMap<i16, Named>) -> SceneMesh {
    let (vertices, faces, labels, segments, groups) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut whole = SceneMesh { vertices, faces, labels, segments, groups, classes };
    // Instances by number and class, then what is none by part.
    let mut of_objects: BTreeMap<(bool, usize, i16), Vec<u32>> = BTreeMap::new();
    let mut segments_before = 0;
    for (PartLabel { semantic, instance }, object, mesh, (segments, count)) in parts {
        let vertices_before = whole.vertices.len() as u32;
        let is_known = whole.classes.contains_key(&semantic);
        whole.faces.extend(mesh.faces.iter().map(|face| face.map(|corner| vertices_before + corner)));
        whole.labels.extend(std::iter::repeat_n(if is_known { semantic as u16 } else { 0 }, mesh.vertices.len()));
        whole.vertices.extend(mesh.vertices);
        whole.segments.extend(segments.iter().map(|segment| segments_before + segment));
        if is_known {
            let number = usize::try_from(instance).ok().filter(|&number| number > 0);
            let of_object = of_objects.entry((number.is_none(), number.unwrap_or(object), semantic)).or_default();
            of_object.extend(segments_before..segments_before + count);
        }
        segments_before += count;
    }
    for (id, ((is_part, number, semantic), segments)) in of_objects.into_iter().enumerate() {
        let instance = i16::try_from(number).ok().filter(|_| !is_part);
        whole.groups.push(Group { id, object_id: id, segments, label: whole.classes[&semantic].word.clone(), instance });
    }
    whole
}

impl SceneMesh {
    /// Writes the four files of a scan.
    pub fn write(&self, out: &ExportFolder, folder: &str, scan: &str, colors: &[[u8; 4]]) -> Result<(), ExportError> {
        let name = format!("{scan}_vh_clean_2");
        let segments_file = format!("{name}.0.010000.segs.json");
        out.write(&format!("{folder}/{name}.ply"), &self.ply(|i| (colors[i], None)))?;
        out.write(&format!("{folder}/{name}.labels.ply"), &self.ply(|i| (self.class_color(i), Some(self.labels[i]))))?;
        let params = Parameters { k_thresh: THRESHOLD.to_string(), seg_min_verts: FEWEST_VERTICES.to_string() };
        let segmentation = Segmentation { params, scene_id: scan, seg_indices: &self.segments };
        out.write(&format!("{folder}/{segments_file}"), &compact(&segmentation))?;
        let app_id = format!("enfilade {}", env!("CARGO_PKG_VERSION"));
        let aggregation = Aggregation { scene_id: scan, app_id, seg_groups: &self.groups, segments_file };
        out.write(&format!("{folder}/{scan}.aggregation.json"), &compact(&aggregation))
    }

    fn class_color(&self, vertex: usize) -> [u8; 4] {
        let class = self.classes.get(&(self.labels[vertex] as i16));
        class.map_or(UNLABELLED, |Named { color: [red, green, blue], .. }| [*red, *green, *blue, 255])
    }

    /// The bytes of a PLY file with the colour of every vertex, and its label where it has one.
    fn ply(&self, vertex: impl Fn(usize) -> ([u8; 4], Option<u16>)) -> Vec<u8> {
        let has_label = !self.vertices.is_empty() && vertex(0).1.is_some();
        let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", self.vertices.len()).into_bytes();
        let properties = [("float", &["x", "y", "z"][..]), ("uchar", &["red", "green", "blue", "alpha"])];
        for (kind, names) in properties.into_iter().chain(has_label.then_some(("ushort", &["label"][..]))) {
            names.iter().for_each(|name| bytes.extend(format!("property {kind} {name}\n").bytes()));
        }
        bytes.extend(format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", self.faces.len()).bytes());
        for (i, position) in self.vertices.iter().enumerate() {
            let (color, label) = vertex(i);
            bytes.extend(position.to_array().iter().flat_map(|&v| (v as f32).to_le_bytes()));
            bytes.extend(color);
            bytes.extend(label.into_iter().flat_map(u16::to_le_bytes));
        }
        for face in &self.faces {
            bytes.push(3);
            bytes.extend(face.iter().flat_map(|&corner| (corner as i32).to_le_bytes()));
        }
        bytes
    }
}

/// JSON without line breaks: a number for every vertex.
fn compact(value: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(value).expect("plain data encodes")
}
