//! The instances that a frame shows: which pixels, which class, which box.

use crate::ExportError;
use crate::selected_frames::SelectedFrames;
use enfilade_frame::{Frame, Layer};
use enfilade_scene::Warning;
use std::collections::BTreeMap;

/// The visible part of one instance.
pub(crate) struct Instance {
    /// Number within the scene, from 1.
    pub number: i16,
    /// NYU40 class of most of its pixels, the lowest of several; −1 when it has none.
    pub semantic: i16,
    /// Indices of its pixels, row by row, ascending.
    pub pixels: Vec<usize>,
}

/// True where a part of the scenes is an instance.
pub(crate) fn are_labelled(selected: &SelectedFrames<'_>) -> Result<bool, ExportError> {
    let labels = selected.scenes().map(|tracks| selected.labels(&tracks[0].scene)).collect::<Result<Vec<_>, _>>()?;
    Ok(labels.iter().flat_map(|labels| &labels.parts).any(|label| label.instance >= 1))
}

/// Warns if an export of instances found none, and says why. `found` is true if there is one.
pub(crate) fn warn_of_none(selected: &SelectedFrames<'_>, found: bool) -> Result<(), ExportError> {
    if found {
        return Ok(());
    }
    let (mut classed, mut numbered) = (0, 0);
    for tracks in selected.scenes() {
        let labels = selected.labels(&tracks[0].scene)?.parts;
        classed += labels.iter().filter(|label| label.semantic >= 1).count();
        numbered += labels.iter().filter(|label| label.instance >= 1).count();
    }
    let why = match (classed, numbered) {
        (_, 1..) => "none of the frames shows one; select others, or place cameras nearer to things".to_string(),
        (0, 0) => "no part has a label; name a label table, or use enfilade suggest or enfilade annotate".to_string(),
        (classed, 0) => format!(
            "{classed} parts have a class and none is an instance: walls, floors and ceilings are not counted, nor is what the label table \
             gives the instance -1"
        ),
    };
    let message = format!("the export has no instance: {why}");
    selected.warn(Warning { place: selected.dataset.root().display().to_string(), message });
    Ok(())
}

/// The instances of a frame with `semantic_instance`, by number.
pub(crate) fn instances(frame: &Frame) -> Vec<Instance> {
    let Some(numbers) = frame.get(Layer::SemanticInstance) else { return Vec::new() };
    let mut pixels: BTreeMap<i16, Vec<usize>> = BTreeMap::new();
    for i in 0..frame.pixels() {
        let number = numbers.get(i) as i16;
        if number > 0 {
            pixels.entry(number).or_default().push(i);
        }
    }
    pixels.into_iter().map(|(number, pixels)| Instance { number, semantic: class_of(frame, &pixels), pixels }).collect()
}

/// The class of most of the pixels.
fn class_of(frame: &Frame, pixels: &[usize]) -> i16 {
    let Some(semantic) = frame.get(Layer::Semantic) else { return -1 };
    let mut counts: BTreeMap<i16, usize> = BTreeMap::new();
    for class in pixels.iter().map(|&i| semantic.get(i) as i16).filter(|class| (1..=40).contains(class)) {
        *counts.entry(class).or_default() += 1;
    }
    counts.into_iter().max_by_key(|&(class, count)| (count, -class)).map_or(-1, |(class, _)| class)
}

impl Instance {
    /// First and last column and row of its pixels: `[x_min, y_min, x_max, y_max]`.
    pub fn extent(&self, width: u32) -> [u32; 4] {
        let at = |i: usize| [(i % width as usize) as u32, (i / width as usize) as u32];
        self.pixels
            .iter()
            .map(|&i| at(i))
            .fold([u32::MAX, u32::MAX, 0, 0], |e, [x, y]| [e[0].min(x), e[1].min(y), e[2].max(x), e[3].max(y)])
    }

    /// 255 on its pixels, 0 elsewhere.
    pub fn mask(&self, frame: &Frame) -> Vec<u8> {
        let mut mask = vec![0; frame.pixels()];
        self.pixels.iter().for_each(|&i| mask[i] = 255);
        mask
    }
}
