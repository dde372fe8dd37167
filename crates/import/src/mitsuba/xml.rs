//! The XML of a Mitsuba scene as a tree in which versions no longer differ: property names are in snake case, `$parameters`
//! are filled in, included files and the samples of spectra are in their place, and folders in which to look for files are known.

use crate::ImportError;
use crate::assembly::Assembly;
use crate::spectrum;
use crate::xml::xml_text;
use std::path::PathBuf;
use std::rc::Rc;

/// Elements within elements, and files within files, deeper than this are taken for a mistake.
const MAX_DEPTH: usize = 64;

/// Included files, counted as often as they are included, beyond this many are taken for a mistake.
const MAX_INCLUDES: usize = 1000;

/// Parameters that make a value longer than this, bytes, are taken for a mistake: each can contain others many times.
const MAX_VALUE: usize = 1 << 20;

/// An element.
#[derive(Debug)]
pub(super) struct Node {
    /// Tag of the element in lower case; `luminaire` and `camera` of old versions are `emitter` and `sensor`.
    pub tag: String,
    /// The `type` attribute: which plugin; empty for properties.
    pub plugin: String,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The `name` attribute in snake case; empty when absent.
    pub name: String,
    /// All attributes, with parameters filled in.
    attributes: Vec<(String, String)>,
    /// Elements within, in order.
    pub children: Vec<Node>,
    file: Rc<PathBuf>,
    line: u32,
    column: u32,
}

impl Node {
    /// An attribute by its name.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(k, _)| k == name).map(|(_, v)| v.as_str())
    }

    /// The place of the element, for messages: file, line, column and kind.
    pub(super) fn place(&self) -> String {
        let file = self.file.file_name().map_or_else(String::new, |f| f.to_string_lossy().into_owned());
        let kind = if self.plugin.is_empty() { String::new() } else { format!(" type=\"{}\"", self.plugin) };
        let which = match (&self.id, self.name.as_str()) {
            (Some(id), _) => format!(" id=\"{id}\""),
            (None, "") => String::new(),
            (None, name) => format!(" name=\"{name}\""),
        };
        format!("{file} line {}:{} <{}{kind}{which}>", self.line, self.column, self.tag)
    }

    /// An error about this element.
    pub(super) fn error(&self, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(&self.file, self.place(), problem)
    }

    /// The property or object of a name.
    pub(super) fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The numbers in the attribute `name`, separated by spaces or commas.
    ///
    /// # Errors
    /// When one of them is not a number, or not finite.
    pub(super) fn numbers(&self, name: &str) -> Result<Vec<f64>, ImportError> {
        let text = self.attribute(name).unwrap_or_default();
        let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
        words
            .map(|w| {
                let number = w.parse::<f64>().ok().filter(|n| n.is_finite());
                number.ok_or_else(|| self.error(format!("{w:?} in the attribute {name} is not a finite number")))
            })
            .collect()
    }

    /// Number of a `float` or `integer` property; `None` when there is no such property.
    pub(super) fn float(&self, name: &str) -> Result<Option<f64>, ImportError> {
        let Some(child) = self.child(name).filter(|c| c.attribute("value").is_some()) else { return Ok(None) };
        child.numbers("value").map(|n| n.first().copied())
    }

    /// A `float` property, or a default.
    pub(super) fn float_or(&self, name: &str, default: f64) -> Result<f64, ImportError> {
        Ok(self.float(name)?.unwrap_or(default))
    }

    /// A `string` property in lower case.
    pub(super) fn text(&self, name: &str) -> Option<String> {
        self.raw_text(name).map(str::to_lowercase)
    }

    /// A `string` property as it is.
    pub(super) fn raw_text(&self, name: &str) -> Option<&str> {
        self.child(name)?.attribute("value")
    }

    /// A `boolean` property.
    pub(super) fn flag(&self, name: &str, default: bool) -> bool {
        self.text(name).map_or(default, |t| t.trim() == "true" || t.trim() == "1")
    }
}

/// Reads the scene file and all that it includes.
///
/// # Errors
/// When a file cannot be read or is not well-formed XML, with line and column, or elements are nested too deeply.
pub(super) fn read(assembly: &mut Assembly) -> Result<Node, ImportError> {
    let bytes = assembly.read_scene_file()?;
    let file = assembly.file().to_path_buf();
    let mut loader = Loader { assembly, parameters: Vec::new(), includes: 0 };
    loader.parse(file, &bytes, 0)
}

