//! The table of results, on the terminal and in `docs/benchmarks`.

use super::measure::Measured;
use enfilade_testkit::processor;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// Rays of a walk of 100 frames, 20 candidates each, at 256×192 pixels.
const WALK_RAYS: f64 = 99.0 * 20.0 * 256.0 * 192.0;

/// All rooms.
#[derive(Default)]
pub struct Report {
    rooms: Vec<Measured>,
}

/// One line of the comparison.
struct Row {
    case: String,
    ours_s: f64,
    peer_s: f64,
}

impl Report {
    pub fn push(&mut self, room: Measured) {
        self.rooms.push(room);
    }

    /// Writes `explore.md` and `explore.json`.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("explore.md"), self.markdown())?;
        let row = |row: Row| -> Value {
            json!({ "case": row.case, "ours": tidy(row.ours_s), "peer": tidy(row.peer_s), "ratio": tidy(row.peer_s / row.ours_s) })
        };
        let rows: Vec<Value> = self.rows().into_iter().map(row).collect();
        std::fs::write(folder.join("explore.json"), serde_json::to_string_pretty(&rows)? + "\n")
    }

    /// "carve ROOM" and "walk ROOM", a walk being the median of the room's cameras.
    fn rows(&self) -> Vec<Row> {
        let carve =
            |room: &Measured| Row { case: format!("carve {}", room.name), ours_s: room.carve_s[0], peer_s: room.peer_carve_s.iter().sum() };
        let walk = |room: &Measured| Row {
            case: format!("walk {}", room.name),
            ours_s: median(room.walks_s.iter().map(|walk| walk.0[0])),
            peer_s: median(room.walks_s.iter().map(|walk| walk.1)),
        };
        self.rooms.iter().map(carve).chain(self.rooms.iter().map(walk)).collect()
    }

    pub fn markdown(&self) -> String {
        let mut page = format!(
            "# Exploring: our carving and walking against Hypersim's programs\n\n\
             Made by `cargo xtask bench explore` on {}. Values are CPU seconds of one thread, medians of five runs, with the programs'\n\
             parameters (voxels of 0.1 m in a cube of 30 m, 262,144 rays from five positions per start; 100 frames, 20 candidates, test images of\n\
             256x192). Everything is included: each of our runs builds its hierarchy and writes or reads its octree. The programs' times were\n\
             recorded with their results on the same kind of processor, in another run; the time of carving includes its Python part.\n\n\
             | case | ours, s | theirs, s | theirs / ours |\n|---|---|---|---|\n",
            processor()
        );
        for row in self.rows() {
            let _ = writeln!(page, "| {} | {:.2} | {:.2} | **{:.1}** |", row.case, row.ours_s, row.peer_s, row.peer_s / row.ours_s);
        }
        page += "\nThe parts of these times, and the times of the `default` preset for the same work:\n\n\
                 | room | triangles | hierarchy, s | carve, `hypersim` | carve, `default` | walks, `hypersim` | walks, `default` | faster on all cores: carve, walk |\n\
                 |---|---|---|---|---|---|---|---|\n";
        for room in &self.rooms {
            let walks = |preset: usize| room.walks_s.iter().map(|walk| format!("{:.2}", walk.0[preset])).collect::<Vec<_>>().join(", ");
            let [carve, default] = room.carve_s;
            let [on_carve, on_walk] = room.speedups;
            let _ = writeln!(
                page,
                "| {} | {} | {:.2} | {carve:.2} | {default:.2} | {} | {} | {on_carve:.2}, {on_walk:.2} |",
                room.name,
                room.triangles,
                room.hierarchy_s,
                walks(0),
                walks(1)
            );
        }
        page += "\nAgreement of the results of preset `hypersim` with those of the programs:\n\n\
                 | room | free voxels, ours / theirs | free, intersection over union | occupied | positions carved from, farthest | frames at the same positions |\n\
                 |---|---|---|---|---|---|\n";
        for room in &self.rooms {
            let a = &room.agreement;
            let _ = writeln!(
                page,
                "| {} | {} / {} | {:.6} | {:.6} | {:.1e} m | {} of {} |",
                room.name, a.free[0], a.free[1], a.overlap[0], a.overlap[1], a.carve_positions_m, a.frames[1], a.frames[0]
            );
        }
        page + &self.limits()
    }

    fn limits(&self) -> String {
        let walk_s = median(self.rooms.iter().flat_map(|room| room.walks_s.iter().map(|walk| walk.0[0] - room.hierarchy_s)));
        format!(
            "\n## The limit\n\n\
             A walk needs to know what {:.1} million rays see. Embree, in packets of sixteen, takes 2.9 to 4.1 s for them in these rooms (measured\n\
             separately); the program casts 5.6 million a second. The score needs only the set of triangles in view, so we draw the triangles into tiles\n\
             of 16x16 pixels by means of the hierarchy and cast none of these rays: {:.0} million pixels a second, including everything else in the walk.\n\n\
             Carving casts 1.3 million rays per start through fifty to a hundred voxels each; traversing all of them on a flat bit grid takes 1.0 to\n\
             2.9 s. We skip what is known to be free, and test the mesh only where sampling has not decided a surface's voxel.\n",
            WALK_RAYS / 1e6,
            WALK_RAYS / walk_s / 1e6
        )
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

fn tidy(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
