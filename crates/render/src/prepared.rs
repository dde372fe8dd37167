//! A scene made ready for rays: world triangles, hierarchy, lights, coat tables.

use crate::bsdf::{TableMaker, Tables};
use crate::error::RenderError;
use crate::light::Lights;
use crate::texture::{Cone, Footprint, Textures};
use crate::triangles::Triangles;
use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Bounds3, Ray, Rgb, hash_u32};
use enfilade_scene::{Alpha, Cx, Material, Scene};
use std::cell::Cell;

/// A scene ready to be rendered.
pub struct RenderScene<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) textures: Textures<'s>,
    pub(crate) triangles: Triangles<'s>,
    pub(crate) bvh: Bvh,
    pub(crate) lights: Lights<'s>,
    /// Of each material.
    pub(crate) tables: Vec<Tables>,
    /// True when some surfaces are half transparent, so that rays pass them by chance.
    pub(crate) has_veils: bool,
}

impl<'s> RenderScene<'s> {
    /// Builds everything that rays need. About two CPU seconds per million triangles.
    ///
    /// # Errors
    /// When the scene has more parts than ids, or no light.
    pub fn new(scene: &'s Scene, cx: &dyn Cx) -> Result<Self, RenderError> {
        Self::check_parts(scene)?;
        cx.progress("building the ray-tracing hierarchy", 0, 1);
        let ready = Self::of(Triangles::new(scene))?;
        cx.progress("building the ray-tracing hierarchy", 1, 1);
        Ok(ready)
    }

    pub(crate) fn of(triangles: Triangles<'s>) -> Result<Self, RenderError> {
        let scene = triangles.scene();
        let bvh = triangles.hierarchy(asks_filter);
        let mut maker = TableMaker::default();
        let tables = scene.materials.iter().map(|m| maker.tables(&m.bsdf)).collect();
        let lights = Lights::new(scene, &triangles);
        if lights.is_empty() {
            return Err(RenderError::NoLight);
        }
        let textures = Textures::new(&scene.images, &scene.materials);
        let has_veils = scene.materials.iter().any(|m| matches!(m.alpha, Alpha::Blend { .. }));
        Ok(Self { scene, textures, triangles, bvh, lights, tables, has_veils })
    }

    /// Every part needs an id.
    pub(crate) fn check_parts(scene: &Scene) -> Result<(), RenderError> {
        let found = scene.parts.len();
        if found > i16::MAX as usize { Err(RenderError::TooManyParts { found }) } else { Ok(()) }
    }

    /// The smallest box around the scene.
    pub fn bounds(&self) -> Bounds3 {
        self.triangles.bounds()
    }

    /// Number of triangles in world space.
    pub fn triangle_count(&self) -> usize {
        self.triangles.count()
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
            let surface = self.surface(hit, ray.direction, &Cone::POINT);
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

    /// True when nothing at all lies along a ray, not even a pane or something half transparent.
    #[inline]
    pub(crate) fn is_clear(&self, ray: &Ray) -> bool {
        !self.bvh.occluded_filtered(ray, |hit| match self.material_at(hit).alpha {
            Alpha::Mask { .. } => self.is_present(hit, Cutout::Half),
            _ => true,
        })
    }

    fn material_at(&self, hit: &Hit) -> &'s Material {
        &self.scene.materials[self.triangles.material(hit.triangle) as usize]
    }

    /// Whether the surface exists at a hit, given its cut-outs.
    pub(crate) fn is_present(&self, hit: &Hit, cut: Cutout) -> bool {
        let opacity = |p| self.textures.scalar(p, self.triangles.get(hit.triangle).uv(hit.weights()), &Footprint::POINT);
        match &self.material_at(hit).alpha {
            Alpha::Opaque => true,
            Alpha::Mask { opacity: p, cutoff } => opacity(p) >= *cutoff,
            Alpha::Blend { opacity: p } => match cut {
                Cutout::Half => opacity(p) >= 0.5,
                // Independent between rays, because no two hit at the same place; the same for the same ray.
                Cutout::Random => {
                    let h = hash_u32(hit.triangle ^ hash_u32(hit.u.to_bits() ^ hash_u32(hit.v.to_bits() ^ hit.t.to_bits())));
                    opacity(p) > (h >> 8) as f32 * (1.0 / 16_777_216.0)
                }
            },
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
    material.bsdf.is_pane() || material.alpha != Alpha::Opaque
}
