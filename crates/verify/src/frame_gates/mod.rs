//! Gates: requirements that users of training data have for a frame.
//!
//! [`GATES`] is the one table: the measure, the limit, and the source of the rule. A frame that a gate rejects is not wrong (errors are
//! found by the laws of `verify`), but it is not useful for training. [`view_values`] needs only geometry layers, so that views can be
//! judged before light is computed; [`light_values`] needs the colour layers.

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
