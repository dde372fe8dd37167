//! The table of a search.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The guards that protect our readers from mistakes of the libraries they use.
const NOTES: &str = "\
## Guards around libraries

- `rust-hdf5`: the file's length is compared with its superblock, and the shape of an array with the most that deflate can produce from the
  file; our own reader does not read chunks without an extent. Trees of chunks of version 1 are walked first, and refused where they lead
  to a node twice or out of the file; so are more than 32 chunks per byte. If the library panics nevertheless, that becomes an error.
- `image`, `exr`: width and height are read first; pictures of more than 2^27 pixels or a gigabyte of channels are refused. So are
  EXRs, V-Ray's included, with blocks of more than 128 MiB, since memory for these is allocated before reading, or with a table that does
  not list each block once.
- `png`, in scene packages: the size must be the one that the package states, and no more than deflate can produce from the file.
- `draco-core`: its own limits on vertices, triangles and bytes are set by the size of the stream, as is the limit on what meshopt unpacks.
- `basisu`: width and height are read first; a panic of its ETC1S decoder, as at sums beyond 32 bits, becomes an error.
- `ruzstd`: no more is unpacked than the picture's size requires.
- `flate2`, `zip`: unpacked data are counted, and refused beyond a bound: the vertices of a mesh, the bytes of a list or a model.
- `postcard`: blends within blends are read to a depth of 128, since the library has no bound of its own.
";

/// The results of a target after a search.
pub struct Row {
    pub name: String,
    pub about: String,
    executions: f64,
    per_second: f64,
    /// Edges of the control flow that were covered.
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
    /// Message of the program.
    pub problem: String,
    /// Path of the input.
    pub input: PathBuf,
}

impl Found {
    /// The message: the problem and what to do.
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
    /// Reads libFuzzer's output for a target.
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
        "# Fuzzing: everything that reads untrusted bytes\n\n\
         Made by `cargo xtask fuzz --seconds {seconds}`, two targets at a time. libFuzzer searches by coverage, starting from the files of \
         the tests;\nthe program has every check of the debug build. A panic, an input that takes longer than 20 s, and more than 1.5 GB of \
         memory at a time\nend a search and count as defects. Edges are those of the whole program's control flow that inputs reached; the \
         corpus is the set of\ninputs that reach different code; times are of the program with coverage. `crates/fuzz/` describes the \
         targets and what was found before."
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
