//! The table of a search.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What guards stand between our readers and mistakes of the libraries behind them.
const NOTES: &str = "\
## Where libraries are guarded

- `rust-hdf5`: the file's length is compared with what its superblock says, and the shape of an array with what deflate can make of the
  file; chunks without an extent are not read by our own way. Trees of chunks of version 1 are walked first, and refused where they lead
  to a node twice or out of the file; so are more chunks than 32 per byte. Where the library panics all the same, that becomes an error.
- `image`, `exr`: width and height are read first, and pictures of more than 2^27 pixels or a gigabyte of channels are refused; so are
  EXRs, V-Ray's too, with blocks of more than 128 MiB, for which room is made before they are read, and with a table that does not lead
  to each block once.
- `png`, in scene packages: the size must be the one that the package says, and no more than deflate can make of the file.
- `draco-core`: has limits of its own on vertices, triangles and bytes, which are set by the size of the stream; so is what meshopt unpacks.
- `basisu`: width and height are read first; where its decoder of ETC1S panics, as at sums beyond 32 bits, that becomes an error.
- `ruzstd`: no more is unpacked than the picture's size calls for.
- `flate2`, `zip`: what is unpacked is counted, and refused beyond a bound: vertices of a mesh, bytes of a list, of a model.
- `postcard`: blends within blends are read 128 deep, since the library has no bound of its own.
";

/// What is known of a target after a search.
pub struct Row {
    pub name: String,
    pub about: String,
    executions: f64,
    per_second: f64,
    /// Edges of the control flow that were gone along.
    edges: f64,
    /// Inputs that lead to different places.
    corpus: f64,
    /// Memory of the process at its peak, code and corpus included.
    peak_rss_mb: f64,
    /// The most that was allocated at a time when the slowest input had been read.
    pub peak_alloc_mb: f64,
    pub slowest_ms: f64,
    pub found: Option<Found>,
}

/// An input that broke a target.
pub struct Found {
    /// What the program said.
    pub problem: String,
    /// Where it lies.
    pub input: PathBuf,
}

impl Found {
    /// What was found and what to do.
    pub fn message(&self, target: &str) -> String {
        format!(
            "{target}: {}\n  the input is {}; fix what reads it, and keep the input in crates/fuzz/regressions/{target}/ by a name that \
             says what it is",
            self.problem,
            self.input.display()
        )
    }
}

impl Row {
    /// Reads what libFuzzer said of a target.
    pub fn new(name: &str, about: &str, said: &str, found: Option<Found>) -> Self {
        let stat = |name: &str| {
            let line = said.lines().find_map(|line| line.strip_prefix("stat::")?.strip_prefix(name)?.strip_prefix(':'));
            line.and_then(|value| value.trim().parse().ok()).unwrap_or(0.0)
        };
        // "#4096 pulse cov: 812 ft: 1707 corp: 120/3241b …": the last one counts.
        let status = said.lines().rev().find(|line| line.starts_with('#') && line.contains(" cov: ")).unwrap_or_default();
        let after = |word: &str| {
            let value = status.split(word).nth(1)?.split([' ', '/']).find(|part| !part.is_empty())?;
            value.parse::<f64>().ok()
        };
        Self {
            name: name.into(),
            about: about.into(),
            executions: stat("number_of_executed_units"),
            per_second: stat("average_exec_per_sec"),
            edges: after("cov:").unwrap_or(0.0),
            corpus: after("corp:").unwrap_or(0.0),
            peak_rss_mb: stat("peak_rss_mb"),
            peak_alloc_mb: 0.0,
            slowest_ms: 0.0,
            found,
        }
    }

    fn json(&self) -> Value {
        json!({
            "target": self.name,
            "reads": self.about,
            "executions": self.executions,
            "executions_per_s": self.per_second,
            "edges": self.edges,
            "corpus": self.corpus,
            "peak_rss_mb": self.peak_rss_mb,
            "peak_alloc_mb": self.peak_alloc_mb.round(),
            "slowest_ms": self.slowest_ms,
            "found": self.found.as_ref().map(|found| found.problem.clone()),
        })
    }
}

