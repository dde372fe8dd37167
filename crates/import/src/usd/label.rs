//! Labels: `semantics:labels:*` of UsdSemantics, and `semantic:*:params:semanticData` of Omniverse's SemanticsAPI.

use super::stage::Prim;
use enfilade_scene::{NYU40, PartLabel};

/// Labels that name no class of NYU40: how many, and the first one with its prim.
#[derive(Default)]
pub(super) struct Unknown {
    pub count: usize,
    pub first: Option<(String, String)>,
}

/// The label that a prim's semantics give, where they are silent the inherited one.
pub(super) fn at(prim: &Prim, inherited: PartLabel, unknown: &mut Unknown) -> PartLabel {
    let mut names: Vec<String> = Vec::new();
    for property in prim.properties() {
        let omniverse = property.starts_with("semantic:") && property.ends_with(":params:semanticData");
        if property.starts_with("semantics:labels:") || omniverse {
            names.extend(prim.value(&property).into_iter().flat_map(|v| v.as_texts()).map(|t| t.trim().to_string()));
        }
    }
    names.retain(|n| !n.is_empty());
    let known = names.iter().find_map(|name| NYU40.iter().find(|c| c.name.eq_ignore_ascii_case(name)));
    match (known, names.first()) {
        (Some(class), _) => PartLabel { semantic: class.id, ..inherited },
        (None, Some(name)) => {
            unknown.count += 1;
            unknown.first.get_or_insert_with(|| (name.clone(), prim.path.clone()));
            inherited
        }
        (None, None) => inherited,
    }
}
