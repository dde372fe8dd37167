//! The files of a scene as a whole, apart from its cameras: units, render entities, geometry, free space.

use crate::camera_files::{optional, read_f64_vec3};
use crate::frames::read_json;
use crate::hdf5::{Array, Storage, write_array};
use crate::mesh_files::write_mesh;
use crate::tables::{Table, write_parameters};
use crate::{Dataset, DatasetError, check_name, replace_file, write_bytes, write_json};
use enfilade_math::DVec3;
use enfilade_scene::{Part, Rooms, Scene};
use std::path::Path;

/// Hypersim's name for the object of a node that belongs to none.
const NULL_OBJECT: &str = "_NULL_OBJECT";
const NODE_COLUMNS: [&str; 4] = ["node_id", "node_name", "object_id", "object_name"];
/// Column of our own scenes alone: 1 where [`Node::is_partly_there`].
const PARTLY_THERE: &str = "partly_there";
const METERS: &str = "meters_per_asset_unit";

/// A row of `metadata_nodes.csv`: a render entity and the object it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// From 1, in order; the value of `render_entity_id`.
    pub node_id: u32,
    /// Name of the entity.
    pub node_name: String,
    /// Index into the object tables; `None` where Hypersim writes −1.
    pub object_id: Option<u32>,
    /// Name of the object.
    pub object_name: String,
    /// Whether one sees things behind it through opacity or holes, so that colours and reflectances of its pixels are partly theirs. False
    /// if that is not known.
    pub is_partly_there: bool,
}

impl Dataset {
    /// Writes the files of a scene as a whole: `metadata_scene.csv`, `metadata_nodes.csv`,
    /// `metadata_materials.csv` and the mesh folder's geometry and names. Every part is one node and one object.
    ///
    /// # Errors
    /// When a file cannot be written, or the scene has more parts or materials than int16 can number (32767).
    pub fn write_scene(&self, scene_name: &str, scene: &Scene) -> Result<(), DatasetError> {
        check_name("scene name", scene_name)?;
        let max = i16::MAX as usize;
        if scene.parts.len() > max || scene.materials.len() > max {
            let problem = format!(
                "{} parts and {} materials, but render_entity_id and material_id are int16 and hold 32767; join small parts",
                scene.parts.len(),
                scene.materials.len()
            );
            return Err(DatasetError::Unstorable { what: format!("scene {scene_name:?}"), problem });
        }
        write_parameters(&self.layout().metadata_scene(scene_name), &[(METERS, 1.0)])?;
        let mut nodes = Table::new(&self.layout().metadata_nodes(scene_name), &[&NODE_COLUMNS[..], &[PARTLY_THERE]].concat());
        let node = |(i, part): (usize, &Part)| {
            let partly = u8::from(scene.materials[part.material as usize].is_partly_there());
            vec![(i + 1).to_string(), part.name.clone(), i.to_string(), part.name.clone(), partly.to_string()]
        };
        nodes.rows = scene.parts.iter().enumerate().map(node).collect();
        nodes.write()?;
        let mut materials = Table::new(&self.layout().metadata_materials(scene_name), &["material_id", "material_name"]);
        materials.rows = scene.materials.iter().enumerate().map(|(i, m)| vec![(i + 1).to_string(), m.name.clone()]).collect();
        materials.write()?;
        write_mesh(self.layout(), scene_name, scene)
    }

