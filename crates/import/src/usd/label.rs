//! Labels: `semantics:labels:*` of UsdSemantics, `semantic:*:params:semanticData` of Omniverse's SemanticsAPI, and `customData.Category`,
//! as Apple's RoomPlan writes it.

use super::stage::Prim;
use super::value::Value;
use crate::assembly::{FileLabel, class_named};
use crate::classes::class_of;
use enfilade_scene::ObjectId;

/// Categories of RoomPlan that collections call otherwise.
const ROOMPLAN: [(&str, i16); 1] = [("storage", 3)];

/// Labels that name no class of NYU40: how many, and the first one with its prim.
#[derive(Default)]
pub(super) struct Unknown {
    pub count: usize,
    pub first: Option<(String, String)>,
}

/// The label that is given to a prim with all below it, which is `object`; where the prim is silent the inherited one.
pub(super) fn at(prim: &Prim, object: Option<ObjectId>, inherited: FileLabel, unknown: &mut Unknown) -> FileLabel {
    match class(prim, unknown) {
        Some(semantic) => FileLabel { semantic, instance: None, whole: object },
        None => inherited,
    }
}

/// The class that a prim itself states.
pub(super) fn class(prim: &Prim, unknown: &mut Unknown) -> Option<i16> {
    let names = semantics(prim);
    let category = category(prim);
    let known = names.iter().find_map(|name| class_named(name)).or_else(|| category.as_deref().and_then(class_of_category));
    if let (None, Some(name)) = (known, names.into_iter().next().or(category)) {
        unknown.count += 1;
        unknown.first.get_or_insert_with(|| (name, prim.path.clone()));
    }
    known
}

/// The texts of both schemas: of the stronger opinion first, of equally strong ones the newer schema's.
fn semantics(prim: &Prim) -> Vec<String> {
    let mut ranked = Vec::new();
    for property in prim.properties() {
        let is_newer = property.starts_with("semantics:labels:");
        let is_older = property.starts_with("semantic:") && property.ends_with(":params:semanticData");
        if !(is_newer || is_older) {
            continue;
        }
        if let Some((value, site)) = prim.value_at(&property) {
            ranked.push(((prim.rank(site), is_older), value));
        }
    }
    ranked.sort_by_key(|(rank, _)| *rank);
    let texts = ranked.into_iter().flat_map(|(_, value)| value.as_texts());
    texts.map(|text| text.trim().to_string()).filter(|text| !text.is_empty()).collect()
}

/// RoomPlan's category, without additional properties: `Door(Isopen: False)` is a door.
fn category(prim: &Prim) -> Option<String> {
    let Some(Value::Dictionary(custom)) = prim.field("customData") else { return None };
    let text = custom.get("Category")?.as_text()?;
    let name = text.split('(').next().unwrap_or(text).trim();
    (!name.is_empty()).then(|| name.to_string())
}

fn class_of_category(name: &str) -> Option<i16> {
    class_of(name).or_else(|| ROOMPLAN.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, class)| *class))
}
