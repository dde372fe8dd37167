//! Composition: the opinions about each prim, strongest first, from all layers that speak of it.
//!
//! Each prim has a tree of nodes. A node is a path in a stack of layers (a file with its sublayers); its children are what it
//! inherits, its chosen variants, its references, payloads and what it specializes, sorted in this order of strength (LIVRPS) and,
//! among equals, what the prim itself says before what it has from its ancestors. The node of a child prim begins as its parent's
//! with longer paths. What specializes is weakest of all. This is the prim index of OpenUSD's `Pcp` without relocates, and without
//! classes that are overridden from outside of a reference ("implied inherits").

use super::files::{Files, resolve};
use super::layer::{Layer, MAX_PATH, child_path, field, moved, without_variants};
use super::value::{Item, Value};
use crate::ImportError;
use crate::assembly::Assembly;
use std::collections::HashMap;
use std::rc::Rc;

/// References of references of … beyond this are taken for a mistake.
const MAX_ARCS: usize = 64;

/// Nodes of one prim beyond this are taken for a mistake.
const MAX_NODES: usize = 4096;

/// A layer and its sublayers, strongest first.
#[derive(Debug)]
pub(super) struct Stack {
    /// Location of the first layer.
    pub location: String,
    pub layers: Vec<Rc<Layer>>,
}

/// By what a node came in, the strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Arc {
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
    stack: Rc<Stack>,
    path: String,
    arc: Arc,
    /// Number of prims between the layer's root and the prim that brought the node in.
    depth: usize,
    /// Prefixes of paths in the stack, and what they are on the stage.
    map: Rc<Vec<(String, String)>>,
    children: Vec<Node>,
}

/// A path of a layer that speaks of a prim, and how its paths become the stage's.
#[derive(Clone, Debug)]
pub(super) struct Site {
    pub layer: Rc<Layer>,
    pub path: String,
    map: Rc<Vec<(String, String)>>,
}

impl Site {
    /// A path that the site names, as a path on the stage. `None` when it leads out of what was referenced.
    pub(super) fn on_stage(&self, path: &str) -> Option<String> {
        let path = without_variants(path);
        self.map.iter().find_map(|(from, to)| moved(&path, from, to))
    }
}

/// A stack, and a path in it that an arc leads to.
type Target = (Rc<Stack>, String);

/// Opens layers and finds opinions.
pub(super) struct Composer {
    pub files: Files,
    stacks: HashMap<String, Rc<Stack>>,
}

impl Composer {
    /// The composer of a scene file, and the node of its root.
    pub(super) fn open(location: &str, a: &mut Assembly) -> Result<(Self, Node), ImportError> {
        let mut composer = Self { files: Files::default(), stacks: HashMap::new() };
        let stack = composer.stack(location, "the scene file", a)?;
        let map = Rc::new(vec![("/".to_string(), "/".to_string())]);
        Ok((composer, Node { stack, path: "/".into(), arc: Arc::Root, depth: 0, map, children: Vec::new() }))
    }

    fn stack(&mut self, location: &str, user: &str, a: &mut Assembly) -> Result<Rc<Stack>, ImportError> {
        if let Some(known) = self.stacks.get(location) {
            return Ok(known.clone());
        }
        let mut layers = Vec::new();
        self.add_layers(location, user, &mut Vec::new(), &mut layers, a)?;
        let stack = Rc::new(Stack { location: layers[0].location.clone(), layers });
        self.stacks.insert(location.to_string(), stack.clone());
        Ok(stack)
    }

    fn add_layers(
        &mut self,
        at: &str,
        user: &str,
        open: &mut Vec<String>,
        out: &mut Vec<Rc<Layer>>,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let layer = self.files.layer(at, user, a)?;
        if open.contains(&layer.location) || open.len() > MAX_ARCS {
            let way = open.iter().map(|l| &**l).chain([&*layer.location]).collect::<Vec<_>>().join(" → ");
            return Err(a.malformed("subLayers", format!("sublayers stand in a circle or too deep: {way}; take one of them out")));
        }
        // A layer that comes in twice counts where it is strongest.
        if out.iter().any(|l| l.location == layer.location) {
            return Ok(());
        }
        out.push(layer.clone());
        open.push(layer.location.clone());
        for sublayer in layer.get("/", field::SUBLAYERS).map(|v| v.as_texts().to_vec()).unwrap_or_default() {
            let user = format!("subLayers of {}", layer.location);
            self.add_layers(&resolve(&sublayer, &layer.location), &user, open, out, a)?;
        }
        open.pop();
        Ok(())
    }

    /// The node of a child.
    ///
    /// # Errors
    /// When a layer cannot be read, or references stand in a circle.
    pub(super) fn child(&mut self, parent: &Node, name: &str, a: &mut Assembly) -> Result<Node, ImportError> {
        let mut node = parent.below(name);
        let mut count = 0;
        self.add_arcs(&mut node, &mut Vec::new(), &mut Vec::new(), &mut count, a)?;
        Ok(node)
    }

