//! A scene: meshes, the parts that place them, materials, pictures, lights and cameras as plain data, with the check that it is whole.

use crate::material::Constant;
use crate::{Alpha, Body, Environment, Image, Light, Material, NormalMap, Object, ObjectId, Parameter, Pixels, StartCamera};
use enfilade_geometry::{Bvh, Mesh, MeshError};
use enfilade_math::{DAffine3, DMat3, Vec3, place};
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Index into [`Scene::parts`]. A part's render entity id in the images is this plus one.
pub type PartId = u32;

/// A visible thing with one mesh and one material: the unit that is labelled and that `render_entity_id` distinguishes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Unique within the scene.
    pub name: String,
    /// The object it is a part of; `None` if it is a thing by itself.
    pub object: Option<ObjectId>,
    /// Index into `Scene::meshes`; several parts may share one.
    pub mesh: u32,
    /// Index into `Scene::materials`.
    pub material: u32,
    /// Places the mesh in the world. Triangles are counter-clockwise seen from outside once placed, so a placement that mirrors is used
    /// with a mesh of opposite winding.
    pub world_from_mesh: DAffine3,
}

/// A scene. Every one that an importer or generator returns passes [`Scene::validate`].
///
/// A floor of one metre by one, in code:
///
/// ```
/// use enfilade_geometry::Mesh;
/// use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
/// use enfilade_scene::{Material, Part, Scene};
///
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
/// let mut scene = Scene {
///     meshes: vec![Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }.into()],
///     materials: vec![Material::diffuse("oak", Rgb::new(0.5, 0.3, 0.2))],
///     parts: vec![Part { name: "floor".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
///     ..Scene::default()
/// };
/// assert_eq!(scene.validate(), Ok(()));
///
/// // A second part may share the mesh; what it refers to must exist.
/// let world_from_mesh = DAffine3::from_translation(DVec3::Z * 2.5);
/// scene.parts.push(Part { name: "ceiling".into(), object: None, mesh: 0, material: 1, world_from_mesh });
/// assert_eq!(scene.validate().unwrap_err().to_string(), "part \"ceiling\" refers to material 1, but there are only 1");
/// assert_eq!(scene.world_corners(&scene.parts[1], 0)[1], Vec3::new(1.0, 0.0, 2.5));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Triangle meshes. Scenes made from another by edits share those that are the same.
    pub meshes: Vec<Arc<Mesh>>,
    /// Everything visible.
    pub parts: Vec<Part>,
    /// The objects that the parts belong to, and their parents; a parent comes before its children.
    pub objects: Vec<Object>,
    /// Surfaces.
    pub materials: Vec<Material>,
    /// Decoded pictures of all textures and of the environment, shared like the meshes.
    #[serde(with = "crate::pictures")]
    pub images: Vec<Arc<Image>>,
    /// Lights without a surface.
    pub lights: Vec<Light>,
    /// Light from the surroundings.
    pub environment: Option<Environment>,
    /// Cameras of the file.
    pub cameras: Vec<StartCamera>,
    /// What moves, and how; a body comes after the one that bears it. Packages have them apart from the rest.
    #[serde(skip)]
    pub bodies: Vec<Body>,
}

/// Why a scene is not valid: which of its things, and what is wrong with it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// No parts.
    #[error("the scene has no visible parts; check that the file holds meshes and that they are not hidden")]
    NoParts,
    /// More triangles than a ray-tracing hierarchy has room for.
    #[error(
        "the scene has {found} triangles, those of meshes in several places counted each time, but only {limit} can be rendered; \
         leave out or simplify its finest meshes",
        limit = Bvh::MAX_TRIANGLES
    )]
    TooManyTriangles {
        /// Number of triangles in the world.
        found: usize,
    },
    /// A mesh that cannot be used.
    #[error("mesh of part {part:?}: {error}")]
    Mesh {
        /// The first part that uses the mesh.
        part: String,
        /// The problem.
        error: MeshError,
    },
    /// An index to nothing.
    #[error("{what} refers to {kind} {index}, but there are only {count}")]
    Dangling {
        /// The owner of the index.
        what: String,
        /// "mesh", "material", "object", "image", "part", "light", "camera" or "the body".
        kind: &'static str,
        /// The index.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// Two parts of one name.
    #[error("two parts are named {0:?}; names must be unique because labels are joined by name")]
    DuplicateName(String),
    /// A number out of its domain.
    #[error("{what}: {problem}")]
    Value {
        /// The owner of the number.
        what: String,
        /// The value found and what was expected.
        problem: String,
    },
}

