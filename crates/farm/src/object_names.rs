//! The names of objects in a job's store. Each lies in the folder of its kind; names of payloads and attempts are never used twice.

/// What there is to do.
pub(crate) const PLAN: &str = "plan.json";
/// Files that workers need, under their hashes.
pub(crate) const OBJECTS: &str = "objects";
/// Payloads: the files of a frame as one attempt made them.
pub(crate) const FRAMES: &str = "frames";
/// Markers, each of which says which payload is a frame.
pub(crate) const DONE: &str = "done";
/// Frames in the making, left by attempts that were told to end.
pub(crate) const KEPT: &str = "kept";
/// What attempts have come to.
pub(crate) const ATTEMPTS: &str = "attempts";
/// Objects that are made to find out what a store does, and removed.
pub(crate) const PROBE: &str = "probe";

/// Everything that lies at the top of a job.
pub(crate) const ALL: [&str; 7] = [PLAN, OBJECTS, FRAMES, DONE, KEPT, ATTEMPTS, PROBE];

/// The name of a file that workers need, by its BLAKE3.
pub(crate) fn object_name(blake3: &str) -> String {
    format!("{OBJECTS}/{}/{blake3}", &blake3[..blake3.len().min(2)])
}