/// Lines and columns of a text. The parser finds each by counting from the text's beginning; here each byte is passed once.
struct Places<'t> {
    text: &'t str,
    at: usize,
    line: u32,
    column: u32,
}

impl Places<'_> {
    /// Line and column, both from 1, of the byte `at`, which comes no earlier than the one asked for last.
    fn of(&mut self, at: usize) -> (u32, u32) {
        for c in self.text.get(self.at..at).unwrap_or_default().chars() {
            (self.line, self.column) = if c == '\n' { (self.line + 1, 1) } else { (self.line, self.column + 1) };
        }
        self.at = self.at.max(at);
        (self.line, self.column)
    }
}

struct Loader<'l, 'a> {
    assembly: &'l mut Assembly<'a>,
    /// `$name` and its value; the first definition counts, as on Mitsuba's command line.
    parameters: Vec<(String, String)>,
    /// Files that were included so far.
    includes: usize,
}

impl Loader<'_, '_> {
    fn parse(&mut self, file: PathBuf, bytes: &[u8], depth: usize) -> Result<Node, ImportError> {
        let text = xml_text(bytes);
        let document = roxmltree::Document::parse(&text).map_err(|e| {
            let place = format!("line {}:{}", e.pos().row, e.pos().col);
            ImportError::malformed(&file, place, format!("not well-formed XML: {e}"))
        })?;
        let (file, mut places) = (Rc::new(file), Places { text: &text, at: 0, line: 1, column: 1 });
        let mut root = Node {
            tag: document.root_element().tag_name().name().to_lowercase(),
            plugin: String::new(),
            id: None,
            name: String::new(),
            attributes: document.root_element().attributes().map(|a| (a.name().to_string(), a.value().to_string())).collect(),
            children: Vec::new(),
            file: file.clone(),
            line: 1,
            column: 1,
        };
        if root.tag != "scene" {
            return Err(root.error(format!("the outermost element is <{}>, expected <scene>", root.tag)));
        }
        self.children(document.root_element(), &mut places, &file, &mut root, depth)?;
        Ok(root)
    }

    fn children(
        &mut self,
        xml: roxmltree::Node,
        places: &mut Places,
        file: &Rc<PathBuf>,
        into: &mut Node,
        depth: usize,
    ) -> Result<(), ImportError> {
        for element in xml.children().filter(roxmltree::Node::is_element) {
            let (line, column) = places.of(element.range().start);
            let filled_in = |a: roxmltree::Attribute| {
                let value = self.filled_in(a.value()).ok_or_else(|| {
                    let place = format!("line {line}:{column}");
                    let problem = format!("the parameters in the attribute {} make it longer than {MAX_VALUE} bytes", a.name());
                    ImportError::malformed(file, place, problem)
                })?;
                match undefined(&value) {
                    // A definition may refer to what an outer file or a command line would define.
                    Some(name) if element.tag_name().name() != "default" => {
                        let problem = format!(
                            "the attribute {} has the parameter ${name}, which nothing before it defines; add <default name=\"{name}\" value=\"…\"/> \
                             at the beginning of the scene, with the value that is given to Mitsuba by -D {name}=…",
                            a.name()
                        );
                        Err(ImportError::malformed(file, format!("line {line}:{column}"), problem))
                    }
                    _ => Ok((a.name().to_string(), value)),
                }
            };
            let attributes: Vec<(String, String)> = element.attributes().map(filled_in).collect::<Result<_, ImportError>>()?;
            let get = |name: &str| attributes.iter().find(|(found, _)| found == name).map(|(_, value)| value.clone());
            let (plugin, id, name) = (get("type").unwrap_or_default(), get("id"), get("name").map_or_else(String::new, |n| snake_case(&n)));
            let tag = element.tag_name().name().to_lowercase();
            let tag = match tag.as_str() {
                "luminaire" => "emitter".to_string(),
                "camera" => "sensor".to_string(),
                _ => tag,
            };
            let mut node = Node { tag, plugin, id, name, attributes, children: Vec::new(), file: file.clone(), line, column };
            if depth >= MAX_DEPTH {
                return Err(node.error(format!("elements (or included files) are nested more than {MAX_DEPTH} deep")));
            }
            if node.tag == "spectrum" && node.attribute("value").is_none() {
                self.fill_in_samples(&mut node)?;
            }
            match node.tag.as_str() {
                "path" => self.look_in(&node),
                "default" => {
                    let (name, value) = (node.attribute("name"), node.attribute("value"));
                    if let (Some(name), Some(value)) = (name, value)
                        && !self.parameters.iter().any(|(n, _)| n == name)
                    {
                        self.parameters.push((name.to_string(), value.to_string()));
                    }
                }
                "include" => {
                    let name = node.attribute("filename").ok_or_else(|| node.error("there is no filename"))?.to_string();
                    self.includes += 1;
                    if self.includes > MAX_INCLUDES {
                        return Err(
                            node.error(format!("more than {MAX_INCLUDES} files are included; files include each other over and over"))
                        );
                    }
                    let (path, bytes) = self.assembly.read_from(file, &name)?;
                    let mut included = self.parse(path, &bytes, depth + 8)?;
                    into.children.append(&mut included.children);
                }
                _ => {
                    self.children(element, places, file, &mut node, depth + 1)?;
                    into.children.push(node);
                }
            }
        }
        Ok(())
    }

