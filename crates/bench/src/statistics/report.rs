//! The page `docs/benchmarks/homes.md`, and `homes.json` beside it.

use super::buildings;
use super::measure::{Measured, Object};
use super::published::{
    DWELLING_M2, HYPERSIM_INSTANCES, HYPERSIM_SCENES, HYPERSIM_SCENES_WITH, HYPERSIM_VOLUMES_M3, ROOM_SOURCES, ROOMS, SIZE_SOURCES,
};
use super::remarks;
use super::sizes;
use super::spread::{Spread, tidy};
use enfilade_home::Building;
use enfilade_scene::{NYU40, is_stuff};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// Writes both files into `folder`.
pub fn write(all: Vec<Measured>, folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let (table, buildings) = (buildings::table(&all), buildings::figures(&all));
    let homes: Vec<Measured> = all.into_iter().filter(|made| made.building == Building::Home.name()).collect();
    let mut figures = figures(&homes);
    figures["buildings"] = buildings;
    std::fs::write(folder.join("homes.md"), page(&homes) + &table)?;
    std::fs::write(folder.join("homes.json"), serde_json::to_string_pretty(&figures)? + "\n")
}

fn page(homes: &[Measured]) -> String {
    let (first, last) = (homes.first().map_or(0, |home| home.seed), homes.last().map_or(0, |home| home.seed));
    let mut page = format!(
        "# Homes: what they cost and what is in them\n\nMade by `cargo xtask bench homes` on {}: the {} homes of the seeds {first} to \
         {last} with the\ndefaults, each in a process of its own. [homes.md](../homes.md) says what is drawn from which distribution.\n",
        enfilade_testkit::processor(),
        homes.len()
    );
    page += &cost_table(homes);
    page += &class_table(homes);
    page += &sizes::tables(homes);
    page += &room_table(homes);
    page += &clutter_table(homes);
    page + &truth(homes)
}

