//! The rays that gather light for a scene's cells (final gathering), and what they meet.

use super::cells::{Cells, NONE, Site};
use super::mirrored::mirrored;
use super::spots::Spots;
use super::square::{BINS, SIDE};
use crate::bsdf::Event;
use crate::light::{LightChoice, LightPoint};
use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use enfilade_math::{Onb, Ray, Rgb, Rng, Vec3, hash_u64, offset_origin, warp};

/// Panes that a gathering ray passes.
const PANES: usize = 8;
/// Mirrors and bends by which a gathering ray continues.
const MIRRORS: usize = 6;
/// Factor of what is mirrored in the probability that a ray continues there: the faint reflections of varnish are looked for by few rays.
const MIRROR_GAIN: f32 = 4.0;

/// Purposes of a cell's random numbers: its direct light, the rays through its bins by their round, and the search for bright places.
const DIRECT: usize = 0;
const ROUNDS: usize = 1;
pub(super) const LOOKING: usize = u16::MAX as usize;

/// Result of a gathering ray: the cell or spot that it met and the fraction of its light that comes back along the ray, the same for one
/// seen in a mirror or gloss, and the light of sources.
#[derive(Clone, Copy)]
pub(super) struct GatherHit {
    /// Position of the hit, in the world.
    pub p: Vec3,
    /// The number of the cell or spot, see [`Rays::place`], and the fraction of its light that comes back.
    diffuse: (u32, Rgb),
    /// The same for the cell or spot seen in mirrors, gloss and glass.
    mirrored: (u32, Rgb),
    /// Luminance that sources send along the ray, weighted against light sampling.
    pub emitted: f32,
}

impl GatherHit {
    /// Radiance that arrives, given the light of the cells and spots.
    pub fn radiance(&self, total: &[Rgb]) -> Rgb {
        self.unmirrored(total) + self.mirrored(total)
    }

    /// Luminance that arrives, including the light of sources.
    pub fn luminance(&self, total: &[Rgb]) -> f32 {
        self.emitted + self.radiance(total).luminance()
    }

    /// The part of it that comes straight from the cell.
    pub fn unmirrored(&self, total: &[Rgb]) -> Rgb {
        sent(self.diffuse, total)
    }

    /// The part of it that comes by way of a mirror or gloss.
    pub fn mirrored(&self, total: &[Rgb]) -> Rgb {
        sent(self.mirrored, total)
    }
}

/// Mean luminance that arrives by the bins of a cell, which is irradiance over π.
pub(super) fn mean(hits: &[GatherHit], total: &[Rgb]) -> f32 {
    hits.iter().map(|hit| hit.luminance(total)).sum::<f32>() / BINS as f32
}

/// The light that a cell or spot sends back along a ray.
fn sent((place, fraction): (u32, Rgb), total: &[Rgb]) -> Rgb {
    if place == NONE { Rgb::BLACK } else { fraction * total[place as usize] }
}

/// The rays that leave the cells.
pub(super) struct Rays<'a, 's> {
    pub scene: &'a RenderScene<'s>,
    pub choice: &'a LightChoice,
    pub cells: &'a Cells,
    pub spots: &'a Spots,
    pub seed: u64,
}

impl Rays<'_, '_> {
    pub(super) fn sites(&self, cell: usize) -> Vec<Site> {
        self.cells.sites[cell].iter().flatten().copied().collect()
    }

    pub(super) fn rng(&self, cell: usize, purpose: usize) -> Rng {
        Rng::new(hash_u64(self.seed ^ hash_u64((purpose as u64) << 32 | cell as u64)))
    }

    /// The number under which the light at a surface point is stored: its cell or, after all cells, its spot; [`NONE`] if it has neither.
    fn place(&self, p: Vec3, n: Vec3) -> u32 {
        self.spots.at(p, n).map_or_else(|| self.cells.find(p, n), |spot| (self.cells.len() + spot) as u32)
    }

    /// Direct irradiance over π in a cell, the mean over its sites.
    pub fn direct(&self, cell: usize) -> Rgb {
        let (sites, mut rng) = (self.sites(cell), self.rng(cell, DIRECT));
        let lights = &self.scene.lights;
        sites.iter().map(|site| lights.irradiance(self.scene, self.choice, site.p, site.n, &mut rng)).sum::<Rgb>() / sites.len() as f32
    }

    /// The hits through each bin of a cell, from its sites in turn.
    pub fn gather(&self, cell: usize, round: usize) -> impl Iterator<Item = GatherHit> {
        let (sites, mut rng) = (self.sites(cell), self.rng(cell, ROUNDS + round));
        (0..BINS).map(move |bin| {
            let site = site_of(&sites, bin, round);
            let u = [((bin % SIDE) as f32 + rng.next_f32()) / SIDE as f32, ((bin / SIDE) as f32 + rng.next_f32()) / SIDE as f32];
            let wi = warp::cosine_hemisphere(u);
            self.gather_one(&site, Onb::from_z(site.n).to_world(wi), warp::cosine_hemisphere_pdf(wi.z), &mut rng)
        })
    }

