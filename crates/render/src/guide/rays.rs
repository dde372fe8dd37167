//! Rays that leave a scene's cells, and what they meet.

use super::cells::{Cells, NONE, Site};
use super::square::{BINS, SIDE};
use crate::bsdf::Event;
use crate::light::{LightChoice, LightPoint};
use crate::prepared::{Cutout, RenderScene};
use crate::surface::Surface;
use enfilade_math::{Onb, Ray, Rgb, Rng, Vec3, hash_u64, offset_origin, warp};

/// Panes that a gathering ray passes.
const PANES: usize = 8;
/// Mirrors and bends by which a gathering ray goes on.
const MIRRORS: usize = 6;

/// What a cell's random numbers are for: its direct light, rays through its bins by their round, and small bright places.
const DIRECT: usize = 0;
const ROUNDS: usize = 1;
pub(super) const LOOKING: usize = u16::MAX as usize;

/// What a gathering ray met: a cell, the share of its light that comes back along the ray; the same of a cell seen in a mirror or
/// gloss; and what sources send by it.
#[derive(Clone, Copy)]
pub(super) struct Link {
    /// The place that the cell was met in.
    pub p: Vec3,
    diffuse: (u32, Rgb),
    mirrored: (u32, Rgb),
    /// Luminance that sources send by it, as far as light sampling leaves them to chance.
    pub emitted: f32,
}

impl Link {
    /// Radiance that arrives, given the light of the cells.
    pub fn radiance(&self, total: &[Rgb]) -> Rgb {
        self.unmirrored(total) + self.mirrored(total)
    }

    /// Luminance that arrives, of what sources send by it too.
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
pub(super) fn mean(links: &[Link], total: &[Rgb]) -> f32 {
    links.iter().map(|link| link.luminance(total)).sum::<f32>() / BINS as f32
}

fn sent((cell, share): (u32, Rgb), total: &[Rgb]) -> Rgb {
    if cell == NONE { Rgb::BLACK } else { share * total[cell as usize] }
}

/// The rays that leave the cells.
pub(super) struct Rays<'a, 's> {
    pub scene: &'a RenderScene<'s>,
    pub choice: &'a LightChoice,
    pub cells: &'a Cells,
    pub seed: u64,
}

impl Rays<'_, '_> {
    pub(super) fn sites(&self, cell: usize) -> Vec<Site> {
        self.cells.sites[cell].iter().flatten().copied().collect()
    }

    pub(super) fn rng(&self, cell: usize, purpose: usize) -> Rng {
        Rng::new(hash_u64(self.seed ^ hash_u64((purpose as u64) << 32 | cell as u64)))
    }

    /// Direct irradiance over π in a cell, the mean over its sites.
    pub fn direct(&self, cell: usize) -> Rgb {
        let (sites, mut rng) = (self.sites(cell), self.rng(cell, DIRECT));
        let lights = &self.scene.lights;
        sites.iter().map(|site| lights.irradiance(self.scene, self.choice, site.p, site.n, &mut rng)).sum::<Rgb>() / sites.len() as f32
    }

    /// What is met through each bin of a cell, from its sites in turn.
    pub fn links(&self, cell: usize, round: usize) -> impl Iterator<Item = Link> {
        let (sites, mut rng) = (self.sites(cell), self.rng(cell, ROUNDS + round));
        (0..BINS).map(move |bin| {
            let site = site_of(&sites, bin, round);
            let u = [((bin % SIDE) as f32 + rng.next_f32()) / SIDE as f32, ((bin / SIDE) as f32 + rng.next_f32()) / SIDE as f32];
            let wi = warp::cosine_hemisphere(u);
            self.link(&site, Onb::from_z(site.n).to_world(wi), warp::cosine_hemisphere_pdf(wi.z), &mut rng)
        })
    }

    /// What is met from a site in a unit direction, sampled with density `pdf`.
    pub fn link(&self, site: &Site, direction: Vec3, pdf: f32, rng: &mut Rng) -> Link {
        let ray = Ray::new(offset_origin(site.p, site.n), direction);
        link(self.scene, self.choice, self.cells, &LightPoint { p: site.p, n: site.n }, ray, pdf, rng)
    }
}

/// The one of a cell's sites that the ray through a bin leaves from.
pub(super) fn site_of(sites: &[Site], bin: usize, round: usize) -> Site {
    sites[(bin + bin / SIDE + round) % sites.len()]
}

/// What a ray meets, beyond panes, and what is reflected there. It was sampled at `from` with density `pdf`.
fn link(scene: &RenderScene<'_>, choice: &LightChoice, cells: &Cells, from: &LightPoint, ray: Ray, pdf: f32, rng: &mut Rng) -> Link {
    let mut link = Link { p: Vec3::ZERO, diffuse: (NONE, Rgb::BLACK), mirrored: (NONE, Rgb::BLACK), emitted: 0.0 };
    let Some((surface, through)) = first_surface(scene, choice, ray, Some((*from, pdf)), &mut link.emitted) else { return link };
    let mut bsdf = surface.bsdf(scene);
    let mut albedo = bsdf.albedo(surface.wo.dot(surface.ns));
    link.p = surface.p;
    link.diffuse = (cells.find(surface.p, surface.ns_smooth), through * albedo.blurred());
    // One sample of what the surface mirrors, by way of others that only mirror or bend.
    let (mut surface, mut share) = (surface, through);
    for _ in 0..MIRRORS {
        let onb = surface.onb();
        let Some(sample) = bsdf.sample(onb.to_local(surface.wo), [rng.next_f32(), rng.next_f32(), rng.next_f32()]) else { break };
        // What is blurred counts already.
        share *= sample.weight.specular * albedo.sharp_share();
        let direction = onb.to_world(sample.wi).normalize();
        if share.is_black() || direction.dot(surface.ng) * sample.wi.z <= 0.0 {
            break;
        }
        let sampled = (sample.event == Event::Finite).then(|| (LightPoint::on(&surface), sample.pdf));
        let mut emitted = 0.0;
        let next = first_surface(scene, choice, surface.ray(direction), sampled, &mut emitted);
        link.emitted += share.luminance() * emitted;
        let Some((next, through)) = next else { break };
        surface = next;
        bsdf = surface.bsdf(scene);
        albedo = bsdf.albedo(surface.wo.dot(surface.ns));
        share *= through;
        if !albedo.blurred().is_black() {
            link.mirrored = (cells.find(surface.p, surface.ns_smooth), share * albedo.blurred());
            break;
        }
    }
    link
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
        let Some(hit) = scene.closest(&ray, Cutout::Random) else {
            add(through * scene.lights.background_weighted(choice, sampled.as_ref(), ray.direction).total());
            return None;
        };
        let surface = scene.surface(&hit, ray.direction, &crate::texture::Cone::POINT);
        if let Some(transmittance) = surface.straight_transmittance(scene) {
            through *= transmittance;
            ray = surface.ray(ray.direction);
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