/// The rows as a table of Markdown.
pub fn table(rows: &[Row]) -> String {
    let head = "| target | reads | executions | per second | edges | corpus | peak memory, MB | slowest input, ms | found |\n\
                |---|---|---|---|---|---|---|---|---|\n";
    let row = |row: &Row| {
        let found = row.found.as_ref().map_or("nothing".to_string(), |found| found.problem.replace('|', "\\|"));
        format!(
            "| {} | {} | {} | {} | {} | {} | {} | {:.1} | {found} |\n",
            row.name, row.about, row.executions, row.per_second, row.edges, row.corpus, row.peak_rss_mb, row.slowest_ms
        )
    };
    rows.iter().map(row).fold(head.to_string(), |table, row| table + &row)
}

/// Writes `fuzz.md` and `fuzz.json`.
///
/// # Errors
/// When they cannot be written.
pub fn write(folder: &Path, seconds: u64, rows: &[Row]) -> Result<(), String> {
    let page = format!("{}\n\n{}\n{NOTES}", intro(seconds), table(rows));
    let json = json!({ "seconds_per_target": seconds, "targets": rows.iter().map(Row::json).collect::<Vec<_>>() });
    let json = serde_json::to_string_pretty(&json).map_err(|error| error.to_string())? + "\n";
    for (name, text) in [("fuzz.md", page), ("fuzz.json", json)] {
        let file = folder.join(name);
        std::fs::write(&file, text).map_err(|error| format!("cannot write {}: {error}", file.display()))?;
    }
    Ok(())
}

fn intro(seconds: u64) -> String {
    format!(
        "# Fuzzing: everything that reads bytes from outside\n\n\
         Made by `cargo xtask fuzz --seconds {seconds}`, two targets at a time. libFuzzer searches by coverage, from the files of the tests; \
         the program has every\ncheck of the debug build. A panic, an input that takes longer than 20 s, and more than 1.5 GB of memory at a \
         time end a search and are\nmistakes. Edges are those of the whole program's control flow that inputs went along; the corpus is the \
         inputs that lead to different\nplaces; times are of the program with coverage. Targets and what was found before: `crates/fuzz/`."
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAID: &str = "INFO: seed corpus: files: 3\n#4\tINITED cov: 500 ft: 501 corp: 2/20b exec/s: 0 rss: 70Mb\n\
        #90\tNEW    cov: 812 ft: 1707 corp: 120/3241b lim: 8 exec/s: 45 rss: 80Mb L: 3/9 MS: 1 ChangeBit-\n\
        #91\tDONE   cov: 812 ft: 1707 corp: 120/3241b lim: 8 exec/s: 45 rss: 80Mb\nDone 91 runs in 2 second(s)\n\
        stat::number_of_executed_units: 91\nstat::average_exec_per_sec:     45\nstat::peak_rss_mb:              80\n";

    #[test]
    fn what_libfuzzer_says_becomes_a_row() {
        let row = Row::new("obj", "Wavefront OBJ", SAID, None);
        assert_eq!((row.executions, row.per_second, row.edges, row.corpus, row.peak_rss_mb), (91.0, 45.0, 812.0, 120.0, 80.0));
        assert!(table(&[row]).ends_with("| obj | Wavefront OBJ | 91 | 45 | 812 | 120 | 80 | 0.0 | nothing |\n"));
    }

    #[test]
    fn what_was_found_is_told_with_where_it_lies_and_what_to_do() {
        let found = Found { problem: "panicked at a.rs:1:2: oh".into(), input: "target/fuzz/obj/found/small".into() };
        let message = found.message("obj");
        assert!(message.starts_with("obj: panicked at a.rs:1:2: oh\n  the input is target/fuzz/obj/found/small; fix"), "{message}");
        assert!(message.contains("crates/fuzz/regressions/obj/"));
    }
}
