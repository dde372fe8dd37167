//! Lists of extensions in prose, which code cannot make, are those of the table of formats.

use enfilade_import::Format;
use std::path::Path;

#[test]
fn prose_names_every_extension() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for file in ["docs/annotate.md", "crates/python/src/scene_files.rs"] {
        let text = std::fs::read_to_string(root.join(file)).unwrap();
        // As it is read: a list may run over several lines, of a doc comment too.
        let text = text.lines().map(|line| line.trim_start_matches("///").trim()).collect::<Vec<_>>().join(" ");
        assert!(text.contains(&Format::extensions()), "{file} should list {}", Format::extensions());
    }
    let table = std::fs::read_to_string(root.join("docs/import.md")).unwrap();
    for extension in Format::extensions().split(", ") {
        assert!(table.contains(&format!("`{extension}`")), "docs/import.md should list {extension}");
    }
}
