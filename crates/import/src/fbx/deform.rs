//! Meshes whose shape changes over time: skins by their bones, blend shapes by their weights, and what is in nodes whose scale changes.
//!
//! ufbx bends and places all vertices of the scene at a moment, so all meshes that deform are followed at once. Their shapes have all of
//! their motion; no body takes them along.

use super::matrix::affine;
use super::mesh;
use crate::assembly::Assembly;
use crate::motion::{MOST_STATES, Shapes, cuts, length_in, place, shapes};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{PartId, Shape};
use std::sync::Arc;
use ufbx::{AllocatorOpts, Error, EvaluateOpts, Node, Scene, SceneRoot};

/// Longest time between moments at which shapes are looked at, seconds.
const STEP_S: f64 = 1.0 / 15.0;

/// An animation and the scene that it moves.
pub(super) struct Clip {
    /// The scene as it is stored.
    pub scene: SceneRoot,
    /// Number of the animation.
    pub stack: usize,
    /// Most memory that the scene may take at a moment, bytes.
    pub memory: usize,
}

/// A placed part whose shape may change.
pub(super) struct Deforming {
    /// Numbers of the node, of the part of its mesh, and of the set of texture coordinates.
    pub node: u32,
    pub mesh_part: usize,
    pub uv_set: usize,
    /// The point from which positions count.
    pub origin: DVec3,
    /// Placement at rest.
    pub file_from_mesh: DAffine3,
    /// The part of the scene.
    pub part: PartId,
    /// Place of the node in messages.
    pub place: String,
}

impl Clip {
    /// The scene at a moment, seconds after the first one of the animation.
    ///
    /// # Errors
    /// When the library cannot make it.
    pub(super) fn at(&self, time_s: f64) -> Result<SceneRoot, Box<Error>> {
        let stack = &self.scene.anim_stacks[self.stack];
        let limits = || AllocatorOpts { memory_limit: self.memory, ..AllocatorOpts::default() };
        let options =
            EvaluateOpts { temp_allocator: limits(), result_allocator: limits(), evaluate_skinning: true, ..EvaluateOpts::default() };
        Ok(ufbx::evaluate_scene(&self.scene, &stack.anim, stack.time_begin + time_s, options)?)
    }

    /// The keys of all curves, the ends, and what lies between at equal steps: seconds after the first moment.
    fn moments(&self) -> Vec<f64> {
        let stack = &self.scene.anim_stacks[self.stack];
        let (begin, length) = (stack.time_begin, (stack.time_end - stack.time_begin).max(0.0));
        let keys = self.scene.anim_curves.iter().flat_map(|curve| &curve.keyframes).map(|key| key.time - begin);
        let mut ends: Vec<f64> = keys.filter(|key_s| (0.0..=length).contains(key_s)).chain([0.0, length]).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let steps = |pair: &[f64]| cuts(pair[0], pair[1], (pair[1] - pair[0]) / STEP_S, MOST_STATES as f64);
        ends.iter().copied().chain(ends.windows(2).flat_map(steps)).collect()
    }

    /// Makes the parts that deform bodies, each with the shapes that it has over time.
    pub(super) fn follow(&self, parts: &[Deforming], a: &mut Assembly) {
        let lengths = parts.iter().map(|part| length_in(&part.file_from_mesh, a.meters_per_unit()));
        let Some(length) = lengths.reduce(f64::min).filter(|length| length.is_finite()) else { return };
        let rest: Vec<Mesh> = parts.iter().map(|part| part.mesh(&self.scene)).collect();
        let triangles: Vec<&[[u32; 3]]> = rest.iter().map(|mesh| mesh.triangles.as_slice()).collect();
        let mut turned = vec![false; parts.len()];
        let mut all = |time_s: f64| -> Result<Shape, Box<Error>> {
            let scene = self.at(time_s)?;
            let mut all = Shape::default();
            for (i, part) in parts.iter().enumerate() {
                let (mesh, is_mirrored) = part.placed(&scene);
                turned[i] |= is_mirrored || mesh.triangles != triangles[i];
                all.positions.extend(mesh.positions);
                all.normals.extend(mesh.normals);
            }
            Ok(all)
        };
        let refused = match shapes(self.moments(), false, length, |time_s, _| all(time_s)) {
            Ok(Shapes::Constant) => return,
            Ok(Shapes::Timed((times_s, together))) => {
                let mut from = [0; 2];
                for (i, (part, mesh)) in parts.iter().zip(&rest).enumerate() {
                    let to = [from[0] + mesh.positions.len(), from[1] + mesh.normals.len()];
                    let own: Vec<Arc<Shape>> = together.iter().map(|all| cut(all, from, to).into()).collect();
                    from = to;
                    if turned[i] {
                        a.warn(&part.place, "its shape changes, but it is mirrored then; it keeps that of rest");
                    } else if own.iter().any(|shape| shape != &own[0]) {
                        a.deform(part.part, None, (times_s.clone(), own));
                    }
                }
                return;
            }
            Ok(Shapes::Refused(problem)) => problem,
            Err(error) => format!("the library cannot say how: {}", &*error.description),
        };
        let more = if parts.len() > 1 { format!(", and those of {} parts with it", parts.len() - 1) } else { String::new() };
        a.warn(&parts[0].place, format!("its shape changes{more}, but {refused}; all keep those of rest"));
    }
}

/// The vertices of one of the meshes that are in a shape one after the other.
fn cut(all: &Shape, from: [usize; 2], to: [usize; 2]) -> Shape {
    let normals = all.normals.get(from[1]..to[1]).unwrap_or(&[]);
    Shape { positions: all.positions[from[0]..to[0]].to_vec(), normals: normals.to_vec() }
}

impl Deforming {
    fn node<'s>(&self, scene: &'s Scene) -> Option<&'s Node> {
        scene.nodes.get(self.node as usize).map(AsRef::as_ref)
    }

    /// The mesh of the part as a scene has it, in its own space.
    fn mesh(&self, scene: &Scene) -> Mesh {
        let found = self.node(scene).and_then(|node| node.mesh.as_ref());
        found.map_or_else(Mesh::default, |mesh| mesh::of_part(mesh, &mesh.material_parts[self.mesh_part], self.uv_set, self.origin))
    }

    /// The mesh at a moment in the space that it has at rest, and whether that mirrors it.
    fn placed(&self, scene: &Scene) -> (Mesh, bool) {
        let mut mesh = self.mesh(scene);
        let now = self.node(scene).map_or(DAffine3::IDENTITY, placement);
        let from_origin = DAffine3::from_translation(self.origin);
        let map = from_origin.inverse() * self.file_from_mesh.inverse() * now * from_origin;
        if map == DAffine3::IDENTITY {
            return (mesh, false);
        }
        let is_mirrored = place(&mut mesh, &map);
        (mesh, is_mirrored)
    }
}

/// Placement of the vertices of a node's mesh in the file: skins may have them there already.
pub(super) fn placement(node: &Node) -> DAffine3 {
    let is_local = node.mesh.as_ref().is_none_or(|mesh| mesh.skinned_is_local);
    if is_local { affine(&node.geometry_to_world) } else { DAffine3::IDENTITY }
}

/// True if bones or blend shapes bend the mesh of a node.
pub(super) fn is_bent(node: &Node) -> bool {
    node.mesh.as_ref().is_some_and(|mesh| !mesh.skin_deformers.is_empty() || !mesh.blend_deformers.is_empty())
}
