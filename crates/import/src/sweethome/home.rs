//! `Home.xml`: levels, walls, rooms, furniture, ground, cameras.

use super::opening::Opening;
use super::paint::Paint;
use super::piece::{self, Models};
use super::surface::Surface;
use super::wall::{self, Wall, Walls};
use super::xml::Element;
use super::{room, view};
use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_scene::PartLabel;
use std::collections::HashMap;

/// Metres per centimetre.
const METRES: f64 = 0.01;
/// Height of walls that neither they nor the home state, centimetres.
const WALL_HEIGHT: f64 = 250.0;
/// Groups within groups.
const DEEPEST: usize = 64;

/// A storey, in centimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    pub elevation: f64,
    pub floor_thickness: f64,
    pub height: f64,
    pub shown: bool,
}

/// A home in the making.
pub(super) struct Home<'h, 'a> {
    pub a: Assembly<'a>,
    pub archive: &'a Archive,
    pub models: Models,
    levels: HashMap<&'h str, Level>,
    /// Height of walls that do not state their own, centimetres.
    pub wall_height: f64,
    /// Materials of models with another colour or picture.
    pub repainted: HashMap<String, u32>,
    materials: HashMap<String, u32>,
    unknown_levels: usize,
}

/// Imports the home that `text` describes. `a` is the assembly of `Home.xml` within the archive.
pub(super) fn load<'a>(text: &str, archive: &'a Archive, mut a: Assembly<'a>) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let options = roxmltree::ParsingOptions { allow_dtd: false, ..roxmltree::ParsingOptions::default() };
    let document = roxmltree::Document::parse_with_options(text, options).map_err(|e| {
        a.malformed(format!("line {}:{}", e.pos().row, e.pos().col), format!("not well-formed XML: {e}; save the home again"))
    })?;
    let root = Element::new(document.root_element(), &file);
    if root.tag() != "home" {
        return Err(root.error("expected <home>; is it a file of Sweet Home 3D?"));
    }
    a.state_space(METRES, DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
    let mut levels = HashMap::new();
    for element in root.children().filter(|e| e.tag() == "level") {
        let Some(id) = element.text("id") else { return Err(element.error("the level has no id; save the home again")) };
        levels.insert(id, read_level(element)?);
    }
    let mut home = Home {
        a,
        archive,
        models: Models::default(),
        levels,
        wall_height: root.number_or("wallHeight", WALL_HEIGHT)?,
        repainted: HashMap::new(),
        materials: HashMap::new(),
        unknown_levels: 0,
    };
    home.report_ignored(&root);
    let mut pieces = Vec::new();
    piece::collect(&root, None, DEEPEST, &mut home, &mut pieces)?;
    let mut openings = Vec::new();
    for piece in pieces.iter().filter(|p| p.is_opening) {
        openings.push(Opening::read(piece.element, piece.base + piece.element.number_or("elevation", 0.0)?, &mut home.a)?);
    }
    let walls = home.walls(&root)?;
    for index in 0..walls.list.len() {
        wall::add(&walls, index, &openings, &mut home)?;
    }
    room::add_all(&root, &walls, &pieces, &mut home)?;
    let total = pieces.len();
    for (done, piece) in pieces.iter().enumerate() {
        home.a.progress(done + 1, total);
        piece::add(piece, &root, &mut home)?;
    }
    view::add(&root, &walls, &mut home)?;
    if home.unknown_levels > 0 {
        let message = format!("{} things are on levels that do not exist; they were put on the ground", home.unknown_levels);
        home.a.warn("<home>", message);
    }
    home.a.finish()
}

fn read_level(element: Element) -> Result<Level, ImportError> {
    Ok(Level {
        elevation: element.required("elevation")?,
        floor_thickness: element.number_or("floorThickness", 0.0)?.max(0.0),
        height: element.number_or("height", WALL_HEIGHT)?,
        shown: element.flag("visible", true) && element.flag("viewable", true),
    })
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

    /// True for what is on no level or on one that is shown.
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

    /// True when some level lies below the ground.
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

    fn walls(&mut self, root: &Element<'h>) -> Result<Walls<'h>, ImportError> {
        let mut list = Vec::new();
        for element in root.children().filter(|e| e.tag() == "wall") {
            let id = element.text("level");
            self.unknown_levels += usize::from(id.is_some() && self.level(id).is_none());
            if !self.shows(id) {
                continue;
            }
            let elevation = self.elevation_of(id);
            // Walls of upper levels reach down to the ceiling below.
            let bottom = self.level(id).filter(|l| !self.is_lowest(*l)).map_or(elevation, |l| elevation - l.floor_thickness);
            match Wall::read(element, elevation, bottom, self.wall_height)? {
                Some(wall) => list.push(wall),
                None => self.a.warn(element.place(), "the wall has no length, height or thickness and was left out"),
            }
        }
        Ok(Walls::new(list))
    }

    fn report_ignored(&mut self, root: &Element<'h>) {
        let hidden = self.levels.values().filter(|l| !l.shown).count();
        if hidden > 0 {
            self.a.warn("<level>", format!("{hidden} levels are hidden; what is on them was left out"));
        }
        for (tag, what) in [("polyline", "lines"), ("dimensionLine", "dimension lines"), ("label", "labels")] {
            let count = root.children().filter(|e| e.tag() == tag).count();
            if count > 0 {
                self.a.warn(format!("<{tag}>"), format!("{count} {what} of the plan have no surface and were left out"));
            }
        }
    }
}
