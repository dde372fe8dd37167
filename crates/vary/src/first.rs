//! What a variation is made from: the scene that is varied, and seeds.

use enfilade_home::light::LightConfig;
use enfilade_math::Vec2;
use enfilade_scene::{EditError, LabelledScene, Rooms};
use std::collections::BTreeSet;

/// The scene that is varied, and what is known about it.
pub struct First<'a> {
    /// Name of the scene, for messages.
    pub name: &'a str,
    /// The scene and its labels.
    pub scene: &'a LabelledScene,
    /// The light of a generated home; `None` for scenes of files.
    pub home: Option<HomeLight>,
    /// Rooms, doors and names of things, where they are known.
    pub rooms: Option<&'a Rooms>,
    /// Instances whose poses are written elsewhere and that stay where they are.
    pub fixed: BTreeSet<i16>,
}

/// The light that a home has.
pub struct HomeLight {
    /// Place, date, hour and weather.
    pub light: LightConfig,
    /// Directions in which its windows look out.
    pub outward: Vec<Vec2>,
}

/// Seeds of a variation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    /// Of what all variations of a scene have in common: where on the globe it is, and how it is turned.
    pub place: u64,
    /// Of its light.
    pub light: u64,
    /// Of its materials.
    pub materials: u64,
    /// Of its arrangement.
    pub arrangement: u64,
}

/// Why a scene cannot be varied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VaryError {
    /// The configuration names only what the scene does not have.
    #[error("scene {scene:?} cannot vary: {message}")]
    NothingToVary {
        /// Name of the scene.
        scene: String,
        /// What it does not have, and what it has.
        message: String,
    },
    /// The varied scene is not valid.
    #[error(transparent)]
    Scene(#[from] EditError),
}
