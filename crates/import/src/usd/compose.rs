//! Composition: the opinions about each prim, strongest first, from all layers that have any.
//!
//! Each prim has a tree of nodes. A node is a path in a stack of layers (a file with its sublayers); its children are what it
//! inherits, its chosen variants, its references, payloads and what it specializes, sorted in this order of strength (LIVRPS) and,
//! among equals, the prim's own arcs before those that it has from its ancestors. The node of a child prim begins as its parent's
//! with longer paths. Specializes arcs are the weakest of all. This is the prim index of OpenUSD's `Pcp` without relocates, and without
//! classes that are overridden from outside of a reference ("implied inherits").

use super::files::{Files, Unread, is_materialx, resolve};
use super::layer::{Layer, MAX_PATH, child_path, field, moved, without_variants};
use super::node::{Arc, Node, Site, Stack, Target};
use super::time::Retiming;
use super::value::{Item, Value};
use crate::ImportError;
use crate::assembly::Assembly;
use std::collections::HashMap;
use std::rc::Rc;

/// References of references of … beyond this are taken for a mistake.
const MAX_ARCS: usize = 64;

/// Nodes of one prim beyond this are taken for a mistake.
const MAX_NODES: usize = 4096;

/// Nodes of the whole stage beyond this are taken for references that multiply without end.
const MAX_STAGE_NODES: usize = 1 << 18;

/// Opens layers and finds opinions.
pub(super) struct Composer {
    pub files: Files,
    nodes: usize,
    stacks: HashMap<String, Rc<Stack>>,
}

impl Composer {
    /// The composer of a scene file, and the node of its root.
    pub(super) fn open(location: &str, a: &mut Assembly) -> Result<(Self, Node), ImportError> {
        let mut composer = Self { files: Files::default(), nodes: 0, stacks: HashMap::new() };
        match composer.files.layer(location, "the scene file", a) {
            Ok(_) => (),
            Err(Unread::Absent(error) | Unread::Broken(error)) => return Err(error),
        }
        let stack = composer.stack(location, "the scene file", a)?.ok_or_else(|| a.malformed("the scene file", "it is not there"))?;
        let map = Rc::new(vec![("/".to_string(), "/".to_string())]);
        let retiming = Retiming::default();
        Ok((composer, Node { stack, path: "/".into(), kind: Arc::Root, depth: 0, map, retiming, children: Vec::new() }))
    }

    /// The layer at a location with its sublayers; `None`, with a warning, where there is none.
    fn stack(&mut self, location: &str, user: &str, a: &mut Assembly) -> Result<Option<Rc<Stack>>, ImportError> {
        if let Some(known) = self.stacks.get(location) {
            return Ok(Some(known.clone()));
        }
        let mut found = Vec::new();
        self.add_layers(location, (user, None), &mut Vec::new(), &mut found, a)?;
        let (layers, retimings): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        let Some(first) = layers.first() else { return Ok(None) };
        let stack = Rc::new(Stack { location: first.location.clone(), layers, retimings });
        self.stacks.insert(location.to_string(), stack.clone());
        Ok(Some(stack))
    }

    /// Adds a layer with its sublayers. `above` is the layer that it is a sublayer of, and how the sublayer's time becomes that of the stack,
    /// if both have the same time codes a second.
    fn add_layers(
        &mut self,
        at: &str,
        (user, above): (&str, Option<(&Layer, Retiming)>),
        open: &mut Vec<String>,
        out: &mut Vec<(Rc<Layer>, Retiming)>,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let Some(layer) = self.files.find(at, user, a)? else { return Ok(()) };
        if open.contains(&layer.location) || open.len() > MAX_ARCS {
            let way = open.iter().map(|l| &**l).chain([&*layer.location]).collect::<Vec<_>>().join(" → ");
            return Err(a.malformed(
                "subLayers",
                format!("sublayers refer to each other in a circle, or are nested too deep: {way}; take one of them out"),
            ));
        }
        // A layer that comes in twice counts where it is strongest.
        if out.iter().any(|(l, _)| l.location == layer.location) {
            return Ok(());
        }
        let retiming =
            above.map_or(Retiming::default(), |(user, retiming)| retiming.between(user.codes_per_second(), layer.codes_per_second()));
        out.push((layer.clone(), retiming));
        open.push(layer.location.clone());
        let offsets = layer.get("/", field::SUBLAYER_OFFSETS).and_then(|v| v.as_numbers(2)).unwrap_or(&[]).as_chunks::<2>().0;
        for (i, sublayer) in layer.get("/", field::SUBLAYERS).map_or(&[][..], Value::as_texts).iter().enumerate() {
            let user = format!("subLayers of {}", layer.location);
            let stated = offsets.get(i).map_or(Retiming::default(), |[offset, scale]| Retiming::new(*offset, *scale));
            let above = Some((&*layer, retiming.after(stated)));
            self.add_layers(&resolve(sublayer, &layer.location), (&user, above), open, out, a)?;
        }
        open.pop();
        Ok(())
    }

