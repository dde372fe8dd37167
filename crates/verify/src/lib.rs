//! Is it true, and is it worth having: the laws that tie the layers, poses, labels and files of a dataset together, and the gates.
//!
//! [`LAWS`] states them. A [`Card`] collects the worst value of each; a [`VerifyReport`] is its outcome, for machines and
//! people, together with what the [gates](frame_gates) measured of each frame and how well neighbouring frames agree. Every law is
//! computed here again from the stored values, in double precision, with nothing taken from the renderer.

mod boxes;
mod camera_files;
mod card;
mod color;
mod dataset;
mod described;
mod extra;
mod fixtures;
mod frame;
pub mod frame_gates;
mod frame_values;
mod geometry;
mod labels;
mod law;
mod many_views;
mod not_judged;
mod pair_flow;
mod plane_ids;
mod read;
mod relations;
mod release;
mod report;
mod rooms;
mod rounding;
mod scan;
mod sensed;
mod surfaces;
#[cfg(test)]
mod tests;
mod tracks;
mod trajectory;
mod two_views;
mod view;
pub mod view_gates;
mod walk;
mod whole;
mod worth;

pub use card::Card;
pub use dataset::{FrameVerifier, verify_listed_scene, verify_scene};
pub use frame::check_frame;
pub use frame_values::FrameValues;
pub use labels::check_labels;
pub use law::{LAWS, Law, LawSpec};
pub use not_judged::NotJudged;
pub use release::{Excuse, Excused};
pub use report::{GateResult, LawResult, VerifyReport, number};
pub use rounding::Rounding;
pub use trajectory::{PlanRules, check_trajectory};
pub use two_views::{Compared, PairValues};
pub use view::View;
pub use whole::{join_reports, write_report_json};
