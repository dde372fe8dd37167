//! Geometries: the sources of their vertices, and the faces of each primitive as a mesh.

use super::document::{Dae, Node, called, child, children, indices, numbers};
use crate::ImportError;
use crate::assembly::{Assembly, origin_of};
use crate::polygon;
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// Kinds of primitives with a surface.
const SURFACES: [&str; 5] = ["triangles", "polylist", "polygons", "tristrips", "trifans"];
/// Kinds without.
const LINES: [&str; 2] = ["lines", "linestrips"];

/// The primitives of a geometry that have a surface.
pub(super) fn primitives<'d>(geometry: Node<'d>, a: &mut Assembly) -> Vec<Node<'d>> {
    let Some(mesh) = child(geometry, "mesh") else {
        a.warn(called(geometry), "it is no mesh (a spline, a hull or a formula) and was left out");
        return Vec::new();
    };
    let name = |n: &Node| n.tag_name().name().to_string();
    if mesh.children().any(|n| n.is_element() && LINES.contains(&n.tag_name().name())) {
        a.warn(called(geometry), "lines have no surface and were left out");
    }
    mesh.children().filter(|n| n.is_element() && SURFACES.contains(&&*name(n))).collect()
}

/// Numbers of a source by vertex.
struct Source {
    values: Vec<f64>,
    offset: usize,
    stride: usize,
}

impl Source {
    fn get<const N: usize>(&self, index: u32) -> Option<[f64; N]> {
        let at = self.offset.checked_add((index as usize).checked_mul(self.stride)?)?;
        self.values.get(at..at.checked_add(N)?)?.try_into().ok()
    }

    fn len(&self) -> usize {
        self.values.len().saturating_sub(self.offset).div_ceil(self.stride.max(1))
    }

    /// All of it that is whole, as points.
    fn points(&self) -> Vec<DVec3> {
        (0..self.len() as u32).filter_map(|i| self.get(i).map(DVec3::from_array)).collect()
    }
}

/// A source that the corners of a primitive refer to.
struct Input {
    /// Place in the indices of a corner.
    offset: usize,
    source: Source,
}

/// The inputs of a primitive that are used.
struct Inputs {
    position: Input,
    normal: Option<Input>,
    uv: Option<Input>,
    /// Indices of a corner.
    stride: usize,
}

/// The mesh of a primitive.
pub(super) struct Made {
    pub mesh: Mesh,
    /// The point from which its positions count.
    pub origin: DVec3,
    /// The vertex of the geometry that each vertex of the mesh is.
    pub points: Vec<u32>,
    /// The vertices of the geometry.
    pub all: Vec<DVec3>,
}

/// The vertices of a geometry; none where it has no mesh.
pub(super) fn positions(dae: &Dae, geometry: Node, a: &mut Assembly) -> Vec<DVec3> {
    let vertices = child(geometry, "mesh").and_then(|mesh| child(mesh, "vertices"));
    let input = vertices.and_then(|v| children(v, "input").find(|input| input.attribute("semantic") == Some("POSITION")));
    let source = input.and_then(|input| dae.target(input.attribute("source")?)).map(|node| source(dae, node, a));
    source.map(|source| source.points()).unwrap_or_default()
}

/// The mesh of a primitive with the set of texture coordinates `set`.
///
/// # Errors
/// When it refers to vertices that are not there, or has no positions.
pub(super) fn mesh(dae: &Dae, primitive: Node, set: Option<&str>, a: &mut Assembly) -> Result<Made, ImportError> {
    let geometry = primitive.ancestors().find(|n| n.tag_name().name() == "geometry").unwrap_or(primitive);
    let place = called(geometry);
    let inputs = inputs(dae, primitive, set, a).map_err(|problem| a.malformed(&place, format!("{problem}; export the file again")))?;
    let polygons = polygons(primitive, inputs.stride, &place, a)
        .map_err(|problem| a.malformed(&place, format!("{problem}; export the file again")))?;
    let all = inputs.position.source.points();
    let origin = origin_of(all.iter().copied(), a.meters_per_unit());
    let mut builder = Builder { inputs: &inputs, origin, mesh: Mesh::default(), points: Vec::new(), known: HashMap::new(), dangling: 0 };
    for corners in &polygons {
        builder.add(corners).map_err(|problem| a.malformed(&place, format!("{problem}; export the file again")))?;
    }
    if builder.dangling > 0 {
        let message = format!("{} corners refer to normals or texture coordinates that are not there; they are without", builder.dangling);
        a.warn(place, message);
    }
    let Builder { mesh, points, .. } = builder;
    Ok(Made { mesh, origin, points, all })
}

