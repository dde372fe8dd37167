//! All light sources of a scene, behind one `sample`/`pdf` pair.
//!
//! Emissive surfaces, cut into patches, and lights at a point are the leaves of a hierarchy ([`tree`]). Its upper end, a few
//! dozen clusters, is what [`LightChoice`] chooses from, together with each light from far away, the sky, and portals in the
//! windows through which it is seen: it has learned where the light of each *source* arrives. Within a cluster the hierarchy goes by distance, power and orientation.

mod bounds;
mod choice;
mod delta;
mod emitter;
mod environment;
mod gather;
mod learn;
mod spherical;
#[cfg(test)]
mod tests;
mod tree;
mod window;

pub(crate) use choice::LightChoice;

use crate::prepared::{Cutout, RenderScene};
use crate::surface::Surface;
use crate::triangles::Triangles;
use emitter::Emission;
use enfilade_geometry::Hit;
use enfilade_math::{Distribution1, Rgb, Vec3, offset_origin};
use enfilade_scene::{Alpha, Light, Scene};
use environment::Sky;
use gather::EmissiveSurfaces;
use tree::LightTree;
use window::Windows;

/// The most clusters of emitters at points and on surfaces.
const MAX_CLUSTERS: usize = 40;
/// Clusters smaller than this share of the scene's diagonal are not divided: a lamp is one source.
const SMALLEST_CLUSTER: f32 = 0.03;
/// Beyond this many lights from far away all of them count as one source, within which they are chosen by strength.
const MAX_DISTANT: usize = 16;

/// Where light is sampled from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightPoint {
    /// World position.
    pub p: Vec3,
    /// Unit shading normal of a surface that light reaches from its side only; zero where light may come from anywhere.
    pub n: Vec3,
}

impl LightPoint {
    /// A point of a surface.
    #[inline]
    pub fn on(surface: &Surface<'_>) -> Self {
        Self { p: surface.p, n: if surface.material.bsdf.transmits() { Vec3::ZERO } else { surface.ns } }
    }
}

/// Light arriving at a point from a sampled direction.
pub(crate) struct LightSample {
    /// Unit direction to the light.
    pub wi: Vec3,
    /// Where the shadow ray ends, moved off the emitter's surface; `None` for infinitely far lights.
    pub target: Option<Vec3>,
    /// Radiance (finite lights) or radiance × density (delta lights, whose `pdf` is then only the choice's probability).
    /// `None` for the environment, which is looked up once it is known to be seen: see [`Lights::radiance_of`].
    pub radiance: Option<Rgb>,
    /// Density per solid angle, choice included.
    pub pdf: f32,
    /// True when no other technique can find this light.
    pub is_delta: bool,
}

/// Kinds of sources, as light is split by them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightKind {
    Environment,
    Distant,
    Surfaces,
    Points,
}

impl LightSample {
    /// What the light comes from.
    #[inline]
    pub fn kind(&self) -> LightKind {
        match (self.target, self.radiance) {
            (None, None) => LightKind::Environment,
            (None, Some(_)) => LightKind::Distant,
            (Some(_), _) if self.is_delta => LightKind::Points,
            (Some(_), _) => LightKind::Surfaces,
        }
    }
}

/// Radiance from beyond the scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Background {
    /// Of the sky.
    pub environment: Rgb,
    /// Of the disks of lights from far away.
    pub distant: Rgb,
}

impl Background {
    /// Of all.
    #[inline]
    pub fn total(&self) -> Rgb {
        self.environment + self.distant
    }
}

/// The light sources of a scene. The default has none.
#[derive(Debug, Default)]
pub(crate) struct Lights<'s> {
    surfaces: EmissiveSurfaces,
    /// Lights at points; emitters of the tree after the patches.
    points: Vec<Light>,
    tree: LightTree,
    /// Nodes of the tree, the first of the sources.
    clusters: Vec<u32>,
    cluster_of_emitter: Vec<u32>,
    /// Lights from far away and their strengths.
    distant: Vec<Light>,
    distant_by_strength: Option<Distribution1>,
    sky: Option<Sky<'s>>,
}

/// What a number among the sources stands for.
#[derive(Clone, Copy)]
enum Source {
    Cluster(usize),
    /// `None` for all of them together.
    Distant(Option<usize>),
    Sky,
    Portal(usize),
}

