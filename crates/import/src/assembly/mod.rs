//! The common base of all importers: reading files, pictures, units and axes, unique names, and the checks at the end.
//!
//! An importer speaks in the file's own units and axes; [`Assembly`] turns them into the world's (metres, z up).

mod adopt;
mod bodies;
mod contents;
mod elsewhere;
mod files;
mod find;
mod flat;
mod labels;
mod light;
mod names;
mod numbered;
mod survey;

pub(crate) use adopt::Piece;
pub(crate) use bodies::{Contents, STRETCHED, TimedPoses, TimedShapes};
pub(crate) use contents::orthonormal;
pub(crate) use files::Source;
pub(crate) use find::is_absolute;
pub(crate) use labels::{FileLabel, class_named};
pub(crate) use survey::{FAR_M, origin_of, positions_from};

use crate::archive::Archive;
use crate::images::{self, Use};
use crate::others::Others;
use crate::report::Warnings;
use crate::{EnvironmentOverride, Format, ImportError, ImportOptions, ImportReport, Imported, ImportedLabel, UpAxis, UpStated};
use enfilade_math::{DAffine3, DMat3, DVec3, Mat3};
use enfilade_scene::{Cx, Labels, PartId, PartLabel, PictureFiles, Scene, SceneError, Warning};
use names::Names;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// Warnings that the error of an empty scene repeats.
const NAMED: usize = 3;

/// A scene being built.
pub(crate) struct Assembly<'a> {
    format: Format,
    file: PathBuf,
    /// Folders in which files are sought before the folder of the scene file, the last one first.
    folders: Vec<PathBuf>,
    options: &'a ImportOptions,
    cx: &'a dyn Cx,
    archive: Option<&'a Archive>,
    others: Option<Others>,
    warnings: Warnings<'a>,
    inputs: Vec<PathBuf>,
    missing: Vec<PathBuf>,
    images: BTreeMap<(String, Use), Option<u32>>,
    picture_files: PictureFiles,
    part_names: Names,
    /// Depth of each object of the scene: 1 for objects without a parent.
    object_depths: Vec<u8>,
    camera_names: Names,
    reversed: HashMap<u32, u32>,
    /// The points from which the positions of meshes count.
    origins: HashMap<u32, DVec3>,
    /// Positions of the scene's lights in the world, in double precision.
    light_positions: Vec<DVec3>,
    /// The offset that was subtracted from the world's positions.
    offset_m: Option<[f64; 3]>,
    /// Triangles kept of flattened parts.
    flattened: usize,
    /// Labels of the parts that the file labels, in their order.
    file_labels: Vec<(PartId, FileLabel)>,
    labels: Vec<ImportedLabel>,
    meters_per_unit: f64,
    axes: DMat3,
    up: UpStated,
    world_from_file: DAffine3,
    scene: Scene,
}

impl<'a> Assembly<'a> {
    /// An empty scene from `file`, whose format has `up` upward unless the options override it.
    pub(crate) fn new(format: Format, file: &Path, up: UpAxis, options: &'a ImportOptions, cx: &'a dyn Cx) -> Self {
        let mut assembly = Self {
            format,
            file: file.to_path_buf(),
            folders: Vec::new(),
            options,
            cx,
            archive: None,
            others: None,
            warnings: Warnings::new(cx),
            inputs: Vec::new(),
            missing: Vec::new(),
            images: BTreeMap::new(),
            picture_files: PictureFiles::new(),
            part_names: Names::default(),
            object_depths: Vec::new(),
            camera_names: Names::default(),
            reversed: HashMap::new(),
            origins: HashMap::new(),
            light_positions: Vec::new(),
            offset_m: None,
            flattened: 0,
            file_labels: Vec::new(),
            labels: Vec::new(),
            meters_per_unit: 1.0,
            axes: DMat3::IDENTITY,
            up: if options.up_axis.is_some() { UpStated::ByFile } else { format.up_stated() },
            world_from_file: DAffine3::IDENTITY,
            scene: Scene::default(),
        };
        assembly.set_units(1.0, up);
        assembly
    }

    /// Sets the unit and the upward axis that the file itself states, before anything is placed. The options' unit multiplies the
    /// file's, their axis replaces it.
    pub(crate) fn set_units(&mut self, file_meters_per_unit: f64, file_up: UpAxis) {
        self.state_space(file_meters_per_unit, file_up.world_from_file());
    }

