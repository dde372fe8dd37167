//! The laws about one frame, in the order in which a reader of the report meets them.

use crate::card::Card;
use crate::law::Law;
use crate::scan::Scan;
use crate::view::View;
use crate::{color, extra, geometry, labels};
use enfilade_dataset::RELEASED_LAYERS;
use enfilade_frame::{Frame, LAYERS, Layer, Pass};

/// Layers that were added to their kind later: frames of earlier versions have all others of it.
const ADDED: [Layer; 1] = [Layer::DepthBeyondMeters];

/// Checks every law about one frame. `place` names the frame.
///
/// Laws about layers that the frame lacks are not checked, except the one that requires all layers.
pub fn check_frame(frame: &Frame, view: &View<'_>, place: &str) -> Card {
    let mut scan = Scan::new(frame, view, place);
    // Optional layers exist if they were requested, and then all of their kind.
    let has = |pass: Pass| LAYERS.iter().any(|spec| spec.pass == pass && frame.get(spec.layer).is_some());
    let expected = LAYERS.iter().filter(|spec| match view.released {
        true => RELEASED_LAYERS.contains(&spec.layer),
        false => !spec.pass.is_optional() || has(spec.pass) && !ADDED.contains(&spec.layer),
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
