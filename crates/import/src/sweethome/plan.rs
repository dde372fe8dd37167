//! `Home.xml` read from top to bottom: levels, walls, rooms, ground, furniture, cameras.

use super::home::{Home, Level};
use super::model::Models;
use super::opening::Opening;
use super::outline::{Wall, Walls};
use super::xml::Element;
use super::{piece, room, view, wall};
use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DMat3, DVec3};
use std::collections::HashMap;

/// Metres per centimetre.
const METRES: f64 = 0.01;
/// Height of walls that neither they nor the home state, centimetres.
const WALL_HEIGHT: f64 = 250.0;
/// Greatest depth of groups within groups.
const MAX_DEPTH: usize = 64;

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
    piece::collect(&root, None, MAX_DEPTH, &mut home, &mut pieces)?;
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
    /// The walls of all levels that are shown.
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
