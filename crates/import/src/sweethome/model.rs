//! The models of furniture within an archive.

use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{Format, ImportError, ImportOptions, Imported, UpAxis, obj};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_scene::{Alpha, Bsdf, Material, NormalMap, Quiet, TextureRef};

/// A model within the scene in the making; its own unit, y up.
pub(super) struct Model {
    pub parts: Vec<ModelPart>,
}

/// One mesh of a model with its material, both as indices into the scene.
pub(super) struct ModelPart {
    pub name: String,
    pub mesh: u32,
    pub material: u32,
    pub file_from_mesh: DAffine3,
}

/// Extents below this are taken for it, model units, so that flat models can be scaled.
const FLAT: f64 = 1e-4;

impl Model {
    /// The box around the model as `placed`.
    pub fn bounds(&self, placed: DAffine3, a: &Assembly) -> (DVec3, DVec3) {
        let place = |p: &ModelPart| placed * p.file_from_mesh;
        let points =
            self.parts.iter().flat_map(|p| a.mesh_at(p.mesh).positions.iter().map(move |v| place(p).transform_point3(v.as_dvec3())));
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
    }

    /// From the model to a box of side one around the origin, turned by `rotation`. Without `recenter` the turned model stays where
    /// the middle of the one that was not turned lay, as older versions of Sweet Home 3D have it.
    pub fn normalized(&self, rotation: Option<DMat3>, recenter: bool, a: &Assembly) -> DAffine3 {
        let (min, max) = self.bounds(DAffine3::IDENTITY, a);
        let centered = DAffine3::from_translation(-0.5 * (min + max));
        let Some(rotation) = rotation else { return unit_scale(max - min) * centered };
        let turned = DAffine3::from_mat3(rotation) * centered;
        let (min, max) = self.bounds(turned, a);
        let moved = if recenter { DAffine3::from_translation(-0.5 * (min + max)) } else { DAffine3::IDENTITY };
        unit_scale(max - min) * moved * turned
    }
}

fn unit_scale(size: DVec3) -> DAffine3 {
    DAffine3::from_scale(size.max(DVec3::splat(FLAT)).recip())
}

/// Reads the model that `file` names and adds its meshes, materials and pictures to the scene.
///
/// # Errors
/// Why it cannot be used, as the rest of a sentence that begins with its name.
pub(super) fn load(archive: &Archive, file: &str, a: &mut Assembly) -> Result<Model, String> {
    let imported = read(archive, file)?;
    a.pass_on(imported.report.warnings.clone());
    add(imported, a).map_err(|e| format!("cannot be used ({e})"))
}

/// Reads a model of an archive as a scene of its own, in the model's unit and axes. Pictures that are missing become grey.
///
/// # Errors
/// Why it cannot be used, as the rest of a sentence that begins with its name.
pub(super) fn read(archive: &Archive, file: &str) -> Result<Imported, String> {
    let found = archive.find(file).ok_or("is not in the archive")?.to_string();
    let bytes = archive.read(&found).map_err(|e| format!("cannot be read ({e})"))?;
    if bytes.starts_with(b"PK\x03\x04") {
        let inner = Archive::new(&archive.file().join(&found), bytes).map_err(|e| format!("is {e}"))?;
        let object = inner.names().iter().find(|n| n.to_ascii_lowercase().ends_with(".obj"));
        let object = object.ok_or("is an archive without an OBJ model; save the piece as OBJ")?.clone();
        return read_obj(&inner, &object);
    }
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(512)]).to_lowercase();
    match () {
        () if bytes.starts_with(b"MM") => Err("is in the format 3DS, which is not supported; save it as OBJ".into()),
        () if start.contains("<collada") => Err("is in the format Collada, which is not supported; save it as OBJ".into()),
        () if start.starts_with("lwsc") => Err("is in the format LWS, which is not supported; save it as OBJ".into()),
        () => read_obj(archive, &found),
    }
}

fn read_obj(archive: &Archive, name: &str) -> Result<Imported, String> {
    let options = ImportOptions { up_axis: Some(UpAxis::Z), allow_missing_textures: true, ..ImportOptions::default() };
    let assembly = Assembly::new(Format::Obj, &archive.file().join(name), UpAxis::Z, &options, &Quiet).within(archive);
    obj::load_java3d(assembly).map_err(|e| format!("cannot be used ({e})"))
}

