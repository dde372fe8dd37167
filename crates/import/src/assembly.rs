//! What all importers share: reading files, pictures, units and axes, unique names, and the checks at the end.
//!
//! An importer speaks in the file's own units and axes; [`Assembly`] turns them into the world's (metres, z up).

use crate::archive::Archive;
use crate::images::{self, Use};
use crate::report::Warnings;
use crate::{Format, ImportError, ImportOptions, ImportReport, Imported, ImportedLabel, UpAxis, mesh};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Mat3, Rgb};
use enfilade_scene::{Cx, Environment, Labels, Light, MapRows, Material, Part, PartLabel, Scene, StartCamera};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Below this ratio of a placement's determinant to the product of its axes' lengths, it flattens what it places.
const SINGULAR: f64 = 1e-12;

/// Where a picture's bytes are.
pub(crate) enum Source<'a> {
    /// A file, by a path as the scene file spells it.
    File(&'a str),
    /// Inside the scene file: the place, which is also the name, and the bytes.
    Embedded(String, &'a [u8]),
}

/// A scene in the making.
pub(crate) struct Assembly<'a> {
    format: Format,
    file: PathBuf,
    options: &'a ImportOptions,
    cx: &'a dyn Cx,
    archive: Option<&'a Archive>,
    warnings: Warnings<'a>,
    inputs: Vec<PathBuf>,
    images: BTreeMap<(String, Use), Option<u32>>,
    part_names: Names,
    camera_names: Names,
    reversed: HashMap<u32, u32>,
    labels: Vec<ImportedLabel>,
    meters_per_unit: f64,
    world_from_file: DAffine3,
    scene: Scene,
}

impl<'a> Assembly<'a> {
    /// An empty scene from `file`, whose format has `up` upward unless the options say otherwise.
    pub(crate) fn new(format: Format, file: &Path, up: UpAxis, options: &'a ImportOptions, cx: &'a dyn Cx) -> Self {
        let mut assembly = Self {
            format,
            file: file.to_path_buf(),
            options,
            cx,
            archive: None,
            warnings: Warnings::new(cx),
            inputs: Vec::new(),
            images: BTreeMap::new(),
            part_names: Names::default(),
            camera_names: Names::default(),
            reversed: HashMap::new(),
            labels: Vec::new(),
            meters_per_unit: 1.0,
            world_from_file: DAffine3::IDENTITY,
            scene: Scene::default(),
        };
        assembly.set_units(1.0, up);
        assembly
    }

    /// Sets the unit and the upward axis that the file itself states, before anything is placed. The options' unit multiplies the
    /// file's, their axis replaces it.
    pub(crate) fn set_units(&mut self, file_meters_per_unit: f64, file_up: UpAxis) {
        self.state_space(file_meters_per_unit, world_from_up(file_up));
    }

    /// As [`Assembly::set_units`] for any axes: `world_from_axes` is a rotation or a reflection.
    pub(crate) fn state_space(&mut self, file_meters_per_unit: f64, world_from_axes: DMat3) {
        let axes = self.options.up_axis.map_or(world_from_axes, world_from_up);
        self.meters_per_unit = file_meters_per_unit * self.options.meters_per_unit;
        self.world_from_file = DAffine3::from_mat3(axes * self.meters_per_unit);
    }

