//! The report of an import: counts of what the scene contains, and warnings for all that was dropped or guessed.

use crate::Format;
use crate::kinds::by_kind;
use enfilade_scene::{Cx, Scene, Warning};
use serde::Serialize;
use std::collections::HashSet;
use std::fmt;

/// Counts of an imported scene's contents.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Visible parts.
    pub parts: usize,
    /// Meshes; parts may share them.
    pub meshes: usize,
    /// Triangles of all parts, shared meshes counted once per part.
    pub triangles: usize,
    /// Materials.
    pub materials: usize,
    /// Materials that emit light.
    pub emissive_materials: usize,
    /// Materials that transmit light.
    pub transmitting_materials: usize,
    /// Pictures, in the roles they are used in.
    pub images: usize,
    /// Lights without a surface.
    pub lights: usize,
    /// Cameras.
    pub cameras: usize,
    /// One when there is light from the surroundings.
    pub environments: usize,
}

impl Counts {
    fn of(scene: &Scene) -> Self {
        Self {
            parts: scene.parts.len(),
            meshes: scene.meshes.len(),
            triangles: scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].triangles.len()).sum(),
            materials: scene.materials.len(),
            emissive_materials: scene.materials.iter().filter(|m| !m.emission.factor.is_black()).count(),
            transmitting_materials: scene.materials.iter().filter(|m| m.bsdf.transmits()).count(),
            images: scene.images.len(),
            lights: scene.lights.len(),
            cameras: scene.cameras.len(),
            environments: usize::from(scene.environment.is_some()),
        }
    }
}

/// The report of an import.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImportReport {
    /// Name of the format in lower case: "gltf", "obj", …; see [`Format`].
    pub format: &'static str,
    /// Counts of the scene's contents.
    pub counts: Counts,
    /// Offset that was subtracted from all positions, metres, z up: of scenes far from the origin of their coordinates, such as map
    /// coordinates. Adding it gives the file's positions in metres with z up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub offset_m: Option<[f64; 3]>,
    /// What was dropped, guessed or fixed, with its place; in the order of the file, one for all of a kind.
    pub warnings: Vec<Warning>,
}

impl ImportReport {
    pub(crate) fn new(format: Format, scene: &Scene, warnings: Vec<Warning>) -> Self {
        let format = match format {
            Format::Gltf => "gltf",
            Format::Obj => "obj",
            Format::Mitsuba => "mitsuba",
            Format::Usd => "usd",
            Format::Pbrt => "pbrt",
            Format::Ply => "ply",
            Format::VRay => "vray",
            Format::Fbx => "fbx",
            Format::Collada => "collada",
            Format::Stl => "stl",
            Format::Urdf => "urdf",
            Format::Sdf => "sdf",
            Format::Mjcf => "mjcf",
            Format::Zip => "zip",
            Format::SweetHome => "sweethome",
            Format::Collection => "collection",
            Format::Package => "package",
        };
        Self { format, counts: Counts::of(scene), offset_m: None, warnings }
    }

    /// Counts again what the scene contains, after somebody has changed it.
    pub fn recount(&mut self, scene: &Scene) {
        self.counts = Counts::of(scene);
    }
}

impl fmt::Display for ImportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let c = &self.counts;
        writeln!(
            f,
            "{}: {} parts, {} triangles in {} meshes, {} materials ({} emitting, {} transmitting), {} images, {} lights, {} cameras, {}",
            self.format,
            c.parts,
            c.triangles,
            c.meshes,
            c.materials,
            c.emissive_materials,
            c.transmitting_materials,
            c.images,
            c.lights,
            c.cameras,
            if c.environments > 0 { "an environment" } else { "no environment" },
        )?;
        self.warnings.iter().try_for_each(|w| writeln!(f, "  {w}"))
    }
}

/// Warnings of one import, each once. They are reported, and kept for the report, when the import ends: one for all of a kind.
pub(crate) struct Warnings<'a> {
    cx: &'a dyn Cx,
    seen: HashSet<(String, String)>,
    list: Vec<Warning>,
}

impl<'a> Warnings<'a> {
    pub(crate) fn new(cx: &'a dyn Cx) -> Self {
        Self { cx, seen: HashSet::new(), list: Vec::new() }
    }

    /// Records a warning, unless the same was recorded before.
    pub(crate) fn push(&mut self, place: String, message: String) {
        if self.seen.insert((place.clone(), message.clone())) {
            self.list.push(Warning { place, message });
        }
    }

    /// Reports the recorded warnings, and returns them.
    pub(crate) fn into_list(mut self) -> Vec<Warning> {
        self.tell()
    }

    fn tell(&mut self) -> Vec<Warning> {
        let list = by_kind(std::mem::take(&mut self.list));
        list.iter().for_each(|warning| self.cx.warn(warning.clone()));
        list
    }
}

/// Passes on the warnings of an import that ends with an error as well: they may explain it.
impl Drop for Warnings<'_> {
    fn drop(&mut self) {
        self.tell();
    }
}
