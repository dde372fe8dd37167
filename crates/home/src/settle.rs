//! The last step of furnishing: things that run into others or float are moved a little by [`crate::gravity`], and removed where that
//! fails.
//!
//! Furniture is placed by its box; here its triangles count, which creases, tilts and clutter move a little. Of two objects that run into
//! each other the smaller is removed, together with the things on it, which would float. Things that block the only way into a room are
//! removed too.

use crate::check::contact::Contacts;
use crate::check::{Fault, bodies, walk};
use crate::gravity;
use crate::shell::is_shell;
use crate::{Home, Removal, Shift};
use enfilade_furniture::meet::Body;
use enfilade_furniture::object_of;
use enfilade_math::{DAffine3, Vec3};
use enfilade_scene::{PartId, PartLabel, is_stuff};
use std::collections::{BTreeMap, BTreeSet};

/// Moves what can be put right, and removes what cannot; the shell stays.
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
    for body in &mut home.scene.bodies {
        let by = moved.get(object_of(&body.name)).map(|by| DAffine3::from_translation(by.as_dvec3()));
        if let Some(carried) = by.and_then(|by| body.carried(&by)) {
            *body = carried;
        }
    }
    let mut gone = condemned(&bodies, &contacts);
    clear_ways(home, &bodies, &contacts, &mut gone);
    home.removed = gone.into_iter().map(|(i, fault)| Removal { object: bodies[i].name.clone(), fault }).collect();
    let gone: BTreeSet<&str> = home.removed.iter().map(|removal| removal.object.as_str()).collect();
    let (scene, labels) = (&mut home.scene, &mut home.labels);
    let is_gone: BTreeSet<PartId> =
        scene.parts.iter().zip(0..).filter(|(part, _)| gone.contains(object_of(&part.name))).map(|(_, part)| part).collect();
    let mut part = 0..;
    labels.parts.retain(|_| part.next().is_none_or(|part| !is_gone.contains(&part)));
    scene.remove_parts(&is_gone);
    home.joints.retain(|joint| !gone.contains(object_of(&joint.body)));
    home.moved = moved.into_iter().filter(|(object, _)| !gone.contains(object.as_str())).map(|(object, by)| Shift { object, by }).collect();
}

/// Numbers instances without gaps, and drops what no part uses any more.
pub fn tidy(home: &mut Home) {
    number_instances(home);
    drop_unused(home);
}

/// The bodies to remove, and why, so that no other runs into anything or floats.
fn condemned(bodies: &[Body], contacts: &Contacts) -> BTreeMap<usize, Fault> {
    let mut gone: BTreeMap<usize, Fault> = BTreeMap::new();
    for &(a, b) in &contacts.meeting {
        if gone.contains_key(&a) || gone.contains_key(&b) {
            continue;
        }
        let shell = [a, b].map(|i| is_shell(&bodies[i].name));
        let smaller = if shell[1] || !shell[0] && bodies[a].volume() < bodies[b].volume() { a } else { b };
        gone.insert(smaller, Fault::Meets(bodies[a].name.clone(), bodies[b].name.clone()));
    }
    let_go(bodies, contacts, &mut gone);
    gone
}

/// Adds the bodies that nothing carries any more.
fn let_go(bodies: &[Body], contacts: &Contacts, gone: &mut BTreeMap<usize, Fault>) {
    let held = contacts.carried(bodies, |i| !gone.contains_key(&i));
    for i in (0..bodies.len()).filter(|&i| !held[i]) {
        gone.entry(i).or_insert_with(|| Fault::Floats(bodies[i].name.clone()));
    }
}

