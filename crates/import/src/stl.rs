//! STL, binary and as text: one mesh, or as text one for each `solid`.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | facets | triangles; corners at the same place are one vertex, so that the surface is closed |
//! | normals | those of the corners' order, as all programs take them; the file's own only where it has none of that order |
//! | `solid <name>` | a part of that name |
//! | colours | of VisCAM and Materialise within binary facets: left out, with a warning |
//!
//! STL knows neither materials nor units nor axes: a grey surface in metres with z up, as CAD and ROS have it.

use crate::assembly::{Assembly, origin_of};
use crate::{ImportError, Imported};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::{Material, PartLabel, decoded_text};
use std::collections::HashMap;

/// Reflectance of all surfaces.
const GREY: f32 = 0.5;
/// Bytes before the facets of a binary file, and of each facet.
const HEAD: usize = 84;
const FACET: usize = 50;

/// Triangles under a name, three corners each.
#[derive(Default)]
struct Solid {
    name: String,
    corners: Vec<DVec3>,
}

/// Imports an STL file.
pub(crate) fn load(mut a: Assembly) -> Result<Imported, ImportError> {
    let bytes = a.read_scene_file()?;
    let file = a.file().to_path_buf();
    let solids = match binary_facets(&bytes) {
        Some(facets) => vec![binary(facets, &mut a)],
        None => text(&bytes).map_err(|(line, problem)| a.malformed(format!("line {line}"), problem))?,
    };
    let material = a.push_material(Material::diffuse("default", Rgb::splat(GREY)));
    let stem = file.file_stem().map_or_else(|| "mesh".to_string(), |s| s.to_string_lossy().into_owned());
    for solid in solids {
        let name = if solid.name.is_empty() { &stem } else { &solid.name };
        let finite = solid.corners.chunks_exact(3).filter(|t| t.iter().all(|p| p.as_vec3().is_finite()));
        let corners: Vec<DVec3> = finite.flatten().copied().collect();
        if corners.len() < solid.corners.len() {
            let lost = (solid.corners.len() - corners.len()) / 3;
            a.warn(name, format!("{lost} facets have corners that are no finite points and were left out"));
        }
        let origin = origin_of(corners.iter().copied(), a.meters_per_unit());
        if let Some(mesh) = a.push_mesh_from(origin, mesh(&corners, origin), &file, name)? {
            a.push_part(name, mesh, material, DAffine3::IDENTITY, PartLabel::NONE);
        }
    }
    a.finish()
}

/// A mesh in which corners at the same place share a vertex.
fn mesh(corners: &[DVec3], origin: DVec3) -> Mesh {
    let (mut mesh, mut known) = (Mesh::default(), HashMap::new());
    let mut vertex = |p: DVec3| {
        let key = p.to_array().map(|v| (v + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            mesh.positions.push((p - origin).as_vec3());
            (mesh.positions.len() - 1) as u32
        })
    };
    let triangles: Vec<[u32; 3]> = corners.chunks_exact(3).map(|t| [vertex(t[0]), vertex(t[1]), vertex(t[2])]).collect();
    mesh.triangles = triangles;
    mesh
}

/// The facets of a binary file; `None` for one of text. Text may be longer than a binary file would be, and a binary file may begin with
/// `solid`: they are distinguished by the number of facets.
fn binary_facets(bytes: &[u8]) -> Option<&[u8]> {
    let count = bytes.get(80..HEAD)?.try_into().ok().map(u32::from_le_bytes)? as usize;
    let rest = bytes.get(HEAD..)?;
    let unmarked = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let starts = unmarked.trim_ascii_start().get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"solid"));
    let is_text = starts && !bytes.contains(&0);
    match count.checked_mul(FACET) {
        Some(wanted) if wanted == rest.len() => Some(rest),
        // Some programs count wrongly, or add bytes: what is no text is facets.
        Some(wanted) if !is_text => Some(&rest[..wanted.min(rest.len())]),
        None if !is_text => Some(rest),
        _ => None,
    }
}

fn binary(facets: &[u8], a: &mut Assembly) -> Solid {
    let float = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let point = |b: &[u8]| DVec3::new(float(b), float(&b[4..]), float(&b[8..]));
    let mut solid = Solid::default();
    let mut colored = 0usize;
    for facet in facets.chunks_exact(FACET) {
        solid.corners.extend([12, 24, 36].map(|at| point(&facet[at..])));
        colored += usize::from(facet[48..] != [0, 0]);
    }
    if colored > 0 {
        a.warn("facets", format!("{colored} facets have attributes, which some programs take for colours; they were left out"));
    }
    if !facets.len().is_multiple_of(FACET) {
        a.warn("facets", "the last facet is cut short and was left out; copy or export the file again");
    }
    solid
}

/// The solids of a text.
///
/// # Errors
/// The line, and the fault there.
fn text(bytes: &[u8]) -> Result<Vec<Solid>, (usize, String)> {
    let text = decoded_text(bytes);
    let mut solids: Vec<Solid> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let Some(first) = words.next() else { continue };
        match &*first.to_ascii_lowercase() {
            "solid" => solids.push(Solid { name: words.collect::<Vec<_>>().join(" "), corners: Vec::new() }),
            "vertex" => {
                let found: Vec<f64> =
                    words.map_while(|word| word.parse().ok().or_else(|| word.replacen(',', ".", 1).parse().ok())).collect();
                let &[x, y, z] = &found[..] else {
                    return Err((i + 1, format!("found {:?}, expected three numbers; export the file again", line.trim())));
                };
                if solids.is_empty() {
                    solids.push(Solid::default());
                }
                solids.iter_mut().last().into_iter().for_each(|solid| solid.corners.push(DVec3::new(x, y, z)));
            }
            // A facet may have more corners in theory; what is incomplete is left out.
            "endfacet" => solids.iter_mut().last().into_iter().for_each(|s| s.corners.truncate(s.corners.len() / 3 * 3)),
            "facet" | "outer" | "endloop" | "endsolid" | "color" => (),
            _ if solids.is_empty() => {
                return Err((i + 1, "found neither `solid` nor the facets of a binary file; check that this is STL".into()));
            }
            _ => (),
        }
    }
    if solids.is_empty() {
        return Err((1, "found neither `solid` nor the facets of a binary file; check that this is STL".into()));
    }
    Ok(solids)
}
