//! All plugins of a scene, of its file and of those that it includes, found by name.

use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_vrscene::{Document, Item, Place, Plugin};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Files that include files beyond this many levels go in a circle.
const MAX_INCLUDES_DEEP: usize = 16;

/// No scene has more files than this.
const MAX_FILES: usize = 4096;

/// The plugins of a scene in the order in which they are read, an included file in the place of its `#include`. Of a scene that is
/// written moment by moment (`#time`), each as it is first written.
pub(super) struct Plugins {
    list: Vec<(Plugin, usize)>,
    files: Vec<PathBuf>,
    by_name: HashMap<Vec<u8>, usize>,
    /// True after a `#time`: a plugin that comes again is the same one at another moment.
    timed: bool,
}

/// A plugin of a scene.
#[derive(Clone, Copy)]
pub(super) struct Handle<'n> {
    pub(super) plugins: &'n Plugins,
    /// Place of the plugin among all, which identifies it.
    pub(super) index: usize,
    pub(super) plugin: &'n Plugin,
    pub(super) file: &'n Path,
}

impl Plugins {
    /// Reads the scene file and what it includes.
    ///
    /// # Errors
    /// When a file cannot be read, is no scene description, or includes itself.
    pub(super) fn read(a: &mut Assembly) -> Result<Self, ImportError> {
        let mut plugins = Self { list: Vec::new(), files: Vec::new(), by_name: HashMap::new(), timed: false };
        let bytes = a.read_scene_file()?;
        let file = a.file().to_path_buf();
        plugins.add(bytes, file, &mut Vec::new(), a)?;
        Ok(plugins)
    }

    /// Adds a file; `open` are those that are being read and include it, outermost first.
    fn add(&mut self, bytes: Vec<u8>, file: PathBuf, open: &mut Vec<PathBuf>, a: &mut Assembly) -> Result<(), ImportError> {
        let document = Document::parse(bytes).map_err(|e| {
            let problem = format!("expected {}, found {}; export the scene again or correct the file", e.expected, e.found);
            ImportError::malformed(&file, e.place.to_string(), problem)
        })?;
        let own = self.files.len();
        self.files.push(file.clone());
        open.push(file.clone());
        for item in document.items {
            match item {
                Item::Plugin(plugin) => self.push(plugin, own, a),
                Item::Time(time) => {
                    if !std::mem::replace(&mut self.timed, true) {
                        a.warn(
                            format!("{}: #time", time.place()),
                            "the scene is animated; each plugin was used as it is at the first moment",
                        );
                    }
                }
                Item::Include(include) => {
                    let path = String::from_utf8_lossy(include.path()).into_owned();
                    self.include(&path, include.place(), &file, open, a)?;
                }
            }
        }
        open.pop();
        Ok(())
    }

    fn include(&mut self, path: &str, place: Place, from: &Path, open: &mut Vec<PathBuf>, a: &mut Assembly) -> Result<(), ImportError> {
        let place = format!("{place}: #include {path:?}");
        if self.files.len() >= MAX_FILES {
            return Err(ImportError::malformed(from, place, format!("the scene includes more than {MAX_FILES} files; include each once")));
        }
        let (file, bytes) = a.read_from(from, path)?;
        if open.len() > MAX_INCLUDES_DEEP || open.contains(&file) {
            return Err(ImportError::malformed(from, place, "files include each other in a circle; remove the include that closes it"));
        }
        if self.files.contains(&file) {
            a.warn(place, "the file was included before, so it was not read again");
            return Ok(());
        }
        self.add(bytes, file, open, a)
    }

    fn push(&mut self, plugin: Plugin, file: usize, a: &mut Assembly) {
        let index = self.list.len();
        let name = plugin.name().to_vec();
        if self.timed && self.by_name.contains_key(&name) {
            return;
        }
        self.list.push((plugin, file));
        if self.by_name.insert(name, index).is_some() {
            let place = self.at(index).place();
            a.warn(place, "there is another plugin of this name; references mean the later one");
        }
    }

    /// The plugin at an index.
    pub(super) fn at(&self, index: usize) -> Handle<'_> {
        let (plugin, file) = &self.list[index];
        Handle { plugins: self, index, plugin, file: &self.files[*file] }
    }

    /// All plugins in order.
    pub(super) fn all(&self) -> impl Iterator<Item = Handle<'_>> {
        (0..self.list.len()).map(|index| self.at(index))
    }

    /// The plugins of a kind, in order.
    pub(super) fn of_kind<'n>(&'n self, kind: &'n str) -> impl Iterator<Item = Handle<'n>> {
        self.all().filter(move |plugin| plugin.kind() == kind)
    }

    /// The last plugin of a kind: settings have one.
    pub(super) fn settings<'n>(&'n self, kind: &'n str) -> Option<Handle<'n>> {
        self.of_kind(kind).last()
    }

    /// The plugin of a name.
    pub(super) fn named(&self, name: &[u8]) -> Option<Handle<'_>> {
        self.by_name.get(name).map(|&index| self.at(index))
    }
}
