//! Captions of frames: what is visible, how it is arranged, how far it is.

use crate::seen::{SeenFrame, Sight};
use crate::things::Things;
use crate::words;
use enfilade_dataset::{Caption, DescribedInstance, InstanceRelation, RelationKind};
use enfilade_math::DVec3;
use enfilade_scene::{CEILING, FLOOR, is_stuff};
use std::collections::{BTreeMap, BTreeSet};

/// A thing is spoken of when it covers this share of the image.
const SPOKEN: f64 = 3e-3;
/// Share of the image from which on another thing of the same name may be mistaken for the one that is spoken of.
const NOTICED: f64 = 2e-4;
/// The things that the first sentence lists, at most, things of one name being one.
const LISTED: usize = 6;
/// Most sentences on how things are arranged.
const SENTENCES: usize = 4;
/// Most clauses about a thing in one of them.
const CLAUSES: usize = 2;

/// The known facts about a scene, and the part of it that a frame shows.
pub struct Scope<'a> {
    pub things: &'a Things,
    /// By subject.
    pub relations: &'a [InstanceRelation],
    pub seen: &'a SeenFrame,
    /// The things that have a name and can be noticed, the largest first.
    noticed: Vec<(&'a DescribedInstance, &'a Sight)>,
}

impl<'a> Scope<'a> {
    pub fn new(things: &'a Things, described: &'a [DescribedInstance], relations: &'a [InstanceRelation], seen: &'a SeenFrame) -> Self {
        let thing = |(&instance, sight): (&i16, &'a Sight)| Some((&described[things.place(instance)?], sight));
        let is_noticed = |(thing, sight): &(&DescribedInstance, &Sight)| !thing.noun.is_empty() && seen.covers(sight, NOTICED);
        let mut noticed: Vec<_> = seen.sights.iter().filter_map(thing).filter(is_noticed).collect();
        noticed.sort_by_key(|(thing, sight)| (std::cmp::Reverse(sight.pixels), thing.instance));
        Self { things, relations, seen, noticed }
    }

    /// Things that have a name and cover at least this share of the image, the largest first.
    pub fn visible(&self, share: f64) -> Vec<(&'a DescribedInstance, &'a Sight)> {
        self.noticed.iter().copied().filter(|(_, sight)| self.seen.covers(sight, share)).collect()
    }

    /// The relations whose subject is an instance.
    pub fn relations_of(&self, instance: i16) -> &'a [InstanceRelation] {
        let [first, end] = [instance, instance.saturating_add(1)].map(|i| self.relations.partition_point(|r| r.subject < i));
        &self.relations[first..end]
    }

    /// "the sofa", "the blue sofa": words that mean this thing and no other that the frame shows; `None` where there are none.
    pub fn definite(&self, thing: &DescribedInstance) -> Option<String> {
        let mistaken = |with_color: bool| {
            let others =
                self.noticed.iter().filter(|(other, _)| other.instance != thing.instance && words::may_be(&other.noun, &thing.noun));
            others.into_iter().any(|(other, _)| !with_color || other.color.is_empty() || other.color == thing.color)
        };
        if !mistaken(false) {
            return Some(format!("the {}", thing.noun));
        }
        (!thing.color.is_empty() && !mistaken(true)).then(|| format!("the {} {}", thing.color, thing.noun))
    }

    /// The name of a relation's object: a wall, floor or ceiling, or a thing that the frame shows.
    pub fn object(&self, relation: &InstanceRelation) -> Option<String> {
        if relation.object < 1 {
            let is_told = self.things.has_nyu40() && is_stuff(relation.object_semantic);
            return is_told.then(|| format!("the {}", enfilade_label::class_name(relation.object_semantic)));
        }
        let (thing, _) = self.noticed.iter().find(|(thing, _)| thing.instance == relation.object)?;
        self.definite(thing)
    }
}

