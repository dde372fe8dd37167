//! Several group names on one `g` line: a face belongs to all of them, as in `g chair_1 furniture`.
//!
//! The format separates names by spaces, but many programs write a name with spaces (`g Living Room Chair`). A program writes all its lines
//! alike, so they are several names if no line contradicts that and one shows it: the first name, which is the innermost, is on no more
//! lines than the names behind it, every name has a letter, and some name is on several lines or written as one word by a sign or digit
//! (`chair_1`).

use super::file::Group;
use std::collections::{BTreeSet, HashMap};

/// Splits the names of groups where they are several: the first stays the name, the others are the groups around it.
pub(super) fn split(groups: &mut [Group]) {
    let is_object = |group: &Group| group.object_name == group.name;
    let lines: BTreeSet<&str> = groups.iter().filter(|group| !is_object(group)).filter_map(|group| group.name.as_deref()).collect();
    if !are_several(&lines) {
        return;
    }
    for group in groups.iter_mut().filter(|group| !is_object(group)) {
        let names: Vec<String> = group.name.iter().flat_map(|name| name.split_whitespace()).map(str::to_string).collect();
        if let [first, around @ ..] = names.as_slice() {
            (group.name, group.around) = (Some(first.clone()), around.to_vec());
        }
    }
}

/// Whether lines with spaces are several names each.
fn are_several(lines: &BTreeSet<&str>) -> bool {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for line in lines {
        let names: BTreeSet<&str> = line.split_whitespace().collect();
        names.into_iter().for_each(|name| *counts.entry(name).or_default() += 1);
    }
    let several: Vec<Vec<&str>> =
        lines.iter().map(|line| line.split_whitespace().collect()).filter(|names: &Vec<_>| names.len() > 1).collect();
    let is_innermost = |names: &Vec<&str>| names.iter().all(|name| counts[names[0]] <= counts[name]);
    let is_word = |name: &&str| name.contains(char::is_alphabetic);
    let is_one_word = |name: &&str| name.contains(|c: char| c == '_' || c.is_ascii_digit());
    several.iter().all(|names| is_innermost(names) && names.iter().all(is_word))
        && several.iter().flatten().any(|name| counts[name] > 1 || is_one_word(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn several(lines: &[&str]) -> bool {
        are_several(&lines.iter().copied().collect())
    }

    #[test]
    fn names_of_groups_are_told_from_names_with_spaces() {
        // As SketchUp and Maya write groups, innermost first.
        assert!(several(&["Mesh1 Chair Model", "Mesh2 Chair Model", "Mesh3 Table1 Model"]));
        assert!(several(&["chair_1 furniture", "table_1 furniture", "floor"]));
        assert!(several(&["chair_1 furniture"]));
        assert!(several(&["chair furniture", "table furniture"]));
        // Names of one thing.
        assert!(!several(&["Living Room Chair", "Living Room Table"]));
        assert!(!several(&["Chair 1", "Chair 2", "Table #1 furniture"]));
        assert!(!several(&["Big Chair", "Small Table", "floor"]));
        assert!(!several(&["floor", "wall_1"]));
    }
}
