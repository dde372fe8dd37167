//! `metadata_camera_parameters.csv`: one row per scene with the image size, units and camera matrices.
//!
//! The columns are those of the table that Hypersim publishes, so that loaders find what they look for. Those of V-Ray's physical
//! camera are empty, as they are there for scenes without one. The matrices are there where they are exact, which is for pinholes;
//! they are empty for distorted and panoramic cameras, whose rays are in files of their own (`camera_model.rs`).

use crate::tables::Table;
use crate::{CameraTable, Dataset, DatasetError, check_name};
use enfilade_math::DMat4;
use enfilade_scene::{Camera, Intrinsics, Projection, TiltedPinhole};

/// Near plane of `M_proj`, metres. It scales depth only, not where a point falls in the image.
const NEAR_M: f64 = 0.01;
/// Far plane of `M_proj`, metres.
const FAR_M: f64 = 1000.0;

/// V-Ray's parameters of a physical camera, in the order of the table.
const CAMERA_PHYSICAL: [&str; 45] = [
    "anisotropy",
    "blades_enable",
    "blades_num",
    "blades_rotation",
    "bmpaperture_affects_exposure",
    "bmpaperture_enable",
    "bmpaperture_resolution",
    "bmpaperture_tex",
    "center_bias",
    "distortion",
    "distortion_tex",
    "distortion_type",
    "dof_display_threshold",
    "dont_affect_settings",
    "enable_thin_lens_equation",
    "exposure",
    "f_number",
    "film_width",
    "focal_length",
    "focus_distance",
    "fov",
    "horizontal_offset",
    "horizontal_shift",
    "ISO",
    "latency",
    "lens_file",
    "lens_shift",
    "optical_vignetting",
    "rolling_shutter_duration",
    "rolling_shutter_mode",
    "shutter_angle",
    "shutter_offset",
    "shutter_speed",
    "specify_focus",
    "specify_fov",
    "subdivs",
    "target_distance",
    "targeted",
    "type",
    "use_dof",
    "use_moblur",
    "vertical_offset",
    "vignetting",
    "white_balance",
    "zoom_factor",
];

/// V-Ray's other camera settings, in the order of the table.
const SETTINGS_CAMERA: [&str; 12] = [
    "auto_corrections_mode",
    "auto_exposure",
    "auto_exposure_compensation",
    "auto_fit",
    "auto_white_balance",
    "curve",
    "dist",
    "dont_affect_settings",
    "fov",
    "height",
    "image_planes",
    "type",
];

impl Dataset {
    /// Sets the scene's row of `metadata_camera_parameters.csv`; the rows of other scenes stay as they are. A damaged table is replaced by
    /// a new one: then the result is the error, and the rows of other scenes are lost.
    ///
    /// # Errors
    /// When the file cannot be read or written.
    pub fn write_camera_parameters(&self, scene: &str, camera: &Camera) -> Result<Option<DatasetError>, DatasetError> {
        check_name("scene name", scene)?;
        let (mut table, damage) = self.read_camera_parameters()?;
        let names = table.column("scene_name")?;
        let row = row_values(scene, camera);
        let cell = |column: &String| row.iter().find(|(name, _)| name == column).map_or(String::new(), |(_, value)| value.clone());
        let cells: Vec<String> = table.header.iter().map(cell).collect();
        table.rows.retain(|row| row[names] != scene);
        table.rows.push(cells);
        table.rows.sort_by(|a, b| a[names].cmp(&b[names]));
        table.write()?;
        Ok(damage)
    }

    /// Removes the rows of scenes that do not stay from `metadata_camera_parameters.csv`. A table that is damaged stays as it is.
    ///
    /// # Errors
    /// When the file cannot be read or written.
    pub fn retain_camera_parameters(&self, stays: impl Fn(&str) -> bool) -> Result<(), DatasetError> {
        let (mut table, _) = self.read_camera_parameters()?;
        let (names, before) = (table.column("scene_name")?, table.rows.len());
        table.rows.retain(|row| stays(&row[names]));
        if table.rows.len() < before { table.write() } else { Ok(()) }
    }

    /// The table of cameras: the dataset's own, or the one that was found near it or named in its place.
    ///
    /// # Errors
    /// When it is missing or damaged.
    pub fn read_camera_table(&self) -> Result<CameraTable, DatasetError> {
        CameraTable::read(&self.camera_table())
    }

    /// The scene's pinhole by that table: [`CameraTable::projection`].
    ///
    /// # Errors
    /// When the table is missing or damaged, has no row for the scene, or its matrix is empty or no pinhole's.
    pub fn table_projection(&self, scene: &str) -> Result<Projection, DatasetError> {
        self.read_camera_table()?.projection(scene)
    }

    /// The scene's `M_proj` by that table: takes camera space to clip space.
    ///
    /// # Errors
    /// When the table is missing or damaged, or has no row for the scene.
    pub fn projection_matrix(&self, scene: &str) -> Result<DMat4, DatasetError> {
        self.read_camera_table()?.projection_matrix(scene)
    }

