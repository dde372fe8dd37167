//! A scene made ready for rays: world triangles, ray-tracing hierarchy, lights, textures, and the tables of its materials.

use crate::bsdf::{TableMaker, Tables};
use crate::config::RenderConfig;
use crate::error::RenderError;
use crate::glass::Bodies;
use crate::light::{Fixture, Fixtures, Lights};
use crate::texture::{Cone, Footprint, Textures};
use crate::triangles::Triangles;
use enfilade_geometry::{Bvh, Hit};
use enfilade_math::{Bounds3, Ray, Rgb, hash_u32};
use enfilade_scene::{Alpha, Cx, Material, PartId, Scene};
use std::cell::Cell;
use std::sync::OnceLock;

/// A scene ready to be rendered. It borrows the [`Scene`], serves any number of cameras and settings, and never changes.
///
/// ```
/// # use enfilade_geometry::Mesh;
/// # use enfilade_math::{DAffine3, Rgb, Vec3};
/// use enfilade_render::{RenderError, RenderScene};
/// use enfilade_scene::{Environment, Material, Part, Quiet, Scene};
///
/// let triangle = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
/// let part = Part { name: "triangle".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
/// let materials = vec![Material::diffuse("grey", Rgb::splat(0.5))];
/// let mut scene = Scene { meshes: vec![triangle.into()], materials, parts: vec![part], ..Scene::default() };
/// assert_eq!(RenderScene::new(&scene, &Quiet).err(), Some(RenderError::NoLight));
///
/// scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
/// let prepared = RenderScene::new(&scene, &Quiet)?;
/// assert_eq!(prepared.triangle_count(), 1);
/// assert_eq!(prepared.bounds().extent(), Vec3::new(1.0, 1.0, 0.0));
/// # Ok::<(), RenderError>(())
/// ```
pub struct RenderScene<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) textures: Textures<'s>,
    pub(crate) triangles: Triangles<'s>,
    pub(crate) bvh: Bvh,
    pub(crate) lights: Lights<'s>,
    /// Lookup tables of each material's BSDF.
    pub(crate) tables: Vec<Tables>,
    pub(crate) bodies: Bodies,
    /// Found on first use.
    pub(crate) fixtures: OnceLock<Fixtures>,
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

    /// The scene with the changes of its materials by the settings: [`RenderConfig::lambertian`]. Frames need a scene that was settled by
    /// their settings.
    #[must_use]
    pub fn settled(mut self, config: &RenderConfig) -> Self {
        if config.lambertian {
            let mut maker = TableMaker::lambertian();
            self.tables = self.scene.materials.iter().map(|m| maker.tables(&m.bsdf)).collect();
        }
        self
    }

    pub(crate) fn of(triangles: Triangles<'s>) -> Result<Self, RenderError> {
        let scene = triangles.scene();
        let bvh = triangles.hierarchy(needs_filter);
        let mut maker = TableMaker::default();
        let tables = scene.materials.iter().map(|m| maker.tables(&m.bsdf)).collect();
        let lights = Lights::new(scene, &triangles);
        if lights.is_empty() {
            return Err(RenderError::NoLight);
        }
        let textures = Textures::new(&scene.images, &scene.materials);
        let bodies = Bodies::of(scene);
        let mut ready = Self { scene, textures, triangles, bvh, lights, tables, bodies, fixtures: OnceLock::new() };
        Lights::find_glints(&mut ready);
        Ok(ready)
    }

    /// Every part needs an id.
    pub(crate) fn check_parts(scene: &Scene) -> Result<(), RenderError> {
        let found = scene.parts.len();
        if found > i16::MAX as usize { Err(RenderError::TooManyParts { found }) } else { Ok(()) }
    }

    /// The smallest box around the scene, in metres of the world.
    pub fn bounds(&self) -> Bounds3 {
        self.triangles.bounds()
    }

    /// The fixtures of the scene, in the order in which frames store their light: see [`RenderConfig::fixtures`](crate::RenderConfig).
    pub fn fixtures(&self) -> &[Fixture] {
        &self.told_apart().list
    }

    /// Fixtures with what belongs to each.
    #[inline]
    pub(crate) fn told_apart(&self) -> &Fixtures {
        self.fixtures.get_or_init(|| Lights::find_fixtures(self))
    }

    /// Number of triangles in world space.
    pub fn triangle_count(&self) -> usize {
        self.triangles.count()
    }

    /// The nearest hit whose surface is present there by its opacity; `test` decides how partial opacity counts.
    #[inline]
    pub(crate) fn closest(&self, ray: &Ray, test: AlphaTest) -> Option<Hit> {
        self.bvh.closest_filtered(ray, |hit| self.is_present(hit, test))
    }

    /// Whether a ray meets any surface that is present by its opacity.
    #[inline]
    pub(crate) fn is_met(&self, ray: &Ray, test: AlphaTest) -> bool {
        self.bvh.occluded_filtered(ray, |hit| self.is_present(hit, test))
    }

    /// Fraction of light that gets through along a shadow ray: 0 when something opaque is in the way; thin panes and solid ones dim it.
    #[inline]
    pub(crate) fn transmittance(&self, ray: &Ray) -> Rgb {
        let through = self.unbent_transmittance(ray);
        if self.bodies.any && through.is_black() { self.through_panes(ray).0 } else { through }
    }

    /// Transmittance along the ray, and what `name` calls the farthest pane on the way that it has a name for, by its part.
    pub(crate) fn transmittance_and_pane<T: Copy>(&self, ray: &Ray, name: impl Fn(PartId) -> Option<T>) -> (Rgb, Option<T>) {
        let found = self.unbent_transmittance_and_pane(ray, &name);
        if !(self.bodies.any && found.0.is_black()) {
            return found;
        }
        let (through, passed) = self.through_panes(ray);
        (through, passed.last_named(name))
    }

    /// Fraction of light that gets through along a shadow ray where solid glass stops it, as everything does but thin panes.
    #[inline]
    pub(crate) fn unbent_transmittance(&self, ray: &Ray) -> Rgb {
        self.transmittance_of(ray, |_| ())
    }

    /// Transmittance along the ray, and what `name` calls the farthest pane on the way that it has a name for, by its part.
    #[inline]
    pub(crate) fn unbent_transmittance_and_pane<T: Copy>(&self, ray: &Ray, name: impl Fn(PartId) -> Option<T>) -> (Rgb, Option<T>) {
        let farthest = Cell::new((0.0, None));
        let through = self.transmittance_of(ray, |hit| {
            if hit.t > farthest.get().0
                && let Some(named) = name(self.triangles.part_of(hit.triangle))
            {
                farthest.set((hit.t, Some(named)));
            }
        });
        (through, farthest.get().1)
    }

    /// The fraction of light that gets through; `pane` is called for every pane on the way, in no order.
    #[inline]
    fn transmittance_of(&self, ray: &Ray, pane: impl Fn(&Hit)) -> Rgb {
        let through = Cell::new(Rgb::WHITE);
        let blocked = self.bvh.occluded_filtered(ray, |hit| {
            if !self.is_present(hit, AlphaTest::Stochastic) {
                return false;
            }
            let surface = self.surface(hit, ray.direction, &Cone::POINT);
            match surface.straight_transmittance(self) {
                Some(t) if !t.is_black() => {
                    through.set(through.get() * t);
                    pane(hit);
                    false
                }
                _ => true,
            }
        });
        if blocked { Rgb::BLACK } else { through.get() }
    }

    /// True if anything is in the way of a shadow ray, including panes.
    pub(crate) fn is_covered(&self, ray: &Ray) -> bool {
        self.is_met(ray, AlphaTest::Stochastic)
    }

    fn material_at(&self, hit: &Hit) -> &'s Material {
        &self.scene.materials[self.triangles.material(hit.triangle) as usize]
    }

    /// Whether the surface is present at a hit, by its opacity there.
    pub(crate) fn is_present(&self, hit: &Hit, test: AlphaTest) -> bool {
        let opacity = self.opacity(hit);
        match test {
            _ if opacity >= 1.0 => true,
            AlphaTest::Half => opacity >= 0.5,
            // Independent between rays, because no two hit at the same place; the same for the same ray.
            AlphaTest::Stochastic => {
                let h = hash_u32(hit.triangle ^ hash_u32(hit.u.to_bits() ^ hash_u32(hit.v.to_bits() ^ hit.t.to_bits())));
                opacity > (h >> 8) as f32 * (1.0 / 16_777_216.0)
            }
        }
    }

    /// How much of the surface is there at a hit: 0 none, 1 and above all of it.
    #[inline]
    pub(crate) fn opacity(&self, hit: &Hit) -> f32 {
        let read = |p| self.textures.scalar(p, self.triangles.get(hit.triangle).uv(hit.weights()), &Footprint::POINT);
        match &self.material_at(hit).alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask { opacity, cutoff } => f32::from(u8::from(read(opacity) >= *cutoff)),
            Alpha::Blend { opacity } => read(opacity),
        }
    }
}

/// How a partial opacity counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AlphaTest {
    /// Present with probability equal to the opacity, which is right on average: for light (Enderton et al. 2010, "Stochastic
    /// Transparency").
    Stochastic,
    /// Present from an opacity of one half on: for geometry layers, which are point samples.
    Half,
}

/// Whether hits on this material must pass the filter of a ray query before they count: panes, and what is cut out or half transparent.
fn needs_filter(material: &Material) -> bool {
    material.bsdf.is_pane() || material.alpha != Alpha::Opaque
}
