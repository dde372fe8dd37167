//! Skeletons (`UsdSkel`): joints in a tree, where they hold a mesh, and where an animation has them at a time.

use super::arrays::Arrays;
use super::layer::field;
use super::operation::{Kind, quaternion};
use super::stage::{Prim, Stage};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DMat3, DVec3};
use std::rc::Rc;

/// A skeleton and what moves it.
pub(super) struct Skeleton {
    /// Names of the joints: paths from the root, each after its parent.
    pub joints: Vec<Rc<str>>,
    parents: Vec<Option<usize>>,
    /// From the skeleton's space to that of each joint as it holds the mesh.
    inverse_binds: Vec<DAffine3>,
    /// Each joint in its parent, where no animation says otherwise.
    rest: Vec<DAffine3>,
    pub animation: Option<Animation>,
}

/// An animation of joints, and of weights of blend shapes.
pub(super) struct Animation {
    /// For each joint of the skeleton its number in the animation.
    joints: Vec<Option<usize>>,
    /// Placement of joints in their parents, where there are as many as joints.
    local: Option<[Arrays; 3]>,
    /// Names and weights of blend shapes.
    blend_shapes: Option<(Vec<Rc<str>>, Arrays)>,
}

impl Skeleton {
    /// The skeleton of a prim.
    ///
    /// # Errors
    /// When a layer cannot be read.
    pub(super) fn read(prim: &Prim, stage: &mut Stage, a: &mut Assembly) -> Result<Option<Self>, ImportError> {
        let joints = prim.value("joints").map(|v| v.as_texts().to_vec()).unwrap_or_default();
        let matrices = |attribute: &str| {
            let numbers = prim.value(attribute).and_then(|v| v.as_numbers(16)).unwrap_or(&[]);
            let all: Vec<DAffine3> = numbers.as_chunks::<16>().0.iter().map(|m| Kind::Matrix.matrix(m)).collect();
            (all.len() == joints.len()).then_some(all)
        };
        let binds = matrices("bindTransforms").filter(|all| all.iter().all(|m| m.is_finite() && m.matrix3.determinant() != 0.0));
        let Some(binds) = binds.filter(|binds| !binds.is_empty()) else {
            a.warn(
                &prim.path,
                "the skeleton has no joints, or not a bindTransform that can be inverted for each; its meshes stay as they are",
            );
            return Ok(None);
        };
        let parents: Vec<Option<usize>> = (0..joints.len()).map(|joint| parent(&joints, joint)).collect();
        let in_parent = |(bind, parent): (&DAffine3, &Option<usize>)| parent.map_or(*bind, |parent| binds[parent].inverse() * *bind);
        let rest = matrices("restTransforms").unwrap_or_else(|| binds.iter().zip(&parents).map(in_parent).collect());
        let animation = match source(prim, stage, a)? {
            Some(path) => stage.at(&path, a)?.map(|source| Animation::read(&source, &joints, a)),
            None => None,
        };
        Ok(Some(Self { parents, inverse_binds: binds.iter().map(DAffine3::inverse).collect(), rest, animation, joints }))
    }

    /// From where each joint holds the mesh to where it has it at a time code, in the skeleton's space.
    pub(super) fn moves(&self, code: Option<f64>) -> Vec<DAffine3> {
        let local = self.animation.as_ref().map(|animation| animation.local(&self.rest, code));
        let local = local.as_deref().unwrap_or(&self.rest);
        let mut placed: Vec<DAffine3> = Vec::with_capacity(local.len());
        for (joint, parent) in self.parents.iter().enumerate() {
            placed.push(parent.map_or(DAffine3::IDENTITY, |parent| placed[parent]) * local[joint]);
        }
        placed.iter().zip(&self.inverse_binds).map(|(place, inverse)| *place * *inverse).collect()
    }
}