struct Builder<'i> {
    inputs: &'i Inputs,
    origin: DVec3,
    mesh: Mesh,
    points: Vec<u32>,
    known: HashMap<[u32; 3], u32>,
    dangling: usize,
}

impl Builder<'_> {
    /// Adds a polygon of these corners, each as many indices as the inputs have places.
    fn add(&mut self, corners: &[u32]) -> Result<(), String> {
        let mut polygon = Vec::with_capacity(corners.len() / self.inputs.stride);
        for corner in corners.chunks_exact(self.inputs.stride) {
            polygon.push(self.vertex(corner)?);
        }
        if polygon.len() < 3 {
            return Ok(());
        }
        if let [a, b, c] = polygon[..] {
            self.mesh.triangles.push([a, b, c]);
        } else {
            let points: Vec<Vec3> = polygon.iter().map(|&i| self.mesh.positions[i as usize]).collect();
            self.mesh.triangles.extend(polygon::triangulate(&points).into_iter().map(|t| t.map(|i| polygon[i])));
        }
        Ok(())
    }

    fn vertex(&mut self, corner: &[u32]) -> Result<u32, String> {
        let index = |input: Option<&Input>| input.and_then(|input| corner.get(input.offset).copied()).unwrap_or(0);
        let Inputs { position, normal, uv, .. } = self.inputs;
        let key = [index(Some(position)), index(normal.as_ref()), index(uv.as_ref())];
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let found: Option<[f64; 3]> = position.source.get(key[0]);
        let found = found.ok_or_else(|| format!("a face refers to vertex {}, but there are only {}", key[0], position.source.len()))?;
        self.mesh.positions.push((DVec3::from_array(found) - self.origin).as_vec3());
        self.points.push(key[0]);
        if let Some(normal) = normal {
            let found = normal.source.get::<3>(key[1]);
            self.dangling += usize::from(found.is_none());
            self.mesh.normals.push(found.map_or(Vec3::ZERO, |n| DVec3::from_array(n).as_vec3()));
        }
        if let Some(uv) = uv {
            let found = uv.source.get::<2>(key[2]);
            self.dangling += usize::from(found.is_none());
            self.mesh.uvs.push(found.map_or(Vec2::ZERO, |[u, v]| Vec2::new(u as f32, v as f32)));
        }
        let vertex = (self.mesh.positions.len() - 1) as u32;
        self.known.insert(key, vertex);
        Ok(vertex)
    }
}