impl<'s> Lights<'s> {
    /// Collects every source.
    pub fn new(scene: &'s Scene, triangles: &Triangles<'_>) -> Self {
        let surfaces = EmissiveSurfaces::new(scene, triangles);
        let mut emitters = surfaces.bounds.clone();
        let (mut points, mut distant) = (Vec::new(), Vec::new());
        for light in &scene.lights {
            match delta::light_bounds(light) {
                Some(bounds) => {
                    emitters.push(bounds);
                    points.push(light.clone());
                }
                None if distant_strength(light) > 0.0 => distant.push(light.clone()),
                None => {}
            }
        }
        let tree = LightTree::new(&emitters);
        let diagonal = triangles.bounds().extent().length();
        let clusters = tree.cut(MAX_CLUSTERS, SMALLEST_CLUSTER * diagonal);
        let cluster_of_emitter = tree.cluster_of_emitter(&clusters);
        let strengths: Vec<f32> = distant.iter().map(distant_strength).collect();
        let sky = scene.environment.as_ref().and_then(|e| Sky::new(e, &scene.images));
        let distant_by_strength = Distribution1::new(&strengths);
        Self { surfaces, points, tree, clusters, cluster_of_emitter, distant, distant_by_strength, sky }
    }

    /// True when there is no source at all.
    pub fn is_empty(&self) -> bool {
        self.source_count(0) == 0
    }

    /// Number of sources, of which `portals` are windows. Clusters come first, then lights from far away, the sky, the portals.
    fn source_count(&self, portals: usize) -> usize {
        self.sky_source() + if self.sky.is_some() { 1 + portals } else { 0 }
    }

    fn sky_source(&self) -> usize {
        self.clusters.len() + if self.distant.len() > MAX_DISTANT { 1 } else { self.distant.len() }
    }

    fn source(&self, index: usize) -> Source {
        let sky = self.sky_source();
        if index < self.clusters.len() {
            Source::Cluster(index)
        } else if index < sky {
            Source::Distant((self.distant.len() <= MAX_DISTANT).then_some(index - self.clusters.len()))
        } else if index == sky {
            Source::Sky
        } else {
            Source::Portal(index - sky - 1)
        }
    }

    /// About the irradiance that a source could cast on a point, unoccluded.
    fn prior(&self, source: usize, windows: Option<&Windows>, at: &LightPoint) -> f32 {
        let sky = || self.sky.as_ref().map_or(0.0, Sky::irradiance);
        match self.source(source) {
            Source::Cluster(cluster) => self.tree.importance(self.clusters[cluster], at),
            Source::Distant(Some(one)) => distant_strength(&self.distant[one]),
            Source::Distant(None) => self.distant_by_strength.as_ref().map_or(0.0, |d| d.total() as f32),
            // In a room there is little of it besides what comes through the windows.
            Source::Sky => sky() * if windows.is_some() { 0.02 } else { 1.0 },
            Source::Portal(portal) => windows.map_or(0.0, |w| sky() * w.solid_angle(portal, at.p) * std::f32::consts::FRAC_1_PI),
        }
    }

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

    /// Samples light of the source number `index`; the density is that of all sources that find it, of which each has its `share` of
    /// the samples: the sky itself and a portal find the same light.
    fn sample_one(
        &self,
        scene: &RenderScene<'_>,
        index: usize,
        windows: Option<&Windows>,
        at: &LightPoint,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
        share: impl Fn(usize) -> f32,
    ) -> Option<LightSample> {
        let source = self.source(index);
        let mut sample = self.sample_source(scene, source, windows, at, u, wanted)?;
        sample.pdf *= share(index);
        match (source, &self.sky, windows) {
            (Source::Portal(_), Some(sky), _) => sample.pdf += share(self.sky_source()) * sky.pdf(sample.wi),
            (Source::Sky, _, Some(windows)) => sample.pdf += self.portal_pdf(windows, at, sample.wi, share),
            _ => {}
        }
        Some(sample)
    }

