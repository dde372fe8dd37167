//! Verification: the laws that tie the layers, poses, labels and files of a dataset together.
//!
//! [`LAWS`] states them. A [`Card`] collects the worst value of each; a [`VerifyReport`] is its outcome, for machines and
//! people, together with what the [gates](crate::gates) measured of each frame and how well neighbouring frames agree. Every law is computed here anew from the stored values, in double precision, with nothing taken from the renderer.

mod boxes;
mod camera_files;
mod card;
mod color;
mod dataset;
mod extra;
mod frame_values;
mod geometry;
mod labels;
mod law;
mod page;
mod read;
mod release;
mod report;
mod rounding;
mod scan;
#[cfg(test)]
mod tests;
mod trajectory;
mod two_views;
mod whole;

pub use card::Card;
pub use dataset::{FrameVerifier, verify_listed_scene, verify_scene};
pub use frame_values::FrameValues;
pub use labels::check_labels;
pub use law::{LAWS, Law, LawSpec};
pub use page::report_page;
pub use release::{Excuse, Excused};
pub use report::{GateResult, LawResult, VerifyReport};
pub use rounding::Rounding;
pub use trajectory::{PlanRules, check_trajectory};
pub use two_views::{Compared, PairValues};
pub use whole::{join_reports, write_report};

use enfilade_dataset::RELEASED_LAYERS;
use enfilade_frame::{Frame, LAYERS, Pass};
use enfilade_scene::{CameraView, Labels, PartLabel};
use scan::Scan;

/// What a frame is checked against.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// What it was taken with, and where that stood.
    pub camera: CameraView<'a>,
    /// How its distances and positions, which are in metres, were rounded when they were stored.
    pub rounding: Rounding,
    /// True for frames of Hypersim's release, which has fewer layers.
    pub released: bool,
    /// Number of render entities.
    pub entities: usize,
    /// Labels by render entity (`parts[i]` is entity i + 1), where the scene has label tables.
    pub labels: Option<&'a Labels>,
    /// Labels of the other pieces of parts that people split, by render entity; empty where nothing was split.
    pub pieces: &'a [(u32, PartLabel)],
    /// The greatest class of the scene's list: 40 of NYU40.
    pub last_class: i16,
}

/// Checks every law about one frame. `place` names the frame.
///
/// Laws about layers that the frame lacks are not checked, beyond the one that asks for all layers.
pub fn check_frame(frame: &Frame, view: &View<'_>, place: &str) -> Card {
    let mut scan = Scan::new(frame, view, place);
    // Optional layers are there where they were asked for, and then all of their kind.
    let has = |pass: Pass| LAYERS.iter().any(|spec| spec.pass == pass && frame.get(spec.layer).is_some());
    let expected = LAYERS.iter().filter(|spec| match view.released {
        true => RELEASED_LAYERS.contains(&spec.layer),
        false => !spec.pass.is_optional() || has(spec.pass),
    });
    let missing: Vec<&str> = expected.filter(|spec| frame.get(spec.layer).is_none()).map(|spec| spec.name).collect();
    scan.card.observe(Law::LayersPresent, missing.len() as f64, || format!("{place}: without {}", missing.join(", ")));
    let [width, height] = view.camera.camera().size();
    let size_error = frame.width.abs_diff(width).max(frame.height.abs_diff(height));
    let sizes = || format!("{place}: images of {}x{}, table says {width}x{height}", frame.width, frame.height);
    scan.card.observe(Law::Calibration, f64::from(size_error), sizes);
    if size_error == 0 {
        geometry::check(&mut scan);
    }
    color::check(&mut scan);
    extra::check(&mut scan);
    labels::check(&mut scan);
    scan.card
}
