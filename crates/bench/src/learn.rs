//! Learns the tables of `data/` again: `cargo run --release -p enfilade-bench -- learn object_names_nyu40.csv... -o crates/suggest/data`
//!
//! Each input is a CSV with the columns scene, `object_name`, `nyu40_id` and `instance_id`. The same inputs give the same bytes.

use enfilade_suggest::calibration::Thresholds;
use enfilade_suggest::learn::{LearnConfig, NameGroup, Split, group, held_out, learn, read_names, with_curtains};
use enfilade_suggest::lexicon::Lexicon;
use std::error::Error;
use std::path::Path;

/// Shares of right names that thresholds are given for.
const PRECISIONS: [f32; 4] = [0.8, 0.85, 0.9, 0.95];
/// Parts that the volumes are divided into.
const FOLDS: usize = 10;

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = crate::arguments::arguments().collect();
    let [inputs @ .., option, folder] = arguments.as_slice() else {
        return Err("expected: TABLE.csv... -o FOLDER".into());
    };
    if inputs.is_empty() || option != "-o" {
        return Err("expected: TABLE.csv... -o FOLDER".into());
    }
    let mut objects = Vec::new();
    for input in inputs {
        let bytes = std::fs::read(input).map_err(|error| format!("{input}: {error}"))?;
        objects.extend(read_names(&bytes, input)?);
    }
    let lexicon = Lexicon::builtin()?;
    let groups = with_curtains(&group(&objects), &lexicon);
    let config = LearnConfig::default();
    let weights = learn(&groups.iter().collect::<Vec<&NameGroup>>(), &lexicon, &config);
    let unseen = held_out(&groups, &lexicon, &config, Split::Volume, FOLDS);
    let thresholds = Thresholds::find(&unseen.confidences, &PRECISIONS);
    let (shares, around) = unseen.around(&groups);
    let tables = [
        ("weights.csv", weights.to_csv()),
        ("calibration.csv", unseen.calibration().to_csv()),
        ("thresholds.csv", thresholds.to_csv()),
        ("shares.csv", shares.to_csv()),
        ("around.csv", around.to_csv()),
    ];
    for (file, text) in tables {
        let path = Path::new(folder).join(file);
        std::fs::write(&path, &text).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{}  {} bytes", path.display(), text.len());
    }
    let (features, entries) = weights.size();
    println!("{} objects, {} names of {features} features with {entries} weights", objects.len(), groups.len());
    print!("{}", thresholds.to_csv());
    Ok(())
}
