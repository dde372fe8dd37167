//! Kinds of room that each camera of a dataset passes through, for classification of scenes.

use crate::config::Config;
use crate::error::Error;
use crate::products::not_judged;
use enfilade_dataset::{Dataset, Manifest, SceneTypeRow, scene_type};
use enfilade_scene::{RoomOutline, Rooms};
use std::collections::BTreeMap;

/// Type of scenes without another type.
const OTHER: &str = "Other";

/// Writes the type of scene of every camera that `manifest` lists: the key `scene_type`, else the room with most of its poses, else
/// [`OTHER`].
pub(crate) fn write_scene_types(dataset: &Dataset, config: &Config, manifest: &Manifest) -> Result<(), Error> {
    let mut rows = Vec::new();
    for (scene, entry) in &manifest.scenes {
        let told = config.scenes.iter().find(|known| known.name == *scene).and_then(|known| scene_type(known.scene_type.as_deref()?));
        // Missing or damaged files are reported by the stages that need them.
        let is_fresh = !not_judged(dataset, scene)?.has(&dataset.layout().rooms(scene));
        let rooms = dataset.read_rooms(scene).ok().flatten().filter(|_| is_fresh);
        for camera in entry.cameras.keys() {
            let room = rooms.as_ref().and_then(|rooms| most_seen_from(dataset, rooms, scene, camera));
            let of_room = room.map_or(OTHER, |room| type_of_room(&room.kind));
            let notes = room.map(|room| room.name.clone()).unwrap_or_default();
            rows.push(SceneTypeRow { scene: scene.clone(), camera: camera.clone(), scene_type: told.unwrap_or(of_room), notes });
        }
    }
    dataset.write_scene_types(&rows).map_err(Error::stage)
}

/// The room in which most poses of a camera are.
fn most_seen_from<'s>(dataset: &Dataset, rooms: &'s Rooms, scene: &str, camera: &str) -> Option<&'s RoomOutline> {
    let mut poses: BTreeMap<usize, usize> = BTreeMap::new();
    for pose in dataset.read_trajectory(scene, camera).ok()?.poses {
        if let Some(room) = rooms.room_at(pose.position) {
            *poses.entry(room).or_default() += 1;
        }
    }
    let most = poses.into_iter().max_by_key(|&(room, count)| (count, std::cmp::Reverse(room)));
    most.map(|(room, _)| &rooms.outlines[room])
}

/// Hypersim's word for a kind of room of a home.
fn type_of_room(kind: &str) -> &'static str {
    match kind {
        "bathroom" | "toilet" => "Bathroom",
        "bedroom" | "childrens" => "Bedroom",
        "dining" => "Dining room",
        "hall" => "Hallway",
        "kitchen" => "Kitchen",
        "living" => "Living room",
        "study" => "Office (home)",
        "office" | "open_office" => "Office",
        "meeting" => "Office (conference room)",
        "reception" => "Office (waiting area)",
        "corridor" => "Hallway",
        "library" => "Library",
        "cafe" => "Restaurant",
        "shop" | "bookshop" => "Retail space",
        "hotel_room" => "Bedroom",
        _ => OTHER,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_have_words_of_the_list() {
        let is_word = |kind: &str| scene_type(type_of_room(kind)) == Some(type_of_room(kind));
        assert!(enfilade_home::RoomKind::ALL.into_iter().map(enfilade_home::RoomKind::name).chain(["pantry"]).all(is_word));
    }
}
