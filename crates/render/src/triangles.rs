//! All triangles of a scene, by the numbers that the hierarchy reports.
//!
//! A small number of triangles is all kept in world space. If there are too many, meshes that are placed several times are instanced: their
//! triangles are computed from the mesh on demand, with the same rounding, so that no pixel depends on which are kept.

use crate::triangle::Triangle;
use enfilade_geometry::{Bvh, Placement};
use enfilade_math::{Bounds3, Mat3, Vec3};
use enfilade_scene::{Material, Part, PartId, Scene};

/// Up to this many triangles, all are kept in world space: rays are faster then, for about 200 bytes a triangle.
const KEPT: usize = 1 << 21;
/// Meshes of fewer triangles are never instanced.
const MIN_INSTANCED: usize = 64;

/// The triangles of a scene, in the order of parts and their triangles.
pub(crate) struct Triangles<'s> {
    scene: &'s Scene,
    kept: Vec<Triangle>,
    parts: Vec<Range>,
    count: usize,
    bounds: Bounds3,
}

/// The triangles of a part.
struct Range {
    /// Number of the first.
    first: u32,
    /// Index of the first among the kept triangles, if they are kept.
    kept: Option<u32>,
    /// For those that are not kept.
    normal_from_mesh: Mat3,
}

impl<'s> Triangles<'s> {
    /// Triangles of a valid scene. Lamps are always kept.
    pub fn new(scene: &'s Scene) -> Self {
        Self::keeping(scene, KEPT)
    }

    /// Instances the meshes that save most memory until no more than `max` triangles are kept, if that can be.
    fn keeping(scene: &'s Scene, max: usize) -> Self {
        let instanced = instanced_meshes(scene, max);
        let mut triangles = Self { scene, kept: Vec::new(), parts: Vec::new(), count: 0, bounds: Bounds3::EMPTY };
        for (number, part) in scene.parts.iter().enumerate() {
            let mesh = &scene.meshes[part.mesh as usize];
            let world: Vec<Vec3> = scene.world_positions(part).collect();
            let normal_from_mesh = part.world_from_mesh.matrix3.inverse().transpose().as_mat3();
            let is_kept = !instanced[part.mesh as usize] || emits(scene, part);
            let kept = is_kept.then_some(triangles.kept.len() as u32);
            for &vertices in &mesh.triangles {
                let corners = vertices.map(|i| world[i as usize]);
                triangles.bounds = corners.iter().fold(triangles.bounds, |bounds, &p| bounds.include(p));
                if is_kept {
                    triangles.kept.push(Triangle::new(scene, (number as u32, part), &normal_from_mesh, corners, vertices));
                }
            }
            triangles.parts.push(Range { first: triangles.count as u32, kept, normal_from_mesh });
            triangles.count += mesh.triangles.len();
        }
        triangles
    }

    /// The scene that they are of.
    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    /// How many there are in the world.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The smallest box around all.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Whether all of them are kept.
    #[inline]
    fn all_kept(&self) -> bool {
        self.kept.len() == self.count
    }

    /// The triangle of a number.
    #[inline]
    pub fn get(&self, number: u32) -> Triangle {
        if self.all_kept() { self.kept[number as usize] } else { self.find(number) }
    }

    /// The material of a triangle.
    #[inline]
    pub fn material(&self, number: u32) -> u32 {
        if self.all_kept() { self.kept[number as usize].material } else { self.scene.parts[self.part(number)].material }
    }

