//! A floor plan as people draw it: outlines of rooms, and where doors and windows are. Readers of files make it, and homes are built on it.

use crate::rooms::{Hinge, OpeningKind, Rooms};
use crate::slope::CeilingSlope;
use enfilade_math::{DVec2, DVec3};

/// Rooms and openings of one storey, metres, seen from above.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnPlan {
    /// The rooms, in the order of the file.
    pub rooms: Vec<DrawnRoom>,
    /// Doors, passages and windows.
    pub openings: Vec<DrawnOpening>,
    /// Sloping parts of ceilings; their heights are above the floor.
    pub slopes: Vec<CeilingSlope>,
    /// The file uses our own names of kinds: others are errors. Where it does not, kinds that nobody knows are guessed.
    pub strict: bool,
    /// What the reader left out or guessed, for people.
    pub notes: Vec<String>,
}

/// A room of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnRoom {
    /// Name in the file, for messages.
    pub name: String,
    /// What the file says that it is for.
    pub kind: String,
    /// Corners of the inner faces of its walls, or of the middles of walls that it shares with others; in either order.
    pub polygon: Vec<DVec2>,
    /// Height of the room, where the file has it.
    pub height_m: Option<f64>,
}

/// A door, passage or window of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnOpening {
    /// What it is.
    pub kind: OpeningKind,
    /// Its middle, in or near its wall.
    pub at: DVec2,
    /// Width, where the file has it.
    pub width_m: Option<f64>,
    /// Lower and upper edge above the floor, where the file has them.
    pub z_m: Option<[f64; 2]>,
    /// Number of the room into which a door swings, where the file has it.
    pub into: Option<usize>,
    /// The edge with its hinges for someone in that room, where the file has it.
    pub hinge: Option<Hinge>,
    /// How far it is open, degrees, where the file has it.
    pub open_deg: Option<f64>,
}

impl DrawnOpening {
    /// An opening of which nothing else is known.
    pub fn new(kind: OpeningKind, at: DVec2) -> Self {
        Self { kind, at, width_m: None, z_m: None, into: None, hinge: None, open_deg: None }
    }
}

impl From<&Rooms> for DrawnPlan {
    /// The rooms of a layout, whose floors are taken to one level by the caller.
    fn from(layout: &Rooms) -> Self {
        let rooms = layout.outlines.iter().map(|room| DrawnRoom {
            name: room.name.clone(),
            kind: room.kind.clone(),
            polygon: room.polygon.iter().map(|&corner| DVec2::from(corner)).collect(),
            height_m: Some(room.ceiling_z_m - room.floor_z_m),
        });
        let openings = layout.openings.iter().map(|opening| {
            let face = &layout.walls[opening.walls[0]];
            let floor = layout.outlines[face.room].floor_z_m;
            let heights = [opening.corners[0], opening.corners[2]].map(|corner| corner[2] - floor);
            DrawnOpening {
                kind: opening.kind,
                // In the middle of the wall, so that both faces are equally near.
                at: opening.center().truncate() - DVec2::from(face.inward) * (0.5 * face.thickness_m),
                width_m: Some(DVec3::from(opening.corners[0]).distance(opening.corners[1].into())),
                z_m: Some([heights[0].min(heights[1]), heights[0].max(heights[1])]),
                into: opening.leaf.map(|_| face.room),
                hinge: opening.leaf.map(|leaf| leaf.hinge),
                open_deg: opening.leaf.map(|leaf| leaf.open_deg),
            }
        });
        let slopes = layout.slopes.iter().map(|of| {
            let floor = layout.outlines[of.room].floor_z_m;
            CeilingSlope { slope: of.slope.moved(-floor * DVec3::Z), ..*of }
        });
        Self { rooms: rooms.collect(), openings: openings.collect(), slopes: slopes.collect(), strict: true, notes: Vec::new() }
    }
}