    /// An empty scene from the file `entry` within an archive, with the same options.
    pub(crate) fn inside<'b>(&self, format: Format, up: UpAxis, archive: &'b Archive, entry: &str) -> Assembly<'b>
    where
        'a: 'b,
    {
        Assembly::new(format, &archive.file().join(entry), up, self.options, self.cx).within(archive)
    }

    /// The same for a scene file within an archive: all that it refers to is in there as well, and nowhere else.
    pub(crate) fn within(self, archive: &'a Archive) -> Self {
        Self { archive: Some(archive), inputs: vec![archive.file().to_path_buf()], ..self }
    }

    /// The scene file.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Metres per unit of the file.
    pub(crate) fn meters_per_unit(&self) -> f64 {
        self.meters_per_unit
    }

    /// Records something dropped, guessed or mended at a place in the scene file.
    pub(crate) fn warn(&mut self, place: impl AsRef<str>, message: impl Into<String>) {
        let place = format!("{}: {}", self.file.display(), place.as_ref());
        self.warnings.push(place, message.into());
    }

    /// Takes over the warnings of an import that is part of this one.
    pub(crate) fn pass_on(&mut self, warnings: Vec<enfilade_scene::Warning>) {
        warnings.into_iter().for_each(|w| self.warnings.push(w.place, w.message));
    }

    /// Tells the caller how far the import is.
    pub(crate) fn progress(&self, done: usize, total: usize) {
        self.cx.progress("import", done as u64, total as u64);
    }

    /// A [`ImportError::Malformed`] of the scene file.
    pub(crate) fn malformed(&self, place: impl Into<String>, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(&self.file, place, problem)
    }

    /// The bytes of the scene file itself.
    pub(crate) fn read_scene_file(&mut self) -> Result<Vec<u8>, ImportError> {
        let file = self.file.clone();
        self.read_input(&file, "check the path and the permission to read it")
    }

    /// The bytes of a file that the scene file refers to by `path`, with the path it was found at.
    pub(crate) fn read(&mut self, path: &str) -> Result<(PathBuf, Vec<u8>), ImportError> {
        let file = self.resolve(path);
        let remedy = format!("{} refers to it; put the file there or correct the reference", self.file.display());
        let bytes = self.read_input(&file, &remedy)?;
        Ok((file, bytes))
    }

    /// The bytes of a file that `from`, a file of the scene, refers to by `path`, with the path it was found at: in the folder of
    /// `from`, or else in that of the scene file.
    pub(crate) fn read_from(&mut self, from: &Path, path: &str) -> Result<(PathBuf, Vec<u8>), ImportError> {
        match self.beside(from, path) {
            Some(beside) => {
                let bytes = self.read_input(&beside, "check the permission to read it")?;
                Ok((beside, bytes))
            }
            None => self.read(path),
        }
    }

    /// The file in the folder of `from`, a file of the scene, that `path` means; `None` where there is none.
    pub(crate) fn beside(&self, from: &Path, path: &str) -> Option<PathBuf> {
        let folder = from.parent().unwrap_or(Path::new(""));
        [folder.join(path), folder.join(path.replace('\\', "/"))].into_iter().find(|file| file.is_file())
    }

    /// The path of a file that the scene file refers to by `path`, for messages.
    pub(crate) fn path_of(&self, path: &str) -> PathBuf {
        self.resolve(path)
    }

    /// True when there is a file where the scene file's `path` leads.
    pub(crate) fn exists(&self, path: &str) -> bool {
        self.is_file(&self.resolve(path))
    }

    fn read_input(&mut self, file: &Path, remedy: &str) -> Result<Vec<u8>, ImportError> {
        let unreadable = |source: std::io::Error| ImportError::Read { file: file.to_path_buf(), source, remedy: remedy.to_string() };
        // A device would be read without end, and a pipe would be waited for.
        if self.archive.is_none() && !std::fs::metadata(file).map_err(unreadable)?.is_file() {
            return Err(unreadable(std::io::Error::other("it is no file")));
        }
        let read = self.archive.map_or_else(|| std::fs::read(file), |archive| archive.read_path(file));
        let bytes = read.map_err(unreadable)?;
        if self.archive.is_none() && !self.inputs.iter().any(|i| i == file) {
            self.inputs.push(file.to_path_buf());
        }
        Ok(bytes)
    }

    /// The file that `path` in the scene file means: relative to its folder, with Windows separators understood.
    fn resolve(&self, path: &str) -> PathBuf {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let plain = folder.join(path);
        if self.is_file(&plain) || !path.contains('\\') { plain } else { folder.join(path.replace('\\', "/")) }
    }

    fn is_file(&self, path: &Path) -> bool {
        self.archive.map_or_else(|| path.is_file(), |archive| archive.contains_path(path))
    }

    /// The index of a picture, decoded at first use. `user` is the material or light that wants it. `None` when it is missing
    /// and the options allow that; then a plain value has to stand in.
    pub(crate) fn image(&mut self, source: &Source, usage: Use, user: &str) -> Result<Option<u32>, ImportError> {
        let key = match source {
            Source::File(path) => self.resolve(path).to_string_lossy().into_owned(),
            Source::Embedded(place, _) => place.clone(),
        };
        if let Some(&found) = self.images.get(&(key.clone(), usage)) {
            if found.is_none() {
                self.warn(user, format!("the texture {key} is missing here as well; a plain grey stands in"));
            }
            return Ok(found);
        }
        let decoded = match source {
            Source::File(path) => match self.read(path) {
                Ok((_, bytes)) => images::decode(&key, &bytes, usage),
                Err(ImportError::Read { source, .. }) => Err(format!("cannot be read ({source})")),
                Err(other) => return Err(other),
            },
            Source::Embedded(place, bytes) => images::decode(place, bytes, usage),
        };
        let index = match decoded {
            Ok(decoded) => {
                if let Some(note) = decoded.note {
                    self.warn(user, format!("texture {key}: {note}"));
                }
                Some(self.push_image(decoded.image))
            }
            Err(problem) if self.options.allow_missing_textures => {
                self.warn(user, format!("the texture {key} {problem}; a plain grey stands in, so put the file there and import again"));
                None
            }
            Err(problem) => {
                return Err(ImportError::Texture { file: self.file.clone(), user: user.to_string(), texture: key, problem });
            }
        };
        self.images.insert((key, usage), index);
        Ok(index)
    }

    /// Adds a picture made by the importer.
    pub(crate) fn push_image(&mut self, image: enfilade_scene::Image) -> u32 {
        self.scene.images.push(image);
        (self.scene.images.len() - 1) as u32
    }

    /// The index that the next picture will have.
    pub(crate) fn next_image(&self) -> u32 {
        self.scene.images.len() as u32
    }

    /// Adds a light that is already in the world's units and axes.
    pub(crate) fn push_world_light(&mut self, light: Light) {
        self.scene.lights.push(light);
    }

    /// A picture by its index.
    pub(crate) fn image_at(&self, index: u32) -> &enfilade_scene::Image {
        &self.scene.images[index as usize]
    }

    /// A mesh by its index.
    pub(crate) fn mesh_at(&self, index: u32) -> &Mesh {
        &self.scene.meshes[index as usize]
    }

    /// A material by its index.
    pub(crate) fn material_at(&self, index: u32) -> &Material {
        &self.scene.materials[index as usize]
    }

    /// Adds a material.
    pub(crate) fn push_material(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        (self.scene.materials.len() - 1) as u32
    }

    /// True when a material reads any picture.
    pub(crate) fn is_textured(&self, material: u32) -> bool {
        let mut found = false;
        self.scene.materials[material as usize].textures(|_| found = true);
        found
    }

    /// The area of a mesh under a placement.
    pub(crate) fn area(&self, mesh: u32, placement: DAffine3) -> f64 {
        let mesh = &self.scene.meshes[mesh as usize];
        let corners = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| placement.transform_point3(p.as_dvec3())));
        corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// True unless the options say which axis is up.
    pub(crate) fn has_default_axes(&self) -> bool {
        self.options.up_axis.is_none()
    }

    /// Checks and mends a mesh and adds it. `None` (and a warning) when it is empty.
    ///
    /// # Errors
    /// When an index is out of range or a position is not finite; `place` tells where the mesh is.
    pub(crate) fn push_mesh(&mut self, mut mesh: Mesh, file: &Path, place: &str) -> Result<Option<u32>, ImportError> {
        if mesh.triangles.is_empty() {
            self.warnings.push(format!("{}: {place}", file.display()), "the mesh has no triangles and was left out".into());
            return Ok(None);
        }
        for note in mesh::mend(&mut mesh) {
            self.warnings.push(format!("{}: {place}", file.display()), note);
        }
        mesh.validate().map_err(|e| ImportError::malformed(file, place, e.to_string()))?;
        self.scene.meshes.push(mesh);
        Ok(Some((self.scene.meshes.len() - 1) as u32))
    }

    /// Places a mesh in the world under a unique name made from `name`. Parts that a placement flattens are left out with a
    /// warning. A mirrored placement gets a copy of the mesh with its triangles reversed, so that fronts stay fronts.
    pub(crate) fn push_part(&mut self, name: &str, mesh: u32, material: u32, file_from_mesh: DAffine3, label: PartLabel) {
        let world_from_mesh = self.world_from_file * file_from_mesh;
        let m = world_from_mesh.matrix3;
        let determinant = m.determinant();
        let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        if !world_from_mesh.is_finite() || !determinant.is_finite() || determinant.abs() <= SINGULAR * size {
            self.warn(format!("part {name:?}"), "its placement flattens it to nothing (a scale of zero), so it was left out");
            return;
        }
        let mesh = if determinant < 0.0 { self.reversed(mesh) } else { mesh };
        let name = self.part_names.unique(name);
        if label != PartLabel::NONE {
            self.labels.push(ImportedLabel { part: self.scene.parts.len() as u32, label });
        }
        self.scene.parts.push(Part { name, mesh, material, world_from_mesh });
    }

    fn reversed(&mut self, mesh: u32) -> u32 {
        if let Some(&found) = self.reversed.get(&mesh) {
            return found;
        }
        let mut copy = self.scene.meshes[mesh as usize].clone();
        copy.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self.scene.meshes.push(copy);
        let index = (self.scene.meshes.len() - 1) as u32;
        self.reversed.insert(mesh, index);
        index
    }

    /// Adds a camera by its placement in the file (x right, y up, z backward) and horizontal field of view, under a unique name.
    pub(crate) fn push_camera(&mut self, name: &str, file_from_camera: DAffine3, fov_x_rad: f64, aspect: f64) {
        let placement = self.world_from_file * file_from_camera;
        let axes = orthonormal(placement.matrix3.y_axis, placement.matrix3.z_axis);
        let plausible = fov_x_rad > 0.0 && fov_x_rad < std::f64::consts::PI && aspect > 0.0 && aspect.is_finite();
        match axes {
            Some(world_from_camera) if plausible && placement.translation.is_finite() => {
                let name = self.camera_names.unique(name);
                let position = placement.translation;
                self.scene.cameras.push(StartCamera { name, position, world_from_camera, fov_x_rad, aspect });
            }
            _ => self.warn(format!("camera {name:?}"), "its placement or field of view makes no sense, so it was left out"),
        }
    }

    /// Adds a light given in the file's units and axes. Point and spot lights shine so that a picture looks the same whatever
    /// the unit: their intensity grows with the square of the metres per unit.
    pub(crate) fn push_light(&mut self, light: Light) {
        let metres = self.meters_per_unit as f32;
        let name = light.name().to_string();
        let place = |p: enfilade_math::Vec3| self.world_from_file.transform_point3(p.as_dvec3()).as_vec3();
        let turn = |d: enfilade_math::Vec3| self.world_from_file.transform_vector3(d.as_dvec3()).as_vec3().normalize_or_zero();
        let light = match light {
            Light::Point { name, position, intensity } => {
                Light::Point { name, position: place(position), intensity: intensity * (metres * metres) }
            }
            Light::Spot { name, position, direction, intensity, inner_rad, outer_rad, falloff } => Light::Spot {
                name,
                position: place(position),
                direction: turn(direction),
                intensity: intensity * (metres * metres),
                inner_rad,
                outer_rad,
                falloff,
            },
            Light::Profile { name, position, web_from_world: web_from_file, intensity, web } => {
                let rotation = self.world_from_file.matrix3 * (1.0 / self.meters_per_unit);
                let web_from_world = web_from_file * mat3_f32(rotation.transpose());
                Light::Profile { name, position: place(position), web_from_world, intensity: intensity * (metres * metres), web }
            }
            Light::Directional { name, direction, irradiance, angular_radius_rad } => {
                Light::Directional { name, direction: turn(direction), irradiance, angular_radius_rad }
            }
        };
        let (usable, power) = match &light {
            Light::Point { position, intensity, .. } => (position.is_finite(), *intensity),
            Light::Spot { position, direction, intensity, .. } => (position.is_finite() && direction.length() > 0.5, *intensity),
            Light::Profile { position, web_from_world, intensity, .. } => (position.is_finite() && web_from_world.is_finite(), *intensity),
            Light::Directional { direction, irradiance, .. } => (direction.length() > 0.5, *irradiance),
        };
        if usable && power.is_finite() {
            self.scene.lights.push(light);
        } else {
            self.warn(format!("light {name:?}"), "its placement or strength makes no sense, so it was left out");
        }
    }

    /// Sets an environment picture by the matrix that takes its own space (y up) to the file's axes; its scale is taken out.
    pub(crate) fn set_environment_map(&mut self, image: u32, rows: MapRows, scale: Rgb, file_from_map: DMat3, place: &str) {
        let world_from_map = self.world_from_file.matrix3 * file_from_map;
        let normalized = |v: DVec3| v.try_normalize();
        let columns = (normalized(world_from_map.x_axis), normalized(world_from_map.y_axis), normalized(world_from_map.z_axis));
        let (Some(x), Some(y), Some(z)) = columns else {
            self.warn(place, "the environment's rotation makes no sense, so the environment was left out");
            return;
        };
        let world_from_map = DMat3::from_cols(x, y, z);
        let skew = (world_from_map * world_from_map.transpose() - DMat3::IDENTITY).to_cols_array().iter().any(|v| v.abs() > 1e-4);
        if skew {
            self.warn(place, "the environment's transform is skewed; its axes were kept as they are, which distorts the picture");
        }
        let map_from_world = world_from_map.inverse();
        self.set_environment(Environment::Map { image, rows, scale, map_from_world: mat3_f32(map_from_world) }, place);
    }

    /// Sets the environment; a second one replaces the first, with a warning.
    pub(crate) fn set_environment(&mut self, environment: Environment, place: &str) {
        if self.scene.environment.replace(environment).is_some() {
            self.warn(place, "the file has several environments; the last one counts");
        }
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
        let scene = without_unused_meshes(std::mem::take(&mut self.scene));
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
            let path = environment.file.to_string_lossy().into_owned();
            // The override's path is the caller's, not the scene file's: relative to the working directory.
            let bytes = self.read_input(&environment.file, "the import options name it as the environment; correct the path")?;
            let decoded = images::decode(&path, &bytes, Use::Color)
                .map_err(|problem| ImportError::malformed(&environment.file, "environment picture", format!("it {problem}")))?;
            let image = self.push_image(decoded.image);
            let world_from_map = DMat3::from_rotation_z(f64::from(environment.rotation_deg).to_radians())
                * DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
            let scale = Rgb::splat(environment.scale);
            let map_from_world = mat3_f32(world_from_map.transpose());
            self.scene.environment = Some(Environment::Map { image, rows: MapRows::Bands, scale, map_from_world });
        }
        let file = self.file;
        self.scene.validate().map_err(|source| ImportError::Scene { file, source })?;
        let labels = (!self.labels.is_empty()).then_some(self.labels);
        let report = ImportReport::new(self.format, &self.scene, self.warnings.into_list());
        Ok(Imported { scene: self.scene, labels, inputs: self.inputs, report })
    }
}