impl Scene {
    /// Checks that every index points at something, every number is finite, part names are unique, and that the triangles are not too many.
    ///
    /// # Errors
    /// The first problem found, with the name of the thing concerned.
    pub fn validate(&self) -> Result<(), SceneError> {
        if self.parts.is_empty() {
            return Err(SceneError::NoParts);
        }
        self.validate_after(&Self::default())
    }

    /// Checks as [`Scene::validate`] does, except that a scene may be empty; meshes and pictures shared with `earlier`, which is valid, are
    /// not looked at again.
    pub(crate) fn validate_after(&self, earlier: &Self) -> Result<(), SceneError> {
        let mut user_of_mesh = HashMap::new();
        let mut names = HashMap::new();
        for part in &self.parts {
            let what = || format!("part {:?}", part.name);
            check_index(what, "mesh", part.mesh, self.meshes.len())?;
            check_index(what, "material", part.material, self.materials.len())?;
            part.object.map_or(Ok(()), |object| check_index(what, "object", object, self.objects.len()))?;
            let m = part.world_from_mesh;
            if !m.is_finite() || m.matrix3.determinant() == 0.0 {
                return Err(SceneError::Value { what: what(), problem: format!("its placement cannot be inverted: {m:?}") });
            }
            if names.insert(part.name.as_str(), ()).is_some() {
                return Err(SceneError::DuplicateName(part.name.clone()));
            }
            user_of_mesh.entry(part.mesh).or_insert(part.name.as_str());
        }
        for (i, object) in self.objects.iter().enumerate() {
            object.parent.map_or(Ok(()), |parent| check_index(|| format!("object {:?}", object.name), "object", parent, i))?;
        }
        let found = self.parts.iter().map(|part| self.meshes[part.mesh as usize].triangles.len()).sum();
        if found > Bvh::MAX_TRIANGLES {
            return Err(SceneError::TooManyTriangles { found });
        }
        let checked: HashSet<*const Mesh> = earlier.meshes.iter().map(Arc::as_ptr).collect();
        user_of_mesh.retain(|mesh, _| !checked.contains(&Arc::as_ptr(&self.meshes[*mesh as usize])));
        for (&mesh, part) in &user_of_mesh {
            self.meshes[mesh as usize].validate().map_err(|error| SceneError::Mesh { part: (*part).to_string(), error })?;
        }
        for material in &self.materials {
            self.validate_material(material)?;
        }
        let checked: HashSet<*const Image> = earlier.images.iter().map(Arc::as_ptr).collect();
        for image in self.images.iter().filter(|image| !checked.contains(&Arc::as_ptr(image))) {
            let texels = match &image.pixels {
                Pixels::Rgba8 { texels, .. } => texels.len(),
                Pixels::RgbF32(texels) => texels.len(),
            };
            if texels == 0 || texels as u64 != u64::from(image.width) * u64::from(image.height) {
                let problem = format!("{texels} texels for {}x{} pixels", image.width, image.height);
                return Err(SceneError::Value { what: format!("image {:?}", image.name), problem });
            }
        }
        for light in &self.lights {
            check_finite(|| format!("light {:?}", light.name()), light.is_finite())?;
        }
        if let Some(environment) = &self.environment {
            let what = || "the environment".to_string();
            check_finite(what, environment.is_finite())?;
            if let Environment::Map { image, map_from_world, .. } = environment {
                check_index(what, "image", *image, self.images.len())?;
                if off_orthonormal(map_from_world.as_dmat3()) > 1e-4 {
                    let problem = format!("map_from_world must turn or mirror and nothing else, found {map_from_world:?}");
                    return Err(SceneError::Value { what: what(), problem });
                }
            }
        }
        for camera in &self.cameras {
            let r = camera.world_from_camera;
            let error = off_orthonormal(r);
            if !camera.position.is_finite() || error.is_nan() || error > 1e-9 || r.determinant() < 0.0 {
                let problem = format!("its axes must be orthonormal and right-handed, found {r:?} at {}", camera.position);
                return Err(SceneError::Value { what: format!("camera {:?}", camera.name), problem });
            }
        }
        self.validate_bodies()
    }

