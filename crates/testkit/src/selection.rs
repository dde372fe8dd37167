//! How much of a long search a run of the tests takes.

/// Set by `cargo xtask test --all`: long searches go over all their seeds.
const ALL: &str = "ENFILADE_ALL_TESTS";

/// How many seeds, counted from 0, a search goes over: `few`, or `all` where all tests are asked for.
pub fn seeds(few: u64, all: u64) -> u64 {
    if std::env::var_os(ALL).is_some() { all } else { few }
}
