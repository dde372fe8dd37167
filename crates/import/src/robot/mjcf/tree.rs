//! The elements of a model with those of the files that it includes in place of each `<include>`, and their attributes.

use crate::ImportError;
use crate::assembly::Assembly;
use crate::vectors::numbers;
use roxmltree::{Document, Node};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Files that include each other deeper than this are taken for a circle.
const MAX_DEPTH: usize = 16;
/// More inclusions are taken for a mistake.
const MAX_FILES: usize = 2_000;

/// An element of a model.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub tag: String,
    /// Names and values, in the order of the file.
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Element>,
    file: Rc<PathBuf>,
    line: u32,
}

/// Reads the scene file and all that it includes.
///
/// # Errors
/// When a file is missing or not well-formed.
pub(super) fn read(a: &mut Assembly) -> Result<Element, ImportError> {
    let file = a.file().to_path_buf();
    let bytes = a.read_scene_file()?;
    let root = parsed(&file, &bytes)?;
    if root.tag != "mujoco" {
        return Err(a.malformed("line 1", format!("the outermost element is <{}>, expected <mujoco>", root.tag)));
    }
    with_includes(root, 0, &mut 0, a)
}

fn parsed(file: &Path, bytes: &[u8]) -> Result<Element, ImportError> {
    let text = crate::xml::xml_text(bytes);
    let document = Document::parse(&text)
        .map_err(|e| ImportError::malformed(file, format!("line {}:{}", e.pos().row, e.pos().col), format!("not well-formed XML: {e}")))?;
    Ok(element(document.root_element(), &Rc::new(file.to_path_buf())))
}

fn element(node: Node, file: &Rc<PathBuf>) -> Element {
    Element {
        tag: node.tag_name().name().to_string(),
        attributes: node.attributes().map(|a| (a.name().to_string(), a.value().trim().to_string())).collect(),
        children: node.children().filter(Node::is_element).map(|child| element(child, file)).collect(),
        file: Rc::clone(file),
        line: node.document().text_pos_at(node.range().start).row,
    }
}

fn with_includes(mut within: Element, depth: usize, files: &mut usize, a: &mut Assembly) -> Result<Element, ImportError> {
    let mut children = Vec::with_capacity(within.children.len());
    for child in std::mem::take(&mut within.children) {
        if child.tag == "include" {
            children.extend(included(&child, depth, files, a)?.children);
        } else {
            children.push(with_includes(child, depth, files, a)?);
        }
    }
    within.children = children;
    Ok(within)
}

fn included(include: &Element, depth: usize, files: &mut usize, a: &mut Assembly) -> Result<Element, ImportError> {
    if depth >= MAX_DEPTH {
        return Err(include.wrong(format!("files include each other more than {MAX_DEPTH} deep; break the circle")));
    }
    *files += 1;
    if *files > MAX_FILES {
        return Err(include.wrong(format!("more than {MAX_FILES} files are included")));
    }
    let path = include.text("file").ok_or_else(|| include.wrong("it names no file".into()))?.replace('\\', "/");
    // From the model's own folder, as MuJoCo does; from the including file's, as others expect.
    let found = a.beside(a.file(), &path).or_else(|| a.beside(&include.file, &path));
    let file = found.unwrap_or_else(|| a.path_of(&path));
    let bytes = a.read_input(&file, &format!("{} includes it; put it there or correct the path", include.file.display()))?;
    with_includes(parsed(&file, &bytes)?, depth + 1, files, a)
}

impl Element {
    /// The elements of a tag within it.
    pub(super) fn all<'e, 't>(&'e self, tag: &'t str) -> impl Iterator<Item = &'e Element> + use<'e, 't> {
        self.children.iter().filter(move |child| child.tag == tag)
    }

    /// An attribute, unless it is empty.
    pub(super) fn text(&self, attribute: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, value)| name == attribute && !value.is_empty()).map(|(_, value)| value.as_str())
    }

    /// The name, or an empty one.
    pub(super) fn name(&self) -> &str {
        self.text("name").unwrap_or_default()
    }

    /// Whether a word such as `true` is given; `None` of others.
    pub(super) fn flag(&self, attribute: &str) -> Option<bool> {
        match self.text(attribute)? {
            "true" | "enable" => Some(true),
            "false" | "disable" => Some(false),
            _ => None,
        }
    }

    /// The numbers of an attribute, of which there are as many as `counts` has.
    ///
    /// # Errors
    /// When it has others, or what is no finite number.
    pub(super) fn numbers(&self, attribute: &str, counts: std::ops::RangeInclusive<usize>) -> Result<Option<Vec<f64>>, ImportError> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        let found = numbers(text).filter(|found| counts.contains(&found.len()));
        let expected =
            if counts.start() == counts.end() { counts.start().to_string() } else { format!("{} to {}", counts.start(), counts.end()) };
        found.map(Some).ok_or_else(|| self.wrong(format!("found {text:?} as {attribute}, expected {expected} finite numbers")))
    }

    /// A vector.
    ///
    /// # Errors
    /// When it has another number of numbers.
    pub(super) fn vector<const N: usize>(&self, attribute: &str) -> Result<Option<[f64; N]>, ImportError> {
        Ok(self.numbers(attribute, N..=N)?.and_then(|found| found.try_into().ok()))
    }

    /// A number.
    ///
    /// # Errors
    /// When it is none.
    pub(super) fn number(&self, attribute: &str) -> Result<Option<f64>, ImportError> {
        Ok(self.vector::<1>(attribute)?.map(|[number]| number))
    }

    /// The error of what is wrong with the element.
    pub(super) fn wrong(&self, problem: String) -> ImportError {
        ImportError::malformed(&self.file, self.line_and_tag(), problem)
    }

    /// The element in the scene file, or in the file that it is of, for warnings.
    pub(super) fn place(&self, a: &Assembly) -> String {
        let line = self.line_and_tag();
        if self.file.as_path() == a.file() { line } else { format!("{} {line}", self.file.display()) }
    }

    fn line_and_tag(&self) -> String {
        let name = if self.name().is_empty() { String::new() } else { format!(" {:?}", self.name()) };
        format!("line {} <{}>{name}", self.line, self.tag)
    }
}
