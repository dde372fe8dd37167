//! Rotations that bring a model onto itself, found by its shape alone, as BOP's `models_info.json` states them.
//!
//! The measure is BOP's (Hodaň et al. 2020, "BOP Challenge 2020 on 6D Object Localization", section 2.3): a rotation is a symmetry if the
//! Hausdorff distance between the surface and the turned surface stays within a tolerance. BOP tolerates max(15 mm, 0.1 d), d being the
//! diameter, and has people leave out of these what texture or details tell apart; nobody does that here, so the default is 0.02 d.
//!
//! Every rotation that maps a surface onto itself fixes the centroid of its area and permutes its principal axes (Minovic, Ishikawa and Kato
//! 1993, "Symmetry identification of a 3-D object represented by octree"). So the candidates are the principal axes where the three moments
//! differ; where two are alike, also every direction across the third axis; where all are alike, every direction.

mod deviation;
mod moments;
mod search;

use crate::mesh::SurfaceMesh;
use crate::options::SymmetryRule;
use deviation::Shape;
use enfilade_math::{DMat3, DVec3};
use moments::Moments;

/// Tolerance by the shape alone, over the diameter.
const SHAPE_SHARE: f64 = 0.02;

/// BOP's tolerance: a length, or a share of the diameter where that is more.
const BOP_METRES: f64 = 0.015;
const BOP_SHARE: f64 = 0.1;

/// The symmetries of a model, in its own space and unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Symmetries {
    /// Rotations but the identity, all about `center`. Where there is a continuous symmetry, all are these, each followed by any turn about
    /// that axis.
    pub discrete: Vec<DMat3>,
    /// Axes about which every turn is a symmetry, all through `center`: one, or for a ball three that are perpendicular.
    pub continuous: Vec<DVec3>,
    /// Fixed point of the rotations.
    pub center: DVec3,
}

impl SymmetryRule {
    /// Greatest deviation that a symmetry may have, metres; `None` where none is looked for.
    fn tolerance_m(self, diameter_m: f64) -> Option<f64> {
        match self {
            Self::Shape => Some(SHAPE_SHARE * diameter_m),
            Self::Bop => Some(BOP_METRES.max(BOP_SHARE * diameter_m)),
            Self::None => None,
        }
    }
}

/// The symmetries of a surface in metres, of a known diameter.
pub(crate) fn symmetries(mesh: &SurfaceMesh, diameter_m: f64, rule: SymmetryRule) -> Symmetries {
    let (Some(tolerance_m), Some(moments)) = (rule.tolerance_m(diameter_m), Moments::of(mesh)) else { return Symmetries::default() };
    let shape = Shape::new(mesh, moments.centroid, diameter_m);
    let (discrete, continuous) = search::search(&shape, &moments, tolerance_m);
    Symmetries { discrete, continuous, center: moments.centroid }
}

#[cfg(test)]
mod tests;
