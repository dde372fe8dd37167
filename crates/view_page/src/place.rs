//! The frame that an address names, and how problems with the dataset's files are answered.

use super::cache::Stamp;
use enfilade_dataset::{DatasetError, check_name};
use enfilade_serve::ApiProblem;
use std::path::Path;

/// Scene, camera and number of a frame. The names are safe as parts of paths.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FramePlace {
    /// Scene name.
    pub scene: String,
    /// Camera name.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
}

impl FramePlace {
    /// From the words of an address.
    ///
    /// # Errors
    /// 400 when a name cannot be part of a path or the frame is no number.
    pub fn parse([scene, camera, frame]: [String; 3]) -> Result<Self, ApiProblem> {
        check_name("scene name", &scene).map_err(problem)?;
        check_name("camera name", &camera).map_err(problem)?;
        let wrong = || ApiProblem::bad_request(format!("the frame is {frame:?}"), "give its number, such as 0 or 12");
        // `parse` accepts a sign, which would give one frame two addresses.
        let digits = frame.bytes().all(|b| b.is_ascii_digit());
        let frame = frame.parse().ok().filter(|_| digits).ok_or_else(wrong)?;
        Ok(Self { scene, camera, frame })
    }
}

/// The answer to a request that met this error.
pub fn problem(error: DatasetError) -> ApiProblem {
    let text = error.to_string();
    if error.is_not_found() {
        return ApiProblem::not_found(text, "look at /api/view/dataset for what there is; it may not be made yet");
    }
    match error {
        DatasetError::Name { .. } => ApiProblem::bad_request(text, "use the names that /api/view/dataset lists"),
        _ => ApiProblem::failed(text, "fix or delete the file that is named"),
    }
}

/// Turns the error that a file does not exist into `None`.
pub fn optional<T>(result: Result<T, DatasetError>) -> Result<Option<T>, ApiProblem> {
    match result {
        Err(error) if error.is_not_found() => Ok(None),
        other => other.map(Some).map_err(problem),
    }
}

/// Length and modification time of a file; zero and `None` if it cannot be read, in which case reading it will report the reason.
pub fn stamp(path: &Path) -> Stamp {
    std::fs::metadata(path).map_or((0, None), |data| (data.len(), data.modified().ok()))
}

/// A digest that changes with a file.
pub fn version(path: &Path) -> String {
    let (bytes, time) = stamp(path);
    let since = time.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok()).unwrap_or_default();
    let both = [bytes.to_le_bytes().as_slice(), &since.as_nanos().to_le_bytes()].concat();
    blake3::hash(&both).to_hex()[..16].to_string()
}
