//! Going over the pixels of a frame: what the frame laws share.

use super::View;
use super::card::Card;
use super::law::Law;
use enfilade_frame::{DENOISED, Frame, Layer, Values};
use enfilade_math::{DMat3, DVec3};

/// One frame under examination.
pub(super) struct Scan<'a> {
    pub frame: &'a Frame,
    pub view: &'a View<'a>,
    pub card: Card,
    /// Camera centre and world from camera, by row.
    pub rows: Vec<(DVec3, DMat3)>,
    /// Direction through the centre of each pixel, in camera space, unit length; NaN where the picture shows nothing.
    pub directions: Vec<DVec3>,
    place: &'a str,
}

impl<'a> Scan<'a> {
    pub fn new(frame: &'a Frame, view: &'a View<'a>, place: &'a str) -> Self {
        let (camera, middle) = (view.camera, |i: u32| f64::from(i) + 0.5);
        let rows = (0..frame.height).map(|y| camera.row_placement(middle(y))).collect();
        let direction = |x: u32, y: u32| camera.camera().projection.ray(middle(x), middle(y)).map_or(DVec3::NAN, DVec3::normalize);
        let directions = (0..frame.height).flat_map(|y| (0..frame.width).map(move |x| direction(x, y))).collect();
        Self { frame, view, card: Card::default(), rows, directions, place }
    }

    pub fn layer(&self, layer: Layer) -> Option<&'a Values> {
        self.frame.get(layer)
    }

    /// The rendered version of a layer that denoising replaces; `None` if it is denoised and the rendered version was not kept.
    pub fn rendered(&self, layer: Layer) -> Option<&'a Values> {
        let kept = DENOISED.into_iter().find(|(plain, _)| *plain == layer).and_then(|(_, kept)| self.layer(kept));
        kept.or_else(|| self.layer(layer).filter(|_| !self.view.denoised))
    }

    /// The pixels that see the scene, by `render_entity_id`; none without that layer.
    pub fn seen(&self) -> Vec<usize> {
        let ids = self.layer(Layer::RenderEntityId);
        ids.map_or(vec![], |ids| (0..ids.len()).filter(|&i| ids.get(i) != -1.0).collect())
    }

    /// Observes the largest value, NaN counting as infinite. `what` describes it after "pixel (x, y): ".
    pub fn worst(&mut self, law: Law, what: &str, values: impl Iterator<Item = (usize, f64)>) {
        let mut worst: Option<(usize, f64)> = None;
        for (pixel, value) in values {
            let value = if value.is_nan() { f64::INFINITY } else { value };
            if worst.is_none_or(|(_, w)| value > w) {
                worst = Some((pixel, value));
            }
        }
        if let Some((pixel, value)) = worst {
            self.observe_at(law, value, pixel, what);
        }
    }

    /// Observes how many pixels (or values) break a law, and the first of them.
    pub fn broken(&mut self, law: Law, what: &str, mut pixels: impl Iterator<Item = usize>) {
        match pixels.next() {
            None => self.card.observe(law, 0.0, || self.place.to_string()),
            Some(first) => self.observe_at(law, 1.0 + pixels.count() as f64, first, what),
        }
    }

    pub fn observe_at(&mut self, law: Law, value: f64, pixel: usize, what: &str) {
        let (x, y) = (pixel % self.frame.width as usize, pixel / self.frame.width as usize);
        let id = self.layer(Layer::RenderEntityId).map_or(String::new(), |ids| format!(", part {}", ids.get(pixel)));
        self.card.observe(law, value, || format!("{} pixel ({x}, {y}){id}: {what}", self.place));
    }

    /// Camera centre and world from camera when `pixel` was exposed.
    pub fn placement(&self, pixel: usize) -> (DVec3, DMat3) {
        self.rows[pixel / self.frame.width as usize]
    }
}