/// Adds the bodies that block the way into rooms that nobody can reach.
fn clear_ways(home: &Home, bodies: &[Body], contacts: &Contacts, gone: &mut BTreeMap<usize, Fault>) {
    let floor = walk::Floor::new(home);
    let numbers: BTreeMap<&str, usize> = bodies.iter().enumerate().map(|(i, body)| (body.name.as_str(), i)).collect();
    let stays = |object: &str, gone: &BTreeMap<usize, Fault>| numbers.get(object).is_none_or(|i| !gone.contains_key(i));
    for room in floor.unreachable(|object| stays(object, gone)) {
        for object in floor.in_the_way(room, |object| stays(object, gone)) {
            gone.entry(numbers[object]).or_insert(Fault::Unreachable(room));
        }
        let_go(bodies, contacts, gone);
    }
}

/// Numbers the instances 1, 2, 3, … in their old order.
fn number_instances(home: &mut Home) {
    let old: BTreeSet<i16> = home.labels.parts.iter().filter(|label| !is_stuff(label.semantic)).map(|label| label.instance).collect();
    let new: BTreeMap<i16, i16> = old.into_iter().zip(1..).collect();
    for PartLabel { instance, .. } in &mut home.labels.parts {
        *instance = new.get(instance).copied().unwrap_or(*instance);
    }
}

/// Drops the objects, meshes, materials and pictures that no part uses any more.
fn drop_unused(home: &mut Home) {
    let scene = &mut home.scene;
    scene.remove_unused_objects();
    let mesh = retain(&mut scene.meshes, scene.parts.iter().map(|part| part.mesh));
    let material = retain(&mut scene.materials, scene.parts.iter().map(|part| part.material));
    for part in &mut scene.parts {
        (part.mesh, part.material) = (mesh[&part.mesh], material[&part.material]);
    }
    let mut shown = Vec::new();
    scene.materials.iter().for_each(|material| material.textures(|texture| shown.push(texture.image)));
    let image = retain(&mut scene.images, shown.into_iter());
    let materials = std::mem::take(&mut scene.materials).into_iter();
    scene.materials = materials.map(|material| material.repictured(|k| image[&k])).collect();
}

/// Keeps the entries of a list that are used, in their order. Returns the new index of each by its old one.
fn retain<T>(list: &mut Vec<T>, used: impl Iterator<Item = u32>) -> BTreeMap<u32, u32> {
    let places: BTreeMap<u32, u32> = used.collect::<BTreeSet<u32>>().into_iter().zip(0..).collect();
    let mut index = 0;
    list.retain(|_| {
        index += 1;
        places.contains_key(&(index - 1))
    });
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HomeConfig, RoomKind};
    use enfilade_furniture::pose;
    use enfilade_furniture::shape::bevelled_box;
    use enfilade_scene::Part;

    #[test]
    fn what_stands_in_the_only_way_goes() {
        let mut home = crate::home(&HomeConfig { rooms: vec![RoomKind::Study, RoomKind::Bathroom], ..HomeConfig::default() });
        assert!(walk::unreachable(&home).is_empty());
        let (number, room) = home.plan.rooms.iter().enumerate().find(|(_, room)| room.kind == RoomKind::Bathroom).unwrap();
        let way = room.ways().next().unwrap();
        assert_eq!(room.ways().count(), 1);
        let at = room.before(way.wall, way.center_x(), 0.3);
        let size = Vec3::new(way.size().x + 0.2, 0.02, 1.2);
        home.scene.meshes.push(bevelled_box(size, 0.01).into());
        let world_from_mesh = pose(f64::from(at.x), f64::from(at.y), 0.601, f64::from(room.yaw(way.wall)));
        let mesh = home.scene.meshes.len() as u32 - 1;
        home.scene.parts.push(Part { name: "crate_1/body".into(), object: None, mesh, world_from_mesh, ..home.scene.parts[0].clone() });
        home.labels.parts.push(home.labels.parts[0]);
        assert_eq!(walk::unreachable(&home), [number]);
        settle(&mut home);
        assert_eq!(home.removed, [Removal { object: "crate_1".into(), fault: Fault::Unreachable(number) }]);
        assert!(walk::unreachable(&home).is_empty());
    }
}
