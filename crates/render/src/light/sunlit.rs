//! Finding the glints of a scene, and the `sample`/`pdf` pair of their light.

use super::choice::LightChoice;
use super::delta;
use super::glint::{GlintBounds, Glinting, Glints, depth, piece, piece_at, place_in};
use super::lights::Lights;
use super::sample::{Glint, LightPoint, LightSample, power_heuristic};
use super::tree::LightTree;
use crate::prepared::RenderScene;
use crate::surface::Surface;
use crate::texture::Cone;
use crate::triangle::Triangle;
use crate::vertex::{sides_agree, viewing};
use enfilade_geometry::Hit;
use enfilade_math::{Bounds3, Ray, Rgb, Vec3, offset_origin};
use enfilade_scene::{Alpha, Light};
use std::f32::consts::PI;

/// A glossy reflection this many times as bright at its peak as a white diffuse one is a glint.
const MIN_PEAK: f32 = 2.0;
/// Rays that look for the sun from a piece, and the steps between them: powers of the inverse plastic number cover a square evenly (Roberts
/// 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
const RAYS: u32 = 4;
const STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];
/// The most triangles that are looked at; scenes with more have no glints.
const MAX_TRIANGLES: usize = 1 << 22;
/// The most clusters of glints, and the size below which none is divided, as a fraction of the diagonal around all.
const MAX_CLUSTERS: usize = 8;
const SMALLEST_CLUSTER: f32 = 0.05;

impl Glints {
    /// The glints of a scene whose only distant light is the sun.
    pub fn find(scene: &RenderScene<'_>) -> Self {
        let [Light::Directional { direction, irradiance, .. }] = &scene.lights.distant[..] else { return Self::default() };
        let count = scene.triangle_count();
        if count > MAX_TRIANGLES {
            return Self::default();
        }
        let eligible: Vec<bool> = (scene.scene.materials.iter())
            .map(|m| m.alpha == Alpha::Opaque && !m.bsdf.transmits() && m.emission.factor.is_black())
            .collect();
        let of_triangle = |number: usize| {
            let number = number as u32;
            let may = eligible[scene.triangles.material(number) as usize];
            if may { glinting(scene, number, -*direction, irradiance.luminance()) } else { None }
        };
        let found: Vec<(Glinting, Vec<GlintBounds>)> = enfilade_parallel::flat_map_up_to(count, of_triangle);
        let (mut triangles, mut of_emitter, mut emitters) = (Vec::new(), Vec::new(), Vec::new());
        for (place, (triangle, mut pieces)) in found.into_iter().enumerate() {
            triangles.push(Glinting { first: emitters.len() as u32, ..triangle });
            of_emitter.extend(pieces.iter().map(|_| place as u32));
            emitters.append(&mut pieces);
        }
        let tree = LightTree::new(&emitters);
        let diagonal = emitters.iter().fold(Bounds3::EMPTY, |all, one| all.union(one.bounds)).extent().length();
        let clusters = tree.cut(MAX_CLUSTERS, SMALLEST_CLUSTER * diagonal);
        let cluster_of_emitter = tree.cluster_of_emitter(&clusters);
        Self { triangles, of_emitter, tree, clusters, cluster_of_emitter }
    }

    /// Samples a place of a cluster that is seen from `at`. Its light is still to be found: [`Lights::radiance_of`].
    pub fn sample(&self, scene: &RenderScene<'_>, cluster: usize, at: &LightPoint, u: [f32; 3]) -> Option<LightSample> {
        let (emitter, pmf, u_left) = self.tree.sample(self.clusters[cluster], at, u[2])?;
        let Glinting { number, first, depth, area } = self.triangles[self.of_emitter[emitter as usize] as usize];
        let triangle = scene.triangles.get(number);
        let place = place_in(&piece(&triangle.corners, emitter - first, depth), [u[0], u[1]]);
        let to = triangle.position(place.to_array()) - at.p;
        let (distance, wi) = (to.length(), to.try_normalize()?);
        let hit = Hit { t: distance, triangle: number, u: place.y, v: place.z };
        let cosine = triangle.winding.dot(wi);
        let target = offset_origin(at.p + to, if cosine > 0.0 { -triangle.winding } else { triangle.winding });
        let pdf = pmf * distance * distance / (area * cosine.abs());
        let glint = Some(Glint { hit, u: u_left });
        pdf.is_finite().then_some(LightSample { glint, ..LightSample::new(wi, Some(target), None, pdf) })
    }

