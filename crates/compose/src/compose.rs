//! A scene with its objects.

use crate::draw::{Size, Wanted, draw};
use crate::model::Model;
use crate::place::{Placed, place};
use crate::rest::settle_all;
use crate::surfaces::Surfaces;
use crate::world::{Neighbour, SOLVER, World};
use crate::{ComposeError, Materials, Missing, ObjectGroup, Pose, materials};
use enfilade_dataset::{MissingObject, PlacedObject, PlacedObjects};
use enfilade_math::{DAffine3, DMat3, DVec3, Rng};
use enfilade_scene::{Counted, Cx, LabelledScene, NewThing, Warning};
use std::collections::BTreeMap;
use std::path::Path;

/// Space around surfaces in which the scene takes part in the simulation, metres: to the sides, below and above.
const AROUND_M: [f64; 3] = [0.6, 0.3, 1.5];
/// The place of warnings.
const PLACE: &str = "[[object]]";

/// Models by their files.
pub type Models<'a> = &'a (dyn Fn(&ObjectGroup, &str) -> Result<LabelledScene, String> + Sync);

/// A scene with its objects.
#[derive(Clone, Debug)]
pub struct Composed {
    /// The scene.
    pub scene: LabelledScene,
    /// The record of what was placed.
    pub placed: PlacedObjects,
}

/// Places objects in a scene. `groups` are the groups with the files that each means, `classes` the NYU40 class of each part of the scene or
/// −1, and `load` reads a model.
///
/// # Errors
/// When a key cannot be, or an object cannot be placed whose group refuses that.
pub fn compose(
    scene: &LabelledScene,
    classes: &[i16],
    groups: &[(ObjectGroup, Vec<String>)],
    load: Models<'_>,
    seed: u64,
    cx: &dyn Cx,
) -> Result<Composed, ComposeError> {
    let rng = Rng::new(seed);
    let mut wanted = Vec::new();
    for (index, (group, files)) in groups.iter().enumerate() {
        group.validate(index + 1)?;
        wanted.extend(draw(group, index, files, &mut rng.fork(index as u64)));
    }
    let models = models(&wanted, groups, load, cx);
    let surfaces: Vec<Result<Surfaces, String>> = groups.iter().map(|(group, _)| Surfaces::of(group, scene, classes)).collect();
    let boxes = surfaces.iter().flatten().flat_map(Surfaces::boxes).map(|[low, high]| {
        let [side, below, above] = AROUND_M;
        [low - DVec3::new(side, side, below), high + DVec3::new(side, side, above)]
    });
    let mut world = World::new(&scene.scene, &boxes.collect::<Vec<_>>());
    let mut missing = MissingObjects { groups, list: Vec::new() };
    let (mut placed, mut kept) = (Vec::new(), Vec::new());
    let counted = Counted::new(cx, "objects", wanted.len());
    for one in &wanted {
        let found = counted.unit(|| {
            let model = models[&(one.group, one.model.as_str())].as_ref().map_err(Clone::clone)?;
            let surfaces = surfaces[one.group].as_ref().map_err(Clone::clone)?;
            let group = &groups[one.group].0;
            let scale = match one.size {
                Size::Scale(scale) => scale,
                Size::Longest(longest) => longest / model.longest,
            };
            model.check_size(scale, matches!(one.size, Size::Longest(_)))?;
            let object = Placed { model, scale, surfaces, is_upright: group.pose == Pose::Upright };
            place(&mut world, &mut placed, object, group, &mut Rng::new(one.seed)).map_err(|failures| failures.to_string())
        });
        match found {
            Ok(()) => kept.push(one),
            Err(reason) => missing.add(one, reason)?,
        }
    }
    for (number, reason) in settle_all(&mut world, &mut placed) {
        missing.add(kept.remove(number), reason)?;
    }
    missing.tell(cx);
    let (scene, objects) = add_all(scene, &world, &placed, &kept, groups)?;
    Ok(Composed { scene, placed: PlacedObjects { solver: SOLVER.into(), objects, missing: missing.list } })
}

/// The models of all objects, by group and file.
fn models<'w>(
    wanted: &'w [Wanted],
    groups: &[(ObjectGroup, Vec<String>)],
    load: Models<'_>,
    cx: &dyn Cx,
) -> BTreeMap<(usize, &'w str), Result<Model, String>> {
    let mut keys: Vec<(usize, &str)> = wanted.iter().map(|one| (one.group, one.model.as_str())).collect();
    keys.sort_unstable();
    keys.dedup();
    let counted = Counted::new(cx, "models", keys.len());
    let read = enfilade_parallel::map(&keys, |(group, file)| counted.unit(|| load(&groups[*group].0, file).and_then(Model::new)));
    keys.into_iter().zip(read).collect()
}