/// The inputs of a primitive.
fn inputs(dae: &Dae, primitive: Node, set: Option<&str>, a: &mut Assembly) -> Result<Inputs, String> {
    let offset = |input: Node| input.attribute("offset").and_then(|o| o.trim().parse().ok()).unwrap_or(0usize);
    let (mut position, mut normal, mut uv) = (None, None, None);
    let mut stride = 1;
    for input in children(primitive, "input") {
        let at = offset(input);
        if at >= MAX_INPUTS {
            return Err(format!("found an input with the offset {at}, expected fewer than {MAX_INPUTS}"));
        }
        stride = stride.max(at + 1);
        let target = dae.target(input.attribute("source").unwrap_or_default());
        let own_set = input.attribute("set").unwrap_or("0");
        match input.attribute("semantic").unwrap_or_default() {
            "VERTEX" => {
                for inner in target.into_iter().flat_map(|vertices| children(vertices, "input")) {
                    let found = || dae.target(inner.attribute("source").unwrap_or_default());
                    match inner.attribute("semantic").unwrap_or_default() {
                        "POSITION" => position = found().map(|node| (at, node)),
                        "NORMAL" => normal = normal.or(found().map(|node| (at, node))),
                        "TEXCOORD" => uv = uv.or(found().map(|node| (at, node))),
                        _ => (),
                    }
                }
            }
            "POSITION" => position = target.map(|node| (at, node)),
            "NORMAL" => normal = target.map(|node| (at, node)),
            "TEXCOORD" if uv.is_none() || set == Some(own_set) => uv = target.map(|node| (at, node)),
            "COLOR" => a.warn(called(primitive), "colours of vertices were left out"),
            _ => (),
        }
    }
    let mut read = |(offset, node): (usize, Node)| Input { offset, source: source(dae, node, a) };
    let position = position.map(&mut read).filter(|input| input.source.len() > 0).ok_or("it has no positions of vertices")?;
    Ok(Inputs { position, normal: normal.map(&mut read), uv: uv.map(&mut read), stride })
}

/// A corner has fewer indices than this.
const MAX_INPUTS: usize = 256;

fn source(dae: &Dae, node: Node, a: &mut Assembly) -> Source {
    let accessor = child(node, "technique_common").and_then(|t| child(t, "accessor"));
    let stated = |name: &str| accessor.and_then(|a| a.attribute(name)).and_then(|v| v.trim().parse::<usize>().ok());
    let array = accessor.and_then(|a| dae.target(a.attribute("source").unwrap_or_default()));
    let array = array.or_else(|| child(node, "float_array"));
    let (values, odd) = array.map_or_else(|| (Vec::new(), 0), numbers);
    if odd > 0 {
        a.warn(called(node), format!("{odd} of {} values are no finite numbers and were replaced by zero", values.len()));
    }
    Source { values, offset: stated("offset").unwrap_or(0), stride: stated("stride").filter(|s| *s > 0).unwrap_or(3) }
}

/// The polygons of a primitive, each as the indices of its corners.
fn polygons(primitive: Node, stride: usize, place: &str, a: &mut Assembly) -> Result<Vec<Vec<u32>>, String> {
    let read = |p: Node| indices(p).ok_or_else(|| "the indices of its faces are no whole numbers".to_string());
    let kind = primitive.tag_name().name();
    let mut polygons = Vec::new();
    for p in children(primitive, "p") {
        let all = read(p)?;
        let corner = |i: usize| all.get(i * stride..(i + 1) * stride).unwrap_or_default();
        let count = all.len() / stride;
        match kind {
            "triangles" => polygons.extend(all.chunks_exact(3 * stride).map(<[u32]>::to_vec)),
            "polygons" => polygons.push(all),
            "trifans" => polygons.extend((1..count.max(2) - 1).map(|i| [corner(0), corner(i), corner(i + 1)].concat())),
            "tristrips" => polygons.extend((0..count.max(2) - 2).map(|i| {
                let (first, second) = if i % 2 == 0 { (i, i + 1) } else { (i + 1, i) };
                [corner(first), corner(second), corner(i + 2)].concat()
            })),
            _ => {
                let counts = child(primitive, "vcount").map(read).transpose()?.unwrap_or_default();
                let mut at = 0usize;
                for count in counts {
                    let end = (count as usize).checked_mul(stride).and_then(|n| n.checked_add(at));
                    let corners = end.and_then(|end| all.get(at..end)).ok_or("its vcount tells of more corners than there are")?;
                    polygons.push(corners.to_vec());
                    at += corners.len();
                }
            }
        }
    }
    let holed: Vec<Node> = children(primitive, "ph").collect();
    if !holed.is_empty() {
        a.warn(place, format!("the holes of {} polygons were filled", holed.len()));
    }
    for p in holed.into_iter().filter_map(|ph| child(ph, "p")) {
        polygons.push(read(p)?);
    }
    Ok(polygons)
}