    /// Samples light of one source; the density is given that source.
    fn sample_source(
        &self,
        scene: &RenderScene<'_>,
        source: Source,
        windows: Option<&Windows>,
        at: &LightPoint,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        let from_sky = |wi: Vec3, pdf: f32| {
            (pdf > 0.0 && wanted(wi)).then_some(LightSample { wi, target: None, radiance: None, pdf, is_delta: false })
        };
        match source {
            Source::Cluster(cluster) => {
                let (emitter, pmf, _) = self.tree.sample(self.clusters[cluster], at, u[2])?;
                let emitter = emitter as usize;
                let mut sample = match emitter.checked_sub(self.surfaces.patches.len()) {
                    Some(point) => delta::sample(&self.points[point], at, [u[0], u[1]]).filter(|s| wanted(s.wi))?,
                    None => self.sample_patch(scene, emitter, at, [u[0], u[1]], wanted)?,
                };
                sample.pdf *= pmf;
                Some(sample)
            }
            Source::Distant(one) => {
                let (light, pmf) = match one {
                    Some(one) => (one, 1.0),
                    None => self.distant_by_strength.as_ref().map(|d| d.sample(u[2])).map(|(light, pmf, _)| (light, pmf))?,
                };
                let sample = delta::sample(&self.distant[light], at, [u[0], u[1]]).filter(|s| wanted(s.wi))?;
                Some(LightSample { pdf: sample.pdf * pmf, ..sample })
            }
            Source::Portal(portal) => {
                let wi = windows?.sample(portal, at.p, [u[0], u[1]])?;
                from_sky(wi, windows?.find_portal(at.p, wi).map_or(0.0, |(_, pdf)| pdf))
            }
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
            let sample = LightSample { wi: point.wi, target, radiance: Some(radiance), pdf: point.pdf, is_delta: false };
            return (two_sided || !behind).then_some(sample);
        }
        let (triangle, [b, c]) = patch.locate(point.q, |number| scene.triangles.get(number).corners);
        let hit = Hit { t: point.distance, triangle, u: b, v: c };
        let surface = scene.surface(&hit, point.wi, &crate::texture::Cone::POINT);
        let mut radiance = surface.emission(scene);
        match surface.material.alpha {
            Alpha::Opaque => {}
            Alpha::Mask { .. } => radiance *= if scene.is_present(&hit, Cutout::Half) { 1.0 } else { 0.0 },
            Alpha::Blend { opacity } => {
                radiance *= scene.textures.scalar(&opacity, surface.uv, &crate::texture::Footprint::POINT).clamp(0.0, 1.0)
            }
        }
        if radiance.is_black() {
            return None;
        }
        let target = Some(offset_origin(point.q, surface.ng));
        Some(LightSample { wi: point.wi, target, radiance: Some(radiance), pdf: point.pdf, is_delta: false })
    }

    /// Density per solid angle with which [`Lights::sample`] at `from` finds the emissive surface at `hit`, whose place is `p`
    /// and which lies in the unit direction `wi`.
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

    /// The part of the portals in [`Lights::environment_pdf`], each source having its `share` of the samples.
    fn portal_pdf(&self, windows: &Windows, at: &LightPoint, d: Vec3, share: impl Fn(usize) -> f32) -> f32 {
        windows.find_portal(at.p, d).map_or(0.0, |(portal, pdf)| share(self.sky_source() + 1 + portal) * pdf)
    }

    /// Radiance of the environment in the unit direction `d`.
    fn sky(&self, d: Vec3) -> Rgb {
        self.sky.as_ref().map_or(Rgb::BLACK, |sky| sky.radiance(d))
    }

    /// The radiance of a sample.
    pub fn radiance_of(&self, sample: &LightSample) -> Rgb {
        sample.radiance.unwrap_or_else(|| self.sky(sample.wi))
    }

    /// Radiance from beyond the scene in the unit direction `d`.
    pub fn background(&self, d: Vec3) -> Background {
        let distant = self.distant.iter().filter_map(|light| delta::disk(light, d)).map(|(radiance, _)| radiance).sum();
        Background { environment: self.sky(d), distant }
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

/// Luminance of the irradiance of a light from far away.
fn distant_strength(light: &Light) -> f32 {
    if let Light::Directional { irradiance, .. } = light { irradiance.luminance() } else { 0.0 }
}

/// Weight of a sample of density `a` where another technique has density `b` (Veach 1997, β = 2).
#[inline]
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // In ratio form, so that large densities do not overflow when squared.
    if a <= 0.0 {
        return 0.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
