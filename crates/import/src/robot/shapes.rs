//! Shapes of links, with their materials: primitives, and meshes in files of their own.

use crate::assembly::{Assembly, FileLabel, Source, is_absolute};
use crate::collections::assets::{Models, unless_odd};
use crate::images::Use;
use crate::{ImportError, primitives};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, ObjectId, ScalarParam, TextureRef};
use std::collections::HashMap;
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// Reflectance of surfaces without a material.
const GREY: f32 = 0.5;
/// A mesh without materials has one of this name.
const PLAIN: &str = "default";
/// Number of folders above the file in which packages are sought.
const ABOVE: usize = 5;

/// The shape of a visual.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Box(DVec3),
    Cylinder { radius: f64, length: f64 },
    Sphere(f64),
    Capsule { radius: f64, length: f64 },
    Plane { normal: DVec3, size: [f64; 2] },
    Mesh { path: String, scale: DVec3 },
}

/// A material as its description states it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Look {
    pub name: String,
    /// In sRGB, with opacity.
    pub rgba: Option<[f64; 4]>,
    pub texture: Option<String>,
    pub emission: Option<[f64; 3]>,
}

/// Shapes and materials that were met so far.
#[derive(Default)]
pub(super) struct Shapes {
    models: Models,
    primitives: HashMap<&'static str, Option<u32>>,
    materials: Vec<(Look, u32)>,
    /// The file from which files are looked for: the scene's, or one that it includes.
    pub(super) from: PathBuf,
    /// The label of all parts, if the file's neighbours state one.
    pub(super) label: Option<FileLabel>,
}

impl Shapes {
    /// None yet, for a scene file.
    pub(super) fn of(file: &Path) -> Self {
        Self { from: file.to_path_buf(), ..Self::default() }
    }

    /// Adds a shape of an object.
    ///
    /// # Errors
    /// When its mesh or a picture is missing and has to be there.
    pub(super) fn place(
        &mut self,
        shape: &Shape,
        look: Option<&Look>,
        name: &str,
        file_from_shape: DAffine3,
        object: ObjectId,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        if let Shape::Mesh { path, scale } = shape {
            return self.mesh(path, look, name, file_from_shape * DAffine3::from_scale(*scale), object, a);
        }
        let material = self.material(look, a)?;
        for (kind, made, shape_from_mesh) in pieces(shape) {
            let mesh = match self.primitives.get(kind) {
                Some(known) => *known,
                None => {
                    let file = a.file().to_path_buf();
                    let pushed = a.push_mesh(made, &file, kind)?;
                    self.primitives.insert(kind, pushed);
                    pushed
                }
            };
            if let Some(mesh) = mesh {
                let label = self.label.unwrap_or(FileLabel::NONE);
                a.push_part_of(object, name, mesh, material, file_from_shape * shape_from_mesh, label);
            }
        }
        Ok(())
    }

    fn mesh(
        &mut self,
        path: &str,
        look: Option<&Look>,
        name: &str,
        file_from_model: DAffine3,
        object: ObjectId,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let Some(file) = find(path, &self.from, a) else {
            let absent = Err::<(), _>(ImportError::Read {
                file: path.into(),
                source: Error::new(ErrorKind::NotFound, "no such file beside the scene or in the folders above"),
                remedy: String::new(),
            });
            a.note_missing(&self.from.with_file_name(bare(path).1));
            return a.mesh_or_none(absent, path, name).map(drop);
        };
        a.report_case(path, &file);
        let model = self.models.get(&file, a);
        let Some(model) = unless_odd(model, name, "a mesh", a)?.flatten() else { return Ok(()) };
        let several = model.pieces.len() > 1;
        for piece in &model.pieces {
            let is_plain = a.material_at(piece.material).name == PLAIN;
            let material = if is_plain && look.is_some() { self.material(look, a)? } else { piece.material };
            let part = if several { format!("{name}.{}", piece.name) } else { name.to_string() };
            let label = self.label.unwrap_or_else(|| piece.label_in(object));
            a.push_part_of(object, &part, piece.mesh, material, file_from_model * piece.model_from_mesh, label);
        }
        Ok(())
    }