    /// The cluster of a surface, and the density per solid angle with which [`Glints::sample`] at `from` finds it, given that cluster.
    fn pdf(&self, scene: &RenderScene<'_>, from: &LightPoint, surface: &Surface<'_>) -> Option<(usize, f32)> {
        let place = self.triangles.binary_search_by_key(&surface.triangle, |triangle| triangle.number).ok()?;
        let Glinting { first, depth, area, .. } = self.triangles[place];
        let emitter = first + if depth == 0 { 0 } else { piece_at(&scene.triangles.get(surface.triangle).corners, surface.weights, depth) };
        let cluster = self.cluster_of_emitter[emitter as usize] as usize;
        let pmf = self.tree.pmf(*self.clusters.get(cluster)?, from, emitter);
        Some((cluster, pmf * from.p.distance_squared(surface.p) / (area * surface.ng.dot(surface.wo).abs())))
    }
}

impl Lights<'_> {
    /// Finds what light there is beyond the scene's own: reflections of the sun.
    pub fn find_glints(scene: &mut RenderScene<'_>) {
        scene.lights.glints = Glints::find(scene);
    }

    /// The radiance of a sample, in a ray of the width of `cone` at the point that it was sampled from; `u` is uniform on [0,1).
    #[inline]
    pub fn radiance_of(&self, scene: &RenderScene<'_>, sample: &LightSample, cone: &Cone, u: f32) -> Rgb {
        match (&sample.glint, sample.radiance) {
            (Some(glint), _) => self.reflected_sun(scene, &glint.hit, sample.wi, cone, [u, glint.u]),
            (None, Some(radiance)) => radiance,
            (None, None) => self.sky(sample.wi),
        }
    }

    /// Weight by the power heuristic of the sun's light that `surface` reflects, where a direction sampled with some density met it: the
    /// rest is left to glints. `sampled` as in [`Lights::background_weighted`].
    pub fn glint_weight(
        &self,
        scene: &RenderScene<'_>,
        choice: &LightChoice,
        sampled: Option<&(LightPoint, f32)>,
        surface: &Surface<'_>,
    ) -> f32 {
        if self.glints.len() == 0 {
            return 1.0;
        }
        let Some((from, pdf)) = sampled else { return 1.0 };
        let Some((cluster, found)) = self.glints.pdf(scene, from, surface) else { return 1.0 };
        power_heuristic(*pdf, choice.row(from).probability(self.first_glint() + cluster) * found)
    }

    /// Sunlight that the surface at `hit` reflects against the unit direction `wi` of a ray that met it; `u` is uniform on [0,1)².
    pub(super) fn reflected_sun(&self, scene: &RenderScene<'_>, hit: &Hit, wi: Vec3, cone: &Cone, u: [f32; 2]) -> Rgb {
        let surface = scene.surface(hit, wi, cone).lifted(scene);
        let bsdf = surface.bsdf(scene);
        let onb = surface.onb();
        let at = surface.light_point();
        let Some(sun) = self.distant.first().and_then(|light| delta::sample(light, &at, u)) else { return Rgb::BLACK };
        let to_sun = onb.to_local(sun.wi);
        if !sides_agree(to_sun.z, surface.side(sun.wi)) {
            return Rgb::BLACK;
        }
        let value = bsdf.eval_pdf(viewing(&onb, surface.wo), to_sun).0.total(bsdf.reflectance);
        if value.is_black() {
            return Rgb::BLACK;
        }
        value * sun.radiance.unwrap_or_default() * scene.transmittance(&surface.shadow_ray(sun.wi, None)) * (1.0 / sun.pdf)
    }
}