    fn validate_material(&self, material: &Material) -> Result<(), SceneError> {
        let what = || format!("material {:?}", material.name);
        let mut finite = material.emission.factor.is_finite();
        material.bsdf.parameters(&mut |parameter| {
            finite &= match parameter {
                Parameter::Color(p) => p.factor.is_finite(),
                Parameter::Scalar(p) => p.factor.is_finite(),
            };
        });
        let mut no_index = None;
        material.bsdf.constants(&mut |constant| match constant {
            Constant::Color(color) => finite &= color.is_finite(),
            Constant::Index(index) => {
                finite &= index.is_finite();
                no_index = no_index.or((index <= 0.0).then_some(index));
            }
        });
        match &material.alpha {
            Alpha::Opaque => {}
            Alpha::Mask { opacity, cutoff } => finite &= opacity.factor.is_finite() && cutoff.is_finite(),
            Alpha::Blend { opacity } => finite &= opacity.factor.is_finite(),
        }
        if let Some(NormalMap::Normal { scale, .. } | NormalMap::Bump { scale, .. }) = &material.normal_map {
            finite &= scale.is_finite();
        }
        material.textures(|t| finite &= t.uv_transform.iter().flatten().all(|v| v.is_finite()));
        check_finite(what, finite)?;
        if let Some(index) = no_index {
            let problem = format!("an index of refraction is {index}, expected more than 0");
            return Err(SceneError::Value { what: what(), problem });
        }
        let mut dangling = Ok(());
        material.textures(|t| {
            if dangling.is_ok() {
                dangling = check_index(what, "image", t.image, self.images.len());
            }
        });
        dangling
    }

    /// Removes the meshes that no part uses; the others keep their order.
    pub fn remove_unused_meshes(&mut self) {
        let mut used = vec![false; self.meshes.len()];
        self.parts.iter().for_each(|p| used[p.mesh as usize] = true);
        let mut next = 0;
        let new_index: Vec<u32> = used.iter().map(|&u| (next, next += u32::from(u)).0).collect();
        self.parts.iter_mut().for_each(|p| p.mesh = new_index[p.mesh as usize]);
        let mut keep = used.into_iter();
        self.meshes.retain(|_| keep.next().unwrap_or(false));
    }

    /// World positions of the vertices of `part`.
    pub fn world_positions<'a>(&'a self, part: &'a Part) -> impl Iterator<Item = Vec3> + 'a {
        self.meshes[part.mesh as usize].positions.iter().map(|&p| place(&part.world_from_mesh, p))
    }

    /// World positions of the corners of triangle `triangle` of `part`.
    pub fn world_corners(&self, part: &Part, triangle: usize) -> [Vec3; 3] {
        let mesh = &self.meshes[part.mesh as usize];
        mesh.corners(triangle).map(|p| place(&part.world_from_mesh, p))
    }
}

/// The largest difference of m·mᵀ from the identity; NaN when any is.
fn off_orthonormal(m: DMat3) -> f64 {
    let differences = (m * m.transpose() - DMat3::IDENTITY).to_cols_array();
    differences.into_iter().map(f64::abs).max_by(f64::total_cmp).unwrap_or(0.0)
}

fn check_finite(what: impl Fn() -> String, finite: bool) -> Result<(), SceneError> {
    if finite { Ok(()) } else { Err(SceneError::Value { what: what(), problem: "a colour or number is not finite".into() }) }
}

