//! The table of all kinds of buildings: what each costs, and how many are without a fault.

use super::measure::Measured;
use super::spread::{Spread, tidy};
use enfilade_home::Building;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The homes and buildings of one kind.
fn of(all: &[Measured], building: Building) -> Vec<&Measured> {
    all.iter().filter(|made| made.building == building.name()).collect()
}

fn median(made: &[&Measured], value: impl Fn(&Measured) -> f64) -> f64 {
    made.iter().map(|made| value(made)).collect::<Spread>().quantile(0.5)
}

/// The section, which is empty where there are homes only.
pub fn table(all: &[Measured]) -> String {
    if all.iter().all(|made| made.building == Building::Home.name()) {
        return String::new();
    }
    let mut text = String::from(
        "\n## Buildings\n\nMedians of each kind of building, with the rooms that it has where none are named.\n\n\
         | building | made | rooms | floor, m² | processor time, s | peak memory, MB | triangles | instances | without a fault |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for building in Building::ALL {
        let made = of(all, building);
        if made.is_empty() {
            continue;
        }
        let cells = [
            median(&made, |made| made.rooms.len() as f64),
            median(&made, |made| made.rooms.iter().map(|room| f64::from(room.area_m2)).sum()),
            median(&made, |made| made.cpu_s),
            median(&made, |made| made.peak_mb),
            median(&made, |made| made.triangles as f64),
            median(&made, |made| made.objects.len() as f64),
        ];
        let sound = made.iter().filter(|made| made.faults.is_empty()).count();
        let _ = writeln!(text, "| {} | {} | {} | {sound} |", building.name(), made.len(), cells.map(tidy).join(" | "));
    }
    text
}

/// The table for programs.
pub fn figures(all: &[Measured]) -> Value {
    let kind = |building: Building| {
        let made = of(all, building);
        let faults: Vec<Value> =
            made.iter().filter(|made| !made.faults.is_empty()).map(|made| json!({ "seed": made.seed, "faults": made.faults })).collect();
        json!({
            "building": building.name(),
            "made": made.len(),
            "processor_s": median(&made, |made| made.cpu_s),
            "triangles": median(&made, |made| made.triangles as f64),
            "faults": faults,
        })
    };
    Building::ALL.into_iter().filter(|building| !of(all, *building).is_empty()).map(kind).collect()
}
