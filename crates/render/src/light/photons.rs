//! Photons: light traced from its sources, to find small places that receive much light.

use super::bounds::LightBounds;
use super::choice::LightChoice;
use super::delta;
use super::emitter::Emission;
use super::lights::Lights;
use super::sample::LightPoint;
use crate::prepared::RenderScene;
use enfilade_math::{Distribution1, Onb, Ray, Rgb, Rng, Vec3, offset_origin, warp};
use enfilade_scene::Light;
use std::f32::consts::{PI, TAU};

/// The part of the photons that come from the sun where lamps are lit as well.
const OF_THE_SUN: f32 = 0.5;

/// The sources of photons: emissive surfaces and point lights, and the sun where it shines through windows.
pub(crate) struct PhotonSources<'a, 's> {
    scene: &'a RenderScene<'s>,
    choice: &'a LightChoice,
    /// Patches, then point lights.
    by_flux: Option<Distribution1>,
    /// Probability of the sun.
    of_the_sun: f32,
}

impl<'a, 's> PhotonSources<'a, 's> {
    /// The sources of a scene. `None` where there are none.
    pub fn new(scene: &'a RenderScene<'s>, choice: &'a LightChoice) -> Option<Self> {
        let lights = &scene.lights;
        let of_patches = lights.surfaces.bounds.iter().map(|b| b.power * PI * if b.two_sided { 2.0 } else { 1.0 });
        let of_points = lights.points.iter().map(|light| delta::light_bounds(light).map_or(0.0, |b| b.power * solid_angle(&b)));
        let by_flux = Distribution1::new(&of_patches.chain(of_points).collect::<Vec<_>>());
        let sunny = choice.windows().is_some() && lights.distant_by_strength.is_some();
        let of_the_sun = match (sunny, by_flux.is_some()) {
            (false, _) => 0.0,
            (true, true) => OF_THE_SUN,
            (true, false) => 1.0,
        };
        (sunny || by_flux.is_some()).then_some(Self { scene, choice, by_flux, of_the_sun })
    }

    /// A photon: its ray, and its flux over its probability. `None` for one that is lost.
    pub fn emit(&self, rng: &mut Rng) -> Option<(Ray, Rgb)> {
        let (photon, probability) = if rng.next_f32() < self.of_the_sun {
            (self.sunbeam(rng), self.of_the_sun)
        } else {
            (self.lamplight(rng), 1.0 - self.of_the_sun)
        };
        photon.map(|(ray, flux)| (ray, flux / probability))
    }

    /// A photon of an emissive surface or of a point light.
    fn lamplight(&self, rng: &mut Rng) -> Option<(Ray, Rgb)> {
        let lights = &self.scene.lights;
        let (emitter, pmf, _) = self.by_flux.as_ref()?.sample(rng.next_f32());
        let [u, v] = [(); 2].map(|()| [rng.next_f32(), rng.next_f32()]);

        // A light at a point shines evenly into the cone that bounds it, by its intensity there.
        let Some(patch) = lights.surfaces.patches.get(emitter) else {
            let light = &lights.points[emitter - lights.surfaces.patches.len()];
            let bounds = delta::light_bounds(light)?;
            let p = bounds.bounds.center();
            let d = Onb::from_z(bounds.axis).to_world(warp::cone(v, 1.0 - bounds.cos_normals)).normalize();
            let at_one_metre = delta::sample(light, &LightPoint { p: p + d, n: Vec3::ZERO }, u)?;
            return Some((Ray::new(p, d), at_one_metre.radiance? * (solid_angle(&bounds) / pmf)));
        };

        // A surface shines by the cosine. What a texture emits counts as even: photons guide, and need not be exact.
        let bounds = &lights.surfaces.bounds[emitter];
        let radiance = match patch.emission() {
            Emission::Even { radiance, .. } => radiance,
            Emission::Varied => Rgb::splat(bounds.power / patch.area()),
        };
        let sides = if bounds.two_sided { 2.0 } else { 1.0 };
        let normal = if bounds.two_sided && rng.next_f32() < 0.5 { -patch.normal() } else { patch.normal() };
        let d = Onb::from_z(normal).to_world(warp::cosine_hemisphere(v)).normalize();
        Some((Ray::new(offset_origin(patch.place(u), normal), d), radiance * (patch.area() * PI * sides / pmf)))
    }

