//! One warning for all of a kind: a scene of a hundred materials has a hundred reasons for the same sentence.

use enfilade_scene::Warning;
use std::collections::HashMap;

/// Places that a warning names.
const NAMED: usize = 3;
/// Number of warnings that differ in names and numbers alone from which on they are one; those that do not differ, and have no numbers, are one always.
const MANY: usize = 4;

/// The warnings with those of a kind in one, in the place of the first, with their number and the first places.
pub(crate) fn by_kind(warnings: Vec<Warning>) -> Vec<Warning> {
    // What counts things is about its own place alone, unless there are many.
    let plain = |message: &str| (!message.contains(|c: char| c.is_ascii_digit())).then(|| message.to_string());
    let alike = grouped(warnings.into_iter().map(|warning| vec![warning]).collect(), plain, 2);
    grouped(alike, |message| Some(kind(message)), MANY).into_iter().filter_map(joined).collect()
}

/// Groups joined whose messages have the same key, where they are `least` warnings or more together.
fn grouped(groups: Vec<Vec<Warning>>, key: impl Fn(&str) -> Option<String>, least: usize) -> Vec<Vec<Warning>> {
    let keys: Vec<Option<String>> = groups.iter().map(|group| key(&group.first()?.message)).collect();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    keys.iter().zip(&groups).filter_map(|(key, group)| Some((key.as_deref()?, group))).for_each(|(key, group)| {
        *counts.entry(key).or_default() += group.len();
    });
    let (mut joined, mut at): (Vec<Vec<Warning>>, HashMap<&str, usize>) = (Vec::new(), HashMap::new());
    for (key, group) in keys.iter().zip(groups) {
        let many = key.as_deref().filter(|key| counts[key] >= least);
        match many.and_then(|key| at.get(key)) {
            Some(&index) => joined[index].extend(group),
            None => {
                at.extend(many.map(|key| (key, joined.len())));
                joined.push(group);
            }
        }
    }
    joined
}

/// A message without what names and counts: quoted names, paths and numbers.
fn kind(message: &str) -> String {
    let outside: Vec<&str> = message.split('"').step_by(2).collect();
    let is_path = |word: &&str| word.contains(['/', '\\']) || word.trim_end_matches([',', ';', ':', ')']).contains('.');
    let words = outside.iter().flat_map(|text| text.split_whitespace().chain(["…"])).filter(|word| !is_path(word));
    words.map(|word| word.replace(|c: char| c.is_ascii_digit(), "")).collect::<Vec<_>>().join(" ")
}

/// One warning of a group.
fn joined(group: Vec<Warning>) -> Option<Warning> {
    let first = group.first()?;
    let (count, file) = (group.len(), first.place.split_once(": ").map(|(file, _)| file));
    if count == 1 {
        return group.into_iter().next();
    }
    // If all places are in one file, its name is mentioned once.
    let within = |warning: &Warning| warning.place.split_once(": ").filter(|(of, _)| Some(*of) == file).map(|(_, place)| place.to_string());
    let inside: Option<Vec<String>> = group.iter().map(within).collect();
    let mut places = inside.clone().unwrap_or_else(|| group.iter().map(|warning| warning.place.clone()).collect());
    let mut seen = std::collections::HashSet::new();
    places.retain(|place| seen.insert(place.clone()));
    let more = if places.len() > NAMED { format!(" and {} more", places.len() - NAMED) } else { String::new() };
    let named = places.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ") + &more;
    let place = if inside.is_some() { format!("{}: {named}", file.unwrap_or_default()) } else { named };
    let is_alike = group.iter().all(|warning| warning.message == first.message);
    let message = if is_alike { first.message.clone() } else { format!("{}; {} more are of this kind", first.message, count - 1) };
    Some(Warning { place, message })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(place: impl Into<String>, message: impl Into<String>) -> Warning {
        Warning { place: place.into(), message: message.into() }
    }

    fn lines(warnings: Vec<Warning>) -> Vec<String> {
        by_kind(warnings).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_hundred_materials_are_one_line_with_three_names() {
        let of = |i: usize| warning(format!("a.mtl: material \"m{i}\""), "map_Ns ignored");
        let all = (0..100).map(of).chain([warning("a.mtl: material \"m7\"", "Tf ignored")]).collect();
        assert_eq!(
            lines(all),
            ["a.mtl: material \"m0\", material \"m1\", material \"m2\" and 97 more: map_Ns ignored", "a.mtl: material \"m7\": Tf ignored"]
        );
    }

    #[test]
    fn four_that_differ_in_names_are_of_a_kind_and_three_are_told() {
        let of =
            |i: usize| warning(format!("a.obj: material \"m{i}\""), format!("the texture maps/{i}.png is gone; a plain grey stands in"));
        assert_eq!(lines((0..3).map(of).collect()).len(), 3);
        let told = lines((0..5).map(of).collect());
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].starts_with("a.obj: material \"m0\", material \"m1\", material \"m2\" and 2 more: the texture maps/0.png is gone"));
        assert!(told[0].ends_with("; 4 more are of this kind"), "{told:?}");
    }

    #[test]
    fn files_are_named_where_they_differ() {
        let told = lines(vec![warning("a.glb: whole file", "no normals"), warning("b.glb: whole file", "no normals")]);
        assert_eq!(told, ["a.glb: whole file, b.glb: whole file: no normals"]);
    }
}
