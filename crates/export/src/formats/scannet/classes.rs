//! Names of classes: the words of ScanNet's raw vocabulary in `aggregation.json`, and the table by which loaders turn them into numbers.
//!
//! ScanNet's own `scannetv2-labels.combined.tsv` has a row for each raw category, with its number, NYU40's number and NYU40's name. The words
//! here are raw categories of that table with the same NYU40 number, and of the list of 200 classes of its benchmark ScanNet200 (Rozenberszki
//! et al. 2022), whose numbers are the raw ones. So loaders may use either table; ours has the same columns up to the last one that is read.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::selected_frames::SelectedFrames;
use enfilade_dataset::{Class, Classes};
use enfilade_scene::{NYU40, Warning};
use std::collections::{BTreeMap, BTreeSet};

/// The table's name.
const TABLE: &str = "scannetv2-labels.combined.tsv";

/// Number and raw category of every class of NYU40, and the class's name, all as ScanNet's table has them.
const WORDS: [(u16, &str, &str); 40] = [
    (1, "wall", "wall"),
    (3, "floor", "floor"),
    (7, "cabinet", "cabinet"),
    (11, "bed", "bed"),
    (2, "chair", "chair"),
    (6, "couch", "sofa"),
    (4, "table", "table"),
    (5, "door", "door"),
    (16, "window", "window"),
    (18, "bookshelf", "bookshelf"),
    (15, "picture", "picture"),
    (35, "counter", "counter"),
    (86, "blinds", "blinds"),
    (9, "desk", "desk"),
    (8, "shelf", "shelves"),
    (21, "curtain", "curtain"),
    (36, "dresser", "dresser"),
    (13, "pillow", "pillow"),
    (71, "mirror", "mirror"),
    (140, "mat", "floor mat"),
    (32, "clothes", "clothes"),
    (41, "ceiling", "ceiling"),
    (22, "book", "books"),
    (27, "refrigerator", "refridgerator"),
    (33, "tv", "television"),
    (79, "paper", "paper"),
    (31, "towel", "towel"),
    (55, "shower curtain", "shower curtain"),
    (26, "box", "box"),
    (52, "whiteboard", "whiteboard"),
    (80, "person", "person"),
    (34, "nightstand", "night stand"),
    (17, "toilet", "toilet"),
    (14, "sink", "sink"),
    (28, "lamp", "lamp"),
    (42, "bathtub", "bathtub"),
    (47, "bag", "bag"),
    (1178, "structure", "otherstructure"),
    (213, "furniture", "otherfurniture"),
    (1163, "object", "otherprop"),
];

/// A class as ScanNet's files have it.
pub(super) struct Named {
    /// Number of the raw category, which `label-filt` has.
    pub raw: u16,
    /// Raw category.
    pub word: String,
    /// Name of the class.
    pub class: String,
    pub color: [u8; 3],
}

/// The classes of a scene by number: NYU40, or the scene's own list.
pub(super) fn classes(selected: &SelectedFrames<'_>, scene: &str) -> Result<BTreeMap<i16, Named>, ExportError> {
    Ok(named(&selected.dataset.mesh_files(scene).read_classes()?.unwrap_or_else(Classes::nyu40)))
}

/// Classes that are NYU40's get ScanNet's numbers and words. Somebody's own list keeps its numbers, all of them, since two kinds of numbers in
/// one list could meet, and its names but where both are NYU40's.
fn named(classes: &Classes) -> BTreeMap<i16, Named> {
    let row = |of: &Class| NYU40.iter().zip(WORDS).find(|(class, _)| class.id == of.id && class.name == of.name).map(|(_, row)| row);
    let is_nyu40 = classes.list().iter().all(|class| row(class).is_some());
    let named = |class: &Class| {
        let own = || class.name.split(char::is_control).collect::<Vec<_>>().join(" ");
        let number = u16::try_from(class.id).unwrap_or(0);
        let (raw, word, name) = row(class)
            .map_or_else(|| (number, own(), own()), |(raw, word, name)| (if is_nyu40 { raw } else { number }, word.into(), name.into()));
        (class.id, Named { raw, word, class: name, color: class.color })
    };
    classes.list().iter().map(named).collect()
}

/// Writes `scannetv2-labels.combined.tsv` with the classes of all scenes.
pub(super) fn write_table(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut rows = BTreeSet::new();
    for tracks in selected.scenes() {
        let classes = classes(selected, &tracks[0].scene)?;
        rows.extend(classes.into_iter().map(|(id, Named { raw, word, class, .. })| (raw, word, class, id)));
    }
    let rows: Vec<_> = rows.into_iter().collect();
    if let Some([(raw, one, ..), (_, other, ..)]) = rows.array_windows().find(|[one, other]| one.0 == other.0) {
        let message = format!(
            "number {raw} is both `{one}` and `{other}`, by lists of different scenes: export scenes of one list at a time (--scene)"
        );
        selected.warn(Warning { place: TABLE.into(), message });
    }
    let header = "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\n".to_string();
    let row = |(raw, word, class, id): &(u16, String, String, i16)| format!("{raw}\t{word}\t{word}\t0\t{id}\t0\t{class}\t{class}\n");
    let text = header + &rows.iter().map(row).collect::<String>();
    out.write(TABLE, text.as_bytes())
}
