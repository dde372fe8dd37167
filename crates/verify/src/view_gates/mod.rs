//! Gates of views: which ones are not worth rendering, judged by their geometry before any light is computed.
//!
//! [`VIEW_GATES`] is the one table, the worst fault first; a view is rejected for the first one that it has. Depth range, planes and
//! invalid pixels are measured as for finished frames ([`crate::frame_gates`]), so that a view that passes here passes there.

mod config;
mod gate;
mod measure;

pub use config::{GateAction, GateConfig, GateKeys, LimitError};
pub use gate::{VIEW_GATES, ViewGate, ViewGateSpec};
pub use measure::{Place, ViewMeasures};
