//! A scene being read: the graphics state, what directives have defined, and what has been made of it so far.

use super::definition::{MaterialDefinition, TextureDefinition};
use super::made::{BakeKey, Placed, Shape, Surface};
use super::params::{Params, Place};
use super::state::{Saved, State};
use super::version::Version;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3, Rgb};
use std::collections::HashMap;
use std::path::PathBuf;

/// Materials or textures within each other deeper than this are taken for a cycle.
pub(super) const MAX_REFERENCES: usize = 32;

/// A scene being read.
pub(super) struct Reader<'a> {
    pub a: Assembly<'a>,
    pub version: Version,
    pub state: State,
    pub saved: Vec<Saved>,
    /// The file's axes from pbrt's world: the identity, or a mirror.
    pub file_from_world: DAffine3,
    pub coordinate_systems: HashMap<String, DAffine3>,
    pub film: Option<Params>,
    pub camera: Option<(Params, String, DAffine3)>,
    pub in_world: bool,
    pub textures: Vec<TextureDefinition>,
    /// Names of textures to indices: of colours, and of numbers.
    pub texture_names: [HashMap<String, usize>; 2],
    pub baked: HashMap<BakeKey, u32>,
    pub baked_texels: usize,
    pub materials: Vec<MaterialDefinition>,
    pub material_names: HashMap<String, usize>,
    pub surfaces: HashMap<usize, Surface>,
    pub finished: HashMap<String, Option<u32>>,
    pub media: HashMap<String, Rgb>,
    /// By file or measures, and whether they are turned inside out.
    pub meshes: HashMap<(String, bool), Option<Shape>>,
    pub objects: HashMap<String, Vec<Placed>>,
    /// The object being defined, if any.
    pub object: Option<(String, Vec<Placed>)>,
    pub parts: usize,
    pub including: Vec<PathBuf>,
    pub included: usize,
    pub next_light: usize,
}

impl<'a> Reader<'a> {
    /// Begins a scene of a version, of which nothing has been read.
    pub(super) fn new(a: Assembly<'a>, version: Version) -> Self {
        Self {
            a,
            version,
            state: State::new(),
            saved: Vec::new(),
            file_from_world: DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
            coordinate_systems: HashMap::new(),
            film: None,
            camera: None,
            in_world: false,
            textures: Vec::new(),
            texture_names: [HashMap::new(), HashMap::new()],
            baked: HashMap::new(),
            baked_texels: 0,
            materials: vec![MaterialDefinition::default_of(version)],
            material_names: HashMap::new(),
            surfaces: HashMap::new(),
            finished: HashMap::new(),
            media: HashMap::new(),
            meshes: HashMap::new(),
            objects: HashMap::new(),
            object: None,
            parts: 0,
            including: Vec::new(),
            included: 0,
            next_light: 0,
        }
    }

    /// Warns of what was dropped or guessed at a place.
    pub(super) fn warn(&mut self, place: &Place, message: impl Into<String>) {
        self.a.warn(place.text(), message);
    }

    /// Warns of the parameters that nothing asked for, except for those in `silent`.
    pub(super) fn report_unused(&mut self, params: &Params, silent: &[&str]) {
        let names: Vec<String> = params.unused().map(|p| p.name.clone()).filter(|n| !silent.contains(&n.as_str())).collect();
        if !names.is_empty() {
            self.warn(&params.place, format!("ignored: {}", names.join(", ")));
        }
    }
}
