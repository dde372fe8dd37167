use crate::{Document, Plugin, Value};
use std::collections::{HashMap, HashSet};

/// A string that a node leads to: names of materials, files of textures, notes of exporters. They tell people what the node is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeString {
    /// From the node to the string: `node.parameter.parameter[i]…`.
    pub path: String,
    /// The string.
    pub string: String,
}

/// All strings that a node leads to, depth first, parameters in their order. Each plugin is visited once, so circles end.
pub fn node_strings(scene: &Document, node: &Plugin) -> Vec<NodeString> {
    let plugins: HashMap<&[u8], &Plugin> = scene.plugins().map(|plugin| (plugin.name(), plugin)).collect();
    let mut walk = Walk { plugins: &plugins, visited: HashSet::from([node.name()]), found: Vec::new() };
    walk.plugin(&String::from_utf8_lossy(node.name()), node, 0);
    walk.found
}

/// Chains of plugins are no longer than this in any scene; it keeps made-up ones from exhausting the stack.
const MAX_CHAIN: usize = 256;

struct Walk<'a> {
    plugins: &'a HashMap<&'a [u8], &'a Plugin>,
    visited: HashSet<&'a [u8]>,
    found: Vec<NodeString>,
}

impl<'a> Walk<'a> {
    fn plugin(&mut self, path: &str, plugin: &'a Plugin, chain: usize) {
        if chain > MAX_CHAIN {
            return;
        }
        for parameter in plugin.parameters() {
            // Packed numbers lead nowhere.
            if parameter.raw().windows(4).take(32).any(|bytes| bytes == b"Hex(") {
                continue;
            }
            if let Ok(value) = parameter.value() {
                let path = format!("{path}.{}", String::from_utf8_lossy(parameter.name()));
                self.value(&path, &value, chain);
            }
        }
    }

    fn value(&mut self, path: &str, value: &Value, chain: usize) {
        match value {
            Value::Text(text) => {
                self.found.push(NodeString { path: path.to_string(), string: String::from_utf8_lossy(text).into_owned() });
            }
            Value::Name(_) => {
                let plugin = value.plugin().and_then(|name| self.plugins.get(name)).copied();
                if let Some(plugin) = plugin.filter(|plugin| self.visited.insert(plugin.name())) {
                    self.plugin(path, plugin, chain + 1);
                }
            }
            Value::List(_, values) => {
                for (i, value) in values.iter().enumerate() {
                    self.value(&format!("{path}[{i}]"), value, chain);
                }
            }
            Value::Animated(keys) => {
                if let Some((_, first)) = keys.first() {
                    self.value(path, first, chain);
                }
            }
            _ => {}
        }
    }
}
