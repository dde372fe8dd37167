//! A Draco stream: the vertices and triangles within, read out attribute by attribute.
//!
//! The decoder is `draco-core`: without unsafe code, and with limits on what it allocates.

use draco_core::{AttributeValueIndex, DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::ComponentType;

/// A decoded stream.
pub(super) struct Stream {
    mesh: Mesh,
    /// False for a cloud of points, whose triangles are elsewhere.
    has_triangles: bool,
}

impl Stream {
    /// Decodes a stream to at most the given number of bytes of attributes.
    ///
    /// # Errors
    /// When it is damaged or contains more, as the rest of a sentence.
    pub(super) fn decode(bytes: &[u8], most: u64) -> Result<Self, String> {
        // A vertex has at least a position of three bytes.
        let limits = DecodeLimits::default().with_max_decoded_bytes(most).with_max_points(most / 3).with_max_faces(most / 3);
        let mut mesh = Mesh::new();
        let decoded = MeshDecoder::new().decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh);
        decoded.map_err(|e| format!("cannot be decoded ({e}); it is damaged, or else export it without compression"))?;
        // Behind the magic and the version.
        Ok(Self { mesh, has_triangles: bytes.get(7) == Some(&1) })
    }

    pub(super) fn vertices(&self) -> usize {
        self.mesh.num_points()
    }

    /// Indices of the triangles, little-endian; `None` for a cloud of points.
    pub(super) fn indices(&self) -> Option<Vec<u8>> {
        self.has_triangles.then(|| self.mesh.faces().iter().flatten().flat_map(|point| point.0.to_le_bytes()).collect())
    }

    /// The attribute of that number, in the form of an accessor with these components of this type.
    ///
    /// # Errors
    /// When there is none, or it has another number of components, as the rest of a sentence.
    pub(super) fn attribute(&self, id: u32, components: usize, kind: ComponentType) -> Result<Vec<u8>, String> {
        let found = self.mesh.attribute_by_unique_id(id).ok_or_else(|| format!("has no attribute {id}; export the file again"))?;
        if usize::from(found.num_components()) != components {
            let problem = format!("has {} components in attribute {id}, expected {components}; export it again", found.num_components());
            return Err(problem);
        }
        let mut bytes = Vec::new();
        for point in 0..self.vertices() as u32 {
            let value = value(found, found.mapped_index(PointIndex(point)))
                .ok_or_else(|| format!("lacks attribute {id} at vertex {point}; the file is damaged, so export it again"))?;
            for component in value.chunks_exact(found.data_type().byte_length()) {
                write(number(found.data_type(), component), kind, &mut bytes);
            }
        }
        Ok(bytes)
    }
}

/// The bytes of a value; `None` beyond the last.
fn value(attribute: &PointAttribute, index: AttributeValueIndex) -> Option<&[u8]> {
    let length = usize::from(attribute.num_components()) * attribute.data_type().byte_length();
    let stride = usize::try_from(attribute.byte_stride()).ok()?;
    let start = (index.0 as usize).checked_mul(stride)?;
    attribute.buffer().data().get(start..start.checked_add(length)?)
}

/// A component from exactly its bytes. Doubles represent all that glTF has exactly.
fn number(kind: DataType, bytes: &[u8]) -> f64 {
    let low = bytes.iter().rev().fold(0u64, |value, b| value << 8 | u64::from(*b));
    match kind {
        DataType::Int8 => f64::from(low as i8),
        DataType::Int16 => f64::from(low as i16),
        DataType::Int32 => f64::from(low as i32),
        DataType::Int64 => low as i64 as f64,
        DataType::Float32 => f64::from(f32::from_bits(low as u32)),
        DataType::Float64 => f64::from_bits(low),
        _ => low as f64,
    }
}

/// Appends a component in the type of the accessor.
fn write(v: f64, kind: ComponentType, bytes: &mut Vec<u8>) {
    match kind {
        ComponentType::I8 => bytes.extend((v as i8).to_le_bytes()),
        ComponentType::U8 => bytes.push(v as u8),
        ComponentType::I16 => bytes.extend((v as i16).to_le_bytes()),
        ComponentType::U16 => bytes.extend((v as u16).to_le_bytes()),
        ComponentType::U32 => bytes.extend((v as u32).to_le_bytes()),
        ComponentType::F32 => bytes.extend((v as f32).to_le_bytes()),
    }
}
