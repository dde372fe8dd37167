//! The names of the files in a scene's mesh folder (`Layout::mesh_file`, `MeshFiles::file`), all of them Hypersim's except the file of
//! pieces.
//!
//! In `mesh_faces_Xi` each face has indices of X: vertices, normals, texture coordinates, groups, materials, objects. In
//! `mesh_objects_Xi` each object has its class or its instance.

/// Positions of vertices, float64 (V,3), asset units.
pub const VERTICES: &str = "mesh_vertices.hdf5";
/// Normals, float64 (N,3).
pub const NORMALS: &str = "mesh_normals.hdf5";
/// Texture coordinates, float64 (T,2).
pub const TEXCOORDS: &str = "mesh_texcoords.hdf5";
/// The vertices of every face, int64 (F,3).
pub const FACES_VERTICES: &str = "mesh_faces_vi.hdf5";
/// The normals of every face, int64 (F,3).
pub const FACES_NORMALS: &str = "mesh_faces_vni.hdf5";
/// The texture coordinates of every face, int64 (F,3).
pub const FACES_TEXCOORDS: &str = "mesh_faces_vti.hdf5";
/// The group of every face, int64 (F).
pub const FACES_GROUPS: &str = "mesh_faces_gi.hdf5";
/// The material of every face, int64 (F).
pub const FACES_MATERIALS: &str = "mesh_faces_mi.hdf5";
/// The object of every face, int64 (F).
pub const FACES_OBJECTS: &str = "mesh_faces_oi.hdf5";
/// The names of the objects.
pub const OBJECTS: &str = "metadata_objects.csv";
/// The names of the groups.
pub const GROUPS: &str = "metadata_groups.csv";
/// The names of the materials.
pub const MATERIALS: &str = "metadata_materials.csv";
/// The objects that came from splitting others; without the file, none did.
pub const OBJECT_PIECES: &str = "metadata_object_splits.csv";
/// The class of every object, int64 (O,1).
pub const OBJECTS_SEMANTIC: &str = "mesh_objects_si.hdf5";
/// The instance of every object, int64 (O,1).
pub const OBJECTS_INSTANCE: &str = "mesh_objects_sii.hdf5";
/// The display colour of every class, int64 (C,3).
pub const SEMANTIC_COLORS: &str = "metadata_semantic_colors.hdf5";
/// The display colour of every instance, int64 (I,3).
pub const INSTANCE_COLORS: &str = "metadata_semantic_instance_colors.hdf5";
