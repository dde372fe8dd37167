//! What varies, and between which values.

use enfilade_home::light::{Moment, Outside};
use enfilade_options::{Form, Given, Value, Whole, closest, options};
use enfilade_scene::NYU40;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

options! {
    /// Variations of a scene. What has no key here is the same in all of them.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct VaryConfig keys pub VaryKeys {
        /// Number of variations beside the scene itself, 1 to 9999. They are named after it: `room_v01`, `room_v02`, …
        #[serde(skip)]
        pub count: Option<Whole<1, MOST>> = None,
        /// Number of different lights (`lamps`, `sky` and `exposure` together), which variations take in turn; each has one of its own
        /// unless given.
        #[serde(skip)]
        pub light_sets: Option<Whole<1, MOST>> = None,
        /// Number of different sets of materials. Every light meets each of them once, where there are enough variations.
        #[serde(skip)]
        pub material_sets: Option<Whole<1, MOST>> = None,
        /// Number of different arrangements (`furniture` and `clutter` together).
        #[serde(skip)]
        pub arrangement_sets: Option<Whole<1, MOST>> = None,
        /// Which lamps are lit, their colour temperature and power: a table; `{}` takes its defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub lamps: Option<LampVary> = None,
        /// Date, hour and weather: a table; `{}` takes its defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub sky: Option<SkyVary> = None,
        /// Least and greatest offset of the exposure of displayed pictures, in stops from -4 to 4, such as `[-0.7, 0.7]`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub exposure: Option<[f64; 2]> = None,
        /// Colours and textures of surfaces, by class: a table; `{}` takes its defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub materials: Option<MaterialVary> = None,
        /// Poses of furniture: a table; `{}` takes its defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub furniture: Option<FurnitureVary> = None,
        /// Which small things lie about, and where: a table; `{}` takes its defaults.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub clutter: Option<ClutterVary> = None,
    }
}

/// The largest number of variations of a scene.
pub const MOST: u32 = 9999;

options! {
    /// The lamps of a variation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct LampVary {
        /// Least and greatest share of the lamps that are lit, 0 to 1; uniform between them, by evening and night in their upper half.
        pub lit: [f64; 2] = [0.3, 1.0],
        /// Lowest and highest colour temperature, kelvin, from 1700 to 20 000; uniform in reciprocal megakelvin. A lamp in five has its
        /// own, the others share one.
        pub kelvin: [f64; 2] = [2700.0, 4500.0],
        /// Least and greatest factor on the power of a lamp, more than 0; uniform in its logarithm, lamp by lamp.
        pub power: [f64; 2] = [0.5, 1.5],
    }
}

options! {
    /// The sun and the sky of a variation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct SkyVary {
        /// Parts of the day, equally often each time that they are named.
        pub moments: Vec<Moment> = vec![Moment::Day, Moment::Day, Moment::Day, Moment::Evening, Moment::Night],
        /// Least and greatest share of the sky under cloud, 0 to 1; clear skies are a third of all, overcast ones a sixth.
        pub cloud: [f64; 2] = [0.0, 1.0],
        /// Least and greatest haze of the clear part of the sky, 1.7 to 10; uniform.
        pub turbidity: [f64; 2] = [2.2, 7.0],
        /// What is seen outside: garden, street, suburb, skyline or country. Homes keep what they have, and every imported room has one
        /// that its seed decides, unless given.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub outside: Option<Outside> = None,
        /// Names of the parts or materials of a file whose glow stands for daylight, as windows of rooms without a sky do; `*` is any run
        /// of characters. Unless given, those of windows, doors, blinds and curtains, and upright ones without a class of half a
        /// square metre or more.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub daylight: Option<Vec<String>> = None,
    }
}

options! {
    /// The colours and textures of a variation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MaterialVary {
        /// Share of the materials of these classes that get another colour, 0 to 1.
        pub share: f64 = 0.8,
        /// Share of those that get another texture of their class too, such as tiles in place of planks, 0 to 1.
        pub textures: f64 = 0.5,
        /// Classes of NYU40 whose materials vary, each with ranges of its own or `{}`; the classes of the documentation unless given.
        pub classes: Classes = Classes::default(),
    }
}

/// Ranges of colours, by the names of classes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Classes(pub BTreeMap<String, ColorRange>);

options! {
    /// Colours that a class may have, in Oklab (Ottosson 2020). What is not given follows from what the class is usually made of.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ColorRange {
        /// Least and greatest lightness, 0 to 1; uniform.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub lightness: Option<[f64; 2]> = None,
        /// Least and greatest chroma, 0 to 0.3; uniform.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub chroma: Option<[f64; 2]> = None,
        /// First and last hue, degrees from 0 to 360; uniform.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub hue_deg: Option<[f64; 2]> = None,
    }
}

options! {
    /// The furniture of a variation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct FurnitureVary {
        /// Classes of NYU40 that move.
        pub classes: Vec<String> = ["chair", "table", "sofa", "nightstand", "otherfurniture"].map(String::from).to_vec(),
        /// Share of them that move, 0 to 1.
        pub share: f64 = 0.7,
        /// Greatest distance along x and along y by which one moves, metres; uniform up to it.
        pub shift_m: f64 = 0.3,
        /// Greatest angle by which one turns to either side, degrees up to 180; uniform up to it.
        pub turn_deg: f64 = 25.0,
    }
}

