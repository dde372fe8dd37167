//! The materials of surfaces: each [`Finish`] becomes a material when the first thing asks for it.
//!
//! Reflectances follow measured ones: white emulsion 0.8, glaze and washed cotton 0.76, pale wood 0.4 to 0.5, concrete 0.35, dark wood
//! and leather 0.05 to 0.15, black plastic 0.025. Pictures that take their colour from a factor are shared by all rooms.

mod cloth;
mod finish;
mod glass;
mod luminous;
mod maker;
mod metal;
mod nature;
mod public;
mod recipes;
mod solid;
mod wall;

pub use finish::{Finish, Surfacing};
pub use maker::coated;
pub use public::{CARPET_TILE_M, CEILING_TILE_M, PACKAGE_COLUMNS};

use crate::lamplight::{Glow, LampLight};
use crate::palette::Palette;
use enfilade_geometry::Mesh;
use enfilade_math::Rng;
use enfilade_scene::{Material, Scene};
use maker::{Layers, Maker, Stock, rough};
use std::collections::BTreeMap;

/// The materials and pictures made so far, and the palette that new ones take their colours from.
#[derive(Clone, Debug)]
pub struct Materials {
    stock: Stock,
    /// Number of the palette's room, counted in the order in which rooms were entered.
    room: u32,
    light: LampLight,
    materials: BTreeMap<(u32, Finish), u32>,
}

impl Materials {
    /// None yet. `rng` decides the pictures, `light` how bright what glows is.
    pub fn new(palette: Palette, light: LampLight, rng: Rng) -> Self {
        Self { stock: Stock::new(palette, light.exposure, rng), room: 0, light, materials: BTreeMap::new() }
    }

    /// Materials of a home in which varnish and lacquer are rougher by up to `wear` times their roughness where they have been used.
    #[must_use]
    pub fn worn(mut self, wear: f32) -> Self {
        self.stock.wear = wear;
        self
    }

    /// From now on finishes have the colours of `palette`.
    pub fn enter_room(&mut self, palette: Palette) {
        (self.stock.palette, self.room) = (palette, self.room + 1);
    }

    /// Index of the material, made and added to `scene` if there is none yet.
    pub fn get(&mut self, scene: &mut Scene, finish: Finish) -> u32 {
        let key = (self.room, finish);
        if let Some(&known) = self.materials.get(&key) {
            return known;
        }
        let material = Maker { stock: &mut self.stock, scene }.material(finish);
        let index = add(scene, material);
        self.materials.insert(key, index);
        index
    }

    /// The material of a luminous part with this mesh; the lamp's name decides whether it is lit, unless it always is.
    pub fn glow(&self, scene: &mut Scene, lamp: &str, always: bool, mesh: &Mesh, glow: Glow) -> u32 {
        add(scene, glow.material(mesh, always || self.light.is_lit(lamp), self.stock.exposure))
    }
}

/// Index of a material of the scene; equal ones are stored once.
fn add(scene: &mut Scene, material: Material) -> u32 {
    let found = scene.materials.iter().position(|m| *m == material);
    found.unwrap_or_else(|| {
        scene.materials.push(material);
        scene.materials.len() - 1
    }) as u32
}

#[cfg(test)]
mod tests;