/// A quantity of every home.
type Quantity = (&'static str, fn(&Measured) -> f64);

const COSTS: [Quantity; 14] = [
    ("processor time, s", |home| home.cpu_s),
    ("time, s", |home| home.wall_s),
    ("peak memory, MB", |home| home.peak_mb),
    ("scene package, MB", |home| home.package_mb),
    ("rooms", |home| home.rooms.len() as f64),
    ("triangles", |home| home.triangles as f64),
    ("triangles stored", |home| home.stored_triangles as f64),
    ("parts", |home| home.parts as f64),
    ("meshes", |home| home.meshes as f64),
    ("instances", |home| home.objects.len() as f64),
    ("classes", |home| classes_of(home) as f64),
    ("triangles per room", |home| per_room(home, home.triangles)),
    ("parts per room", |home| per_room(home, home.parts)),
    ("instances per room", |home| per_room(home, home.objects.len())),
];

fn per_room(home: &Measured, count: usize) -> f64 {
    count as f64 / home.rooms.len().max(1) as f64
}

fn classes_of(home: &Measured) -> usize {
    (1..=40).filter(|&class| is_stuff(class) || home.objects.iter().any(|object| object.semantic == class)).count()
}

fn cost_table(homes: &[Measured]) -> String {
    let mut text = String::from("\n## Cost\n\n| per home | mean | median | 90 % below | largest |\n|---|---|---|---|---|\n");
    for (name, value) in COSTS {
        let spread: Spread = homes.iter().map(value).collect();
        let cells = [spread.mean(), spread.quantile(0.5), spread.quantile(0.9), spread.quantile(1.0)].map(tidy);
        let _ = writeln!(text, "| {name} | {} |", cells.join(" | "));
    }
    text += remarks::COST;
    let [wall, cpu]: [f64; 2] = [homes.iter().map(|home| home.wall_s).sum(), homes.iter().map(|home| home.cpu_s).sum()];
    if wall > 1.5 * cpu { text + remarks::SHARED } else { text }
}

/// Share of the instances, and of the homes, that belong to a class or have it; in per cent.
fn shares(homes: &[Measured], class: i16) -> [f64; 2] {
    let all: usize = homes.iter().map(|home| home.objects.len()).sum();
    let ours: usize = homes.iter().map(|home| home.objects.iter().filter(|object| object.semantic == class).count()).sum();
    let with = homes.iter().filter(|home| is_stuff(class) || home.objects.iter().any(|object| object.semantic == class)).count();
    [percent(ours, all), percent(with, homes.len())]
}

fn hypersims(class: i16) -> [f64; 2] {
    let (k, all) = (class as usize - 1, HYPERSIM_INSTANCES.iter().sum::<u32>() as usize);
    [percent(HYPERSIM_INSTANCES[k] as usize, all), percent(HYPERSIM_SCENES_WITH[k] as usize, HYPERSIM_SCENES as usize)]
}

fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

fn class_table(homes: &[Measured]) -> String {
    let mut text = String::from(remarks::CLASSES);
    text +=
        "\n| class | % of instances, ours | Hypersim's | % of homes with it, ours | of Hypersim's scenes | |\n|---|---|---|---|---|---|\n";
    for class in NYU40 {
        let ([ours, homes_with], [theirs, scenes_with]) = (shares(homes, class.id), hypersims(class.id));
        let share = |value: f64| if is_stuff(class.id) { String::new() } else { format!("{value:.2}") };
        let comment = remarks::of_class(class.id);
        let _ = writeln!(text, "| {} | {} | {} | {homes_with:.0} | {scenes_with:.0} | {comment} |", class.name, share(ours), share(theirs));
    }
    text
}

fn room_table(homes: &[Measured]) -> String {
    let mut text = String::from(
        "\n## Rooms\n\nClear areas between the walls, m². The programme is the range from which a room's area is drawn before the \
         search.\n\n\
         | room | rooms | median | 10 % to 90 % | programme | published | |\n|---|---|---|---|---|---|---|\n",
    );
    for room in &ROOMS {
        let areas: Spread = homes
            .iter()
            .flat_map(|home| &home.rooms)
            .filter(|found| found.kind == room.kind)
            .map(|found| f64::from(found.area_m2))
            .collect();
        let [from, to] = enfilade_home::RoomKind::from_name(room.kind).map_or([0.0; 2], |kind| enfilade_home::room::kind::norm(kind).area);
        let found = if areas.count() == 0 {
            "– | –".into()
        } else {
            format!("{:.1} | {:.1} to {:.1}", areas.quantile(0.5), areas.quantile(0.1), areas.quantile(0.9))
        };
        let _ = writeln!(text, "| {} | {} | {found} | {from:.1} to {to:.1} | {} | {} |", room.kind, areas.count(), room.area, room.comment);
    }
    let whole: Spread = homes.iter().map(floor_m2).collect();
    let _ = writeln!(
        text,
        "\nA home has {:.0} m² of floor (median; 10 % have less than {:.0}, 10 % more than {:.0}). A dwelling in Germany has \
         {DWELLING_M2} m² on average [4],\nwhich includes houses; ours are flats.\n\n{ROOM_SOURCES}",
        whole.quantile(0.5),
        whole.quantile(0.1),
        whole.quantile(0.9)
    );
    text
}

fn floor_m2(home: &Measured) -> f64 {
    home.rooms.iter().map(|room| f64::from(room.area_m2)).sum()
}

/// Whether an object is small: the volume of its box is below 30 litres and no side is longer than 0.6 m.
fn small(object: &Object) -> bool {
    volume_m3(object) < 0.03 && object.size_m.iter().all(|&side| side < 0.6)
}

fn volume_m3(object: &Object) -> f64 {
    object.size_m.iter().map(|&side| f64::from(side)).product()
}

/// Small things of every room of a kind, and those to the square metre of its surfaces where it has any to speak of.
fn clutter(homes: &[Measured], kind: &str) -> [Spread; 2] {
    let rooms = homes.iter().flat_map(|home| home.rooms.iter().enumerate().map(move |(k, room)| (home, k, room)));
    let counted: Vec<(f64, f64)> = rooms
        .filter(|(_, _, room)| room.kind == kind)
        .map(|(home, k, room)| {
            let things = home.objects.iter().filter(|object| object.room == Some(k) && small(object)).count();
            (things as f64, f64::from(room.surface_m2))
        })
        .collect();
    let on_surfaces = counted.iter().filter(|(_, surface)| *surface > 0.5).map(|(things, surface)| things / surface);
    [counted.iter().map(|(things, _)| *things).collect(), on_surfaces.collect()]
}

fn clutter_table(homes: &[Measured]) -> String {
    let mut text = String::from(remarks::CLUTTER);
    text += "\n| room | small things, median | 10 % to 90 % | per m² of surface, median |\n|---|---|---|---|\n";
    for room in &ROOMS {
        let [things, dense] = clutter(homes, room.kind);
        if things.count() > 0 {
            let dense = if dense.count() == 0 { "–".into() } else { tidy(dense.quantile(0.5)) };
            let [low, middle, high] = [0.1, 0.5, 0.9].map(|q| things.quantile(q));
            let _ = writeln!(text, "| {} | {middle:.0} | {low:.0} to {high:.0} | {dense} |", room.kind);
        }
    }
    let volumes: Spread = homes.iter().flat_map(|home| &home.objects).map(volume_m3).collect();
    let [ours_low, ours_middle, ours_high] = [0.05, 0.5, 0.95].map(|q| volumes.quantile(q));
    let [low, middle, high] = HYPERSIM_VOLUMES_M3;
    let _ = writeln!(
        text,
        "\nThe boxes of our instances have {:.2} litres in the median (5 % less than {:.2}, 5 % more than {:.0}), those of Hypersim {:.1} \
         ({:.2}, {:.0}).\n{}",
        1e3 * ours_middle,
        1e3 * ours_low,
        1e3 * ours_high,
        1e3 * middle,
        1e3 * low,
        1e3 * high,
        remarks::VOLUMES
    );
    text
}

fn truth(homes: &[Measured]) -> String {
    let parts: usize = homes.iter().map(|home| home.parts).sum();
    let unlabelled: usize = homes.iter().map(|home| home.unlabelled_parts).sum();
    let sound = homes.iter().filter(|home| home.faults.is_empty()).count();
    format!(
        "\n## Labels and faults\n\n{} of {parts} parts have a class ({:.2} %); of Hypersim's pixels 88.35 % have one. {sound} of {} homes \
         have no fault by the\nchecks of [homes.md](../homes.md#checks).\n",
        parts - unlabelled,
        percent(parts - unlabelled, parts),
        homes.len()
    )
}

/// Figures of the report for programs.
fn figures(homes: &[Measured]) -> Value {
    let spread = |spread: &Spread| {
        let [low, middle, high, largest] = [0.1, 0.5, 0.9, 1.0].map(|q| spread.quantile(q));
        json!({ "count": spread.count(), "mean": spread.mean(), "p10": low, "median": middle, "p90": high, "largest": largest })
    };
    let cost: serde_json::Map<String, Value> =
        COSTS.iter().map(|(name, value)| ((*name).into(), spread(&homes.iter().map(value).collect()))).collect();
    let class = |class: &enfilade_scene::SemanticClass| {
        let ([ours, homes_with], [theirs, scenes_with]) = (shares(homes, class.id), hypersims(class.id));
        json!({ "class": class.name, "instances_percent": [ours, theirs], "homes_percent": [homes_with, scenes_with] })
    };
    let room = |room: &super::published::PublishedRoom| {
        let found = homes.iter().flat_map(|home| &home.rooms).filter(|found| found.kind == room.kind);
        let [things, dense] = clutter(homes, room.kind);
        let area: Spread = found.map(|found| f64::from(found.area_m2)).collect();
        json!({ "kind": room.kind, "area_m2": spread(&area), "small_things": spread(&things), "small_things_per_m2": spread(&dense) })
    };
    let faults: Vec<Value> =
        homes.iter().filter(|home| !home.faults.is_empty()).map(|home| json!({ "seed": home.seed, "faults": home.faults })).collect();
    json!({
        "homes": homes.len(),
        "cost": cost,
        "classes": NYU40.iter().map(class).collect::<Vec<_>>(),
        "sizes": sizes::figures(homes),
        "rooms": ROOMS.iter().map(room).collect::<Vec<_>>(),
        "unlabelled_parts": homes.iter().map(|home| home.unlabelled_parts).sum::<usize>(),
        "faults": faults,
        "sources": [SIZE_SOURCES, ROOM_SOURCES],
    })
}
