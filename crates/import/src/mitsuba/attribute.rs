//! Attributes of meshes: values that a PLY file has for vertices and faces, of which the mean is used.

use super::reader::Reader;
use super::xml::Node;
use crate::ImportError;
use enfilade_math::Rgb;

impl<'n> Reader<'n, '_> {
    /// The mean of the attribute that a texture refers to; `None`, with a warning, where the mesh has no attribute of that name.
    pub(super) fn mesh_attribute(&mut self, node: &'n Node) -> Result<Option<Rgb>, ImportError> {
        self.report_unknown(node, &["name", "scale"], &[]);
        let name = node.raw_text("name").ok_or_else(|| node.error("there is no name of an attribute, such as vertex_color"))?;
        let scale = node.float_or("scale", 1.0)? as f32;
        let means = self.attributes.current.and_then(|mesh| self.attributes.of_mesh.get(&mesh));
        let mean = means.and_then(|means| means.get(name)).map(|mean| mean * scale);
        let message = match mean {
            Some(_) => format!("attributes of meshes are not supported; the mean of {name} was used"),
            None => format!("the mesh has no attribute {name}; a mid grey stands in"),
        };
        self.warn(node, message);
        Ok(mean)
    }
}