    /// Adds to a node, and to those that it has from its parent, what their own opinions bring in. `chain` holds the nodes above it,
    /// `stronger` the opinions found so far, which may select variants.
    fn add_arcs(
        &mut self,
        node: &mut Node,
        chain: &mut Vec<(Rc<Stack>, String)>,
        stronger: &mut Vec<Site>,
        count: &mut usize,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        *count += 1;
        let place = || format!("<{}> in {}", node.path, node.stack.location);
        if chain.len() > MAX_ARCS || *count > MAX_NODES || node.path.len() > MAX_PATH {
            return Err(a.malformed(
                place(),
                format!("the prim is made of more than {MAX_NODES} others, or of others {MAX_ARCS} deep; simplify it"),
            ));
        }
        stronger.extend(node.own_sites());
        chain.push((node.stack.clone(), node.path.clone()));
        let depth = without_variants(&node.path).matches('/').count();
        let mut added = Vec::new();
        for (arc, name) in [(Arc::Inherit, field::INHERITS), (Arc::Specialize, field::SPECIALIZES)] {
            for (_, item) in node.items(name) {
                added.push(node.arc(arc, depth, (node.stack.clone(), item.path), true));
            }
        }
        for (arc, name) in [(Arc::Reference, field::REFERENCES), (Arc::Payload, field::PAYLOAD)] {
            for (layer, item) in node.items(name) {
                if let Some(target) = self.target(&item, &layer, node, a)? {
                    added.push(node.arc(arc, depth, target, item.asset.is_empty()));
                }
            }
        }
        for new in &added {
            if let Some((stack, path)) = chain.iter().find(|(s, p)| Rc::ptr_eq(s, &new.stack) && overlaps(p, &new.path)) {
                let problem = format!("it is made of itself, by way of <{path}> in {}; take the reference out", stack.location);
                return Err(a.malformed(place(), problem));
            }
        }
        node.children.extend(added);
        node.children.sort_by_key(|n| (n.arc, usize::MAX - n.depth));
        // What is inherited first, for it may select variants; then the variants; then the rest.
        let mut children = std::mem::take(&mut node.children);
        let first_variant = children.partition_point(|n| n.arc < Arc::Variant);
        for child in &mut children[..first_variant] {
            self.add_arcs(child, chain, stronger, count, a)?;
        }
        let mut variants = node.variants(stronger, &children, depth);
        let first_weaker = children.partition_point(|n| n.arc <= Arc::Variant);
        let weaker = children.split_off(first_weaker);
        let mut old = children.split_off(first_variant);
        variants.append(&mut old);
        for child in &mut variants {
            self.add_arcs(child, chain, stronger, count, a)?;
        }
        children.extend(variants);
        node.children = children;
        for mut child in weaker {
            self.add_arcs(&mut child, chain, stronger, count, a)?;
            node.children.push(child);
        }
        chain.pop();
        Ok(())
    }

    /// Where a reference leads. `None`, with a warning, when its layer has no default prim.
    fn target(&mut self, item: &Item, layer: &Rc<Layer>, node: &Node, a: &mut Assembly) -> Result<Option<Target>, ImportError> {
        let stack = if item.asset.is_empty() {
            node.stack.clone()
        } else {
            let user = format!("<{}> in {}", node.path, node.stack.location);
            self.stack(&resolve(&item.asset, &layer.location), &user, a)?
        };
        let default = || {
            stack.layers[0]
                .get("/", "defaultPrim")
                .and_then(Value::as_text)
                .filter(|n| !n.is_empty())
                .map(|n| child_path("/", n.trim_start_matches('/')))
        };
        let path = if item.path.is_empty() { default() } else { Some(item.path.clone()) };
        match path {
            Some(path) if stack.layers.iter().any(|l| l.specs.contains_key(&path)) => Ok(Some((stack, path))),
            path => {
                let what = path.map_or("its default prim, but it names none".to_string(), |p| format!("<{p}>, which is not there"));
                a.warn(format!("<{}>", node.path), format!("a reference to {} asks for {what}; it was left out", stack.location));
                Ok(None)
            }
        }
    }
}

/// True when one of the paths is the other or above it.
fn overlaps(a: &str, b: &str) -> bool {
    let (a, b) = (without_variants(a), without_variants(b));
    moved(&a, &b, "/").is_some() || moved(&b, &a, "/").is_some()
}

impl Node {
    /// The node of a child, before its own opinions are asked.
    fn below(&self, name: &str) -> Self {
        Self {
            stack: self.stack.clone(),
            path: child_path(&self.path, name),
            arc: self.arc,
            depth: self.depth,
            map: self.map.clone(),
            // Where a path is not there, nothing below it is.
            children: self.children.iter().map(|c| c.below(name)).filter(|c| !c.children.is_empty() || !c.own_sites().is_empty()).collect(),
        }
    }

    /// The prim's path on the stage.
    fn stage_path(&self) -> String {
        let path = without_variants(&self.path);
        self.map.iter().find_map(|(from, to)| moved(&path, from, to)).unwrap_or(path)
    }

    fn arc(&self, arc: Arc, depth: usize, (stack, path): Target, same_layers: bool) -> Self {
        let mut map = vec![(path.clone(), self.stage_path())];
        if same_layers {
            map.extend(self.map.iter().cloned());
        }
        Self { stack, path, arc, depth, map: Rc::new(map), children: Vec::new() }
    }

    fn own_sites(&self) -> Vec<Site> {
        let has = |l: &&Rc<Layer>| l.specs.contains_key(&self.path);
        self.stack.layers.iter().filter(has).map(|l| Site { layer: l.clone(), path: self.path.clone(), map: self.map.clone() }).collect()
    }

    /// The items of a list field over the layers of the stack, each with the layer that names it.
    fn items(&self, name: &str) -> Vec<(Rc<Layer>, Item)> {
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
    fn variants(&self, stronger: &[Site], children: &[Node], depth: usize) -> Vec<Node> {
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
                nodes.push(Self { stack: self.stack.clone(), path, arc: Arc::Variant, depth, map: self.map.clone(), children: Vec::new() });
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
            if child.arc == Arc::Specialize {
                let mut weaker = Vec::new();
                child.collect(weakest, &mut weaker);
                weakest.extend(weaker);
            } else {
                child.collect(sites, weakest);
            }
        }
    }
}
