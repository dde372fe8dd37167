//! Removes plugins by kind, and every reference to them.

use enfilade_vrscene::{Document, Item, Value};
use std::collections::HashSet;

/// Kinds of plugins that blur the image over its pixels; Hypersim renders without any.
pub const IMAGE_FILTERS: [&str; 10] = [
    "FilterPoint",
    "FilterMitNet",
    "FilterCookVariable",
    "FilterGaussian",
    "FilterSinc",
    "FilterCatmullRom",
    "FilterLanczos",
    "FilterTriangle",
    "FilterBox",
    "FilterArea",
];

/// Counts of removed items.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    /// Plugins.
    pub plugins: usize,
    /// References to them: parameters, and entries of lists.
    pub references: usize,
}

/// Removes all plugins of some kinds and every reference to them. A parameter that is such a reference is removed, so that V-Ray takes its
/// default; in a list only the entry is removed.
pub fn remove_kinds(scene: &mut Document, kinds: &[&str]) -> Removed {
    let mut names = HashSet::new();
    let before = scene.items.len();
    scene.items.retain(|item| match item {
        Item::Plugin(plugin) if kinds.iter().any(|kind| plugin.kind() == kind.as_bytes()) => {
            names.insert(plugin.name().to_vec());
            false
        }
        _ => true,
    });
    let mut removed = Removed { plugins: before - scene.items.len(), references: 0 };
    if names.is_empty() {
        return removed;
    }
    for plugin in scene.plugins_mut() {
        plugin.parameters_mut().retain_mut(|parameter| {
            // Most values cannot be references, and packed ones take long to decode: the beginning of the text is enough to decide.
            let Ok(value) = (if may_refer(parameter.raw()) { parameter.value() } else { return true }) else { return true };
            match without(value.clone(), &names, &mut removed.references) {
                Some(rest) if rest == value => true,
                Some(rest) => {
                    parameter.set(&rest);
                    true
                }
                None => false,
            }
        });
    }
    removed
}

fn may_refer(raw: &[u8]) -> bool {
    let packed = raw.windows(5).take(64).any(|bytes| bytes == b"Hex(\"");
    !packed && !raw.first().is_some_and(|&b| b == b'"' || b.is_ascii_digit() || b == b'-')
}

/// The value without references to the plugins of these names; `None` when nothing is left of it.
fn without(value: Value, names: &HashSet<Vec<u8>>, references: &mut usize) -> Option<Value> {
    match value {
        Value::Name(_) if value.plugin().is_some_and(|name| names.contains(name)) => {
            *references += 1;
            None
        }
        Value::List(kind, values) => Some(Value::List(kind, values.into_iter().filter_map(|v| without(v, names, references)).collect())),
        Value::Animated(keys) => {
            let left: Vec<_> = keys.into_iter().filter_map(|(frame, v)| Some((frame, without(v, names, references)?))).collect();
            (!left.is_empty()).then_some(Value::Animated(left))
        }
        other => Some(other),
    }
}
