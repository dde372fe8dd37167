//! Semantic labels: NYUv2's forty classes with Hypersim's names and colours, and the class and instance of every part.

use serde::{Deserialize, Serialize};

/// A semantic class: id, name and display colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemanticClass {
    /// 1 to 40; −1 means "unlabelled" and 0 is never used.
    pub id: i16,
    /// NYU40's name.
    pub name: &'static str,
    /// Hypersim's display colour, sRGB.
    pub color: [u8; 3],
}

macro_rules! classes {
    ($($id:literal $name:literal $r:literal $g:literal $b:literal),* $(,)?) => {
        [$(SemanticClass { id: $id, name: $name, color: [$r, $g, $b] }),*]
    };
}

/// The forty classes of NYUv2 as Hypersim names and colours them; `NYU40[i].id == i + 1`.
pub const NYU40: [SemanticClass; 40] = classes![
    1 "wall" 174 199 232, 2 "floor" 152 223 138, 3 "cabinet" 31 119 180, 4 "bed" 255 187 120, 5 "chair" 188 189 34,
    6 "sofa" 140 86 75, 7 "table" 255 152 150, 8 "door" 214 39 40, 9 "window" 197 176 213, 10 "bookshelf" 148 103 189,
    11 "picture" 196 156 148, 12 "counter" 23 190 207, 13 "blinds" 178 76 76, 14 "desk" 247 182 210, 15 "shelves" 66 188 102,
    16 "curtain" 219 219 141, 17 "dresser" 140 57 197, 18 "pillow" 202 185 52, 19 "mirror" 51 176 203, 20 "floormat" 200 54 131,
    21 "clothes" 92 193 61, 22 "ceiling" 78 71 183, 23 "books" 172 114 82, 24 "refrigerator" 255 127 14, 25 "television" 91 163 138,
    26 "paper" 153 98 156, 27 "towel" 140 153 101, 28 "showercurtain" 158 218 229, 29 "box" 100 125 154, 30 "whiteboard" 178 127 135,
    31 "person" 120 185 128, 32 "nightstand" 146 111 194, 33 "toilet" 44 160 44, 34 "sink" 112 128 144, 35 "lamp" 96 207 209,
    36 "bathtub" 227 119 194, 37 "bag" 213 92 176, 38 "otherstructure" 94 106 211, 39 "otherfurniture" 82 84 163,
    40 "otherprop" 100 85 144,
];

/// The class of walls.
pub const WALL: i16 = 1;
/// The class of floors.
pub const FLOOR: i16 = 2;
/// The class of ceilings.
pub const CEILING: i16 = 22;

/// True for classes that have no countable instances: wall, floor and ceiling.
pub fn is_stuff(semantic: i16) -> bool {
    matches!(semantic, WALL | FLOOR | CEILING)
}

/// The label of a part. −1 means unlabelled in both fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartLabel {
    /// NYU40 class, 1 to 40, or −1.
    pub semantic: i16,
    /// Instance number from 1, or −1. Parts of one object share it.
    pub instance: i16,
}

impl PartLabel {
    /// No class and no instance.
    pub const NONE: Self = Self { semantic: -1, instance: -1 };
}

/// The labels of a scene, one per part, in the order of `Scene::parts`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Labels {
    /// `parts[i]` belongs to `Scene::parts[i]`.
    pub parts: Vec<PartLabel>,
}
