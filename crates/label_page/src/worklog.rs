//! How long people worked on a scene: the time between two inputs counts as work unless it is a long pause.

use super::clock;
use enfilade_dataset::write_bytes;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Name of the work log in the folder of labels.
pub const WORK_LOG: &str = "annotation_time.csv";
/// Longer pauses do not count as work, seconds.
pub const LONGEST_PAUSE_S: f64 = 60.0;

/// A run of the program, from its first to its last moment of work.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorkSession {
    /// In UTC.
    pub start: String,
    /// In UTC.
    pub end: String,
    /// Time at work, seconds.
    pub active_seconds: f64,
    /// Edits made, undoing included.
    pub actions: u64,
}

/// All sessions of a scene; the last one is the session of this run, once something is done in it.
pub struct WorkLog {
    path: PathBuf,
    earlier: Vec<WorkSession>,
    this: Option<WorkSession>,
    /// When somebody last did something, seconds since 1970.
    last_input_s: Option<f64>,
}

impl WorkLog {
    /// Reads the sessions recorded in `folder`.
    ///
    /// # Errors
    /// When the file is there and cannot be understood.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let path = folder.join(WORK_LOG);
        let earlier = match std::fs::read(&path) {
            Ok(bytes) => parse(&bytes).map_err(|problem| format!("{}: {problem}; fix it or move it away", path.display()))?,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(e) => return Err(format!("cannot read {}: {e}", path.display())),
        };
        Ok(Self { path, earlier, this: None, last_input_s: None })
    }

    /// Records input at this moment, seconds since 1970. Several pages may report the same time; it counts once.
    pub fn input(&mut self, moment_s: f64) {
        let this = self.this.get_or_insert_with(|| {
            let start = clock::iso(moment_s);
            WorkSession { end: start.clone(), start, active_seconds: 0.0, actions: 0 }
        });
        let since = moment_s - *self.last_input_s.get_or_insert(moment_s);
        if since > 0.0 {
            if since < LONGEST_PAUSE_S {
                this.active_seconds += since;
            }
            self.last_input_s = Some(moment_s);
            this.end = clock::iso(moment_s);
        }
    }

    /// Records an edit at this moment.
    pub fn action(&mut self, moment_s: f64) {
        self.input(moment_s);
        if let Some(this) = &mut self.this {
            this.actions += 1;
        }
    }

    /// Every session, this one last.
    pub fn sessions(&self) -> Vec<WorkSession> {
        self.earlier.iter().chain(&self.this).cloned().collect()
    }

    /// Writes the file; nothing when nothing was done yet.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self) -> Result<(), enfilade_dataset::DatasetError> {
        if self.this.is_none() {
            return Ok(());
        }
        let mut text = String::from("start,end,active_seconds,actions\n");
        for WorkSession { start, end, active_seconds, actions } in self.sessions() {
            text.push_str(&format!("{start},{end},{active_seconds:.0},{actions}\n"));
        }
        write_bytes(&self.path, text)
    }
}

fn parse(bytes: &[u8]) -> Result<Vec<WorkSession>, String> {
    let mut reader = csv::Reader::from_reader(bytes);
    let row = |(i, record): (usize, csv::Result<csv::StringRecord>)| {
        let record = record.map_err(|e| e.to_string())?;
        let cell = |column: usize| record.get(column).unwrap_or("");
        let wrong = |what: &str, found: &str| format!("line {}: {what} is {found:?}, expected a number", i + 2);
        Ok(WorkSession {
            start: cell(0).into(),
            end: cell(1).into(),
            active_seconds: cell(2).parse().map_err(|_| wrong("active_seconds", cell(2)))?,
            actions: cell(3).parse().map_err(|_| wrong("actions", cell(3)))?,
        })
    };
    reader.records().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn idle_time_is_not_counted_and_sessions_add_up() {
        let folder = tempfile::tempdir().unwrap();
        let mut log = WorkLog::open(folder.path()).unwrap();
        log.write().unwrap();
        assert!(!folder.path().join(WORK_LOG).exists());
        log.input(1000.0);
        log.input(1015.0);
        // A second page reports the same time.
        log.input(1010.0);
        log.action(1030.0);
        // Lunch.
        log.input(4000.0);
        log.input(4020.0);
        log.write().unwrap();
        let session = WorkSession { start: clock::iso(1000.0), end: clock::iso(4020.0), active_seconds: 50.0, actions: 1 };
        assert_eq!(log.sessions(), std::slice::from_ref(&session));
        let mut again = WorkLog::open(folder.path()).unwrap();
        assert_eq!(again.sessions(), std::slice::from_ref(&session));
        again.action(9000.0);
        again.write().unwrap();
        let sessions = WorkLog::open(folder.path()).unwrap().sessions();
        assert_eq!((sessions.len(), &sessions[0], sessions[1].actions), (2, &session, 1));
        std::fs::write(folder.path().join(WORK_LOG), "start,end,active_seconds,actions\na,b,c,d\n").unwrap();
        assert!(WorkLog::open(folder.path()).err().unwrap().contains("line 2: active_seconds is \"c\""));
    }
}