    /// A photon of the sun, where it comes through a window.
    fn sunbeam(&self, rng: &mut Rng) -> Option<(Ray, Rgb)> {
        let Lights { distant, distant_by_strength, .. } = &self.scene.lights;
        let (sun, pmf, _) = distant_by_strength.as_ref()?.sample(rng.next_f32());
        let Light::Directional { direction, irradiance, .. } = &distant[sun] else { return None };
        let (p, area) = self.choice.windows()?.entry(*direction, [rng.next_f32(), rng.next_f32(), rng.next_f32()])?;
        let through = self.scene.transmittance(&Ray::new(p, -*direction));
        (!through.is_black()).then(|| (Ray::new(p, *direction), *irradiance * through * (area / pmf)))
    }
}

/// Steradians that a light at a point shines into.
fn solid_angle(bounds: &LightBounds) -> f32 {
    TAU * (1.0 - bounds.cos_normals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::DAffine3;
    use enfilade_scene::{Material, Part, Quiet, Scene, SpotFalloff};

    /// The mean flux of photons, and how many of them go up.
    fn flux(scene: &Scene, count: u32) -> (f32, f32) {
        let prepared = RenderScene::new(scene, &Quiet).expect("lit");
        let choice = LightChoice::learn(&prepared, &[], &crate::RenderConfig::default());
        let sources = PhotonSources::new(&prepared, &choice).expect("lamps");
        let mut rng = Rng::new(1);
        let (mut sum, mut up) = (0.0, 0.0);
        for _ in 0..count {
            let Some((ray, flux)) = sources.emit(&mut rng) else { continue };
            sum += flux.luminance() / count as f32;
            up += f32::from(u8::from(ray.direction.z > 0.0)) / count as f32;
        }
        (sum, up)
    }

    #[test]
    fn photons_carry_the_flux_of_the_lamps() {
        // A square of 0.5 m² that faces up with the radiance 4, or that emits on both sides; its flux is π times that, a side.
        let corners = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.5, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh { positions: corners.map(Vec3::from).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let of = |emits_both_sides| Scene {
            meshes: vec![mesh.clone().into()],
            materials: vec![Material { emission: Rgb::splat(4.0).into(), emits_both_sides, ..Material::diffuse("lamp", Rgb::BLACK) }],
            parts: vec![Part { name: "lamp".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
            ..Scene::default()
        };
        let (one, up) = flux(&of(false), 1000);
        assert!((one - 2.0 * PI).abs() < 1e-3 && up > 0.999, "{one} W, {up} of them up");
        let (both, up) = flux(&of(true), 4000);
        assert!((both - 4.0 * PI).abs() < 1e-3 && (up - 0.5).abs() < 0.05, "{both} W, {up} of them up");

        // Beside it a point light of the intensity 1, and a spot of the intensity 3 into a cone of 60°.
        let mut scene = of(false);
        scene.lights.push(Light::Point { name: "point".into(), position: Vec3::Z, intensity: Rgb::WHITE });
        scene.lights.push(Light::Spot {
            name: "spot".into(),
            position: Vec3::Z,
            direction: Vec3::NEG_Z,
            intensity: Rgb::splat(3.0),
            inner_rad: PI / 3.0,
            outer_rad: PI / 3.0,
            falloff: SpotFalloff::Angle,
        });
        let (all, _) = flux(&scene, 4000);
        let expected = 2.0 * PI + 4.0 * PI + 3.0 * PI;
        assert!((all / expected - 1.0).abs() < 0.02, "{all} W of {expected}");
    }
}
