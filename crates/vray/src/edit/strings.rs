//! The strings reachable from a node (names, paths of textures, notes), by which people recognise what it is.

use enfilade_vrscene::{Document, Parameter, Plugin, Value};
use std::collections::{BTreeMap, HashMap, HashSet};

/// A string reachable from a node: a name of a plugin or material, a file of a texture, a note of an exporter. People recognise from them
/// what the node is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeString {
    /// From the node to the string: `<root>.parameter.parameter[i]…`.
    pub path: String,
    /// The string.
    pub string: String,
}

/// All strings reachable from a node: its own name and, depth first, the strings behind its parameters, in the order of their names.
///
/// The paths and their order are the toolkit's, with two differences: a plugin that is reached on several paths is named on each of them,
/// but the strings behind it are listed only on the first, while the toolkit repeats them; and a reference to a plugin's output counts as
/// one to the plugin, while the toolkit stops there. A path ends before it would become circular. Strings of parameters that the scene does
/// not state are missing: only V-Ray knows them.
pub fn node_strings(scene: &Document, node: &Plugin) -> Vec<NodeString> {
    let plugins: HashMap<&[u8], &Plugin> = scene.plugins().map(|plugin| (plugin.name(), plugin)).collect();
    let mut walk = Walk { plugins: &plugins, way: Vec::new(), visited: HashSet::new(), found: Vec::new() };
    walk.plugin("<root>", node);
    walk.found
}

/// Chains of plugins are no longer than this in any scene; it keeps made-up ones from exhausting the stack.
const MAX_CHAIN: usize = 256;

struct Walk<'a> {
    plugins: &'a HashMap<&'a [u8], &'a Plugin>,
    /// The plugins from the node to this place.
    way: Vec<&'a [u8]>,
    visited: HashSet<&'a [u8]>,
    found: Vec<NodeString>,
}

impl<'a> Walk<'a> {
    fn plugin(&mut self, path: &str, plugin: &'a Plugin) {
        if self.way.len() > MAX_CHAIN || self.way.contains(&plugin.name()) {
            return;
        }
        self.string(path, plugin.name());
        if !self.visited.insert(plugin.name()) {
            return;
        }
        self.way.push(plugin.name());
        let parameters: BTreeMap<&[u8], &Parameter> = plugin.parameters().iter().map(|p| (p.name(), p)).collect();
        for (name, parameter) in parameters {
            // Packed numbers are no references.
            if parameter.raw().windows(4).take(32).any(|bytes| bytes == b"Hex(") {
                continue;
            }
            if let Ok(value) = parameter.value() {
                self.value(&format!("{path}.{}", String::from_utf8_lossy(name)), &value);
            }
        }
        self.way.pop();
    }

    fn value(&mut self, path: &str, value: &Value) {
        match value {
            Value::Text(text) => self.string(path, text),
            Value::Name(_) => {
                if let Some(plugin) = value.plugin().and_then(|name| self.plugins.get(name)).copied() {
                    self.plugin(path, plugin);
                }
            }
            Value::List(_, values) => {
                for (i, value) in values.iter().enumerate() {
                    self.value(&format!("{path}[{i}]"), value);
                }
            }
            Value::Animated(keys) => {
                if let Some((_, first)) = keys.first() {
                    self.value(path, first);
                }
            }
            _ => {}
        }
    }

    fn string(&mut self, path: &str, string: &[u8]) {
        self.found.push(NodeString { path: path.to_string(), string: String::from_utf8_lossy(string).into_owned() });
    }
}
