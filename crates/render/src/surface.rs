//! The surface at a ray's hit: position, normals, texture coordinates, material.

use crate::bsdf::{self, Bsdf};
use crate::light::LightPoint;
use crate::prepared::RenderScene;
use crate::texture::{Cone, Footprint, Textures};
use enfilade_geometry::Hit;
use enfilade_math::{Onb, Ray, Rgb, Vec2, Vec3, offset_origin};
use enfilade_scene::{Material, NormalMap, TextureRef};

/// A surface point seen from the unit direction `wo`.
#[derive(Clone)]
pub(crate) struct Surface<'s> {
    /// World position.
    pub p: Vec3,
    /// Towards where the ray came from.
    pub wo: Vec3,
    /// Unit geometric normal facing `wo`.
    pub ng: Vec3,
    /// See [`crate::triangle::Triangle::slack`].
    slack: f32,
    /// See [`Surface::lifted`], metres; zero where nothing is lifted.
    lift: Vec3,
    /// Unit interpolated normal, on the side of `wo`, before bump.
    pub ns_smooth: Vec3,
    /// Unit shading normal with bump, on the side of `wo`.
    pub ns: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// How wide the ray is that found it.
    pub cone: Cone,
    /// The part of a texture that one lookup covers here.
    footprint: Footprint,
    /// True when `wo` is on the side that outward normals point to.
    pub outside: bool,
    /// True where light passes and the shading normal is the same all over the triangle.
    pub flat: bool,
    /// Number of the triangle, and the weights of its corners.
    pub triangle: u32,
    pub weights: [f32; 3],
    /// The material.
    pub material: &'s Material,
    material_index: usize,
}

impl<'s> RenderScene<'s> {
    /// The surface at a hit of a ray with the unit direction `direction` and the cone `cone` at its origin.
    pub(crate) fn surface(&self, hit: &Hit, direction: Vec3, cone: &Cone) -> Surface<'s> {
        let wo = -direction;
        let triangle = self.triangles.get(hit.triangle);
        let weights = hit.weights();
        let [a, b, c] = triangle.normals;
        let winding = if triangle.winding == Vec3::ZERO { wo } else { triangle.winding };
        let interpolated = (a * weights[0] + b * weights[1] + c * weights[2]).try_normalize().unwrap_or(winding);
        // The vertex normals determine the outer side of the face.
        let outward = if interpolated.dot(winding) < 0.0 { -winding } else { winding };
        let outside = wo.dot(outward) >= 0.0;
        let side = if outside { 1.0 } else { -1.0 };
        let smooth = interpolated * side;

        let material_index = triangle.material as usize;
        let material = &self.scene.materials[material_index];
        let uv = triangle.uv(weights);
        let cone = cone.advanced(hit.t);
        let footprint = cone.footprint(triangle.uv_density);
        let bumped = material.normal_map.as_ref().and_then(|map| {
            let tangents = tangents(&triangle.corners, triangle.uvs)?;
            Some(perturbed(&self.textures, map, uv, &footprint, smooth, side, tangents))
        });
        let ns_smooth = facing(smooth, wo);
        let even = |other: Vec3| other.distance_squared(a) <= EVEN * EVEN;
        let flat = material.bsdf.transmits() && material.normal_map.is_none() && even(b) && even(c) && ns_smooth == smooth;
        Surface {
            p: triangle.position(weights),
            wo,
            ng: outward * side,
            slack: triangle.slack,
            lift: Vec3::ZERO,
            ns_smooth,
            ns: bumped.map_or(ns_smooth, |bumped| facing(bumped, wo)),
            uv,
            cone,
            footprint,
            outside,
            flat,
            triangle: hit.triangle,
            weights,
            material,
            material_index,
        }
    }
}

impl<'s> Surface<'s> {
    fn inputs<'a>(&self, scene: &'a RenderScene<'s>) -> bsdf::Inputs<'a> {
        bsdf::Inputs {
            textures: &scene.textures,
            uv: self.uv,
            footprint: self.footprint,
            tables: &scene.tables[self.material_index],
            cos_o: self.wo.dot(self.ns).max(MIN_COSINE),
            outside: self.outside,
        }
    }

    /// The scattering here; nothing on the back of a one-sided surface.
    pub fn bsdf<'a>(&self, scene: &'a RenderScene<'s>) -> Bsdf<'a> {
        if !self.outside && !self.material.two_sided && !self.material.bsdf.transmits() {
            return Bsdf::black();
        }
        Bsdf::new(&self.material.bsdf, &self.inputs(scene))
    }

    /// See [`bsdf::straight_transmittance`].
    pub fn straight_transmittance(&self, scene: &RenderScene<'s>) -> Option<Rgb> {
        bsdf::straight_transmittance(&self.material.bsdf, &self.inputs(scene))
    }

    /// See [`bsdf::border`].
    pub fn border(&self, scene: &RenderScene<'s>) -> Option<bsdf::Border> {
        bsdf::border(&self.material.bsdf, &self.inputs(scene))
    }

