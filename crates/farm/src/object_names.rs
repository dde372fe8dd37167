//! The names of objects in a job's store. Each is in the folder of its kind; names of payloads and attempts are never used twice.

/// The plan of the job.
pub(crate) const PLAN: &str = "plan.json";
/// Files that workers need, under their hashes.
pub(crate) const OBJECTS: &str = "objects";
/// Payloads: the files of a frame as one attempt made them.
pub(crate) const FRAMES: &str = "frames";
/// Markers, each of which names the payload of a frame.
pub(crate) const DONE: &str = "done";
/// Unfinished frames, left by attempts that were asked to end.
pub(crate) const KEPT: &str = "kept";
/// Records of attempts.
pub(crate) const ATTEMPTS: &str = "attempts";
/// Objects that are created to test a store, and removed.
pub(crate) const PROBE: &str = "probe";

/// Everything at the top level of a job.
pub(crate) const ALL: [&str; 7] = [PLAN, OBJECTS, FRAMES, DONE, KEPT, ATTEMPTS, PROBE];

/// The name of a file that workers need, by its BLAKE3.
pub(crate) fn object_name(blake3: &str) -> String {
    format!("{OBJECTS}/{}/{blake3}", &blake3[..blake3.len().min(2)])
}