    /// States unit and axes as [`Assembly::set_units`] does, for any axes: `world_from_axes` is a rotation or a reflection.
    pub(crate) fn state_space(&mut self, file_meters_per_unit: f64, world_from_axes: DMat3) {
        self.axes = self.options.up_axis.map_or(world_from_axes, UpAxis::world_from_file);
        self.meters_per_unit = file_meters_per_unit * self.options.meters_per_unit;
        self.world_from_file = DAffine3::from_mat3(self.axes * self.meters_per_unit);
    }

    /// States that the file leaves out which way is up, so that the rules of its format decide.
    pub(crate) fn leaves_up_to_rules(&mut self) {
        if self.options.up_axis.is_none() {
            self.up = UpStated::ByRule;
        }
    }

    /// An empty scene from the file `entry` within an archive, with the same options.
    pub(crate) fn inside<'b>(&self, format: Format, up: UpAxis, archive: &'b Archive, entry: &str) -> Assembly<'b>
    where
        'a: 'b,
    {
        Assembly::new(format, &archive.file().join(entry), up, self.options, self.cx).within(archive)
    }

    /// An assembly for a scene file within an archive: all that it refers to is in there as well, and nowhere else.
    pub(crate) fn within(self, archive: &'a Archive) -> Self {
        Self { archive: Some(archive), inputs: vec![archive.file().to_path_buf()], ..self }
    }

    /// The archive that the scene is in.
    pub(crate) fn archive(&self) -> Option<&Archive> {
        self.archive
    }

    /// The scene file.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Metres per unit of the file.
    pub(crate) fn meters_per_unit(&self) -> f64 {
        self.meters_per_unit
    }

    /// Records something dropped, guessed or fixed at a place in the scene file.
    pub(crate) fn warn(&mut self, place: impl AsRef<str>, message: impl Into<String>) {
        let place = format!("{}: {}", self.file.display(), place.as_ref());
        self.warnings.push(place, message.into());
    }

    /// Sets the files of which those that the scene was not made of are reported at the end.
    pub(crate) fn chosen_among(&mut self, others: Others) {
        self.others = Some(others);
    }

    /// Takes over the warnings of an import that is part of this one.
    pub(crate) fn pass_on(&mut self, warnings: Vec<enfilade_scene::Warning>) {
        warnings.into_iter().for_each(|w| self.warnings.push(w.place, w.message));
    }

    /// Reports the progress of the import to the caller.
    pub(crate) fn progress(&self, done: usize, total: usize) {
        self.cx.progress("import", done as u64, total as u64);
    }

    /// A [`ImportError::Malformed`] of the scene file.
    pub(crate) fn malformed(&self, place: impl Into<String>, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(&self.file, place, problem)
    }

    /// The user's options.
    pub(crate) fn options(&self) -> &ImportOptions {
        self.options
    }

    /// True where a missing picture is replaced by grey.
    pub(crate) fn allows_missing_textures(&self) -> bool {
        self.options.allow_missing_textures
    }

    /// Records a file that was looked for and not found: with it the scene would be a different one.
    pub(crate) fn note_missing(&mut self, file: &Path) {
        if !self.missing.iter().any(|known| known == file) {
            self.missing.push(file.to_path_buf());
        }
    }

    /// Records files that were read for the scene elsewhere.
    pub(crate) fn note_inputs(&mut self, files: &[PathBuf]) {
        self.inputs.extend(files.iter().filter(|file| !self.inputs.contains(file)).cloned().collect::<Vec<_>>());
    }

    /// The rotation (and scale) from file axes to world axes.
    pub(crate) fn world_from_file(&self) -> DAffine3 {
        self.world_from_file
    }

    /// The finished import.
    ///
    /// # Errors
    /// When nothing visible remains or something about the scene is not valid.
    pub(crate) fn finish(mut self) -> Result<Imported, ImportError> {
        self.bring_near();
        self.labels = self.numbered_labels();
        let mut scene = std::mem::take(&mut self.scene);
        scene.remove_unused_meshes();
        scene.remove_unused_objects();
        self.finish_scene(scene)
    }

    /// The labels of a scene that has them all, one per part.
    pub(crate) fn set_labels(&mut self, labels: Option<Labels>) {
        let labels = labels.map_or(Vec::new(), |labels| labels.parts);
        let labelled = labels.into_iter().enumerate().filter(|(_, label)| *label != PartLabel::NONE);
        self.labels = labelled.map(|(part, label)| ImportedLabel { part: part as u32, label }).collect();
    }

    /// The finished import of a scene that is already in the world's units and axes.
    pub(crate) fn finish_scene(mut self, scene: Scene) -> Result<Imported, ImportError> {
        self.scene = scene;
        if let Some(environment) = &self.options.environment {
            self.replace_environment(environment)?;
        }
        self.tell_others();
        let file = self.file;
        let warnings = self.warnings.into_list();
        self.scene.validate().map_err(|source| ImportError::Scene { file, told: told_of_nothing(&source, &warnings), source })?;
        let labels = (!self.labels.is_empty()).then_some(self.labels);
        let report = ImportReport { offset_m: self.offset_m, ..ImportReport::new(self.format, &self.scene, warnings) };
        let (picture_files, axes, up) = (self.picture_files, self.axes, self.up);
        Ok(Imported { scene: self.scene, labels, picture_files, inputs: self.inputs, missing: self.missing, axes, up, report })
    }

    /// Reports those files of the choice that the scene was not made of.
    fn tell_others(&mut self) {
        let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let Some(others) = &self.others else { return };
        let inputs: Vec<PathBuf> = self.inputs.iter().map(|path| whole(path)).collect();
        let was_read = |path: &Path| self.archive.map_or_else(|| inputs.contains(&whole(path)), |archive| archive.was_read(path));
        if let Some((place, remark)) = others.remark(was_read) {
            self.warn(place, remark);
        }
    }

    /// Puts the surroundings of the options in place of the file's own.
    fn replace_environment(&mut self, environment: &EnvironmentOverride) -> Result<(), ImportError> {
        environment.light(&mut self.scene);
        if let Some(file) = environment.file() {
            // The path is the caller's, not the scene file's: relative to the working directory.
            let bytes = self.read_input(file, "the import options name it as the environment; correct the path")?;
            let decoded = images::decode(&self.picture_name(file), &bytes, Use::Color)
                .map_err(|problem| ImportError::malformed(file, "environment picture", format!("it {problem}")))?;
            let image = self.push_image(decoded.image);
            self.scene.environment = Some(environment.of_picture(image));
        }
        Ok(())
    }
}

