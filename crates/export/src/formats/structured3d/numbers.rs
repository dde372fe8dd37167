//! The numbers of scenes: Structured3D calls them `scene_00000` to `scene_03499`, and the number determines on which side of its partition
//! a scene is.

use crate::ExportError;
use crate::selected_frames::SelectedFrames;
use enfilade_dataset::Side;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Numbers of scenes that are bad in Structured3D: its errata as MonteFloor, HEAT and RoomFormer leave them out, whatever is in them.
const LEFT_OUT: [u32; 48] = [
    76, 183, 335, 491, 663, 681, 703, 728, 865, 936, 985, 986, 1009, 1104, 1155, 1221, 1282, 1365, 1378, 1635, 1745, 1772, 1774, 1816,
    1866, 2037, 2076, 2274, 2334, 2357, 2580, 2665, 2706, 2713, 2771, 2868, 3156, 3192, 3198, 3261, 3271, 3276, 3296, 3342, 3387, 3398,
    3466, 3496,
];

/// The numbers of a side.
const fn of_side(side: Side) -> Range<u32> {
    match side {
        Side::Train => 0..3000,
        Side::Val => 3000..3250,
        Side::Test => 3250..3500,
    }
}

/// The number of every scene: its own where it is called as Structured3D's are, else the next one of its side of the dataset's partition.
pub(super) fn numbers(selected: &SelectedFrames<'_>) -> Result<BTreeMap<String, u32>, ExportError> {
    let scenes: BTreeSet<&str> = selected.scenes().map(|tracks| tracks[0].scene.as_str()).collect();
    let mut numbers: BTreeMap<String, u32> = scenes.iter().filter_map(|scene| Some((scene.to_string(), own_number(scene)?))).collect();
    let mut used: BTreeSet<u32> = numbers.values().copied().chain(LEFT_OUT).collect();
    let sides = selected.sides_of_scenes()?;
    for scene in scenes {
        if numbers.contains_key(scene) {
            continue;
        }
        let side = sides.get(scene).copied().unwrap_or(Side::Train);
        let Some(number) = of_side(side).find(|number| !used.contains(number)) else {
            let problem = format!("Structured3D has no more numbers for {}; export the dataset in parts (--scene)", side.name());
            return Err(selected.unsuitable(scene, problem));
        };
        used.insert(number);
        numbers.insert(scene.to_string(), number);
    }
    Ok(numbers)
}

fn own_number(scene: &str) -> Option<u32> {
    scene.strip_prefix("scene_").filter(|digits| digits.len() == 5 && digits.bytes().all(|b| b.is_ascii_digit()))?.parse().ok()
}

/// The folder of a number.
pub(super) fn folder(number: u32) -> String {
    format!("scene_{number:05}")
}

/// The table of scenes and their numbers.
pub(super) fn table(numbers: &BTreeMap<String, u32>) -> String {
    let row = |(scene, &number): (&String, &u32)| format!("{},{scene}\n", folder(number));
    "folder,scene\n".to_string() + &numbers.iter().map(row).collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_is_called_as_theirs_keeps_its_number() {
        assert_eq!((own_number("scene_00042"), own_number("scene_42"), own_number("home_00042")), (Some(42), None, None));
        assert_eq!(folder(42), "scene_00042");
    }
}
