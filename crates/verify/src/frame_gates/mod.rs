//! Gates: what those who train on such data ask of a frame before they take it.
//!
//! [`GATES`] is the one table: what is measured, the limit, and whose rule it is. A frame that a gate rejects is not wrong (that is
//! for the laws of `verify`), but nobody will use it. [`view_values`] needs geometry layers alone, so that views can be judged before light
//! is computed; [`light_values`] needs the colour layers.

mod gate;
mod light;
mod view;

pub use gate::{GATES, Gate, GateSpec, GateValues, Limit};
pub use light::light_values;
pub use view::{largest_plane_share, view_values};

use enfilade_frame::Frame;

/// All that can be measured of a frame, in `seeing` of whose pixels the camera sees at all.
pub fn gate_values(frame: &Frame, seeing: usize) -> GateValues {
    let mut values = view_values(frame, seeing);
    values.extend(light_values(frame));
    values
}