/// The matrix in single precision.
pub(crate) fn mat3_f32(m: DMat3) -> Mat3 {
    Mat3::from_cols(m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3())
}

/// What was reported of a scene of which nothing is left, as a sentence; empty for other faults.
fn told_of_nothing(source: &SceneError, warnings: &[Warning]) -> String {
    if *source != SceneError::NoParts || warnings.is_empty() {
        return String::new();
    }
    let told = warnings.iter().take(NAMED).map(|warning| format!("{}: {}", warning.place, warning.message)).collect::<Vec<_>>();
    let more = if warnings.len() > NAMED { "; …" } else { "" };
    format!(". What was left out: {}{more}", told.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{Rgb, Vec3};
    use enfilade_scene::{Environment, Light, MapRows, Material, Quiet, uv_from_direction};

    fn triangle() -> Mesh {
        Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }
    }

    fn assembled(options: &ImportOptions, fill: impl FnOnce(&mut Assembly)) -> Imported {
        let mut a = Assembly::new(Format::Gltf, Path::new("test.gltf"), UpAxis::Y, options, &Quiet);
        a.push_material(Material::diffuse("grey", Rgb::splat(0.5)));
        let mesh = a.push_mesh(triangle(), Path::new("test.gltf"), "mesh").unwrap().unwrap();
        a.push_part("part", mesh, 0, DAffine3::IDENTITY, PartLabel::NONE);
        fill(&mut a);
        a.finish().unwrap()
    }

    #[test]
    fn y_up_becomes_z_up_and_units_become_metres() {
        let options = ImportOptions { meters_per_unit: 0.5, ..ImportOptions::default() };
        let scene = assembled(&options, |_| ()).scene;
        let p = scene.parts[0].world_from_mesh.transform_point3(DVec3::new(2.0, 4.0, 6.0));
        assert_eq!(p, DVec3::new(1.0, -3.0, 2.0));
    }

    #[test]
    fn files_beside_included_ones_are_spelled_from_the_scene_on() {
        let options = ImportOptions::default();
        for (scene, file, expected) in [
            ("hall/a.vrscene", "hall/../shared/wood.png", "../shared/wood.png"),
            ("a.vrscene", "parts/wood.png", "parts/wood.png"),
            ("hall/a.vrscene", "/elsewhere/wood.png", "/elsewhere/wood.png"),
        ] {
            let a = Assembly::new(Format::VRay, Path::new(scene), UpAxis::Z, &options, &Quiet);
            assert_eq!(a.spelled(Path::new(file)), expected, "{file} of {scene}");
        }
    }

    #[test]
    fn pictures_are_called_by_their_paths_from_the_scene_or_by_their_names() {
        let options = ImportOptions::default();
        for (scene, file, expected) in [
            ("/rooms/hall/a.gltf", "/rooms/hall/./tex/wood.png", "tex/wood.png"),
            ("/rooms/hall/a.gltf", "/rooms/hall/../wood.png", "../wood.png"),
            ("/rooms/hall/a.gltf", "/elsewhere/wood.png", "wood.png"),
            ("a.gltf", "tex/wood.png", "tex/wood.png"),
            ("a.gltf", "/elsewhere/wood.png", "wood.png"),
        ] {
            let a = Assembly::new(Format::Gltf, Path::new(scene), UpAxis::Y, &options, &Quiet);
            assert_eq!(a.picture_name(Path::new(file)), expected, "{file} of {scene}");
        }
    }

    #[test]
    fn irradiance_of_a_point_light_does_not_depend_on_the_unit() {
        let light = || Light::Point { name: "l".into(), position: Vec3::new(0.0, 2.0, 0.0), intensity: Rgb::splat(8.0) };
        let irradiance = |meters_per_unit: f64| {
            let options = ImportOptions { meters_per_unit, ..ImportOptions::default() };
            let scene = assembled(&options, |a| a.push_light(light())).scene;
            let Light::Point { position, intensity, .. } = &scene.lights[0] else { panic!("not a point light") };
            intensity.g / position.length_squared()
        };
        assert!((irradiance(1.0) - 2.0).abs() < 1e-6 && (irradiance(0.4) - 2.0).abs() < 1e-5);
    }

    #[test]
    fn mirrored_parts_keep_their_front_and_flattened_ones_go() {
        let imported = assembled(&ImportOptions::default(), |a| {
            a.push_part("part", 0, 0, DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)), PartLabel::NONE);
            a.push_part("part", 0, 0, DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)), PartLabel::NONE);
        });
        let scene = imported.scene;
        assert_eq!(scene.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["part", "part_2"]);
        let normal = |i: usize| {
            let [a, b, c] = scene.world_corners(&scene.parts[i], 0);
            (b - a).cross(c - a).normalize()
        };
        assert!((normal(0) - normal(1)).length() < 1e-6);
        assert!(imported.report.warnings[0].message.contains("flattens"));
    }

    #[test]
    fn sheets_flattened_along_their_normal_stay() {
        let flat = DAffine3::from_scale_rotation_translation(DVec3::new(2.0, 2.0, 0.0), enfilade_math::DQuat::IDENTITY, DVec3::Y);
        let imported = assembled(&ImportOptions::default(), |a| a.push_part("sheet", 0, 0, flat, PartLabel::NONE));
        let scene = imported.scene;
        assert_eq!(scene.world_corners(&scene.parts[1], 0), [Vec3::Z, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 3.0)]);
        assert!(imported.report.warnings[0].message.contains("the faces that have an area then were kept"));
    }

    #[test]
    fn cameras_are_orthonormal_after_scaled_and_rounded_placements() {
        let tilt = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7) * 3.0;
        let rounded = DMat3::from_cols_array(&tilt.to_cols_array().map(|v| f64::from(v as f32)));
        let options = ImportOptions { meters_per_unit: 0.4, ..ImportOptions::default() };
        let scene = assembled(&options, |a| {
            a.push_camera("c", DAffine3::from_mat3_translation(rounded, DVec3::X), 1.0, 1.5);
            a.push_camera("bad", DAffine3::from_mat3(DMat3::ZERO), 1.0, 1.5);
        })
        .scene;
        assert_eq!(scene.cameras.len(), 1);
        assert_eq!(scene.cameras[0].position, DVec3::new(0.4, 0.0, 0.0));
    }

    #[test]
    fn the_middle_of_an_environment_stays_where_the_file_puts_it() {
        let scene = assembled(&ImportOptions::default(), |a| {
            let white = enfilade_scene::Pixels::RgbF32(vec![[1.0; 3]]);
            let image = a.push_image(enfilade_scene::Image { name: "sky".into(), width: 1, height: 1, pixels: white });
            a.set_environment_map(image, MapRows::Bands, Rgb::WHITE, DMat3::IDENTITY, "sky");
        })
        .scene;
        let Some(Environment::Map { map_from_world, .. }) = scene.environment else { panic!("no map") };
        // +z of the file, the middle of the picture, is −y of the world; up stays up.
        assert!((uv_from_direction(map_from_world * Vec3::NEG_Y).x - 0.5).abs() < 1e-6);
        assert!(uv_from_direction(map_from_world * Vec3::Z).y < 1e-3);
    }
}
