//! Geometry plugins to meshes, one for each material that a geometry's faces have.

use super::parameters;
use super::plugins::Handle;
use super::reader::{MAX_CHAIN, Meshes, Reader};
use crate::ImportError;
use crate::primitives;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use enfilade_vrscene::Value;
use std::collections::{BTreeMap, HashMap};

/// Half the side of the square that replaces an infinite plane, units.
const PLANE_HALF: f32 = 1000.0;

impl<'n> Reader<'n, '_> {
    /// The meshes of a geometry plugin, made at first use. Empty, with a warning, for kinds that are not supported.
    pub(super) fn geometry(&mut self, plugin: Handle<'n>, channel: i64, by_material: bool) -> Result<Meshes, ImportError> {
        let plugin = self.base_geometry(plugin)?;
        let key = (plugin.index, channel, by_material);
        if let Some(known) = self.meshes.get(&key) {
            return Ok(known.clone());
        }
        let meshes = match plugin.kind() {
            "GeomStaticMesh" => StaticMesh::read(plugin)?.meshes(self, channel, by_material)?,
            "GeomPlane" | "GeomInfinitePlane" => {
                self.warn(plugin, format!("the infinite plane became a square of {} units a side", 2.0 * PLANE_HALF));
                let mut mesh = primitives::rectangle();
                mesh.positions.iter_mut().for_each(|p| *p *= PLANE_HALF);
                vec![(0, mesh)]
            }
            kind => {
                self.warn(plugin, format!("{kind} is not supported, so what it shows was left out; export it as a mesh"));
                Vec::new()
            }
        };
        let mut made = Meshes::new();
        for (id, mesh) in meshes {
            made.extend(self.a.push_mesh(mesh, plugin.file, &plugin.place())?.map(|mesh| (id, mesh)));
        }
        self.meshes.insert(key, made.clone());
        Ok(made)
    }

    /// The geometry within plugins that change it in ways that are not supported.
    fn base_geometry(&mut self, plugin: Handle<'n>) -> Result<Handle<'n>, ImportError> {
        let mut at = plugin;
        for _ in 0..MAX_CHAIN {
            let within = match at.kind() {
                "GeomDisplacedMesh" | "GeomStaticSmoothedMesh" | "GeomStaticDisplacedMesh" => at.reference("mesh")?,
                _ => return Ok(at),
            };
            let Some(within) = within else { return Err(at.error("mesh", "there is no mesh; refer to the geometry that it changes")) };
            self.warn(at, "displacement and subdivision are not supported; the mesh was used as it is");
            at = within;
        }
        Err(plugin.error("mesh", "geometries refer to each other in a circle; refer to a mesh"))
    }
}

/// The lists of a `GeomStaticMesh`. Positions, normals and texture coordinates have indices of their own.
struct StaticMesh<'n> {
    plugin: Handle<'n>,
    positions: Vec<[f32; 3]>,
    faces: Vec<[usize; 3]>,
    normals: Vec<[f32; 3]>,
    face_normals: Vec<[usize; 3]>,
    material_ids: Vec<i32>,
}

/// A texture channel: its number, its coordinates, and which of them each face has.
type Channel = (i64, Vec<[f32; 3]>, Vec<[usize; 3]>);

impl<'n> StaticMesh<'n> {
    fn read(plugin: Handle<'n>) -> Result<Self, ImportError> {
        let positions = plugin.vectors("vertices")?;
        let faces = faces(plugin, "faces", &plugin.ints("faces")?, positions.len(), "vertices")?;
        let normals = plugin.vectors("normals")?;
        let face_normals = plugin.ints("faceNormals")?;
        let face_normals = match face_normals.as_slice() {
            // Without indices of their own, normals belong to the vertices.
            [] if normals.len() == positions.len() => faces.clone(),
            [] => Vec::new(),
            indices => faces_like(plugin, "faceNormals", indices, normals.len(), "normals", faces.len())?,
        };
        let material_ids = plugin.ints("face_mtlIDs")?;
        if !material_ids.is_empty() && material_ids.len() != faces.len() {
            let problem = format!("found {} material ids, expected one for each of the {} faces", material_ids.len(), faces.len());
            return Err(plugin.error("face_mtlIDs", problem + "; export the mesh again"));
        }
        Ok(Self { plugin, positions, faces, normals, face_normals, material_ids })
    }

