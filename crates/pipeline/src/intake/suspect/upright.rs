//! The upward direction by names of things, orientation of cameras, and surfaces of a room.

use super::{names::Named, support};
use crate::intake::seen::Look;
use enfilade_import::UpStated;
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{CEILING, FLOOR, Scene};

/// Least share of the area of floors that faces along one axis, and largest share along any other.
const FACING: f64 = 0.6;
const ELSEWHERE: f64 = 0.25;
/// Least distance between the middles of floor and ceiling, over the extent of the scene along that axis.
const APART: f64 = 0.1;
/// Cosines between an axis and a camera's upward direction: for an upright camera, and for one that indicates another axis. A camera that
/// looks down more steeply than the third is a bird's-eye view, whose upward direction is level.
const UPRIGHT: f64 = 0.6;
const TELLS: f64 = 0.8;
const DOWN: f64 = -0.8;
/// Without names or cameras: extents of a storey, metres, and how many times as much area its floor and ceiling have as its walls along
/// each other axis.
const STOREY_M: std::ops::RangeInclusive<f64> = 2.1..=4.5;
const FLATTER: f64 = 1.5;
/// Least ratio of flatness where things rest on that side too, and how many times as long the extent along the supposed height is.
const FLATTER_AND_RESTED_ON: f64 = 1.2;
const HIGHER: f64 = 1.2;

/// A scene that lies on its side.
pub(super) struct Lying {
    /// The true upward direction, in the world's axes.
    pub up: DVec3,
    /// The evidence for it.
    pub witnesses: Vec<Witness>,
}

/// Evidence for the upward direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Witness {
    /// Positions of parts named floor and ceiling.
    Names,
    /// The upward directions of the file's cameras.
    Cameras,
    /// What things rest on.
    Support,
    /// Extents, and the sides with most area.
    Surfaces,
}

/// The upward direction where it is not z by all that is known; `axes` turn the file's to the world's.
pub(super) fn suspected(scene: &Scene, look: &Look, named: &Named, axes: DMat3, stated: UpStated) -> Option<Lying> {
    let cameras = of_cameras(scene);
    let lying = |up: DVec3, witnesses: &[Witness]| (up != DVec3::Z).then(|| Lying { up, witnesses: witnesses.to_vec() });
    match (of_names(look, named), cameras) {
        (Some((up, _)), Some(seen)) if seen == up => lying(up, &[Witness::Names, Witness::Cameras]),
        // A floor or a ceiling alone may be named so by mistake.
        (Some((_, false)), Some(DVec3::Z)) => None,
        (Some((up, _)), _) => lying(up, &[Witness::Names]),
        (None, Some(seen)) => lying(seen, &[Witness::Cameras]),
        (None, None) => {
            let rest = || flat_side(look).and_then(|axis| support::upward(look, axis)).and_then(|up| lying(up, &[Witness::Support]));
            match stated {
                UpStated::ByFile => None,
                UpStated::ByRule => rest(),
                UpStated::Nowhere => of_surfaces(look, axes).and_then(|up| lying(up, &[Witness::Surfaces])).or_else(rest),
            }
        }
    }
}

/// The upward direction by names, and whether both floor and ceiling indicate it.
fn of_names(look: &Look, named: &Named) -> Option<(DVec3, bool)> {
    let [floor, ceiling, rest] = [Some(FLOOR), Some(CEILING), None].map(|class| Flat::of(look, named, class));
    let extent = look.bounds_of_building().extent().as_dvec3();
    let apart = |axis: usize, low: &Flat, high: &Flat| {
        let distance = high.middle()?[axis] - low.middle()?[axis];
        (distance.abs() >= APART * extent[axis]).then(|| DVec3::AXES[axis] * distance.signum())
    };
    match (floor.axis(), ceiling.axis()) {
        (Some(axis), over) if over.is_none_or(|over| over == axis) => {
            let both = apart(axis, &floor, &ceiling).map(|up| (up, true));
            both.or_else(|| apart(axis, &floor, &rest).map(|up| (up, false)))
        }
        (None, Some(axis)) => apart(axis, &rest, &ceiling).map(|up| (up, false)),
        _ => None,
    }
}