    /// Writes the rooms, walls, doors and windows of a scene, `_detail/layout.json`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_rooms(&self, scene: &str, rooms: &Rooms) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        write_json(&self.layout().rooms(scene), rooms)
    }

    /// The rooms, walls, doors and windows of a scene; `None` where they are not known.
    ///
    /// # Errors
    /// When the file is damaged, or of a newer version of the program.
    pub fn read_rooms(&self, scene: &str) -> Result<Option<Rooms>, DatasetError> {
        let path = self.layout().rooms(scene);
        let remedy = "import the scene again, which rewrites it";
        let Some(rooms) = read_json::<Rooms>(&path, remedy)? else { return Ok(None) };
        rooms.check().map_err(|problem| DatasetError::text(&path, format!("{problem}; {remedy}")))?;
        Ok(Some(rooms))
    }

    /// Adds to `metadata_scene.csv` what was subtracted from the coordinates of the scene's file, metres, z up: `offset_x_m` and so on.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_offset(&self, scene_name: &str, offset_m: [f64; 3]) -> Result<(), DatasetError> {
        check_name("scene name", scene_name)?;
        let [x, y, z] = offset_m;
        write_parameters(
            &self.layout().metadata_scene(scene_name),
            &[(METERS, 1.0), ("offset_x_m", x), ("offset_y_m", y), ("offset_z_m", z)],
        )
    }

    /// The render entities, in order of `node_id` (1, 2, …).
    ///
    /// # Errors
    /// When the table is missing or damaged.
    pub fn read_nodes(&self, scene: &str) -> Result<Vec<Node>, DatasetError> {
        read_node_table(&self.layout().metadata_nodes(scene))
    }

    /// Writes `metadata_nodes.csv`, and `metadata_scene.csv` of a scene in metres: the files that a scene rendered elsewhere needs. Of its
    /// nodes it is not known which are partly there.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_nodes(&self, scene: &str, nodes: &[Node]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        let mut table = Table::new(&self.layout().metadata_nodes(scene), &NODE_COLUMNS);
        let object = |node: &Node| node.object_id.map_or("-1".into(), |id| id.to_string());
        table.rows = nodes.iter().map(|n| vec![n.node_id.to_string(), n.node_name.clone(), object(n), n.object_name.clone()]).collect();
        table.write()?;
        let units = self.layout().metadata_scene(scene);
        if units.is_file() { Ok(()) } else { write_parameters(&units, &[(METERS, 1.0)]) }
    }

    /// Metres per asset unit; 1 in every dataset of ours. If Hypersim's `metadata_scene.csv` was not downloaded, it is read from the table
    /// of cameras.
    ///
    /// # Errors
    /// When both tables are missing or lack the scene, or one that is there is damaged or states no positive number.
    pub fn meters_per_asset_unit(&self, scene: &str) -> Result<f64, DatasetError> {
        let path = self.layout().metadata_scene(scene);
        let (metres, path) = match Table::read(&path) {
            Err(error) if error.is_not_found() => {
                // A table without the scene counts as missing; one that has the scene without its unit is an error.
                let table = optional(self.read_camera_table())?.filter(|table| table.scenes().any(|name| name == scene));
                (table.ok_or(error)?.meters_per_asset_unit(scene)?, self.camera_table())
            }
            table => (table?.parameter(METERS)?, path),
        };
        let problem = || format!("scene {scene:?} has {metres} metres per asset unit; expected a positive number");
        if metres.is_finite() && metres > 0.0 { Ok(metres) } else { Err(DatasetError::text(&path, problem())) }
    }

    /// Writes the occupancy tree (OctoMap's `.bt` bytes) and the bounds of the free voxels' centres.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_free_space(&self, scene: &str, tree_bt: &[u8], free_min: DVec3, free_max: DVec3) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        write_bytes(&self.layout().octomap(scene), tree_bt)?;
        let bounds = [(self.layout().octomap_free_space_min(scene), free_min), (self.layout().octomap_free_space_max(scene), free_max)];
        bounds.iter().try_for_each(|(path, point)| {
            let array = Array::f64(&[3], point.to_array().to_vec());
            replace_file(path, |aside| write_array(aside, &array, Storage::Contiguous, &[]))
        })
    }

    /// The occupancy tree's `.bt` bytes and the bounds of the free voxels' centres.
    ///
    /// # Errors
    /// When a file is missing or damaged.
    pub fn read_free_space(&self, scene: &str) -> Result<(Vec<u8>, DVec3, DVec3), DatasetError> {
        let path = self.layout().octomap(scene);
        let tree = std::fs::read(&path).map_err(DatasetError::at("read", &path))?;
        let min = read_f64_vec3(&self.layout().octomap_free_space_min(scene))?;
        Ok((tree, min, read_f64_vec3(&self.layout().octomap_free_space_max(scene))?))
    }
}