/// Objects that could not be placed.
struct MissingObjects<'g> {
    groups: &'g [(ObjectGroup, Vec<String>)],
    list: Vec<MissingObject>,
}

impl MissingObjects<'_> {
    fn add(&mut self, one: &Wanted, reason: String) -> Result<(), ComposeError> {
        let model = one.model.clone();
        if self.groups[one.group].0.missing == Missing::Refuse {
            return Err(ComposeError::Missing { group: one.group + 1, model, reason });
        }
        self.list.push(MissingObject { model, reason });
        Ok(())
    }

    /// One warning per reason, with the models that it concerns.
    fn tell(&self, cx: &dyn Cx) {
        let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        self.list.iter().for_each(|one| by_reason.entry(&one.reason).or_default().push(&one.model));
        for (reason, models) in by_reason {
            let names = models.iter().take(3).copied().collect::<Vec<_>>().join(", ");
            let more = if models.len() > 3 { format!(" and {} more", models.len() - 3) } else { String::new() };
            cx.warn(Warning { place: PLACE.into(), message: format!("{names}{more} left out: {reason}") });
        }
    }
}

/// The scene with the objects where they came to rest, and what is recorded of them.
fn add_all(
    scene: &LabelledScene,
    world: &World,
    placed: &[Placed<'_>],
    kept: &[&Wanted],
    groups: &[(ObjectGroup, Vec<String>)],
) -> Result<(LabelledScene, Vec<PlacedObject>), ComposeError> {
    let mut scene = scene.clone();
    let mut objects: Vec<PlacedObject> = Vec::new();
    let original = scene.scene.parts.len();
    let mut next_instance: BTreeMap<usize, u32> = BTreeMap::new();
    for (number, (object, one)) in placed.iter().zip(kept).enumerate() {
        let group = &groups[one.group].0;
        let failed = |error| ComposeError::Edit { group: one.group + 1, model: one.model.clone(), error };
        let world_from_model = world.placement(number);
        let name = Path::new(&one.model).file_stem().map_or_else(|| one.model.clone(), |stem| stem.to_string_lossy().into_owned());
        let first = scene.scene.parts.len();
        let material = (group.materials == Materials::Drawn).then(|| materials::drawn(&name, &mut Rng::new(one.seed).fork(1)));
        let scaled = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::splat(object.scale)));
        let thing =
            NewThing { name, of: &object.model.thing, material, world_from_thing: world_from_model * scaled, class: Some(group.label.0) };
        scene = scene.with_thing(&thing).map_err(failed)?;
        if let Some(first_instance) = group.first_instance {
            let instance = *next_instance.entry(one.group).and_modify(|next| *next += 1).or_insert(first_instance);
            number_instance(&mut scene, first, instance, one.group + 1)?;
        }
        let added = &scene.scene.parts[first];
        let objects_of = scene.scene.objects_around(added);
        let name = objects_of.last().map_or_else(|| added.name.clone(), |object| scene.scene.objects[object as usize].name.clone());
        objects.push(PlacedObject {
            name,
            instance: scene.labels.parts[first].instance,
            semantic: group.label.0,
            model: one.model.clone(),
            scale: object.scale,
            world_from_model: rows(&world_from_model),
            rests_on: String::new(),
            is_distractor: group.distractor,
            visible_share: group.visible_share,
        });
    }
    for number in 0..objects.len() {
        objects[number].rests_on = match world.carriers(number).first() {
            Some(Neighbour::Part(part)) if (*part as usize) < original => owner(&scene, *part),
            Some(Neighbour::Body(other)) => objects[*other].name.clone(),
            _ => String::new(),
        };
    }
    Ok((scene, objects))
}

/// Gives the parts from `first` on this instance.
fn number_instance(scene: &mut LabelledScene, first: usize, instance: u32, group: usize) -> Result<(), ComposeError> {
    let wrong = |problem| ComposeError::Key { group, key: "first_instance", problem };
    let number = i16::try_from(instance).map_err(|_| wrong(format!("the numbers end at {}, found {instance}", i16::MAX)))?;
    if scene.labels.parts[..first].iter().any(|label| label.instance == number) {
        return Err(wrong(format!("the scene has an instance {number} already; choose a number above those of its instances")));
    }
    scene.labels.parts[first..].iter_mut().for_each(|label| label.instance = number);
    Ok(())
}

/// Name of the object that a part belongs to, or its own.
fn owner(scene: &LabelledScene, part: u32) -> String {
    let part = &scene.scene.parts[part as usize];
    part.object.map_or_else(|| part.name.clone(), |object| scene.scene.objects[object as usize].name.clone())
}

/// A map as rows of four.
fn rows(map: &DAffine3) -> [[f64; 4]; 4] {
    let (m, t) = (map.matrix3, map.translation);
    let row = |i: usize| [m.row(i).x, m.row(i).y, m.row(i).z, t[i]];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}
