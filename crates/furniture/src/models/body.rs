//! The body of a model: its meshes and materials, transformed to the space of furniture.

use crate::shape::bevelled_box;
use crate::surface::Surface;
use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_scene::{Image, Material, Part, Scene};
use std::sync::Arc;

/// A triangle mesh of one material.
#[derive(Clone, Debug)]
pub struct BodyPart {
    /// Unique among the parts of a model.
    pub name: String,
    /// In the model's own space.
    pub mesh: Mesh,
    /// Index into [`Body::materials`].
    pub material: usize,
}

/// A light source of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bulb {
    /// The middle of the lamp, in the model's own space.
    pub at: Vec3,
    /// Metres.
    pub diameter: f32,
}

/// The meshes, materials and lights of a model. The middle of its footprint on the floor is the origin, x is to the right, y to the front,
/// z up.
#[derive(Clone, Debug)]
pub struct Body {
    /// Everything visible.
    pub parts: Vec<BodyPart>,
    /// Surfaces; their textures are indices into `images`.
    pub materials: Vec<Material>,
    /// Decoded pictures.
    pub images: Vec<Arc<Image>>,
    /// Light sources, besides materials that glow.
    pub bulbs: Vec<Bulb>,
    size: Vec3,
    surfaces: Vec<Surface>,
}

impl Body {
    /// The parts of `scene`, turned by `turn` (a rotation, or one with a reflection), scaled to `size` if there is one, and put on the
    /// floor with the middle of its footprint at the origin.
    ///
    /// # Errors
    /// When nothing is visible, or everything is at one point.
    pub fn new(scene: Scene, turn: DMat3, size: Option<Vec3>) -> Result<Self, String> {
        let mirrored = turn.determinant() < 0.0;
        let mut parts: Vec<BodyPart> = scene
            .parts
            .iter()
            .map(|part| {
                let matrix = turn * part.world_from_mesh.matrix3;
                let shift = turn * part.world_from_mesh.translation;
                let mesh = moved(&scene.meshes[part.mesh as usize], matrix, |p| (matrix * p.as_dvec3() + shift).as_vec3());
                let mesh = if mirrored { reversed(mesh) } else { mesh };
                BodyPart { name: part.name.replace('/', "."), mesh, material: part.material as usize }
            })
            .collect();
        let bounds = Bounds3::from_points(parts.iter().flat_map(|part| part.mesh.positions.iter().copied()));
        let extent = bounds.extent();
        if parts.is_empty() || extent.max_element() <= 0.0 || !extent.is_finite() {
            return Err("nothing in it can be seen; export it with its meshes".into());
        }
        let size = size.unwrap_or(extent);
        // What is flat cannot be stretched in that direction.
        let scale = Vec3::select(extent.cmpgt(Vec3::splat(1e-6)), size / extent, Vec3::ONE);
        let foot = Vec3::new(0.5 * (bounds.min.x + bounds.max.x), 0.5 * (bounds.min.y + bounds.max.y), bounds.min.z);
        for part in &mut parts {
            part.mesh = moved(&part.mesh, DMat3::from_diagonal(scale.as_dvec3()), |p| (p - foot) * scale);
        }
        let triangles: Vec<[Vec3; 3]> =
            parts.iter().flat_map(|part| (0..part.mesh.triangles.len()).map(|t| part.mesh.corners(t))).collect();
        let surfaces = super::surfaces::surfaces(&triangles, extent * scale);
        Ok(Self { parts, materials: scene.materials, images: scene.images, bulbs: Vec::new(), size: extent * scale, surfaces })
    }

    /// A plain grey block of `size`.
    pub fn block(size: Vec3) -> Result<Self, String> {
        let part = Part { name: "block".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
        let grey = Material::diffuse("block", Rgb::splat(0.5));
        let scene = Scene { meshes: vec![bevelled_box(size, 0.004).into()], parts: vec![part], materials: vec![grey], ..Scene::default() };
        Self::new(scene, DMat3::IDENTITY, None)
    }

    /// Width, depth and height, metres.
    pub fn size(&self) -> Vec3 {
        self.size
    }

    /// Surfaces on which small things can stand.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// True where the part gives off light by itself.
    pub fn shines(&self, part: &BodyPart) -> bool {
        !self.materials[part.material].emission.factor.is_black()
    }
}

/// The mesh with its points where `place` puts them, and its normals as `matrix`, the linear part of that, turns them.
fn moved(mesh: &Mesh, matrix: DMat3, place: impl Fn(Vec3) -> Vec3) -> Mesh {
    let turn = if matrix.determinant() == 0.0 { DMat3::IDENTITY } else { matrix.inverse().transpose() };
    let normal = |n: &Vec3| (turn * n.as_dvec3()).normalize_or(DVec3::Z).as_vec3();
    Mesh {
        positions: mesh.positions.iter().map(|p| place(*p)).collect(),
        normals: mesh.normals.iter().map(normal).collect(),
        uvs: mesh.uvs.clone(),
        triangles: mesh.triangles.clone(),
    }
}

fn reversed(mut mesh: Mesh) -> Mesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_turned_scaled_and_put_on_the_floor() {
        let part = |name: &str, mesh, at: [f64; 3]| Part {
            name: name.into(),
            object: None,
            mesh,
            material: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::from_array(at)),
        };
        let scene = Scene {
            meshes: vec![bevelled_box(Vec3::new(1.0, 0.5, 0.2), 0.0).into(), bevelled_box(Vec3::splat(0.1), 0.0).into()],
            parts: vec![part("top", 0, [5.0, 1.0, 0.9]), part("leg/1", 1, [5.0, 1.0, 0.05])],
            materials: vec![Material::diffuse("m", Rgb::WHITE)],
            ..Scene::default()
        };
        let turned = Body::new(scene.clone(), DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2), None).unwrap();
        assert!((turned.size() - Vec3::new(0.5, 1.0, 1.0)).abs().max_element() < 1e-5, "{}", turned.size());
        assert_eq!(turned.parts[1].name, "leg.1");
        let low = turned.parts[1].mesh.positions.iter().fold(Vec3::INFINITY, |low, p| low.min(*p));
        assert!((low - Vec3::new(-0.05, -0.05, 0.0)).abs().max_element() < 1e-5);
        let scaled = Body::new(scene, DMat3::IDENTITY, Some(Vec3::new(2.0, 0.5, 0.5))).unwrap();
        assert!((scaled.size() - Vec3::new(2.0, 0.5, 0.5)).abs().max_element() < 1e-5);
        let [top] = scaled.surfaces() else { panic!("one surface: {:?}", scaled.surfaces()) };
        assert!((top.z - 0.5).abs() < 0.002 && top.headroom.is_infinite() && top.max.x > 0.9);
    }
}
