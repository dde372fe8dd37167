//! Contact of things: the distance at which they touch, and which of them are soft.

use crate::names::family_of;

/// Families of cloth that lies in folds over or in something: it follows what it lies on, so its depth is not checked.
const DRAPED: [&str; 6] = ["throw", "blanket", "clothes", "towel", "napkin", "crumpled_paper"];
/// Things nearer than this touch, metres.
const REACH: f32 = 0.0025;
/// Soft things touch at this larger distance, metres: cloth hangs and lies in waves.
pub const SOFT_REACH: f32 = 0.02;
/// Families of soft things.
const SOFT: [&str; 14] = [
    "crumpled_paper",
    "pillow",
    "cushion",
    "floor_cushion",
    "bench_cushion",
    "throw",
    "blanket",
    "towel",
    "clothes",
    "curtain",
    "plush_toy",
    "handbag",
    "shopping_bag",
    "shower_curtain",
];
/// True for an object of cloth or with cushions, which gives way.
pub fn is_soft(object: &str) -> bool {
    SOFT.contains(&family_of(object))
}

/// True for an object of cloth that lies in folds: how deep it sinks into others is not checked.
pub fn is_draped(object: &str) -> bool {
    DRAPED.contains(&family_of(object))
}

/// Distance below which objects of these names touch, metres.
pub fn reach(a: &str, b: &str) -> f32 {
    if is_soft(a) || is_soft(b) { SOFT_REACH } else { REACH }
}
