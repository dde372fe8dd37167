//! The table of marks.

use enfilade_math::Rgb;
use enfilade_textures::Mark;

/// Where marks are.
#[derive(Clone, Copy, Debug)]
pub enum On {
    /// On walls between two heights, for each 10 m of wall.
    Walls([f32; 2]),
    /// On walls at a height, beside doors.
    Doors([f32; 2]),
    /// On the floor, for each 10 m².
    Floor,
    /// On top of pieces of these families, for each piece.
    Tops(&'static [&'static str]),
    /// On the upper side of soft pieces of these families, for each piece.
    Soft(&'static [&'static str]),
    /// On upright screens and panes of these names, for each.
    Fronts(&'static [&'static str]),
    /// On leaves of doors of these names, beside the handle, for each.
    Leaves(&'static [&'static str]),
}

/// A kind of mark.
pub struct Row {
    /// The kind.
    pub kind: Mark,
    /// Where it is.
    pub on: On,
    /// Least and greatest width and height, metres.
    pub size: [[f32; 2]; 2],
    /// Colour, linear reflectance.
    pub color: Rgb,
    /// Share that it covers where it is strongest: at ½ and at 1.
    pub strength: [f32; 2],
    /// Expected number at ½ and at 1.
    pub expected: [f32; 2],
    /// Roughness of a glossy film; a rough diffuse one where it is none.
    pub gloss: Option<f32>,
}

const TABLES: &[&str] = &[
    "dining_table",
    "long_table",
    "coffee_table",
    "side_table",
    "desk",
    "student_desk",
    "conference_table",
    "bistro_table",
    "nightstand",
    "worktop",
    "counter",
    "workbench",
    "play_table",
];
const SHELVES: &[&str] = &["sideboard", "dresser", "tv_bench", "console", "shoe_cabinet", "cube_shelf", "filing_cabinet", "office_cabinet"];
const SCREENS: &[&str] = &["screen"];
const PANES: &[&str] = &["pane", "mirror", "glass"];
const LEAVES: &[&str] = &["leaf"];
const SEATS: &[&str] =
    &["sofa", "corner_sofa", "chesterfield", "day_bed", "armchair", "club_chair", "upholstered_chair", "office_chair", "bench", "pouf"];
const DIRT: Rgb = Rgb::new(0.075, 0.06, 0.045);
const RUBBER: Rgb = Rgb::new(0.03, 0.028, 0.027);

/// All kinds.
pub static ROWS: [Row; 18] = [
    Row {
        kind: Mark::Scuffs,
        on: On::Walls([0.1, 0.42]),
        size: [[0.12, 0.5], [0.04, 0.14]],
        color: RUBBER,
        strength: [0.28, 0.6],
        expected: [2.2, 7.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Walls([0.7, 1.5]),
        size: [[0.08, 0.3], [0.08, 0.3]],
        color: DIRT,
        strength: [0.08, 0.2],
        expected: [1.4, 5.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Doors([0.8, 1.3]),
        size: [[0.1, 0.22], [0.15, 0.4]],
        color: DIRT,
        strength: [0.12, 0.28],
        expected: [0.7, 1.7],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.5, 2.0]),
        size: [[0.2, 0.7], [0.15, 0.5]],
        color: Rgb::new(0.8, 0.79, 0.76),
        strength: [0.05, 0.12],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.4, 2.1]),
        size: [[0.3, 0.9], [0.3, 0.9]],
        color: Rgb::new(0.3, 0.27, 0.23),
        strength: [0.03, 0.08],
        expected: [0.8, 2.4],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Floor,
        size: [[0.3, 1.1], [0.3, 1.1]],
        color: DIRT,
        strength: [0.07, 0.18],
        expected: [1.6, 4.0],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Floor,
        size: [[0.06, 0.22], [0.06, 0.22]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Scratches,
        on: On::Floor,
        size: [[0.3, 0.8], [0.3, 0.8]],
        color: Rgb::new(0.35, 0.32, 0.28),
        strength: [0.12, 0.35],
        expected: [0.8, 2.4],
        gloss: Some(0.35),
    },
    Row {
        kind: Mark::Rings,
        on: On::Tops(TABLES),
        size: [[0.15, 0.19], [0.15, 0.19]],
        color: Rgb::new(0.12, 0.07, 0.035),
        strength: [0.16, 0.4],
        expected: [0.5, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Tops(TABLES),
        size: [[0.04, 0.16], [0.04, 0.16]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.4, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Dust,
        on: On::Tops(SHELVES),
        size: [[0.3, 0.9], [0.15, 0.35]],
        color: Rgb::new(0.42, 0.4, 0.37),
        strength: [0.07, 0.2],
        expected: [0.8, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Fingers,
        on: On::Fronts(SCREENS),
        size: [[0.2, 0.4], [0.2, 0.4]],
        color: Rgb::new(0.3, 0.3, 0.3),
        strength: [0.03, 0.09],
        expected: [0.6, 1.5],
        gloss: Some(0.3),
    },
    Row {
        kind: Mark::Fingers,
        on: On::Fronts(PANES),
        size: [[0.2, 0.45], [0.2, 0.45]],
        color: Rgb::new(0.4, 0.4, 0.4),
        strength: [0.035, 0.1],
        expected: [0.5, 1.6],
        gloss: Some(0.35),
    },
    Row {
        kind: Mark::Dust,
        on: On::Fronts(PANES),
        size: [[3.0, 3.0], [3.0, 3.0]],
        color: Rgb::new(0.5, 0.48, 0.44),
        strength: [0.03, 0.1],
        expected: [0.5, 0.9],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Leaves(LEAVES),
        size: [[0.08, 0.11], [0.14, 0.34]],
        color: DIRT,
        strength: [0.07, 0.2],
        expected: [0.9, 1.8],
        gloss: None,
    },
    Row {
        kind: Mark::Fingers,
        on: On::Leaves(LEAVES),
        size: [[0.09, 0.12], [0.1, 0.2]],
        color: DIRT,
        strength: [0.06, 0.16],
        expected: [0.6, 1.5],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Soft(SEATS),
        size: [[0.06, 0.16], [0.06, 0.16]],
        color: DIRT,
        strength: [0.1, 0.28],
        expected: [0.35, 1.3],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Soft(SEATS),
        size: [[0.22, 0.42], [0.2, 0.36]],
        color: DIRT,
        strength: [0.06, 0.15],
        expected: [0.7, 1.6],
        gloss: None,
    },
];