    /// Gives a spectrum that is in a file its samples as value.
    fn fill_in_samples(&mut self, node: &mut Node) -> Result<(), ImportError> {
        let Some(name) = node.attribute("filename") else { return Ok(()) };
        let (file, bytes) = self.assembly.read_from(&node.file, name)?;
        let samples: Vec<String> = spectrum::pairs(&bytes, &file)?.iter().map(|(nm, value)| format!("{nm:e}:{value:e}")).collect();
        node.attributes.push(("value".to_string(), samples.join(" ")));
        Ok(())
    }

    /// Has files looked for in the folder of a `path`.
    fn look_in(&mut self, node: &Node) {
        let folder = node.attribute("value").unwrap_or_default();
        if !self.assembly.look_in(&node.file, folder) {
            self.assembly.warn(node.place(), format!("there is no folder {folder:?}; files are not looked for in it"));
        }
    }

    /// The value with every `$parameter` replaced; the longest names first, so that `$res` does not spoil `$resx`. `None` when it
    /// would be longer than [`MAX_VALUE`].
    fn filled_in(&self, value: &str) -> Option<String> {
        if !value.contains('$') {
            return Some(value.to_string());
        }
        let mut parameters: Vec<_> = self.parameters.iter().collect();
        parameters.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
        parameters.into_iter().try_fold(value.to_string(), |text, (name, with)| {
            let place = format!("${name}");
            let length = text.matches(&place).count().checked_mul(with.len())?.checked_add(text.len())?;
            (length <= MAX_VALUE).then(|| text.replace(&place, with))
        })
    }
}

/// The name of a parameter that is left in a value; a dollar sign alone is text.
fn undefined(value: &str) -> Option<&str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let behind = value.split('$').skip(1).find(|rest| rest.starts_with(|c: char| c.is_alphabetic() || c == '_'))?;
    Some(behind.split(|c| !is_name(c)).next().unwrap_or(behind))
}

/// `toWorld` → `to_world`, `intIOR` → `int_ior`: the names of Mitsuba 2 and 3 for those of version 0.x.
fn snake_case(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    let mut before = '_';
    for c in name.chars() {
        if c.is_uppercase() && (before.is_lowercase() || before.is_ascii_digit()) {
            out.push('_');
        }
        out.extend(c.to_lowercase());
        before = c;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_parser() {
        let text = "<a>\n <b é='ü'/><c/>\r\n<d><e/>é</d>\n\n</a>";
        let document = roxmltree::Document::parse(text).unwrap();
        let mut places = Places { text, at: 0, line: 1, column: 1 };
        for element in document.descendants().filter(roxmltree::Node::is_element) {
            let expected = document.text_pos_at(element.range().start);
            assert_eq!(places.of(element.range().start), (expected.row, expected.col));
        }
        assert_eq!((places.line, places.column), (3, 4));
    }

    #[test]
    fn names_of_old_versions_become_those_of_the_new() {
        let pairs = [("toWorld", "to_world"), ("intIOR", "int_ior"), ("alphaU", "alpha_u"), ("diffuse_reflectance", "diffuse_reflectance")];
        for (old, new) in pairs {
            assert_eq!(snake_case(old), new);
        }
    }
}