    /// Radiance emitted towards `wo`.
    pub fn emission(&self, scene: &RenderScene<'s>) -> Rgb {
        if self.material.emission.factor.is_black() || (!self.outside && !self.material.emits_both_sides) {
            return Rgb::BLACK;
        }
        // Read at a point: every technique that finds a light must see the same radiance.
        scene.textures.color(&self.material.emission, self.uv, &Footprint::POINT)
    }

    /// Shading space: z along the shading normal.
    #[inline]
    pub fn onb(&self) -> Onb {
        Onb::from_z(self.ns)
    }

    /// Admits light that smooth shading still receives although the face is already turned away from it. Light on coarse
    /// smooth meshes would otherwise end in steps along their edges, before it has faded: the "shadow terminator".
    ///
    /// For such directions the surface point is moved to where it would be if the surface were as round as its normals, by the planes
    /// through the corners that are perpendicular to their normals: Hanika 2021, "Hacking the Shadow Terminator". All other directions are
    /// unchanged. Nothing is lifted on flat faces, in hollows, on surfaces that transmit light, nor where another surface is within the
    /// lift.
    pub fn lifted(self, scene: &RenderScene<'s>) -> Self {
        Self { lift: self.lift(scene).unwrap_or(Vec3::ZERO), ..self }
    }

    fn lift(&self, scene: &RenderScene<'s>) -> Option<Vec3> {
        let triangle = scene.triangles.get(self.triangle);
        let [a, b, c] = triangle.normals;
        if (a == b && b == c) || self.material.bsdf.transmits() {
            return None;
        }
        let side = if self.outside { 1.0 } else { -1.0 };
        let corners = triangle.corners.into_iter().zip(triangle.normals).zip(self.weights);
        let lift: Vec3 = corners.map(|((corner, n), weight)| n * (-(self.p - corner).dot(n * side).min(0.0) * side * weight)).sum();
        let height = lift.dot(self.ng);
        if height < MIN_LIFT_M {
            return None;
        }
        let way = Ray { t_max: lift.length(), ..Ray::new(self.face_origin(self.ng), lift.normalize()) };
        (height < FREE_LIFT_M || !scene.is_covered(&way)).then_some(lift)
    }

    /// The cosine of a direction to the face; positive also for light that [`Surface::lifted`] lets in.
    #[inline]
    pub fn side(&self, direction: Vec3) -> f32 {
        let cos = direction.dot(self.ng);
        if cos <= 0.0 && self.lift != Vec3::ZERO { cos.max(direction.dot(self.ns_smooth)) } else { cos }
    }

    /// The point, just off the face on the side of `normal`.
    #[inline]
    fn face_origin(&self, normal: Vec3) -> Vec3 {
        offset_origin(self.p, normal) + normal * self.slack
    }

    /// The ray that leaves in a direction, from the side of the surface that it leaves on.
    #[inline]
    pub fn ray(&self, direction: Vec3) -> Ray {
        let cos = direction.dot(self.ng);
        if cos <= 0.0 && self.side(direction) > 0.0 {
            return Ray::new(self.face_origin(self.ng) + self.lift, direction);
        }
        Ray::new(self.face_origin(if cos < 0.0 { -self.ng } else { self.ng }), direction)
    }

    /// The point as one that receives light.
    #[inline]
    pub fn light_point(&self) -> LightPoint {
        LightPoint { p: self.p, n: if self.material.bsdf.transmits() { Vec3::ZERO } else { self.ns } }
    }

    /// See [`shadow_ray`].
    pub fn shadow_ray(&self, wi: Vec3, target: Option<Vec3>) -> Ray {
        shadow_ray(self.ray(wi).origin, wi, target)
    }
}

/// Surfaces that bulge by less are as good as flat.
const MIN_LIFT_M: f32 = 1e-6;
/// Lifts below this are not checked for other surfaces in between: at so small a distance they do not matter.
const FREE_LIFT_M: f32 = 1e-3;

/// The ray from a surface to a light, ending just before it.
pub(crate) fn shadow_ray(origin: Vec3, wi: Vec3, target: Option<Vec3>) -> Ray {
    match target {
        None => Ray::new(origin, wi),
        Some(target) => {
            let to_target = target - origin;
            let distance = to_target.length();
            Ray { origin, direction: to_target / distance.max(f32::MIN_POSITIVE), t_min: 0.0, t_max: distance * (1.0 - 1e-5) }
        }
    }
}

/// Unit normals of corners that differ by no more are the same up to rounding.
const EVEN: f32 = 1e-5;

/// Viewing cosines are never smaller, so that nothing divides by zero at the horizon.
pub(crate) const MIN_COSINE: f32 = 1e-4;

/// `n`, or the nearest direction to it that still faces `wo`.
#[inline]
fn facing(n: Vec3, wo: Vec3) -> Vec3 {
    let cos = n.dot(wo);
    if cos >= MIN_COSINE { n } else { (n + wo * (MIN_COSINE - cos)).normalize_or(wo) }
}

