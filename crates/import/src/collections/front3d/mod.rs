//! Houses of 3D-FRONT with the furniture of 3D-FUTURE.
//!
//! Made from the code of 3D-FRONT's toolbox (`scripts/scene.py` and `scripts/utils.py` of 3D-FRONT-ToolBox), which reads them. Houses are in
//! metres with y up. The folders `3D-FUTURE-model` and `3D-FRONT-texture` are looked for beside the house's file and in the three folders
//! above.
//!
//! | in the file | what becomes of it |
//! |---|---|
//! | `scene.room[].children` | each a piece of furniture or a mesh, by `ref`: scaled by `scale`, turned by `rot` (a quaternion x y z w), moved to `pos` |
//! | `furniture` | the model `<jid>/raw_model.obj`, if it is `valid`; its category is `category` of `model_info.json`, else the `super-category` there, else the house's own |
//! | `mesh` | `xyz`, `normal`, `uv`, `faces`, as `<type> (<room>)`; the class by its type: walls, floors, ceilings, doors, windows and what is built in |
//! | `material` | the picture `<jid>/texture.png` with the linear part of `UVTransform`, as in the toolbox; where that is not available, `color`; else grey |
//! | `lights` | rectangles and spheres (`VRayLight`) with place, size, strength and temperature, and the sun (`VraySun`) with a sky; others are left out, with a warning |
//! | `extension`, `groups` | not used |

pub(crate) mod house;
mod lights;
mod surface;

use super::assets::{Models, unless_odd};
use super::json;
use super::listed::Listed;
use super::objects::Objects;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, DQuat};
use enfilade_scene::PartLabel;
use house::{Child, Furniture, House};
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use surface::{PICTURES, Placed, Surfaces};

/// The folder of models.
const MODELS: &str = "3D-FUTURE-model";
/// Number of folders above the house's in which they are sought.
const ABOVE: usize = 3;
/// Models that a warning names.
const NAMED: usize = 6;

/// A row of `model_info.json`.
#[derive(Deserialize)]
struct Info {
    model_id: String,
    category: Option<String>,
    #[serde(rename = "super-category")]
    super_category: Option<String>,
}

/// Imports a house.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let house: House = json::parse(bytes, &file, "a house of 3D-FRONT")?;
    let folder = folder_above(&file, MODELS);
    let categories = categories(folder.as_deref(), &mut a)?;
    let furniture: HashMap<&str, &Furniture> = house.furniture.iter().map(|f| (f.uid.as_str(), f)).collect();
    let mut placer = Placer {
        folder,
        categories,
        furniture,
        surfaces: Surfaces::new(&house, folder_above(&file, PICTURES)),
        models: Models::default(),
        objects: Objects::default(),
        lost: BTreeMap::new(),
        wanted: 0,
        unknown: 0,
    };
    house.furniture.report("furniture", &mut a);
    house.mesh.report("mesh", &mut a);
    house.material.report("material", &mut a);
    house.scene.room.report("scene.room", &mut a);
    for (i, room) in house.scene.room.iter().enumerate() {
        a.progress(i + 1, house.scene.room.len());
        room.children.report(&format!("scene.room {:?}", room.instanceid), &mut a);
        for child in &room.children {
            placer.child(child, &room.instanceid, &mut a)?;
        }
    }
    lights::add(&house.lights, &mut a)?;
    placer.finish(&mut a);
    a.finish()
}

struct Placer<'h> {
    folder: Option<PathBuf>,
    categories: HashMap<String, String>,
    furniture: HashMap<&'h str, &'h Furniture>,
    surfaces: Surfaces<'h>,
    models: Models,
    objects: Objects,
    /// Models that are not available, and of how many pieces.
    lost: BTreeMap<&'h str, usize>,
    /// Pieces of furniture in the rooms.
    wanted: usize,
    /// References to nothing.
    unknown: usize,
}

