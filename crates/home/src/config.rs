//! The configuration of a home: a seed for everything, seeds for one domain alone, and what a user chooses.

use crate::building::Building;
use crate::light::Moment;
use crate::room::kind::usual_programme;
use crate::states::States;
use enfilade_furniture::RoomKind;
use enfilade_math::Rng;
use enfilade_options::{named, options, words};
use serde::{Deserialize, Serialize};

words! {
    /// The shapes of the rooms of plans that are made.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum RoomShape {
        /// Rectangles.
        #[default]
        Rectangular = "rectangular",
        /// Some rooms go around a corner, or have a bay, a niche, a column, a slanted wall or a ceiling that slopes under a roof.
        Varied = "varied",
    }
}

options! {
    /// What a home is a function of. Equal values give equal bytes.
    ///
    /// What is not set follows from `seed`: to vary one thing and keep the others, set its seed and leave `seed` as it is.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct HomeConfig {
        /// Seed of everything random that has no seed of its own.
        ///
        /// Zero is the home on the cover, with palette and light chosen by hand.
        pub seed: u64 = 0 => named("SEED"),
        /// The kind of building: its rooms unless these are named, their layout and height, and its light.
        #[serde(skip_serializing_if = "is_home")]
        pub building: Building = Building::Home,
        /// Kinds of rooms, each as often as it is wanted, 12 in all at most; usual ones of the building, as the seed decides, unless given.
        ///
        /// A home has four to eight rooms, equally often, of the usual programme of that number; other buildings have one of a few lists.
        /// The most are [`HomeConfig::MOST_ROOMS`].
        pub rooms: Vec<RoomKind> = Vec::new() => named("KIND,KIND"),
        /// File with the floor plan, in place of one that is made: rooms as polygons with doors and windows.
        ///
        /// A plan written by hand, a `layout.json`, a file of Structured3D, SpatialLM, 3D-FRONT or ProcTHOR, an SVG or a DXF drawing. `rooms`
        /// then gives the kinds of its rooms, in the file's order, if they are not to be those of the file. As written; the caller reads it.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub plan: Option<String> = None => named("FILE"),
        /// Shapes of rooms where no `plan` is given.
        #[serde(skip_serializing_if = "is_rectangular")]
        pub shape: RoomShape = RoomShape::Rectangular,
        /// Seed of the floor plan alone: areas, shape of the whole, doors and windows.
        ///
        /// Areas are uniform over what is usual for each kind of room.
        pub layout: Option<u64> = None => named("SEED"),
        /// Seed of the furniture alone: which pieces there are, their measures, and where they stand.
        pub furniture: Option<u64> = None => named("SEED"),
        /// Seed of the materials alone: colours, woods, cloths, and the pictures that surfaces show.
        pub materials: Option<u64> = None => named("SEED"),
        /// Share of the colours that match; the others are random.
        ///
        /// See [`enfilade_furniture::DecorConfig`].
        pub realism: f32 = 1.0 => named("SHARE"),
        /// Seed of the light alone: place, date, hour, weather, surroundings, and which lamps are lit.
        pub light: Option<u64> = None => named("SEED"),
        /// Part of the day; as the seed decides unless given.
        ///
        /// It is day in three of five homes, evening or night in the others.
        pub moment: Option<Moment> = None,
        /// Density of small things: 0 leaves only the contents of shelves and cabinets, 2 is crowded.
        pub clutter: f32 = 1.0,
        /// How much people have left lying and moved, 0 to 1: at 0 rooms are as if nobody lived there, at 1 untidy.
        ///
        /// Beds that are unmade, clothes and blankets thrown over chairs and sofas, dishes after a meal, bags, shoes, boxes, cables, post,
        /// toys, chairs pulled out, cushions askew, screens that are on. What lies about is multiplied by `clutter`. It leaves rooms, walls
        /// and furniture as they are without it.
        #[serde(skip_serializing_if = "is_half")]
        pub lived_in: f32 = 0.5 => named("SHARE"),
        /// What is open: `made`, `closed`, `open`, `random`, or, in files, a share of the range, or a table of these by name.
        ///
        /// Furniture has an inside and joints where it is given; without it, nothing can be opened, and only drawers and doors that are ajar
        /// where people live (`lived_in`) have an inside. `made` leaves everything as it is without it. Names are those of joints (`dresser_1/drawer_2_1`), of objects (`door_1`), both
        /// also with `*` and `?`, or kinds (`drawer`).
        #[serde(skip_serializing_if = "Option::is_none")]
        pub states: Option<States> = None,
        /// Folders of glTF models, or furniture of Sweet Home 3D (.sh3f), to take in place of our own furniture where a model fits.
        ///
        /// As written; the caller reads them.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub assets: Vec<String> = Vec::new() => named("FOLDER|FILE"),
        /// Share of the things for which a model fits that are models.
        #[serde(skip_serializing_if = "is_one")]
        pub assets_share: f32 = 1.0 => named("SHARE"),
        /// Use our own furniture, with a warning, where a model is broken.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        pub allow_broken_assets: bool = false,
    }
}

/// True for the default, which is not written: a configuration without models stays as it was before models existed.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde wants it")]
fn is_one(share: &f32) -> bool {
    *share == 1.0
}

/// As [`is_one`].
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde wants it")]
fn is_half(share: &f32) -> bool {
    *share == 0.5
}

/// As [`is_one`].
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde wants it")]
fn is_home(building: &Building) -> bool {
    *building == Building::Home
}

/// As [`is_one`].
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde wants it")]
fn is_rectangular(shape: &RoomShape) -> bool {
    *shape == RoomShape::Rectangular
}

impl HomeConfig {
    /// Largest number of rooms.
    pub const MOST_ROOMS: usize = 12;

    /// The home of a seed, with everything else as it comes.
    pub fn of_seed(seed: u64) -> Self {
        Self { seed, ..Self::default() }
    }

    /// Why no home can be made of it, if none can.
    pub fn problem(&self) -> Option<String> {
        if self.rooms.len() > Self::MOST_ROOMS && self.plan.is_none() {
            return Some(format!("a home has at most {} rooms, found {}", Self::MOST_ROOMS, self.rooms.len()));
        }
        if self.plan.is_some() && self.shape != RoomShape::Rectangular {
            return Some("a `plan` has the shapes that were drawn: leave `shape` out".into());
        }
        if !(0.0..=4.0).contains(&self.clutter) {
            return Some(format!("clutter must lie between 0 and 4, found {}", self.clutter));
        }
        if !(0.0..=1.0).contains(&self.lived_in) {
            return Some(format!("lived_in must lie between 0 and 1, found {}", self.lived_in));
        }
        if !(0.0..=1.0).contains(&self.realism) {
            return Some(format!("realism must lie between 0 and 1, found {}", self.realism));
        }
        if !(0.0..=1.0).contains(&self.assets_share) {
            return Some(format!("assets_share must lie between 0 and 1, found {}", self.assets_share));
        }
        None
    }

    /// The rooms to make.
    pub(crate) fn programme(&self) -> Vec<RoomKind> {
        if !self.rooms.is_empty() {
            return self.rooms.clone();
        }
        let (programmes, mut rng) = (self.building.row().programmes, self.stream(self.layout, 9));
        if programmes.is_empty() { usual_programme(4 + rng.below(5)) } else { programmes[rng.below(programmes.len())].to_vec() }
    }

    /// Random numbers for one purpose, from its own seed if that is set.
    pub(crate) fn stream(&self, own: Option<u64>, purpose: u64) -> Rng {
        Rng::new(own.unwrap_or(self.seed)).fork(purpose)
    }
}
