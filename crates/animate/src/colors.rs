//! The colours of a picture, for the forms that keep a list of them.

use std::collections::BTreeSet;

/// The colours of a picture, ascending; `None` when there are more than 256.
pub(crate) fn few_colors(rgb: &[[u8; 3]]) -> Option<Vec<[u8; 3]>> {
    let mut colors = BTreeSet::new();
    let mut last = None;
    for &color in rgb {
        if last != Some(color) && colors.insert(color) && colors.len() > 256 {
            return None;
        }
        last = Some(color);
    }
    Some(colors.into_iter().collect())
}
