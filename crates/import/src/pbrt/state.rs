//! The graphics state: the transform in force, the material, and what else applies until its block ends.

use super::params::Params;
use super::tokens::{Kind, Tokens};
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3};
use std::rc::Rc;

/// The graphics state that applies to the next shape or light.
#[derive(Clone)]
pub(super) struct State {
    /// pbrt's world from the object's own space; before `WorldBegin` the camera from the world.
    pub ctm: DAffine3,
    /// False between `ActiveTransform EndTime` and the next one: such transforms belong to the end of the motion.
    pub active: bool,
    /// Set by `ReverseOrientation`.
    pub reversed: bool,
    /// Index into the reader's materials.
    pub material: usize,
    /// The area light that shapes are.
    pub area_light: Option<Rc<Params>>,
    /// Name of the medium inside of shapes; empty for none.
    pub inside: Rc<str>,
    /// Parameters by `Attribute`, with the kind of directive that they are for.
    pub defaults: Rc<Vec<(String, Params)>>,
}

/// The state that the end of a block restores.
pub(super) enum Saved {
    /// `AttributeBegin` and `ObjectBegin`.
    Attributes(State),
    /// `TransformBegin`.
    Transform(DAffine3, bool),
}

impl State {
    /// The state at the beginning of a file.
    pub(super) fn new() -> Self {
        Self {
            ctm: DAffine3::IDENTITY,
            active: true,
            reversed: false,
            material: 0,
            area_light: None,
            inside: "".into(),
            defaults: Rc::new(Vec::new()),
        }
    }

    /// Applies a transform before those in force.
    pub(super) fn concatenate(&mut self, transform: DAffine3) {
        if self.active {
            self.ctm *= transform;
        }
    }

    /// Replaces the transform in force.
    pub(super) fn set(&mut self, transform: DAffine3) {
        if self.active {
            self.ctm = transform;
        }
    }
}

/// The transform of a directive that is one, with its numbers read; `None` for other directives.
///
/// # Errors
/// When numbers are missing, or describe no transform.
pub(super) fn transform(directive: &str, tokens: &mut Tokens) -> Result<Option<DAffine3>, ImportError> {
    Ok(Some(match directive {
        "Identity" => DAffine3::IDENTITY,
        "Translate" => DAffine3::from_translation(numbers::<3>(tokens)?.into()),
        "Scale" => DAffine3::from_scale(numbers::<3>(tokens)?.into()),
        "Rotate" => {
            let [degrees, x, y, z] = numbers::<4>(tokens)?;
            let axis = DVec3::new(x, y, z).try_normalize();
            let axis = axis.ok_or_else(|| tokens.error("the axis of rotation is zero; give an angle and x, y, z"))?;
            DAffine3::from_mat3(DMat3::from_axis_angle(axis, degrees.to_radians()))
        }
        "LookAt" => look_at(tokens)?,
        "Transform" | "ConcatTransform" => matrix(tokens)?,
        _ => return Ok(None),
    }))
}

/// 16 numbers, column by column, so that the translation is the last four.
fn matrix(tokens: &mut Tokens) -> Result<DAffine3, ImportError> {
    let n = numbers::<16>(tokens)?;
    if n[15] == 0.0 || [n[3], n[7], n[11]].iter().any(|v| v.abs() > 1e-9 * n[15].abs()) {
        return Err(tokens.error("the matrix is not affine: its last row must be 0 0 0 1 (numbers 4, 8, 12 and 16)"));
    }
    let column = |i: usize| DVec3::new(n[4 * i], n[4 * i + 1], n[4 * i + 2]) / n[15];
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3)))
}

/// The camera (x right, y up, z forward, which is left-handed) from the world.
fn look_at(tokens: &mut Tokens) -> Result<DAffine3, ImportError> {
    let n = numbers::<9>(tokens)?;
    let [eye, look, up] = [0, 3, 6].map(|i| DVec3::new(n[i], n[i + 1], n[i + 2]));
    let problem = "the eye and the point that it looks at coincide, or up points along the view";
    let forward = (look - eye).try_normalize().ok_or_else(|| tokens.error(problem))?;
    let right = up.cross(forward).try_normalize().ok_or_else(|| tokens.error(problem))?;
    let world_from_camera = DAffine3::from_mat3_translation(DMat3::from_cols(right, forward.cross(right), forward), eye);
    Ok(world_from_camera.inverse())
}

/// Reads `N` numbers, with or without brackets.
pub(super) fn numbers<const N: usize>(tokens: &mut Tokens) -> Result<[f64; N], ImportError> {
    let mut found = [0.0; N];
    let bracketed = tokens.peek()?.is_some_and(|t| t.kind == Kind::Open);
    if bracketed {
        tokens.next()?;
    }
    for (i, number) in found.iter_mut().enumerate() {
        *number = match tokens.next()?.map(|t| t.kind) {
            Some(Kind::Bare(word)) => word.parse().ok().filter(|n: &f64| n.is_finite()),
            _ => None,
        }
        .ok_or_else(|| tokens.error(format!("number {} of {N} is missing or not a finite number", i + 1)))?;
    }
    if bracketed && tokens.next()?.map(|t| t.kind) != Some(Kind::Close) {
        return Err(tokens.error(format!("expected ] after {N} numbers")));
    }
    Ok(found)
}
