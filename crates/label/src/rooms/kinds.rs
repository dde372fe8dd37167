//! The kind of a room, by the things in it.

use super::surfaces::LabelledTriangle;
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::{NYU40, RoomOutline};
use std::collections::{BTreeMap, BTreeSet};

/// Kinds of room with the things that identify them; the first kind with a thing in the room is taken. The kinds are those of generated
/// homes.
const TELLTALES: [(&str, &[&str]); 6] = [
    ("bathroom", &["toilet", "bathtub", "showercurtain"]),
    ("bedroom", &["bed"]),
    ("kitchen", &["refrigerator"]),
    ("living", &["sofa"]),
    ("study", &["desk"]),
    ("dining", &["table"]),
];
/// A room that no thing identifies.
const UNKNOWN: &str = "room";

/// Middles of things by class, and how many rooms of each kind there were.
pub struct Kinds {
    things: Vec<(i16, DVec3)>,
    counts: BTreeMap<&'static str, usize>,
}

impl Kinds {
    pub fn new(triangles: &[LabelledTriangle]) -> Self {
        let told: BTreeSet<i16> = NYU40.iter().filter(|class| telltale(class.name).is_some()).map(|class| class.id).collect();
        let mut sums: BTreeMap<(i16, i16), (DVec3, f64)> = BTreeMap::new();
        for triangle in triangles.iter().filter(|t| told.contains(&t.label.semantic) && t.label.instance >= 1) {
            let area = triangle.normal_and_area().1;
            let sum = sums.entry((triangle.label.semantic, triangle.label.instance)).or_default();
            (sum.0, sum.1) = (sum.0 + triangle.center() * area, sum.1 + area);
        }
        let things = sums.into_iter().filter(|(_, (_, area))| *area > 0.0).map(|((class, _), (sum, area))| (class, sum / area)).collect();
        Self { things, counts: BTreeMap::new() }
    }

    /// Kind and name of the room over an outline, between these heights.
    pub fn of_room(&mut self, outline: &[DVec2], [floor_z_m, ceiling_z_m]: [f64; 2]) -> (String, String) {
        let polygon = outline.iter().map(|p| p.to_array()).collect();
        let room = RoomOutline { name: String::new(), kind: String::new(), polygon, floor_z_m, ceiling_z_m };
        let there = self.things.iter().filter(|(_, middle)| room.contains(*middle));
        let rank = there.filter_map(|(class, _)| telltale(NYU40[*class as usize - 1].name)).min();
        let kind = rank.map_or(UNKNOWN, |rank| TELLTALES[rank].0);
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        (kind.into(), format!("{kind}_{count}"))
    }
}

fn telltale(class: &str) -> Option<usize> {
    TELLTALES.iter().position(|(_, classes)| classes.contains(&class))
}