fn check_index(what: impl Fn() -> String, kind: &'static str, index: u32, count: usize) -> Result<(), SceneError> {
    if (index as usize) < count { Ok(()) } else { Err(SceneError::Dangling { what: what(), kind, index, count }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bsdf, ScalarParam, TextureRef};
    use enfilade_math::{Mat3, Rgb};

    fn one_triangle(material: Material) -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let part = Part { name: "a".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        Scene { meshes: vec![mesh.into()], parts: vec![part], materials: vec![material], ..Scene::default() }
    }

    fn glass(eta: f32, absorption: Rgb) -> Bsdf {
        Bsdf::Dielectric { eta, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption }
    }

    #[test]
    fn materials_whose_numbers_are_not_finite_are_refused_by_name() {
        let refused = |material: Material| one_triangle(material).validate().unwrap_err().to_string();
        let of = |bsdf: Bsdf| Material::new("m", bsdf);
        assert_eq!(one_triangle(of(glass(1.5, Rgb::BLACK))).validate(), Ok(()));
        let inside =
            Bsdf::Blend { first: Box::new(glass(f32::INFINITY, Rgb::BLACK)), second: Box::new(glass(1.5, Rgb::BLACK)), weight: 0.5.into() };
        let mut moved = TextureRef::new(0);
        moved.uv_transform[1][2] = f32::NAN;
        for material in [
            of(inside),
            of(glass(1.5, Rgb::new(0.0, f32::NAN, 0.0))),
            of(Bsdf::Conductor { eta: Rgb::WHITE, k: Rgb::splat(f32::INFINITY), reflectance: Rgb::WHITE.into(), alpha: 0.1.into() }),
            Material { alpha: Alpha::Mask { opacity: ScalarParam::from(1.0), cutoff: f32::NAN }, ..Material::diffuse("m", Rgb::WHITE) },
            Material { normal_map: Some(NormalMap::Bump { texture: moved, scale: 1.0 }), ..Material::diffuse("m", Rgb::WHITE) },
        ] {
            let message = refused(material);
            assert!(message.contains("material \"m\"") && message.contains("not finite"), "{message}");
        }
        let message = refused(of(glass(0.0, Rgb::BLACK)));
        assert!(message.contains("an index of refraction is 0, expected more than 0"), "{message}");
    }

    #[test]
    fn more_triangles_than_can_be_rendered_are_refused() {
        let mut scene = one_triangle(Material::diffuse("m", Rgb::WHITE));
        let in_mesh = 1 << 16;
        Arc::make_mut(&mut scene.meshes[0]).triangles = vec![[0, 1, 2]; in_mesh];
        let part = scene.parts[0].clone();
        scene.parts = (0..Bvh::MAX_TRIANGLES / in_mesh).map(|i| Part { name: format!("part {i}"), ..part.clone() }).collect();
        assert_eq!(scene.validate(), Ok(()));
        scene.parts.push(part);
        let message = scene.validate().unwrap_err().to_string();
        assert!(message.contains("134283264 triangles") && message.contains("only 134217728"), "{message}");
    }

    #[test]
    fn lights_and_surroundings_whose_numbers_are_not_finite_are_refused() {
        let mut scene = one_triangle(Material::diffuse("m", Rgb::WHITE));
        scene.lights.push(Light::Point { name: "lamp".into(), position: Vec3::ZERO, intensity: Rgb::splat(f32::INFINITY) });
        let message = scene.validate().unwrap_err().to_string();
        assert!(message.contains("light \"lamp\"") && message.contains("not finite"), "{message}");
        scene.lights.clear();
        scene.environment = Some(Environment::Constant { radiance: Rgb::splat(f32::NAN) });
        assert!(scene.validate().unwrap_err().to_string().contains("the environment"));
        let map = Environment::Map { image: 3, rows: crate::MapRows::Bands, scale: Rgb::WHITE, map_from_world: Mat3::IDENTITY };
        scene.environment = Some(map);
        assert!(scene.validate().unwrap_err().to_string().contains("image 3"));
        let skewed = Mat3::from_cols(Vec3::X, Vec3::new(0.5, 1.0, 0.0).normalize(), Vec3::Z);
        scene.images.push(Image { name: "sky".into(), width: 1, height: 1, pixels: Pixels::RgbF32(vec![[1.0; 3]]) }.into());
        for (map_from_world, fits) in
            [(skewed, false), (Mat3::from_rotation_x(0.3), true), (Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)), true)]
        {
            scene.environment = Some(Environment::Map { image: 0, rows: crate::MapRows::Bands, scale: Rgb::WHITE, map_from_world });
            assert_eq!(scene.validate().is_ok(), fits, "{map_from_world:?}: {:?}", scene.validate());
        }
    }
}
