//! A scene description as a run of items (includes, times, plugins), each of which keeps the bytes that it was read from.

use crate::error::{Place, SceneTextError};
use crate::plugin::{Parameter, Plugin, Text};
use crate::scan::Scanner;
use std::ops::Range;
use std::sync::Arc;

/// An item of a file.
#[derive(Clone, Debug)]
pub enum Item {
    /// `#include "path"`.
    Include(Include),
    /// `#time frame`.
    Time(Time),
    /// A plugin.
    Plugin(Plugin),
}

/// An included file.
#[derive(Clone, Debug)]
pub struct Include {
    pub(crate) before: Text,
    /// `#include` and the quote.
    pub(crate) opening: Text,
    pub(crate) path: Text,
    /// The quote.
    pub(crate) closing: Text,
}

impl Include {
    /// An include on a line of its own.
    pub fn new(path: &str) -> Self {
        let made = |text: &str| Text::Made(text.as_bytes().to_vec());
        Self { before: made("\n"), opening: made("#include \""), path: made(path), closing: made("\"") }
    }

    /// The path as written: valid on the machine that wrote the file.
    pub fn path(&self) -> &[u8] {
        self.path.bytes()
    }

    /// Points elsewhere.
    pub fn set_path(&mut self, path: &str) {
        self.path = Text::Made(path.as_bytes().to_vec());
    }

    /// Position in the file that was read: line and column.
    pub fn place(&self) -> Place {
        self.opening.place()
    }
}

/// The frame for which the plugins after it are stated; plugins that change are stated again after each such line.
#[derive(Clone, Debug)]
pub struct Time {
    pub(crate) before: Text,
    /// `#time`, the number, and the blank that ends it.
    pub(crate) text: Text,
}

impl Time {
    /// Position in the file that was read: line and column.
    pub fn place(&self) -> Place {
        self.text.place()
    }
}

/// A scene description.
///
/// ```
/// use enfilade_vrscene::{Document, Plugin, Value};
///
/// let text = "Node chair { geometry=mesh_1; /* the seat */  visible=1; }\n";
/// let mut scene = Document::parse(text.as_bytes()).unwrap();
/// assert_eq!(scene.to_bytes(), text.as_bytes());
///
/// // An edit changes what it names and leaves everything around it.
/// let chair = scene.of_kind_mut("Node").next().unwrap();
/// assert_eq!(chair.get("geometry").unwrap(), Some(Value::Name(b"mesh_1".to_vec())));
/// chair.set("visible", &Value::Int(0));
/// assert_eq!(scene.to_bytes(), text.replace("visible=1", "visible=0").as_bytes());
///
/// // New plugins are written as exporters write them.
/// scene.push(Plugin::new("SettingsGI", "gi"));
/// assert!(scene.to_bytes().ends_with(b"SettingsGI gi {\n}\n"));
/// ```
///
/// Unreadable text is an error with line and column:
///
/// ```
/// # use enfilade_vrscene::Document;
/// let error = Document::parse("Node chair {\n  geometry mesh_1;\n}".as_bytes()).unwrap_err();
/// assert_eq!(error.to_string(), "2:12: expected `=` after the name of the parameter, found `mesh_1;`");
/// ```
#[derive(Clone, Debug)]
pub struct Document {
    /// The items of the file, in order. Plugins may refer to later ones.
    pub items: Vec<Item>,
    /// The text after the last item.
    pub(crate) end: Text,
}

impl Default for Document {
    fn default() -> Self {
        Self { items: Vec::new(), end: Text::Made(b"\n".to_vec()) }
    }
}

impl Document {
    /// Reads a description. The bytes are kept, and shared by everything that is not edited.
    ///
    /// # Errors
    /// The first place that is not one, with line and column.
    pub fn parse(bytes: impl Into<Arc<[u8]>>) -> Result<Self, SceneTextError> {
        let file: Arc<[u8]> = bytes.into();
        let mut reader = Reader { scanner: Scanner::new(&file), file: &file };
        let mut items = Vec::new();
        loop {
            let start = reader.scanner.at;
            reader.scanner.skip_blank()?;
            match reader.scanner.peek() {
                None => return Ok(Self { items, end: reader.text(start..file.len()) }),
                Some(b'#') => items.push(reader.directive(start)?),
                Some(_) => items.push(Item::Plugin(reader.plugin(start)?)),
            }
        }
    }

    /// The plugins in order.
    pub fn plugins(&self) -> impl Iterator<Item = &Plugin> {
        self.items.iter().filter_map(|item| match item {
            Item::Plugin(plugin) => Some(plugin),
            Item::Include(_) | Item::Time(_) => None,
        })
    }

