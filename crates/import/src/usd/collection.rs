//! Collections of prims: what they include and exclude by path.

use super::layer::{field, moved, split_property};
use super::stage::Stage;
use super::value::Value;
use crate::ImportError;
use crate::assembly::Assembly;

/// The members of a collection.
#[derive(Debug, Default)]
pub(super) struct Collection {
    includes: Vec<String>,
    excludes: Vec<String>,
    /// True when the prims below a member are not members themselves.
    is_explicit: bool,
}

impl Collection {
    /// The collection that a path such as `/A.collection:name` means; `None`, with a warning, where it cannot be read.
    pub(super) fn read(path: &str, stage: &mut Stage, a: &mut Assembly) -> Result<Option<Self>, ImportError> {
        let (owner, property) = split_property(path);
        let Some(prim) = stage.at(owner, a)?.filter(|_| property.starts_with("collection:")) else {
            a.warn(path, "a material is bound to this collection, which is not there; that binding was left out");
            return Ok(None);
        };
        let (mut includes, excludes) =
            (prim.targets(&format!("{property}:includes"), field::TARGETS), prim.targets(&format!("{property}:excludes"), field::TARGETS));
        if includes.iter().any(|i| i.contains(".collection:")) || prim.value(&format!("{property}:membershipExpression")).is_some() {
            a.warn(path, "the collection has other collections or an expression, which are left out of what its material is bound to");
        }
        if prim.value(&format!("{property}:includeRoot")).and_then(Value::as_bool) == Some(true) {
            includes.push("/".into());
        }
        let is_explicit = prim.text(&format!("{property}:expansionRule")) == Some("explicitOnly");
        Ok(Some(Self { includes, excludes, is_explicit }))
    }

    /// True for the paths of members: of the listed paths at or above them, the longest decides.
    pub(super) fn contains(&self, path: &str) -> bool {
        let nearest = |list: &[String]| {
            let holds = |listed: &&String| if self.is_explicit { *listed == path } else { moved(path, listed, "/").is_some() };
            list.iter().filter(holds).map(String::len).max()
        };
        nearest(&self.includes).is_some_and(|included| nearest(&self.excludes).is_none_or(|excluded| included > excluded))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_listed_path_decides() {
        let list = |paths: &[&str]| paths.iter().map(|p| (*p).to_string()).collect();
        let mut c = Collection { includes: list(&["/A", "/A/B/C"]), excludes: list(&["/A/B"]), is_explicit: false };
        let found = |c: &Collection| ["/A", "/A/X", "/A/B", "/A/B/C/D", "/AB"].map(|p| c.contains(p));
        assert_eq!(found(&c), [true, true, false, true, false]);
        c.is_explicit = true;
        assert_eq!(found(&c), [true, false, false, false, false]);
    }
}
