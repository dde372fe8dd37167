//! How many actions it takes to give the labelled objects of a scene their classes.
//!
//! Without suggestions, one action labels what can be selected together: an instance, or the objects without one (walls, floors) of one
//! name and class; where parts of one name can be chosen together, it is the objects of one name and class, if the name has a word. With
//! suggestions: one action confirms all that are sure; objects whose suggestion is wrong, or that have none, take as many actions as
//! without suggestions.

use enfilade_suggest::Suggestion;
use enfilade_suggest::learn::{NameGroup, NamedObject};
use enfilade_suggest::words::words;
use std::collections::{BTreeMap, BTreeSet};

/// The actions of a scene.
#[derive(Clone, Copy, Default)]
pub struct Actions {
    /// Labelled objects, and those of them whose names have words.
    pub objects: [f64; 2],
    /// Actions to label part by part: without and with suggestions.
    pub singly: [f64; 2],
    /// By name: without and with suggestions.
    pub by_name: [f64; 2],
}

/// The objects that one action selects.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Choice<'a> {
    Instance(i32, i16),
    Name(&'a [String], i16),
}

/// The actions of every scene that has labelled objects. `suggestions` are of `groups`; the sure ones have `min` confidence.
pub fn per_scene(objects: &[NamedObject], groups: &[NameGroup], suggestions: &[Option<Suggestion>], min: f32) -> Vec<Actions> {
    let sure: BTreeMap<(&str, &[String]), i16> = groups
        .iter()
        .zip(suggestions)
        .filter_map(|(group, s)| Some(((group.scene.as_str(), group.words.as_slice()), s.as_ref().filter(|s| s.confidence >= min)?.class)))
        .collect();
    let mut scenes: BTreeMap<&str, Vec<(&NamedObject, Vec<String>)>> = BTreeMap::new();
    for object in objects.iter().filter(|object| object.class > 0) {
        scenes.entry(&object.scene).or_default().push((object, words(&object.name)));
    }
    scenes
        .iter()
        .map(|(scene, list)| {
            let named = |words: &[String], class| sure.get(&(*scene, words)) == Some(&class);
            let (mut singly, mut by_name) = ([BTreeSet::new(), BTreeSet::new()], [BTreeSet::new(), BTreeSet::new()]);
            for (object, words) in list {
                let one = || match object.instance {
                    -1 => Choice::Name(words, object.class),
                    instance => Choice::Instance(instance, object.class),
                };
                let together = || if words.is_empty() { one() } else { Choice::Name(words, object.class) };
                let left = !named(words, object.class);
                singly[0].insert(one());
                by_name[0].insert(together());
                if left {
                    singly[1].insert(one());
                    by_name[1].insert(together());
                }
            }
            let worded = list.iter().filter(|(_, words)| !words.is_empty()).count();
            let confirmed = list.iter().any(|(object, words)| named(words, object.class));
            let count = |sets: &[BTreeSet<Choice<'_>>; 2]| [sets[0].len() as f64, sets[1].len() as f64 + f64::from(u8::from(confirmed))];
            Actions { objects: [list.len() as f64, worded as f64], singly: count(&singly), by_name: count(&by_name) }
        })
        .collect()
}
