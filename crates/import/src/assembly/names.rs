//! Names of parts and cameras, each of which occurs once.

use enfilade_scene::printable;
use std::collections::{HashMap, HashSet};

/// Names that are taken.
#[derive(Default)]
pub(super) struct Names {
    taken: HashSet<String>,
    /// The number to try next for a name that occurred before, so that many equal names do not need a long search.
    next: HashMap<String, usize>,
}

impl Names {
    /// `name`, or `name_2`, `name_3` … when it is taken, printable.
    pub(super) fn unique(&mut self, name: &str) -> String {
        let name = printable(name, "part");
        if self.taken.insert(name.clone()) {
            return name;
        }
        let next = self.next.entry(name.clone()).or_insert(2);
        loop {
            let numbered = format!("{name}_{next}");
            *next += 1;
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}
