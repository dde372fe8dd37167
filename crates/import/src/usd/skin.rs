//! Skins and blend shapes of meshes: how the joints of a skeleton and weights move their points.

use super::layer::field;
use super::operation::Kind;
use super::skeleton::Skeleton;
use super::stage::{Prim, Stage};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DMat3, DVec3};
use std::rc::Rc;

/// How a skeleton moves the points of a mesh.
pub(super) struct Skin {
    skeleton: Rc<Skeleton>,
    /// Joints of the skeleton and their weights, as many for each point; for all points together where there is one list.
    held: Vec<(usize, f64)>,
    per_point: usize,
    /// From the mesh's space as it was bound to the skeleton's, and from that to the mesh's space now.
    skeleton_from_bound: DAffine3,
    mesh_from_skeleton: DAffine3,
    blend_shapes: Vec<BlendShape>,
}

/// Offsets of points and of their normals.
struct BlendShape {
    /// The name in animations.
    name: Rc<str>,
    /// Points that it moves.
    points: Vec<usize>,
    offsets: Vec<DVec3>,
    /// As many as offsets, or none.
    normal_offsets: Vec<DVec3>,
}

/// Points of a mesh at a time, and what maps them and their normals into the mesh's space.
pub(super) struct Moved {
    points: Vec<DVec3>,
    /// For each point what blend shapes add to its normals; empty for nothing.
    normal_offsets: Vec<DVec3>,
    /// For points and for normals; one for each point, or one for all.
    maps: Vec<(DAffine3, DMat3)>,
}

impl Moved {
    /// Points that nothing moves.
    pub(super) fn still(points: Vec<DVec3>) -> Self {
        Self { points, normal_offsets: Vec::new(), maps: vec![(DAffine3::IDENTITY, DMat3::IDENTITY)] }
    }

    /// Where a point is.
    pub(super) fn point(&self, point: u32) -> DVec3 {
        self.map(point).0.transform_point3(self.points[point as usize])
    }

    /// The direction of a normal that is stated for a point.
    pub(super) fn normal(&self, point: u32, stated: DVec3) -> DVec3 {
        let offset = self.normal_offsets.get(point as usize).copied().unwrap_or_default();
        (self.map(point).1 * (stated + offset)).try_normalize().unwrap_or(stated)
    }

    fn map(&self, point: u32) -> &(DAffine3, DMat3) {
        self.maps.get(point as usize).unwrap_or(&self.maps[0])
    }
}

impl Skin {
    /// The skin of a mesh prim of so many points; `mesh_from_skeleton` is the placement of the skeleton in the mesh's space. What makes no sense is
    /// left out with a warning.
    ///
    /// # Errors
    /// When a layer cannot be read.
    pub(super) fn read(
        prim: &Prim,
        points: usize,
        (skeleton, mesh_from_skeleton): (Rc<Skeleton>, DAffine3),
        stage: &mut Stage,
        a: &mut Assembly,
    ) -> Result<Option<Self>, ImportError> {
        let blend_shapes = blend_shapes(prim, points, stage, a)?;
        let held = match held(prim, points, &skeleton) {
            Ok(held) => held,
            Err(problem) => {
                a.warn(&prim.path, format!("{problem}; the mesh does not follow its skeleton"));
                None
            }
        };
        if held.is_none() && blend_shapes.is_empty() {
            return Ok(None);
        }
        if prim.text("primvars:skel:skinningMethod") == Some("dualQuaternion") {
            a.warn(&prim.path, "it is to be bent by dual quaternions, and is bent by blended matrices instead");
        }
        let bound = prim.value("primvars:skel:geomBindTransform").and_then(|v| v.as_tuple::<16>());
        let is_held = held.is_some();
        let (held, per_point) = held.unwrap_or_default();
        let identity = DAffine3::IDENTITY;
        Ok(Some(Self {
            skeleton,
            held,
            per_point,
            skeleton_from_bound: if is_held { bound.map_or(identity, |m| Kind::Matrix.matrix(&m)) } else { identity },
            mesh_from_skeleton: if is_held { mesh_from_skeleton } else { identity },
            blend_shapes,
        }))
    }

    /// The time codes at which the joints and weights that it follows change their pace.
    pub(super) fn codes(&self) -> Vec<f64> {
        self.skeleton.animation.as_ref().map_or_else(Vec::new, |animation| animation.codes())
    }

