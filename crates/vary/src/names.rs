//! Names for materials that are new.

/// The name, with the first number behind it, if need be, under which nothing `is_taken`.
pub fn free_name(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let candidates = std::iter::once(name.to_string()).chain((2..).map(|number| format!("{name} {number}")));
    candidates.into_iter().find(|candidate| !is_taken(candidate)).unwrap_or_default()
}
