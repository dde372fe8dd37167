//! Furniture libraries of Sweet Home 3D (`.sh3f`) as models: `enfilade_import::sweethome` reads them.
//!
//! Doors, windows and staircases are left out, as are outdoor pieces, vehicles and people.

use super::notes::Notes;
use super::table::{Front, Table};
use crate::error::Error;
use enfilade_furniture::models::{Body, Bulb, Model};
use enfilade_import::sweethome::{CatalogueKind, CatalogueLight, CataloguePiece, catalogue};
use enfilade_math::{DMat3, Vec3};
use enfilade_scene::Cx;
use std::path::PathBuf;
use std::sync::Arc;

/// Categories whose pieces are not furniture of a home.
const ELSEWHERE: [&str; 5] = ["doors and windows", "exterior", "vehicles", "characters", "staircases"];

/// A piece of a library.
pub(super) struct Piece {
    /// By which `assets.toml` knows it: its id, or its name.
    pub name: String,
    archive: PathBuf,
    piece: CataloguePiece,
}

/// The pieces of these libraries that homes could use.
pub(super) fn pieces(catalogues: &[&PathBuf]) -> Result<Vec<Piece>, Error> {
    let wanted = |kind: CatalogueKind| {
        let elsewhere = ELSEWHERE.contains(&kind.category.to_lowercase().as_str());
        !(elsewhere || kind.is_opening || kind.is_staircase)
    };
    let mut all = Vec::new();
    for file in catalogues {
        let found =
            catalogue(file, wanted).map_err(|error| Error::usage(error.to_string(), "repair the catalogue, or download it again"))?;
        let named = |piece: CataloguePiece| Piece {
            name: piece.id.clone().unwrap_or_else(|| piece.title.clone()),
            archive: (*file).clone(),
            piece,
        };
        all.extend(found.into_iter().map(named));
    }
    Ok(all)
}

/// A light source in the space of furniture: x to the left for someone who looks at its front, y to the front.
fn bulb(light: &CatalogueLight, size: Vec3) -> Bulb {
    let at = Vec3::new(0.5 * size.x - light.at.x, 0.5 * size.y - light.at.y, light.at.z);
    Bulb { at, diameter: light.diameter }
}

impl Piece {
    /// The model, which is read when it is used; anything dropped or guessed then is added to `notes`.
    pub fn model(self, table: &Table, notes: Notes) -> Model {
        let choice = table.of(&self.name);
        let families = choice.families_or(&self.piece.title);
        let front = choice.front;
        let size = choice.size.unwrap_or_else(|| front.turned(self.piece.size));
        let archive = self.archive.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let (title, elevation, shines) = (self.piece.title.clone(), self.piece.elevation, !self.piece.lights.is_empty());
        let file = format!("{archive}, {}", self.name);
        let licence = choice.licence.clone().unwrap_or_else(|| self.piece.licence.clone());
        let mut model = Model::new(title, size, families, Box::new(move || self.read(front, size, &notes).map(Arc::new)));
        (model.file, model.licence) = (file, licence);
        (model.elevation, model.shines, model.weight) = (elevation, shines, choice.weight);
        model
    }

    /// Mesh and materials of the model.
    fn read(&self, front: Front, size: Vec3, notes: &Notes) -> Result<Body, String> {
        let imported = self.piece.load(&self.archive).map_err(|error| error.to_string())?;
        imported.report.warnings.into_iter().for_each(|warning| notes.warn(warning));
        // The model and its rotation have y up, furniture z.
        let up = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0]);
        let rotation = up * self.piece.rotation.unwrap_or(DMat3::IDENTITY);
        let place = format!("{}: {}", self.archive.display(), self.piece.model);
        let mut body = Body::new(imported.scene, front.turn() * rotation, Some(size)).map_err(|problem| format!("{place}: {problem}"))?;
        let turned = (front.turn() * Front::Z.turn().transpose()).as_mat3();
        let own = front.turned(self.piece.size);
        let moved = |light: &CatalogueLight| {
            let bulb = bulb(light, self.piece.size);
            Bulb { at: (turned * bulb.at) * size / own, ..bulb }
        };
        body.bulbs = self.piece.lights.iter().map(moved).collect();
        Ok(body)
    }
}
