//! Time samples of placements as rigid motion, and of points and skeletons as shapes over time.
//!
//! A prim whose `xformOp`s have samples is a body, with all that is below it; one below it that moves by itself rides on it. Time begins at
//! `startTimeCode`.

use super::camera::name;
use super::layer::Layer;
use super::stage::Prim;
use super::state::{Piece, State};
use super::stretch::Stretch;
use super::value::Value;
use super::xform::Xform;
use crate::assembly::Assembly;
use crate::motion::{Changing, Moved, Shapes, length_in, shapes};
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyId, PartId, Shape};

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

    /// The body that a prim is, if it moves by itself, else the one that bears it, and what of its motion no body has. `prefix` goes before
    /// its name.
    pub(super) fn body(
        &mut self,
        prim: &Prim,
        prefix: &str,
        xform: &Xform,
        (file_from_parent, bearer): (DAffine3, Option<BodyId>),
        a: &mut Assembly,
    ) -> Moved {
        let codes = xform.codes();
        if codes.is_empty() {
            return Moved { body: bearer, problem: None };
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
        let moved = node.moved((file_from_parent, bearer), a);
        if moved.body.is_some() {
            self.note(&codes);
        }
        Moved { body: moved.body.or(bearer), ..moved }
    }

    /// Makes a placed part deform if its points change, or prims that it is in are stretched.
    pub(super) fn deform(&mut self, prim: &Prim, piece: &Piece, origin: DVec3, (part, state): (PartId, &State), a: &mut Assembly) {
        let (deform, stretch) = (&piece.deform, &state.stretch);
        let mut codes = deform.as_ref().map(|(deform, _)| deform.codes()).unwrap_or_default();
        codes.extend(stretch.iter().flat_map(Stretch::codes));
        let (rate, mesh) = (self.codes_per_second, a.mesh_at(piece.mesh).clone());
        let own = |code: f64| match deform {
            Some((deform, corners)) => deform.shape(Some(code), corners, &mesh),
            None => Shape { positions: mesh.positions.clone(), normals: mesh.normals.clone() },
        };
        let placed = (&state.file_from_parent, origin);
        let shape = |time_s: f64, _| {
            let code = time_s * rate;
            match stretch {
                Some(stretch) => stretch.shape(code, own(code), placed).ok_or(()),
                None => Ok(own(code)),
            }
        };
        let length = length_in(&state.file_from_parent, a.meters_per_unit());
        let problem = match shapes(codes.iter().map(|code| code / rate).collect(), false, length, shape) {
            Ok(Shapes::Timed(shapes)) => {
                let bearer = stretch.as_ref().map_or(state.body, |stretch| stretch.bearer);
                if a.deform(part, bearer, shapes) {
                    self.note(&codes);
                }
                return;
            }
            Ok(Shapes::Constant) => return,
            Ok(Shapes::Refused(problem)) => problem,
            Err(()) => "it is mirrored then".into(),
        };
        a.warn(&prim.path, format!("its shape changes, but {problem}; it keeps that of rest"));
    }

    /// Takes in the time codes at which something has a state.
    fn note(&mut self, codes: &[f64]) {
        let [first, last] = self.sampled.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        self.sampled = Some([codes.iter().copied().fold(first, f64::min), codes.iter().copied().fold(last, f64::max)]);
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