    /// The hierarchy over them, in which triangles of some materials ask the filter.
    pub fn hierarchy(&self, filtered: impl Fn(&Material) -> bool) -> Bvh {
        let filtered: Vec<bool> = self.scene.materials.iter().map(filtered).collect();
        let corners: Vec<[Vec3; 3]> = self.kept.iter().map(|triangle| triangle.corners).collect();
        let (mut numbers, mut meshes, mut placements) = (Vec::with_capacity(corners.len()), Vec::new(), Vec::new());
        let mut mesh_of = vec![None; self.scene.meshes.len()];
        for (part, range) in self.scene.parts.iter().zip(&self.parts) {
            let mesh = &self.scene.meshes[part.mesh as usize];
            if range.kept.is_some() {
                numbers.extend(range.first..range.first + mesh.triangles.len() as u32);
                continue;
            }
            let mesh = *mesh_of[part.mesh as usize].get_or_insert_with(|| {
                meshes.push(mesh.triangles.iter().map(|vertices| vertices.map(|i| mesh.positions[i as usize])).collect());
                meshes.len() - 1
            });
            placements.push(Placement { mesh, filtered: filtered[part.material as usize], ..placement(part, range.first) });
        }
        Bvh::with_placements(&corners, &numbers, &|number| filtered[self.material(number) as usize], &meshes, &placements)
    }

    /// The part of a triangle.
    #[inline]
    pub fn part_of(&self, number: u32) -> PartId {
        if self.all_kept() { self.kept[number as usize].part } else { self.part(number) as PartId }
    }

    fn part(&self, number: u32) -> usize {
        self.parts.partition_point(|range| range.first <= number) - 1
    }

    #[inline(never)]
    fn find(&self, number: u32) -> Triangle {
        let part_number = self.part(number);
        let range = &self.parts[part_number];
        let in_part = number - range.first;
        if let Some(kept) = range.kept {
            return self.kept[(kept + in_part) as usize];
        }
        let part = &self.scene.parts[part_number];
        let mesh = &self.scene.meshes[part.mesh as usize];
        let vertices = mesh.triangles[in_part as usize];
        let placement = placement(part, range.first);
        let corners = vertices.map(|i| placement.world(mesh.positions[i as usize]));
        Triangle::new(self.scene, (part_number as u32, part), &range.normal_from_mesh, corners, vertices)
    }
}

fn placement(part: &Part, first_triangle: u32) -> Placement {
    Placement { mesh: part.mesh as usize, world_from_mesh: part.world_from_mesh, first_triangle, filtered: false }
}

pub(crate) fn emits(scene: &Scene, part: &Part) -> bool {
    !scene.materials[part.material as usize].emission.factor.is_black()
}

