//! V-Ray's scene description: reading, writing back byte by byte, and the edits that a job makes.

use crate::Run;
#[cfg(feature = "dataset")]
use enfilade_vray::edit::{IMAGE_FILTERS, file_references, linear_output, meters_per_asset_unit, node_strings, reduce_size, remove_kinds};
use enfilade_vrscene::{Document, Value};
use std::path::Path;

/// Reads a document and every value in it. What was not edited must be written as it was read, and a value that was written must be
/// readable.
pub fn document(_: &Path) -> Run {
    Box::new(|bytes| {
        drop(Value::parse(bytes));
        #[cfg_attr(not(feature = "dataset"), allow(unused_mut, reason = "edits come with datasets"))]
        let Ok(mut document) = Document::parse(bytes) else { return };
        assert!(document.to_bytes() == bytes, "a document that was not edited is written as it was read");
        for parameter in document.plugins().flat_map(|plugin| plugin.parameters()) {
            if let Ok(value) = parameter.value() {
                Value::parse(&value.to_bytes()).expect("a value that was written can be read");
            }
        }
        #[cfg(feature = "dataset")]
        {
            edit(&mut document);
            Document::parse(document.to_bytes()).expect("an edited document can be read");
        }
    })
}

#[cfg(feature = "dataset")]
fn edit(document: &mut Document) {
    drop((file_references(document), meters_per_asset_unit(document)));
    document.of_kind("Node").for_each(|node| drop(node_strings(document, node)));
    linear_output(document);
    reduce_size(document);
    let _ = remove_kinds(document, &IMAGE_FILTERS);
}
