//! `#include` lines: other files that belong to a scene.

use crate::plugin::Text;
use crate::{Document, Include, Item, Place};

/// No scene nests includes deeper than this.
const MAX_DEPTH: usize = 32;
/// No scene includes more files than this. The limit is needed because files that each include the next one twice double at every level.
const MAX_FILES: usize = 4096;

/// Why included files cannot be taken in.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IncludeError<E> {
    /// The file could not be loaded.
    #[error("{0}")]
    Load(E),
    /// A file includes itself, directly or by way of others.
    #[error("{place}: \"{path}\" includes itself")]
    Circle {
        /// The path as it is written.
        path: String,
        /// Place of the line, in the file that has it.
        place: Place,
    },
    /// Too many files, or includes within includes.
    #[error("{place}: \"{path}\" is one included file too many (more than {MAX_FILES} files, or {MAX_DEPTH} within each other)")]
    TooMany {
        /// The path as it is written.
        path: String,
        /// Place of the line, in the file that has it.
        place: Place,
    },
}

/// Adds an `#include` line at the end of the scene.
pub fn add_include(scene: &mut Document, path: &str) {
    scene.items.push(Item::Include(Include::new(path)));
}

/// The scene with the contents of its included files in place of the `#include` lines, so that edits reach all of it.
///
/// `at` is the scene's location. `load` is called with the including file's location and the path as written there, and returns the
/// document and its location. Comments and blanks of the files are kept.
///
/// # Errors
/// The errors of `load`, and circular includes.
pub fn inline_includes<P: PartialEq + Clone, E>(
    scene: Document,
    at: P,
    load: &mut impl FnMut(&P, &Include) -> Result<(Document, P), E>,
) -> Result<Document, IncludeError<E>> {
    Splice { open: vec![at], files: 0, load }.whole(scene)
}

struct Splice<'l, P, L> {
    /// The files that are being read, the outermost first.
    open: Vec<P>,
    files: usize,
    load: &'l mut L,
}

impl<P: PartialEq + Clone, E, L: FnMut(&P, &Include) -> Result<(Document, P), E>> Splice<'_, P, L> {
    fn whole(&mut self, scene: Document) -> Result<Document, IncludeError<E>> {
        let mut items = Vec::new();
        // Blanks and comments that belonged to an include, for the next item.
        let mut between: Vec<u8> = Vec::new();
        for item in scene.items {
            let Item::Include(include) = item else {
                items.push(after(&mut between, item));
                continue;
            };
            let inner = self.included(&include)?;
            between.extend(include.before.bytes());
            items.extend(inner.items.into_iter().map(|item| after(&mut between, item)));
            between.extend(inner.end.bytes());
        }
        let end = if between.is_empty() { scene.end } else { Text::Made(joined(&between, scene.end.bytes())) };
        Ok(Document { items, end })
    }

    fn included(&mut self, include: &Include) -> Result<Document, IncludeError<E>> {
        let wrong = || (String::from_utf8_lossy(include.path()).into_owned(), include.place());
        self.files += 1;
        if self.files > MAX_FILES || self.open.len() > MAX_DEPTH {
            let (path, place) = wrong();
            return Err(IncludeError::TooMany { path, place });
        }
        let from = self.open[self.open.len() - 1].clone();
        let (inner, at) = (self.load)(&from, include).map_err(IncludeError::Load)?;
        if self.open.contains(&at) {
            let (path, place) = wrong();
            return Err(IncludeError::Circle { path, place });
        }
        self.open.push(at);
        let whole = self.whole(inner)?;
        self.open.pop();
        Ok(whole)
    }
}

/// The item with the text of `between` put before it; `between` is then empty.
fn after(between: &mut Vec<u8>, mut item: Item) -> Item {
    if !between.is_empty() {
        let before = match &mut item {
            Item::Plugin(plugin) => &mut plugin.before,
            Item::Include(include) => &mut include.before,
            Item::Time(time) => &mut time.before,
        };
        *before = Text::Made(joined(&std::mem::take(between), before.bytes()));
    }
    item
}

/// Two runs of blanks and comments; the first may end in a comment without a line's end.
fn joined(a: &[u8], b: &[u8]) -> Vec<u8> {
    let newline: &[u8] = if a.ends_with(b"\n") || b.starts_with(b"\n") { b"" } else { b"\n" };
    [a, newline, b].concat()
}
