//! Point instancers: prototypes at many places.

use super::bind::{self, Bindings};
use super::constants::Constants;
use super::label::{self, Unknown};
use super::layer::field;
use super::operation::rotation;
use super::stage::Prim;
use super::state::State;
use super::things::Thing;
use super::walk::{Walk, is_aside};
use crate::ImportError;
use crate::assembly::{Assembly, FileLabel};
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_scene::ObjectId;
use std::collections::HashSet;
use std::rc::Rc;

/// More instances than this are taken for damage or for grass, neither of which is a room.
const MAX_INSTANCES: usize = 1 << 18;

impl Walk<'_> {
    /// Adds the instances of a point instancer. What is below it is not drawn by itself.
    pub(super) fn instances(&mut self, prim: &Rc<Prim>, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        let numbers = |name: &str, width: usize| prim.value(name).and_then(|v| v.as_numbers(width)).unwrap_or(&[]).to_vec();
        let which = numbers("protoIndices", 1);
        let (positions, scales) = (numbers("positions", 3), numbers("scales", 3));
        let precise = numbers("orientationsf", 4);
        let orientations = if precise.is_empty() { numbers("orientations", 4) } else { precise };
        if which.len() > MAX_INSTANCES {
            return Err(a.malformed(
                format!("<{}>", prim.path),
                format!("found {} instances, expected at most {MAX_INSTANCES}; make the scene smaller", which.len()),
            ));
        }
        for (name, found, width) in
            [("positions", positions.len(), 3), ("scales", scales.len(), 3), ("orientations", orientations.len(), 4)]
        {
            let optional = found == 0 && name != "positions";
            if !optional && found / width != which.len() {
                let problem = format!("found {} {name} for {} instances; the instancer was left out", found / width, which.len());
                a.warn(&prim.path, problem);
                return Ok(());
            }
        }
        let hidden = self.hidden_instances(prim, which.len());
        let mut prototypes = Vec::new();
        for path in prim.targets("prototypes", field::TARGETS) {
            prototypes.push(self.prototype(&path, state, a)?);
        }
        for (i, proto) in which.iter().enumerate().filter(|(i, _)| !hidden.contains(i)) {
            let found = if *proto >= 0.0 { prototypes.get(*proto as usize) } else { None };
            let Some(Some((prototype, inherited))) = found else {
                let problem = format!("found prototype {proto}, but there are {}; its instances were left out", prototypes.len());
                a.warn(format!("<{}>.protoIndices", prim.path), problem);
                continue;
            };
            let vector =
                |list: &[f64], default: f64| list.as_chunks::<3>().0.get(i).map_or(DVec3::splat(default), |v| DVec3::from_array(*v));
            let turn = orientations.as_chunks::<4>().0.get(i).map_or(DMat3::IDENTITY, |q| rotation(*q));
            let placed = DAffine3::from_mat3_translation(turn * DMat3::from_diagonal(vector(&scales, 1.0)), vector(&positions, 0.0));
            let own = format!("{}[{i}]", prim.name());
            let object = a.push_object(&own, state.object);
            let state = State {
                file_from_parent: state.file_from_parent * placed,
                prefix: format!("{}{own}/", state.prefix),
                object: Some(object),
                thing: Thing::placed(object, state.thing),
                label: of_instance(inherited.label, state.object, object),
                stretch: state.stretch.as_ref().map(|stretch| stretch.placed(placed)),
                ..inherited.clone()
            };
            self.visit(&prototype.clone(), &state, a)?;
        }
        Ok(())
    }

    /// A prototype and what it has from those above it: bindings, colours and purpose along its own path; the label, where they have none, of
    /// the instancer. `None` where nothing is at the path.
    fn prototype(&mut self, path: &str, state: &State, a: &mut Assembly) -> Result<Option<(Rc<Prim>, State)>, ImportError> {
        let Some(prim) = self.stage.at(path, a)? else { return Ok(None) };
        let (mut bindings, mut constants) = (Bindings::default(), Constants::default());
        let (mut label, mut hidden) = (state.label, state.hidden);
        for (end, _) in path.match_indices('/').skip(1) {
            let Some(above) = self.stage.at(&path[..end], a)? else { continue };
            bindings = bind::at(&above, &bindings, self.stage, a)?;
            constants = constants.below(&above);
            label = label::at(&above, None, label, &mut Unknown::default());
            hidden = is_aside(&above, hidden);
        }
        Ok(Some((prim, State { label, bindings, constants, hidden, ..state.clone() })))
    }

    /// Places of the instances that are invisible or inactive; both are named by id.
    fn hidden_instances(&self, prim: &Prim, count: usize) -> HashSet<usize> {
        let ids = prim.value("ids").and_then(|v| v.as_numbers(1)).unwrap_or(&[]);
        let mut hidden: Vec<i64> =
            prim.value("invisibleIds").and_then(|v| v.as_numbers(1)).unwrap_or(&[]).iter().map(|i| *i as i64).collect();
        let inactive = prim.field("inactiveIds").map(|v| v.as_list().explicit.unwrap_or_default()).unwrap_or_default();
        hidden.extend(inactive.iter().filter_map(|i| i.path.parse::<i64>().ok()));
        let id = |i: usize| ids.get(i).map_or(i as i64, |id| *id as i64);
        (0..count).filter(|i| hidden.contains(&id(*i))).collect()
    }
}

/// The label of one instance: a label of the instancer, or of a prim that contains the prototypes, applies to each.
fn of_instance(label: FileLabel, instancer: Option<ObjectId>, instance: ObjectId) -> FileLabel {
    let is_of_all = label.whole.is_some() && label.whole != instancer;
    if is_of_all { label } else { FileLabel { whole: Some(instance), ..label } }
}
