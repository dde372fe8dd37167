//! Skins in a pose of their nodes: joints move each vertex, by their weights.
//!
//! As the specification has it, the transform of the node with the mesh is ignored.

use super::container::Document;
use super::transform::affine;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::HashMap;
use std::rc::Rc;

/// The skins met so far.
pub(super) struct Skins<'d> {
    document: &'d Document,
    /// The placement of every node, computed at first use; `None` for nodes in a cycle.
    file_from_node: Option<Vec<Option<DAffine3>>>,
    known: HashMap<usize, Rc<[DAffine3]>>,
}

impl<'d> Skins<'d> {
    pub(super) fn new(document: &'d Document) -> Self {
        Self { document, file_from_node: None, known: HashMap::new() }
    }

    /// The transform of the mesh by each joint of a skin: the joint's placement times its inverse bind matrix.
    ///
    /// # Errors
    /// When the skin of the node, one of its joints or its matrices are not there.
    pub(super) fn joints(&mut self, skin: usize, node: usize, a: &Assembly) -> Result<Rc<[DAffine3]>, ImportError> {
        if let Some(known) = self.known.get(&skin) {
            return Ok(Rc::clone(known));
        }
        let document = self.document;
        let rest = self.file_from_node.get_or_insert_with(|| placements(document, |node| document.local_transform(node)));
        let joints: Rc<[DAffine3]> = joints(document, skin, node, rest, a)?.into();
        self.known.insert(skin, Rc::clone(&joints));
        Ok(joints)
    }
}

/// The transform of the mesh at a node by each joint of its skin, with the nodes at these placements.
///
/// # Errors
/// As [`Skins::joints`].
pub(super) fn joints(
    document: &Document,
    skin: usize,
    node: usize,
    file_from_node: &[Option<DAffine3>],
    a: &Assembly,
) -> Result<Vec<DAffine3>, ImportError> {
    let skins = &document.root.skins;
    let Some(json) = skins.get(skin) else {
        let problem = format!("it refers to skin {skin}, but there are only {}", skins.len());
        return Err(a.malformed(format!("nodes[{node}]"), problem));
    };
    let bad = |what: &str, problem: String| a.malformed(format!("skins[{skin}].{what}"), problem);
    let inverse_binds = json.inverse_bind_matrices.map(|accessor| document.vectors::<16>(accessor)).transpose();
    let inverse_binds = inverse_binds.map_err(|problem| bad("inverseBindMatrices", problem))?;
    if let Some(found) = inverse_binds.as_ref().map(Vec::len).filter(|&found| found < json.joints.len()) {
        let problem = format!("found {found} matrices, expected {}, one a joint; export the file again", json.joints.len());
        return Err(bad("inverseBindMatrices", problem));
    }
    let mut joints = Vec::with_capacity(json.joints.len());
    for (i, joint) in json.joints.iter().map(|joint| joint.value()).enumerate() {
        let Some(placement) = file_from_node.get(joint) else {
            return Err(bad("joints", format!("it refers to node {joint}, but there are only {}", file_from_node.len())));
        };
        let Some(placement) = placement else {
            return Err(bad("joints", format!("node {joint} is its own ancestor, so it has no place; export the file again")));
        };
        joints.push(*placement * inverse_binds.as_ref().map_or(DAffine3::IDENTITY, |matrices| affine(&matrices[i])));
    }
    Ok(joints)
}

/// The parents of all nodes; of several the first.
pub(super) fn parents(document: &Document) -> Vec<Option<usize>> {
    let nodes = &document.root.nodes;
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            if let Some(known) = parents.get_mut(child.value()) {
                known.get_or_insert(parent);
            }
        }
    }
    parents
}

/// The placements of all nodes, by their own transforms; `None` for nodes in a cycle.
pub(super) fn placements(document: &Document, local: impl Fn(usize) -> DAffine3) -> Vec<Option<DAffine3>> {
    let (nodes, parents) = (&document.root.nodes, parents(document));
    let mut found = vec![None; nodes.len()];
    let mut stack: Vec<(usize, DAffine3)> = (0..nodes.len()).filter(|&i| parents[i].is_none()).map(|i| (i, local(i))).collect();
    while let Some((index, file_from_node)) = stack.pop() {
        if found[index].replace(file_from_node).is_some() {
            continue;
        }
        let children = nodes[index].children.iter().flatten().map(|child| child.value());
        for child in children.filter(|&child| parents.get(child) == Some(&Some(index))) {
            stack.push((child, file_from_node * local(child)));
        }
    }
    found
}

/// True when the vertices of a primitive have joints or weights.
pub(super) fn is_bound(primitive: &Primitive) -> bool {
    [Semantic::Joints(0), Semantic::Weights(0)].into_iter().any(|s| primitive.attributes.contains_key(&Checked::Valid(s)))
}

