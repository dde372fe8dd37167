//! The mesh folder's geometry and names, for those who want points, boxes and meshes beside the images.
//!
//! The vertices of all parts follow one after the other, in world space and metres. `mesh_faces_vti` has indices into
//! `mesh_texcoords` and `mesh_faces_vni` into `mesh_normals`, as the names say; in Hypersim's own files the two are swapped.
//! −1 means "none".

use crate::atomic::remove_if_there;
use crate::hdf5::{Array, Storage, write_array};
use crate::mesh_names as names;
use crate::tables::Table;
use crate::{DatasetError, Layout, replace_file};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Part, Scene};

/// The arrays of the mesh folder, as they grow part by part.
#[derive(Default)]
struct Arrays {
    vertices: Vec<f64>,
    normals: Vec<f64>,
    texcoords: Vec<f64>,
    faces_vi: Vec<i64>,
    faces_vni: Vec<i64>,
    faces_vti: Vec<i64>,
    faces_oi: Vec<i64>,
    faces_mi: Vec<i64>,
}

/// Writes the geometry of every part, and the tables of objects, groups (there are none) and materials.
pub(crate) fn write_mesh(layout: &Layout, scene_name: &str, scene: &Scene) -> Result<(), DatasetError> {
    let mut arrays = Arrays::default();
    for (object, part) in scene.parts.iter().enumerate() {
        arrays.add(scene, part, object as i64);
    }
    let faces = arrays.faces_oi.len();
    let rows = |values: Vec<f64>, width: usize| Array::f64(&[values.len() / width, width], values);
    let corners = |values: Vec<i64>| Array::i64(&[faces, 3], values);
    let files = [
        (names::VERTICES, rows(arrays.vertices, 3), "m"),
        (names::NORMALS, rows(arrays.normals, 3), ""),
        (names::TEXCOORDS, rows(arrays.texcoords, 2), ""),
        (names::FACES_VERTICES, corners(arrays.faces_vi), ""),
        (names::FACES_NORMALS, corners(arrays.faces_vni), ""),
        (names::FACES_TEXCOORDS, corners(arrays.faces_vti), ""),
        (names::FACES_OBJECTS, Array::i64(&[faces], arrays.faces_oi), ""),
        (names::FACES_GROUPS, Array::i64(&[faces], vec![-1; faces]), ""),
        (names::FACES_MATERIALS, Array::i64(&[faces], arrays.faces_mi), ""),
    ];
    for (name, array, unit) in &files {
        let attributes: &[(&str, &str)] = if unit.is_empty() { &[] } else { &[("unit", unit)] };
        let path = layout.mesh_file(scene_name, name);
        replace_file(&path, |aside| write_array(aside, array, Storage::Compressed, attributes))?;
    }
    let write_names = |file: &str, column: &str, names: Vec<&str>| {
        let mut table = Table::new(&layout.mesh_file(scene_name, file), &[column]);
        table.rows = names.into_iter().map(|name| vec![name.to_string()]).collect();
        table.write()
    };
    // Objects are whole again, if people had split any: what they did is in their log.
    remove_if_there(&layout.mesh_file(scene_name, names::OBJECT_PIECES))?;
    write_names(names::OBJECTS, "object_name", scene.parts.iter().map(|p| p.name.as_str()).collect())?;
    write_names(names::GROUPS, "group_name", vec![])?;
    write_names(names::MATERIALS, "material_name", scene.materials.iter().map(|m| m.name.as_str()).collect())
}

impl Arrays {
    /// Appends a part in world space.
    fn add(&mut self, scene: &Scene, part: &Part, object: i64) {
        let mesh = &scene.meshes[part.mesh as usize];
        let normal_matrix: DMat3 = part.world_from_mesh.matrix3.inverse().transpose();
        let (first_v, first_n, first_t) = (self.vertices.len() / 3, self.normals.len() / 3, self.texcoords.len() / 2);
        let point = |p: &enfilade_math::Vec3| part.world_from_mesh.transform_point3(p.as_dvec3()).to_array();
        let normal = |n: &enfilade_math::Vec3| (normal_matrix * n.as_dvec3()).try_normalize().unwrap_or(DVec3::ZERO).to_array();
        self.vertices.extend(mesh.positions.iter().flat_map(point));
        self.normals.extend(mesh.normals.iter().flat_map(normal));
        self.texcoords.extend(mesh.uvs.iter().flat_map(|uv| uv.as_dvec2().to_array()));
        let corners = || mesh.triangles.iter().flatten();
        let from = |first: usize, present: bool| move |&i: &u32| if present { first as i64 + i64::from(i) } else { -1 };
        self.faces_vi.extend(corners().map(from(first_v, true)));
        self.faces_vni.extend(corners().map(from(first_n, !mesh.normals.is_empty())));
        self.faces_vti.extend(corners().map(from(first_t, !mesh.uvs.is_empty())));
        self.faces_oi.extend(mesh.triangles.iter().map(|_| object));
        self.faces_mi.extend(mesh.triangles.iter().map(|_| i64::from(part.material)));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::hdf5::{Elements, read_array};
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec2, Vec3};
    use enfilade_scene::Material;

    /// A floor with texture coordinates and a shared triangle with normals, twice as large.
    pub(crate) fn two_parts() -> Scene {
        let triangle = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let floor =
            Mesh { positions: triangle.clone(), uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let lamp = Mesh { positions: triangle, normals: vec![Vec3::Z; 3], triangles: vec![[0, 1, 2], [2, 1, 0]], ..Mesh::default() };
        let part = |name: &str, mesh, world_from_mesh| Part { name: name.into(), object: None, mesh, material: mesh, world_from_mesh };
        let raised = DAffine3::from_translation(DVec3::Z) * DAffine3::from_scale(DVec3::splat(2.0));
        Scene {
            meshes: vec![floor.into(), lamp.into()],
            parts: vec![part("floor, oak", 0, DAffine3::IDENTITY), part("lamp", 1, raised)],
            materials: vec![Material::diffuse("oak", Rgb::splat(0.5)), Material::diffuse("paper", Rgb::WHITE)],
            ..Scene::default()
        }
    }

    #[test]
    fn parts_stand_in_the_world_one_after_the_other() {
        let folder = tempfile::tempdir().unwrap();
        let layout = Layout::new(folder.path());
        write_mesh(&layout, "room", &two_parts()).unwrap();
        let read = |name: &str| read_array(&layout.mesh_file("room", &format!("mesh_{name}.hdf5"))).unwrap();
        let Elements::F64(vertices) = read("vertices").values else { panic!("not float64") };
        assert_eq!(vertices[12..15], [2.0, 0.0, 1.0]);
        assert_eq!(read("faces_vi"), Array::i64(&[3, 3], vec![0, 1, 2, 3, 4, 5, 5, 4, 3]));
        assert_eq!(read("faces_vni"), Array::i64(&[3, 3], vec![-1, -1, -1, 0, 1, 2, 2, 1, 0]));
        assert_eq!(read("faces_vti"), Array::i64(&[3, 3], vec![0, 1, 2, -1, -1, -1, -1, -1, -1]));
        assert_eq!(read("faces_oi"), Array::i64(&[3], vec![0, 1, 1]));
        assert_eq!(read("normals"), Array::f64(&[3, 3], vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
        let objects = std::fs::read_to_string(layout.mesh_file("room", "metadata_objects.csv")).unwrap();
        assert_eq!(objects, "object_name\n\"floor, oak\"\nlamp\n");
    }
}
