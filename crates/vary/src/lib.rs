//! Variations of a scene: the same room at another time, in other colours, with its furniture a little elsewhere.
//!
//! [`vary`] is a function of a labelled scene, a configuration and seeds alone. Each kind of variation has a file and random numbers of its
//! own: `light` (which lamps are lit, their colour and power, sun and sky), `materials` (colours and textures by class), `arrange` (poses
//! of furniture, and what lies about). What differs is returned as a record, by name.

mod arrange;
mod config;
mod draw;
mod first;
mod light;
mod materials;
mod names;
mod planck;
mod repaint;
mod sources;
mod survey;
mod things;

pub use config::{Classes, ClutterVary, ColorRange, FurnitureVary, LampVary, MaterialVary, Misset, SkyVary, VaryConfig, VaryKeys};
pub use first::{First, HomeLight, Seeds, VaryError};
pub use materials::{LEAST as LEAST_REFLECTANCE, MOST as MOST_REFLECTANCE};
pub use planck::{chromaticity, color as planckian};

use enfilade_dataset::Variation;
use enfilade_math::Rng;
use enfilade_scene::{Cx, EditError, LabelledScene, Quiet, Rooms};
use std::collections::BTreeSet;

/// A variation.
pub struct Varied {
    /// The scene and its labels.
    pub scene: LabelledScene,
    /// The rooms, with what has moved.
    pub rooms: Option<Rooms>,
}

/// The variation of `first` that `seeds` decide; `record` is told what differs. `cx` hears what of the configuration changes nothing.
///
/// # Errors
/// When the configuration names only classes that the scene does not have.
pub fn vary(first: &First, config: &VaryConfig, seeds: &Seeds, record: &mut Variation, cx: &dyn Cx) -> Result<Varied, VaryError> {
    // What is to be said is the same for all variations of a scene.
    let cx: &dyn Cx = if record.number == 1 { cx } else { &Quiet };
    let mut scene = first.scene.clone();
    if let Some(materials) = &config.materials {
        record.materials = materials::vary(&mut scene, first, materials, &Rng::new(seeds.materials), cx)?;
    }
    if config.lamps.is_some() || config.sky.is_some() {
        light::light(&mut scene, first, (config.lamps.as_ref(), config.sky.as_ref()), seeds, record, cx);
    }
    if let Some(range) = config.exposure {
        record.exposure_stops = draw::uniform(&mut Rng::new(seeds.light).fork(3), range);
    }
    if config.furniture.is_some() || config.clutter.is_some() {
        let kinds = (config.furniture.as_ref(), config.clutter.as_ref());
        arrange::arrange(&mut scene, first, kinds, &Rng::new(seeds.arrangement), record, cx)?;
    }
    scene.scene.validate().map_err(EditError::from)?;
    Ok(Varied { rooms: first.rooms.map(|rooms| rearranged(rooms, &scene, record)), scene })
}

/// The rooms with the fronts of what has turned, without what is gone.
fn rearranged(rooms: &Rooms, scene: &LabelledScene, record: &Variation) -> Rooms {
    let there: BTreeSet<i16> = scene.labels.parts.iter().map(|label| label.instance).collect();
    let mut rooms = rooms.clone();
    rooms.things.retain(|thing| there.contains(&thing.instance));
    for thing in &mut rooms.things {
        let moved = record.moved.iter().find(|moved| moved.instance == thing.instance);
        if let (Some(moved), Some(front)) = (moved, &mut thing.front) {
            let turned = enfilade_math::DVec2::from_angle(moved.turn_deg.to_radians()).rotate((*front).into());
            *front = turned.to_array();
        }
    }
    rooms
}
