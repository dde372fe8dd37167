//! Morph targets by the weights that the file states for its nodes and meshes.

use super::container::Document;
use enfilade_math::Vec3;
use gltf::json::mesh::{Mesh, Primitive};
use gltf::json::scene::Node;

/// The weights of a mesh at a node: the node's own, else the mesh's; without the zeros at their end.
pub(super) fn weights<'j>(node: &'j Node, mesh: &'j Mesh) -> &'j [f32] {
    let weights = node.weights.as_deref().or(mesh.weights.as_deref()).unwrap_or_default();
    let used = weights.iter().rposition(|&weight| weight != 0.0).map_or(0, |last| last + 1);
    &weights[..used]
}

/// Moves vertices and normals by their weighted targets. Targets of weight zero are not read.
///
/// # Errors
/// The place within the primitive and the problem, when a target is missing, cannot be read or is of another length.
pub(super) fn apply(
    document: &Document,
    primitive: &Primitive,
    weights: &[f32],
    positions: &mut [Vec3],
    normals: &mut [Vec3],
) -> Result<(), (String, String)> {
    let targets = primitive.targets.as_deref().unwrap_or_default();
    for (i, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        let Some(target) = targets.get(i) else {
            let problem = format!("found {} targets, but target {i} has the weight {weight}; export the file again", targets.len());
            return Err(("targets".into(), problem));
        };
        shift(document, target.positions, weight, positions).map_err(|problem| (format!("targets[{i}].POSITION"), problem))?;
        // Without normals the surface is flat, whatever normals the target has.
        if !normals.is_empty() {
            shift(document, target.normals, weight, normals).map_err(|problem| (format!("targets[{i}].NORMAL"), problem))?;
        }
    }
    Ok(())
}

fn shift(
    document: &Document,
    accessor: Option<gltf::json::Index<gltf::json::Accessor>>,
    weight: f32,
    vectors: &mut [Vec3],
) -> Result<(), String> {
    let Some(accessor) = accessor else { return Ok(()) };
    let shifts = document.vectors::<3>(accessor)?;
    if shifts.len() != vectors.len() {
        return Err(format!("found {} displacements, expected {}, one a vertex; export the file again", shifts.len(), vectors.len()));
    }
    vectors.iter_mut().zip(shifts).for_each(|(vector, shift)| *vector += weight * Vec3::from(shift));
    Ok(())
}
