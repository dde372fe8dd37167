//! Numbers of the instances that the scene file labels without one.

use super::Assembly;
use super::labels::FileLabel;
use crate::ImportedLabel;
use enfilade_scene::{PartLabel, is_stuff};
use std::collections::{BTreeSet, HashMap};

impl Assembly<'_> {
    /// The labels of all parts that have one, in their order. Those without a number get the first that the file does not state; it is
    /// shared by the parts of one class within what the label was given to. Wall, floor and ceiling are not counted.
    pub(super) fn numbered_labels(&self) -> Vec<ImportedLabel> {
        let stated: BTreeSet<i16> = self.file_labels.iter().filter_map(|(_, label)| label.instance).collect();
        let mut free = (1..=i16::MAX).filter(|number| !stated.contains(number));
        let mut known: HashMap<(u32, i16), i16> = HashMap::new();
        let number = |(part, label): &(u32, FileLabel)| {
            let FileLabel { semantic, instance, whole } = *label;
            let instance = match instance {
                Some(stated) => stated,
                None if semantic == -1 || is_stuff(semantic) => -1,
                None => {
                    let whole = whole.unwrap_or_else(|| self.scene.object_of(*part));
                    *known.entry((whole, semantic)).or_insert_with(|| free.next().unwrap_or(-1))
                }
            };
            ImportedLabel { part: *part, label: PartLabel { semantic, instance } }
        };
        self.file_labels.iter().map(number).filter(|found| found.label != PartLabel::NONE).collect()
    }
}
