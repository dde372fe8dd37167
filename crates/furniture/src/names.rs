//! The meaning of the names of parts: `sofa_2/cushion_1` is a part of the object `sofa_2`, which belongs to the family `sofa`.
//!
//! [`Builder`](crate::Builder) makes such names.

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
