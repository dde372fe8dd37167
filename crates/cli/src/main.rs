//! The `enfilade` binary.
fn main() {}
