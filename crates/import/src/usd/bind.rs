//! The material of a prim: its own binding, or the nearest prim's above, unless one above is stronger; and by purpose before nearness, as
//! in OpenUSD's `ComputeBoundMaterial`.

use super::collection::Collection;
use super::layer::field;
use super::stage::{Prim, Stage};
use crate::ImportError;
use crate::assembly::Assembly;
use std::rc::Rc;

/// A binding that a prim states, for itself and what is below it or for a collection.
#[derive(Clone, Debug)]
struct Binding {
    /// Path of the material.
    material: String,
    /// Place among [`PURPOSES`].
    purpose: usize,
    /// True when bindings below do not count.
    stronger: bool,
    /// The bound prims, if they are a collection.
    members: Option<Rc<Collection>>,
    /// Path of the prim that states it.
    by: Rc<str>,
}

/// The bindings that prims from the root down state, the nearest last, and at one prim collections last.
#[derive(Clone, Debug, Default)]
pub(super) struct Bindings(Rc<Vec<Binding>>);

/// Relationships that bind, by purpose: what final pictures use before what previews use.
const PURPOSES: [&str; 3] = ["material:binding:full", "material:binding", "material:binding:preview"];

/// Relationships that bind collections have names that begin so; a purpose may follow.
const COLLECTIONS: &str = "material:binding:collection:";

impl Bindings {
    /// Path of the material of the prim at a path.
    pub(super) fn material(&self, path: &str) -> Option<&str> {
        (0..PURPOSES.len()).find_map(|purpose| {
            let mut chosen: Option<&Binding> = None;
            for b in self.0.iter().rev().filter(|b| b.purpose == purpose) {
                let wins = chosen.is_none_or(|nearer| b.stronger && nearer.by != b.by);
                if wins && b.members.as_ref().is_none_or(|m| m.contains(path)) {
                    chosen = Some(b);
                }
            }
            chosen.map(|b| b.material.as_str())
        })
    }

    /// True when nothing is bound.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Bindings of these and nearer ones together.
    pub(super) fn and(&self, nearer: &Self) -> Self {
        match (self.is_empty(), nearer.is_empty()) {
            (_, true) => self.clone(),
            (true, _) => nearer.clone(),
            _ => Self(Rc::new(self.0.iter().chain(nearer.0.iter()).cloned().collect())),
        }
    }
}

/// The bindings in force at a prim.
///
/// # Errors
/// When a layer with a collection cannot be read.
pub(super) fn at(prim: &Prim, inherited: &Bindings, stage: &mut Stage, a: &mut Assembly) -> Result<Bindings, ImportError> {
    let by: Rc<str> = Rc::from(prim.path.as_str());
    let is_stronger = |name: &str| prim.property(name, "bindMaterialAs").and_then(|v| v.as_text()) == Some("strongerThanDescendants");
    let mut own = Vec::new();
    for (purpose, name) in PURPOSES.iter().enumerate() {
        if let Some(material) = prim.targets(name, field::TARGETS).into_iter().next() {
            own.push(Binding { material, purpose, stronger: is_stronger(name), members: None, by: by.clone() });
        }
    }
    let mut names: Vec<Rc<str>> = prim.properties().into_iter().filter(|p| p.starts_with(COLLECTIONS)).collect();
    // The first by name is the strongest, and goes last.
    names.sort_by(|a, b| b.cmp(a));
    for name in names {
        let purpose = match name[COLLECTIONS.len()..].split_once(':') {
            Some(("full", _)) => 0,
            Some(("preview", _)) => 2,
            _ => 1,
        };
        if let [collection, material] = prim.targets(&name, field::TARGETS).as_slice() {
            let members = Collection::read(collection, stage, a)?.map(Rc::new);
            if members.is_some() {
                own.push(Binding { material: material.clone(), purpose, stronger: is_stronger(&name), members, by: by.clone() });
            }
        }
    }
    Ok(inherited.and(&Bindings(Rc::new(own))))
}
