//! Reading of the files to verify. Unreadable files are added to the card.

use super::card::Card;
use super::check_labels;
use super::law::Law;
use super::rounding::Rounding;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{Dataset, DatasetError, MeshGeometry, Node};
use enfilade_frame::{Dtype, Frame, Layer, LayerSpec, Values, f16};
use enfilade_geometry::OccupancyTree;
use enfilade_scene::{Labels, PartLabel};

/// The value of a read; an error is added to the card.
pub(super) fn readable<T>(card: &mut Card, read: Result<T, DatasetError>) -> Option<T> {
    let problem = read.as_ref().err().map(ToString::to_string);
    card.observe(Law::Readable, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
    read.ok()
}

/// A scene as its frames are read.
#[derive(Clone, Copy)]
pub(super) struct Stored<'d> {
    pub dataset: &'d Dataset,
    pub scene: &'d str,
    /// Metres per unit of positions; 1 in our own datasets.
    pub meters_per_unit: f64,
    /// True for Hypersim's release, whose distances and positions are float16.
    pub released: bool,
}

/// Reads the existing layers as stored, except that positions are in metres, and how they were rounded. Types or sizes that differ from the
/// table's are added to the card.
pub(super) fn read_frame(stored: Stored<'_>, camera: &str, number: u32, layers: &[Layer], card: &mut Card) -> Option<(Frame, Rounding)> {
    let Stored { dataset, scene, .. } = stored;
    let mut frame: Option<Frame> = None;
    let mut rounding = Rounding::default();
    for spec in layers.iter().map(|layer| layer.spec()).filter(|spec| dataset.has_layer(scene, camera, number, spec.layer)) {
        let path = dataset.layout().layer(scene, camera, number, spec.layer);
        let Some(array) = readable(card, read_array(&path)) else { continue };
        let shape = array.shape.clone();
        let size = image_size(&shape, spec);
        let values = array.values.into_values().ok();
        // Only Hypersim's may be: ours must be float32.
        let is_half = stored.released && values.as_ref().is_some_and(|values| values.dtype() == Dtype::F16) && spec.dtype == Dtype::F32;
        if is_half {
            match spec.layer {
                Layer::Position => rounding.position = Some(stored.meters_per_unit),
                Layer::DepthMeters => rounding.distance = true,
                _ => (),
            }
        }
        if size.is_none() || (!is_half && values.as_ref().is_none_or(|values| values.dtype() != spec.dtype)) {
            let expected =
                format!("expected an image of {} channels of {:?}, found shape {shape:?} or another type", spec.channels, spec.dtype);
            card.observe(Law::Readable, 1.0, || format!("{}: {expected}", path.display()));
        }
        let (Some((width, height)), Some(mut values)) = (size, values.and_then(|values| as_floats(values, spec.dtype))) else { continue };
        if let (Layer::Position, Values::F32(positions)) = (spec.layer, &mut values) {
            positions.iter_mut().for_each(|v| *v = (f64::from(*v) * stored.meters_per_unit) as f32);
        }
        let frame = frame.get_or_insert_with(|| Frame::new(width, height));
        if (frame.width, frame.height) == (width, height) {
            frame.insert(spec.layer, values);
        } else {
            let other = format!("{width}x{height} pixels, but other layers of the frame have {}x{}", frame.width, frame.height);
            card.observe(Law::Readable, 1.0, || format!("{}: {other}", path.display()));
        }
    }
    Some((frame?, rounding))
}

/// Values in the type of their layer: Hypersim's own distances and positions are float16, and can be looked at nevertheless.
fn as_floats(values: Values, dtype: Dtype) -> Option<Values> {
    match (values, dtype) {
        (Values::F16(halves), Dtype::F32) => Some(Values::F32(halves.into_iter().map(f16::to_f32).collect())),
        (values, dtype) => (values.dtype() == dtype).then_some(values),
    }
}

