//! Meshes whose faces have the number of their object, as in annotated scans: one mesh per object.

use super::faces::Faces;
use super::header::{Element, Problem, parse_header};
use super::values::Values;
use crate::ImportError;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec3, linear_from_srgb};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Names of the property of a face, or of a vertex, with the number of the object.
const OBJECT: [&str; 3] = ["object_id", "objectId", "segment_id"];

/// The faces of one object.
pub(crate) struct ObjectMesh {
    /// Number of the object in its faces.
    pub id: i64,
    pub mesh: Mesh,
    /// The mean of the colours of its vertices, linear; `None` where vertices have none.
    pub color: Option<[f32; 3]>,
}

/// The vertices of a file.
#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    colors: Vec<[f32; 3]>,
    objects: Vec<i64>,
}

/// Reads a mesh, apart by objects in the order of their numbers.
///
/// # Errors
/// When the file is no PLY, or neither its faces nor its vertices have the number of an object.
pub(crate) fn read_objects(bytes: &[u8], file: &Path) -> Result<Vec<ObjectMesh>, ImportError> {
    let error = |(place, problem): Problem| ImportError::malformed(file, place, problem);
    let (header, body) = parse_header(bytes).map_err(error)?;
    let mut values = Values::new(&header, body);
    let (mut vertices, mut faces) = (Vertices::default(), BTreeMap::new());
    let mut of_faces = Vec::new();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices = read_vertices(element, &mut values).map_err(error)?,
            "face" => of_faces = read_faces(element, &mut values).map_err(error)?,
            _ if element.properties.is_empty() => (),
            _ => (0..element.count).try_for_each(|_| element.row(&mut values, &mut |_, _| ())).map_err(error)?,
        }
    }
    for (number, (polygon, object)) in of_faces.into_iter().enumerate() {
        let of_vertex = || vertices.objects.get(*polygon.first()? as usize).copied();
        let Some(object) = object.or_else(of_vertex) else {
            let problem = format!("neither faces nor vertices have a number {}; expected an annotated mesh", OBJECT.join(" or "));
            return Err(ImportError::malformed(file, format!("face {number}"), problem));
        };
        faces.entry(object).or_insert_with(Vec::new).push((number as u64, polygon));
    }
    apart(faces, &vertices).map_err(error)
}

/// The polygons of each object, cut into triangles together.
fn apart(of_objects: BTreeMap<i64, Vec<(u64, Vec<f64>)>>, vertices: &Vertices) -> Result<Vec<ObjectMesh>, Problem> {
    let (mut faces, mut counts) = (Faces::default(), Vec::new());
    for (id, polygons) in &of_objects {
        polygons.iter().for_each(|(number, polygon)| faces.push(*number, polygon, None));
        // A polygon of n corners gives n − 2 triangles.
        counts.push((*id, polygons.iter().map(|(_, polygon)| polygon.len().saturating_sub(2)).sum::<usize>()));
    }
    let mut whole = Mesh { positions: vertices.positions.clone(), ..Mesh::default() };
    faces.cut_into(&mut whole)?;
    let mut rest = &whole.triangles[..];
    let mut meshes = Vec::new();
    for (id, count) in counts {
        let (own, others) = rest.split_at(count.min(rest.len()));
        rest = others;
        meshes.push(object_mesh(id, own, vertices));
    }
    Ok(meshes)
}

/// Index of a property with one of these names.
fn index_of(element: &Element, names: &[&str]) -> Option<usize> {
    names.iter().find_map(|name| element.properties.iter().position(|p| p.name == *name && p.list.is_none()))
}

fn read_vertices(element: &Element, values: &mut Values) -> Result<Vertices, Problem> {
    let [x, y, z] = ["x", "y", "z"].map(|name| index_of(element, &[name]));
    let (Some(x), Some(y), Some(z)) = (x, y, z) else {
        return Err(("header".into(), "the vertices have no x, y and z; export the file with them".into()));
    };
    let rgb = ["red", "green", "blue"].map(|name| index_of(element, &[name]));
    let object = index_of(element, &OBJECT);
    let mut vertices = Vertices::default();
    let mut row = vec![0.0; element.properties.len()];
    for _ in 0..element.count {
        element.row(values, &mut |i, value| row[i] = value)?;
        vertices.positions.push(Vec3::new(row[x] as f32, row[y] as f32, row[z] as f32));
        if let [Some(r), Some(g), Some(b)] = rgb {
            let channel = |i: usize| linear_from_srgb((row[i] / element.properties[i].kind.full()).clamp(0.0, 1.0) as f32);
            vertices.colors.push([r, g, b].map(channel));
        }
        vertices.objects.extend(object.map(|i| row[i] as i64));
    }
    Ok(vertices)
}

/// Polygons with their objects, if faces have them.
type Polygons = Vec<(Vec<f64>, Option<i64>)>;

fn read_faces(element: &Element, values: &mut Values) -> Result<Polygons, Problem> {
    let indices = element.properties.iter().position(|p| p.list.is_some() && p.name.starts_with("vertex_ind"));
    let Some(indices) = indices else {
        return Err(("header".into(), "the faces have no vertex_indices; export the file with them".into()));
    };
    let object = index_of(element, &OBJECT);
    let mut faces = Vec::new();
    for _ in 0..element.count {
        let (mut polygon, mut id) = (Vec::new(), None);
        element.row(values, &mut |i, value| {
            if i == indices {
                polygon.push(value);
            } else if Some(i) == object {
                id = Some(value as i64);
            }
        })?;
        faces.push((polygon, id));
    }
    Ok(faces)
}

/// The mesh of one object, with the vertices that it uses alone.
fn object_mesh(id: i64, triangles: &[[u32; 3]], vertices: &Vertices) -> ObjectMesh {
    let (mut mesh, mut known, mut sum) = (Mesh::default(), HashMap::new(), [0.0f64; 3]);
    for triangle in triangles {
        mesh.triangles.push(triangle.map(|vertex| {
            *known.entry(vertex).or_insert_with(|| {
                mesh.positions.push(vertices.positions[vertex as usize]);
                let color = vertices.colors.get(vertex as usize).copied().unwrap_or_default();
                sum.iter_mut().zip(color).for_each(|(sum, c)| *sum += f64::from(c));
                (mesh.positions.len() - 1) as u32
            })
        }));
    }
    let count = mesh.positions.len().max(1) as f64;
    let color = (!vertices.colors.is_empty()).then(|| sum.map(|s| (s / count) as f32));
    ObjectMesh { id, mesh, color }
}