/// Which meshes are instanced.
fn instanced_meshes(scene: &Scene, max: usize) -> Vec<bool> {
    let triangles = |mesh: usize| scene.meshes[mesh].triangles.len();
    let mut uses = vec![0; scene.meshes.len()];
    scene.parts.iter().filter(|part| !emits(scene, part)).for_each(|part| uses[part.mesh as usize] += 1);
    let mut kept: usize = scene.parts.iter().map(|part| triangles(part.mesh as usize)).sum();
    let mut repeated: Vec<usize> = (0..uses.len()).filter(|&mesh| uses[mesh] > 1 && triangles(mesh) >= MIN_INSTANCED).collect();
    repeated.sort_by_key(|&mesh| std::cmp::Reverse(triangles(mesh) * (uses[mesh] - 1)));
    let mut instanced = vec![false; uses.len()];
    for mesh in repeated {
        if kept <= max {
            break;
        }
        kept -= triangles(mesh) * uses[mesh];
        instanced[mesh] = true;
    }
    instanced
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepared::RenderScene;
    use crate::{Guide, RenderConfig, render_frame};
    use enfilade_frame::Layer;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Rng, Vec2, warp};
    use enfilade_scene::{Alpha, Camera, CameraView, Environment, Image, Intrinsics, Pixels, Pose, Quiet, ScalarParam, TextureRef};

    /// A crumpled ball with normals and texture coordinates.
    fn ball(rng: &mut Rng) -> Mesh {
        let positions: Vec<Vec3> = (0..300).map(|_| warp::sphere([rng.next_f32(), rng.next_f32()]) * rng.range(0.5, 1.0)).collect();
        Mesh {
            normals: positions.iter().map(|p| p.normalize()).collect(),
            uvs: positions.iter().map(|p| Vec2::new(p.x, p.y)).collect(),
            triangles: (0..100).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            positions,
        }
    }

    /// Balls of two meshes in many places, one of them a lamp, others with cut-outs; single triangles between them.
    fn balls() -> Scene {
        let mut rng = Rng::new(3);
        let mut scene = Scene { environment: Some(Environment::Constant { radiance: Rgb::WHITE }), ..Scene::default() };
        let texels = (0..16).map(|i| [(i % 3) as f32 / 2.0; 3]).collect();
        scene.images.push(Image { name: "holes".into(), width: 4, height: 4, pixels: Pixels::RgbF32(texels) }.into());
        let mut holes = Material::diffuse("holes", Rgb::new(0.7, 0.5, 0.3));
        holes.alpha = Alpha::Mask { opacity: ScalarParam { factor: 1.0, texture: Some((TextureRef::new(0), 0)) }, cutoff: 0.4 };
        let mut lamp = Material::diffuse("lamp", Rgb::splat(0.5));
        lamp.emission.factor = Rgb::splat(5.0);
        scene.materials = vec![Material::diffuse("grey", Rgb::splat(0.5)), holes, lamp];
        scene.meshes = vec![ball(&mut rng).into(), ball(&mut rng).into()];
        scene.meshes.push(Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() }.into());
        for i in 0..40u32 {
            let mut unit = || f64::from(rng.range(-1.0, 1.0));
            let turn = DMat3::from_rotation_z(3.0 * unit()) * DMat3::from_rotation_x(3.0 * unit());
            let size = DMat3::from_diagonal(DVec3::new(1.0 + 0.5 * unit(), 1.0, 1.0 + 0.5 * unit()));
            let world_from_mesh = DAffine3 { matrix3: turn * size, translation: DVec3::new(unit(), unit(), unit()) * 4.0 };
            let material = if i == 7 { 2 } else { u32::from(i % 4 == 1) };
            scene.parts.push(Part { name: format!("part {i}"), object: None, mesh: i % 3, material, world_from_mesh });
        }
        scene.validate().unwrap();
        scene
    }

    #[test]
    fn triangles_are_the_same_whether_they_are_kept_or_made() {
        let scene = balls();
        let (kept, made) = (Triangles::new(&scene), Triangles::keeping(&scene, 0));
        assert_eq!((kept.kept.len(), kept.count()), (2713, 2713));
        assert_eq!((made.kept.len(), made.count()), (113, 2713), "the lamp and what is too small to be instanced");
        assert_eq!(kept.bounds(), made.bounds());
        for number in 0..kept.count() as u32 {
            assert_eq!(format!("{:?}", kept.get(number)), format!("{:?}", made.get(number)));
            assert_eq!(kept.material(number), made.material(number));
        }
        // Meshes that save most are instanced first, and no more than needed.
        assert_eq!(Triangles::keeping(&scene, 1500).kept.len(), 1313);
    }

    #[test]
    fn frames_are_the_same_whether_triangles_are_kept_or_made() {
        let scene = balls();
        let camera = Camera::from(Intrinsics { width: 40, height: 30, fx: 20.0, fy: 20.0, cx: 20.0, cy: 15.0, skew: 0.0 });
        let pose = Pose::look_at(0, DVec3::new(7.0, 1.0, 0.5), DVec3::ZERO, DVec3::Z).unwrap();
        let view = CameraView::still(&camera, &pose);
        let config = RenderConfig { samples: 4, ..RenderConfig::default() };
        let frame = |triangles| {
            let scene = RenderScene::of(triangles).unwrap();
            let guide = Guide::learn(&scene, &[view], &config);
            (render_frame(&scene, &guide, &view, &config, &Quiet).unwrap(), scene.bvh.memory_bytes())
        };
        let ((kept, kept_bytes), (made, made_bytes)) = (frame(Triangles::new(&scene)), frame(Triangles::keeping(&scene, 0)));
        assert!(made_bytes < kept_bytes / 3, "{made_bytes} of {kept_bytes} bytes");
        for layer in [Layer::Color, Layer::DepthMeters, Layer::NormalWorld, Layer::TexCoord, Layer::RenderEntityId] {
            let (kept, made) = (kept.get(layer).unwrap(), made.get(layer).unwrap());
            assert!((0..kept.len()).all(|i| kept.get(i).to_bits() == made.get(i).to_bits()), "{layer:?}");
        }
    }
}
