//! `panes`: glass whose transmission was lost in export becomes clear; if that is not requested, such glass is reported.
//!
//! Exporters leave transmission out where their format has no place for it: Blender's FBX and OBJ, and USD without MaterialX.

use crate::config::FileSource;
use crate::pattern::matches;
use enfilade_dataset::counted;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Scene};
use enfilade_suggest::words::words;
use std::collections::{BTreeMap, BTreeSet};

/// Index of refraction of window glass.
const GLASS: f32 = 1.5;
/// Words for glass and panes, as names are taken apart: English, German, French, Spanish, Italian, Polish, Russian.
const CALLED: [&str; 16] = [
    "glass",
    "glazing",
    "pane",
    "windowpane",
    "windowglass",
    "glas",
    "fensterglas",
    "scheibe",
    "fensterscheibe",
    "verre",
    "vitre",
    "vidrio",
    "cristal",
    "vetro",
    "szyba",
    "steklo",
];
/// Words that may follow one of these.
const BEHIND: [&str; 12] =
    ["clear", "transparent", "window", "door", "panel", "shader", "mat", "thin", "simple", "architectural", "tinted", "surface"];
/// Words for glass that is opaque on purpose: hobs, screens, lampshades.
const OPAQUE: [&str; 8] = ["black", "opal", "opaline", "milk", "milky", "opaque", "painted", "mirror"];
/// Number of names in a remark.
const NAMED: usize = 3;
/// Metalness from which on a surface is a mirror.
const METAL: f32 = 0.5;

/// Makes panes of the materials that `source` names; returns a remark on how many, and on names without a material.
pub(super) fn glaze(source: &FileSource, scene: &mut Scene) -> Option<String> {
    let patterns: Vec<String> = source.panes.iter().map(|pattern| pattern.trim().to_lowercase()).collect();
    if patterns.is_empty() {
        return None;
    }
    let mut used: BTreeSet<usize> = BTreeSet::new();
    let mut fitting = |name: &str| {
        let found: Vec<usize> = (0..patterns.len()).filter(|k| matches(&patterns[*k], &name.to_lowercase())).collect();
        used.extend(&found);
        !found.is_empty()
    };
    let by_material: Vec<bool> = scene.materials.iter().map(|material| fitting(&material.name)).collect();
    let by_part: Vec<bool> = scene.parts.iter().map(|part| fitting(&part.name)).collect();
    let (mut clear, mut count): (BTreeMap<u32, Option<u32>>, usize) = (BTreeMap::new(), 0);
    for (part, is_named) in scene.parts.iter_mut().zip(by_part) {
        if !(is_named || by_material[part.material as usize]) {
            continue;
        }
        let materials = &mut scene.materials;
        let pane = *clear.entry(part.material).or_insert_with(|| {
            let pane = pane(&materials[part.material as usize])?;
            materials.push(pane);
            Some(materials.len() as u32 - 1)
        });
        part.material = pane.unwrap_or(part.material);
        count += usize::from(pane.is_some());
    }
    let unused: Vec<String> = (0..patterns.len()).filter(|k| !used.contains(k)).map(|k| format!("{:?}", source.panes[k])).collect();
    let unused = if unused.is_empty() { String::new() } else { format!("; no part or material is called {}", unused.join(", ")) };
    Some(format!("{} became clear panes (panes){unused}", counted(count, "part")))
}

/// Says which opaque surfaces are called glass.
pub(super) fn lost(scene: &Scene) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for part in &scene.parts {
        let material = &scene.materials[part.material as usize];
        let called = [material.name.as_str(), part.name.as_str()];
        if called.iter().any(|name| is_opaque_on_purpose(name)) {
            continue;
        }
        let name = called.into_iter().find(|name| is_called_glass(name));
        names.extend(name.filter(|name| is_opaque(material) && !names.contains(name)));
    }
    let named: Vec<String> = names.iter().take(NAMED).map(|name| format!("{name:?}")).collect();
    let more = if names.len() > NAMED { format!(" and {} more", names.len() - NAMED) } else { String::new() };
    let plain: Vec<&str> = names.iter().copied().take(NAMED).filter(|name| !name.contains([',', '"'])).collect();
    (!names.is_empty()).then(|| {
        format!(
            "what is called {}{more} lets no light through: many exporters leave out that glass does; if it is clear, panes = [{}] (or --panes \
             \"{}\") makes panes of it; \"*\" matches any characters in names",
            named.join(", "),
            named.join(", "),
            plain.join(",")
        )
    })
}

