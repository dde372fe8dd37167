//! `manifest_times.csv`: the time of each frame, and other values that differ between two runs. Rows are appended as frames finish; of
//! several rows for one frame the last counts. A table that an older version began keeps its five columns.

use crate::{Dataset, DatasetError};
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

const HEADER: &str = "scene_name,camera_name,frame_id,seconds_wall,seconds_cpu,peak_memory_bytes,threads\n";
/// Header of tables of older versions.
const OLD_HEADER: &str = "scene_name,camera_name,frame_id,seconds_wall,seconds_cpu\n";

/// The time that a frame took, and the resources used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// Elapsed seconds.
    pub wall_s: f64,
    /// Seconds of all threads together.
    pub cpu_s: f64,
    /// Peak memory of the process until the frame was finished; `None` if the system does not report it.
    pub peak_memory_bytes: Option<u64>,
    /// Threads at work.
    pub threads: Option<u32>,
}

impl Dataset {
    /// The time that each frame took when it was last rendered, by scene, camera and frame number. Rows that a killed run left
    /// unfinished are passed over.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn read_times(&self) -> Result<BTreeMap<(String, String, u32), FrameTime>, DatasetError> {
        let path = self.layout().manifest_times();
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
            text => text.map_err(DatasetError::at("read", &path))?,
        };
        Ok(text.lines().filter_map(parse_row).collect())
    }

    /// Appends a row in one write, so that rows of several threads do not mix.
    ///
    /// # Errors
    /// When the table cannot be written.
    pub fn append_time(&self, scene: &str, camera: &str, frame: u32, time: FrameTime) -> Result<(), DatasetError> {
        let path = self.layout().manifest_times();
        let [memory, threads] = [time.peak_memory_bytes, time.threads.map(u64::from)].map(|v| v.map_or(String::new(), |v| v.to_string()));
        let times = format!("{scene},{camera},{frame},{:.3},{:.3}", time.wall_s, time.cpu_s);
        append(&path, &times, &format!(",{memory},{threads}")).map_err(DatasetError::at("write", &path))
    }
}

/// Appends a row, after the header in a new file and after a line end that a killed run has not written. `more` are the cells of
/// columns that an older table lacks.
fn append(path: &Path, row: &str, more: &str) -> std::io::Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
    let length = file.metadata()?.len();
    let (mut before, mut more) = (HEADER, more);
    if length > 0 {
        let mut head = vec![0; OLD_HEADER.len().min(length as usize)];
        file.read_exact(&mut head)?;
        if head == OLD_HEADER.as_bytes() {
            more = "";
        }
        file.seek(SeekFrom::End(-1))?;
        let mut last = [0];
        file.read_exact(&mut last)?;
        before = if last == *b"\n" { "" } else { "\n" };
    }
    file.write_all(format!("{before}{row}{more}\n").as_bytes())
}

/// Names have no commas or quotes, so a row is split at commas.
fn parse_row(row: &str) -> Option<((String, String, u32), FrameTime)> {
    let cells: Vec<&str> = row.split(',').collect();
    let (&[scene, camera, frame, wall, cpu], more) = cells.split_first_chunk::<5>()?;
    let (peak_memory_bytes, threads) = match more {
        [] => (None, None),
        [memory, threads] => (memory.parse().ok(), threads.parse().ok()),
        _ => return None,
    };
    let time = FrameTime { wall_s: wall.parse().ok()?, cpu_s: cpu.parse().ok()?, peak_memory_bytes, threads };
    Some(((scene.to_string(), camera.to_string(), frame.parse().ok()?), time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_row_of_a_frame_counts_and_torn_rows_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(dataset.read_times().unwrap().is_empty());
        let time = |wall_s| FrameTime { wall_s, cpu_s: 2.0 * wall_s, peak_memory_bytes: Some(1 << 30), threads: Some(2) };
        dataset.append_time("room", "cam_00", 0, time(1.5)).unwrap();
        dataset.append_time("room", "cam_00", 1, time(2.0)).unwrap();
        dataset.append_time("room", "cam_00", 0, time(3.25)).unwrap();
        let path = dataset.layout().manifest_times();
        fs::write(&path, fs::read_to_string(&path).unwrap() + "room,cam_0").unwrap();
        dataset.append_time("room", "cam_01", 0, time(4.0)).unwrap();
        let key = |camera: &str, frame| ("room".to_string(), camera.to_string(), frame);
        let expected = [(key("cam_00", 0), time(3.25)), (key("cam_00", 1), time(2.0)), (key("cam_01", 0), time(4.0))];
        assert_eq!(dataset.read_times().unwrap(), BTreeMap::from(expected));
        assert!(fs::read_to_string(&path).unwrap().starts_with(HEADER));
    }

    #[test]
    fn a_table_of_an_older_version_is_read_and_keeps_its_columns() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let path = dataset.layout().manifest_times();
        fs::write(&path, format!("{OLD_HEADER}room,cam_00,0,1.500,3.000\n")).unwrap();
        let new = FrameTime { wall_s: 2.0, cpu_s: 4.0, peak_memory_bytes: Some(7), threads: None };
        dataset.append_time("room", "cam_00", 1, new).unwrap();
        assert!(fs::read_to_string(&path).unwrap().ends_with("3.000\nroom,cam_00,1,2.000,4.000\n"));
        let times: Vec<FrameTime> = dataset.read_times().unwrap().into_values().collect();
        let old = |wall_s| FrameTime { wall_s, cpu_s: 2.0 * wall_s, ..FrameTime::default() };
        assert_eq!(times, [old(1.5), old(2.0)]);
    }
}