impl Animation {
    fn read(prim: &Prim, of_skeleton: &[Rc<str>], a: &mut Assembly) -> Self {
        let joints = prim.value("joints").map(|v| v.as_texts().to_vec()).unwrap_or_default();
        let mut read = |attribute: &str, width: usize| {
            let (arrays, is_cut) = Arrays::read(prim, attribute, width)?;
            if is_cut {
                a.warn(format!("<{}>.{attribute}", prim.path), "its samples have different lengths, or are too many; the first was taken");
            }
            Some(arrays)
        };
        let (translations, rotations, scales) = (read("translations", 3), read("rotations", 4), read("scales", 3));
        let weights = read("blendShapeWeights", 1);
        let local = match (translations, rotations, scales) {
            (Some(t), Some(r), Some(s)) => Some([t, r, s]).filter(|[t, r, s]| {
                [t.first().len() / 3, r.first().len() / 4, s.first().len() / 3].iter().all(|found| *found == joints.len())
            }),
            _ => None,
        };
        if local.is_none() && !joints.is_empty() {
            a.warn(&prim.path, "it has not one translation, rotation and scale for each of its joints, which stay at rest");
        }
        let names = prim.value("blendShapes").map(|v| v.as_texts().to_vec()).unwrap_or_default();
        let blend_shapes = weights.filter(|weights| weights.first().len() == names.len()).map(|weights| (names, weights));
        let joints = of_skeleton.iter().map(|name| joints.iter().position(|known| known == name)).collect();
        Self { joints, local, blend_shapes }
    }

    /// The joints in their parents at a time code.
    fn local(&self, rest: &[DAffine3], code: Option<f64>) -> Vec<DAffine3> {
        let Some([translations, rotations, scales]) = &self.local else { return rest.to_vec() };
        let (translations, scales) = (translations.at(code), scales.at(code));
        let rotations = rotations.quaternions_at(code);
        let vector = |numbers: &[f64], joint: usize| DVec3::from_slice(&numbers[3 * joint..]);
        let of_joint = |(rest, joint): (&DAffine3, &Option<usize>)| {
            let Some(joint) = *joint else { return *rest };
            let turned = DMat3::from_quat(quaternion(rotations[joint])) * DMat3::from_diagonal(vector(&scales, joint));
            DAffine3::from_mat3_translation(turned, vector(&translations, joint))
        };
        rest.iter().zip(&self.joints).map(of_joint).collect()
    }

    /// The weight of a blend shape at a time code.
    pub(super) fn weight(&self, name: &str, code: Option<f64>) -> f64 {
        let Some((names, weights)) = &self.blend_shapes else { return 0.0 };
        names.iter().position(|known| &**known == name).map_or(0.0, |at| weights.at(code)[at])
    }

    /// The time codes at which joints and weights change their pace.
    pub(super) fn codes(&self) -> Vec<f64> {
        let of_joints = self.local.iter().flatten().flat_map(Arrays::codes);
        of_joints.chain(self.blend_shapes.iter().flat_map(|(_, weights)| weights.codes())).copied().collect()
    }
}

/// The joint above another: that of the longest path that leads to it.
fn parent(joints: &[Rc<str>], joint: usize) -> Option<usize> {
    let ancestors = std::iter::successors(joints[joint].rsplit_once('/'), |(above, _)| above.rsplit_once('/'));
    ancestors.into_iter().find_map(|(above, _)| joints[..joint].iter().position(|known| &**known == above))
}

/// The animation that a skeleton's prim names, or else the nearest one above it.
fn source(prim: &Prim, stage: &mut Stage, a: &mut Assembly) -> Result<Option<String>, ImportError> {
    let mut path = prim.path.as_str();
    loop {
        let here = stage.at(path, a)?;
        let named = here.and_then(|prim| prim.targets("skel:animationSource", field::TARGETS).into_iter().next());
        match path.rsplit_once('/') {
            _ if named.is_some() => return Ok(named),
            Some((above, _)) if !above.is_empty() => path = above,
            _ => return Ok(None),
        }
    }
}