/// Whether a name describes opaque glass.
fn is_opaque_on_purpose(name: &str) -> bool {
    words(name).iter().any(|word| OPAQUE.contains(&word.as_str()))
}

/// Whether a name ends with a word for glass, apart from words that may follow it: a glass table is a table.
fn is_called_glass(name: &str) -> bool {
    let words = words(name);
    let last = words.iter().rev().find(|word| !BEHIND.contains(&word.as_str()));
    last.is_some_and(|word| CALLED.contains(&word.as_str()))
}

/// Whether a surface lets no light through, and is neither a mirror nor a lamp.
fn is_opaque(material: &Material) -> bool {
    let reflects = match &material.bsdf {
        Bsdf::Diffuse { .. } | Bsdf::RoughDiffuse { .. } | Bsdf::Plastic { .. } => true,
        Bsdf::Principled(p) => p.metallic.factor < METAL,
        Bsdf::Disney(p) => p.metallic.factor < METAL,
        _ => false,
    };
    reflects && matches!(material.alpha, Alpha::Opaque) && !material.bsdf.transmits() && material.emission.factor.is_black()
}

/// A clear pane in the place of an opaque material; `None` of one that lets light through by itself.
fn pane(material: &Material) -> Option<Material> {
    let color = match &material.bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } | Bsdf::Conductor { reflectance, .. } => reflectance,
        Bsdf::Plastic { diffuse, .. } => diffuse,
        Bsdf::Principled(p) if !material.bsdf.transmits() => &p.base_color,
        Bsdf::Disney(p) if !material.bsdf.transmits() => &p.base_color,
        Bsdf::Dielectric { .. } | Bsdf::ThinDielectric { .. } | Bsdf::Blend { .. } | Bsdf::Principled(_) | Bsdf::Disney(_) => return None,
    };
    let alpha = match &material.alpha {
        mask @ Alpha::Mask { .. } => *mask,
        Alpha::Opaque | Alpha::Blend { .. } => Alpha::Opaque,
    };
    let bsdf = Bsdf::ThinDielectric { eta: GLASS, transmittance: tinted(color) };
    Some(Material { bsdf, alpha, normal_map: None, ..material.clone() })
}

/// Transmittance of a pane of a colour: exporters write black, grey or white for clear glass, so grey is ignored, and half of a colour is
/// kept.
fn tinted(color: &ColorParam) -> ColorParam {
    let Rgb { r, g, b } = color.factor;
    let most = r.max(g).max(b);
    if color.texture.is_some() || most <= 0.0 {
        return Rgb::WHITE.into();
    }
    color.factor.map(|c| 0.5 + 0.5 * c / most).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_is_told_by_the_end_of_names_in_several_languages() {
        for name in ["Glass", "window_glass.001", "Glass_Mesh052", "GlassPanel", "WindowPane", "Fensterscheibe_2", "стекло", "Glass Clear"]
        {
            assert!(is_called_glass(name), "{name}");
        }
        for name in ["glass_table", "window", "glass frame", "fibreglass", "Glasses", "panel", "", "grass"] {
            assert!(!is_called_glass(name), "{name}");
        }
    }

    #[test]
    fn black_and_opal_glass_is_opaque_on_purpose() {
        assert!(["black glass", "Opal_Glass.002", "mat_milkGlass"].into_iter().all(is_opaque_on_purpose));
        assert!(!["Glass", "window_glass_tinted", "backdoor glass"].into_iter().any(is_opaque_on_purpose));
    }

    #[test]
    fn grey_glass_is_clear_and_coloured_glass_keeps_half_of_its_colour() {
        let tint = |r, g, b| tinted(&Rgb::new(r, g, b).into()).factor;
        assert_eq!([tint(0.0, 0.0, 0.0), tint(0.8, 0.8, 0.8)], [Rgb::WHITE; 2]);
        assert_eq!(tint(0.0, 0.4, 0.2), Rgb::new(0.5, 1.0, 0.75));
    }
}
