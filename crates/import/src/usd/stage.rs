//! The composed scene: prims with their resolved values.

use super::compose::Composer;
use super::layer::{Layer, child_path, field, property_path};
use super::node::{Node, Site};
use super::time::Retiming;
use super::value::{Item, Samples, Value};
use crate::ImportError;
use crate::assembly::Assembly;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// More prims than this are taken for references that multiply without end.
const MAX_PRIMS: usize = 1 << 18;

/// The composed scene.
pub(super) struct Stage {
    composer: Composer,
    root: Rc<Prim>,
    known: HashMap<String, Rc<Prim>>,
    /// Attributes of which the first of several time samples was taken.
    pub sampled: Rc<RefCell<BTreeSet<String>>>,
}

/// A prim with all opinions about it.
#[derive(Debug)]
pub(super) struct Prim {
    /// Path on the stage.
    pub path: String,
    node: Node,
    sites: Vec<Site>,
    sampled: Rc<RefCell<BTreeSet<String>>>,
}

/// The strongest opinion about an attribute, over time.
pub(super) enum OverTime<'p> {
    /// One value at all times.
    Constant(&'p Value),
    /// Values at times, and how these become the stage's.
    Sampled(&'p Samples, Retiming),
}

impl Stage {
    /// Opens a scene file.
    pub(super) fn open(location: &str, a: &mut Assembly) -> Result<Self, ImportError> {
        let (composer, node) = Composer::open(location, a)?;
        let sampled = Rc::default();
        let root = Rc::new(Prim { path: "/".into(), sites: node.sites(), node, sampled: Rc::clone(&sampled) });
        Ok(Self { composer, root, known: HashMap::new(), sampled })
    }

    /// The layer of the scene file, which alone says how fast time runs.
    pub(super) fn layer(&self) -> &Layer {
        &self.root.node.stack.layers[0]
    }

    /// The prim above all.
    pub(super) fn root(&self) -> Rc<Prim> {
        self.root.clone()
    }

    /// A child of a prim.
    ///
    /// # Errors
    /// When a layer that it refers to cannot be read, or there are too many prims.
    pub(super) fn child(&mut self, parent: &Prim, name: &str, a: &mut Assembly) -> Result<Rc<Prim>, ImportError> {
        let path = child_path(&parent.path, name);
        if let Some(known) = self.known.get(&path) {
            return Ok(known.clone());
        }
        if self.known.len() >= MAX_PRIMS {
            return Err(a.malformed(
                path,
                format!("the scene has more than {MAX_PRIMS} prims, perhaps by references that multiply; make it smaller"),
            ));
        }
        let node = self.composer.child(&parent.node, name, a)?;
        let prim = Rc::new(Prim { path: path.clone(), sites: node.sites(), node, sampled: self.sampled.clone() });
        self.known.insert(path, prim.clone());
        Ok(prim)
    }

    /// The prim at a path of the stage; `None` when nothing speaks of it.
    pub(super) fn at(&mut self, path: &str, a: &mut Assembly) -> Result<Option<Rc<Prim>>, ImportError> {
        if path == "/" {
            return Ok(Some(self.root()));
        }
        let Some((parent, name)) = path.rsplit_once('/') else { return Ok(None) };
        let Some(parent) = self.at(if parent.is_empty() { "/" } else { parent }, a)? else { return Ok(None) };
        let prim = self.child(&parent, name, a)?;
        Ok((!prim.sites.is_empty()).then_some(prim))
    }

    /// The bytes of a file within an archive that contains a layer.
    pub(super) fn embedded(&self, location: &str) -> Option<Vec<u8>> {
        self.composer.files.embedded(location)
    }
}

impl Prim {
    /// The last name of the path.
    pub(super) fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or("")
    }

    /// The strongest opinion about a field of the prim.
    pub(super) fn field(&self, name: &str) -> Option<&Value> {
        self.sites.iter().find_map(|s| s.layer.get(&s.path, name))
    }

    /// The name of the prim's schema; empty for none.
    pub(super) fn kind(&self) -> &str {
        let kinds = self.sites.iter().filter_map(|s| s.layer.get(&s.path, field::TYPE)?.as_text());
        kinds.into_iter().find(|k| !k.is_empty()).unwrap_or("")
    }

    /// True when something defines the prim (0) and the strongest such opinion does not call it a class (2).
    pub(super) fn is_defined(&self) -> bool {
        let specifiers = self.sites.iter().filter_map(|s| s.layer.get(&s.path, field::SPECIFIER)?.as_number());
        specifiers.into_iter().find(|s| *s != 1.0) == Some(0.0)
    }

    /// False for prims that are switched off.
    pub(super) fn is_active(&self) -> bool {
        self.field("active").and_then(Value::as_bool).unwrap_or(true)
    }

    /// Names of the children, in the order of the weakest opinion that has them.
    pub(super) fn children(&self) -> Vec<Rc<str>> {
        self.names(field::CHILDREN)
    }

    /// Names of the properties.
    pub(super) fn properties(&self) -> Vec<Rc<str>> {
        self.names(field::PROPERTIES)
    }

    fn names(&self, list: &str) -> Vec<Rc<str>> {
        let mut seen = std::collections::HashSet::new();
        let weakest_first = self.sites.iter().rev().filter_map(|s| s.layer.get(&s.path, list));
        weakest_first.flat_map(|v| v.as_texts()).filter(|n| seen.insert(Rc::clone(n))).cloned().collect()
    }

    /// The strongest opinion about a field of a property.
    pub(super) fn property(&self, property: &str, name: &str) -> Option<&Value> {
        self.sites.iter().find_map(|s| s.layer.get(&property_path(&s.path, property), name))
    }

    /// An attribute's value, and the site that states it: of time samples the first.
    pub(super) fn value_at(&self, attribute: &str) -> Option<(&Value, &Site)> {
        let (value, site) = self.opinion(attribute)?;
        let Value::Samples(samples) = value else { return Some((value, site)) };
        if samples.vary() {
            self.sampled.borrow_mut().insert(property_path(&self.path, attribute));
        }
        samples.values.first().filter(|first| !matches!(first, Value::Block)).map(|first| (first, site))
    }

    /// An attribute's values at all times.
    pub(super) fn over_time(&self, attribute: &str) -> Option<OverTime<'_>> {
        Some(match self.opinion(attribute)? {
            (Value::Samples(samples), site) => OverTime::Sampled(samples, site.retiming),
            (value, _) => OverTime::Constant(value),
        })
    }

    /// The strongest opinion about an attribute. In a layer, time samples have precedence over the value without time, as at every time
    /// that programs show.
    fn opinion(&self, attribute: &str) -> Option<(&Value, &Site)> {
        let stated = self.sites.iter().find_map(|site| {
            let path = property_path(&site.path, attribute);
            let samples = site.layer.get(&path, field::SAMPLES).filter(|value| matches!(value, Value::Samples(_)));
            samples.or_else(|| site.layer.get(&path, field::DEFAULT)).map(|value| (value, site))
        });
        stated.filter(|(value, _)| !matches!(value, Value::Block))
    }

    /// Rank in strength of one of the prim's sites; 0 for the strongest.
    pub(super) fn rank(&self, site: &Site) -> usize {
        self.sites.iter().position(|known| std::ptr::eq(known, site)).unwrap_or(self.sites.len())
    }

    /// An attribute's value.
    pub(super) fn value(&self, attribute: &str) -> Option<&Value> {
        self.value_at(attribute).map(|(value, _)| value)
    }

    /// An attribute's number.
    pub(super) fn number(&self, attribute: &str) -> Option<f64> {
        self.value(attribute)?.as_number()
    }

    /// An attribute's token or string.
    pub(super) fn text(&self, attribute: &str) -> Option<&str> {
        self.value(attribute)?.as_text()
    }

    /// Paths on the stage that a relationship (or the connection of an attribute) leads to.
    pub(super) fn targets(&self, property: &str, list: &str) -> Vec<String> {
        let mut items: Vec<Item> = Vec::new();
        for site in self.sites.iter().rev() {
            let Some(value) = site.layer.get(&property_path(&site.path, property), list) else { continue };
            let mut edit = value.as_list();
            let onto_stage = |items: &mut Vec<Item>| {
                *items = items.iter().filter_map(|i| site.on_stage(&i.path)).map(Item::name).collect();
            };
            edit.explicit.iter_mut().for_each(onto_stage);
            [&mut edit.prepended, &mut edit.appended, &mut edit.deleted].into_iter().for_each(onto_stage);
            edit.apply(&mut items);
        }
        items.into_iter().map(|i| i.path).collect()
    }

    /// Names of the schemas that are applied to the prim.
    pub(super) fn schemas(&self) -> Vec<String> {
        let mut items = Vec::new();
        self.sites.iter().rev().filter_map(|s| s.layer.get(&s.path, field::SCHEMAS)).for_each(|v| v.as_list().apply(&mut items));
        items.into_iter().map(|i| i.path).collect()
    }

    /// Identity of the prim's opinions: prims of the same opinions, such as instances, have the same shape.
    pub(super) fn identity(&self) -> String {
        self.sites.iter().map(|s| format!("{}<{}>", s.layer.location, s.path)).collect()
    }
}
