//! Meshes whose points change with time: by samples of them, by skeletons and by blend shapes.

use super::arrays::Arrays;
use super::layer::{child_path, field};
use super::polygons::{Corner, Polygons};
use super::skeleton::Skeleton;
use super::skin::{Moved, Skin};
use super::stage::{Prim, Stage};
use super::xform::Xform;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::mesh::add_smooth_normals;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Vec3};
use enfilade_scene::Shape;
use std::collections::HashMap;
use std::rc::Rc;

/// What the prims above a mesh say of its skeleton.
#[derive(Clone, Default)]
pub(super) struct Rig {
    /// True below a `SkelRoot`, without which a skeleton moves nothing.
    is_in_root: bool,
    /// Path of the skeleton.
    skeleton: Option<Rc<str>>,
}

/// Skeletons by their paths; `None` for what is none.
pub(super) type Skeletons = HashMap<Rc<str>, Option<Rc<Skeleton>>>;

/// How the points of a mesh prim change.
pub(super) struct Deform {
    points: Arrays,
    /// Values of the normals, where they are stated.
    normals: Option<Arrays>,
    skin: Option<Skin>,
    /// True where there are smooth normals that are not stated.
    is_smooth: bool,
    origin: DVec3,
}

impl Rig {
    /// What a prim and those above it say.
    pub(super) fn at(&self, prim: &Prim) -> Self {
        let own = prim.targets("skel:skeleton", field::TARGETS).into_iter().next();
        Self { is_in_root: self.is_in_root || prim.kind() == "SkelRoot", skeleton: own.map(Into::into).or_else(|| self.skeleton.clone()) }
    }

    /// The skeleton that moves a mesh prim, and its placement in the mesh's space at rest.
    fn skeleton(
        &self,
        prim: &Prim,
        known: &mut Skeletons,
        stage: &mut Stage,
        a: &mut Assembly,
    ) -> Result<Option<(Rc<Skeleton>, DAffine3)>, ImportError> {
        let Some(path) = self.skeleton.clone().filter(|_| self.is_in_root) else { return Ok(None) };
        let skeleton = match known.get(&path) {
            Some(known) => known.clone(),
            None => {
                let there = stage.at(&path, a)?.filter(|there| there.kind() == "Skeleton");
                if there.is_none() {
                    a.warn(&prim.path, format!("its skeleton <{path}> is not there; the mesh stays in its rest pose"));
                }
                let read = there.map(|there| Skeleton::read(&there, stage, a)).transpose()?.flatten().map(Rc::new);
                known.insert(path.clone(), read.clone());
                read
            }
        };
        let Some(skeleton) = skeleton else { return Ok(None) };
        let mesh_from_file = placement(&prim.path, stage, a)?.inverse();
        let mesh_from_skeleton = mesh_from_file * placement(&path, stage, a)?;
        if !mesh_from_skeleton.is_finite() {
            a.warn(&prim.path, "its placement cannot be inverted, so that it does not follow its skeleton");
            return Ok(None);
        }
        Ok(Some((skeleton, mesh_from_skeleton)))
    }
}

impl Deform {
    /// How a mesh prim deforms, at rest or over time; `None` of one that keeps its points.
    ///
    /// # Errors
    /// When a layer cannot be read.
    pub(super) fn of(
        prim: &Prim,
        polygons: &Polygons,
        (rig, known): (&Rig, &mut Skeletons),
        stage: &mut Stage,
        a: &mut Assembly,
    ) -> Result<Option<Self>, ImportError> {
        let Some((points, are_cut)) = Arrays::read(prim, "points", 3) else { return Ok(None) };
        let normals = polygons.normals_attribute().and_then(|attribute| Arrays::read(prim, attribute, 3));
        let topology = ["faceVertexCounts", "faceVertexIndices"].map(|attribute| Arrays::read(prim, attribute, 1));
        if are_cut || topology.iter().flatten().any(|(indices, is_cut)| *is_cut || !indices.codes().is_empty()) {
            return Ok(None);
        }
        let skin = match rig.skeleton(prim, known, stage, a)? {
            Some(skeleton) => Skin::read(prim, polygons.sizes().points, skeleton, stage, a)?,
            None => None,
        };
        let normals = normals.map(|(normals, _)| normals);
        let found = Self { points, skin, is_smooth: polygons.smooth && normals.is_none(), normals, origin: polygons.origin };
        if found.codes().is_empty() && found.skin.is_none() {
            return Ok(None);
        }
        for attribute in ["points", "normals", "primvars:normals"] {
            stage.sampled.borrow_mut().remove(&format!("{}.{attribute}", prim.path));
        }
        Ok(Some(found))
    }

    /// The time codes at which it changes its pace; none of what is bent at rest alone.
    pub(super) fn codes(&self) -> Vec<f64> {
        let mut codes = self.points.codes().to_vec();
        codes.extend(self.normals.iter().flat_map(Arrays::codes));
        codes.extend(self.skin.iter().flat_map(Skin::codes));
        codes
    }

    /// The shape of a mesh that was made of these corners at a time code; of rest, the first samples, without one.
    pub(super) fn shape(&self, code: Option<f64>, corners: &[Corner], mesh: &Mesh) -> Shape {
        let points: Vec<DVec3> = self.points.at(code).as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)).collect();
        let moved = match &self.skin {
            Some(skin) => skin.at(points, code),
            None => Moved::still(points),
        };
        let positions: Vec<Vec3> = corners.iter().map(|corner| (moved.point(corner.point) - self.origin).as_vec3()).collect();
        let normals = match &self.normals {
            Some(normals) => {
                let values = normals.at(code);
                let stated = |corner: &Corner| DVec3::from_slice(&values[3 * corner.normal as usize..]);
                corners.iter().map(|corner| moved.normal(corner.point, stated(corner)).as_vec3()).collect()
            }
            None if self.is_smooth => {
                let mut bent = Mesh { positions: positions.clone(), triangles: mesh.triangles.clone(), ..Mesh::default() };
                add_smooth_normals(&mut bent);
                bent.normals
            }
            None => Vec::new(),
        };
        Shape { positions, normals }
    }
}

/// The placement of a prim on the stage at rest.
fn placement(path: &str, stage: &mut Stage, a: &mut Assembly) -> Result<DAffine3, ImportError> {
    let mut place = DAffine3::IDENTITY;
    let mut at = String::from("/");
    for name in path.split('/').filter(|name| !name.is_empty()) {
        at = child_path(&at, name);
        let Some(prim) = stage.at(&at, a)? else { break };
        let xform = Xform::of(&prim, a);
        place = if xform.resets { xform.rest() } else { place * xform.rest() };
    }
    Ok(place)
}
