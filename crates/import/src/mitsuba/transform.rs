//! Transforms: `matrix`, `translate`, `rotate`, `scale`, `lookat`, each applied after those before it.

use super::xml::Node;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3};

/// The transform property `name` of `node`; the identity when it has none.
///
/// # Errors
/// When an operation is unknown or its numbers make no sense.
pub(super) fn of(node: &Node, name: &str) -> Result<DAffine3, ImportError> {
    let Some(mut transform) = node.child(name) else { return Ok(DAffine3::IDENTITY) };
    if transform.tag == "animation" {
        transform = transform.children.first().ok_or_else(|| transform.error("the animation is empty"))?;
    }
    transform.children.iter().try_fold(DAffine3::IDENTITY, |so_far, operation| Ok(one(operation)? * so_far))
}

/// True when the transform property `name` is animated, of which only the first moment is used.
pub(super) fn is_animated(node: &Node, name: &str) -> bool {
    node.child(name).is_some_and(|t| t.tag == "animation")
}

fn one(operation: &Node) -> Result<DAffine3, ImportError> {
    match operation.tag.as_str() {
        "matrix" => matrix(operation),
        "translate" => Ok(DAffine3::from_translation(vector(operation, 0.0)?)),
        "scale" => Ok(DAffine3::from_scale(vector(operation, 1.0)?)),
        "rotate" => {
            let axis = vector(operation, 0.0)?;
            let angle = operation.numbers("angle")?.first().copied().unwrap_or(0.0).to_radians();
            let axis = axis.try_normalize().ok_or_else(|| operation.error("the axis of rotation is zero; give x, y or z"))?;
            Ok(DAffine3::from_mat3(DMat3::from_axis_angle(axis, angle)))
        }
        "lookat" => look_at(operation),
        other => Err(operation.error(format!("<{other}> is not a transform; expected matrix, translate, rotate, scale or lookat"))),
    }
}

/// The components x, y, z, each from its attribute or from `value` (one number applies to all three).
fn vector(operation: &Node, default: f64) -> Result<DVec3, ImportError> {
    if operation.attribute("value").is_some() {
        return match operation.numbers("value")?[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            [all] => Ok(DVec3::splat(all)),
            ref other => Err(operation.error(format!("found {} numbers, expected 1 or 3", other.len()))),
        };
    }
    let component = |name: &str| Ok::<_, ImportError>(operation.numbers(name)?.first().copied().unwrap_or(default));
    Ok(DVec3::new(component("x")?, component("y")?, component("z")?))
}

/// 16 numbers of a 4×4 or 9 of a 3×3 matrix, row by row. The last row of a 4×4 scales the rest by its last number.
fn matrix(operation: &Node) -> Result<DAffine3, ImportError> {
    let n = operation.numbers("value")?;
    match n.len() {
        9 => Ok(DAffine3::from_mat3(DMat3::from_cols_array(&std::array::from_fn(|i| n[i])).transpose())),
        16 if n[15] != 0.0 => {
            let column = |i: usize| DVec3::new(n[i], n[4 + i], n[8 + i]) / n[15];
            Ok(DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3)))
        }
        found => Err(operation.error(format!("found {found} numbers, expected 16 (the last not zero) or 9"))),
    }
}

/// Mitsuba's camera space: x left, y up, z forward.
fn look_at(operation: &Node) -> Result<DAffine3, ImportError> {
    let point = |name: &str, default: Option<DVec3>| -> Result<DVec3, ImportError> {
        match (&operation.numbers(name)?[..], default) {
            (&[x, y, z], _) => Ok(DVec3::new(x, y, z)),
            ([], Some(default)) => Ok(default),
            _ => Err(operation.error(format!("{name} should be three numbers"))),
        }
    };
    let (origin, target, up) = (point("origin", None)?, point("target", None)?, point("up", Some(DVec3::ZERO))?);
    let problem = || operation.error("origin and target coincide, or up points along the view");
    let forward = (target - origin).try_normalize().ok_or_else(problem)?;
    // Without an up, Mitsuba 2 and 3 take the first tangent of this basis (Duff et al. 2017).
    let up = if up == DVec3::ZERO { forward.any_orthonormal_pair().0 } else { up };
    let left = up.cross(forward).try_normalize().ok_or_else(problem)?;
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(left, forward.cross(left), forward), origin))
}
