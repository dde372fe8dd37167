//! Upward surfaces of a scene on which objects can stand.

use crate::ObjectGroup;
use enfilade_math::{DVec3, Rng};
use enfilade_options::closest;
use enfilade_scene::{LabelledScene, NYU40, ObjectId, PartId};
use std::collections::{BTreeMap, BTreeSet};
use wildmatch::WildMatch;

/// Cosine of the steepest slope on which something is put.
const FLAT_COS: f64 = 0.9;
/// Objects that a message names.
const NAMED: usize = 5;

/// The surfaces for one group of objects.
#[derive(Debug, Default)]
pub struct Surfaces {
    /// Triangles, and the number of the thing that they belong to.
    triangles: Vec<([DVec3; 3], usize)>,
    /// Sum of the areas up to each triangle, m².
    areas: Vec<f64>,
    /// The parts of each thing.
    pub things: Vec<Thing>,
    /// The box in which objects are put.
    region: Option<[DVec3; 2]>,
}

/// One thing of the scene.
#[derive(Debug, Default)]
pub struct Thing {
    /// Parts of it.
    pub parts: BTreeSet<PartId>,
    /// Objects are put below another part of it, not on top.
    pub is_shelf: bool,
}

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The point.
    pub at: DVec3,
    /// The thing that it belongs to.
    pub thing: usize,
}

impl Surfaces {
    /// The surfaces that a group names. `classes` is the NYU40 class of each part, −1 where it is unknown.
    ///
    /// # Errors
    /// What the scene does not have.
    pub fn of(group: &ObjectGroup, scene: &LabelledScene, classes: &[i16]) -> Result<Self, String> {
        let mut found = Self { region: group.region(), ..Self::default() };
        let mut numbers = BTreeMap::new();
        for (words, is_shelf) in [(&group.on.0, false), (&group.inside.0, true)] {
            for word in words {
                for part in parts_of(word, scene, classes)? {
                    found.add(scene, part, is_shelf, &mut numbers);
                }
            }
        }
        if group.on.0.is_empty() && group.inside.0.is_empty() {
            (0..scene.scene.parts.len() as PartId).for_each(|part| found.add(scene, part, false, &mut numbers));
        }
        if found.triangles.is_empty() {
            return Err(format!("what {} names has no upward surface{}", words_of(group), in_region(group)));
        }
        Ok(found)
    }

    /// Adds the upward triangles of a part.
    fn add(&mut self, scene: &LabelledScene, part: PartId, is_shelf: bool, numbers: &mut BTreeMap<(Owner, bool), usize>) {
        let scene = &scene.scene;
        let of = &scene.parts[part as usize];
        let owner = of.object.map_or(Owner::Part(part), Owner::Object);
        let thing = *numbers.entry((owner, is_shelf)).or_insert_with(|| {
            self.things.push(Thing { parts: BTreeSet::new(), is_shelf });
            self.things.len() - 1
        });
        if !self.things[thing].parts.insert(part) {
            return;
        }
        for triangle in 0..scene.meshes[of.mesh as usize].triangles.len() {
            let corners = scene.world_corners(of, triangle).map(|corner| corner.as_dvec3());
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let is_up = normal.z > FLAT_COS * normal.length() && normal.length() > 1e-9;
            let meets = |[low, high]: [DVec3; 2]| {
                let least = corners[0].min(corners[1]).min(corners[2]);
                let most = corners[0].max(corners[1]).max(corners[2]);
                least.cmple(high).all() && most.cmpge(low).all()
            };
            if is_up && self.region.is_none_or(meets) {
                self.areas.push(self.areas.last().unwrap_or(&0.0) + normal.length() / 2.0);
                self.triangles.push((corners, thing));
            }
        }
    }

