//! Circles: within a crate, no file imports another that imports it back, directly or indirectly, and no module does, taken with all files
//! below it.
//!
//! A file imports another if it names an item that the other defines, in a `use` or in a path. Names are followed through
//! re-exports to the file that defines them, so a parent that re-exports its children imports nothing by that, and a file that takes a
//! child's item by way of its parent imports the child. Tests are not looked at, and neither are methods, because no path names their file.

mod graph;
mod modules;

use crate::floors;
use crate::house::House;
use graph::Imports;
use modules::Crate;

/// Circles that stay: a file of the circle, and why.
const KEPT: [(&str, &str); 1] = [(
    "crates/render/src/prepared.rs",
    "a prepared scene has its lights, and lights are chosen, sampled and learned in a prepared scene; its files are in no circle",
)];

/// Checks all crates.
///
/// # Errors
/// With every circle, and what ties it.
pub fn check(house: &House) -> Result<String, String> {
    let (mut files, mut found) = (0, Vec::new());
    for name in floors::manifests(house)?.keys() {
        let folder = if name == "xtask" { name.clone() } else { format!("crates/{name}") };
        let modules = Crate::read(house, &folder)?;
        files += modules.files.len();
        found.extend(circles_of(&modules).into_iter().filter(|circle| !KEPT.iter().any(|(kept, _)| circle.contains(kept))));
    }
    if found.is_empty() { Ok(format!("{files} files, {} circles kept", KEPT.len())) } else { Err(found.join("\n  ")) }
}

/// The circles of a crate in words: circles of files, then circles of modules that do not follow from circles of files.
fn circles_of(modules: &Crate) -> Vec<String> {
    let imports = modules.imports();
    let files = graph::circles(&imports);
    if !files.is_empty() {
        return files.iter().map(|circle| told(modules, &imports, circle)).collect();
    }
    let within = modules.imports_within(&imports);
    within.values().flat_map(|imports| graph::circles(imports).into_iter().map(|circle| told_of_modules(imports, &circle))).collect()
}

/// A circle in words: its files, then which imports what from which.
fn told(modules: &Crate, imports: &Imports, circle: &[usize]) -> String {
    let names: Vec<&str> = circle.iter().map(|&file| modules.files[file].as_str()).collect();
    let mut text = format!("{} files import each other in a circle: {}", circle.len(), names.join(", "));
    for (&(from, to), items) in imports.iter().filter(|((from, to), _)| circle.contains(from) && circle.contains(to)) {
        let items: Vec<&str> = items.iter().map(String::as_str).collect();
        text += &format!("\n    {} -> {}: {}", modules.files[from], modules.files[to], items.join(", "));
    }
    text
}

/// A circle of modules in words: their paths, then which file imports what from which.
fn told_of_modules(imports: &Imports<modules::Path>, circle: &[modules::Path]) -> String {
    let names: Vec<String> = circle.iter().map(|path| path.join("::")).collect();
    let mut text = format!("{} modules import each other in a circle: {}", circle.len(), names.join(", "));
    for (_, lines) in imports.iter().filter(|((from, to), _)| circle.contains(from) && circle.contains(to)) {
        lines.iter().for_each(|line| text += &format!("\n    {line}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let modules = Crate::parse("src/lib.rs", &|path| files.iter().find(|(name, _)| *name == path).map(|(_, text)| (*text).into()));
        circles_of(&modules.unwrap())
    }

    #[test]
    fn two_files_that_name_each_others_items_are_a_circle() {
        let found = circles(&[
            ("src/lib.rs", "mod a; mod b;"),
            ("src/a.rs", "use crate::b::Roof; pub struct Wall(Roof);"),
            ("src/b.rs", "pub struct Roof; fn f() -> super::a::Wall { loop {} }"),
        ]);
        assert_eq!(
            found,
            ["2 files import each other in a circle: src/a.rs, src/b.rs\n    src/a.rs -> src/b.rs: Roof\n    src/b.rs -> src/a.rs: Wall"]
        );
    }

    #[test]
    fn a_parent_that_only_re_exports_its_children_is_in_no_circle() {
        let parent = "mod a; mod b; pub use a::Wall; pub(crate) use b::*;";
        let child = ("src/a.rs", "use super::Roof; pub struct Wall;");
        assert!(circles(&[("src/lib.rs", parent), child, ("src/b.rs", "pub struct Roof;")]).is_empty());
        let found = circles(&[("src/lib.rs", parent), child, ("src/b.rs", "pub struct Roof(crate::Wall);")]);
        assert_eq!(found.len(), 1, "{found:?}");
    }

    #[test]
    fn a_parent_that_calls_a_child_which_takes_its_types_is_a_circle() {
        let child = ("src/a.rs", "use super::*; pub fn wall(_: House) {}");
        assert_eq!(circles(&[("src/lib.rs", "mod a; pub struct House; fn f() { a::wall(House) }"), child]).len(), 1);
        assert!(circles(&[("src/lib.rs", "mod a; pub struct House;"), child]).is_empty());
    }

    #[test]
    fn two_modules_whose_files_name_each_others_items_are_a_circle() {
        let files = [
            ("src/lib.rs", "mod a; mod b;"),
            ("src/a/mod.rs", "mod wall; pub mod floor; pub use wall::Wall;"),
            ("src/a/wall.rs", "use crate::b::Roof; pub struct Wall(Roof);"),
            ("src/a/floor.rs", "pub struct Floor;"),
            ("src/b.rs", "use crate::a::floor::Floor; pub struct Roof(Floor);"),
        ];
        assert_eq!(
            circles(&files),
            ["2 modules import each other in a circle: a, b\n    src/a/wall.rs -> src/b.rs: Roof\n    src/b.rs -> src/a/floor.rs: Floor"]
        );
        assert!(circles(&[files[0], files[1], files[2], files[3], ("src/b.rs", "pub struct Roof;")]).is_empty());
    }

    #[test]
    fn tests_and_inline_modules_of_one_file_are_no_circle() {
        let tests = "pub struct Wall; #[cfg(test)] mod tests { use crate::b::Roof; }";
        let files = [("src/lib.rs", "mod a; mod b;"), ("src/a.rs", tests), ("src/b.rs", "use crate::a::Wall; pub struct Roof;")];
        assert!(circles(&files).is_empty());
        assert!(circles(&[("src/lib.rs", "mod a { pub fn f() { super::g() } } fn g() { a::f() }")]).is_empty());
    }

    #[test]
    fn modules_lie_beside_their_parent_or_below_it() {
        let files = [
            ("src/lib.rs", "mod a;"),
            ("src/a/mod.rs", "mod b; fn f() { b::c::g() }"),
            ("src/a/b.rs", "pub mod c;"),
            ("src/a/b/c.rs", "pub fn g() {}"),
        ];
        assert!(circles(&files).is_empty());
        let error = Crate::parse("src/lib.rs", &|path| (path == "src/lib.rs").then(|| "mod gone;".into())).err().unwrap();
        assert!(error.contains("src/gone.rs"), "{error}");
    }
}
