//! The table of gates of views, the worst fault first.

/// A fault of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "VIEW_GATES describes each one")]
pub enum ViewGate {
    Blank,
    Buried,
    Outside,
    BackFaces,
    Blocked,
    BareWall,
    DepthRange,
    Invalid,
}

/// The definition of a gate of views.
#[derive(Clone, Copy, Debug)]
pub struct ViewGateSpec {
    /// Which one.
    pub gate: ViewGate,
    /// In files.
    pub name: &'static str,
    /// The measure.
    pub measure: &'static str,
    /// Name of that in files.
    pub column: &'static str,
    /// The key of `[gate]` that sets the limit.
    pub key: &'static str,
    /// In words, after "the camera" or "the view".
    pub meaning: &'static str,
}

/// The table of gates of views; `VIEW_GATES[gate as usize].gate == gate`.
pub const VIEW_GATES: [ViewGateSpec; 8] = [
    ViewGateSpec {
        gate: ViewGate::Blank,
        name: "blank",
        measure: "share of the pixels that show no surface",
        column: "void_share",
        key: "max_void_share",
        meaning: "shows nothing or nearly nothing",
    },
    ViewGateSpec {
        gate: ViewGate::Buried,
        name: "buried",
        measure: "share of all directions around the camera in which there is a back face, or a surface nearer than enclosed_m",
        column: "enclosed_share",
        key: "max_enclosed_share",
        meaning: "stands within an object or a wall",
    },
    ViewGateSpec {
        gate: ViewGate::Outside,
        name: "outside",
        measure: "share of the level directions around the camera in which there is nothing, or a back face",
        column: "open_share",
        key: "max_open_share",
        meaning: "stands outside of the building",
    },
    ViewGateSpec {
        gate: ViewGate::BackFaces,
        name: "back_faces",
        measure: "share of the pixels that show the back of a surface whose front is what one sees from the start cameras",
        column: "back_face_share",
        key: "max_back_face_share",
        meaning: "sees things from behind, as from outside of a room or through a wall",
    },
    ViewGateSpec {
        gate: ViewGate::Blocked,
        name: "blocked",
        measure: "share of the pixels that show a surface nearer than min_depth_m",
        column: "near_share",
        key: "max_near_share",
        meaning: "is blocked by something near",
    },
    ViewGateSpec {
        gate: ViewGate::BareWall,
        name: "bare_wall",
        measure: "share of the pixels that the largest plane fills",
        column: "plane_share",
        key: "max_plane_share",
        meaning: "shows one bare wall, floor or ceiling",
    },
    ViewGateSpec {
        gate: ViewGate::DepthRange,
        name: "depth_range",
        measure: "largest minus smallest planar depth, m",
        column: "depth_range_m",
        key: "min_depth_range_m",
        meaning: "shows too little depth",
    },
    ViewGateSpec {
        gate: ViewGate::Invalid,
        name: "invalid",
        measure: "share of the pixels in which the camera sees that have no depth",
        column: "invalid_share",
        key: "max_invalid_share",
        meaning: "looks out of the scene in too many pixels",
    },
];

impl ViewGate {
    /// The gate's row of the table.
    pub const fn spec(self) -> &'static ViewGateSpec {
        &VIEW_GATES[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum() {
        for (i, spec) in VIEW_GATES.iter().enumerate() {
            assert_eq!(spec.gate as usize, i);
        }
    }
}
