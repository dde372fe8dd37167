//! Warnings that wait for more important ones.

use enfilade_scene::{Cx, Warning};
use std::sync::{Mutex, PoisonError};

/// Keeps warnings back until it is dropped: a terminal shows only a few, and without this the findings about geometry would come after a
/// hundred missing textures. Progress is passed on to the [`Cx`] below.
pub(crate) struct Held<'a> {
    below: &'a dyn Cx,
    warnings: Mutex<Vec<Warning>>,
}

impl<'a> Held<'a> {
    /// Before `below`.
    pub fn over(below: &'a dyn Cx) -> Self {
        Self { below, warnings: Mutex::default() }
    }
}

impl Cx for Held<'_> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.below.progress(what, done, total);
    }

    fn warn(&self, warning: Warning) {
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(warning);
    }
}

impl Drop for Held<'_> {
    fn drop(&mut self) {
        let warnings = std::mem::take(self.warnings.get_mut().unwrap_or_else(PoisonError::into_inner));
        warnings.into_iter().for_each(|warning| self.below.warn(warning));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Heard;

    #[test]
    fn what_is_held_comes_last_and_is_not_lost() {
        let heard = Heard::default();
        let warning = |message: &str| Warning { place: "room.obj".into(), message: message.into() };
        let held = Held::over(&heard);
        held.warn(warning("a texture is missing"));
        held.warn(warning("another one"));
        heard.warn(warning("the room is 4 cm wide"));
        drop(held);
        let said: Vec<String> = heard.lines();
        assert!(said[0].ends_with("4 cm wide") && said[1].ends_with("missing") && said[2].ends_with("another one"), "{said:?}");
    }
}