/// The rotation that turns `up` to z.
fn world_from_up(up: UpAxis) -> DMat3 {
    match up {
        UpAxis::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
        UpAxis::Z => DMat3::IDENTITY,
    }
}

/// The matrix in single precision.
pub(crate) fn mat3_f32(m: DMat3) -> Mat3 {
    Mat3::from_cols(m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3())
}

/// Names that are taken.
#[derive(Default)]
struct Names {
    taken: HashSet<String>,
    /// The number to try next for a name that occurred before, so that many equal names are no long search.
    next: HashMap<String, usize>,
}

impl Names {
    /// `name`, or `name_2`, `name_3` … when it is taken. Control characters, which would break tables, become underscores.
    fn unique(&mut self, name: &str) -> String {
        let name: String = name.trim().chars().map(|c| if c.is_control() { '_' } else { c }).collect();
        let name = if name.is_empty() { "part".to_string() } else { name };
        if self.taken.insert(name.clone()) {
            return name;
        }
        let next = self.next.entry(name.clone()).or_insert(2);
        loop {
            let numbered = format!("{name}_{next}");
            *next += 1;
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}

/// Right-handed orthonormal axes with z along `z` and y as near to `y` as can be.
pub(crate) fn orthonormal(y: DVec3, z: DVec3) -> Option<DMat3> {
    let z = z.try_normalize()?;
    let x = y.try_normalize()?.cross(z).try_normalize()?;
    Some(DMat3::from_cols(x, z.cross(x).normalize(), z))
}

/// The scene without meshes that no part uses; the others keep their order.
fn without_unused_meshes(mut scene: Scene) -> Scene {
    let mut used = vec![false; scene.meshes.len()];
    scene.parts.iter().for_each(|p| used[p.mesh as usize] = true);
    let mut next = 0;
    let new_index: Vec<u32> = used.iter().map(|&u| (next, next += u32::from(u)).0).collect();
    scene.parts.iter_mut().for_each(|p| p.mesh = new_index[p.mesh as usize]);
    let mut keep = used.into_iter();
    scene.meshes.retain(|_| keep.next().unwrap_or(false));
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Vec3;
    use enfilade_scene::{Quiet, uv_from_direction};

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
