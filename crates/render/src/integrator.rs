//! The path tracer: radiance along paths, and the steps that they are made of. [`crate::camera_path`] begins them at the camera.
//!
//! Kajiya 1986, "The Rendering Equation", with next-event estimation, multiple importance sampling by the power heuristic (Veach 1997)
//! and Russian roulette. Bounce 0 is the surface that the camera ray hits.

use crate::bsdf::{Bsdf, Value};
use crate::config::RenderConfig;
use crate::glass::Connection;
use crate::guide::Guide;
use crate::light::{Background, LightKind, LightPoint, LightSample, power_heuristic};
use crate::light_parts::{Arriving, Origin};
use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::{Medium, Segment, Vertex, sides_agree};
use enfilade_math::{Ray, Rgb, Rng, Sampler, Vec3, hash_u64};

/// A path continues with a probability of this times the light that it is expected to reflect, relative to that at the first surface. The
/// light is not known exactly, and ending a path that mattered costs more than following one that did not.
const SURVIVAL_GAIN: f32 = 0.8;
/// Factor of the throughput in that probability if nothing is known of the light, and for the light that mirrors and glass find.
const UNKNOWN_GAIN: f32 = 12.0;
/// Bounds of the probability that a path continues; the second one where nothing is known of the light.
const MIN_SURVIVAL: f32 = 0.2;
const MIN_SURVIVAL_UNKNOWN: f32 = 0.05;
const MAX_SURVIVAL: f32 = 0.95;

/// For Russian roulette, each colour of the throughput counts as at least this fraction of the largest one.
const MIN_COLOR: f32 = 0.05;

/// The most panes, one behind the other, that are looked through at a path's last surface where bounces are limited.
const MAX_PANES: usize = 64;

/// The set of random numbers for the direction at a bounce; the fourth is for Russian roulette, and at the first surface, which has none, for
/// the draw by opacity. Set 0 is the camera's; each bounce has two more.
pub(crate) const fn bsdf_set(bounce: u32) -> u32 {
    1 + 2 * bounce
}
/// The set of random numbers for the light sample at a bounce.
pub(crate) const fn light_set(bounce: u32) -> u32 {
    2 + 2 * bounce
}

/// A path's throughput, as it counts for Russian roulette. No colour counts as zero, because the demodulated illumination does not have
/// the first surface's colour.
pub(crate) fn roulette_throughput(throughput: Rgb) -> Rgb {
    let best = throughput.max_component();
    let min = MIN_COLOR * if best > 0.0 { best } else { 1.0 };
    throughput.map(|v| v.max(min))
}

/// Estimates radiance along paths of one scene.
pub(crate) struct Integrator<'a, 's> {
    pub scene: &'a RenderScene<'s>,
    pub config: &'a RenderConfig,
    pub guide: &'a Guide,
    /// The angle that a camera ray covers, radians.
    pub pixel_angle: f32,
}

/// Light sampled at a light source, as it arrives at a vertex.
pub(crate) struct Direct {
    /// The BSDF's value over the light's density, weighted against BSDF sampling.
    pub weight: Value,
    /// Radiance that arrives.
    pub light: Rgb,
    pub from: Origin,
    /// True when it reaches the surface from behind.
    pub crosses: bool,
    /// True when a glossy surface has scattered it before.
    pub scattered: bool,
}

impl<'a, 's> Integrator<'a, 's> {
    /// The fixture, if light is separated by fixture.
    #[inline]
    fn fixture(&self, find: impl FnOnce() -> Option<u16>) -> Option<u16> {
        if self.config.fixtures { find() } else { None }
    }

    /// Origin of the emission of a surface.
    #[inline]
    pub fn origin_of_surface(&self, surface: &Surface<'s>) -> Origin {
        let part = || self.scene.triangles.part_of(surface.triangle);
        Origin { kind: LightKind::Surfaces, fixture: self.fixture(|| self.scene.told_apart().of_part(part())) }
    }

