//! A scene made ready for rays: world triangles, hierarchy, lights, coat tables.

use crate::bsdf::coat::{Bounces, CoatSpec, CoatTable};
use crate::error::RenderError;
use crate::light::Lights;
use crate::triangle::{self, Triangle};
use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Bounds3, Ray, Rgb, hash_u32};
use enfilade_scene::{Alpha, Bsdf, Cx, Material, Scene, WorldMesh};
use rayon::prelude::*;
use std::cell::Cell;

/// A scene ready to be rendered.
pub struct RenderScene<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) bvh: Bvh,
    bounds: Bounds3,
    pub(crate) lights: Lights<'s>,
    /// Per material: its coat, if it has a diffuse base under a dielectric.
    pub(crate) coats: Vec<Option<usize>>,
    pub(crate) coat_tables: Vec<CoatTable>,
}

impl<'s> RenderScene<'s> {
    /// Builds everything that rays need. Costs about a microsecond per triangle.
    ///
    /// # Errors
    /// When the scene has more parts than ids, or no light.
    pub fn new(scene: &'s Scene, cx: &dyn Cx) -> Result<Self, RenderError> {
        if scene.parts.len() > i16::MAX as usize {
            return Err(RenderError::TooManyParts { found: scene.parts.len() });
        }
        cx.progress("building the ray-tracing hierarchy", 0, 1);
        let world = WorldMesh::new(scene);
        let triangles = triangle::gather(scene, &world);
        let filtered: Vec<bool> = scene.materials.iter().map(asks_filter).collect();
        let bvh = Bvh::new(&world.corners, &|t| filtered[triangles[t as usize].material as usize]);
        let (coats, coat_tables) = coat_tables(&scene.materials);
        let lights = Lights::new(scene, &triangles);
        if lights.is_empty() {
            return Err(RenderError::NoLight);
        }
        cx.progress("building the ray-tracing hierarchy", 1, 1);
        Ok(Self { scene, triangles, bvh, bounds: world.bounds, lights, coats, coat_tables })
    }

    /// The smallest box around the scene.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Number of triangles in world space.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The nearest surface that is there, cut-outs considered. `cut` says how partial opacity is decided.
    #[inline]
    pub(crate) fn closest(&self, ray: &Ray, cut: Cutout) -> Option<Hit> {
        self.bvh.closest_filtered(ray, |hit| self.is_present(hit, cut))
    }

    /// Share of light that gets through along a shadow ray: 0 when something opaque is in the way; thin panes dim it.
    #[inline]
    pub(crate) fn transmittance(&self, ray: &Ray) -> Rgb {
        let through = Cell::new(Rgb::WHITE);
        let blocked = self.bvh.occluded_filtered(ray, |hit| {
            if !self.is_present(hit, Cutout::Random) {
                return false;
            }
            let surface = self.surface(hit, ray.direction);
            match surface.straight_transmittance(self) {
                Some(t) if !t.is_black() => {
                    through.set(through.get() * t);
                    false
                }
                _ => true,
            }
        });
        if blocked { Rgb::BLACK } else { through.get() }
    }

    /// Whether the surface exists at a hit, given its cut-outs.
    pub(crate) fn is_present(&self, hit: &Hit, cut: Cutout) -> bool {
        let triangle = &self.triangles[hit.triangle as usize];
        let material = &self.scene.materials[triangle.material as usize];
        let opacity = |p| crate::surface::scalar_at(self.scene, p, triangle.uv(hit.weights()));
        match &material.alpha {
            Alpha::Opaque => true,
            Alpha::Mask { opacity: p, cutoff } => opacity(p) >= *cutoff,
            Alpha::Blend { opacity: p } => {
                let threshold = match cut {
                    Cutout::Half => 0.5,
                    // Independent between rays, because no two hit at the same place; the same for the same ray.
                    Cutout::Random => {
                        let h = hash_u32(hit.triangle ^ hash_u32(hit.u.to_bits() ^ hash_u32(hit.v.to_bits() ^ hit.t.to_bits())));
                        (h >> 8) as f32 * (1.0 / 16_777_216.0)
                    }
                };
                opacity(p) > threshold
            }
        }
    }
}

/// How partial opacity is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cutout {
    /// Present with probability equal to the opacity: for light.
    Random,
    /// Present from one half on: for geometry layers.
    Half,
}

/// Whether rays must ask before they accept a hit on this material.
fn asks_filter(material: &Material) -> bool {
    let pane = match &material.bsdf {
        Bsdf::ThinDielectric { .. } => true,
        Bsdf::Principled(p) => !p.solid && p.transmission.factor > 0.0,
        _ => false,
    };
    pane || material.alpha != Alpha::Opaque
}

/// One table per distinct coat, and which table each material uses.
fn coat_tables(materials: &[Material]) -> (Vec<Option<usize>>, Vec<CoatTable>) {
    let coats: Vec<_> = materials.iter().map(coat).collect();
    let mut distinct: Vec<CoatSpec> = Vec::new();
    let indices = coats
        .iter()
        .map(|coat| {
            let coat = (*coat)?;
            Some(distinct.iter().position(|d| *d == coat).unwrap_or_else(|| {
                distinct.push(coat);
                distinct.len() - 1
            }))
        })
        .collect();
    (indices, distinct.into_par_iter().map(CoatTable::new).collect())
}

/// A material's coat; an index of one or less is none.
fn coat(material: &Material) -> Option<CoatSpec> {
    let spec = match &material.bsdf {
        Bsdf::Plastic { eta, alpha, .. } => {
            CoatSpec { eta: *eta, alpha: alpha.texture.is_none().then_some(alpha.factor), bounces: Bounces::Single }
        }
        Bsdf::Principled(p) => {
            let alpha = p.roughness.texture.is_none().then(|| p.roughness.factor.clamp(0.0, 1.0).powi(2));
            CoatSpec { eta: p.ior, alpha, bounces: Bounces::All }
        }
        _ => return None,
    };
    (spec.eta > 1.0).then_some(spec)
}
