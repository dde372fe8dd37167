//! The path tracer: radiance along paths, and the steps that they are made of. [`crate::batch`] begins them at the camera.

use crate::bsdf::{Bsdf, Value};
use crate::config::RenderConfig;
use crate::guide::Guide;
use crate::light::{LightKind, LightPoint, power_heuristic};
use crate::prepared::{Cutout, RenderScene};
use crate::split::Arriving;
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::{Medium, Segment, Vertex, sides_agree};
use enfilade_geometry::Hit;
use enfilade_math::{Ray, Rgb, Sampler, Vec3};

/// A path goes on with this times the ratio of the light it is expected to find to that of the first surface: the light is not known
/// exactly, and ending a path that mattered costs more than following one that did not.
const SURVIVAL_GAIN: f32 = 0.8;
/// The same where nothing is known of the light, and of the light that mirrors and glass find, for what the path lets through.
const UNKNOWN_GAIN: f32 = 12.0;
/// Bounds of the probability that a path goes on; the second of them where nothing is known of the light.
const LEAST_SURVIVAL: f32 = 0.2;
const LEAST_UNKNOWN: f32 = 0.05;
const MOST_SURVIVAL: f32 = 0.95;

/// What a path lets through counts in each colour as at least this share of the colour that it lets through best.
const LEAST_COLOR: f32 = 0.05;

/// Panes one behind the other that are looked through where a path has its last surface.
const MOST_PANES: usize = 64;

/// Random numbers: set 0 is the camera's; each bounce has two more.
pub(crate) const fn bsdf_set(bounce: u32) -> u32 {
    1 + 2 * bounce
}
pub(crate) const fn light_set(bounce: u32) -> u32 {
    2 + 2 * bounce
}

/// What a path lets through to the camera, for roulette. No colour is wholly lost: other pixels count on what the path finds, and so does
/// illumination, which is without the first surface's colour.
pub(crate) fn for_roulette(passed: Rgb) -> Rgb {
    let best = passed.max_component();
    let least = LEAST_COLOR * if best > 0.0 { best } else { 1.0 };
    passed.map(|v| v.max(least))
}

/// Estimates radiance along paths of one scene.
pub(crate) struct Integrator<'a, 's> {
    pub scene: &'a RenderScene<'s>,
    pub config: &'a RenderConfig,
    pub guide: &'a Guide,
    /// The angle that a camera ray stands for, radians.
    pub pixel_angle: f32,
}

/// Light sampled at a source.
pub(crate) struct Direct {
    /// The BSDF's value over the light's density, weighted against BSDF sampling.
    pub weight: Value,
    /// Radiance that arrives.
    pub light: Rgb,
    pub kind: LightKind,
    /// True when it reaches the surface from behind.
    pub crosses: bool,
    /// Where it comes from.
    pub wi: Vec3,
    /// What the BSDF's value was multiplied by.
    pub factor: f32,
    /// Density of the direction; `None` when no other technique can find it.
    pub pdf: Option<f32>,
}

/// Light that arrives at a surface by way of others.
pub(crate) struct Indirect {
    /// The BSDF's value over the direction's density, and over the probability of having followed it.
    pub weight: Value,
    pub light: Arriving,
    /// Where it comes from.
    pub wi: Vec3,
    /// The density times that probability; `None` unless the direction came from a density.
    pub density: Option<f32>,
}

/// How a path goes on.
pub(crate) struct Step {
    /// The BSDF's value over the direction's density and over `survival`.
    pub weight: Value,
    /// Probability that it went on.
    pub survival: f32,
}