/// The pieces of a triangle as glints; `None` if it is not a glint: not glossy, turned away from the sun, or in shadow.
fn glinting(scene: &RenderScene<'_>, number: u32, to_sun: Vec3, irradiance: f32) -> Option<(Glinting, Vec<GlintBounds>)> {
    let triangle = scene.triangles.get(number);
    let area = 0.5 * triangle.cross().length();
    let normal = triangle.normals.iter().sum::<Vec3>().try_normalize()?;
    let two_sided = scene.scene.materials[triangle.material as usize].two_sided;
    let sign = if two_sided && normal.dot(to_sun) < 0.0 { -1.0 } else { 1.0 };
    if area <= 0.0 || triangle.normals.iter().all(|n| n.dot(to_sun) * sign <= 0.0) {
        return None;
    }

    // The reflection straight back gives roughness and reflectance for every model: its value is F·D/4, and D is 1/(π·α²).
    let middle = Hit { t: 0.0, triangle: number, u: 1.0 / 3.0, v: 1.0 / 3.0 };
    let bsdf = scene.surface(&middle, normal * -sign, &Cone::POINT).bsdf(scene);
    let albedo = bsdf.albedo(1.0);
    let reflectance = (albedo.glossy + albedo.sharp).luminance();
    let peak = bsdf.eval_pdf(Vec3::Z, Vec3::Z).0.specular.luminance();
    if peak * PI < MIN_PEAK || reflectance <= 0.0 {
        return None;
    }
    let alpha_2 = (reflectance / (4.0 * PI * peak)).min(1.0);

    let depth = depth(&triangle.corners);
    let area = area / (1u32 << depth) as f32;
    let piece = |index: u32| {
        let corners = piece(&triangle.corners, index, depth);
        let power = irradiance * area * reflectance * sunlit(scene, &triangle, &corners, to_sun);
        let normal =
            |corner: &Vec3| (triangle.normals.iter().zip(corner.to_array()).map(|(n, w)| *n * w).sum::<Vec3>()).normalize_or(normal);
        let mean = corners.iter().map(normal).sum::<Vec3>() / 3.0;
        GlintBounds {
            bounds: Bounds3::from_points(corners.iter().map(|corner| triangle.position(corner.to_array()))),
            power,
            grazing: power * (1.0 / reflectance - 1.0).max(0.0),
            axis: mean.normalize_or(normal(&corners[0])) * sign,
            mean_length: mean.length(),
            alpha_2,
            to_sun,
        }
    };
    let pieces: Vec<GlintBounds> = (0..1 << depth).map(piece).collect();
    pieces.iter().any(|piece| piece.power > 0.0).then_some((Glinting { number, first: 0, depth, area }, pieces))
}

