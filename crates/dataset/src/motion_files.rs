//! How a camera moved between its frames: `_detail/<camera>/metadata_camera_motion.csv`.

use crate::atomic::remove_if_there;
use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name};
use enfilade_math::{DQuat, DVec3};
use enfilade_scene::MotionSample;

const HEADER: [&str; 17] = [
    "time_s",
    "position_x",
    "position_y",
    "position_z",
    "rotation_w",
    "rotation_x",
    "rotation_y",
    "rotation_z",
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "angular_rate_x",
    "angular_rate_y",
    "angular_rate_z",
    "specific_force_x",
    "specific_force_y",
    "specific_force_z",
];

impl Dataset {
    /// Writes how a camera moved; no samples remove the table.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or the file cannot be written.
    pub fn write_motion(&self, scene: &str, camera: &str, motion: &[MotionSample]) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let path = self.layout().motion(scene, camera);
        if motion.is_empty() {
            return remove_if_there(&path);
        }
        let mut table = Table::new(&path, &HEADER);
        let row = |sample: &MotionSample| {
            let MotionSample { time_s, position, rotation, velocity, angular_rate, specific_force } = sample;
            let [x, y, z, w] = rotation.to_array();
            let vectors = [velocity, angular_rate, specific_force].into_iter().flat_map(|v| v.to_array());
            let values = [*time_s].into_iter().chain(position.to_array()).chain([w, x, y, z]).chain(vectors);
            // The shortest text that is read back as the same number.
            values.map(|value| value.to_string()).collect()
        };
        table.rows = motion.iter().map(row).collect();
        table.write()
    }

    /// How a camera moved; nothing where it is not known, as of cameras that make no video.
    ///
    /// # Errors
    /// When the table is damaged.
    pub fn read_motion(&self, scene: &str, camera: &str) -> Result<Vec<MotionSample>, DatasetError> {
        let path = self.layout().motion(scene, camera);
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let table = Table::read(&path)?;
        let at = table.columns(HEADER)?;
        let sample = |row: usize| {
            let mut values = [0.0; HEADER.len()];
            for (value, column) in values.iter_mut().zip(at) {
                *value = table.parse(row, column)?;
            }
            let vector = |first: usize| DVec3::new(values[first], values[first + 1], values[first + 2]);
            let rotation = DQuat::from_xyzw(values[5], values[6], values[7], values[4]);
            if (rotation.length() - 1.0).abs() > 1e-6 {
                let problem = format!("line {}: the rotation has length {}, expected 1; plan the scene again", row + 2, rotation.length());
                return Err(DatasetError::text(&path, problem));
            }
            Ok(MotionSample {
                time_s: values[0],
                position: vector(1),
                rotation,
                velocity: vector(8),
                angular_rate: vector(11),
                specific_force: vector(14),
            })
        };
        (0..table.rows.len()).map(sample).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write_bytes;

    #[test]
    fn motion_comes_back_to_the_bit_and_what_is_no_rotation_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let sample = |i: i32| MotionSample {
            time_s: f64::from(i) / 192.0,
            position: DVec3::new(0.1, -1.0 / 3.0, 1e-17),
            rotation: DQuat::from_rotation_z(0.1 * f64::from(i)),
            velocity: DVec3::X,
            angular_rate: DVec3::new(1e-9, 0.3, -0.7),
            specific_force: DVec3::new(0.0, -9.80665, 0.0),
        };
        let motion: Vec<MotionSample> = (0..5).map(sample).collect();
        dataset.write_motion("room", "cam_00", &motion).unwrap();
        assert_eq!(dataset.read_motion("room", "cam_00").unwrap(), motion);
        let path = dataset.layout().motion("room", "cam_00");
        let text = std::fs::read_to_string(&path).unwrap().replacen(",1,0,0,0,", ",2,0,0,0,", 1);
        write_bytes(&path, text).unwrap();
        let message = dataset.read_motion("room", "cam_00").unwrap_err().to_string();
        assert!(message.contains("line 2: the rotation has length 2, expected 1"), "{message}");
        dataset.write_motion("room", "cam_00", &[]).unwrap();
        assert_eq!(dataset.read_motion("room", "cam_00").unwrap(), []);
    }
}
