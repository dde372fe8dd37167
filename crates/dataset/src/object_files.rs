//! Reading the mesh folder for labelling: triangles, the objects that they belong to, and objects that were cut into pieces.
//!
//! An object that was cut keeps its number for the remaining piece; the other pieces are appended. `mesh_faces_oi.hdf5` then has the object
//! of each face, and `metadata_object_splits.csv` the object that each appended piece was a part of.

use crate::atomic::remove_if_there;
use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::mesh_names::{FACES_MATERIALS, FACES_OBJECTS, FACES_VERTICES, MATERIALS, OBJECT_PIECES, OBJECTS, VERTICES};
use crate::tables::Table;
use crate::{Dataset, DatasetError, replace_file};
use enfilade_math::DVec3;
use std::path::{Path, PathBuf};

/// A mesh folder: ours, or Hypersim's.
#[derive(Clone, Debug)]
pub struct MeshFiles {
    folder: PathBuf,
}

/// The triangles of a mesh folder, and what they belong to.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshGeometry {
    /// Asset units, which in our datasets are metres.
    pub vertices: Vec<DVec3>,
    /// Indices into the vertices.
    pub faces: Vec<[u32; 3]>,
    /// The object of every face, as it was before objects were cut.
    pub object_of_face: Vec<u32>,
    /// The material of every face, if it has one.
    pub material_of_face: Vec<Option<u32>>,
    /// Names of the objects, without those that were cut from others.
    pub objects: Vec<String>,
    /// Names of the materials.
    pub materials: Vec<String>,
}

impl Dataset {
    /// The mesh folder of a scene.
    pub fn mesh_files(&self, scene: &str) -> MeshFiles {
        MeshFiles::new(self.layout().mesh_dir(scene))
    }
}

impl MeshFiles {
    /// The mesh folder at `folder`, which need not exist.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// A file of the folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The triangles and what they belong to. Materials may be missing, as they are in parts of Hypersim.
    ///
    /// # Errors
    /// When a file is missing or damaged, or the files do not fit each other.
    pub fn read(&self) -> Result<MeshGeometry, DatasetError> {
        let mut objects = self.read_object_names()?;
        let parents = self.read_pieces()?;
        let object_of_face = read_indices(&self.file(FACES_OBJECTS), objects.len(), "objects")?;
        let whole = objects.len().saturating_sub(parents.len());
        objects.truncate(whole);
        let before = |object: u32| parents.get((object as usize).wrapping_sub(whole)).copied().unwrap_or(object);
        self.read_geometry(objects, object_of_face.into_iter().map(before).collect())
    }

    /// Reads the mesh as [`MeshFiles::read`] does, if the caller knows how many objects were not cut from others (the first `whole`), and
    /// the object of every face before that. The tables of these need not fit each other then.
    ///
    /// # Errors
    /// As [`MeshFiles::read`].
    pub fn read_whole(&self, whole: usize, object_of_face: Vec<u32>) -> Result<MeshGeometry, DatasetError> {
        let mut objects = self.read_object_names()?;
        objects.truncate(whole);
        self.read_geometry(objects, object_of_face)
    }

    fn read_geometry(&self, objects: Vec<String>, object_of_face: Vec<u32>) -> Result<MeshGeometry, DatasetError> {
        let path = self.file(VERTICES);
        let vertices = match read_array(&path)? {
            Array { values: Elements::F64(values), shape } if shape.get(1) == Some(&3) => {
                values.chunks_exact(3).map(DVec3::from_slice).collect::<Vec<_>>()
            }
            other => return Err(unexpected(&path, "float64 (V,3)", &other)),
        };
        if let Some(bad) = vertices.iter().position(|v| !v.is_finite()) {
            return Err(DatasetError::hdf5(&path, format!("vertex {bad} is {}; expected finite numbers", vertices[bad])));
        }
        let path = self.file(FACES_VERTICES);
        let corners = read_indices(&path, vertices.len(), "vertices")?;
        let faces: Vec<[u32; 3]> = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let path = self.file(FACES_OBJECTS);
        check_length(&path, object_of_face.len(), faces.len())?;
        if let Some(face) = object_of_face.iter().position(|&object| object as usize >= objects.len()) {
            let problem =
                format!("face {face} is of object {}, but {} are whole; export the mesh again", object_of_face[face], objects.len());
            return Err(DatasetError::hdf5(&path, problem));
        }
        let (material_of_face, materials) = self.read_materials(faces.len())?;
        Ok(MeshGeometry { vertices, faces, object_of_face, material_of_face, objects, materials })
    }