fn add(imported: Imported, a: &mut Assembly) -> Result<Model, ImportError> {
    let scene = imported.scene;
    let first_image = a.next_image();
    for image in scene.images {
        a.push_image(image);
    }
    let moved = |mut m: Material| {
        each_texture(&mut m, &mut |t| t.image += first_image);
        m
    };
    let materials: Vec<u32> = scene.materials.into_iter().map(|m| a.push_material(moved(m))).collect();
    let file = a.file().to_path_buf();
    let mut meshes = Vec::new();
    for mesh in scene.meshes {
        meshes.push(a.push_mesh(mesh, &file, "model")?);
    }
    let part = |p: enfilade_scene::Part| {
        let (mesh, material) = (meshes[p.mesh as usize]?, materials[p.material as usize]);
        Some(ModelPart { name: p.name, mesh, material, file_from_mesh: p.world_from_mesh })
    };
    Ok(Model { parts: scene.parts.into_iter().filter_map(part).collect() })
}

/// A grey box of side one, in place of a model that cannot be used.
pub(super) fn cuboid(a: &mut Assembly) -> Result<Model, ImportError> {
    let at = |k: u32, bit: u32| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
    let positions = (0..8).map(|k| Vec3::new(at(k, 0), at(k, 1), at(k, 2))).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[p, q, r, s]| [[p, q, r], [p, r, s]]).collect();
    let file = a.file().to_path_buf();
    let material = a.push_material(Material::diffuse("stand_in", Rgb::splat(0.5)));
    let mesh = a.push_mesh(Mesh { positions, triangles, ..Mesh::default() }, &file, "stand-in")?;
    let part = |mesh| ModelPart { name: "box".into(), mesh, material, file_from_mesh: DAffine3::IDENTITY };
    Ok(Model { parts: mesh.map(part).into_iter().collect() })
}

/// Calls `found` with every texture that a material of an OBJ model may have.
fn each_texture(material: &mut Material, found: &mut dyn FnMut(&mut TextureRef)) {
    of_bsdf(&mut material.bsdf, found);
    material.emission.texture.iter_mut().for_each(&mut *found);
    if let Alpha::Mask { opacity, .. } | Alpha::Blend { opacity } = &mut material.alpha {
        opacity.texture.iter_mut().for_each(|(t, _)| found(t));
    }
    if let Some(NormalMap::Normal { texture, .. } | NormalMap::Bump { texture, .. }) = &mut material.normal_map {
        found(texture);
    }
}

fn of_bsdf(bsdf: &mut Bsdf, found: &mut dyn FnMut(&mut TextureRef)) {
    let (colors, scalars) = match bsdf {
        Bsdf::Diffuse { reflectance } => (vec![reflectance], vec![]),
        Bsdf::RoughDiffuse { reflectance, roughness } => (vec![reflectance], vec![roughness]),
        Bsdf::Conductor { reflectance, alpha, .. } => (vec![reflectance], vec![alpha]),
        Bsdf::Dielectric { transmittance, alpha, .. } => (vec![transmittance], vec![alpha]),
        Bsdf::ThinDielectric { transmittance, .. } => (vec![transmittance], vec![]),
        Bsdf::Plastic { diffuse, specular, alpha, .. } => (vec![diffuse, specular], vec![alpha]),
        Bsdf::Blend { first, second, weight } => {
            of_bsdf(first, found);
            of_bsdf(second, found);
            (vec![], vec![weight])
        }
        Bsdf::Principled(p) => (
            vec![&mut p.base_color, &mut p.specular_color, &mut p.sheen_color],
            vec![
                &mut p.metallic,
                &mut p.roughness,
                &mut p.specular,
                &mut p.transmission,
                &mut p.clearcoat,
                &mut p.clearcoat_roughness,
                &mut p.sheen_roughness,
            ],
        ),
    };
    colors.into_iter().flat_map(|c| c.texture.as_mut()).for_each(&mut *found);
    scalars.into_iter().flat_map(|s| s.texture.as_mut()).for_each(|(t, _)| found(t));
}
