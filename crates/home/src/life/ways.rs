//! Ways through a home that things close.

use super::stage::Stage;
use crate::check::walk;
use std::collections::BTreeSet;

/// As few of these objects as possible, the last ones if there is a choice, without which people can walk into every room that they could
/// walk into without all of them.
pub fn closed_by(stage: &Stage, objects: Vec<String>) -> Vec<String> {
    let floor = walk::Floor::new(stage.home);
    if floor.unreachable(|_| true).is_empty() {
        return Vec::new();
    }
    let closed = |gone: &BTreeSet<String>| floor.unreachable(|object| !gone.contains(object)).len();
    let mut gone: BTreeSet<String> = objects.iter().cloned().collect();
    let least = closed(&gone);
    for object in objects {
        gone.remove(&object);
        if closed(&gone) > least {
            gone.insert(object);
        }
    }
    gone.into_iter().collect()
}
