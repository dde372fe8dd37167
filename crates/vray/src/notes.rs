//! Notes about images that occur many times: each is reported once, with its number of occurrences and the first place.

use enfilade_scene::{Cx, Warning};
use std::collections::BTreeMap;

/// The notes, by message.
#[derive(Debug, Default)]
pub(crate) struct Notes(BTreeMap<String, Noted>);

#[derive(Debug)]
struct Noted {
    first: String,
    images: u64,
    pixels: u64,
}

impl Notes {
    /// About an image as a whole.
    pub fn add(&mut self, message: &str, place: &str) {
        self.note(message, place, 0);
    }

    /// About `pixels` of its pixels; not noted where that is 0.
    pub fn count(&mut self, message: &str, place: &str, pixels: usize) {
        if pixels > 0 {
            self.note(message, place, pixels as u64);
        }
    }

    fn note(&mut self, message: &str, place: &str, pixels: u64) {
        let noted = self.0.entry(message.into()).or_insert_with(|| Noted { first: place.into(), images: 0, pixels: 0 });
        noted.images += 1;
        noted.pixels += pixels;
    }

    /// Reports all notes.
    pub fn tell(&self, cx: &dyn Cx) {
        for (message, Noted { first, images, pixels }) in &self.0 {
            let often = if *pixels > 0 { format!("{pixels} pixels of {images} images") } else { format!("{images} images") };
            cx.warn(Warning { place: first.clone(), message: format!("{message} ({often}, this one first)") });
        }
    }
}