impl<'h> Placer<'h> {
    fn child(&mut self, child: &Child, room: &str, a: &mut Assembly) -> Result<(), ImportError> {
        let [x, y, z, w] = child.rot;
        let turn = DQuat::from_xyzw(x, y, z, w);
        let turn = if turn.is_finite() && turn.length() > 1e-9 { turn.normalize() } else { DQuat::IDENTITY };
        let placement = DAffine3::from_scale_rotation_translation(child.scale, turn, child.pos);
        let id = child.r#ref.as_str();
        if let Some(&furniture) = self.furniture.get(id) {
            return if furniture.valid { self.piece(furniture, placement, a) } else { Ok(()) };
        }
        let Some(Placed { class, name, mesh, material }) = self.surfaces.get(id, room, a)? else {
            self.unknown += usize::from(!self.surfaces.knows(id));
            return Ok(());
        };
        match class {
            Some(class) => {
                let object = self.objects.of_class(class, &name);
                a.push_part(&object.name, mesh, material, placement, object.label);
            }
            None => a.push_part(&name, mesh, material, placement, PartLabel::NONE),
        }
        Ok(())
    }

    fn piece(&mut self, furniture: &'h Furniture, placement: DAffine3, a: &mut Assembly) -> Result<(), ImportError> {
        self.wanted += 1;
        let file = self.folder.as_ref().map(|folder| folder.join(&furniture.jid).join("raw_model.obj"));
        let model = match file {
            Some(file) if file.is_file() => self.models.get(&file, a)?,
            Some(file) => {
                a.note_missing(&file);
                None
            }
            None => None,
        };
        let Some(model) = model else {
            *self.lost.entry(furniture.jid.as_str()).or_default() += 1;
            return Ok(());
        };
        let own = furniture.category.as_deref();
        let category = self.categories.get(&furniture.jid).map(String::as_str).or(own);
        self.objects.next(category, &furniture.jid).place(&model.pieces, placement, a);
        Ok(())
    }

    fn finish(self, a: &mut Assembly) {
        self.objects.finish(a);
        if self.unknown > 0 {
            a.warn("scene.room", format!("{} children of rooms refer to nothing in the file; they were left out", self.unknown));
        }
        if self.lost.is_empty() {
            return;
        }
        let pieces: usize = self.lost.values().sum();
        let all = self.wanted;
        let message = match &self.folder {
            None => format!(
                "no folder {MODELS} is beside the house or in the {ABOVE} folders above; its {pieces} pieces of furniture were left out"
            ),
            Some(folder) => {
                let named: Vec<&str> = self.lost.keys().take(NAMED).copied().collect();
                let models = self.lost.len();
                format!(
                    "{pieces} of {all} pieces of furniture were left out, because {models} models are not in {}, such as {}",
                    folder.display(),
                    named.join(", ")
                )
            }
        };
        a.warn("furniture", message);
    }
}

/// The folder of this name beside a file, or in one of the folders above.
fn folder_above(file: &Path, name: &str) -> Option<PathBuf> {
    let mut folder = file.parent().map(Path::to_path_buf).unwrap_or_default();
    for _ in 0..=ABOVE {
        let found = folder.join(name);
        if found.is_dir() {
            return Some(found);
        }
        folder = folder.join("..");
    }
    None
}

/// The categories of models, by what they are called.
fn categories(folder: Option<&Path>, a: &mut Assembly) -> Result<HashMap<String, String>, ImportError> {
    let Some(file) = folder.map(|folder| folder.join("model_info.json")) else { return Ok(HashMap::new()) };
    if !file.is_file() {
        a.note_missing(&file);
        a.warn("furniture", format!("{} is not there; the categories of furniture are those of the house, if it has any", file.display()));
        return Ok(HashMap::new());
    }
    let bytes = a.read_input(&file, "check the permission to read it")?;
    let list = json::parse::<Listed<Info>>(&bytes, &file, "the list of models of 3D-FUTURE");
    let list = unless_odd(list, "furniture", "the list of models", a)?.unwrap_or_default();
    list.report(&file.display().to_string(), a);
    let category = |info: &Info| info.category.clone().or(info.super_category.clone());
    Ok(list.iter().filter_map(|info| Some((info.model_id.clone(), category(info)?))).collect())
}
