//! The names of a scene's parts, as NYU40 classes.

use crate::config::FileSource;
use enfilade_import::{Imported, scene_name};
use enfilade_scene::{CEILING, FLOOR, Object, WALL, is_stuff};
use enfilade_suggest::lexicon::Lexicon;
use enfilade_suggest::words::words;
use std::path::Path;

/// Classes of parts by their labels and names.
pub(super) struct Named {
    /// The class of every part; `None` if its names give none, or several.
    pub classes: Vec<Option<i16>>,
    /// The class of every object by its own name.
    pub objects: Vec<Option<i16>>,
    /// Whether an object's name is one word.
    pub is_whole_object: Vec<bool>,
    /// Whether a part's name is only this thing, so that it is the whole thing and not a leg of it.
    pub is_whole: Vec<bool>,
    /// The class from the file's own name, if no part has one.
    pub of_file: Option<i16>,
}

impl Named {
    pub fn of(source: &FileSource, imported: &Imported) -> Self {
        let scene = &imported.scene;
        let lexicon = Lexicon::builtin().unwrap_or_default();
        let called = |object: &Object| {
            let own = words(&object.name);
            (only(&lexicon.meanings(&own)), own.len() == 1)
        };
        let (objects, is_whole_object): (Vec<_>, Vec<_>) = scene.objects.iter().map(called).unzip();
        let (mut classes, mut is_whole) = (Vec::new(), Vec::new());
        for part in &scene.parts {
            let own = words(&part.name);
            let of_object = || part.object.and_then(|object| objects[object as usize]);
            let class = only(&lexicon.meanings(&own)).or_else(of_object);
            // Exporters give shells one name and distinguish floor and ceiling by the material.
            let by_material = || only(&lexicon.meanings(&words(&scene.materials[part.material as usize].name)));
            let shell =
                if class.is_none_or(|class| class == WALL) { by_material().filter(|c| matches!(*c, FLOOR | CEILING)) } else { None };
            classes.push(shell.or(class));
            is_whole.push(own.len() == 1 && class.is_some());
        }
        for label in imported.labels.iter().flatten().filter(|label| label.label.semantic > 0) {
            classes[label.part as usize] = Some(label.label.semantic);
        }
        let tells = |path: &str| only(&lexicon.meanings(&words(&scene_name(Path::new(path)))));
        let of_file = if classes.iter().all(Option::is_none) { tells(&source.file) } else { None };
        Self { classes, objects, is_whole_object, is_whole, of_file }
    }

    /// Whether it is the shell of a building.
    pub fn is_building(&self) -> bool {
        self.classes.iter().flatten().any(|class| is_stuff(*class))
    }

    /// Whether all that is known of it is things, as of a single piece of furniture.
    pub fn is_thing(&self) -> bool {
        !self.is_building() && self.classes.iter().chain([&self.of_file]).any(Option::is_some)
    }
}

/// The class that all words mean; `None` where they mean several or none.
fn only(meanings: &[i16]) -> Option<i16> {
    let first = *meanings.first()?;
    meanings.iter().all(|class| *class == first).then_some(first)
}
