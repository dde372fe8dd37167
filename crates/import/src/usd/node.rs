//! Nodes of composition: paths in stacks of layers that speak of one prim.

use super::layer::{Layer, child_path, field, moved, without_variants};
use super::time::Retiming;
use super::value::{Item, Value};
use std::rc::Rc;

/// A layer and its sublayers, strongest first.
#[derive(Debug)]
pub(super) struct Stack {
    /// Location of the first layer.
    pub location: String,
    pub layers: Vec<Rc<Layer>>,
    /// How the time of each layer becomes that of the first.
    pub retimings: Vec<Retiming>,
}

impl Stack {
    /// How the time of one of its layers becomes that of the first.
    pub(super) fn retiming(&self, layer: &Rc<Layer>) -> Retiming {
        let at = self.layers.iter().position(|known| Rc::ptr_eq(known, layer));
        at.map_or(Retiming::default(), |at| self.retimings[at])
    }
}

/// The arc by which a node was added, the strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Arc {
    Root,
    Inherit,
    Variant,
    Reference,
    Payload,
    Specialize,
}

/// A path in a stack that speaks of a prim.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub stack: Rc<Stack>,
    pub path: String,
    pub kind: Arc,
    /// Number of prims between the layer's root and the prim that brought the node in.
    pub depth: usize,
    /// Prefixes of paths in the stack, and what they are on the stage.
    pub map: Rc<Vec<(String, String)>>,
    /// How the time of the stack's first layer becomes the stage's.
    pub retiming: Retiming,
    pub children: Vec<Node>,
}

/// A path of a layer that speaks of a prim, and how its paths become the stage's.
#[derive(Clone, Debug)]
pub(super) struct Site {
    pub layer: Rc<Layer>,
    pub path: String,
    map: Rc<Vec<(String, String)>>,
    /// How the layer's time becomes the stage's.
    pub retiming: Retiming,
}

impl Site {
    /// A path that the site names, as a path on the stage. `None` when it leads out of what was referenced.
    pub(super) fn on_stage(&self, path: &str) -> Option<String> {
        let path = without_variants(path);
        self.map.iter().find_map(|(from, to)| moved(&path, from, to))
    }
}

/// A stack, and a path in it that an arc leads to.
pub(super) type Target = (Rc<Stack>, String);

impl Node {
    /// The node of a child, before its own opinions are asked.
    pub(super) fn below(&self, name: &str) -> Self {
        Self {
            stack: self.stack.clone(),
            path: child_path(&self.path, name),
            kind: self.kind,
            depth: self.depth,
            map: self.map.clone(),
            retiming: self.retiming,
            // Where a path is not there, nothing below it is.
            children: self.children.iter().map(|c| c.below(name)).filter(|c| !c.children.is_empty() || !c.own_sites().is_empty()).collect(),
        }
    }

    /// The prim's path on the stage.
    fn stage_path(&self) -> String {
        let path = without_variants(&self.path);
        self.map.iter().find_map(|(from, to)| moved(&path, from, to)).unwrap_or(path)
    }

    /// The node that an arc of this node leads to, which shifts time. Within the same layers, paths outside of the target keep their meaning.
    pub(super) fn arc(&self, kind: Arc, depth: usize, (stack, path): Target, retiming: Retiming, same_layers: bool) -> Self {
        let mut map = vec![(path.clone(), self.stage_path())];
        if same_layers {
            map.extend(self.map.iter().cloned());
        }
        Self { stack, path, kind, depth, map: Rc::new(map), retiming: self.retiming.after(retiming), children: Vec::new() }
    }

    /// The layers of the stack that speak of the path.
    pub(super) fn own_sites(&self) -> Vec<Site> {
        let layers = self.stack.layers.iter().zip(&self.stack.retimings).filter(|(layer, _)| layer.specs.contains_key(&self.path));
        let site = |(layer, retiming): (&Rc<Layer>, &Retiming)| Site {
            layer: layer.clone(),
            path: self.path.clone(),
            map: self.map.clone(),
            retiming: self.retiming.after(*retiming),
        };
        layers.map(site).collect()
    }

    /// The items of a list field over the layers of the stack, each with the layer that names it.
    pub(super) fn items(&self, name: &str) -> Vec<(Rc<Layer>, Item)> {
        let mut list: Vec<Item> = Vec::new();
        let mut from: Vec<(Item, Rc<Layer>)> = Vec::new();
        for layer in self.stack.layers.iter().rev() {
            let Some(value) = layer.get(&self.path, name) else { continue };
            let edit = value.as_list();
            edit.apply(&mut list);
            let named = edit.explicit.into_iter().flatten().chain(edit.prepended).chain(edit.appended);
            from.extend(named.map(|i| (i, layer.clone())));
        }
        let layer_of = |item: &Item| from.iter().rev().find(|(i, _)| i == item).map(|(_, l)| l.clone());
        list.into_iter().filter_map(|item| Some((layer_of(&item)?, item))).collect()
    }

    /// Nodes of the chosen variants of this node's variant sets that it does not have from its parent.
    pub(super) fn variants(&self, stronger: &[Site], children: &[Node], depth: usize) -> Vec<Node> {
        let selection = |set: &str| {
            stronger.iter().find_map(|site| match site.layer.get(&site.path, field::VARIANTS) {
                Some(Value::Dictionary(d)) => d.get(set).and_then(Value::as_text).map(str::to_string),
                _ => None,
            })
        };
        let mut nodes = Vec::new();
        for (_, set) in self.items(field::VARIANT_SETS) {
            let Some(name) = selection(&set.path).filter(|n| !n.is_empty()) else { continue };
            let path = format!("{}{{{}={name}}}", self.path, set.path);
            let known = children.iter().any(|c| c.path == path);
            if !known && self.stack.layers.iter().any(|l| l.specs.contains_key(&path)) {
                nodes.push(Self {
                    stack: self.stack.clone(),
                    path,
                    kind: Arc::Variant,
                    depth,
                    map: self.map.clone(),
                    retiming: self.retiming,
                    children: Vec::new(),
                });
            }
        }
        nodes
    }

    /// All opinions, strongest first.
    pub(super) fn sites(&self) -> Vec<Site> {
        let (mut sites, mut weakest) = (Vec::new(), Vec::new());
        self.collect(&mut sites, &mut weakest);
        sites.extend(weakest);
        sites
    }

    fn collect(&self, sites: &mut Vec<Site>, weakest: &mut Vec<Site>) {
        sites.extend(self.own_sites());
        for child in &self.children {
            if child.kind == Arc::Specialize {
                let mut weaker = Vec::new();
                child.collect(weakest, &mut weaker);
                weakest.extend(weaker);
            } else {
                child.collect(sites, weakest);
            }
        }
    }
}
