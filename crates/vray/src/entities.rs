//! From V-Ray's numbers of nodes and lights to the parts of a dataset.

use crate::error::VrayError;
use enfilade_dataset::{Dataset, Node, read_node_table};
use std::collections::HashMap;
use std::path::Path;

/// The meaning of numbers in `VRayRenderEntityID` in the dataset.
#[derive(Debug)]
pub(crate) struct Entities {
    /// Value of `render_entity_id` of node i + 1; `None` where the node is no part of the dataset.
    parts: Vec<Option<i16>>,
}

/// The entity that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entity {
    /// Nothing.
    Void,
    /// A part with this `render_entity_id`.
    Part(i16),
    /// A node that is no part of the dataset.
    Stranger,
    /// A light, or anything else with a number beyond the nodes.
    Light,
}

impl Entities {
    /// For the images of a scene whose nodes are in the table `nodes`: a `metadata_nodes.csv` that `enfilade vray entities` wrote; without
    /// one, the dataset's own table is used.
    ///
    /// A dataset without a table receives this one. With the same table, V-Ray's numbers are kept. Otherwise the nodes are matched by their
    /// objects: a pixel gets the number of the dataset's node that belongs to the same object.
    ///
    /// # Errors
    /// When a table cannot be read, or has more rows than int16 can number.
    pub fn read(dataset: &Dataset, scene: &str, nodes: Option<&Path>) -> Result<Self, VrayError> {
        let own = match dataset.read_nodes(scene) {
            Err(error) if error.is_not_found() => None,
            own => Some(own?),
        };
        let path = nodes.map_or_else(|| dataset.layout().metadata_nodes(scene), Path::to_path_buf);
        let theirs = match (nodes, &own) {
            (Some(path), _) => read_node_table(path)?,
            (None, Some(own)) => own.clone(),
            (None, None) => {
                let message = format!("the scene {scene} has no table of nodes ({})", path.display());
                return Err(VrayError::usage(message, "name that of the V-Ray scene with --nodes (enfilade vray entities --nodes FILE)"));
            }
        };
        if theirs.len() > i16::MAX as usize {
            return Err(VrayError::usage(
                format!("{}: {} nodes, but render_entity_id is int16 and holds 32767", path.display(), theirs.len()),
                "join small objects before the scene is exported",
            ));
        }
        let Some(own) = own else {
            dataset.write_nodes(scene, &theirs)?;
            return Ok(Self::identity(theirs.len()));
        };
        if own == theirs { Ok(Self::identity(own.len())) } else { Self::by_object(&own, &theirs, &path) }
    }

    fn identity(count: usize) -> Self {
        Self { parts: (1..=count as i16).map(Some).collect() }
    }

    fn by_object(own: &[Node], theirs: &[Node], path: &Path) -> Result<Self, VrayError> {
        let known = own.iter().filter_map(|node| Some((node.object_id?, node)));
        let by_object: HashMap<u32, &Node> = known.rev().collect();
        let part = |node: &Node| {
            let Some(object) = node.object_id else { return Ok(None) };
            match by_object.get(&object) {
                Some(own) if own.object_name == node.object_name => Ok(Some(own.node_id as i16)),
                found => {
                    let there = found.map_or("none".into(), |own| format!("{:?}", own.object_name));
                    let message = format!(
                        "{}: node {} is object {object} {:?}, which in the dataset is {there}",
                        path.display(),
                        node.node_id,
                        node.object_name
                    );
                    let hint = "number the nodes by the dataset's own objects: enfilade vray entities --objects \
                        DATASET/scenes/SCENE/_detail/mesh/metadata_objects.csv, and render again";
                    Err(VrayError::usage(message, hint))
                }
            }
        };
        Ok(Self { parts: theirs.iter().map(part).collect::<Result<_, _>>()? })
    }

    /// `render_entity_id` by number of the node, from 1.
    pub fn parts(&self) -> &[Option<i16>] {
        &self.parts
    }

    /// The entity of a number.
    pub fn of(&self, id: i64) -> Entity {
        match usize::try_from(id).ok().and_then(|id| id.checked_sub(1)) {
            None => Entity::Void,
            Some(index) => match self.parts.get(index) {
                Some(Some(part)) => Entity::Part(*part),
                Some(None) => Entity::Stranger,
                None => Entity::Light,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(node_id: u32, name: &str, object: Option<u32>, object_name: &str) -> Node {
        Node { node_id, node_name: name.into(), object_id: object, object_name: object_name.into(), is_partly_there: false }
    }

    const THEIRS: &str =
        "node_id,node_name,object_id,object_name\n1,chair@a,1,chair\n2,rail,-1,_NULL_OBJECT\n3,chair@b,1,chair\n4,wall,0,wall\n";

    #[test]
    fn nodes_become_the_parts_of_their_objects() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let path = folder.path().join("nodes.csv");
        std::fs::write(&path, THEIRS).unwrap();
        dataset.write_nodes("room", &[node(1, "wall", Some(0), "wall"), node(2, "chair", Some(1), "chair")]).unwrap();
        let entities = Entities::read(&dataset, "room", Some(&path)).unwrap();
        let found: Vec<Entity> = [-1, 0, 1, 2, 3, 4, 5].map(|id| entities.of(id)).to_vec();
        let expected = [Entity::Void, Entity::Void, Entity::Part(2), Entity::Stranger, Entity::Part(2), Entity::Part(1), Entity::Light];
        assert_eq!(found, expected);
        dataset.write_nodes("room", &[node(1, "wall", Some(0), "wall"), node(2, "sofa", Some(1), "sofa")]).unwrap();
        let message = Entities::read(&dataset, "room", Some(&path)).unwrap_err().to_string();
        assert!(message.contains("node 1 is object 1 \"chair\", which in the dataset is \"sofa\""), "{message}");
    }

    #[test]
    fn a_dataset_without_nodes_takes_those_of_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(Entities::read(&dataset, "room", None).unwrap_err().to_string().contains("has no table of nodes"));
        let path = folder.path().join("nodes.csv");
        std::fs::write(&path, THEIRS).unwrap();
        let entities = Entities::read(&dataset, "room", Some(&path)).unwrap();
        assert_eq!((entities.of(2), entities.of(5)), (Entity::Part(2), Entity::Light));
        assert_eq!(std::fs::read_to_string(dataset.layout().metadata_nodes("room")).unwrap(), THEIRS);
        assert_eq!(dataset.meters_per_asset_unit("room").unwrap(), 1.0);
    }
}
