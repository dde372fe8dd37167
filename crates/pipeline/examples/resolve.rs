//! Resolves configurations: for every line of the standard input, a `dataset.toml` as a JSON string, it writes one line of JSON,
//! `{"config": …}` with every default filled in, or `{"error": …}`.
//!
//! `cargo xtask docs` gets the defaults and ranges of all keys from it, so that the documentation agrees with the program.

use anyhow::Result;
use enfilade_pipeline::{Config, Error, Overrides};
use serde_json::{Value, json};
use std::io::BufRead;
use std::path::Path;

fn main() -> Result<()> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("dataset.toml");
    for line in std::io::stdin().lock().lines() {
        let text: String = serde_json::from_str(&line?)?;
        std::fs::write(&file, text)?;
        println!("{}", outcome(&file));
    }
    Ok(())
}

fn outcome(file: &Path) -> Value {
    match Config::read(file, &Overrides::default()) {
        Ok(config) => json!({ "config": Config { name: "dataset".into(), ..config } }),
        Err(Error::Config(error)) => json!({ "error": error.message }),
        Err(error) => json!({ "error": error.to_string() }),
    }
}
