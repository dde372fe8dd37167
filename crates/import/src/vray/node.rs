//! `Node` plugins to parts: one for each material of their geometry.

use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use enfilade_math::DAffine3;
use enfilade_scene::PartLabel;

impl<'n> Reader<'n, '_> {
    /// Adds the parts of all nodes.
    pub(super) fn nodes(&mut self) -> Result<(), ImportError> {
        let nodes: Vec<Handle<'n>> = self.plugins.of_kind("Node").collect();
        for (i, node) in nodes.iter().enumerate() {
            self.a.progress(i + 1, nodes.len());
            self.node(*node)?;
        }
        Ok(())
    }

    fn node(&mut self, node: Handle<'n>) -> Result<(), ImportError> {
        self.warn_of_animation(node, &["transform", "visible"]);
        if !node.flag("visible", true)? {
            return Ok(());
        }
        if !node.flag("primary_visibility", true)? {
            self.warn(node, "it should be unseen by cameras and yet there for light, which is not supported; it is seen");
        }
        let Some(geometry) = node.reference("geometry")? else {
            self.warn(node, "it has no geometry and was left out");
            return Ok(());
        };
        let placement = node.transform("transform")?;
        let materials = self.materials_of(node)?;
        let by_id = materials.len() > 1;
        // Materials without textures take any channel.
        let channel = materials.iter().find_map(|(_, made)| made.channel).unwrap_or(1);
        let object = self.a.push_object(&node.name(), None);
        for (id, mesh) in self.geometry(geometry, channel, by_id)? {
            // Ids beyond the list begin it again, as in 3ds Max.
            let found = materials.iter().find(|(own, _)| *own == id || !by_id);
            let found = found.or_else(|| materials.get(usize::try_from(id).unwrap_or(0) % materials.len().max(1)));
            let Some((_, made)) = found else { continue };
            let mesh = match made.channel.filter(|own| *own != channel) {
                None => mesh,
                Some(own) => {
                    let of_channel = self.geometry(geometry, own, by_id)?;
                    of_channel.into_iter().find_map(|(of, other)| (of == id).then_some(other)).unwrap_or(mesh)
                }
            };
            let name = if by_id { format!("{}_{}", node.name(), made.name) } else { node.name() };
            self.a.push_part_of(object, &name, mesh, made.index, placement, PartLabel::NONE);
        }
        Ok(())
    }

    /// Adds the surface of a light as a part.
    pub(super) fn light_part(&mut self, light: Handle<'n>, mesh: u32, material: u32, placement: DAffine3) {
        self.a.push_part(&light.name(), mesh, material, placement, PartLabel::NONE);
    }
}
