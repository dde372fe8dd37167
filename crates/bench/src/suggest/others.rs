//! Names that are not Hypersim's: rooms of other artists, and generated homes.

use enfilade_home::{HomeConfig, home};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::{Quiet, Scene};
use enfilade_suggest::Suggester;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

/// Homes that are made.
const HOMES: u64 = 4;

/// Parts of one scene.
pub struct Other {
    pub name: String,
    /// Parts with a label.
    pub parts: usize,
    /// Labelled parts with a right suggestion of any confidence.
    pub right: usize,
    /// Labelled parts whose suggestion is sure, and those of them that are right.
    pub sure: [usize; 2],
    /// Labelled parts whose suggestion is sure at 95 % precision, and those of them that are right.
    pub surest: [usize; 2],
}

/// Measures the rooms below `scenes` that `material_to_nyu40.csv` labels and that are there as glTF, then homes.
pub fn measure(suggester: &Suggester, scenes: &Path) -> Result<Vec<Other>, Box<dyn Error>> {
    let path = scenes.join("material_to_nyu40.csv");
    let mut reader = csv::Reader::from_path(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut tables: BTreeMap<String, BTreeMap<String, i16>> = BTreeMap::new();
    for record in reader.records() {
        let record = record?;
        let class: i16 = record[3].parse().map_err(|error| format!("{}: {:?}: {error}", path.display(), &record[3]))?;
        tables.entry(record[0].to_string()).or_default().insert(record[1].to_string(), if class == 0 { -1 } else { class });
    }
    let mut found = Vec::new();
    for (name, table) in &tables {
        let file = scenes.join(name).join("gltf/scene.gltf");
        if file.is_file() {
            let scene = load(&file, &ImportOptions::default(), &Quiet)?.scene;
            let material = |i: usize| scene.materials[scene.parts[i].material as usize].name.as_str();
            let classes: Vec<i16> = (0..scene.parts.len()).map(|i| table.get(material(i)).copied().unwrap_or(-1)).collect();
            found.push(judge(name, suggester, &scene, &classes));
        }
    }
    for seed in 0..HOMES {
        let home = home(&HomeConfig::of_seed(seed));
        let classes: Vec<i16> = home.labels.parts.iter().map(|label| label.semantic).collect();
        found.push(judge(&format!("generated home {seed}"), suggester, &home.scene, &classes));
    }
    Ok(found)
}

fn judge(name: &str, suggester: &Suggester, scene: &Scene, classes: &[i16]) -> Other {
    let suggestions = suggester.suggest_scene(scene);
    let pairs: Vec<_> = suggestions.iter().zip(classes).filter(|(_, class)| **class > 0).collect();
    let from = |min: f32| {
        let sure: Vec<bool> =
            pairs.iter().filter_map(|(s, class)| Some(s.as_ref().filter(|s| s.confidence >= min)?.class == **class)).collect();
        [sure.len(), sure.iter().filter(|right| **right).count()]
    };
    let threshold = |precision: f32| suggester.min_confidence(precision).unwrap_or(1.0);
    Other { name: name.into(), parts: pairs.len(), right: from(0.0)[1], sure: from(threshold(0.9)), surest: from(threshold(0.95)) }
}