    /// Names of the objects, pieces of cut ones last.
    ///
    /// # Errors
    /// When the table is missing or damaged.
    pub fn read_object_names(&self) -> Result<Vec<String>, DatasetError> {
        self.names(OBJECTS, "object_name")
    }

    /// The object of every face, cut objects by their pieces.
    ///
    /// # Errors
    /// When the file is missing or damaged.
    pub fn read_objects_of_faces(&self) -> Result<Vec<u32>, DatasetError> {
        read_indices(&self.file(FACES_OBJECTS), u32::MAX as usize, "objects")
    }

    /// For each of the objects that were cut from others, which are the last ones, the object that it was a part of.
    ///
    /// # Errors
    /// When the table is damaged; without a table nothing was cut.
    pub fn read_pieces(&self) -> Result<Vec<u32>, DatasetError> {
        let path = self.file(OBJECT_PIECES);
        let table = match Table::read(&path) {
            Err(error) if error.is_not_found() => return Ok(Vec::new()),
            table => table?,
        };
        let (object, parent) = (table.column("object_id")?, table.column("parent_object_id")?);
        let Some(first) = (!table.rows.is_empty()).then(|| table.parse::<u32>(0, object)).transpose()? else { return Ok(Vec::new()) };
        let row = |row: usize| {
            let (object, parent): (u32, u32) = (table.parse(row, object)?, table.parse(row, parent)?);
            if parent >= first || u64::from(object) != u64::from(first) + row as u64 {
                let problem = format!("line {}: object {object} of {parent}; expected objects in order, from one that is whole", row + 2);
                return Err(DatasetError::text(&path, problem));
            }
            Ok(parent)
        };
        (0..table.rows.len()).map(row).collect()
    }

    /// Writes the objects and which face belongs to which: `whole` names first, then those of `pieces`, each with the object that it
    /// was a part of. Returns the files.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_objects(&self, whole: &[String], pieces: &[(String, u32)], object_of_face: &[u32]) -> Result<Vec<PathBuf>, DatasetError> {
        let mut objects = Table::new(&self.file(OBJECTS), &["object_name"]);
        objects.rows = whole.iter().chain(pieces.iter().map(|(name, _)| name)).map(|name| vec![name.clone()]).collect();
        objects.write()?;
        let faces = Array::i64(&[object_of_face.len()], object_of_face.iter().map(|&o| i64::from(o)).collect());
        replace_file(&self.file(FACES_OBJECTS), |aside| write_array(aside, &faces, Storage::Compressed, &[]))?;
        let mut files = vec![self.file(OBJECTS), self.file(FACES_OBJECTS)];
        let path = self.file(OBJECT_PIECES);
        if pieces.is_empty() {
            remove_if_there(&path)?;
        } else {
            let mut pieces_table = Table::new(&path, &["object_id", "parent_object_id"]);
            let row = |(i, (_, parent)): (usize, &(String, u32))| vec![(whole.len() + i).to_string(), parent.to_string()];
            pieces_table.rows = pieces.iter().enumerate().map(row).collect();
            pieces_table.write()?;
            files.push(path);
        }
        Ok(files)
    }

    fn read_materials(&self, faces: usize) -> Result<(Vec<Option<u32>>, Vec<String>), DatasetError> {
        let path = self.file(FACES_MATERIALS);
        if !path.is_file() {
            return Ok((vec![None; faces], Vec::new()));
        }
        let materials = self.names(MATERIALS, "material_name")?;
        let values = read_i64(&path)?;
        check_length(&path, values.len(), faces)?;
        let known = |&value: &i64| u32::try_from(value).ok().filter(|&m| (m as usize) < materials.len());
        Ok((values.iter().map(known).collect(), materials))
    }

    fn names(&self, file: &str, column: &str) -> Result<Vec<String>, DatasetError> {
        let table = Table::read(&self.file(file))?;
        let column = table.column(column)?;
        Ok(table.rows.into_iter().map(|mut row| row.swap_remove(column)).collect())
    }
}

