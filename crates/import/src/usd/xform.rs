//! Placement: `xformOpOrder` and its operations, at rest and over time.
//!
//! USD multiplies row vectors from the left, so that the first operation of the list is the outermost. Rest is the first sample of every
//! operation.

use super::curve::Curve;
use super::operation::Kind;
use super::stage::Prim;
use crate::assembly::Assembly;
use enfilade_math::DAffine3;

/// A prim's own transform.
pub(super) struct Xform {
    operations: Vec<Operation>,
    /// True when it does not follow its parent (`!resetXformStack!`).
    pub resets: bool,
}

struct Operation {
    kind: Kind,
    inverse: bool,
    curve: Curve,
}

impl Xform {
    /// The transform of a prim. What makes no sense is reported and left out.
    pub(super) fn of(prim: &Prim, a: &mut Assembly) -> Self {
        let order = prim.value("xformOpOrder").map(|v| v.as_texts().to_vec()).unwrap_or_default();
        let mut found = Self { operations: Vec::new(), resets: false };
        for name in &order {
            if &**name == "!resetXformStack!" {
                found = Self { operations: Vec::new(), resets: true };
                continue;
            }
            let (inverse, attribute) = name.strip_prefix("!invert!").map_or((false, &**name), |n| (true, n));
            // An operation without a value is left out, as in USD.
            let Some(values) = prim.over_time(attribute) else {
                if prim.property(attribute, "spline").is_some() {
                    let problem = "is a spline, which is not read, and was left out; bake it to time samples";
                    a.warn(&prim.path, format!("{attribute} {problem}"));
                }
                continue;
            };
            let operation = Kind::named(attribute).and_then(|kind| Some(Operation { kind, inverse, curve: Curve::read(&values, kind)? }));
            match operation {
                None => a.warn(
                    &prim.path,
                    format!("{attribute} is no operation on transforms that is known, or has a wrong value; it was left out"),
                ),
                Some(operation) if operation.is_singular() => {
                    a.warn(&prim.path, format!("{attribute} cannot be inverted and was left out"));
                }
                Some(operation) => found.operations.push(operation),
            }
        }
        found
    }

    /// The transform at rest.
    pub(super) fn rest(&self) -> DAffine3 {
        self.operations.iter().fold(DAffine3::IDENTITY, |all, operation| all * operation.at(None))
    }

    /// The transform at a time code of the stage.
    pub(super) fn at(&self, code: f64) -> DAffine3 {
        self.operations.iter().fold(DAffine3::IDENTITY, |all, operation| all * operation.at(Some(code)))
    }

    /// The time codes between which no operation bends: those of all samples, and as many more as turns need to be told from shorter ones.
    /// Empty where nothing changes.
    pub(super) fn codes(&self) -> Vec<f64> {
        self.operations.iter().flat_map(|operation| operation.curve.codes(operation.kind)).collect()
    }
}

impl Operation {
    fn at(&self, code: Option<f64>) -> DAffine3 {
        let matrix = self.curve.at(code, self.kind);
        match self.inverse {
            true if matrix.matrix3.determinant() != 0.0 => matrix.inverse(),
            true => DAffine3::IDENTITY,
            false => matrix,
        }
    }

    fn is_singular(&self) -> bool {
        self.inverse && self.curve.at(None, self.kind).matrix3.determinant() == 0.0
    }
}