/// Width and height of an image of the layer's channels.
fn image_size(shape: &[usize], spec: &LayerSpec) -> Option<(u32, u32)> {
    match (shape, spec.channels) {
        (&[height, width], 1) => Some((width as u32, height as u32)),
        (&[height, width, channels], expected) if channels == expected && expected > 1 => Some((width as u32, height as u32)),
        _ => None,
    }
}

/// Data that a scene's label images are checked against.
pub(super) struct SceneLabels {
    /// By render entity.
    pub labels: Labels,
    /// Labels of the other pieces of split parts, by render entity.
    pub pieces: Vec<(u32, PartLabel)>,
    /// The greatest class of the scene's list.
    pub last_class: i16,
}

/// The labels by render entity.
pub(super) fn read_labels(dataset: &Dataset, scene: &str, nodes: &[Node], card: &mut Card) -> Option<SceneLabels> {
    let files = dataset.mesh_files(scene);
    let read = files.read_labels().and_then(|tables| Ok((tables, files.read_pieces()?, files.read_last_class()?)));
    let (tables, parents, last_class) = match read {
        Ok(read) => read,
        Err(error) => {
            card.observe(Law::LabelTables, 1.0, || error.to_string());
            return None;
        }
    };
    let objects = nodes.iter().filter_map(|node| node.object_id).max().map_or(0, |id| id as usize + 1);
    let enough = tables.parts.len() >= objects + parents.len();
    card.observe(Law::LabelTables, if enough { 0.0 } else { 1.0 }, || {
        format!("{scene}: {} rows for {} objects", tables.parts.len(), objects + parents.len())
    });
    card.merge(check_labels(&tables, scene));
    let label = |node: &Node| node.object_id.and_then(|id| tables.parts.get(id as usize)).copied().unwrap_or(PartLabel::NONE);
    let first = tables.parts.len().saturating_sub(parents.len());
    let piece = |(&parent, &label): (&u32, &PartLabel)| {
        let node = nodes.iter().find(|node| node.object_id == Some(parent))?;
        Some((node.node_id, label))
    };
    let pieces = parents.iter().zip(&tables.parts[first..]).filter_map(piece).collect();
    Some(SceneLabels { labels: Labels { parts: nodes.iter().map(label).collect() }, pieces, last_class })
}

/// The geometry of the mesh folder, of which all is there or nothing: scenes that were rendered elsewhere, and copies for fast reading, have
/// none, and of Hypersim's release parts are downloaded. The triangles, where they are there.
pub(super) fn check_mesh(dataset: &Dataset, scene: &str, card: &mut Card) -> Option<MeshGeometry> {
    let files = dataset.mesh_files(scene);
    let is_there = |name: &&str| files.file(name).is_file();
    if dataset.is_released(scene) || !["mesh_vertices.hdf5", "mesh_normals.hdf5", "mesh_faces_vi.hdf5"].iter().any(is_there) {
        return None;
    }
    let mesh = readable(card, files.read());
    for name in ["mesh_normals.hdf5", "mesh_texcoords.hdf5", "mesh_faces_vni.hdf5", "mesh_faces_vti.hdf5"] {
        readable(card, read_array(&files.file(name)));
    }
    mesh
}

/// The free space, if there is one.
pub(super) fn read_tree(dataset: &Dataset, scene: &str, card: &mut Card) -> Option<OccupancyTree> {
    let path = dataset.layout().octomap(scene);
    let bytes = match dataset.read_free_space(scene) {
        Err(error) if error.is_not_found() => return None,
        read => readable(card, read)?.0,
    };
    let tree = OccupancyTree::from_bt(&bytes);
    let problem = tree.as_ref().err().map(|error| format!("{}: {error}", path.display()));
    card.observe(Law::Readable, if problem.is_some() { 1.0 } else { 0.0 }, || problem.unwrap_or_default());
    tree.ok()
}
