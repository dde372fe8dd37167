//! Every file to begin with and every input that was once found is read again, with the bounds of a search.

use cap::Cap;
use enfilade_fuzz::{MAX_MEMORY, Seed, TARGETS, Target};
use std::alloc::System;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, MAX_MEMORY);

/// Longer than any takes on a busy machine, and short of a hang.
const PATIENCE: Duration = Duration::from_secs(20);

/// Reads inputs in a folder that goes away; what went wrong, by input.
fn read(target: &Target, inputs: &[Seed]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let mut run = target.prepare(folder.path());
    let mut found = Vec::new();
    for Seed { name, bytes } in inputs {
        // Shown where the test fails; memory without bound ends it with no other word.
        println!("{}/{name}", target.name);
        let start = Instant::now();
        if catch_unwind(AssertUnwindSafe(|| run(bytes))).is_err() {
            found.push(format!("{}/{name} panics", target.name));
        }
        if start.elapsed() > PATIENCE {
            found.push(format!("{}/{name} takes {:?}", target.name, start.elapsed()));
        }
    }
    found
}

#[test]
fn every_seed_is_read_without_panic() {
    for target in TARGETS {
        let seeds = target.all_seeds();
        assert!(!seeds.is_empty(), "{}: a target needs files to begin with, in seeds/{} or made in src/seeds", target.name, target.name);
        let found = read(target, &seeds);
        assert!(found.is_empty(), "{found:#?}");
    }
}

#[test]
fn every_input_that_was_found_is_read_without_panic() {
    let found: Vec<String> = TARGETS.iter().flat_map(|target| read(target, &target.regressions())).collect();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn folders_belong_to_targets_whose_names_differ() {
    for kind in ["seeds", "regressions"] {
        for entry in std::fs::read_dir(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(kind)).unwrap() {
            let name = entry.unwrap().file_name().to_string_lossy().into_owned();
            assert!(name.ends_with(".md") || Target::of(&name).is_some(), "{kind}/{name} belongs to no target");
        }
    }
    let names: std::collections::BTreeSet<&str> = TARGETS.iter().map(|target| target.name).collect();
    assert_eq!(names.len(), TARGETS.len());
}