options! {
    /// The small things of a variation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct ClutterVary {
        /// Classes of NYU40 whose small things come and go.
        pub classes: Vec<String> = ["books", "box", "bag", "pillow", "paper", "towel", "otherprop"].map(String::from).to_vec(),
        /// Things whose boxes are longer than this stay as they are, metres.
        pub size_m: f64 = 0.6,
        /// Least and greatest share of the things that are taken away, 0 to 1; uniform between them.
        pub remove: [f64; 2] = [0.0, 0.5],
        /// Share of the others that lie elsewhere on what carries them, 0 to 1.
        pub share: f64 = 0.6,
        /// Greatest distance along x and along y by which one moves, metres. It also turns by any angle.
        pub shift_m: f64 = 0.3,
    }
}

/// Tables and words of tables, which only files have.
macro_rules! tables {
    ($($name:ty),*) => {
        $(impl Value for $name {
            const FORM: Form = Form::Table;

            fn read(_: &Given) -> Option<Self> {
                None
            }
        })*
    };
}

tables!(LampVary, SkyVary, MaterialVary, Classes, FurnitureVary, ClutterVary);

/// A value that cannot be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misset {
    /// Key of [`VaryConfig`].
    pub key: &'static str,
    /// What was found, and what was expected.
    pub message: String,
    /// What to write instead.
    pub help: String,
}

impl VaryConfig {
    /// The keys of what varies, of those that are given.
    pub fn kinds(&self) -> Vec<&'static str> {
        let given = [
            ("lamps", self.lamps.is_some()),
            ("sky", self.sky.is_some()),
            ("exposure", self.exposure.is_some()),
            ("materials", self.materials.is_some()),
            ("furniture", self.furniture.is_some()),
            ("clutter", self.clutter.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(key, _)| key).collect()
    }

    /// Checks every value.
    ///
    /// # Errors
    /// The first one that cannot be.
    pub fn validate(&self) -> Result<(), Misset> {
        if self.kinds().is_empty() {
            return Err(Misset {
                key: "count",
                message: "nothing varies: [vary] names none of lamps, sky, exposure, materials, furniture and clutter".into(),
                help: "say what does, such as lamps = {} and materials = {}, which take their defaults".into(),
            });
        }
        if let Some(lamps) = &self.lamps {
            range("lamps", "lit", lamps.lit, [0.0, 1.0])?;
            range("lamps", "kelvin", lamps.kelvin, [1700.0, 20_000.0])?;
            range("lamps", "power", lamps.power, [1e-3, 1e3])?;
        }
        if let Some(sky) = &self.sky {
            if sky.moments.is_empty() {
                return Err(misset("sky", "moments", "is empty".into(), "name at least one of \"day\", \"evening\" and \"night\""));
            }
            range("sky", "cloud", sky.cloud, [0.0, 1.0])?;
            range("sky", "turbidity", sky.turbidity, [1.7, 10.0])?;
        }
        if let Some(exposure) = self.exposure {
            range("exposure", "", exposure, [-4.0, 4.0])?;
        }
        if let Some(materials) = &self.materials {
            number("materials", "share", materials.share, [0.0, 1.0])?;
            number("materials", "textures", materials.textures, [0.0, 1.0])?;
            for (name, colors) in &materials.classes.0 {
                class("materials", name)?;
                colors.lightness.map_or(Ok(()), |given| range("materials", "lightness", given, [0.0, 1.0]))?;
                colors.chroma.map_or(Ok(()), |given| range("materials", "chroma", given, [0.0, 0.3]))?;
                colors.hue_deg.map_or(Ok(()), |given| range("materials", "hue_deg", given, [0.0, 360.0]))?;
            }
        }
        if let Some(furniture) = &self.furniture {
            furniture.classes.iter().try_for_each(|name| class("furniture", name))?;
            number("furniture", "share", furniture.share, [0.0, 1.0])?;
            number("furniture", "shift_m", furniture.shift_m, [0.0, 10.0])?;
            number("furniture", "turn_deg", furniture.turn_deg, [0.0, 180.0])?;
        }
        if let Some(clutter) = &self.clutter {
            clutter.classes.iter().try_for_each(|name| class("clutter", name))?;
            number("clutter", "size_m", clutter.size_m, [0.0, 10.0])?;
            range("clutter", "remove", clutter.remove, [0.0, 1.0])?;
            number("clutter", "share", clutter.share, [0.0, 1.0])?;
            number("clutter", "shift_m", clutter.shift_m, [0.0, 10.0])?;
        }
        Ok(())
    }