    /// The node of a child.
    ///
    /// # Errors
    /// When a layer cannot be read, or there are too many parts of layers.
    pub(super) fn child(&mut self, parent: &Node, name: &str, a: &mut Assembly) -> Result<Node, ImportError> {
        let mut node = parent.below(name);
        let mut count = 0;
        if self.nodes > MAX_STAGE_NODES {
            let problem = format!("the prims of the scene are made of more than {MAX_STAGE_NODES} parts of layers; make it smaller");
            return Err(a.malformed(format!("<{}> in {}", parent.path, parent.stack.location), problem));
        }
        self.add_arcs(&mut node, &mut Vec::new(), &mut Vec::new(), &mut count, a)?;
        self.nodes += count;
        Ok(node)
    }

    /// Adds to a node, and to those that it has from its parent, the arcs of their own opinions. `chain` contains the nodes above it,
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
                added.push(node.arc(arc, depth, (node.stack.clone(), item.path), Retiming::default(), true));
            }
        }
        for (arc, name) in [(Arc::Reference, field::REFERENCES), (Arc::Payload, field::PAYLOAD)] {
            for (layer, item) in node.items(name) {
                if let Some(target) = self.target(&item, &layer, node, a)? {
                    let introduced = node.stack.retiming(&layer).after(item.retiming);
                    let retiming = introduced.between(node.stack.layers[0].codes_per_second(), target.0.layers[0].codes_per_second());
                    added.push(node.arc(arc, depth, target, retiming, item.asset.is_empty()));
                }
            }
        }
        // OpenUSD, too, opens the stage without arcs that lead back ("Cycle detected").
        added.retain(|new| {
            let back = chain.iter().find(|(s, p)| Rc::ptr_eq(s, &new.stack) && overlaps(p, &new.path));
            if let Some((stack, path)) = back {
                let problem = format!("it refers to itself, by way of <{path}> in {}; that reference was left out", stack.location);
                a.warn(place(), problem);
            }
            back.is_none()
        });
        node.children.extend(added);
        node.children.sort_by_key(|n| (n.kind, usize::MAX - n.depth));
        // What is inherited first, for it may select variants; then the variants; then the rest.
        let mut children = std::mem::take(&mut node.children);
        let first_variant = children.partition_point(|n| n.kind < Arc::Variant);
        for child in &mut children[..first_variant] {
            self.add_arcs(child, chain, stronger, count, a)?;
        }
        let mut variants = node.variants(stronger, &children, depth);
        let first_weaker = children.partition_point(|n| n.kind <= Arc::Variant);
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

    /// The target of a reference. `None`, with a warning, when its layer is missing or has no default prim.
    fn target(&mut self, item: &Item, layer: &Rc<Layer>, node: &Node, a: &mut Assembly) -> Result<Option<Target>, ImportError> {
        let stack = if item.asset.is_empty() {
            node.stack.clone()
        } else {
            let user = format!("<{}> in {}", node.path, node.stack.location);
            let Some(stack) = self.stack(&resolve(&item.asset, &layer.location), &user, a)? else { return Ok(None) };
            stack
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
            // Its layer is empty, which has been reported.
            _ if is_materialx(&stack.location) => Ok(None),
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
