//! A scene being read: its plugins, and the meshes and materials that have been made of them so far.

use super::plugins::{Handle, Plugins};
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use std::collections::HashMap;

/// Plugins that lead to each other over more steps than this do so in a circle.
pub(super) const MAX_CHAIN: usize = 48;

/// A material of more BRDFs than this has layers that contain each other again and again.
pub(super) const MAX_LAYERS: usize = 256;

/// Key of a mesh: the geometry's plugin, the texture channel, and whether faces are separated by material.
pub(super) type MeshKey = (usize, i64, bool);

/// The meshes of a geometry by material id; 0 for all where faces are not separated by material.
pub(super) type Meshes = Vec<(i32, u32)>;

/// A material that was made: where it is in the scene, its name, and the texture channel that its textures use, if it has any.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub index: u32,
    pub name: String,
    pub channel: Option<i64>,
}

/// A scene being read: its plugins, and what has been made of them.
pub(super) struct Reader<'n, 'a> {
    pub a: Assembly<'a>,
    pub plugins: &'n Plugins,
    /// Radiance of 1 cd/m².
    pub photometric_scale: f64,
    pub meshes: HashMap<MeshKey, Meshes>,
    pub materials: HashMap<usize, Made>,
    /// The texture channel of the material that is being made.
    pub channel: Option<i64>,
    /// Number of BRDFs of that material so far.
    pub layers: usize,
    /// Pictures of 1 − factor × channel of others.
    pub complements: HashMap<(u32, [u32; 3], Option<u8>), u32>,
    /// Factor of all light by the camera's exposure.
    pub exposure: f32,
    /// Multiplies all lights, exposure included.
    pub light_level: Rgb,
}

impl<'n, 'a> Reader<'n, 'a> {
    /// Begins a scene, of which nothing has been made.
    pub(super) fn new(assembly: Assembly<'a>, plugins: &'n Plugins, photometric_scale: f64, exposure: f32) -> Self {
        Self {
            a: assembly,
            plugins,
            photometric_scale,
            meshes: HashMap::new(),
            materials: HashMap::new(),
            channel: None,
            layers: 0,
            complements: HashMap::new(),
            exposure,
            light_level: Rgb::splat(exposure),
        }
    }

    /// Warns of what was dropped or guessed at a plugin.
    pub(super) fn warn(&mut self, plugin: Handle, message: impl Into<String>) {
        self.a.warn(plugin.place(), message);
    }

    /// Warns of every parameter among these that the plugin animates.
    pub(super) fn warn_of_animation(&mut self, plugin: Handle, parameters: &[&str]) {
        for parameter in parameters.iter().filter(|p| plugin.is_animated(p)) {
            let keys = plugin.keyframes(parameter);
            self.warn(plugin, format!("{parameter} is animated; the first of its {keys} keyframes was used"));
        }
    }
}