    /// The farthest window along a path that continues as `next` from a `surface`, since its direction last changed.
    #[inline]
    pub fn window(&self, surface: &Surface<'s>, next: &Segment) -> Option<u16> {
        if !(self.config.fixtures && next.straight) {
            return None;
        }
        self.scene.told_apart().of_pane(self.scene.triangles.part_of(surface.triangle)).or(next.window)
    }

    /// Transmittance along a shadow ray, and the farthest window along it.
    #[inline]
    fn transmittance_and_window(&self, ray: &Ray) -> (Rgb, Option<u16>) {
        let fixtures = self.scene.told_apart();
        self.scene.unbent_transmittance_and_pane(ray, |part| fixtures.of_pane(part))
    }

    /// Light from beyond the scene, by its origin; `window` is the window that it comes through.
    #[inline]
    pub fn background_by_origin(&self, background: Background, window: Option<u16>) -> [(Origin, Rgb); 2] {
        [(LightKind::Environment, background.environment), (LightKind::Distant, background.distant)]
            .map(|(kind, light)| (Origin { kind, fixture: self.fixture(|| self.scene.told_apart().of_far(kind, window)) }, light))
    }

    /// The surface at the end of a segment, and the throughput to it. What it emits, or the background in its place, is added to
    /// `radiance`, weighted against light sampling; `direct` means that nothing has scattered it.
    #[inline]
    fn next_surface(&self, segment: &Segment, throughput: Rgb, direct: bool, radiance: &mut Arriving) -> Option<(Surface<'s>, Rgb)> {
        let (lights, sampled) = (&self.scene.lights, segment.sampled.as_ref());
        let Some(hit) = self.scene.closest(&segment.ray, AlphaTest::Stochastic) else {
            let mut background = lights.background_weighted(&self.guide.choice, sampled, segment.ray.direction);
            background.distant *= segment.sun;
            for (from, light) in self.background_by_origin(background, segment.window) {
                radiance.add(from, throughput * light, direct);
            }
            return None;
        };
        let surface = self.scene.surface(&hit, segment.ray.direction, &segment.cone);
        let throughput = throughput * segment.medium.transmittance(hit.t);
        let emission = surface.emission(self.scene);
        if !emission.is_black() {
            // Beside the edge of a thick pane the shifted way exists where the straight one misses the pane: light samples do not look there.
            let by_lights =
                |(from, _): &&(LightPoint, f32)| !segment.shifted || self.scene.meets_panes(from, segment.medium, surface.p, surface.ng);
            let sampled = sampled.filter(by_lights);
            let weight = lights.surface_weight(self.scene, &self.guide.choice, sampled, segment.direction_to(surface.p), &hit, surface.p);
            radiance.add(self.origin_of_surface(&surface), throughput * emission * weight, direct);
        }
        Some((surface, throughput))
    }

    /// Adds the lights that are seen through panes beyond a path's last surface, which `segment` ends at. Light sampling sees through
    /// panes, and its weights leave a part of these lights to sampled directions.
    fn beyond_panes(&self, mut segment: Segment, mut surface: Surface<'s>, mut throughput: Rgb, mut direct: bool, radiance: &mut Arriving) {
        for _ in 0..MAX_PANES {
            if segment.sampled.is_none() && segment.inside.is_none_or(|inside| inside.sampled.is_none()) {
                return;
            }
            let Some((passed, mut next)) = self.straight_on(&segment, &surface) else { return };
            next.window = self.window(&surface, &next);
            direct = next.is_direct(&segment, direct);
            segment = next;
            let Some((next, reached)) = self.next_surface(&segment, throughput * passed, direct, radiance) else { return };
            (surface, throughput) = (next, reached);
        }
    }