    /// Numbers of the sets of light, materials and arrangement that variation `number` (from 1) takes, from 0. Every light meets every set
    /// of materials, and every such pair every arrangement, before any comes again.
    pub fn sets(&self, number: u32) -> [u32; 3] {
        let turn = u64::from(number.max(1) - 1);
        let count = u64::from(self.count.map_or(MOST, Whole::get)).max(turn + 1);
        let mut before = 1u64;
        [self.light_sets, self.material_sets, self.arrangement_sets].map(|sets| {
            let sets = sets.map_or(count, |sets| u64::from(sets.get()));
            let set = if before == 1 { turn % sets } else { (turn % before + turn / before) % sets };
            before = before.saturating_mul(sets);
            set as u32
        })
    }

    /// The configuration without the numbers of variations and sets, on which no single variation depends.
    #[must_use]
    pub fn of_one(&self) -> Self {
        Self { count: None, light_sets: None, material_sets: None, arrangement_sets: None, ..self.clone() }
    }
}

/// The number of a class of NYU40.
pub(crate) fn class_id(name: &str) -> Option<i16> {
    NYU40.iter().find(|class| class.name == name).map(|class| class.id)
}

fn class(kind: &'static str, name: &str) -> Result<(), Misset> {
    if class_id(name).is_some() {
        return Ok(());
    }
    let names: Vec<&str> = NYU40.iter().map(|class| class.name).collect();
    let help = closest(name, &names).map_or(format!("the classes are: {}", names.join(", ")), |near| format!("did you mean {near:?}?"));
    Err(misset(kind, "classes", format!("names {name:?}, which is no class of NYU40"), &help))
}

fn misset(key: &'static str, field: &str, problem: String, help: &str) -> Misset {
    let place = if field.is_empty() { key.to_string() } else { format!("{key}.{field}") };
    Misset { key, message: format!("{place} {problem}"), help: help.into() }
}

fn number(key: &'static str, field: &str, found: f64, [least, most]: [f64; 2]) -> Result<(), Misset> {
    if (least..=most).contains(&found) {
        return Ok(());
    }
    let problem = format!("must lie between {least} and {most}, found {found}");
    Err(misset(key, field, problem, "docs/vary.md has the ranges and defaults"))
}

fn range(key: &'static str, field: &str, found: [f64; 2], [least, most]: [f64; 2]) -> Result<(), Misset> {
    if found.iter().all(|end| (least..=most).contains(end)) && found[0] <= found[1] {
        return Ok(());
    }
    let problem = format!("must be two numbers from {least} to {most}, the smaller one first, found [{}, {}]", found[0], found[1]);
    let help = if found[0] > found[1] {
        format!("the other way round: [{}, {}]", found[1], found[0])
    } else {
        "docs/vary.md has the ranges and defaults".into()
    };
    Err(misset(key, field, problem, &help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn refused(config: &VaryConfig) -> String {
        let Misset { key, message, help } = config.validate().unwrap_err();
        format!("{key}: {message}; {help}")
    }

    #[test]
    fn ranges_that_are_reversed_and_classes_that_do_not_exist_are_refused_with_what_to_write() {
        let lamps = LampVary { kelvin: [4000.0, 2700.0], ..LampVary::default() };
        let message = refused(&VaryConfig { lamps: Some(lamps), ..VaryConfig::default() });
        assert_eq!(
            message,
            "lamps: lamps.kelvin must be two numbers from 1700 to 20000, the smaller one first, found [4000, 2700]; \
             the other way round: [2700, 4000]"
        );
        let materials = MaterialVary { classes: Classes([("walls".to_string(), ColorRange::default())].into()), ..MaterialVary::default() };
        let message = refused(&VaryConfig { materials: Some(materials), ..VaryConfig::default() });
        assert!(message.contains("names \"walls\", which is no class of NYU40; did you mean \"wall\"?"), "{message}");
        assert!(refused(&VaryConfig::default()).contains("nothing varies"));
        assert!(refused(&VaryConfig { exposure: Some([-9.0, 0.0]), ..VaryConfig::default() }).contains("exposure must be two numbers"));
    }

    #[test]
    fn every_light_meets_every_set_of_materials_before_a_pair_comes_again() {
        let sets = |lights, materials, arrangements| VaryConfig {
            count: Some(Whole::new(MOST)),
            light_sets: lights,
            material_sets: materials,
            arrangement_sets: arrangements,
            ..VaryConfig::default()
        };
        let twenty = sets(Some(Whole::new(20)), Some(Whole::new(10)), None);
        let pairs: BTreeSet<_> = (1..=200).map(|number| twenty.sets(number)[..2].to_vec()).collect();
        assert_eq!(pairs.len(), 200);
        // The first twenty have all lights, and each set of materials twice.
        let first: Vec<_> = (1..=20).map(|number| twenty.sets(number)).collect();
        assert_eq!(first.iter().map(|set| set[0]).collect::<BTreeSet<_>>().len(), 20);
        assert!((0..10).all(|material| first.iter().filter(|set| set[1] == material).count() == 2));
        let three = sets(Some(Whole::new(2)), Some(Whole::new(3)), Some(Whole::new(4)));
        assert_eq!((1..=24).map(|number| three.sets(number)).collect::<BTreeSet<_>>().len(), 24);
        // Without numbers of sets, each variation has its own.
        assert_eq!(sets(None, None, None).sets(7), [6; 3]);
    }
}
