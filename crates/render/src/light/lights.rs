//! The light sources of a scene, collected once: their list, and how strong each is, regardless of occlusion.

use super::delta;
use super::emissive_surfaces::EmissiveSurfaces;
use super::environment::Sky;
use super::glint::Glints;
use super::sample::{Background, LightPoint};
use super::tree::LightTree;
use super::window::Windows;
use crate::triangles::Triangles;
use enfilade_math::{Distribution1, Rgb, Vec3};
use enfilade_scene::{Light, Scene};

/// The most clusters of point lights and patches of emissive surfaces.
const MAX_CLUSTERS: usize = 40;
/// Clusters smaller than this fraction of the scene's diagonal are not divided: a lamp is one source.
const SMALLEST_CLUSTER: f32 = 0.03;
/// Beyond this many distant lights all of them count as one source, within which they are chosen by strength.
pub(super) const MAX_DISTANT: usize = 16;

/// The light sources of a scene. The default has none.
#[derive(Debug, Default)]
pub(crate) struct Lights<'s> {
    pub(super) surfaces: EmissiveSurfaces,
    /// Point lights; in the tree their numbers follow the numbers of the patches.
    pub(super) points: Vec<Light>,
    pub(super) tree: LightTree,
    /// Nodes of the tree that are clusters; the first of the sources.
    pub(super) clusters: Vec<u32>,
    /// Cluster of each emitter of the tree, `u32::MAX` for those without power.
    pub(super) cluster_of_emitter: Vec<u32>,
    /// Distant lights, and a distribution over them by their strength.
    pub(super) distant: Vec<Light>,
    pub(super) distant_by_strength: Option<Distribution1>,
    /// Sunlit glossy surfaces; found when the scene is ready for rays.
    pub(super) glints: Glints,
    pub(super) sky: Option<Sky<'s>>,
}

/// A source that light sampling can choose.
#[derive(Clone, Copy)]
pub(super) enum Source {
    /// A cluster of the light hierarchy.
    Cluster(usize),
    /// A distant light; `None` for all of them together.
    Distant(Option<usize>),
    /// A cluster of sunlit glossy surfaces.
    Glint(usize),
    /// The environment, in all directions.
    Sky,
    /// The environment through a portal in a window.
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
        let glints = Glints::default();
        Self { surfaces, points, tree, clusters, cluster_of_emitter, distant, distant_by_strength, glints, sky }
    }

    /// True when there is no source at all.
    pub fn is_empty(&self) -> bool {
        self.source_count(0) == 0
    }

    /// Number of sources with this number of portals. Clusters come first, then distant lights, glints, the sky, the portals.
    pub(super) fn source_count(&self, portals: usize) -> usize {
        self.sky_source() + if self.sky.is_some() { 1 + portals } else { 0 }
    }

    /// Number of the source that is the sky.
    #[inline]
    pub(super) fn sky_source(&self) -> usize {
        self.first_glint() + self.glints.len()
    }

    /// Number of the first source that is a cluster of glints.
    #[inline]
    pub(super) fn first_glint(&self) -> usize {
        self.clusters.len() + if self.distant.len() > MAX_DISTANT { 1 } else { self.distant.len() }
    }

    /// Source number `index`.
    #[inline]
    pub(super) fn source(&self, index: usize) -> Source {
        let (glint, sky) = (self.first_glint(), self.sky_source());
        if index < self.clusters.len() {
            Source::Cluster(index)
        } else if index < glint {
            Source::Distant((self.distant.len() <= MAX_DISTANT).then_some(index - self.clusters.len()))
        } else if index < sky {
            Source::Glint(index - glint)
        } else if index == sky {
            Source::Sky
        } else {
            Source::Portal(index - sky - 1)
        }
    }

    /// About the irradiance that a source could cast on a point if nothing were in the way.
    pub(super) fn prior(&self, source: usize, windows: Option<&Windows>, at: &LightPoint) -> f32 {
        let sky = || self.sky.as_ref().map_or(0.0, Sky::irradiance);
        match self.source(source) {
            Source::Cluster(cluster) => self.tree.importance(self.clusters[cluster], at),
            Source::Distant(Some(one)) => distant_strength(&self.distant[one]),
            Source::Distant(None) => self.distant_by_strength.as_ref().map_or(0.0, |d| d.total() as f32),
            Source::Glint(cluster) => self.glints.importance(cluster, at),
            // In a room little of its light arrives but through the windows, which are sources of their own.
            Source::Sky => sky() * if windows.is_some() { 0.02 } else { 1.0 },
            Source::Portal(portal) => windows.map_or(0.0, |w| sky() * w.solid_angle(portal, at.p) * std::f32::consts::FRAC_1_PI),
        }
    }

    /// Radiance of the environment in the unit direction `d`.
    pub(super) fn sky(&self, d: Vec3) -> Rgb {
        self.sky.as_ref().map_or(Rgb::BLACK, |sky| sky.radiance(d))
    }

    /// Radiance from beyond the scene in the unit direction `d`.
    pub fn background(&self, d: Vec3) -> Background {
        let distant = self.distant.iter().filter_map(|light| delta::disk(light, d)).map(|(radiance, _)| radiance).sum();
        Background { environment: self.sky(d), distant }
    }
}

/// Luminance of the irradiance of a distant light; 0 for others.
fn distant_strength(light: &Light) -> f32 {
    if let Light::Directional { irradiance, .. } = light { irradiance.luminance() } else { 0.0 }
}