/// Four joints, or four weights, of each vertex.
type Fours = Vec<[f32; 4]>;

/// Joints and weights of the vertices of a primitive, set by set.
pub(super) struct Bindings(Vec<(Fours, Fours)>);

impl Bindings {
    /// The weights of a primitive of so many vertices.
    ///
    /// # Errors
    /// The place within the primitive and the problem, when they cannot be read.
    pub(super) fn read(document: &Document, primitive: &Primitive, vertices: usize) -> Result<Self, (String, String)> {
        sets(document, primitive, vertices).map(Self)
    }

    /// Places the vertices in the file's space, normals by the inverse transpose; triangles that joints mirror are turned round. Weights count
    /// by their share of their sum. Returns how many vertices have none: these follow the first joint they name.
    ///
    /// # Errors
    /// The place within the primitive and the problem, when joints or weights make no sense.
    pub(super) fn apply(&self, joints: &[DAffine3], mesh: &mut Mesh) -> Result<usize, (String, String)> {
        let Self(sets) = self;
        let mut unweighted = 0;
        let mut mirrored = Vec::with_capacity(mesh.positions.len());
        for vertex in 0..mesh.positions.len() {
            let joint = |set: usize, k: usize| {
                let named = sets[set].0[vertex][k];
                // A cast takes what is no number, or below zero, to zero.
                joints.get(named as usize).filter(|_| named as usize as f32 == named).ok_or_else(|| {
                    let problem = format!(
                        "found joint {named} at vertex {vertex}, expected one of the {} of the skin; export the file again",
                        joints.len()
                    );
                    (format!("attributes.JOINTS_{set}"), problem)
                })
            };
            let (mut turn, mut shift, mut sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
            for (set, (_, weights)) in sets.iter().enumerate() {
                for (k, &weight) in weights[vertex].iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                    if !(weight > 0.0 && weight.is_finite()) {
                        let problem = format!("found {weight} at vertex {vertex}, expected 0 to 1; export the file again");
                        return Err((format!("attributes.WEIGHTS_{set}"), problem));
                    }
                    let (joint, weight) = (joint(set, k)?, f64::from(weight));
                    turn += joint.matrix3 * weight;
                    shift += joint.translation * weight;
                    sum += weight;
                }
            }
            if sum == 0.0 {
                unweighted += 1;
                let joint = joint(0, 0)?;
                (turn, shift, sum) = (joint.matrix3, joint.translation, 1.0);
            }
            let place = &mut mesh.positions[vertex];
            *place = ((turn * place.as_dvec3() + shift) / sum).as_vec3();
            let is_mirrored = turn.determinant() < 0.0;
            if let Some(normal) = mesh.normals.get_mut(vertex) {
                let cofactors =
                    DMat3::from_cols(turn.y_axis.cross(turn.z_axis), turn.z_axis.cross(turn.x_axis), turn.x_axis.cross(turn.y_axis));
                let turned = (cofactors * normal.as_dvec3()).normalize_or_zero().as_vec3();
                *normal = if is_mirrored { -turned } else { turned };
            }
            mirrored.push(is_mirrored);
        }
        let is_mirrored = |triangle: &&mut [u32; 3]| mirrored.get(triangle[0] as usize) == Some(&true);
        mesh.triangles.iter_mut().filter(is_mirrored).for_each(|triangle| triangle.swap(1, 2));
        Ok(unweighted)
    }
}

/// Joints and weights, set by set; at least one of as many vertices as are `expected`.
fn sets(document: &Document, primitive: &Primitive, expected: usize) -> Result<Vec<(Fours, Fours)>, (String, String)> {
    let read = |semantic: Semantic| {
        let name = semantic.to_string();
        let Some(&accessor) = primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
        let fours = document.vectors::<4>(accessor).and_then(|fours| {
            let problem = || format!("found {} of them, expected {expected}, one a vertex; export the file again", fours.len());
            if fours.len() == expected { Ok(fours) } else { Err(problem()) }
        });
        fours.map(Some).map_err(|problem| (format!("attributes.{name}"), problem))
    };
    let mut sets = Vec::new();
    for set in 0.. {
        match (read(Semantic::Joints(set))?, read(Semantic::Weights(set))?) {
            (Some(joints), Some(weights)) => sets.push((joints, weights)),
            (None, None) if set > 0 => break,
            _ => {
                let problem = format!("expected both JOINTS_{set} and WEIGHTS_{set}; export the file again");
                return Err(("attributes".into(), problem));
            }
        }
    }
    Ok(sets)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_are_read_column_by_column() {
        let mut m = [0.0; 16];
        (m[1], m[4], m[10], m[12], m[15]) = (1.0, -1.0, 2.0, 5.0, 1.0);
        assert_eq!(affine(&m).transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(3.0, 1.0, 6.0));
    }
}