    /// A point drawn evenly over the area; `None` if it is not in the region.
    pub fn draw(&self, rng: &mut Rng) -> Option<Spot> {
        let total = *self.areas.last()?;
        let place = rng.next_f64() * total;
        let index = self.areas.partition_point(|area| *area <= place).min(self.triangles.len() - 1);
        let ([a, b, c], thing) = self.triangles[index];
        let (u, v) = (rng.next_f64().sqrt(), rng.next_f64());
        let at = a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v);
        let is_in = |[low, high]: [DVec3; 2]| at.cmpge(low).all() && at.cmple(high).all();
        self.region.is_none_or(is_in).then_some(Spot { at, thing })
    }

    /// Whether objects may rest on a part.
    pub fn carries(&self, part: PartId) -> bool {
        self.things.iter().any(|thing| thing.parts.contains(&part))
    }

    /// Least and greatest corners of a box around each surface.
    pub fn boxes(&self) -> Vec<[DVec3; 2]> {
        let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; self.things.len()];
        for (corners, thing) in &self.triangles {
            let [low, high] = &mut boxes[*thing];
            corners.iter().for_each(|corner| (*low, *high) = (low.min(*corner), high.max(*corner)));
        }
        if let Some([low, high]) = self.region {
            boxes.iter_mut().for_each(|found| *found = [found[0].max(low), found[1].min(high)]);
        }
        boxes.into_iter().filter(|[low, high]| low.cmple(*high).all()).collect()
    }
}

/// What parts belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Owner {
    Object(ObjectId),
    Part(PartId),
}

/// The parts that a word means: by name, else by class.
fn parts_of(word: &str, scene: &LabelledScene, classes: &[i16]) -> Result<Vec<PartId>, String> {
    let parts = &scene.scene.parts;
    let named = |part: &PartId| {
        let part = &parts[*part as usize];
        fits(word, &part.name) || scene.scene.objects_around(part).any(|object| fits(word, &scene.scene.objects[object as usize].name))
    };
    let all = 0..parts.len() as PartId;
    let by_name: Vec<PartId> = all.clone().filter(named).collect();
    if !by_name.is_empty() {
        return Ok(by_name);
    }
    let class = NYU40.iter().find(|class| class.name.eq_ignore_ascii_case(word));
    let by_class: Vec<PartId> = all.filter(|part| class.is_some_and(|class| classes[*part as usize] == class.id)).collect();
    if by_class.is_empty() { Err(unknown(word, class.is_some(), scene, classes)) } else { Ok(by_class) }
}

/// The reason for a word that means nothing in a scene.
fn unknown(word: &str, is_class: bool, scene: &LabelledScene, classes: &[i16]) -> String {
    if is_class {
        let there: BTreeSet<&str> = NYU40.iter().filter(|class| classes.contains(&class.id)).map(|class| class.name).collect();
        let there =
            if there.is_empty() { "no part has a class".into() } else { format!("its classes are {}", Vec::from_iter(there).join(", ")) };
        return format!("no part of the scene is of the class {word:?} ({there}); name a part or an object, or give labels");
    }
    let parts = scene.scene.parts.iter().map(|part| part.name.as_str());
    let known: BTreeSet<&str> =
        parts.chain(scene.scene.objects.iter().map(|object| object.name.as_str())).chain(NYU40.iter().map(|class| class.name)).collect();
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = closest(word, &known).map_or_else(
        || format!("; its first parts are {}", known.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ")),
        |name| format!("; did you mean {name:?}?"),
    );
    format!("the scene has no part, object or class {word:?}{nearest}")
}

/// Whether a name is this one, or of this form with `*` and `?`.
pub(crate) fn fits(pattern: &str, name: &str) -> bool {
    if pattern.contains(['*', '?']) { WildMatch::new(pattern).matches(name) } else { pattern == name }
}

/// The keys that say where.
fn words_of(group: &ObjectGroup) -> String {
    let say = |key: &str, words: &[String]| (!words.is_empty()).then(|| format!("{key} = {words:?}"));
    let said: Vec<String> = [say("on", &group.on.0), say("inside", &group.inside.0)].into_iter().flatten().collect();
    if said.is_empty() { "region_m".into() } else { said.join(" and ") }
}

fn in_region(group: &ObjectGroup) -> &'static str {
    if group.region_m.is_some() { " in region_m" } else { "" }
}
