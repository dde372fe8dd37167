//! Reading a plan: names in it become paths on the worker's machine, so each is checked first.

use crate::Plan;
use crate::plan::StoredFile;
use std::collections::BTreeMap;
use std::path::{Component, Path};

impl Plan {
    /// Parses a plan from `bytes`.
    ///
    /// # Errors
    /// When they are no plan, or a plan that would write outside of a dataset's folder, with what is wrong.
    pub fn from_json(bytes: &[u8]) -> Result<Self, String> {
        let plan: Self = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        check_files("files", &plan.files)?;
        for scene in &plan.scenes {
            check_name("a scene", &scene.name)?;
            check_files(&format!("files of scene {}", scene.name), &scene.files)?;
        }
        for (number, task) in plan.tasks.iter().enumerate() {
            check_name(&format!("the scene of task {number}"), &task.part.scene)?;
            check_name(&format!("the camera of task {number}"), &task.part.camera)?;
            if !plan.scenes.iter().any(|scene| scene.name == task.part.scene) {
                return Err(format!("task {number} is of scene {:?}, which the plan does not have", task.part.scene));
            }
        }
        Ok(plan)
    }
}

fn check_files(what: &str, files: &BTreeMap<String, StoredFile>) -> Result<(), String> {
    for (path, file) in files {
        let normal = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        if path.is_empty() || !normal {
            return Err(format!("{what}: found the path {path:?}, expected one within a dataset's folder"));
        }
        if file.blake3.len() != 64 || !file.blake3.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f')) {
            return Err(format!("{what}: found {:?} as the hash of {path}, expected 64 hexadecimal digits", file.blake3));
        }
    }
    Ok(())
}

/// Names of scenes and cameras are folders.
fn check_name(what: &str, name: &str) -> Result<(), String> {
    let mut parts = Path::new(name).components();
    match (parts.next(), parts.next()) {
        (Some(Component::Normal(part)), None) if part == name => Ok(()),
        _ => Err(format!("{what} is called {name:?}, expected the name of a folder")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(path: &str, hash: &str, scene: &str, of_task: &str) -> String {
        let expected = r#"{"mean": 1.0, "deviation": 0.1}"#;
        format!(
            r#"{{"format": 1, "program": "enfilade", "id": "", "dataset": "d", "cpus": 1,
            "files": {{"{path}": {{"blake3": "{hash}", "bytes": 1}}}},
            "scenes": [{{"name": "{scene}", "files": {{}}, "frames": 1, "cpu_s": {expected}, "memory_bytes": {expected}, "disk_bytes": {expected}}}],
            "tasks": [{{"scene": "{of_task}", "camera": "cam_00", "frames": [0], "cpu_s": 1.0}}]}}"#
        )
    }

    #[test]
    fn a_plan_that_would_write_elsewhere_is_refused() {
        let hash = "0a".repeat(32);
        Plan::from_json(plan("a/b.csv", &hash, "room", "room").as_bytes()).unwrap();
        let refused = |path, hash, scene, of_task| Plan::from_json(plan(path, hash, scene, of_task).as_bytes()).unwrap_err();
        assert!(refused("../b.csv", &hash, "room", "room").contains("files: found the path \"../b.csv\""));
        assert!(refused("/b.csv", &hash, "room", "room").contains("within a dataset's folder"));
        assert!(refused("a", "../../x", "room", "room").contains("64 hexadecimal digits"));
        assert!(refused("a", &hash, "..", "..").contains("a scene is called \"..\""));
        assert!(refused("a", &hash, "room", "room/../../x").contains("the scene of task 0"));
        assert!(refused("a", &hash, "room", "other").contains("which the plan does not have"));
    }
}