    /// The table; an empty one with Hypersim's columns if there is none or it is damaged. In the latter case the error is returned too.
    fn read_camera_parameters(&self) -> Result<(Table, Option<DatasetError>), DatasetError> {
        let path = self.layout().camera_parameters();
        let header = header();
        let empty = || Table::new(&path, &header.iter().map(String::as_str).collect::<Vec<_>>());
        let whole = |table: Table| header.iter().try_for_each(|name| table.column(name).map(drop)).map(|()| table);
        match Table::read(&path).and_then(whole) {
            Ok(table) => Ok((table, None)),
            Err(error) if error.is_not_found() => Ok((empty(), None)),
            Err(damage @ DatasetError::Text { .. }) => Ok((empty(), Some(damage))),
            Err(error) => Err(error),
        }
    }
}

fn header() -> Vec<String> {
    let first = ["scene_name", "settings_output_img_height", "settings_output_img_width", "settings_units_info_meters_scale"];
    let mut header: Vec<String> = first.iter().map(ToString::to_string).collect();
    header.push("use_camera_physical".into());
    header.extend(CAMERA_PHYSICAL.iter().map(|name| format!("camera_physical_{name}")));
    header.extend(SETTINGS_CAMERA.iter().map(|name| format!("settings_camera_{name}")));
    header.extend((0..9).map(|k| format!("M_cam_from_uv_{}{}", k / 3, k % 3)));
    header.extend((0..16).map(|k| format!("M_proj_{}{}", k / 4, k % 4)));
    header
}

/// The cells of a scene's row that have a true value.
fn row_values(scene: &str, camera: &Camera) -> Vec<(String, String)> {
    let [width, height] = camera.size();
    let number = |name: &str, value: f64| (name.to_string(), format!("{value:?}"));
    let mut row = vec![
        ("scene_name".to_string(), scene.to_string()),
        number("settings_output_img_height", f64::from(height)),
        number("settings_output_img_width", f64::from(width)),
        number("settings_units_info_meters_scale", 1.0),
        ("use_camera_physical".to_string(), "False".to_string()),
        number("settings_camera_auto_exposure", 0.0),
        number("settings_camera_auto_white_balance", 0.0),
        number("settings_camera_fov", camera.projection.fov_x_rad(std::f64::consts::TAU)),
    ];
    let (cam_from_uv, projection) = match &camera.projection {
        Projection::Pinhole(intrinsics) => (intrinsics.cam_from_uv(), projection(intrinsics)),
        Projection::TiltedPinhole(tilted) => (tilted.cam_from_uv(), tilted_projection(tilted)),
        _ => return row,
    };
    row.push(number("settings_camera_type", 0.0));
    // Adding zero turns −0 into 0.
    row.extend((0..9).map(|k| number(&format!("M_cam_from_uv_{}{}", k / 3, k % 3), cam_from_uv.col(k % 3)[k / 3] + 0.0)));
    row.extend((0..16).map(|k| number(&format!("M_proj_{}{}", k / 4, k % 4), projection.col(k % 4)[k / 4] + 0.0)));
    row
}

/// OpenGL's frustum of the camera: takes camera space to clip space, with x to the right, y up and the image on [−1, 1]².
fn projection(intrinsics: &Intrinsics) -> DMat4 {
    let (w, h) = (f64::from(intrinsics.width), f64::from(intrinsics.height));
    let depth = -(FAR_M + NEAR_M) / (FAR_M - NEAR_M);
    let rows = [
        [2.0 * intrinsics.fx / w, -2.0 * intrinsics.skew / w, 1.0 - 2.0 * intrinsics.cx / w, 0.0],
        [0.0, 2.0 * intrinsics.fy / h, 2.0 * intrinsics.cy / h - 1.0, 0.0],
        [0.0, 0.0, depth, -2.0 * FAR_M * NEAR_M / (FAR_M - NEAR_M)],
        [0.0, 0.0, -1.0, 0.0],
    ];
    DMat4::from_cols_array_2d(&rows).transpose()
}