/// The fraction of some places of a piece that the sun reaches.
fn sunlit(scene: &RenderScene<'_>, triangle: &Triangle, piece: &[Vec3; 3], to_sun: Vec3) -> f32 {
    let side = if triangle.winding.dot(to_sun) < 0.0 { -triangle.winding } else { triangle.winding };
    let lit = (0..RAYS).filter(|&k| {
        let u = STEPS.map(|step| (0.5 + step * k as f32).fract());
        let p = triangle.position(place_in(piece, u).to_array());
        let ray = Ray::new(offset_origin(p, side) + side * triangle.slack, to_sun);
        !scene.transmittance(&ray).is_black()
    });
    lit.count() as f32 / RAYS as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Onb, Rng, warp};
    use enfilade_scene::{Bsdf, Material, Part, Quiet, Scene};
    use enfilade_testkit::Mean;

    /// A polished bowl of metal that is open towards +z, in coarse triangles with smooth normals, under a sun with a wide disk.
    fn bowl() -> Scene {
        let (rings, columns) = (6, 12);
        let point = |ring: u32, column: u32| {
            let (tilt, turn) = (1.4 * ring as f32 / rings as f32, std::f32::consts::TAU * column as f32 / columns as f32);
            Vec3::new(tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), 0.0 - tilt.cos())
        };
        let positions: Vec<Vec3> = (0..=rings).flat_map(|ring| (0..columns).map(move |column| point(ring, column))).collect();
        let square = |ring: u32, column: u32| {
            let [a, b] = [column, (column + 1) % columns].map(|column| ring * columns + column);
            [[a, b, b + columns], [a, b + columns, a + columns]]
        };
        let triangles = (0..rings).flat_map(|ring| (0..columns).flat_map(move |column| square(ring, column))).collect();
        let mesh = Mesh { normals: positions.iter().map(|p| -*p).collect(), positions, triangles, ..Mesh::default() };
        let metal = Bsdf::Conductor { eta: Rgb::splat(0.2), k: Rgb::splat(3.0), alpha: 0.15.into(), reflectance: Rgb::WHITE.into() };
        let direction = Vec3::new(0.3, 0.1, -1.0).normalize();
        Scene {
            parts: vec![Part { name: "bowl".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
            meshes: vec![mesh.into()],
            materials: vec![Material::new("metal", metal)],
            lights: vec![Light::Directional { name: "sun".into(), direction, irradiance: Rgb::splat(3.0), angular_radius_rad: 0.1 }],
            ..Scene::default()
        }
    }

    #[test]
    fn glints_give_the_light_that_all_directions_find() {
        let scene = bowl();
        let prepared = RenderScene::new(&scene, &Quiet).unwrap();
        let (lights, glints) = (&prepared.lights, &prepared.lights.glints);
        assert!(glints.len() > 1 && glints.triangles.iter().any(|triangle| triangle.depth > 2));
        let mut rng = Rng::new(4);
        for p in [Vec3::new(0.1, 0.0, -0.3), Vec3::new(-0.2, 0.4, 0.1)] {
            let at = LightPoint { p, n: Vec3::NEG_Z };
            let mut random = || [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            let by_glints = Mean::of((0..100_000).map(|k| {
                let Some(sample) = glints.sample(&prepared, k % glints.len(), &at, random()) else { return 0.0 };
                let covered = prepared.is_covered(&crate::surface::shadow_ray(p, sample.wi, sample.target));
                let light = lights.radiance_of(&prepared, &sample, &Cone::POINT, random()[0]).luminance() * sample.wi.dot(at.n).max(0.0);
                if covered { 0.0 } else { f64::from(light * glints.len() as f32 / sample.pdf) }
            }));
            let by_directions = Mean::of((0..400_000).map(|_| {
                let u = random();
                let wi = Onb::from_z(at.n).to_world(warp::cosine_hemisphere([u[0], u[1]]));
                let Some(hit) = prepared.closest(&Ray::new(p, wi), crate::prepared::AlphaTest::Half) else { return 0.0 };
                let u = random();
                f64::from(lights.reflected_sun(&prepared, &hit, wi, &Cone::POINT, [u[0], u[1]]).luminance() * PI)
            }));
            let (off, error) =
                (by_glints.value() - by_directions.value(), by_glints.standard_error().hypot(by_directions.standard_error()));
            assert!(error < 0.03 * by_directions.value(), "{error} of {}", by_directions.value());
            assert!(off.abs() < 4.0 * error, "{} by glints, {} by directions", by_glints.value(), by_directions.value());
        }
    }

    #[test]
    fn the_density_of_a_place_is_the_one_that_it_is_sampled_with() {
        let scene = bowl();
        let prepared = RenderScene::new(&scene, &Quiet).unwrap();
        let glints = &prepared.lights.glints;
        let at = LightPoint { p: Vec3::new(0.1, 0.0, -0.3), n: Vec3::ZERO };
        let mut rng = Rng::new(4);
        for k in 0..2000 {
            let sample = glints.sample(&prepared, k % glints.len(), &at, [rng.next_f32(), rng.next_f32(), rng.next_f32()]).unwrap();
            let hit = sample.glint.unwrap().hit;
            let (cluster, pdf) = glints.pdf(&prepared, &at, &prepared.surface(&hit, sample.wi, &Cone::POINT)).unwrap();
            assert_eq!(cluster, k % glints.len());
            assert!((pdf / sample.pdf - 1.0).abs() < 1e-3, "{pdf} and {}", sample.pdf);
        }
    }
}
