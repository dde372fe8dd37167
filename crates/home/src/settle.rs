//! The last word on what was placed: what stands a little beside its place is moved there by [`crate::gravity`], and what still runs
//! into others or floats is taken away, until nothing does.
//!
//! Furniture is placed by its measures; its triangles, which creases, tilts and clutter move a little, are judged as [`crate::check`]
//! does. Of two things that meet the smaller goes; what stood on it goes with it, since it floats then.

use crate::Home;
use crate::check::contact::Contacts;
use crate::check::meet::Body;
use crate::check::{Fault, bodies, is_shell, object_of};
use crate::gravity;
use enfilade_math::{DAffine3, Vec3};
use enfilade_scene::{Part, PartLabel, is_stuff};
use std::collections::{BTreeMap, BTreeSet};

/// An object that was taken away, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removal {
    /// Its name.
    pub object: String,
    /// What was wrong with it.
    pub fault: Fault,
}

/// An object that was moved to where it is carried and free.
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// Its name.
    pub object: String,
    /// How far, metres.
    pub by: Vec3,
}

/// Moves what can be put right, and takes away what cannot; the shell stays.
pub fn settle(home: &mut Home) {
    let mut bodies = bodies(home);
    let mut contacts = Contacts::new(&bodies);
    let moved = gravity::settle(&mut bodies, &mut contacts);
    let moved: BTreeMap<String, Vec3> = moved.into_iter().map(|(i, by)| (bodies[i].name.clone(), by)).collect();
    for part in &mut home.scene.parts {
        if let Some(by) = moved.get(object_of(&part.name)) {
            part.world_from_mesh = DAffine3::from_translation(by.as_dvec3()) * part.world_from_mesh;
        }
    }
    home.removed = condemned(&bodies, &contacts);
    let gone: BTreeSet<&str> = home.removed.iter().map(|removal| removal.object.as_str()).collect();
    let (scene, labels) = (&mut home.scene, &mut home.labels);
    let kept = |part: &Part| !gone.contains(object_of(&part.name));
    let labelled = std::mem::take(&mut scene.parts).into_iter().zip(std::mem::take(&mut labels.parts));
    (scene.parts, labels.parts) = labelled.filter(|(part, _)| kept(part)).unzip();
    home.moved = moved.into_iter().filter(|(object, _)| !gone.contains(object.as_str())).map(|(object, by)| Shift { object, by }).collect();
    number_instances(home);
    drop_unused(home);
}

/// What must go so that nothing of the rest meets or floats.
fn condemned(bodies: &[Body], contacts: &Contacts) -> Vec<Removal> {
    let volume = |i: usize| bodies[i].bounds.extent().max(Vec3::splat(1e-3)).element_product();
    let mut gone: BTreeMap<usize, Fault> = BTreeMap::new();
    for &(a, b) in &contacts.meeting {
        if gone.contains_key(&a) || gone.contains_key(&b) {
            continue;
        }
        let shell = [a, b].map(|i| is_shell(&bodies[i].name));
        let smaller = if shell[1] || !shell[0] && volume(a) < volume(b) { a } else { b };
        gone.insert(smaller, Fault::Meets(bodies[a].name.clone(), bodies[b].name.clone()));
    }
    let held = contacts.carried(bodies, |i| !gone.contains_key(&i));
    for i in (0..bodies.len()).filter(|&i| !held[i]) {
        gone.entry(i).or_insert_with(|| Fault::Floats(bodies[i].name.clone()));
    }
    gone.into_iter().map(|(i, fault)| Removal { object: bodies[i].name.clone(), fault }).collect()
}

/// Instances are 1, 2, 3, … in their old order.
fn number_instances(home: &mut Home) {
    let old: BTreeSet<i16> = home.labels.parts.iter().filter(|label| !is_stuff(label.semantic)).map(|label| label.instance).collect();
    let new: BTreeMap<i16, i16> = old.into_iter().zip(1..).collect();
    for PartLabel { instance, .. } in &mut home.labels.parts {
        *instance = new.get(instance).copied().unwrap_or(*instance);
    }
}

/// Meshes and materials that no part has any more go too.
fn drop_unused(home: &mut Home) {
    let scene = &mut home.scene;
    let mesh = retain(&mut scene.meshes, scene.parts.iter().map(|part| part.mesh));
    let material = retain(&mut scene.materials, scene.parts.iter().map(|part| part.material));
    for part in &mut scene.parts {
        (part.mesh, part.material) = (mesh[&part.mesh], material[&part.material]);
    }
}

/// Keeps the entries of a list that are used, in their order; where each of them has gone.
fn retain<T>(list: &mut Vec<T>, used: impl Iterator<Item = u32>) -> BTreeMap<u32, u32> {
    let places: BTreeMap<u32, u32> = used.collect::<BTreeSet<u32>>().into_iter().zip(0..).collect();
    let mut index = 0;
    list.retain(|_| {
        index += 1;
        places.contains_key(&(index - 1))
    });
    places
}
