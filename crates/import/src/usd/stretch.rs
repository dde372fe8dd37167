//! Prims whose scale or shear changes with time, or that turn within something stretched: no body moves so, and meshes in them deform.

use super::xform::Xform;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyId, Shape};
use std::rc::Rc;

/// The placements of prims, from one that no body can be down to another.
#[derive(Clone)]
pub(super) struct Stretch {
    /// Placement at rest of what the uppermost prim is in.
    file_from_top: DAffine3,
    /// The body that bears it.
    pub bearer: Option<BodyId>,
    steps: Vec<Step>,
}

#[derive(Clone)]
enum Step {
    Prim(Rc<Xform>),
    /// An instance in an instancer.
    Instance(DAffine3),
}

impl Stretch {
    /// What is in something placed like that at rest, and borne by a body.
    pub(super) fn new(file_from_top: DAffine3, bearer: Option<BodyId>) -> Self {
        Self { file_from_top, bearer, steps: Vec::new() }
    }

    /// A prim below.
    pub(super) fn below(&self, xform: &Rc<Xform>) -> Self {
        self.with(Step::Prim(xform.clone()))
    }

    /// An instance below.
    pub(super) fn placed(&self, instance: DAffine3) -> Self {
        self.with(Step::Instance(instance))
    }

    fn with(&self, step: Step) -> Self {
        let mut new = self.clone();
        new.steps.push(step);
        new
    }

    /// The time codes at which prims change their pace.
    pub(super) fn codes(&self) -> Vec<f64> {
        let codes = |step: &Step| if let Step::Prim(xform) = step { xform.codes() } else { Vec::new() };
        self.steps.iter().flat_map(codes).collect()
    }

    /// Placement in the file at a time code, while its bearer is at rest.
    fn at(&self, code: f64) -> DAffine3 {
        let at = |step: &Step| match step {
            Step::Prim(xform) => xform.at(code),
            Step::Instance(placed) => *placed,
        };
        self.steps.iter().fold(self.file_from_top, |all, step| all * at(step))
    }

    /// A mesh's shape at a time code in the space that the mesh has at rest, whose positions count from `origin`. `None` where that mirrors it.
    pub(super) fn shape(&self, code: f64, shape: Shape, (file_from_mesh, origin): (&DAffine3, DVec3)) -> Option<Shape> {
        let from_origin = DAffine3::from_translation(origin);
        let map = from_origin.inverse() * file_from_mesh.inverse() * self.at(code) * from_origin;
        let Shape { positions, normals } = shape;
        let mut mesh = Mesh { positions, normals, ..Mesh::default() };
        let is_mirrored = crate::motion::place(&mut mesh, &map);
        (!is_mirrored).then_some(Shape { positions: mesh.positions, normals: mesh.normals })
    }
}
