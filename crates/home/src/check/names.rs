//! What the names of parts tell: `sofa_2/cushion_1` is a part of the object `sofa_2`, which belongs to the family `sofa`.
//!
//! [`crate::builder::Builder`] makes such names.

use crate::shell::is_shell_family;

/// The object that a part belongs to: its name up to the slash.
pub fn object_of(part: &str) -> &str {
    part.split('/').next().unwrap_or(part)
}

/// The family of an object: its name without its number.
pub fn family_of(object: &str) -> &str {
    match object.rsplit_once('_') {
        Some((family, number)) if !number.is_empty() && number.bytes().all(|c| c.is_ascii_digit()) => family,
        _ => object,
    }
}

/// Pieces of the shell reach into each other, and carry everything else.
pub(crate) fn is_shell(object: &str) -> bool {
    is_shell_family(family_of(object))
}
