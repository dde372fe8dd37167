//! A scene being read: its objects by id, references followed, and what has been made of them so far.

use super::made::{Attributes, MaterialKey, MeshKey, ObjFiles};
use super::xml::Node;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::ObjectId;
use std::collections::{HashMap, HashSet};

/// References to references deeper than this are taken for a cycle.
pub(super) const MAX_REFERENCES: usize = 32;

/// A scene has at most this many parts, instances counted one by one.
pub(super) const MAX_PARTS: usize = 4_000_000;

/// References within references may lead to this many more shapes and bsdfs than the file has elements. More are taken for a mistake:
/// a group of two instances of a group of two instances … doubles with each level.
const MAX_VISITS: usize = 1 << 16;

/// A scene being read: the tree's objects by id, and what has been made of them.
pub(super) struct Reader<'n, 'a> {
    pub a: Assembly<'a>,
    /// The first number of the version that the scene file is for; 0 where it states none.
    pub version: u32,
    pub ids: HashMap<&'n str, &'n Node>,
    /// The ids in the file's references.
    pub referred_to: HashSet<&'n str>,
    pub aliases: HashMap<&'n str, &'n str>,
    pub materials: HashMap<MaterialKey, u32>,
    /// What media absorb, per metre.
    pub media: HashMap<*const Node, Rgb>,
    pub meshes: HashMap<MeshKey, Option<u32>>,
    /// The grey pictures of coloured ones.
    pub greys: HashMap<u32, u32>,
    pub attributes: Attributes,
    pub obj: ObjFiles,
    /// Elements of the file and of those that it includes.
    pub elements: usize,
    /// Parts so far.
    pub parts: usize,
    /// The instance whose shapes are being placed.
    pub instance: Option<ObjectId>,
    /// Number of shapes and bsdfs reached by nested references so far.
    pub visits: usize,
}

impl<'n, 'a> Reader<'n, 'a> {
    /// Begins a scene of a version, of which nothing has been read.
    pub(super) fn new(assembly: Assembly<'a>, version: u32) -> Self {
        Self {
            a: assembly,
            version,
            ids: HashMap::new(),
            referred_to: HashSet::new(),
            aliases: HashMap::new(),
            materials: HashMap::new(),
            media: HashMap::new(),
            meshes: HashMap::new(),
            greys: HashMap::new(),
            attributes: Attributes::default(),
            obj: ObjFiles::default(),
            elements: 0,
            parts: 0,
            instance: None,
            visits: 0,
        }
    }

    /// Notes the ids of a tree. Depth is bounded by the parser.
    pub(super) fn index(&mut self, node: &'n Node) {
        self.elements += node.children.len();
        for child in &node.children {
            if child.tag == "alias" {
                if let (Some(id), Some(new)) = (child.attribute("id"), child.attribute("as")) {
                    self.aliases.insert(new, id);
                }
            } else if let Some(id) = child.id.as_deref().filter(|_| child.tag != "ref")
                && self.ids.insert(id, child).is_some()
            {
                self.warn(child, "the id is used twice; the later one counts");
            }
            if child.tag == "ref" {
                self.referred_to.extend(child.id.as_deref());
            }
            self.attributes.wanted |= child.plugin == "mesh_attribute";
            self.index(child);
        }
    }

    /// The object that a `ref` refers to; any other element is returned itself.
    pub(super) fn resolve(&self, node: &'n Node) -> Result<&'n Node, ImportError> {
        let mut node = node;
        for _ in 0..MAX_REFERENCES {
            if node.tag != "ref" {
                return Ok(node);
            }
            let id = node.id.as_deref().ok_or_else(|| node.error("the reference has no id"))?;
            let id = self.aliases.get(id).copied().unwrap_or(id);
            node = self.ids.get(id).copied().ok_or_else(|| node.error(format!("nothing in the scene has the id {id:?}")))?;
        }
        Err(node.error("references go in a circle"))
    }

    /// True when any reference leads to `node`.
    pub(super) fn is_referred_to(&self, node: &Node) -> bool {
        let meant = |id: &&str| self.ids.get(self.aliases.get(id).unwrap_or(id)).is_some_and(|found| std::ptr::eq(*found, node));
        self.referred_to.iter().any(meant)
    }

    /// The objects of a tag directly within `node`, references followed.
    pub(super) fn objects(&self, node: &'n Node, tag: &str) -> Result<Vec<&'n Node>, ImportError> {
        let mut found = Vec::new();
        for child in node.children.iter().filter(|c| c.tag == tag || c.tag == "ref") {
            let target = self.resolve(child)?;
            if target.tag == tag {
                found.push(target);
            }
        }
        Ok(found)
    }

    /// The property or object `name` of `node`, references followed.
    pub(super) fn property(&self, node: &'n Node, name: &str) -> Result<Option<&'n Node>, ImportError> {
        let Some(child) = node.child(name) else { return Ok(None) };
        let found = self.resolve(child)?;
        // Daylight times a texture is the texture in RGB.
        let texture = if found.plugin == "d65" { self.objects(found, "texture")?.first().copied() } else { None };
        Ok(Some(texture.unwrap_or(found)))
    }

    /// Counts a visit to one of these `things`, to which `depth` references have led.
    ///
    /// # Errors
    /// When references go in a circle, or lead to more things than a scene has.
    pub(super) fn visit(&mut self, node: &Node, depth: usize, things: &str) -> Result<(), ImportError> {
        self.visits += usize::from(depth > 1);
        if depth > MAX_REFERENCES {
            return Err(node.error(format!("{things} go in a circle")));
        }
        let max = MAX_VISITS + self.elements;
        if self.visits > max {
            return Err(node.error(format!("references lead to more than {max} shapes and bsdfs; refer to each thing once")));
        }
        Ok(())
    }

    pub(super) fn warn(&mut self, node: &Node, message: impl Into<String>) {
        self.a.warn(node.place(), message);
    }

    /// Warns of every property and object of `node` that is neither in `known` nor of an object tag in `tags`.
    pub(super) fn report_unknown(&mut self, node: &'n Node, known: &[&str], tags: &[&str]) {
        for child in &node.children {
            let named = known.contains(&child.name.as_str());
            let object = tags.contains(&child.tag.as_str()) || (child.tag == "ref" && !tags.is_empty());
            if !named && !object && child.tag != "alias" {
                self.warn(child, format!("ignored in {}", node.plugin));
            }
        }
    }
}

/// Addition to the message about an unknown plugin if its name has capitals: Mitsuba's have none.
pub(super) fn spelling(plugin: &str) -> String {
    let small = plugin.to_lowercase();
    if small == plugin { String::new() } else { format!(" (plugins have small letters: {small:?})") }
}