/// ∂p/∂u and ∂p/∂v of a triangle; `None` where the texture coordinates are degenerate.
fn tangents(corners: &[Vec3; 3], uvs: [Vec2; 3]) -> Option<(Vec3, Vec3)> {
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let (d1, d2) = (uvs[1] - uvs[0], uvs[2] - uvs[0]);
    let determinant = d1.x * d2.y - d1.y * d2.x;
    if determinant.abs() < 1e-20 {
        return None;
    }
    let inverse = 1.0 / determinant;
    Some(((e1 * d2.y - e2 * d1.y) * inverse, (e2 * d1.x - e1 * d2.x) * inverse))
}

/// Along the axes of a texture that its transform has turned or mirrored; not scaled.
fn along_texture(texture: &TextureRef, (dp_du, dp_dv): (Vec3, Vec3)) -> (Vec3, Vec3) {
    let [[a, b, _], [c, d, _]] = texture.uv_transform;
    let determinant = a * d - b * c;
    if determinant == 0.0 {
        return (dp_du, dp_dv);
    }
    let sign = determinant.signum();
    ((dp_du * d - dp_dv * c) * sign, (dp_dv * a - dp_du * b) * sign)
}

/// The normal `n` (on the viewer's side; `side` is −1 on the back) perturbed by a normal or bump map.
fn perturbed(
    textures: &Textures<'_>,
    map: &NormalMap,
    uv: Vec2,
    footprint: &Footprint,
    n: Vec3,
    side: f32,
    (dp_du, dp_dv): (Vec3, Vec3),
) -> Vec3 {
    match map {
        NormalMap::Normal { texture, scale } => {
            let rgb = textures.sample(texture, uv, footprint).0;
            let local = Vec3::new((2.0 * rgb.r - 1.0) * scale, (2.0 * rgb.g - 1.0) * scale, 2.0 * rgb.b - 1.0);
            let (dp_du, dp_dv) = along_texture(texture, (dp_du, dp_dv));
            // Tangents follow the texture as it is placed on the surface, orthogonal to the smooth normal.
            let Some(t) = (dp_du - n * n.dot(dp_du)).try_normalize() else { return n };
            let b = n.cross(t);
            let b = if b.dot(dp_dv) < 0.0 { -b } else { b };
            // Seen from the back, hills become hollows: the tangential part turns round with the normal.
            (t * (local.x * side) + b * (local.y * side) + n * local.z).try_normalize().unwrap_or(n)
        }
        NormalMap::Bump { texture, scale } => {
            let slope = textures.slope(texture, uv, footprint) * *scale;
            // Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU": subtract the surface gradient.
            let (r1, r2) = (dp_dv.cross(n), n.cross(dp_du));
            let determinant = dp_du.dot(r1);
            if determinant.abs() < 1e-20 {
                return n;
            }
            let gradient = (r1 * slope.x + r2 * slope.y) / determinant;
            (n - gradient * side).try_normalize().unwrap_or(n)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepared::AlphaTest;
    use enfilade_geometry::Mesh;
    use enfilade_math::DAffine3;
    use enfilade_scene::{Environment, Part, Quiet, Scene};

    /// A roof with the normals of a bulge, and a sheet at a height over it.
    fn scene(sheet_m: f32) -> Scene {
        let roof = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: [[-0.3, -0.3], [0.3, 0.0], [0.0, 0.3]].map(|[x, y]| Vec3::new(x, y, 1.0).normalize()).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let sheet = Mesh {
            positions: [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vec3::new(x, y, sheet_m)).to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let part = |mesh| Part { name: format!("part {mesh}"), object: None, mesh, material: 0, world_from_mesh: DAffine3::IDENTITY };
        Scene {
            meshes: vec![roof.into(), sheet.into()],
            parts: vec![part(0), part(1)],
            materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
            environment: Some(Environment::Constant { radiance: Rgb::WHITE }),
            ..Scene::default()
        }
    }

    /// By hand: the centre is 0.2/√1.18 below the plane of one corner and 0.2/√1.09 below the planes of the others; the normals rise by
    /// 1/√1.18 and 1/√1.09.
    #[test]
    fn bulges_are_lifted_to_the_planes_of_their_corners_unless_something_lies_between() {
        let expected = (0.2 / 1.18 + 2.0 * 0.2 / 1.09) / 3.0;
        let hit_from = |z: f32, sheet_m: f32| {
            let scene = scene(sheet_m);
            let ready = RenderScene::new(&scene, &Quiet).unwrap();
            let ray = Ray { t_max: 0.01, ..Ray::new(Vec3::new(1.0 / 3.0, 1.0 / 3.0, z), Vec3::new(0.0, 0.0, -z.signum())) };
            let hit = ready.closest(&ray, AlphaTest::Half).unwrap();
            ready.surface(&hit, ray.direction, &Cone::POINT).lifted(&ready).lift
        };
        let free = hit_from(0.005, 1.0);
        assert!((free.z - expected).abs() < 1e-5, "{free}, expected {expected}");
        assert_eq!(hit_from(0.005, 0.01), Vec3::ZERO, "a sheet in the way");
        assert_eq!(hit_from(-0.005, 1.0), Vec3::ZERO, "a hollow from below");
    }
}
