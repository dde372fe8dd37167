//! Prims whose gprims are one object together: models of kind `component`, instanceable prims, and instances of point
//! instancers. Otherwise each gprim is an object of its own, with its parent prims as parents.

use super::stage::Prim;
use super::value::Value;
use crate::assembly::Assembly;
use enfilade_scene::{ObjectId, PartId};
use std::collections::{BTreeMap, BTreeSet};

/// A prim that is one object with all below it.
#[derive(Clone, Copy)]
pub(super) struct Thing {
    object: ObjectId,
    /// True for those of kind `component`, which nothing below takes apart.
    is_component: bool,
}

impl Thing {
    /// The thing of a prim with an object of its own: the prim itself, or the thing around it.
    pub(super) fn at(prim: &Prim, object: ObjectId, around: Option<Self>) -> Option<Self> {
        let is_component = prim.field("kind").and_then(Value::as_text) == Some("component");
        let is_instance = prim.field("instanceable").and_then(Value::as_bool) == Some(true);
        match around {
            _ if is_component => Some(Self { object, is_component }),
            Some(thing) if thing.is_component || !is_instance => Some(thing),
            _ => is_instance.then_some(Self { object, is_component }),
        }
    }

    /// The thing that an instance of a point instancer is.
    pub(super) fn placed(object: ObjectId, around: Option<Self>) -> Option<Self> {
        around.filter(|thing| thing.is_component).or(Some(Self { object, is_component: false }))
    }
}

/// The parts that are pieces of things.
#[derive(Default)]
pub(super) struct Things {
    parts: usize,
    pieces: BTreeMap<ObjectId, Vec<(ObjectId, PartId)>>,
}

impl Things {
    /// Notes a part, whose own object is `object`.
    pub(super) fn part(&mut self, thing: Option<Thing>, object: ObjectId, part: PartId) {
        self.parts += 1;
        if let Some(thing) = thing {
            self.pieces.entry(thing.object).or_default().push((object, part));
        }
    }

    /// Assigns parts to their things. A prim that contains everything is the scene, whatever its kind.
    pub(super) fn settle(self, a: &mut Assembly) {
        for (thing, pieces) in self.pieces {
            let objects: BTreeSet<ObjectId> = pieces.iter().map(|(object, _)| *object).collect();
            if pieces.len() < self.parts || objects.len() == 1 {
                pieces.iter().for_each(|(_, part)| a.set_object(*part, thing));
            }
        }
    }
}
