//! The last word on what was placed: things that run into others or float are taken away again, until nothing does.
//!
//! Furniture is placed by its measures; its triangles, which creases, tilts and clutter move a little, are judged by [`crate::check`].
//! Of two things that meet the smaller goes; what stood on it goes with it, since it floats then.

use crate::Home;
use crate::check::{Fault, is_shell, object_of, of_things};
use enfilade_math::{Bounds3, Vec3};
use enfilade_scene::{Part, PartLabel, is_stuff};
use std::collections::{BTreeMap, BTreeSet};

/// Takes away what cannot be; the shell stays.
pub fn settle(home: &mut Home) {
    loop {
        let faults = of_things(home);
        let bounds = bounds(home);
        let volume = |name: &str| bounds.get(name).map_or(0.0, |b| b.extent().max(Vec3::splat(1e-3)).element_product());
        let gone: BTreeSet<String> = faults
            .into_iter()
            .filter_map(|fault| match fault {
                Fault::Meets(a, b) => Some(if is_shell(&b) || !is_shell(&a) && volume(&a) < volume(&b) { a } else { b }),
                Fault::Floats(a) => Some(a),
                Fault::Nameless(_) | Fault::Unreachable(_) | Fault::Camera(_) => None,
            })
            .collect();
        if gone.is_empty() {
            break;
        }
        keep(home, |part| !gone.contains(object_of(&part.name)));
    }
    number_instances(home);
    drop_unused(home);
}

/// World boxes of all objects.
fn bounds(home: &Home) -> BTreeMap<String, Bounds3> {
    let mut bounds: BTreeMap<String, Bounds3> = BTreeMap::new();
    for part in &home.scene.parts {
        let mesh = &home.scene.meshes[part.mesh as usize];
        let world = mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3()).as_vec3());
        let found = bounds.entry(object_of(&part.name).to_string()).or_insert(Bounds3::EMPTY);
        *found = found.union(Bounds3::from_points(world));
    }
    bounds
}

fn keep(home: &mut Home, kept: impl Fn(&Part) -> bool) {
    let labelled = std::mem::take(&mut home.scene.parts).into_iter().zip(std::mem::take(&mut home.labels.parts));
    (home.scene.parts, home.labels.parts) = labelled.filter(|(part, _)| kept(part)).unzip();
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
