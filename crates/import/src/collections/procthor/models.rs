//! The models of objects, doors and windows, and boxes where there are none.

use super::super::assets::{Model, Models, unless_odd};
use super::super::json;
use super::super::listed::Listed;
use super::super::objects::Objects;
use super::house::{Opening, Thing};
use super::space::{MIRROR, turn};
use crate::ImportError;
use crate::assembly::{Assembly, Piece};
use crate::primitives;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use enfilade_scene::{Material, PartLabel};
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Folders in which the models are sought.
const FOLDERS: [&str; 4] = ["procthor-assets", "assets", "models", "objects"];
/// Number of folders above the house's in which those are sought.
const ABOVE: usize = 3;
/// ProcTHOR's table of its assets.
const TABLE: &str = "asset-database.json";
/// Assets that a warning names.
const NAMED: usize = 6;

/// A row of the table.
#[derive(Deserialize)]
struct Asset {
    #[serde(rename = "assetId")]
    id: String,
    #[serde(rename = "boundingBox")]
    size: Option<super::house::Xyz>,
    #[serde(rename = "objectType")]
    kind: Option<String>,
}

/// Assets that are available.
pub(super) struct Library {
    folders: Vec<PathBuf>,
    models: Models,
    assets: HashMap<String, Asset>,
    cube: Option<Piece>,
    /// Assets that became boxes or were left out, and how often.
    boxes: BTreeMap<String, usize>,
    lost: BTreeMap<String, usize>,
    /// Doors and windows without a model.
    bare: usize,
}