impl<'a, 's> Integrator<'a, 's> {
    /// The surface at the end of a segment, and the throughput to it. What it emits, or the background in its place, is added to
    /// `radiance`, weighted against light sampling; `direct` says that nothing has scattered it.
    #[inline]
    pub fn next_surface(
        &self,
        segment: &Segment,
        throughput: Rgb,
        direct: bool,
        radiance: &mut Arriving,
    ) -> Option<(Surface<'s>, Hit, Rgb)> {
        let (lights, sampled) = (&self.scene.lights, segment.sampled.as_ref());
        let Some(hit) = self.scene.closest(&segment.ray, Cutout::Random) else {
            let background = lights.background_weighted(&self.guide.choice, sampled, segment.ray.direction);
            radiance.add_background(background, throughput, direct);
            return None;
        };
        let surface = self.scene.surface(&hit, segment.ray.direction, &segment.cone);
        let throughput = throughput * segment.medium.transmittance(hit.t);
        let emission = surface.emission(self.scene);
        if !emission.is_black() {
            let weight = lights.surface_weight(self.scene, &self.guide.choice, sampled, segment.ray.direction, &hit, surface.p);
            radiance.add(LightKind::Surfaces, throughput * emission * weight, direct);
        }
        Some((surface, hit, throughput))
    }

    /// Adds what the last surface, which a segment ends at, lets through of lights: light sampling saw them through panes, and counted
    /// on them.
    pub fn beyond_panes(&self, mut segment: Segment, mut surface: Surface<'s>, mut throughput: Rgb, direct: bool, radiance: &mut Arriving) {
        if segment.sampled.is_none() {
            return;
        }
        for _ in 0..MOST_PANES {
            let Some(passed) = surface.straight_transmittance(self.scene).filter(|passed| !passed.is_black()) else { return };
            (segment.ray, segment.cone) = (surface.ray(segment.ray.direction), surface.cone);
            let Some((next, _, reached)) = self.next_surface(&segment, throughput * passed, direct, radiance) else { return };
            (surface, throughput) = (next, reached);
        }
    }

    /// Where a path goes on, and with which weight; `None` where it ends. Two numbers concern roulette alone: `so_far`, what the path
    /// lets through to the camera ([`for_roulette`]), and `expected`, the light that its first surface is expected to reflect of what directions find there
    /// (0: unknown).
    #[inline]
    pub fn onward(
        &self,
        bounce: u32,
        vertex: &Vertex<'_, 's>,
        so_far: Rgb,
        before: &Segment,
        expected: &mut f32,
        sampler: &Sampler,
    ) -> Option<(Step, Segment)> {
        let u = sampler.set(bsdf_set(bounce));
        let (weight, next) = vertex.scatter([u[0], u[1], u[2]], before)?;
        if bounce < self.config.roulette_start {
            return Some((Step { weight, survival: 1.0 }, next));
        }
        let reflectance = vertex.bsdf.reflectance;
        let here = so_far.luminance() * vertex.expected();
        let blurred = weight.specular.luminance() <= (reflectance * weight.diffuse).luminance();
        let survival = if blurred && here > 0.0 && *expected > 0.0 {
            (SURVIVAL_GAIN * here / *expected).max(LEAST_SURVIVAL)
        } else {
            (UNKNOWN_GAIN * (so_far * weight.total(reflectance)).max_component() / next.medium.compression).max(LEAST_UNKNOWN)
        };
        let survival = survival.min(MOST_SURVIVAL);
        if u[3] >= survival {
            return None;
        }
        if *expected == 0.0 {
            *expected = here;
        }
        Some((Step { weight: weight * (1.0 / survival), survival }, next))
    }

