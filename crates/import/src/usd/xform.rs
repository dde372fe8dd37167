//! Placement: `xformOpOrder` and its operations.
//!
//! USD multiplies row vectors from the left, so that the first operation of the list is the outermost.

use super::stage::Prim;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};

/// A prim's own transform, and true when it does not follow its parent (`!resetXformStack!`).
pub(super) fn local(prim: &Prim, a: &mut Assembly) -> (DAffine3, bool) {
    let order = prim.value("xformOpOrder").map(|v| v.as_texts().to_vec()).unwrap_or_default();
    let (mut matrix, mut reset) = (DAffine3::IDENTITY, false);
    for name in &order {
        if &**name == "!resetXformStack!" {
            (matrix, reset) = (DAffine3::IDENTITY, true);
            continue;
        }
        let (inverse, attribute) = name.strip_prefix("!invert!").map_or((false, &**name), |n| (true, n));
        match operation(prim, attribute) {
            // An operation without a value is left out, as in USD.
            None if prim.value(attribute).is_none() => (),
            None => a.warn(
                &prim.path,
                format!("{attribute} is no operation on transforms that is known, or has a wrong value; it was left out"),
            ),
            Some(op) if inverse && op.matrix3.determinant() == 0.0 => {
                a.warn(&prim.path, format!("{attribute} cannot be inverted and was left out"));
            }
            Some(op) => matrix *= if inverse { op.inverse() } else { op },
        }
    }
    (matrix, reset)
}

fn operation(prim: &Prim, attribute: &str) -> Option<DAffine3> {
    let kind = attribute.strip_prefix("xformOp:")?.split(':').next()?;
    let value = prim.value(attribute)?;
    let vector = || value.as_tuple::<3>().map(DVec3::from_array);
    let axis = |letter: &str| match letter {
        "X" => Some(DVec3::X),
        "Y" => Some(DVec3::Y),
        "Z" => Some(DVec3::Z),
        _ => None,
    };
    if let Some(letters) = kind.strip_prefix("rotate") {
        if let Some(about) = axis(letters) {
            return Some(DAffine3::from_axis_angle(about, value.as_number()?.to_radians()));
        }
        let angles = vector()?;
        // The first letter turns first.
        return letters.split("").filter(|l| !l.is_empty()).try_fold(DAffine3::IDENTITY, |matrix, letter| {
            let about = axis(letter)?;
            Some(DAffine3::from_axis_angle(about, angles.dot(about).to_radians()) * matrix)
        });
    }
    if let Some(letter) = kind.strip_prefix("translate").filter(|l| !l.is_empty()) {
        return Some(DAffine3::from_translation(axis(letter)? * value.as_number()?));
    }
    if let Some(letter) = kind.strip_prefix("scale").filter(|l| !l.is_empty()) {
        let axis = axis(letter)?;
        return Some(DAffine3::from_scale(DVec3::ONE - axis + axis * value.as_number()?));
    }
    match kind {
        "translate" => Some(DAffine3::from_translation(vector()?)),
        "scale" => Some(DAffine3::from_scale(vector()?)),
        "orient" => value.as_tuple().map(|q| DAffine3::from_mat3(rotation(q))),
        "transform" => value.as_tuple().map(matrix),
        _ => None,
    }
}

/// A matrix of 16 numbers for row vectors, row by row.
fn matrix(m: [f64; 16]) -> DAffine3 {
    let row = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
    DAffine3::from_mat3_translation(DMat3::from_cols(row(0), row(4), row(8)), row(12))
}

/// The rotation of a quaternion, its real part first, which need not be of unit length; a zero one turns nothing.
pub(super) fn rotation([w, x, y, z]: [f64; 4]) -> DMat3 {
    let q = DQuat::from_xyzw(x, y, z, w);
    if q.length_squared() > 0.0 && q.is_finite() { DMat3::from_quat(q.normalize()) } else { DMat3::IDENTITY }
}
