//! The words of the command line.

/// The words behind the instrument's name.
pub fn arguments() -> impl Iterator<Item = String> {
    std::env::args().skip(2)
}
