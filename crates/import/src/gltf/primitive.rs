//! Primitives to triangle meshes in a pose: triangles, strips and fans, with or without indices.

use super::container::Document;
use super::morph;
use super::skin::Bindings;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

/// The skin and morph targets that move the vertices of a primitive.
pub(super) struct Pose<'p> {
    /// Weights of morph targets.
    pub weights: &'p [f32],
    /// Joints of the skin, if the mesh has one.
    pub joints: Option<&'p [DAffine3]>,
}

/// The mesh of a primitive with texture coordinate set `uv_set`; `None` for what has no surface.
///
/// # Errors
/// When something of it cannot be read.
pub(super) fn mesh(
    document: &Document,
    primitive: &Primitive,
    uv_set: u32,
    pose: &Pose,
    place: &str,
    assembly: &mut Assembly,
) -> Result<Option<Mesh>, ImportError> {
    let Some(mesh) = unmoved(document, primitive, uv_set, place, assembly)? else { return Ok(None) };
    let bindings = pose.joints.map(|_| bindings(document, primitive, &mesh, place, assembly)).transpose()?;
    posed(document, (primitive, bindings.as_ref()), mesh, pose, place, assembly).map(Some)
}

/// Joints and weights of the vertices of a primitive's mesh.
///
/// # Errors
/// When they cannot be read.
pub(super) fn bindings(
    document: &Document,
    primitive: &Primitive,
    mesh: &Mesh,
    place: &str,
    assembly: &Assembly,
) -> Result<Bindings, ImportError> {
    Bindings::read(document, primitive, mesh.positions.len()).map_err(|(what, e)| assembly.malformed(format!("{place}.{what}"), e))
}

/// The mesh of a primitive that nothing moves yet, in a pose.
///
/// # Errors
/// When targets or joints make no sense.
pub(super) fn posed(
    document: &Document,
    (primitive, bindings): (&Primitive, Option<&Bindings>),
    mut mesh: Mesh,
    pose: &Pose,
    place: &str,
    assembly: &mut Assembly,
) -> Result<Mesh, ImportError> {
    let bad = |(what, e): (String, String), a: &Assembly| a.malformed(format!("{place}.{what}"), e);
    morph::apply(document, primitive, pose.weights, &mut mesh.positions, &mut mesh.normals).map_err(|e| bad(e, assembly))?;
    if let Some((bindings, joints)) = bindings.zip(pose.joints) {
        let unweighted = bindings.apply(joints, &mut mesh).map_err(|e| bad(e, assembly))?;
        if unweighted > 0 {
            assembly.warn(place, format!("{unweighted} vertices have no weights; they follow the first joint they name"));
        }
    }
    Ok(mesh)
}

/// The mesh of a primitive as it is stored; `None` for what has no surface.
///
/// # Errors
/// When something of it cannot be read.
pub(super) fn unmoved(
    document: &Document,
    primitive: &Primitive,
    uv_set: u32,
    place: &str,
    assembly: &mut Assembly,
) -> Result<Option<Mesh>, ImportError> {
    let Checked::Valid(mode) = primitive.mode else { return Err(assembly.malformed(place, "unknown primitive mode; expected 0 to 6")) };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        assembly.warn(place, "points and lines have no surface and were left out");
        return Ok(None);
    }
    let attribute = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
    let bad = |what: &str, problem: String| assembly.malformed(format!("{place}.{what}"), problem);
    let Some(positions) = attribute(Semantic::Positions) else { return Err(bad("attributes", "there is no POSITION".into())) };
    let positions = document.vectors::<3>(positions).map_err(|e| bad("attributes.POSITION", e))?;
    let normals = attribute(Semantic::Normals).map(|i| document.vectors::<3>(i)).transpose().map_err(|e| bad("attributes.NORMAL", e))?;
    let uvs = attribute(Semantic::TexCoords(uv_set)).map(|i| document.vectors::<2>(i)).transpose();
    let uvs = uvs.map_err(|e| bad(&format!("attributes.TEXCOORD_{uv_set}"), e))?;
    let indices = match primitive.indices {
        Some(accessor) => document.indices(accessor).map_err(|e| bad("indices", e))?,
        None => (0..positions.len() as u32).collect(),
    };
    Ok(Some(Mesh {
        positions: positions.into_iter().map(Vec3::from).collect(),
        normals: normals.unwrap_or_default().into_iter().map(Vec3::from).collect(),
        uvs: uvs.unwrap_or_default().into_iter().map(|[u, v]| Vec2::new(u, 1.0 - v)).collect(),
        triangles: triangles(mode, &indices),
    }))
}

/// Triangles of a list, strip or fan; those of strips and fans with a repeated vertex only steer the strip and are left out.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    let real = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    match mode {
        Mode::TriangleStrip => {
            let turned = |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            indices.windows(3).enumerate().map(turned).filter(real).collect()
        }
        Mode::TriangleFan => match indices {
            [hub, rim @ ..] => rim.windows(2).map(|w| [*hub, w[0], w[1]]).filter(real).collect(),
            [] => Vec::new(),
        },
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_alternate_and_fans_share_their_hub() {
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 3]), vec![[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 1, 2]), Vec::<[u32; 3]>::new());
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1, 2, 3]), vec![[0, 1, 2], [0, 2, 3]]);
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3, 4]), vec![[0, 1, 2]]);
        assert!(triangles(Mode::TriangleFan, &[]).is_empty());
    }
}
