//! What classes are called: the words of ScanNet's raw vocabulary in `aggregation.json`, and the table by which loaders turn them into numbers.
//!
//! ScanNet's own `scannetv2-labels.combined.tsv` has a row for each raw category, with its number, NYU40's number and NYU40's name. The words
//! here are raw categories of that table with the same NYU40 number, so loaders may use either; ours has the same columns up to the last one
//! that is read, and its `id` is that of `label-filt`.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::selected_frames::SelectedFrames;
use enfilade_dataset::{Class, Classes};
use enfilade_scene::NYU40;
use std::collections::{BTreeMap, BTreeSet};

/// Raw category of every class of NYU40, and the class's name, both as ScanNet's table spells them.
const WORDS: [(&str, &str); 40] = [
    ("wall", "wall"),
    ("floor", "floor"),
    ("cabinet", "cabinet"),
    ("bed", "bed"),
    ("chair", "chair"),
    ("couch", "sofa"),
    ("table", "table"),
    ("door", "door"),
    ("window", "window"),
    ("bookshelf", "bookshelf"),
    ("picture", "picture"),
    ("counter", "counter"),
    ("blinds", "blinds"),
    ("desk", "desk"),
    ("shelf", "shelves"),
    ("curtain", "curtain"),
    ("dresser", "dresser"),
    ("pillow", "pillow"),
    ("mirror", "mirror"),
    ("mat", "floor mat"),
    ("clothes", "clothes"),
    ("ceiling", "ceiling"),
    ("books", "books"),
    ("refrigerator", "refridgerator"),
    ("tv", "television"),
    ("paper", "paper"),
    ("towel", "towel"),
    ("shower curtain", "shower curtain"),
    ("box", "box"),
    ("whiteboard", "whiteboard"),
    ("person", "person"),
    ("nightstand", "night stand"),
    ("toilet", "toilet"),
    ("sink", "sink"),
    ("lamp", "lamp"),
    ("bathtub", "bathtub"),
    ("bag", "bag"),
    ("structure", "otherstructure"),
    ("furniture", "otherfurniture"),
    ("object", "otherprop"),
];

/// A class as ScanNet's files have it.
pub(super) struct Named {
    /// Raw category.
    pub word: String,
    /// Name of the class.
    pub class: String,
    pub color: [u8; 3],
}

/// The classes of a scene by number: NYU40, or the scene's own list.
pub(super) fn classes(selected: &SelectedFrames<'_>, scene: &str) -> Result<BTreeMap<i16, Named>, ExportError> {
    let classes = selected.dataset.mesh_files(scene).read_classes()?.unwrap_or_else(Classes::nyu40);
    Ok(classes.list().iter().map(|class| (class.id, named(class))).collect())
}

/// A class that is NYU40's gets ScanNet's words, one of somebody's own list keeps its name.
fn named(Class { id, name, color }: &Class) -> Named {
    let nyu40 = NYU40.iter().zip(WORDS).find(|(class, _)| class.id == *id && class.name == name);
    let own = || name.split(char::is_control).collect::<Vec<_>>().join(" ");
    let (word, class) = nyu40.map_or_else(|| (own(), own()), |(_, (word, class))| (word.into(), class.into()));
    Named { word, class, color: *color }
}

/// Writes `scannetv2-labels.combined.tsv` with the classes of all scenes.
pub(super) fn write_table(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut rows = BTreeSet::new();
    for tracks in selected.scenes() {
        let classes = classes(selected, &tracks[0].scene)?;
        rows.extend(classes.into_iter().map(|(id, Named { word, class, .. })| (id, word, class)));
    }
    let header = "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\n".to_string();
    let row = |(id, word, class): &(i16, String, String)| format!("{id}\t{word}\t{word}\t0\t{id}\t0\t{class}\t{class}\n");
    let text = header + &rows.iter().map(row).collect::<String>();
    out.write("scannetv2-labels.combined.tsv", text.as_bytes())
}
