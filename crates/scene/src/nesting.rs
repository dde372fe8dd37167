//! Reading blends within blends with a limit on their depth: without one, a file could exhaust the stack.

use serde::de::{Deserialize, Deserializer, Error as _};
use std::cell::Cell;

/// Largest depth of blends within blends.
pub(crate) const MAX_DEPTH: usize = 128;

thread_local! {
    /// Number of blends around the one that is being read.
    static WITHIN: Cell<usize> = const { Cell::new(0) };
}

/// Reads a part of a blend, for `serde(deserialize_with)`.
///
/// # Errors
/// If the data end too soon, or the blend is too deep.
pub(crate) fn nested<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Box<T>, D::Error> {
    let within = WITHIN.get();
    if within >= MAX_DEPTH {
        return Err(D::Error::custom(format!("blends within blends are more than {MAX_DEPTH} deep")));
    }
    WITHIN.set(within + 1);
    let part = Box::deserialize(deserializer);
    WITHIN.set(within);
    part
}

#[cfg(test)]
mod tests {
    use crate::Bsdf;
    use enfilade_math::Rgb;

    #[test]
    fn blends_are_read_to_the_deepest_and_no_deeper() {
        let blend = |depth: usize| {
            let plain = || Bsdf::Diffuse { reflectance: Rgb::WHITE.into() };
            let around = |inner| Bsdf::Blend { first: Box::new(plain()), second: Box::new(inner), weight: 0.5.into() };
            (0..depth).fold(plain(), |inner, _| around(inner))
        };
        let read = |depth: usize| postcard::from_bytes::<Bsdf>(&postcard::to_stdvec(&blend(depth)).unwrap());
        assert_eq!(read(Bsdf::DEEPEST).unwrap().depth(), Bsdf::DEEPEST);
        assert!(read(Bsdf::DEEPEST + 1).is_err());
        // A failure leaves nothing behind.
        assert!(read(Bsdf::DEEPEST).is_ok());
    }
}
