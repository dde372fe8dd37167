//! Which material a prim has: its own binding, or that of the nearest prim above, unless one above is stronger.

use super::layer::field;
use super::stage::Prim;
use crate::assembly::Assembly;

/// A binding that holds for a prim and what is below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Binding {
    /// Path of the material.
    pub material: String,
    /// True when bindings below do not count.
    stronger: bool,
}

impl Binding {
    /// True when bindings below do not count.
    pub(super) fn is_stronger(&self) -> bool {
        self.stronger
    }
}

/// Relationships that bind, by purpose: what final pictures use before what previews use.
const PURPOSES: [&str; 3] = ["material:binding:full", "material:binding", "material:binding:preview"];

/// The binding that holds at a prim.
pub(super) fn at(prim: &Prim, inherited: Option<&Binding>, a: &mut Assembly) -> Option<Binding> {
    if prim.properties().iter().any(|p| p.starts_with("material:binding:collection")) {
        a.warn(&prim.path, "materials bound to collections are not supported; bind them to the prims themselves");
    }
    if let Some(binding) = inherited.filter(|b| b.stronger) {
        return Some(binding.clone());
    }
    let own = PURPOSES.iter().find_map(|name| {
        let material = prim.targets(name, field::TARGETS).into_iter().next()?;
        let stronger = prim.property(name, "bindMaterialAs").and_then(|v| v.as_text()) == Some("strongerThanDescendants");
        Some(Binding { material, stronger })
    });
    own.or_else(|| inherited.cloned())
}
