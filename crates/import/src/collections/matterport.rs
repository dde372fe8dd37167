//! Scans of Matterport3D: `<house>.house` with `<house>_semantic.ply` in the layout of Habitat, or `<house>.ply` of the dataset's own
//! `house_segmentations`.
//!
//! Made from Matterport3D's `data_organization.md`, which describes `.house`, and habitat-sim's `Mp3dSemanticScene.cpp`. Metres, z up.
//!
//! | in the files | what becomes of it |
//! |---|---|
//! | lines `C` | categories: the name in `mpcat40`, which has a class where NYU40 has one, else the annotators' own |
//! | lines `O` | objects and their categories |
//! | lines `E` | which object a segment belongs to, if faces have segments |
//! | the mesh | the faces of each `object_id` or `segment_id` as one part, in the mean of its colours |
//! | regions, panoramas, images | not used |
//! | the textured mesh (`.glb`, `matterport_mesh/*.obj`) | has no objects; import it by itself if pictures matter more than labels |

use super::objects::Objects;
use super::scan;
use crate::assembly::Assembly;
use crate::classes::class_of;
use crate::{ImportError, Imported, UpAxis};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The objects of a `.house` file.
#[derive(Default)]
struct House {
    categories: HashMap<i64, String>,
    /// Category by object.
    objects: HashMap<i64, i64>,
    /// Object by segment.
    segments: HashMap<i64, i64>,
}

/// Imports a scan by its `.house` file.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let house = parse(&enfilade_scene::decoded_text(bytes)).map_err(|(line, problem)| a.malformed(format!("line {line}"), problem))?;
    let Some(mesh) = mesh_beside(&file) else {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let problem =
            format!("found neither {stem}_semantic.ply nor {stem}.ply beside it, which hold the faces; unpack the collection again");
        return Err(a.malformed("whole file", problem));
    };
    a.set_units(1.0, UpAxis::Z);
    let category = |id: i64| {
        let object = house.segments.get(&id).copied().unwrap_or(id);
        (object, house.objects.get(&object).and_then(|category| house.categories.get(category)).cloned())
    };
    let mut objects = Objects::default();
    scan::add(&mesh, &category, &mut objects, &mut a)?;
    objects.finish(&mut a);
    a.finish()
}

/// The annotated mesh of a house.
fn mesh_beside(file: &Path) -> Option<PathBuf> {
    let stem = file.file_stem()?.to_string_lossy();
    [format!("{stem}_semantic.ply"), format!("{stem}.ply")].into_iter().map(|name| file.with_file_name(name)).find(|mesh| mesh.is_file())
}

/// The lines of categories, objects and segments; or a line and what is wrong with it.
fn parse(text: &str) -> Result<House, (usize, String)> {
    let mut house = House::default();
    if !text.starts_with("ASCII") && !text.trim_start().starts_with("H ") {
        return Err((1, "found no house of Matterport3D, which begins with ASCII or H; unpack the collection again".into()));
    }
    for (i, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |k: usize| {
            let word = words.get(k).copied().unwrap_or_default();
            word.parse::<i64>()
                .map_err(|_| (i + 1, format!("found {word:?} as word {k}, expected a whole number; unpack the collection again")))
        };
        match words.first() {
            // C category_index label_id label_name mpcat40_id mpcat40_name; `#` means a space.
            Some(&"C") => {
                let name = |k: usize| words.get(k).map(|word| word.replace('#', " "));
                let (own, common) = (name(3), name(5));
                let known = [&common, &own].into_iter().flatten().find(|name| class_of(name).is_some());
                if let Some(category) = known.or(own.as_ref()).or(common.as_ref()) {
                    house.categories.insert(number(1)?, category.clone());
                }
            }
            Some(&"O") => drop(house.objects.insert(number(1)?, number(3)?)),
            Some(&"E") => drop(house.segments.insert(number(3)?, number(2)?)),
            _ => (),
        }
    }
    Ok(house)
}
