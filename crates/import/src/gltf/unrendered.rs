//! Extensions of materials that the scene has no place for: each is reported once, with the materials that have it and what is rendered instead.

use crate::assembly::Assembly;
use gltf::json::Root;

/// Extensions, and what is rendered instead.
const INSTEAD: [(&str, &str); 5] = [
    ("KHR_materials_anisotropy", "their highlights are as wide in all directions, by the roughness"),
    ("KHR_materials_diffuse_transmission", "they scatter light back alone, by the base colour"),
    ("KHR_materials_dispersion", "they refract all colours alike, by the index of refraction"),
    ("KHR_materials_iridescence", "their reflections have no colours of thin films"),
    ("KHR_materials_volume_scatter", "light is absorbed within them, but not scattered"),
];

/// Greatest number of materials that are named.
const NAMED: usize = 3;

/// True for an extension that [`report`] mentions.
pub(super) fn is_told(extension: &str) -> bool {
    INSTEAD.iter().any(|(name, _)| *name == extension)
}

/// Warns of each such extension that the file's materials have.
pub(super) fn report(root: &Root, a: &mut Assembly) {
    for (extension, instead) in INSTEAD {
        let has_it = |m: &gltf::json::Material| m.extensions.as_ref().is_some_and(|e| e.others.contains_key(extension));
        let having = root.materials.iter().enumerate().filter(|(_, m)| has_it(m));
        let names: Vec<String> = having.map(|(i, m)| m.name.clone().unwrap_or_else(|| format!("material_{i}"))).collect();
        let named = names.iter().take(NAMED).map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
        let others = match names.len().saturating_sub(NAMED) {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        if !names.is_empty() {
            a.warn(extension, format!("not rendered, materials {named}{others}: {instead}"));
        }
    }
}