    /// Where points are at a time code.
    pub(super) fn at(&self, mut points: Vec<DVec3>, code: Option<f64>) -> Moved {
        let mut normal_offsets = Vec::new();
        for shape in &self.blend_shapes {
            let weight = self.skeleton.animation.as_ref().map_or(0.0, |animation| animation.weight(&shape.name, code));
            if weight == 0.0 {
                continue;
            }
            shape.points.iter().zip(&shape.offsets).for_each(|(&point, offset)| points[point] += weight * *offset);
            if !shape.normal_offsets.is_empty() {
                normal_offsets.resize(points.len(), DVec3::ZERO);
                shape.points.iter().zip(&shape.normal_offsets).for_each(|(&point, offset)| normal_offsets[point] += weight * *offset);
            }
        }
        // As in `UsdSkel`, normals are moved by each joint's own inverse transpose.
        let around = [self.mesh_from_skeleton, self.skeleton_from_bound].map(|map| (map, turned(&map)));
        let map = |(points, normals): (DAffine3, DMat3)| (around[0].0 * points * around[1].0, around[0].1 * normals * around[1].1);
        let maps = if self.per_point == 0 {
            vec![map((DAffine3::IDENTITY, DMat3::IDENTITY))]
        } else {
            let moves: Vec<(DAffine3, DMat3)> = self.skeleton.moves(code).into_iter().map(|m| (m, turned(&m))).collect();
            let blended = |held: &[(usize, f64)]| {
                let mut sum = (DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO }, DMat3::ZERO);
                for &(joint, weight) in held {
                    sum.0.matrix3 += moves[joint].0.matrix3 * weight;
                    sum.0.translation += moves[joint].0.translation * weight;
                    sum.1 += moves[joint].1 * weight;
                }
                map(sum)
            };
            self.held.chunks(self.per_point).map(blended).collect()
        };
        Moved { points, normal_offsets, maps }
    }
}

/// What turns normals where a map turns points.
fn turned(map: &DAffine3) -> DMat3 {
    let inverse = map.matrix3.inverse();
    if inverse.is_finite() { inverse.transpose() } else { map.matrix3 }
}

/// Joints with weights, and how many of them a point has.
type Held = (Vec<(usize, f64)>, usize);

/// The joints that hold each point; `None` where no joint does.
fn held(prim: &Prim, points: usize, skeleton: &Skeleton) -> Result<Option<Held>, String> {
    let numbers = |attribute: &str| prim.value(attribute).and_then(|v| v.as_numbers(1)).unwrap_or(&[]);
    let (indices, weights) = (numbers("primvars:skel:jointIndices"), numbers("primvars:skel:jointWeights"));
    if indices.is_empty() {
        return Ok(None);
    }
    if indices.len() != weights.len() {
        return Err(format!("it has {} jointIndices, but {} jointWeights", indices.len(), weights.len()));
    }
    let attribute = "primvars:skel:jointIndices";
    let is_rigid = prim.property(attribute, "interpolation").and_then(|v| v.as_text()) == Some("constant");
    let lists = if is_rigid { 1 } else { points };
    if lists == 0 || indices.len() % lists != 0 {
        return Err(format!("it has {} jointIndices for {points} points", indices.len()));
    }
    // The mesh may have its own order of joints.
    let own = prim.value("skel:joints").map(|v| v.as_texts().to_vec()).unwrap_or_default();
    let joint = |index: f64| match own.get(index as usize) {
        Some(name) => skeleton.joints.iter().position(|known| known == name),
        None if own.is_empty() => Some(index as usize).filter(|joint| *joint < skeleton.joints.len()),
        None => None,
    };
    let mut held = Vec::with_capacity(indices.len());
    for (&index, &weight) in indices.iter().zip(weights) {
        match joint(index).filter(|_| index >= 0.0 && weight.is_finite()) {
            Some(joint) => held.push((joint, weight)),
            None if weight == 0.0 => held.push((0, 0.0)),
            None => return Err(format!("found joint {index} with weight {weight}, but the skeleton has {} joints", skeleton.joints.len())),
        }
    }
    Ok(Some((held, indices.len() / lists)))
}

/// The blend shapes of a mesh prim.
fn blend_shapes(prim: &Prim, points: usize, stage: &mut Stage, a: &mut Assembly) -> Result<Vec<BlendShape>, ImportError> {
    let names = prim.value("skel:blendShapes").map(|v| v.as_texts().to_vec()).unwrap_or_default();
    let targets = prim.targets("skel:blendShapeTargets", field::TARGETS);
    let mut found = Vec::new();
    for (name, path) in names.into_iter().zip(targets) {
        let Some(target) = stage.at(&path, a)? else { continue };
        let vectors = |attribute: &str| {
            let numbers = target.value(attribute).and_then(|v| v.as_numbers(3)).unwrap_or(&[]);
            numbers.as_chunks::<3>().0.iter().map(|v| DVec3::from_array(*v)).collect::<Vec<_>>()
        };
        let (offsets, normal_offsets) = (vectors("offsets"), vectors("normalOffsets"));
        let indices = target.value("pointIndices").and_then(|v| v.as_numbers(1)).unwrap_or(&[]);
        let moved: Vec<usize> =
            if indices.is_empty() { (0..offsets.len()).collect() } else { indices.iter().map(|i| *i as usize).collect() };
        let is_whole = moved.len() == offsets.len() && moved.iter().all(|point| *point < points);
        let are_finite = offsets.iter().chain(&normal_offsets).all(|v| v.is_finite());
        if !is_whole || !are_finite {
            a.warn(&target.path, format!("its offsets do not fit the {points} points of <{}>; it was left out", prim.path));
            continue;
        }
        if target.properties().iter().any(|property| property.starts_with("inbetweens:")) {
            a.warn(&target.path, "its in-between shapes were left out; it changes evenly with its weight");
        }
        let normal_offsets = if normal_offsets.len() == offsets.len() { normal_offsets } else { Vec::new() };
        found.push(BlendShape { name, points: moved, offsets, normal_offsets });
    }
    Ok(found)
}
