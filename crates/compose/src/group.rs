//! `[[object]]`: which models, how many, where, and how they lie.

use crate::{ClassWord, ComposeError, Extent, Many, Number};
use enfilade_import::UpAxis;
use enfilade_math::DVec3;
use enfilade_options::{options, words};
use serde::{Deserialize, Serialize};

/// Most objects of one group.
const MOST: u32 = 10_000;

words! {
    /// How an object lies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Pose {
        /// The model's upward axis stays up, within 10 degrees once it is at rest.
        Upright = "upright",
        /// Set down on whichever side it comes to rest.
        Lying = "lying",
        /// Dropped from `drop_height_m`, onto others too: a heap.
        Dropped = "dropped",
    }
}

words! {
    /// How an object is turned before it is set down.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Turn {
        /// As the model's file has it.
        None = "none",
        /// By any angle about the vertical.
        Z = "z",
        /// Freely, all orientations alike.
        Free = "free",
    }
}

words! {
    /// Which materials an object has.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Materials {
        /// Materials of its file.
        Kept = "kept",
        /// One for the whole object, drawn: a fifth are metals; hue, saturation, lightness and roughness are uniform.
        Drawn = "drawn",
    }
}

words! {
    /// What happens when an object cannot be placed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Missing {
        /// The scene is made without it, with a warning.
        Skip = "skip",
        /// The scene is refused.
        Refuse = "refuse",
    }
}

/// Patterns of files.
pub type Files = Many;

options! {
    /// Models of one kind, placed in a scene.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ObjectGroup {
        /// Models, in any format that scenes may have: a path or a list of them, with `*` and `?`. A folder means the models in it.
        pub files: Files = Many::default(),
        /// How many objects, or `[least, most]`; each model once unless given. Models are drawn in turn, so that none is taken twice before all
        /// were taken once.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub count: Option<Number> = None,
        /// What they stand on: names of objects or parts, with `*` and `?`, or NYU40 classes such as `"table"`; one or a list.
        pub on: Many = Many::default(),
        /// What they stand in, named as for `on`: surfaces below another part of the same object, such as the boards of a shelf.
        pub inside: Many = Many::default(),
        /// The box in which they are put, `[[x, y, z], [x, y, z]]`, metres; alone, all upward surfaces in it count.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub region_m: Option<[[f64; 3]; 2]> = None,
        /// How they lie: `"upright"`, `"lying"` or `"dropped"`.
        pub pose: Pose = Pose::Upright,
        /// How they are turned: `"none"`, `"z"` or `"free"`; upright ones about z, others freely, unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub turn: Option<Turn> = None,
        /// How far dropped ones fall, `[least, most]` or one number, metres.
        pub drop_height_m: Extent = Extent([0.05, 0.3]),
        /// Length of the longest side of the model's box, metres, or `[least, most]`; as the file has it unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub size_m: Option<Extent> = None,
        /// Size over that in the file, or `[least, most]`.
        pub scale: Extent = Extent([1.0; 2]),
        /// Metres per unit of the models, for files that do not state it.
        pub meters_per_unit: f64 = 1.0,
        /// The axis of the models that points up; that of their format unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub up_axis: Option<UpAxis> = None,
        /// `"kept"` as in the file, or `"drawn"`: one for the whole object, at random.
        pub materials: Materials = Materials::Kept,
        /// NYU40 class, by name or number; each object is an instance of it.
        pub label: ClassWord = ClassWord(40),
        /// Number of the first one's instance, the others follow; the first free ones unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub first_instance: Option<u32> = None,
        /// They are there to distract: exports do not name them as targets, and cameras do not look at them.
        pub distractor: bool = false,
        /// Share of the planned frames in which each is to be visible, for the plan mode `objects`.
        pub visible_share: f64 = 0.5,
        /// What happens when one cannot be placed: `"skip"` or `"refuse"`.
        pub missing: Missing = Missing::Skip,
    }
}

impl ObjectGroup {
    /// How objects of the group are turned.
    pub(crate) fn turn(&self) -> Turn {
        self.turn.unwrap_or(if self.pose == Pose::Upright { Turn::Z } else { Turn::Free })
    }

    /// Least and greatest corner of the box in which objects are put.
    pub(crate) fn region(&self) -> Option<[DVec3; 2]> {
        self.region_m.map(|corners| corners.map(DVec3::from_array))
    }

    /// Checks every value; `group` is the number in the file, from 1.
    ///
    /// # Errors
    /// The first value that cannot be, with its key.
    pub fn validate(&self, group: usize) -> Result<(), ComposeError> {
        let wrong = |key, problem: String| Err(ComposeError::Key { group, key, problem });
        let extent = |key, Extent([least, most]): Extent, low: f64| {
            let fits = least.is_finite() && most.is_finite() && least >= low && most >= least && (most > 0.0 || low == 0.0);
            if fits { Ok(()) } else { wrong(key, format!("found {least} to {most}, expected two numbers above 0, the smaller one first")) }
        };
        if self.files.0.is_empty() {
            return wrong("files", "missing; expected models, such as files = \"models/*.glb\"".into());
        }
        if let Some(Number([least, most])) = self.count
            && !(least <= most && (1..=MOST).contains(&most))
        {
            return wrong("count", format!("found {least} to {most}, expected numbers up to {MOST}, the smaller one first"));
        }
        if self.on.0.is_empty() && self.inside.0.is_empty() && self.region_m.is_none() {
            return wrong(
                "on",
                "missing; say where, as in on = \"table\", inside = \"shelves\" or region_m = [[x, y, z], [x, y, z]]".into(),
            );
        }
        if let Some([low, high]) = self.region()
            && !(low.is_finite() && high.is_finite() && low.cmplt(high).all())
        {
            return wrong("region_m", format!("found {low} to {high}, expected the least corner of a box and then the greatest"));
        }
        if self.size_m.is_some() && self.scale != Extent([1.0; 2]) {
            return wrong("scale", "the size is given by size_m already; leave one of them out".into());
        }
        self.size_m.map_or(Ok(()), |size| extent("size_m", size, f64::MIN_POSITIVE))?;
        extent("scale", self.scale, f64::MIN_POSITIVE)?;
        extent("drop_height_m", self.drop_height_m, 0.0)?;
        if !(self.meters_per_unit.is_finite() && self.meters_per_unit > 0.0) {
            return wrong("meters_per_unit", format!("found {}, expected a number above 0, such as 0.001", self.meters_per_unit));
        }
        if !(0.0..=1.0).contains(&self.visible_share) {
            return wrong("visible_share", format!("found {}, expected a share from 0 to 1", self.visible_share));
        }
        match self.first_instance {
            Some(first) if !(1..=i16::MAX as u32).contains(&first) => {
                wrong("first_instance", format!("found {first}, expected 1 to {}", i16::MAX))
            }
            _ => Ok(()),
        }
    }
}