/// Area of some parts, and the direction it faces.
#[derive(Default)]
struct Flat {
    area: f64,
    facing: DVec3,
    moment: DVec3,
}

impl Flat {
    /// Flat surfaces of the parts of a class; of those that are neither floor nor ceiling without one.
    fn of(look: &Look, named: &Named, class: Option<i16>) -> Self {
        let mut flat = Self::default();
        for (corners, source) in look.world.corners.iter().zip(&look.world.sources) {
            let of_part = named.classes[source.part as usize].filter(|class| matches!(*class, FLOOR | CEILING));
            if of_part != class {
                continue;
            }
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let normal = 0.5 * (b - a).cross(c - a);
            flat.area += normal.length();
            flat.facing += normal.abs();
            flat.moment += (a + b + c) / 3.0 * normal.length();
        }
        flat
    }

    /// All surfaces; only those along the axes face anywhere.
    fn along_axes(look: &Look) -> Self {
        let mut all = Self::default();
        for corners in &look.world.corners {
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let normal = 0.5 * (b - a).cross(c - a);
            let is_level = normal.abs().max_element() >= 0.95 * normal.length();
            all.area += normal.length();
            all.facing += if is_level { normal.abs() } else { DVec3::ZERO };
            all.moment += (a + b + c) / 3.0 * normal.length();
        }
        all
    }

    fn middle(&self) -> Option<DVec3> {
        (self.area > 0.0).then(|| self.moment / self.area)
    }

    /// The axis that nearly all of it faces along.
    fn axis(&self) -> Option<usize> {
        let share = self.facing / self.area.max(f64::MIN_POSITIVE);
        let most = (0..3).find(|&axis| share[axis] >= FACING)?;
        (0..3).all(|axis| axis == most || share[axis] <= ELSEWHERE).then_some(most)
    }
}

/// The upward direction by the cameras that indicate one, if they agree.
fn of_cameras(scene: &Scene) -> Option<DVec3> {
    let told = |camera: &enfilade_scene::StartCamera| {
        let (up, forward) = (camera.world_from_camera.y_axis, -camera.world_from_camera.z_axis);
        if up.z >= UPRIGHT {
            return Some(DVec3::Z);
        }
        let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        axes.into_iter().find(|axis| up.dot(*axis) >= TELLS).filter(|_| forward.z > DOWN)
    };
    let mut told = scene.cameras.iter().filter_map(told);
    let first = told.next()?;
    told.all(|other| other == first).then_some(first)
}

/// The upward direction of a storey on its side: its floor and ceiling have most of the area and are apart by the height of a storey, while
/// the extent along the supposed height is longer. Things in rooms are nearer to the floor.
fn of_surfaces(look: &Look, axes: DMat3) -> Option<DVec3> {
    let all = Flat::along_axes(look);
    let (bounds, extent) = (look.world.bounds, look.world.bounds.extent().as_dvec3());
    let is_storey = |axis: &usize| {
        let others = (0..3).filter(|other| other != axis);
        STOREY_M.contains(&extent[*axis]) && others.clone().all(|other| all.facing[*axis] >= FLATTER * all.facing[other])
    };
    let axis = [0, 1].into_iter().find(is_storey).filter(|_| extent.z > *STOREY_M.end())?;
    let below = 0.5 * (bounds.min.as_dvec3() + bounds.max.as_dvec3())[axis] - all.middle()?[axis];
    // If nothing distinguishes up from down, the file's own axis decides the sign.
    let sign = if below.abs() >= 0.02 * extent[axis] { below } else { (axes.transpose() * DVec3::AXES[axis]).element_sum() };
    Some(DVec3::AXES[axis] * sign.signum())
}

/// The level axis along which a scene is as high as a storey and has most area, while it is longer along the supposed height.
fn flat_side(look: &Look) -> Option<usize> {
    let (facing, extent) = (Flat::along_axes(look).facing, look.world.bounds.extent().as_dvec3());
    let is_flat = |axis: &usize| {
        let others = (0..3).filter(|other| other != axis);
        STOREY_M.contains(&extent[*axis])
            && extent.z >= HIGHER * extent[*axis]
            && others.clone().all(|other| facing[*axis] >= FLATTER_AND_RESTED_ON * facing[other])
    };
    [0, 1].into_iter().find(is_flat)
}
