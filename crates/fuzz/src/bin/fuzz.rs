//! The fuzzing program: libFuzzer, and one target of the table. `cargo xtask fuzz` builds it with coverage, and runs it.
//!
//! Two environment variables control it: `ENFILADE_FUZZ_WRITE=FOLDER` writes the table and the seeds of every target there and ends;
//! `ENFILADE_FUZZ_TARGET=NAME` fuzzes that target, with libFuzzer's options on the command line, and keeps its files in the folder that
//! `ENFILADE_FUZZ_FOLDER` names: `input` is the input that is being read, in case it kills the process without a message; `slowest` the
//! longest time that an input took, in microseconds; `memory` the most bytes that were allocated at a time.
#![no_main]

use cap::Cap;
use enfilade_fuzz::{MAX_MEMORY, Run, TARGETS, Target};
use libfuzzer_sys::fuzz_target;
use std::alloc::System;
use std::cell::RefCell;
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// More memory than this is refused, which ends the process: libFuzzer keeps the input.
#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, MAX_MEMORY);

/// Message of the last panic. It is shown if the panic leaves the target: one that the target catches is no fault.
static PANIC: Mutex<String> = Mutex::new(String::new());

thread_local! {
    static SEARCH: RefCell<Option<Search>> = const { RefCell::new(None) };
}

/// A target at work.
struct Search {
    run: Run,
    folder: PathBuf,
    input: File,
    slowest: Duration,
}

fuzz_target!(init: begin(), |bytes: &[u8]| {
    SEARCH.with_borrow_mut(|search| search.as_mut().expect("a target").read(bytes));
});

fn begin() {
    if let Some(folder) = std::env::var_os("ENFILADE_FUZZ_WRITE") {
        write_table(Path::new(&folder));
        std::process::exit(0);
    }
    std::panic::set_hook(Box::new(|panic| *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string()));
    let variable = |name: &str| std::env::var(name).unwrap_or_else(|_| stop(&format!("{name} is not set; run `cargo xtask fuzz`")));
    let name = variable("ENFILADE_FUZZ_TARGET");
    let target = Target::of(&name).unwrap_or_else(|| stop(&format!("there is no target {name:?}")));
    let folder = PathBuf::from(variable("ENFILADE_FUZZ_FOLDER"));
    let files = folder.join("files");
    drop(std::fs::remove_dir_all(&files));
    std::fs::create_dir_all(&files).unwrap_or_else(|error| stop(&format!("cannot make {}: {error}", files.display())));
    let input = File::create(folder.join("input")).unwrap_or_else(|error| stop(&format!("cannot write {}: {error}", folder.display())));
    let search = Search { run: target.prepare(&files), folder, input, slowest: Duration::ZERO };
    SEARCH.with_borrow_mut(|place| *place = Some(search));
}

fn stop(message: &str) -> ! {
    eprintln!("error: {message}");
    std::process::exit(2)
}

impl Search {
    fn read(&mut self, bytes: &[u8]) {
        // The input is prefixed with its length, so that one write is enough.
        let kept = [&(bytes.len() as u64).to_le_bytes(), bytes].concat();
        self.input.write_all_at(&kept, 0).expect("a folder that can be written");
        let start = Instant::now();
        if catch_unwind(AssertUnwindSafe(|| (self.run)(bytes))).is_err() {
            eprintln!("{}", PANIC.lock().unwrap_or_else(PoisonError::into_inner));
            std::process::abort();
        }
        let time = start.elapsed();
        if time > self.slowest {
            self.slowest = time;
            self.note("slowest", time.as_micros());
            self.note("memory", MEMORY.max_allocated() as u128);
        }
    }

    fn note(&self, name: &str, value: u128) {
        std::fs::write(self.folder.join(name), value.to_string()).expect("a folder that can be written");
    }
}

/// Writes `targets.json`, and per target `<name>/seeds` and `<name>/words`.
fn write_table(folder: &Path) {
    let row = |target: &Target| serde_json::json!({ "name": target.name, "about": target.about, "longest": target.longest });
    for target in TARGETS {
        let seeds = folder.join(target.name).join("seeds");
        std::fs::create_dir_all(&seeds).expect("a folder that can be written");
        for seed in target.all_seeds().into_iter().chain(target.regressions()) {
            std::fs::write(seeds.join(seed.name), seed.bytes).expect("a folder that can be written");
        }
        let words: String = target.words.iter().map(|word| format!("{word:?}\n")).collect();
        std::fs::write(folder.join(target.name).join("words"), words).expect("a folder that can be written");
    }
    let table = serde_json::Value::from(TARGETS.iter().map(row).collect::<Vec<_>>());
    std::fs::write(folder.join("targets.json"), table.to_string()).expect("a folder that can be written");
}