impl Library {
    /// The library of models beside the house and in the folders above.
    ///
    /// # Errors
    /// When the table of assets cannot be read.
    pub fn beside(house: &Path, a: &mut Assembly) -> Result<Self, ImportError> {
        let mut folder = house.parent().map(Path::to_path_buf).unwrap_or_default();
        let (mut folders, mut assets) = (Vec::new(), HashMap::new());
        for _ in 0..=ABOVE {
            folders.extend(FOLDERS.map(|name| folder.join(name)).into_iter().filter(|place| place.is_dir()));
            let table = folder.join(TABLE);
            if assets.is_empty() && table.is_file() {
                let bytes = a.read_input(&table, "check the permission to read it")?;
                let by_kind = json::parse::<BTreeMap<String, Listed<Asset>>>(&bytes, &table, "ProcTHOR's table of assets");
                let by_kind = unless_odd(by_kind, "objects", "the table of assets", a)?.unwrap_or_default();
                by_kind.iter().for_each(|(kind, list)| list.report(&format!("{}: {kind}", table.display()), a));
                assets = by_kind.into_values().flat_map(Listed::into_vec).map(|asset| (asset.id.clone(), asset)).collect();
            }
            folder = folder.join("..");
        }
        let (boxes, lost) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { folders, models: Models::default(), assets, cube: None, boxes, lost, bare: 0 })
    }

    /// The model of an asset, where it is available.
    fn model(&mut self, asset: &str, a: &mut Assembly) -> Result<Option<Rc<Model>>, ImportError> {
        let is_name = !asset.is_empty() && !asset.contains(['/', '\\']) && asset != "..";
        let named = |folder: &PathBuf| {
            let places = [folder.clone(), folder.join(asset)];
            places.into_iter().flat_map(|place| ["glb", "gltf", "obj"].map(|end| place.join(format!("{asset}.{end}")))).collect::<Vec<_>>()
        };
        let file = self.folders.iter().filter(|_| is_name).flat_map(named).find(|file| file.is_file());
        file.map_or(Ok(None), |file| self.models.get(&file, a))
    }

    /// Adds an object.
    pub fn thing(&mut self, thing: &Thing, objects: &mut Objects, a: &mut Assembly) -> Result<(), ImportError> {
        let Some(position) = thing.position else { return Ok(()) };
        let asset = thing.asset.as_str();
        let of_id = thing.id.split('|').next().filter(|kind| !kind.is_empty()).map(str::to_string);
        let kind = self.assets.get(asset).and_then(|asset| asset.kind.clone()).or(of_id);
        let (middle, turn) = (position.point(), turn(thing.rotation));
        if let Some(model) = self.model(asset, a)? {
            let object = objects.next(kind.as_deref(), asset);
            object.place(&model.pieces, standing(&model, middle, turn, a), a);
            return Ok(());
        }
        match self.assets.get(asset).and_then(|asset| asset.size) {
            Some(size) => {
                *self.boxes.entry(asset.to_string()).or_default() += 1;
                let cube = self.cube(a)?;
                let half = DAffine3::from_scale(0.5 * size.point().max(DVec3::splat(1e-3)));
                objects.next(kind.as_deref(), asset).place(&cube, mirrored(middle, turn) * half, a);
            }
            None => *self.lost.entry(asset.to_string()).or_default() += 1,
        }
        Ok(())
    }

    /// Adds the frame and leaf of a door or window, where there is a model of it.
    pub fn opening(
        &mut self,
        opening: &Opening,
        middle: DVec3,
        turn: DMat3,
        objects: &mut Objects,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let Some(model) = self.model(&opening.asset, a)? else {
            self.bare += 1;
            return Ok(());
        };
        let kind = opening.id.split('|').next();
        objects.next(kind, &opening.asset).place(&model.pieces, standing(&model, middle, turn, a), a);
        Ok(())
    }

    /// A grey cube from −1 to 1.
    fn cube(&mut self, a: &mut Assembly) -> Result<Vec<Piece>, ImportError> {
        if self.cube.is_none() {
            let file = a.file().to_path_buf();
            let material = a.push_material(Material::diffuse("box", Rgb::splat(0.5)));
            let mesh = a.push_mesh(primitives::cube(), &file, "box")?;
            let piece = |mesh| Piece {
                name: "box".into(),
                mesh,
                material,
                model_from_mesh: DAffine3::IDENTITY,
                object: None,
                label: PartLabel::NONE,
            };
            self.cube = mesh.map(piece);
        }
        Ok(self.cube.iter().cloned().collect())
    }

    /// Reports what has no model.
    pub fn finish(self, a: &mut Assembly) {
        let named = |of: &BTreeMap<String, usize>| of.keys().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
        let at_hand = format!("a folder {} beside the house or in the {ABOVE} folders above", FOLDERS.join(", "));
        if !self.boxes.is_empty() {
            let objects: usize = self.boxes.values().sum();
            a.warn(
                "objects",
                format!("{objects} objects are boxes, because their models are not in {at_hand}, such as {}", named(&self.boxes)),
            );
        }
        if !self.lost.is_empty() {
            let objects: usize = self.lost.values().sum();
            let message = format!(
                "{objects} objects were left out, because neither their models are in {at_hand}, nor their sizes in an {TABLE} there, such as {}",
                named(&self.lost)
            );
            a.warn("objects", message);
        }
        if self.bare > 0 {
            a.warn("doors and windows", format!("{} openings are bare holes, because their models are not in {at_hand}", self.bare));
        }
    }
}

/// A place in Unity's axes, in right-handed ones.
fn mirrored(middle: DVec3, turn: DMat3) -> DAffine3 {
    let mirror = DMat3::from_diagonal(MIRROR);
    DAffine3::from_mat3_translation(mirror * turn * mirror, middle * MIRROR)
}

/// The placement of a model whose box has its middle at a point.
fn standing(model: &Model, middle: DVec3, turn: DMat3, a: &Assembly) -> DAffine3 {
    let (min, max) = model.bounds_at(DAffine3::IDENTITY, a);
    let center = if min.is_finite() && max.is_finite() { 0.5 * (min + max) } else { DVec3::ZERO };
    mirrored(middle, turn) * DAffine3::from_translation(-center)
}