    /// The hit from a site in a unit direction, sampled with density `pdf`.
    pub fn gather_one(&self, site: &Site, direction: Vec3, pdf: f32, rng: &mut Rng) -> GatherHit {
        let ray = Ray::new(offset_origin(site.p, site.n), direction);
        self.gather_hit(&LightPoint { p: site.p, n: site.n }, ray, pdf, rng)
    }

    /// The hit of a ray beyond panes, with the light reflected there. The ray was sampled at `from` with density `pdf`.
    fn gather_hit(&self, from: &LightPoint, ray: Ray, pdf: f32, rng: &mut Rng) -> GatherHit {
        let &Rays { scene, choice, .. } = self;
        let mut hit = GatherHit { p: Vec3::ZERO, diffuse: (NONE, Rgb::BLACK), mirrored: (NONE, Rgb::BLACK), emitted: 0.0 };
        let Some((surface, through)) = first_surface(scene, choice, ray, Some((*from, pdf)), &mut hit.emitted) else { return hit };
        let mut bsdf = surface.bsdf(scene);
        let mut albedo = bsdf.albedo(surface.wo.dot(surface.ns));
        hit.p = surface.p;
        hit.diffuse = (self.place(surface.p, surface.ns_smooth), through * albedo.blurred());

        // Follow one sample of what the surface mirrors or refracts, until it meets a surface that is not sharp.
        let (mut surface, mut fraction) = (surface, through);
        for _ in 0..MIRRORS {
            let chance = MIRROR_GAIN * albedo.sharp.luminance();
            let Some((sample, direction)) = mirrored(&surface, &bsdf, chance, rng) else { break };
            fraction *= (1.0 / chance).max(1.0);
            // The blurred part counts as diffuse already.
            fraction *= sample.weight.specular * albedo.sharp_fraction();
            if fraction.is_black() {
                break;
            }
            let sampled = (sample.event == Event::Finite).then(|| (surface.light_point(), sample.pdf));
            let mut emitted = 0.0;
            let next = first_surface(scene, choice, surface.ray(direction), sampled, &mut emitted);
            hit.emitted += fraction.luminance() * emitted;
            let Some((next, through)) = next else { break };
            surface = next;
            bsdf = surface.bsdf(scene);
            albedo = bsdf.albedo(surface.wo.dot(surface.ns));
            fraction *= through;
            if !albedo.blurred().is_black() {
                hit.mirrored = (self.place(surface.p, surface.ns_smooth), fraction * albedo.blurred());
                break;
            }
        }
        hit
    }
}

/// Site of a cell that the ray through a bin leaves from.
pub(super) fn site_of(sites: &[Site], bin: usize, round: usize) -> Site {
    sites[(bin + bin / SIDE + round) % sites.len()]
}

/// The first surface beyond panes, and what they let through. Adds the luminance that arrives from sources, weighted against light
/// sampling where the ray was `sampled` from a density.
fn first_surface<'s>(
    scene: &RenderScene<'s>,
    choice: &LightChoice,
    mut ray: Ray,
    sampled: Option<(LightPoint, f32)>,
    emitted: &mut f32,
) -> Option<(Surface<'s>, Rgb)> {
    let mut through = Rgb::WHITE;
    let mut add = |radiance: Rgb| *emitted += Some(radiance.luminance()).filter(|l| l.is_finite()).unwrap_or(0.0);
    for _ in 0..PANES {
        let Some(hit) = scene.closest(&ray, AlphaTest::Stochastic) else {
            add(through * scene.lights.background_weighted(choice, sampled.as_ref(), ray.direction).total());
            return None;
        };
        let surface = scene.surface(&hit, ray.direction, &crate::texture::Cone::POINT);
        if let Some(transmittance) = surface.straight_transmittance(scene) {
            through *= transmittance;
            ray = surface.ray(ray.direction);
            continue;
        }
        // Light samples also find sources behind solid panes.
        if let Some((transmittance, beyond)) = scene.beyond_pane(&surface, ray.direction) {
            through *= transmittance;
            ray = beyond;
            continue;
        }
        let emission = surface.emission(scene);
        if !emission.is_black() {
            let weight = scene.lights.surface_weight(scene, choice, sampled.as_ref(), ray.direction, &hit, surface.p);
            add(through * emission * weight);
        }
        return Some((surface, through));
    }
    None
}
