//! Names that are free.

use crate::Scene;
use std::collections::HashSet;

/// A name without spaces around it, and with underscores for control characters, which would break tables; `otherwise` if nothing is left.
pub fn printable(name: &str, otherwise: &str) -> String {
    let name: String = name.trim().chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    if name.is_empty() { otherwise.into() } else { name }
}

/// `name`, or `name_2`, `name_3` … if it is taken.
pub fn unique(name: String, is_taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2..).map(|number| format!("{name}_{number}"));
    std::iter::once(name.clone()).chain(numbered).find(|name| !is_taken(name)).unwrap_or(name)
}

/// A name for something new that no part or object has, and beneath which (before a slash) there is no part and no light.
pub fn unique_thing(scene: &Scene, name: &str) -> String {
    let lights = scene.lights.iter().map(|light| light.name());
    let names = scene.parts.iter().map(|part| part.name.as_str()).chain(lights);
    let mut taken: HashSet<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    for name in names {
        taken.extend(name.match_indices('/').map(|(at, _)| &name[..at]));
        taken.insert(name);
    }
    unique(printable(name, "part"), |name| taken.contains(name))
}