    /// Continuation of a segment through panes, thin or solid, as light samples reach through them, and its transmittance.
    fn straight_on(&self, segment: &Segment, surface: &Surface<'s>) -> Option<(Rgb, Segment)> {
        if let Some(passed) = surface.straight_transmittance(self.scene).filter(|passed| !passed.is_black()) {
            let ray = surface.ray(segment.ray.direction);
            return Some((passed, Segment { ray, cone: surface.cone, straight: true, was_direct: None, ..*segment }));
        }
        let (passed, next) = segment.beyond(surface, &surface.border(self.scene)?)?;
        (next.straight || next.inside.is_some()).then_some((passed, next))
    }

    /// Continuation of a path and its weight: the BSDF's value over the direction's density and the probability of survival; `None` where
    /// it ends. Two arguments are only for Russian roulette: `so_far`, the throughput to the camera ([`roulette_throughput`]), and
    /// `expected`, the luminance that the first surface is expected to reflect of the light that sampled directions find there (0:
    /// unknown).
    #[inline]
    fn next_step(
        &self,
        bounce: u32,
        vertex: &Vertex<'_, 's>,
        so_far: Rgb,
        before: &Segment,
        expected: &mut f32,
        sampler: &Sampler,
    ) -> Option<(Value, Segment)> {
        // Sample a direction from the BSDF and the guide.
        let u = sampler.set(bsdf_set(bounce));
        let (weight, next) = vertex.scatter([u[0], u[1], u[2]], before)?;
        if bounce < self.config.roulette_start {
            return Some((weight, next));
        }

        // Estimate the light that the path will still add, relative to the light expected from its first surface, and let it survive with a
        // proportional probability. Where the guide knows nothing, and for mirror-like reflection, which it does not cover, only the
        // throughput decides (Vorba & Křivánek 2016, "Adjoint-Driven Russian Roulette and Splitting", for the idea).
        let reflectance = vertex.bsdf.reflectance;
        let here = so_far.luminance() * vertex.expected_at_most();
        let blurred = weight.specular.luminance() <= (reflectance * weight.diffuse).luminance();
        let survival = if blurred && here > 0.0 && *expected > 0.0 {
            (SURVIVAL_GAIN * here / *expected).max(MIN_SURVIVAL)
        } else {
            (UNKNOWN_GAIN * (so_far * weight.total(reflectance)).max_component() / next.medium.compression).max(MIN_SURVIVAL_UNKNOWN)
        };
        let survival = survival.min(MAX_SURVIVAL);

        // Play Russian roulette: survivors carry the weight of those that ended.
        if u[3] >= survival {
            return None;
        }
        if *expected == 0.0 {
            *expected = so_far.luminance() * vertex.expected();
        }
        Some((weight * (1.0 / survival), next))
    }

    /// Radiance that arrives along `segment`, whose end is surface number `bounce` of the path. For `so_far` and `expected` see
    /// [`Integrator::next_step`]. `direct` means that nothing has scattered the light yet.
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
            // Find the next surface, and add its emission, or the background where there is none. Where light sampling could have found the
            // same light, the power heuristic weights the two.
            let Some((surface, reached)) = self.next_surface(&segment, throughput, direct, &mut radiance) else { return radiance };
            throughput = reached;

            // End the path at the limit on bounces. The last surface shows only what it emits, and lights through panes: the light samples
            // before it left a part of these to this path.
            if self.config.max_bounces.is_some_and(|max| bounce > max) {
                self.beyond_panes(segment, surface, throughput, direct, &mut radiance);
                return radiance;
            }

            // Evaluate the material.
            let bsdf = surface.bsdf(self.scene);
            if bsdf.is_black() {
                return radiance;
            }
            let vertex = Vertex::new(self.guide, surface.lifted(self.scene), bsdf);
            let reflectance = vertex.bsdf.reflectance;