/// The projection matrix of a tilted image plane: depth is measured across it.
fn tilted_projection(tilted: &TiltedPinhole) -> DMat4 {
    let uv = tilted.cam_from_uv().inverse().transpose();
    let depth = (FAR_M + NEAR_M) / (FAR_M - NEAR_M);
    let rows = [
        uv.x_axis.extend(0.0),
        uv.y_axis.extend(0.0),
        (uv.z_axis * depth).extend(-2.0 * FAR_M * NEAR_M / (FAR_M - NEAR_M)),
        uv.z_axis.extend(0.0),
    ];
    DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{DMat3, DVec3};

    const OFF_CENTRE: Intrinsics = Intrinsics { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 300.0, cy: 260.0, skew: 6.0 };

    #[test]
    fn intrinsics_come_back_and_other_scenes_stay() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let centred = Intrinsics::from_fov_x(1024, 768, std::f64::consts::FRAC_PI_3);
        dataset.write_camera_parameters("room_b", &OFF_CENTRE.into()).unwrap();
        dataset.write_camera_parameters("room_a", &OFF_CENTRE.into()).unwrap();
        let before = std::fs::read_to_string(dataset.layout().camera_parameters()).unwrap();
        dataset.write_camera_parameters("room_a", &centred.into()).unwrap();
        let after = std::fs::read_to_string(dataset.layout().camera_parameters()).unwrap();
        assert_eq!(before.lines().nth(2), after.lines().nth(2));
        for (scene, expected) in [("room_a", centred), ("room_b", OFF_CENTRE)] {
            let Projection::Pinhole(found) = dataset.table_projection(scene).unwrap() else { panic!() };
            let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
            assert!(close(found.fx, expected.fx) && close(found.fy, expected.fy), "{found:?}");
            assert!(close(found.cx, expected.cx) && close(found.cy, expected.cy) && close(found.skew, expected.skew), "{found:?}");
            assert_eq!((found.width, found.height), (expected.width, expected.height));
            assert_eq!(dataset.projection_matrix(scene).unwrap(), projection(&expected));
        }
        assert!(dataset.table_projection("room_c").unwrap_err().to_string().contains("no row for the scene \"room_c\""));
        dataset.retain_camera_parameters(|scene| scene == "room_b").unwrap();
        assert_eq!(dataset.read_camera_table().unwrap().scenes().collect::<Vec<_>>(), ["room_b"]);
    }

    #[test]
    fn a_damaged_table_is_begun_anew_and_what_was_wrong_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert!(dataset.write_camera_parameters("room_b", &OFF_CENTRE.into()).unwrap().is_none());
        let path = dataset.layout().camera_parameters();
        let whole = std::fs::read_to_string(&path).unwrap();
        let damages = [String::new(), whole[..whole.len() - 20].into(), whole.replace("M_proj_00", "M_proi_00"), "\u{0}\u{1}".into()];
        for damaged in damages {
            std::fs::write(&path, &damaged).unwrap();
            dataset.retain_camera_parameters(|_| false).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), damaged);
            let told = dataset.write_camera_parameters("room_a", &OFF_CENTRE.into()).unwrap().unwrap().to_string();
            assert!(told.contains("metadata_camera_parameters.csv"), "{told}");
            assert_eq!(dataset.read_camera_table().unwrap().scenes().collect::<Vec<_>>(), ["room_a"]);
        }
    }

    #[test]
    fn projection_takes_a_point_to_its_pixel() {
        let p = DVec3::new(0.3, -0.2, -2.0);
        let at = |m: DMat4| {
            let clip = m * p.extend(1.0);
            (0.5 * (clip.x / clip.w + 1.0) * 640.0, 0.5 * (1.0 - clip.y / clip.w) * 480.0)
        };
        let (x, y) = at(projection(&OFF_CENTRE));
        let (px, py) = OFF_CENTRE.project(p);
        assert!((x - px).abs() < 1e-9 && (y - py).abs() < 1e-9);
        let tilted = TiltedPinhole::new(640, 480, DMat3::from_rotation_y(0.2) * OFF_CENTRE.cam_from_uv()).unwrap();
        let ((x, y), (px, py)) = (at(tilted_projection(&tilted)), tilted.project(p).unwrap());
        assert!((x - px).abs() < 1e-9 && (y - py).abs() < 1e-9);
        let depth_at = |z: f64| projection(&OFF_CENTRE) * DVec3::new(0.0, 0.0, -z).extend(1.0);
        assert!((depth_at(NEAR_M).z / depth_at(NEAR_M).w + 1.0).abs() < 1e-9);
        assert!((depth_at(FAR_M).z / depth_at(FAR_M).w - 1.0).abs() < 1e-9);
    }

    #[test]
    fn hypersims_own_table_has_our_columns_and_its_pinholes_are_read() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let dataset = Dataset::open(std::path::Path::new(&scenes).join("hypersim-real")).unwrap();
        assert_eq!(Table::read(&dataset.layout().camera_parameters()).unwrap().header, header());
        let Projection::Pinhole(found) = dataset.table_projection("ai_001_001").unwrap() else { panic!() };
        assert!((found.fx - 886.81).abs() < 0.01 && (found.cx - 512.0).abs() < 1e-6 && found.height == 768, "{found:?}");
        // The same point of the image by the table's two matrices.
        let Projection::TiltedPinhole(tilted) = dataset.table_projection("ai_021_002").unwrap() else { panic!() };
        let clip = dataset.projection_matrix("ai_021_002").unwrap() * (2.0 * tilted.ray(100.0, 700.0)).extend(1.0);
        let (x, y) = (512.0 * (clip.x / clip.w + 1.0), 384.0 * (1.0 - clip.y / clip.w));
        assert!((x - 100.0).hypot(y - 700.0) < 1e-6, "({x}, {y})");
    }
}