    fn material(&mut self, look: Option<&Look>, a: &mut Assembly) -> Result<u32, ImportError> {
        let look = look.cloned().unwrap_or_default();
        if let Some((_, known)) = self.materials.iter().find(|(known, _)| *known == look) {
            return Ok(*known);
        }
        let [r, g, b, opacity] = look.rgba.unwrap_or([f64::NAN; 4]);
        let srgb = |v: f64| linear_from_srgb(v.clamp(0.0, 1.0) as f32);
        let color = if r.is_nan() { Rgb::splat(GREY) } else { Rgb::new(srgb(r), srgb(g), srgb(b)) };
        let texture = look.texture.as_ref().map(|path| {
            let file = find(path, &self.from, a)
                .map_or_else(|| path.clone(), |file| std::path::absolute(&file).unwrap_or(file).to_string_lossy().into_owned());
            a.image(&Source::File(&file), Use::Color, &format!("material {:?}", look.name))
        });
        let texture = texture.transpose()?.flatten().map(TextureRef::new);
        let factor = if texture.is_some() && r.is_nan() { Rgb::WHITE } else { color };
        let name = if look.name.is_empty() { PLAIN } else { look.name.as_str() };
        let mut material = Material::new(name, Bsdf::Diffuse { reflectance: ColorParam { factor, texture } });
        (material.two_sided, material.emits_both_sides) = (true, true);
        if let Some([r, g, b]) = look.emission {
            material.emission = Rgb::new(srgb(r), srgb(g), srgb(b)).into();
        }
        if opacity > 0.0 && opacity < 1.0 {
            material.alpha = Alpha::Blend { opacity: ScalarParam::from(opacity as f32) };
        } else if opacity == 0.0 {
            a.warn(format!("material {name:?}"), "found an opacity of zero, which would hide the surface; one was used");
        }
        let index = a.push_material(material);
        self.materials.push((look, index));
        Ok(index)
    }
}

/// The meshes of a primitive, each with a name of its kind.
fn pieces(shape: &Shape) -> Vec<(&'static str, Mesh, DAffine3)> {
    let scaled = |x: f64, y: f64, z: f64| DAffine3::from_scale(DVec3::new(x, y, z));
    let up = |z: f64| DAffine3::from_translation(DVec3::Z * z);
    let turned = DAffine3::from_rotation_x(std::f64::consts::PI);
    match *shape {
        Shape::Box(size) => vec![("cube", primitives::cube(), DAffine3::from_scale(0.5 * size))],
        Shape::Sphere(r) => vec![("sphere", primitives::sphere(), scaled(r, r, r))],
        Shape::Cylinder { radius: r, length } => vec![
            ("cylinder", primitives::cylinder(), up(-0.5 * length) * scaled(r, r, length)),
            ("disk", primitives::disk(), up(0.5 * length) * scaled(r, r, 1.0)),
            ("disk", primitives::disk(), up(-0.5 * length) * turned * scaled(r, r, 1.0)),
        ],
        Shape::Capsule { radius: r, length } => vec![
            ("cylinder", primitives::cylinder(), up(-0.5 * length) * scaled(r, r, length)),
            ("sphere", primitives::sphere(), up(0.5 * length) * scaled(r, r, r)),
            ("sphere", primitives::sphere(), up(-0.5 * length) * scaled(r, r, r)),
        ],
        Shape::Plane { normal, size: [x, y] } => {
            let axes = crate::assembly::orthonormal(if normal.y.abs() < 0.9 * normal.length() { DVec3::Y } else { DVec3::X }, normal);
            let turn = axes.unwrap_or(DMat3::IDENTITY);
            vec![("rectangle", primitives::rectangle(), DAffine3::from_mat3(turn) * scaled(0.5 * x, 0.5 * y, 1.0))]
        }
        Shape::Mesh { .. } => Vec::new(),
    }
}

/// The file that a path or a URI of a package in the file `from` means.
pub(super) fn find(path: &str, from: &Path, a: &Assembly) -> Option<PathBuf> {
    let (package, rest) = bare(path);
    let mut candidates = Vec::new();
    if is_absolute(&rest) {
        candidates.push(PathBuf::from(&rest));
    }
    let mut folder = from.parent().map(Path::to_path_buf).unwrap_or_default();
    for _ in 0..=ABOVE {
        if package {
            // The folder of the package within this one, or this one itself, or `models/` of Gazebo.
            let (_, within) = rest.split_once('/').unwrap_or(("", &rest));
            candidates.extend([folder.join(&rest), folder.join("models").join(&rest), folder.join(within)]);
        } else {
            candidates.push(folder.join(&rest));
        }
        folder = folder.join("..");
    }
    let exact = candidates.iter().find(|file| a.is_file(file)).cloned();
    exact.or_else(|| candidates.iter().find_map(|file| a.in_other_case(file)))
}

/// A path without its scheme, and whether it begins with the name of a package.
fn bare(path: &str) -> (bool, String) {
    let plain = path.trim().replace('\\', "/");
    for scheme in ["package://", "model://", "$(find "] {
        if let Some(rest) = plain.strip_prefix(scheme) {
            return (true, rest.replacen(')', "", usize::from(scheme.starts_with('$'))));
        }
    }
    (false, plain.strip_prefix("file://").map_or_else(|| plain.clone(), str::to_string))
}