    /// The mesh, or one for each material id.
    fn meshes(&self, reader: &mut Reader, channel: i64, by_material: bool) -> Result<Vec<(i32, Mesh)>, ImportError> {
        if self.normals.is_empty() != self.face_normals.is_empty() {
            reader.warn(self.plugin, "its normals belong to no vertices and were not used");
        }
        if self.plugin.is_animated("vertices") {
            reader.warn(self.plugin, "the mesh is animated; its first moment was used");
        }
        let channel = self.channel(reader, channel)?;
        let mut faces_of: BTreeMap<i32, Vec<usize>> = BTreeMap::new();
        for face in 0..self.faces.len() {
            let id = if by_material { self.material_ids.get(face).copied().unwrap_or(0) } else { 0 };
            faces_of.entry(id).or_default().push(face);
        }
        Ok(faces_of.into_iter().map(|(id, faces)| (id, self.mesh(&faces, channel.as_ref()))).collect())
    }

    /// The texture channel of a number; the first one, with a warning, where there is none of this number.
    fn channel(&self, reader: &mut Reader, wanted: i64) -> Result<Option<Channel>, ImportError> {
        let Some(Value::List(_, channels)) = self.plugin.value("map_channels")? else { return Ok(None) };
        let number = |channel: &Value| match channel {
            Value::List(_, parts) => parts.first().and_then(Value::number).map(|n| n as i64),
            _ => None,
        };
        let found = channels.iter().find(|c| number(c) == Some(wanted));
        let Some(channel) = found.or(channels.first()) else { return Ok(None) };
        let wrong =
            || self.plugin.error("map_channels", "expected List(List(number, ListVector(…), ListInt(…)), …); export the mesh again");
        let Value::List(_, parts) = channel else { return Err(wrong()) };
        let [index, coordinates, indices] = parts.as_slice() else { return Err(wrong()) };
        let (Some(index), Some(uvs), Some(indices)) = (index.number(), parameters::vectors(coordinates), parameters::ints(indices)) else {
            return Err(wrong());
        };
        if found.is_none() {
            reader.warn(self.plugin, format!("it has no texture channel {wanted}; channel {index} was used"));
        }
        if indices.is_empty() {
            return Ok(None);
        }
        let faces = faces_like(self.plugin, "map_channels", &indices, uvs.len(), "texture coordinates", self.faces.len())?;
        Ok(Some((index as i64, uvs, faces)))
    }

    /// The mesh of some of its faces. Corners that agree in position, normal and texture coordinate become one vertex.
    fn mesh(&self, faces: &[usize], channel: Option<&Channel>) -> Mesh {
        let mut mesh = Mesh::default();
        let mut vertices: HashMap<[usize; 3], u32> = HashMap::new();
        for &face in faces {
            let corner = |k: usize| {
                let normal = self.face_normals.get(face).map_or(0, |f| f[k]);
                let uv = channel.map_or(0, |(_, _, faces)| faces[face][k]);
                let at = [self.faces[face][k], normal, uv];
                *vertices.entry(at).or_insert_with(|| {
                    mesh.positions.push(Vec3::from(self.positions[at[0]]));
                    if !self.face_normals.is_empty() {
                        mesh.normals.push(Vec3::from(self.normals[normal]));
                    }
                    if let Some((_, uvs, _)) = channel {
                        mesh.uvs.push(Vec2::new(uvs[uv][0], uvs[uv][1]));
                    }
                    (mesh.positions.len() - 1) as u32
                })
            };
            let triangle = [0, 1, 2].map(corner);
            mesh.triangles.push(triangle);
        }
        mesh
    }
}

/// Triangles from a flat list of indices into `count` things.
fn faces(plugin: Handle, parameter: &str, indices: &[i32], count: usize, things: &str) -> Result<Vec<[usize; 3]>, ImportError> {
    let (triples, rest) = indices.as_chunks::<3>();
    if !rest.is_empty() {
        let problem = format!("found {} indices, expected three for each face; export the mesh again", indices.len());
        return Err(plugin.error(parameter, problem));
    }
    let index = |i: i32| usize::try_from(i).ok().filter(|&i| i < count);
    let triangle = |(face, &[a, b, c]): (usize, &[i32; 3])| match (index(a), index(b), index(c)) {
        (Some(a), Some(b), Some(c)) => Ok([a, b, c]),
        _ => {
            let problem = format!("face {face} has the indices {a}, {b}, {c}, but there are {count} {things}; export the mesh again");
            Err(plugin.error(parameter, problem))
        }
    };
    triples.iter().enumerate().map(triangle).collect()
}

/// [`faces`] that must be as many as the mesh has.
fn faces_like(
    plugin: Handle,
    parameter: &str,
    indices: &[i32],
    count: usize,
    things: &str,
    wanted: usize,
) -> Result<Vec<[usize; 3]>, ImportError> {
    if indices.len() != 3 * wanted {
        let problem = format!("found {} indices of {things}, expected three for each of the {wanted} faces", indices.len());
        return Err(plugin.error(parameter, problem + "; export the mesh again"));
    }
    faces(plugin, parameter, indices, count, things)
}
