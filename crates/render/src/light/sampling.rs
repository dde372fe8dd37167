//! Sampling of a scene's lights, and the densities with which every source can be found: the `sample`/`pdf` pair of all lights.

use super::choice::LightChoice;
use super::delta;
use super::emitter::Emission;
use super::lights::{Lights, MAX_DISTANT, Source};
use super::sample::{Background, LightPoint, LightSample, power_heuristic};
use super::window::Windows;
use crate::prepared::{AlphaTest, RenderScene};
use crate::texture::{Cone, Footprint};
use enfilade_geometry::Hit;
use enfilade_math::{Rgb, Vec3, offset_origin};
use enfilade_scene::Alpha;

impl Lights<'_> {
    /// Samples light arriving at a point, before any shadow. `u` is uniform on [0,1)³. `None` when the sampled light sends
    /// nothing, or from a direction that is not `wanted`.
    pub fn sample(
        &self,
        scene: &RenderScene<'_>,
        choice: &LightChoice,
        at: &LightPoint,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        let row = choice.row(at);
        let (source, _, renewed) = row.sample(u[2]);
        let sample = self.sample_one(scene, source, choice.windows(), at, [u[0], u[1], renewed], wanted, |s| row.probability(s))?;
        (sample.pdf > 0.0).then_some(sample)
    }

    /// Samples light of the source number `index`; the density is summed over all sources that can find it, each with its `probability`:
    /// the sky itself and a portal find the same light.
    pub(super) fn sample_one(
        &self,
        scene: &RenderScene<'_>,
        index: usize,
        windows: Option<&Windows>,
        at: &LightPoint,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
        probability: impl Fn(usize) -> f32,
    ) -> Option<LightSample> {
        let source = self.source(index);
        let mut sample = self.sample_source(scene, source, windows, at, u, wanted)?;
        sample.pdf *= probability(index);
        match (source, &self.sky, windows) {
            (Source::Portal(_), Some(sky), _) => sample.pdf += probability(self.sky_source()) * sky.pdf(sample.wi),
            (Source::Sky, _, Some(windows)) => sample.pdf += self.portal_pdf(windows, at, sample.wi, probability),
            _ => {}
        }
        Some(sample)
    }

    /// Samples light of one source; the density is given that source.
    pub(super) fn sample_source(
        &self,
        scene: &RenderScene<'_>,
        source: Source,
        windows: Option<&Windows>,
        at: &LightPoint,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        let from_sky = |wi: Vec3, pdf: f32| (pdf > 0.0 && wanted(wi)).then_some(LightSample::new(wi, None, None, pdf));
        match source {
            // Choose an emitter of the cluster by its importance to the point, and sample that.
            Source::Cluster(cluster) => {
                let (emitter, pmf, _) = self.tree.sample(self.clusters[cluster], at, u[2])?;
                let emitter = emitter as usize;
                let mut sample = match emitter.checked_sub(self.surfaces.patches.len()) {
                    Some(point) => delta::sample(&self.points[point], at, [u[0], u[1]]).filter(|s| wanted(s.wi))?,
                    None => self.sample_patch(scene, emitter, at, [u[0], u[1]], wanted)?,
                };
                sample.pdf *= pmf;
                sample.emitter = Some(emitter as u32);
                Some(sample)
            }
            // Choose a distant light, where they count as one, and sample its direction.
            Source::Distant(one) => {
                let (light, pmf) = match one {
                    Some(one) => (one, 1.0),
                    None => self.distant_by_strength.as_ref().map(|d| d.sample(u[2])).map(|(light, pmf, _)| (light, pmf))?,
                };
                let sample = delta::sample(&self.distant[light], at, [u[0], u[1]]).filter(|s| wanted(s.wi))?;
                Some(LightSample { pdf: sample.pdf * pmf, ..sample })
            }
            // Sample a place of the cluster's sunlit surfaces.
            Source::Glint(cluster) => self.glints.sample(scene, cluster, at, u).filter(|s| wanted(s.wi)),
            // Sample a point of the portal; the sky is seen through it.
            Source::Portal(portal) => {
                let wi = windows?.sample(portal, at.p, [u[0], u[1]])?;
                from_sky(wi, windows?.find_portal(at.p, wi).map_or(0.0, |(_, pdf)| pdf))
            }
            // Sample the sky by its brightness.
            Source::Sky => {
                let (wi, pdf) = self.sky.as_ref()?.sample([u[0], u[1]])?;
                from_sky(wi, pdf)
            }
        }
    }

    fn sample_patch(
        &self,
        scene: &RenderScene<'_>,
        patch: usize,
        at: &LightPoint,
        u: [f32; 2],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        let patch = &self.surfaces.patches[patch];
        let point = patch.sample(at.p, u)?;
        if !wanted(point.wi) {
            return None;
        }
        if let Emission::Even { radiance, two_sided } = patch.emission() {
            let behind = point.wi.dot(patch.normal()) >= 0.0;
            let target = Some(offset_origin(point.q, if behind { -patch.normal() } else { patch.normal() }));
            let sample = LightSample::new(point.wi, target, Some(radiance), point.pdf);
            return (two_sided || !behind).then_some(LightSample { normal: patch.normal(), ..sample });
        }
        let (triangle, [b, c]) = patch.locate(point.q, |number| scene.triangles.get(number).corners);
        let hit = Hit { t: point.distance, triangle, u: b, v: c };
        let surface = scene.surface(&hit, point.wi, &Cone::POINT);
        let mut radiance = surface.emission(scene);
        match surface.material.alpha {
            Alpha::Opaque => {}
            Alpha::Mask { .. } => radiance *= if scene.is_present(&hit, AlphaTest::Half) { 1.0 } else { 0.0 },
            Alpha::Blend { opacity } => radiance *= scene.textures.scalar(&opacity, surface.uv, &Footprint::POINT).clamp(0.0, 1.0),
        }
        if radiance.is_black() {
            return None;
        }
        let target = Some(offset_origin(point.q, surface.ng));
        Some(LightSample { normal: surface.ng, ..LightSample::new(point.wi, target, Some(radiance), point.pdf) })
    }

    /// The radiance of a sample of a point light as it arrives at another place `p`; `None` for other samples.
    pub fn point_light_at(&self, sample: &LightSample, p: Vec3) -> Option<Rgb> {
        let point = (sample.emitter? as usize).checked_sub(self.surfaces.patches.len())?;
        delta::sample(&self.points[point], &LightPoint { p, n: Vec3::ZERO }, [0.0; 2])?.radiance
    }

    /// Density per solid angle with which [`Lights::sample`] at `from` finds the emissive surface at `hit`, at the position `p` and in the
    /// unit direction `wi`.
    pub fn surface_pdf(&self, scene: &RenderScene<'_>, choice: &LightChoice, from: &LightPoint, wi: Vec3, hit: &Hit, p: Vec3) -> f32 {
        let Some(patch) = self.surfaces.patch_at(&scene.triangles, hit.triangle, [hit.u, hit.v]) else { return 0.0 };
        let cluster = self.cluster_of_emitter[patch as usize] as usize;
        let Some(&node) = self.clusters.get(cluster) else { return 0.0 };
        let pmf = choice.row(from).probability(cluster) * self.tree.pmf(node, from, patch);
        if pmf > 0.0 { pmf * self.surfaces.patches[patch as usize].pdf(from.p, wi, from.p.distance(p)) } else { 0.0 }
    }

    /// Weight by the power heuristic of the emission met at `hit`, as in [`Lights::surface_pdf`]; `sampled` as in
    /// [`Lights::background_weighted`].
    pub fn surface_weight(
        &self,
        scene: &RenderScene<'_>,
        choice: &LightChoice,
        sampled: Option<&(LightPoint, f32)>,
        wi: Vec3,
        hit: &Hit,
        p: Vec3,
    ) -> f32 {
        sampled.map_or(1.0, |(from, pdf)| power_heuristic(*pdf, self.surface_pdf(scene, choice, from, wi, hit, p)))
    }

    /// Density per solid angle with which [`Lights::sample`] finds the environment in the unit direction `d`: the sky itself and
    /// the portal there may choose it.
    fn environment_pdf(&self, choice: &LightChoice, at: &LightPoint, d: Vec3) -> f32 {
        let Some(sky) = &self.sky else { return 0.0 };
        let row = choice.row(at);
        let through = choice.windows().map_or(0.0, |windows| self.portal_pdf(windows, at, d, |s| row.probability(s)));
        row.probability(self.sky_source()) * sky.pdf(d) + through
    }

    /// The part of the portals in [`Lights::environment_pdf`], each source having its `probability`.
    fn portal_pdf(&self, windows: &Windows, at: &LightPoint, d: Vec3, probability: impl Fn(usize) -> f32) -> f32 {
        windows.find_portal(at.p, d).map_or(0.0, |(portal, pdf)| probability(self.sky_source() + 1 + portal) * pdf)
    }

    /// [`Lights::background`], each source weighted against its light samples by the power heuristic. `sampled` says where the
    /// direction was sampled and with which density; `None` is for directions in which light sampling has no part.
    pub fn background_weighted(&self, choice: &LightChoice, sampled: Option<&(LightPoint, f32)>, d: Vec3) -> Background {
        let Some(&(ref from, pdf)) = sampled else { return self.background(d) };
        let mut background = Background::default();
        if let Some(sky) = &self.sky {
            background.environment = sky.radiance(d) * power_heuristic(pdf, self.environment_pdf(choice, from, d));
        }
        for (index, light) in self.distant.iter().enumerate() {
            let Some((disk, disk_pdf)) = delta::disk(light, d) else { continue };
            let row = choice.row(from);
            let probability = if self.distant.len() > MAX_DISTANT {
                row.probability(self.clusters.len()) * self.distant_by_strength.as_ref().map_or(0.0, |d| d.pmf(index))
            } else {
                row.probability(self.clusters.len() + index)
            };
            background.distant += disk * power_heuristic(pdf, disk_pdf * probability);
        }
        background
    }
}
