//! Choosing scenes and cameras by a pattern of names.

use crate::error::Error;
use crate::pattern::matches;
use enfilade_options::closest;

/// The names (of things called `what`) that match `pattern`, in which `*` stands for any run of characters and `,` separates alternatives; all of
/// them without a pattern.
///
/// # Errors
/// When none does.
pub fn select(what: &str, names: &[String], pattern: Option<&str>) -> Result<Vec<String>, Error> {
    let Some(pattern) = pattern else { return Ok(names.to_vec()) };
    let chosen: Vec<String> = names.iter().filter(|name| pattern.split(',').any(|p| matches(p.trim(), name))).cloned().collect();
    if chosen.is_empty() {
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let proposal = closest(pattern, &known).map_or(String::new(), |n| format!("did you mean {n:?}? "));
        let hint = format!("{proposal}the {what}s are: {}", names.join(", "));
        return Err(Error::usage(format!("no {what} is named {pattern:?}"), hint));
    }
    Ok(chosen)
}