    /// The plugins in order, to be edited.
    pub fn plugins_mut(&mut self) -> impl Iterator<Item = &mut Plugin> {
        self.items.iter_mut().filter_map(|item| match item {
            Item::Plugin(plugin) => Some(plugin),
            Item::Include(_) | Item::Time(_) => None,
        })
    }

    /// The plugins of a kind.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a Plugin> {
        self.plugins().filter(move |plugin| plugin.kind() == kind.as_bytes())
    }

    /// The plugins of a kind, to be edited.
    pub fn of_kind_mut<'a>(&'a mut self, kind: &'a str) -> impl Iterator<Item = &'a mut Plugin> {
        self.plugins_mut().filter(move |plugin| plugin.kind() == kind.as_bytes())
    }

    /// The files that belong to it.
    pub fn includes(&self) -> impl Iterator<Item = &Include> {
        self.items.iter().filter_map(|item| match item {
            Item::Include(include) => Some(include),
            Item::Plugin(_) | Item::Time(_) => None,
        })
    }

    /// Appends a plugin.
    pub fn push(&mut self, plugin: Plugin) {
        self.items.push(Item::Plugin(plugin));
    }
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    file: &'a Arc<[u8]>,
}

impl Reader<'_> {
    fn text(&self, range: Range<usize>) -> Text {
        Text::Read { file: self.file.clone(), range }
    }

    fn directive(&mut self, start: usize) -> Result<Item, SceneTextError> {
        let hash = self.scanner.at;
        match self.scanner.word("`#include`")? {
            b"#include" => self.include(start, hash).map(Item::Include),
            b"#time" => self.time(start, hash).map(Item::Time),
            _ => Err(self.scanner.error_at(hash, "`#include`, `#time`, or a plugin")),
        }
    }

    fn include(&mut self, start: usize, hash: usize) -> Result<Include, SceneTextError> {
        let length = self.scanner.string()?.len();
        let quote = self.scanner.at - 1;
        Ok(Include {
            before: self.text(start..hash),
            opening: self.text(hash..quote - length),
            path: self.text(quote - length..quote),
            closing: self.text(quote..quote + 1),
        })
    }

    fn time(&mut self, start: usize, hash: usize) -> Result<Time, SceneTextError> {
        const EXPECTED: &str = "a number after `#time`";
        self.scanner.skip_blank()?;
        let number = self.scanner.at;
        let word = self.scanner.word(EXPECTED)?;
        if std::str::from_utf8(word).ok().and_then(|text| text.parse::<f64>().ok()).is_none() {
            return Err(self.scanner.error_at(number, EXPECTED));
        }
        // The blank belongs to it, so that the number still ends here when the next item is removed.
        self.scanner.at += usize::from(self.scanner.peek().is_some_and(|byte| byte.is_ascii_whitespace()));
        Ok(Time { before: self.text(start..hash), text: self.text(hash..self.scanner.at) })
    }

    fn plugin(&mut self, before: usize) -> Result<Plugin, SceneTextError> {
        let kind = self.word("the kind of a plugin")?;
        let name = self.word("the name of the plugin")?;
        self.scanner.expect(b'{', "`{` after the name of the plugin")?;
        let opening = name.end..self.scanner.at;
        let mut parameters = Vec::new();
        loop {
            let start = self.scanner.at;
            if self.scanner.take(b'}')? {
                return Ok(Plugin {
                    before: self.text(before..kind.start),
                    gap: self.text(kind.end..name.start),
                    kind: self.text(kind),
                    name: self.text(name),
                    opening: self.text(opening),
                    parameters,
                    closing: self.text(start..self.scanner.at),
                });
            }
            parameters.push(self.parameter(start)?);
        }
    }

    fn parameter(&mut self, start: usize) -> Result<Parameter, SceneTextError> {
        let name = self.word("the name of a parameter, or `}`")?;
        self.scanner.expect(b'=', "`=` after the name of the parameter")?;
        self.scanner.skip_blank()?;
        let from = self.scanner.at;
        let value = from..from + self.scanner.raw_value()?.len();
        self.scanner.expect(b';', "`;` at the end of the value")?;
        Ok(Parameter {
            before: self.text(start..value.start),
            after: self.text(value.end..self.scanner.at),
            name: self.text(name),
            value: self.text(value),
        })
    }

    /// A word, as its range of bytes.
    fn word(&mut self, expected: &str) -> Result<Range<usize>, SceneTextError> {
        let length = self.scanner.word(expected)?.len();
        Ok(self.scanner.at - length..self.scanner.at)
    }
}