    /// Radiance along a path from its surface number `bounce` on, to which `so_far` of the light passes to the camera; for that and `expected`
    /// see [`Integrator::onward`]. `direct` says that nothing has scattered the light.
    pub fn radiance(
        &self,
        mut segment: Segment,
        bounce: u32,
        mut direct: bool,
        so_far: Rgb,
        mut expected: f32,
        sampler: &Sampler,
    ) -> Arriving {
        let mut radiance = Arriving::default();
        let mut throughput = Rgb::WHITE;
        for bounce in bounce.. {
            let Some((surface, _, reached)) = self.next_surface(&segment, throughput, direct, &mut radiance) else { return radiance };
            throughput = reached;
            // The last surface only shows what it emits: light sampling before it counted on that.
            if self.config.max_bounces.is_some_and(|most| bounce > most) {
                self.beyond_panes(segment, surface, throughput, direct, &mut radiance);
                return radiance;
            }
            let bsdf = surface.bsdf(self.scene);
            if bsdf.is_black() {
                return radiance;
            }
            let vertex = Vertex::new(self.guide, surface, bsdf);
            let reflectance = vertex.bsdf.reflectance;
            if let Some(Direct { weight, light, kind, .. }) = self.sample_lights(&vertex, sampler.set(light_set(bounce)), segment.medium) {
                radiance.add(kind, throughput * weight.total(reflectance) * light, false);
            }
            let Some((step, next)) = self.onward(bounce, &vertex, throughput * so_far, &segment, &mut expected, sampler) else {
                return radiance;
            };
            throughput *= step.weight.total(reflectance);
            direct &= next.straight;
            segment = next;
        }
        radiance
    }

    /// A sample's indirect light, dimmed to the most that it may add behind the first surface's `throughput`.
    pub fn clamped(&self, light: Arriving, throughput: Rgb) -> Arriving {
        let Some(most) = self.config.clamp else { return light };
        let brightest = (light.total * throughput).max_component();
        if brightest > most { light.scaled(most / brightest) } else { light }
    }

    /// Direct light, where the light sample sends any. `medium` is what lies before the surface, on the viewer's side.
    pub fn sample_lights(&self, vertex: &Vertex<'_, 's>, u: [f32; 4], medium: Medium) -> Option<Direct> {
        let surface = &vertex.surface;
        let wanted = |wi: Vec3| sides_agree(wi.dot(vertex.onb.z), wi.dot(surface.ng));
        let at = LightPoint::on(surface);
        let light = self.scene.lights.sample(self.scene, &self.guide.choice, &at, [u[0], u[1], u[2]], wanted)?;
        let wi = vertex.onb.to_local(light.wi);
        let (value, pdf) = vertex.eval_pdf(wi, light.wi);
        if value == Value::default() {
            return None;
        }
        let ray = surface.shadow_ray(light.wi, light.target);
        let crosses = wi.z < 0.0;
        let medium = medium.after(surface, crosses);
        // Of a body that is not closed, which light from infinity can leave, directions do not know how far it goes either.
        let absorbed = if light.target.is_some() { medium.transmittance(ray.t_max) } else { Rgb::WHITE };
        let arriving = self.scene.transmittance(&ray) * absorbed;
        if arriving.is_black() {
            return None;
        }
        let weight = if light.is_delta { 1.0 } else { power_heuristic(light.pdf, pdf) } / light.pdf;
        Some(Direct {
            weight: value * weight,
            light: self.scene.lights.radiance_of(&light) * arriving,
            kind: light.kind(),
            crosses,
            wi: light.wi,
            factor: weight,
            pdf: (!light.is_delta).then_some(light.pdf),
        })
    }

    /// Irradiance over π at a surface without diffuse reflectance, by a white Lambert surface in its place.
    pub fn irradiance(&self, surface: &Surface<'s>, sampler: &Sampler) -> Rgb {
        let vertex = Vertex::new(self.guide, surface.clone(), Bsdf::lambert(Rgb::WHITE));
        let direct = self.sample_lights(&vertex, sampler.set(light_set(0)), Medium::AIR);
        let mut irradiance = direct.map_or(Rgb::BLACK, |direct| direct.weight.diffuse * direct.light);
        let u = sampler.set(bsdf_set(0));
        let nowhere = Segment::from_camera(Ray::new(surface.p, -surface.wo), Cone::POINT);
        if let Some((weight, segment)) = vertex.scatter([u[0], u[1], u[2]], &nowhere) {
            irradiance += weight.diffuse * self.radiance(segment, 1, true, Rgb::WHITE, vertex.expected(), sampler).total;
        }
        irradiance
    }
}