fn unexpected(path: &Path, expected: &str, found: &Array) -> DatasetError {
    DatasetError::hdf5(path, format!("expected {expected}, found {} of shape {:?}", found.values.element().name(), found.shape))
}

fn read_i64(path: &Path) -> Result<Vec<i64>, DatasetError> {
    match read_array(path)? {
        Array { values: Elements::I64(values), .. } => Ok(values),
        other => Err(unexpected(path, "int64", &other)),
    }
}

/// Reads indices into a list of `count` things.
fn read_indices(path: &Path, count: usize, what: &str) -> Result<Vec<u32>, DatasetError> {
    let index = |(place, value): (usize, i64)| {
        u32::try_from(value).ok().filter(|&i| (i as usize) < count).ok_or_else(|| {
            DatasetError::hdf5(path, format!("entry {place} is {value}, but there are {count} {what}; export the mesh again"))
        })
    };
    read_i64(path)?.into_iter().enumerate().map(index).collect()
}

fn check_length(path: &Path, found: usize, faces: usize) -> Result<(), DatasetError> {
    if found == faces {
        return Ok(());
    }
    Err(DatasetError::hdf5(path, format!("{found} entries for {faces} faces; export the mesh again")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_files::tests::two_parts;

    #[test]
    fn a_mesh_comes_back_and_so_do_pieces() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_scene("room", &two_parts()).unwrap();
        let files = dataset.mesh_files("room");
        let mesh = files.read().unwrap();
        assert_eq!((mesh.objects.clone(), mesh.object_of_face.clone()), (vec!["floor, oak".into(), "lamp".into()], vec![0, 1, 1]));
        assert_eq!((mesh.material_of_face[2], mesh.materials[1].as_str()), (Some(1), "paper"));
        assert_eq!((mesh.vertices[4], mesh.faces[2]), (DVec3::new(2.0, 0.0, 1.0), [5, 4, 3]));
        let written = files.write_objects(&mesh.objects, &[("lamp~2".into(), 1)], &[0, 1, 2]).unwrap();
        assert_eq!(written.len(), 3);
        assert_eq!((files.read().unwrap(), files.read_objects_of_faces().unwrap()), (mesh.clone(), vec![0, 1, 2]));
        assert_eq!(files.read_pieces().unwrap(), [1]);
        // Without the table of pieces, the caller must state which objects are whole.
        std::fs::remove_file(files.file(OBJECT_PIECES)).unwrap();
        assert_eq!(files.read().unwrap().objects.len(), 3);
        assert_eq!(files.read_whole(2, vec![0, 1, 1]).unwrap(), mesh);
        assert!(files.read_whole(1, vec![0, 1, 1]).unwrap_err().to_string().contains("face 1 is of object 1, but 1 are whole"));
        files.write_objects(&mesh.objects, &[], &mesh.object_of_face).unwrap();
        assert!(files.read_pieces().unwrap().is_empty() && !files.file(OBJECT_PIECES).exists());
    }

    #[test]
    fn files_that_do_not_fit_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_scene("room", &two_parts()).unwrap();
        let files = dataset.mesh_files("room");
        files.write_objects(&["floor".into()], &[], &[0, 1, 1]).unwrap();
        let message = files.read().unwrap_err().to_string();
        assert!(message.ends_with("mesh_faces_oi.hdf5: entry 1 is 1, but there are 1 objects; export the mesh again"), "{message}");
        crate::write_bytes(&files.file(OBJECT_PIECES), "object_id,parent_object_id\n2,1\n4,1\n").unwrap();
        assert!(files.read_pieces().unwrap_err().to_string().contains("line 3: object 4 of 1"));
    }
}
