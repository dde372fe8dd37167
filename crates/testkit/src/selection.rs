//! The part of a long search that a run of the tests does.

/// Set by `cargo xtask test --all`: long searches go over all their seeds.
const ALL: &str = "ENFILADE_ALL_TESTS";

/// Number of seeds, counted from 0, that a search tries: `few`, or `all` if all tests are requested.
pub fn seeds(few: u64, all: u64) -> u64 {
    if std::env::var_os(ALL).is_some() { all } else { few }
}
