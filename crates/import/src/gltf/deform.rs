//! Meshes whose shape changes over time: skins by their joints, morphs by their weights, and what is in nodes whose scale changes.

use super::animation::Animations;
use super::container::Document;
use super::primitive::{self, Pose};
use super::skin::{Bindings, joints, parents, placements};
use crate::ImportError;
use crate::assembly::{Assembly, TimedShapes};
use crate::motion::{Shapes, Side, length_in, place, shapes};
use enfilade_geometry::Mesh;
use enfilade_math::DAffine3;
use enfilade_scene::Shape;
use gltf::json::mesh::Primitive;

/// The nodes of a file and what moves them.
pub(super) struct Deforms<'d> {
    document: &'d Document,
    animations: &'d Animations,
    parents: Vec<Option<usize>>,
}

/// A primitive of the mesh of a node.
pub(super) struct Bound<'b> {
    pub node: usize,
    pub skin: Option<usize>,
    pub primitive: &'b Primitive,
    pub uv_set: u32,
    /// Weights of the morph targets at rest.
    pub weights: &'b [f32],
    /// Place of the node in messages.
    pub place: &'b str,
}

/// How a primitive changes its shape.
pub(super) struct Deformed {
    pub shapes: TimedShapes,
    /// True if the body of its node takes it along; false if the shapes have all of its motion.
    pub is_borne: bool,
}

impl<'d> Deforms<'d> {
    pub(super) fn new(document: &'d Document, animations: &'d Animations) -> Self {
        Self { document, animations, parents: parents(document) }
    }

    /// The shapes of a primitive, which is placed at `places` and has these triangles at rest; `None` where its shape does not change, and,
    /// with a warning, where it cannot be followed.
    ///
    /// # Errors
    /// When a shape cannot be read.
    pub(super) fn of(
        &self,
        bound: &Bound,
        triangles: &[[u32; 3]],
        places: &[DAffine3],
        a: &mut Assembly,
    ) -> Result<Option<Deformed>, ImportError> {
        let own = self.chain(bound.node);
        let is_scaled = bound.skin.is_none() && own.iter().any(|&node| self.animations.scales(node));
        let (morphs, moving) = (self.animations.morphs(bound.node), self.moving(bound, is_scaled.then_some(&own)));
        let mut moments: Vec<f64> = moving.iter().flat_map(|&node| self.animations.moments(node)).collect();
        if morphs {
            moments.extend(self.animations.moments(bound.node));
        }
        let (Some(file_from_mesh), false) = (places.first(), moments.is_empty()) else { return Ok(None) };
        let warn =
            |problem: &str, a: &mut Assembly| a.warn(bound.place, format!("its shape changes, but {problem}; it keeps that of rest"));
        let mesh_from_file = file_from_mesh.inverse();
        if is_scaled && (places.len() > 1 || !mesh_from_file.is_finite()) {
            warn("it is in several places, or flat at rest, within a node whose scale changes", a);
            return Ok(None);
        }
        let length = length_in(if bound.skin.is_some() { &DAffine3::IDENTITY } else { file_from_mesh }, a.meters_per_unit());
        let Some(stored) = primitive::unmoved(self.document, bound.primitive, bound.uv_set, bound.place, a)? else { return Ok(None) };
        let bindings = bound.skin.map(|_| primitive::bindings(self.document, bound.primitive, &stored, bound.place, a)).transpose()?;
        let (mut turned, jumps) = (false, self.animations.jump());
        let shape = |time_s: f64, side: Side| -> Result<Shape, ImportError> {
            let mut mesh = self.mesh(bound, (&stored, bindings.as_ref()), (time_s, side), a)?;
            if is_scaled {
                let now = own
                    .iter()
                    .rev()
                    .fold(DAffine3::IDENTITY, |all, &node| all * self.animations.local(self.document, node, (time_s, side)));
                turned |= place(&mut mesh, &(mesh_from_file * now));
            }
            turned |= mesh.triangles != triangles;
            Ok(Shape { positions: mesh.positions, normals: mesh.normals })
        };
        let found = shapes(moments, jumps, length, shape)?;
        match found {
            Shapes::Constant => Ok(None),
            _ if turned => {
                warn("its triangles are others then: it is mirrored, or was repaired or painted", a);
                Ok(None)
            }
            Shapes::Refused(problem) => {
                warn(&problem, a);
                Ok(None)
            }
            Shapes::Timed(shapes) => Ok(Some(Deformed { shapes, is_borne: bound.skin.is_none() && !is_scaled })),
        }
    }

    /// The nodes whose transforms change the shape of a primitive: joints and what they are in, or `chain`.
    fn moving(&self, bound: &Bound, chain: Option<&Vec<usize>>) -> Vec<usize> {
        let skin = bound.skin.and_then(|skin| self.document.root.skins.get(skin));
        let joints = skin.into_iter().flat_map(|skin| &skin.joints).flat_map(|joint| self.chain(joint.value()));
        let mut nodes: Vec<usize> = joints.chain(chain.into_iter().flatten().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// A node and what it is in, from the inside out.
    fn chain(&self, node: usize) -> Vec<usize> {
        let up = std::iter::successors(Some(node), |&node| self.parents.get(node).copied().flatten());
        up.take(self.parents.len()).collect()
    }

    /// The mesh of a primitive at a moment, from its stored one: of a skin in the file's space, else in its own.
    fn mesh(
        &self,
        bound: &Bound,
        (stored, bindings): (&Mesh, Option<&Bindings>),
        at: (f64, Side),
        a: &mut Assembly,
    ) -> Result<Mesh, ImportError> {
        let weights = self.animations.weights(bound.node, at).unwrap_or_else(|| bound.weights.to_vec());
        let placed = || placements(self.document, |node| self.animations.local(self.document, node, at));
        let joints = bound.skin.map(|skin| joints(self.document, skin, bound.node, &placed(), a)).transpose()?;
        let pose = Pose { weights: &weights, joints: joints.as_deref() };
        primitive::posed(self.document, (bound.primitive, bindings), stored.clone(), &pose, bound.place, a)
    }
}