/// A table of render entities in the form of `metadata_nodes.csv`, in any folder.
///
/// # Errors
/// When it is missing or damaged, or the entities are not numbered 1, 2, 3, … in order.
pub fn read_node_table(path: &Path) -> Result<Vec<Node>, DatasetError> {
    let table = Table::read(path)?;
    let [id, name, object, object_name] = table.columns(NODE_COLUMNS)?;
    let partly = table.column(PARTLY_THERE).ok();
    let node = |row: usize| {
        let node_id: u32 = table.parse(row, id)?;
        if node_id as usize != row + 1 {
            let problem = format!("line {}: node_id is {node_id}, expected {} (1, 2, 3, … in order)", row + 2, row + 1);
            return Err(DatasetError::text(path, problem));
        }
        let text = |column: usize| table.rows[row][column].clone();
        let object_id = u32::try_from(table.parse::<i64>(row, object)?).ok().filter(|_| text(object_name) != NULL_OBJECT);
        let is_partly_there = partly.is_some_and(|column| text(column) == "1");
        Ok(Node { node_id, node_name: text(name), object_id, object_name: text(object_name), is_partly_there })
    };
    (0..table.rows.len()).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_files::tests::two_parts;
    use enfilade_scene::{Alpha, Material};

    #[test]
    fn nodes_are_the_parts_from_one() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_scene("room", &two_parts()).unwrap();
        let nodes = dataset.read_nodes("room").unwrap();
        let expected = |id: u32, name: &str| Node {
            node_id: id,
            node_name: name.into(),
            object_id: Some(id - 1),
            object_name: name.into(),
            is_partly_there: false,
        };
        assert_eq!(nodes, [expected(1, "floor, oak"), expected(2, "lamp")]);
        assert_eq!(dataset.meters_per_asset_unit("room").unwrap(), 1.0);
        // A lamp of a shade that is half transparent.
        let mut scene = two_parts();
        let shade = &mut scene.parts[1].material;
        let half = Material { alpha: Alpha::Blend { opacity: 0.5.into() }, ..scene.materials[*shade as usize].clone() };
        *shade = scene.materials.len() as u32;
        scene.materials.push(half);
        dataset.write_scene("room", &scene).unwrap();
        assert_eq!(dataset.read_nodes("room").unwrap().iter().map(|n| n.is_partly_there).collect::<Vec<_>>(), [false, true]);
    }

    #[test]
    fn the_offset_of_a_scene_stands_beside_its_unit() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_scene("room", &two_parts()).unwrap();
        dataset.write_offset("room", [445_123.0, 5_411_235.0, 0.0]).unwrap();
        let text = std::fs::read_to_string(dataset.layout().metadata_scene("room")).unwrap();
        let expected =
            "parameter_name,parameter_value\nmeters_per_asset_unit,1.0\noffset_x_m,445123.0\noffset_y_m,5411235.0\noffset_z_m,0.0\n";
        assert_eq!(text, expected);
        assert_eq!(dataset.meters_per_asset_unit("room").unwrap(), 1.0);
    }

    #[test]
    fn nodes_out_of_order_are_refused_and_null_objects_have_no_id() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let path = dataset.layout().metadata_nodes("room");
        write_bytes(&path, "node_id,node_name,object_id,object_name\n1,a,-1,_NULL_OBJECT\n2,b,0,b\n").unwrap();
        assert_eq!(dataset.read_nodes("room").unwrap().iter().map(|n| n.object_id).collect::<Vec<_>>(), [None, Some(0)]);
        write_bytes(&path, "node_id,node_name,object_id,object_name\n2,a,0,a\n").unwrap();
        let message = dataset.read_nodes("room").unwrap_err().to_string();
        assert!(message.ends_with("line 2: node_id is 2, expected 1 (1, 2, 3, … in order)"), "{message}");
    }

    #[test]
    fn free_space_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let (min, max) = (DVec3::new(-1.05, 0.05, 0.15), DVec3::new(3.45, 2.0, 2.35));
        dataset.write_free_space("room", b"# Octomap", min, max).unwrap();
        assert_eq!(dataset.read_free_space("room").unwrap(), (b"# Octomap".to_vec(), min, max));
    }

    #[test]
    fn names_that_leave_the_dataset_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(matches!(dataset.write_scene("../room", &two_parts()), Err(DatasetError::Name { .. })));
    }
}
