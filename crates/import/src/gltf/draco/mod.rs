//! `KHR_draco_mesh_compression`: primitives whose vertices and triangles are a Draco stream.

mod stream;

use super::budget::Budget;
use super::buffers::Buffers;
use crate::assembly::Assembly;
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::mesh::{Mode, Primitive};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use serde_json::Value;
use std::collections::HashMap;
use std::rc::Rc;
use stream::Stream;

/// The extension's name.
pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// Unpacks all primitives that are Draco streams, so that they have plain accessors. Those that cannot be unpacked have their plain data,
/// where the file has some; what is wrong with the others goes into `unreadable` by mesh and primitive.
pub(super) fn unpack(
    root: &mut Root,
    buffers: &mut Buffers,
    unreadable: &mut HashMap<(usize, usize), String>,
    budget: &mut Budget,
    a: &mut Assembly,
) {
    let mut unpacker = Unpacker { buffers, budget, streams: HashMap::new(), attributes: HashMap::new() };
    for mesh in 0..root.meshes.len() {
        for i in 0..root.meshes[mesh].primitives.len() {
            let primitive = root.meshes[mesh].primitives[i].clone();
            let has_surface = matches!(primitive.mode, Checked::Valid(Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan));
            let extension = primitive.extensions.as_ref().and_then(|e| e.others.get(NAME)).filter(|_| has_surface);
            let Some(extension) = extension else { continue };
            match unpacker.primitive(root, &primitive, extension) {
                Ok(unpacked) => root.meshes[mesh].primitives[i] = unpacked,
                Err(problem) if has_plain_data(root, &primitive) => {
                    let place = format!("meshes[{mesh}].primitives[{i}].extensions.{NAME}");
                    a.warn(place, format!("it {problem}; the plain data of the file were used"));
                }
                Err(problem) => {
                    unreadable.insert((mesh, i), problem);
                }
            }
        }
    }
}

/// True when all accessors of a primitive have data of their own.
fn has_plain_data(root: &Root, primitive: &Primitive) -> bool {
    let mut accessors = primitive.attributes.values().chain(&primitive.indices);
    accessors.all(|i| root.accessors.get(i.value()).is_some_and(|a| a.buffer_view.is_some() || a.sparse.is_some()))
}

struct Unpacker<'u> {
    buffers: &'u mut Buffers,
    budget: &'u mut Budget,
    /// Decoded streams by their buffer view.
    streams: HashMap<usize, Result<Rc<Stream>, String>>,
    /// Accessors by buffer view, number of the attribute (none for indices), type and number of components.
    attributes: HashMap<(usize, Option<u32>, u32, usize), Index<Accessor>>,
}

impl Unpacker<'_> {
    /// The primitive with plain accessors.
    fn primitive(&mut self, root: &mut Root, packed: &Primitive, extension: &Value) -> Result<Primitive, String> {
        let number = |value: &Value| value.as_u64().and_then(|v| u32::try_from(v).ok());
        let view = extension.get("bufferView").and_then(number).ok_or("has no bufferView; export the file again")? as usize;
        let stream = match self.streams.get(&view) {
            Some(known) => known.clone(),
            None => {
                let decoded = self.decode(root, view);
                self.streams.entry(view).or_insert(decoded).clone()
            }
        }?;
        let mut primitive = packed.clone();
        let ids = extension.get("attributes").and_then(Value::as_object).ok_or("has no attributes; export the file again")?;
        for (semantic, accessor) in &mut primitive.attributes {
            let Checked::Valid(semantic) = semantic else { continue };
            let Some(id) = ids.get(&semantic.to_string()) else { continue };
            let id = number(id).ok_or_else(|| format!("has {id} for {semantic:?}, expected a number; export the file again"))?;
            let stated = root.accessors.get(accessor.value()).cloned();
            let stated = stated.ok_or_else(|| format!("stands for accessor {}, which is not there; export it again", accessor.value()))?;
            *accessor = self.attribute(root, &stream, view, id, &stated)?;
        }
        if let Some(indices) = self.indices(root, &stream, view)? {
            primitive.indices = Some(indices);
            // Strips and fans are lists by now.
            primitive.mode = Checked::Valid(Mode::Triangles);
        } else if primitive.indices.is_some_and(|i| root.accessors.get(i.value()).is_none_or(|a| a.buffer_view.is_none())) {
            primitive.indices = None;
        }
        Ok(primitive)
    }

    fn decode(&mut self, root: &Root, view: usize) -> Result<Rc<Stream>, String> {
        let json = root.buffer_views.get(view).ok_or_else(|| format!("refers to bufferView {view}, which is not there"))?;
        let start = json.byte_offset.map_or(0, |o| o.0);
        let bytes = self.buffers.range(&format!("is in bufferViews[{view}], which"), json.buffer.value(), start, json.byte_length.0)?;
        Stream::decode(bytes, self.budget.most(bytes.len())).map(Rc::new)
    }

    /// An accessor of an attribute, made at first use.
    fn attribute(&mut self, root: &mut Root, stream: &Stream, view: usize, id: u32, stated: &Accessor) -> Result<Index<Accessor>, String> {
        let (Checked::Valid(kind), Checked::Valid(of)) = (stated.component_type, stated.type_) else {
            return Err("stands for an accessor of unknown type; export the file again".into());
        };
        let components = of.multiplicity();
        let key = (view, Some(id), kind.0.as_gl_enum(), components);
        if let Some(&known) = self.attributes.get(&key) {
            return Ok(known);
        }
        self.count(root, view, stream.vertices() * components * kind.0.size())?;
        let bytes = stream.attribute(id, components, kind.0)?;
        let accessor = Accessor { count: stream.vertices().into(), byte_offset: None, sparse: None, ..stated.clone() };
        Ok(self.push(root, key, bytes, accessor))
    }

    /// An accessor of the triangles' indices, made at first use.
    fn indices(&mut self, root: &mut Root, stream: &Stream, view: usize) -> Result<Option<Index<Accessor>>, String> {
        let key = (view, None, 0, 1);
        if let Some(&known) = self.attributes.get(&key) {
            return Ok(Some(known));
        }
        let Some(bytes) = stream.indices() else { return Ok(None) };
        self.count(root, view, bytes.len())?;
        let accessor = Accessor {
            buffer_view: None,
            byte_offset: None,
            count: (bytes.len() / 4).into(),
            component_type: Checked::Valid(GenericComponentType(ComponentType::U32)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(Type::Scalar),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        };
        Ok(Some(self.push(root, key, bytes, accessor)))
    }

    /// Counts data that are unpacked from a buffer view.
    fn count(&mut self, root: &Root, view: usize, bytes: usize) -> Result<(), String> {
        let packed = root.buffer_views.get(view).map_or(0, |view| view.byte_length.0 as usize);
        self.budget.take(bytes as u64, packed)
    }

    /// Appends an accessor of these bytes.
    fn push(&mut self, root: &mut Root, key: (usize, Option<u32>, u32, usize), bytes: Vec<u8>, accessor: Accessor) -> Index<Accessor> {
        let view = View {
            buffer: Index::new(0),
            byte_length: bytes.len().into(),
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: Default::default(),
        };
        let view = root.push(View { buffer: Index::new(self.buffers.push(bytes)), ..view });
        let index = root.push(Accessor { buffer_view: Some(view), ..accessor });
        self.attributes.insert(key, index);
        index
    }
}
