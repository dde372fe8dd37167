//! A frame's color as people see it, for points and small pictures that the server colours itself.

use super::place::FramePlace;
use super::viewer::Viewer;
use enfilade_frame::Layer;
use enfilade_frame::tonemap::{ToneMap, brightness, percentile};
use enfilade_serve::ApiProblem;

impl Viewer {
    /// The layer that shows a frame as people see it: color, or what was rendered while color is still to be made; `None` without either.
    pub(super) fn color_layer(&self, place: &FramePlace) -> Option<Layer> {
        let has = |layer: &Layer| self.dataset.has_layer(&place.scene, &place.camera, place.frame, *layer);
        [Layer::Color, Layer::ColorRendered].into_iter().find(has)
    }

    /// A frame's color after Hypersim's tone map; `None` if the frame has no color of this many pixels.
    pub(super) fn tone_mapped(&self, place: &FramePlace, pixels: usize) -> Result<Option<Vec<[u8; 3]>>, ApiProblem> {
        let Some(layer) = self.color_layer(place) else { return Ok(None) };
        let color = self.layer(place, layer)?;
        if color.shape[0] * color.shape[1] != pixels {
            return Ok(None);
        }
        let radiance = |i: usize| [0, 1, 2].map(|c| color.number(3 * i + c));
        // A table that cannot be read is reported where it is shown; here the picture is exposed by itself.
        let rows = self.tone_maps(&place.scene, &place.camera).unwrap_or_default();
        let row = rows.into_iter().find(|row| row.frame == place.frame);
        let tone = match row {
            Some(row) => ToneMap { scale: row.scale },
            // A sixteenth of the pixels is enough for the percentile of a small picture.
            None => ToneMap::of_percentile(percentile((0..pixels).step_by(16).map(|i| brightness(radiance(i))).collect())),
        };
        // A table of 4096 steps: a power for each channel of each pixel would take ten times as long.
        let curve: Vec<u8> =
            (0..=4096).map(|i| (tone.apply(f64::from(i) / 4096.0 / tone.scale.max(1e-30)) * 255.0).round() as u8).collect();
        let shown = |v: f64| curve[((v * tone.scale).clamp(0.0, 1.0) * 4096.0) as usize];
        Ok(Some((0..pixels).map(|i| radiance(i).map(|v| if v.is_nan() { 0 } else { shown(v) })).collect()))
    }
}
