//! Time samples of placements, as rigid motion over time.
//!
//! A prim whose `xformOp`s have samples is a body, with all that is below it; one below it that moves by itself rides on it. Time begins at
//! `startTimeCode`.

use super::camera::name;
use super::layer::Layer;
use super::stage::Prim;
use super::value::Value;
use super::xform::Xform;
use crate::assembly::Assembly;
use crate::motion::Changing;
use enfilade_math::DAffine3;
use enfilade_scene::BodyId;

/// The motion of the prims of a stage.
pub(super) struct Animations {
    codes_per_second: f64,
    /// First and last time code of the stage, where they are stated.
    stated: [Option<f64>; 2],
    /// First and last time code at which a body has a state.
    sampled: Option<[f64; 2]>,
}

impl Animations {
    /// Of a stage whose scene file is `layer`.
    pub(super) fn new(layer: &Layer) -> Self {
        let stated = |name: &str| layer.get("/", name).and_then(Value::as_number).filter(|code| code.is_finite());
        let stated = [stated("startTimeCode"), stated("endTimeCode")];
        Self { codes_per_second: layer.codes_per_second(), stated, sampled: None }
    }

    /// The body that a prim is, if it moves by itself, else the one that bears it. `prefix` goes before its name.
    pub(super) fn body(
        &mut self,
        prim: &Prim,
        prefix: &str,
        xform: &Xform,
        (file_from_parent, bearer): (DAffine3, Option<BodyId>),
        a: &mut Assembly,
    ) -> Option<BodyId> {
        let codes = xform.codes();
        if codes.is_empty() {
            return bearer;
        }
        let rate = self.codes_per_second;
        let node = Changing {
            place: &prim.path,
            name: &format!("{prefix}{}", name(prim)),
            rest: xform.rest(),
            moments: codes.iter().map(|code| code / rate).collect(),
            local: &|time_s, _| xform.at(time_s * rate),
            told: &|time_s| format!("time code {}", (time_s * rate * 1e6).round() / 1e6),
        };
        let body = node.body((file_from_parent, bearer), a);
        if body.is_some() {
            let [first, last] = self.sampled.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
            self.sampled = Some([codes.iter().copied().fold(first, f64::min), codes.iter().copied().fold(last, f64::max)]);
        }
        body.or(bearer)
    }

    /// Makes the first moment of the stage that of the scene, and says what became of its time samples.
    pub(super) fn finish(&self, a: &mut Assembly) {
        let Some(sampled) = self.sampled else { return };
        let [first, last] = [0, 1].map(|end| self.stated[end].unwrap_or(sampled[end]));
        a.begin_at(first / self.codes_per_second);
        let moving = a.drop_unused_bodies();
        let message = if moving == 0 {
            "nothing that is seen moves by them; parts stay where the first samples have them".into()
        } else {
            let span_s = ((last - first) / self.codes_per_second * 1e3).round() / 1e3;
            format!("{moving} things move by them, {span_s} s from time code {first} on (still = true leaves motion out)")
        };
        a.warn("timeSamples", message);
    }
}