            // Sample a light and add its contribution. The sun's light on a glossy surface could have been found as a glint as well.
            let by_glints = segment.sampled.as_ref().filter(|_| !segment.straight);
            let sun = self.scene.lights.glint_weight(self.scene, &self.guide.choice, by_glints, &vertex.surface);
            for Direct { weight, light, from, scattered, .. } in self.sample_lights(&vertex, bounce, sampler, segment.medium) {
                let part = if from.kind == LightKind::Distant && !scattered { sun } else { 1.0 };
                radiance.add(from, throughput * weight.total(reflectance) * light * part, false);
            }

            // Sample the next direction, unless Russian roulette ends the path.
            let Some((weight, mut next)) = self.next_step(bounce, &vertex, throughput * so_far, &segment, &mut expected, sampler) else {
                return radiance;
            };
            throughput *= weight.total(reflectance);
            direct = next.is_direct(&segment, direct);
            if !next.straight {
                next.sun = sun;
            }
            next.window = self.window(&vertex.surface, &next);
            segment = next;
        }
        radiance
    }

    /// A sample's indirect light, scaled down to [`RenderConfig::clamp`] behind the first surface's `throughput`.
    pub fn clamped(&self, light: Arriving, throughput: Rgb) -> Arriving {
        let Some(max) = self.config.clamp else { return light };
        let brightest = (light.total * throughput).max_component();
        if brightest > max { light.scaled(max / brightest) } else { light }
    }

    /// Direct light by one light sample at surface number `bounce`, or by a glint, and the same light once more where glass bends it there.
    /// `medium` is in front of the surface, on the viewer's side.
    pub fn sample_lights(&self, vertex: &Vertex<'_, 's>, bounce: u32, sampler: &Sampler, medium: Medium) -> impl Iterator<Item = Direct> {
        let (seen, bent) = self.sample_light(vertex, bounce, sampler, medium).unwrap_or_default();
        seen.into_iter().chain(bent)
    }

    fn sample_light(
        &self,
        vertex: &Vertex<'_, 's>,
        bounce: u32,
        sampler: &Sampler,
        medium: Medium,
    ) -> Option<(Option<Direct>, Option<Direct>)> {
        // Choose a light and a point on it, above the shading and the geometric surface alike.
        let (surface, u) = (&vertex.surface, sampler.set(light_set(bounce)));
        let wanted = |wi: Vec3| sides_agree(wi.dot(vertex.onb.z), surface.side(wi));
        let at = surface.light_point();
        let light = self.scene.lights.sample(self.scene, &self.guide.choice, &at, [u[0], u[1], u[2]], wanted)?;

        // A glint is one more surface of the path.
        let scattered = light.glint.is_some();
        if scattered && self.config.max_bounces.is_some_and(|max| bounce >= max) {
            return None;
        }

        // Evaluate the BSDF before the shadow ray is traced: it may make that unnecessary.
        let wi = vertex.onb.to_local(light.wi);
        let (value, pdf) = vertex.eval_pdf(wi, light.wi);
        if value == Value::default() {
            return None;
        }

        // Find what panes and media on the way let through.
        let ray = surface.shadow_ray(light.wi, light.target);
        let crosses = wi.z < 0.0;
        let medium = medium.after(surface, crosses);
        // Light from infinity that reaches a point inside a body came through an opening in it. Its distance inside is unknown, as it is
        // for a sampled direction, so nothing is absorbed.
        let absorbed = if light.target.is_some() { medium.transmittance(ray.t_max) } else { Rgb::WHITE };
        let (through, window) = match scattered {
            true if self.scene.is_covered(&ray) => (Rgb::BLACK, None),
            true => (Rgb::WHITE, None),
            false if self.config.fixtures && light.kind() == LightKind::Environment => self.transmittance_and_window(&ray),
            false => (self.scene.unbent_transmittance(&ray), None),
        };
        let arriving = through * absorbed;
        let seen = if !arriving.is_black() {
            // Weight the sample against the BSDF's own chance to find the light.
            let weight = if light.is_delta { 1.0 } else { power_heuristic(light.pdf, pdf) } / light.pdf;
            let radiance = self.scene.lights.radiance_of(self.scene, &light, &surface.cone.scattered(pdf), u[3]);
            let from = Origin { kind: light.kind(), fixture: self.fixture(|| self.scene.told_apart().of_sample(&light, window)) };
            Some(Direct { weight: value * weight, light: radiance * arriving, from, crosses, scattered })
        } else if self.scene.bodies.any && !scattered {
            self.scene.connect(surface, medium, &light).and_then(|way| self.light_through_glass(vertex, &light, &way))
        } else {
            None
        };

        // Lights with a surface are found behind other glass than panes by sampled directions.
        let bends = light.is_delta && !scattered && self.scene.bodies.any && (seen.is_none() || self.scene.bodies.are_curved());
        let bent = bends.then(|| {
            let number = hash_u64(u64::from(u[0].to_bits()) << 32 ^ u64::from(u[1].to_bits())) ^ u64::from(u[3].to_bits());
            let way = self.scene.connect_bent(surface, medium, &light, seen.is_none(), Rng::new(number))?;
            self.light_through_glass(vertex, &light, &way)
        });
        Some((seen, bent.flatten()))
    }

    /// Direct light by a light sample that arrives through solid glass.
    fn light_through_glass(&self, vertex: &Vertex<'_, 's>, light: &LightSample, way: &Connection) -> Option<Direct> {
        // Find what the surface makes of light from there.
        let (scene, surface) = (self.scene, &vertex.surface);
        let wi = vertex.onb.to_local(way.wi);
        if !sides_agree(wi.z, way.wi.dot(surface.ng)) {
            return None;
        }
        let (value, pdf) = vertex.eval_pdf(wi, way.wi);
        if value == Value::default() {
            return None;
        }

        // The weight is for the straight direction to the light, which sampled directions use too.
        let weight = if light.is_delta { 1.0 } else { power_heuristic(light.pdf, pdf) } / light.pdf;
        let radiance = match light.target {
            // A light at a point is where its light seems to come from, by how it is spread.
            Some(target) if light.is_delta => scene.lights.point_light_at(light, target - way.arrives / way.spread.sqrt())?,
            // A point of a surface was sampled by its area, which the straight way saw at another angle and distance.
            Some(target) => {
                let [straight, bent] = [light.wi, way.arrives].map(|direction| direction.dot(light.normal).abs());
                let ratio = way.spread * surface.p.distance_squared(target) * bent / straight.max(f32::MIN_POSITIVE);
                scene.lights.radiance_of(scene, light, &surface.cone, 0.0) * ratio
            }
            None => scene.lights.radiance_of(scene, light, &surface.cone, 0.0) * way.spread,
        };
        let window = self.fixture(|| way.passed.last_named(|part| scene.told_apart().of_pane(part)));
        let from = Origin { kind: light.kind(), fixture: self.fixture(|| scene.told_apart().of_sample(light, window)) };
        Some(Direct { weight: value * (weight * way.ways), light: radiance * way.through, from, crosses: wi.z < 0.0, scattered: false })
    }

    /// Irradiance over π at a surface without diffuse reflectance, by a white Lambert surface in its place.
    pub fn irradiance(&self, surface: &Surface<'s>, sampler: &Sampler) -> Rgb {
        let vertex = Vertex::new(self.guide, surface.clone(), Bsdf::lambert(Rgb::WHITE));
        let direct = self.sample_lights(&vertex, 0, sampler, Medium::AIR);
        let mut irradiance = direct.fold(Rgb::BLACK, |sum, direct| sum + direct.weight.diffuse * direct.light);
        let u = sampler.set(bsdf_set(0));
        let nowhere = Segment::from_camera(Ray::new(surface.p, -surface.wo), Cone::POINT);
        if let Some((weight, segment)) = vertex.scatter([u[0], u[1], u[2]], &nowhere) {
            irradiance += weight.diffuse * self.radiance(segment, 1, true, Rgb::WHITE, vertex.expected(), sampler).total;
        }
        irradiance
    }
}
