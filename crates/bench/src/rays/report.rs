//! The table, on the terminal and in `docs/benchmarks`.

use super::peers::Failure;
use super::turns::{Compared, Row};
use enfilade_testkit::processor;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// All rooms, and the version of Embree if it took part.
pub struct Report {
    version: Option<String>,
    rooms: Vec<Compared>,
}

impl Report {
    pub fn new(version: Option<String>) -> Self {
        Self { version, rooms: Vec::new() }
    }

    pub fn push(&mut self, room: Compared) {
        self.rooms.push(room);
    }

    /// Prints the geometric mean of the ratios over the rooms.
    pub fn print_summary(&self) {
        if self.version.is_none() {
            return;
        }
        println!("\nours / Embree, ours / Embree robust, geometric means over {} rooms", self.rooms.len());
        for (case, [default, robust]) in self.means() {
            println!("{case:>24}  {default:.2} {robust:.2}");
        }
    }

    fn means(&self) -> Vec<(&'static str, [f64; 2])> {
        let Some(first) = self.rooms.first() else { return Vec::new() };
        let mean = |row: usize, peer: usize| {
            let logs: f64 = self.rooms.iter().map(|room| ratio(&room.rows[row], peer).ln()).sum();
            (logs / self.rooms.len() as f64).exp()
        };
        (0..first.rows.len()).map(|row| (first.rows[row].case, [mean(row, 1), mean(row, 2)])).collect()
    }

    /// Writes `rays.md` and `rays.json`.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("rays.md"), self.markdown()?)?;
        let rows: Vec<_> = self.rooms.iter().flat_map(|room| room.rows.iter().map(move |row| (room, row))).collect();
        let rows: Vec<_> = rows
            .into_iter()
            .map(|(room, row)| {
                let case = format!("{}, {}", room.room, row.case);
                json!({ "case": case, "ours": tidy(row.speed(0)), "peer": tidy(row.speed(1)), "ratio": tidy(ratio(row, 1)) })
            })
            .collect();
        std::fs::write(folder.join("rays.json"), serde_json::to_string_pretty(&rows)? + "\n")?;
        Ok(())
    }

    fn markdown(&self) -> Result<String, std::fmt::Error> {
        let version = self.version.as_deref().unwrap_or("?");
        let mut page = format!(
            "# Rays: our hierarchy and Embree {version}\n\n\
             Made by `cargo xtask bench rays` on {}. Values are millions of single rays per core-second on one thread; each is the\n\
             median of interleaved runs over the same rays. Embree uses `rtcIntersect1` and `rtcOccluded1` with medium build quality. Its default\n\
             triangle test is not watertight; ours is, and so is Embree's *robust* mode. The run checks that the numbers of hits agree to one part in\n\
             ten thousand, and the sums of their distances to one part in a thousand.\n\n\
             | room | rays | ours | Embree | ours / Embree | Embree robust | ours / robust |\n|---|---|---|---|---|---|---|\n",
            processor(),
        );
        for room in &self.rooms {
            for (i, row) in room.rows.iter().enumerate() {
                let name = if i == 0 { &room.room } else { "" };
                let speeds = [0, 1, 2].map(|engine| row.speed(engine));
                let ratios = [1, 2].map(|peer| ratio(row, peer));
                writeln!(
                    page,
                    "| {name} | {} | {:.1} | {:.1} | **{:.2}** | {:.1} | {:.2} |",
                    row.case, speeds[0], speeds[1], ratios[0], speeds[2], ratios[1]
                )?;
            }
        }
        for (case, [default, robust]) in self.means() {
            writeln!(page, "| *geometric mean* | {case} | | | **{default:.2}** | | {robust:.2} |")?;
        }
        page += "\n| room | triangles | our build, core-s | MB |\n|---|---|---|---|\n";
        for room in &self.rooms {
            writeln!(page, "| {} | {} | {:.2} | {:.1} |", room.room, room.triangles, room.build_seconds, room.megabytes)?;
        }
        Ok(page)
    }
}

fn ratio(row: &Row, peer: usize) -> f64 {
    row.speed(0) / row.speed(peer)
}

fn tidy(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
