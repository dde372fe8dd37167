//! A home being built: its levels, and what has been made of its models and paints.

use super::model::Models;
use super::paint::Paint;
use super::surface::Surface;
use crate::ImportError;
use crate::archive::Archive;
use crate::assembly::Assembly;
use enfilade_math::DAffine3;
use enfilade_scene::PartLabel;
use std::collections::HashMap;

/// A storey, in centimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    pub elevation: f64,
    pub floor_thickness: f64,
    pub height: f64,
    pub shown: bool,
}

/// A home being built.
pub(super) struct Home<'h, 'a> {
    pub a: Assembly<'a>,
    pub archive: &'a Archive,
    pub models: Models,
    pub levels: HashMap<&'h str, Level>,
    /// Height of walls that do not state their own, centimetres.
    pub wall_height: f64,
    /// Materials of models with another colour or picture.
    pub repainted: HashMap<String, u32>,
    pub materials: HashMap<String, u32>,
    pub unknown_levels: usize,
}

impl<'h> Home<'h, '_> {
    /// The level that an element names; `None` where it names none.
    pub fn level(&self, id: Option<&str>) -> Option<Level> {
        self.levels.get(id?).copied()
    }

    /// Height of a level's floor.
    pub fn elevation_of(&self, id: Option<&str>) -> f64 {
        self.level(id).map_or(0.0, |l| l.elevation)
    }

    /// True for things on no level or on a visible one.
    pub fn shows(&self, id: Option<&str>) -> bool {
        self.level(id).is_none_or(|l| l.shown)
    }

    /// True for the lowest level, and for homes without levels.
    pub fn is_lowest(&self, level: Level) -> bool {
        self.levels.values().all(|l| l.elevation >= level.elevation)
    }

    /// True for the highest level, and for homes without levels.
    pub fn is_highest(&self, level: Level) -> bool {
        self.levels.values().all(|l| l.elevation <= level.elevation)
    }

    /// True when some level is below the ground.
    pub fn has_cellar(&self) -> bool {
        self.levels.values().any(|l| l.elevation < 0.0)
    }

    /// Adds a part of faces with a paint; nothing where there are no faces.
    pub fn push(&mut self, name: &str, surface: Surface, paint: Paint) -> Result<(), ImportError> {
        let Some(mesh) = surface.finish() else { return Ok(()) };
        let (key, named) = paint.key();
        let material = match self.materials.get(&key) {
            Some(&known) => known,
            None => {
                let material = paint.material(&named, &mut self.a)?;
                let index = self.a.push_material(material);
                self.materials.insert(key, index);
                index
            }
        };
        let file = self.a.file().to_path_buf();
        if let Some(mesh) = self.a.push_mesh(mesh, &file, name)? {
            self.a.push_part(name, mesh, material, DAffine3::IDENTITY, PartLabel::NONE);
        }
        Ok(())
    }
}