/// The caption of a frame that was taken from `eye`.
pub fn caption(scope: &Scope<'_>, [scene, camera]: [&str; 2], eye: DVec3) -> Caption {
    let visible = scope.visible(SPOKEN);
    let mut instances = BTreeSet::new();
    let mut sentences = vec![format!("{}.", words::sentence(&inventory(scope, &visible, eye, &mut instances)))];
    let mut said = BTreeSet::new();
    for (thing, _) in &visible {
        if sentences.len() > SENTENCES {
            break;
        }
        let Some(subject) = scope.definite(thing) else { continue };
        let clauses = clauses(scope, thing, &mut said, &mut instances);
        if !clauses.is_empty() {
            instances.insert(thing.instance);
            sentences.push(format!("{} {}.", words::sentence(&subject), words::list(&clauses)));
        }
    }
    let nearest = visible.iter().filter(|(_, sight)| sight.nearest_m.is_finite()).min_by(|a, b| a.1.nearest_m.total_cmp(&b.1.nearest_m));
    if let Some((thing, sight)) = nearest
        && let Some(subject) = scope.definite(thing)
    {
        instances.insert(thing.instance);
        let are = words::are(&thing.noun);
        sentences.push(format!("{} {are} {:.1} m from the camera.", words::sentence(&subject), sight.nearest_m));
    }
    Caption {
        id: format!("{scene}/{camera}/{:04}", scope.seen.frame),
        scene_name: scene.into(),
        camera: camera.into(),
        frame: scope.seen.frame,
        caption: sentences.join(" "),
        instances: instances.into_iter().collect(),
    }
}

/// "a bedroom with a white bed, two nightstands and some books".
fn inventory(scope: &Scope<'_>, visible: &[(&DescribedInstance, &Sight)], eye: DVec3, instances: &mut BTreeSet<i16>) -> String {
    let room = scope.things.rooms.as_ref().and_then(|rooms| rooms.room_at(eye).map(|room| &rooms.outlines[room].kind));
    let room = room.map_or_else(|| "an interior".into(), |kind| words::a_room(kind));
    let mut groups: Vec<(&str, Vec<&DescribedInstance>)> = Vec::new();
    for (thing, _) in visible {
        match groups.iter_mut().find(|(noun, _)| *noun == thing.noun) {
            Some((_, group)) => group.push(thing),
            None => groups.push((&thing.noun, vec![thing])),
        }
    }
    groups.truncate(LISTED);
    let items: Vec<String> = groups
        .iter()
        .map(|(noun, group)| {
            instances.extend(group.iter().map(|thing| thing.instance));
            match group.as_slice() {
                [one] => words::a(&one.color, noun),
                many if words::is_countable(noun) => format!("{} {}", words::number(many.len()), words::plural(noun)),
                _ => words::a("", noun),
            }
        })
        .collect();
    if items.is_empty() { room } else { format!("{room} with {}", words::list(&items)) }
}

/// Clauses on how a thing is arranged, as verbs with their objects. A relation between two things is mentioned once.
fn clauses(scope: &Scope<'_>, thing: &DescribedInstance, said: &mut BTreeSet<[i16; 2]>, instances: &mut BTreeSet<i16>) -> Vec<String> {
    let many = words::is_plural(&thing.noun);
    let mut found: BTreeMap<RelationKind, String> = BTreeMap::new();
    for relation in scope.relations_of(thing.instance) {
        let plain = match relation.kind {
            RelationKind::On => relation.object < 1 && relation.object_semantic == FLOOR,
            RelationKind::In => relation.object < 1,
            _ => false,
        };
        let pair = [relation.subject.min(relation.object), relation.subject.max(relation.object)];
        if found.len() >= CLAUSES || found.contains_key(&relation.kind) || plain || (relation.object >= 1 && said.contains(&pair)) {
            continue;
        }
        let Some(object) = scope.object(relation) else { continue };
        if relation.object >= 1 {
            said.insert(pair);
            instances.insert(relation.object);
        }
        found.insert(relation.kind, format!("{} {object}", verb(relation, many)));
    }
    // "is on the rug and beside the sofa"
    let are = if many { "are " } else { "is " };
    let clauses: Vec<String> = found.into_values().collect();
    let follows = |i: usize| i > 0 && clauses[i - 1].starts_with(are);
    (0..clauses.len()).map(|i| clauses[i].strip_prefix(are).filter(|_| follows(i)).unwrap_or(&clauses[i]).to_string()).collect()
}

/// The words of a relation.
fn verb(relation: &InstanceRelation, many: bool) -> String {
    let are = if many { "are" } else { "is" };
    let s = if many { "" } else { "s" };
    match relation.kind {
        RelationKind::On => format!("{are} on"),
        RelationKind::In => format!("{are} in"),
        RelationKind::HangsFrom if relation.object < 1 && relation.object_semantic == CEILING => format!("hang{s} from"),
        RelationKind::HangsFrom => format!("hang{s} on"),
        RelationKind::Against => format!("{are} against"),
        RelationKind::Under => format!("{are} under"),
        RelationKind::Beside => format!("{are} beside"),
        RelationKind::Facing => format!("face{s}"),
    }
}
