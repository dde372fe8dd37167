//! Radiance over the cells of a scene, solved once before rendering.
//!
//! From every cell one ray goes out through each bin of the cosine-weighted hemisphere; what it meets is remembered as a cell and a
//! reflectance. With the direct light of each cell this is a radiosity system (Goral et al. 1984), solved by a few sweeps without
//! tracing another ray. The last sweep leaves what rendering wants: where indirect light comes from in each cell, and how much.

use super::cells::{Cells, NONE, Site};
use super::square::{BINS, SIDE, SquareDensity};
use crate::bsdf::Event;
use crate::light::{LightChoice, LightPoint};
use crate::prepared::{Cutout, RenderScene};
use crate::surface::Surface;
use enfilade_math::{Bounds3, Onb, Ray, Rgb, Rng, Vec3, hash_u64, offset_origin, warp};
use rayon::prelude::*;

/// Sweeps of the radiosity system: each adds a bounce.
const SWEEPS: usize = 8;
/// Panes that a gathering ray passes.
const PANES: usize = 8;
/// Mirrors and bends by which a gathering ray goes on.
const MIRRORS: usize = 6;
/// Cells along the diagonal of the places that paths visited.
const CELLS_ACROSS: f32 = 48.0;
/// No cell is smaller, in metres.
const MIN_CELL: f32 = 0.05;

/// What is known of the light in a cell.
#[derive(Debug)]
pub(crate) struct CellLight {
    density: SquareDensity,
    /// Irradiance over π of the light that directions find, which is the mean radiance over the hemisphere, weighted by the cosine: what
    /// other surfaces send, and of sources what light sampling leaves to chance.
    pub found: Rgb,
}

/// The light in the cells of a scene.
#[derive(Debug)]
pub(crate) struct Field {
    cells: Cells,
    lights: Vec<CellLight>,
}

/// What a gathering ray met: a cell, the share of its light that comes back along the ray; the same of a cell seen in a mirror or
/// gloss; and the luminance that sources send by it, as far as light sampling leaves them to chance.
#[derive(Clone, Copy)]
struct Link {
    diffuse: (u32, Rgb),
    mirrored: (u32, Rgb),
    emitted: f32,
}

impl Link {
    /// Radiance that arrives, given the light of the cells.
    fn radiance(&self, total: &[Rgb]) -> Rgb {
        let sent = |(cell, share): (u32, Rgb)| if cell == NONE { Rgb::BLACK } else { share * total[cell as usize] };
        sent(self.diffuse) + sent(self.mirrored)
    }
}

impl Field {
    /// Solves for the light around `sites`, in about as many cells as `most` at the most. `None` without sites.
    pub fn solve(scene: &RenderScene<'_>, choice: &LightChoice, sites: &[Site], most: usize, seed: u64) -> Option<Self> {
        let bounds = Bounds3::from_points(sites.iter().map(|s| s.p));
        if bounds.is_empty() {
            return None;
        }
        let cells = Self::cells(bounds, sites, most);
        let gathered: Vec<(Rgb, Vec<Link>)> = (0..cells.len())
            .into_par_iter()
            .map(|cell| {
                let mut rng = Rng::new(hash_u64(seed ^ hash_u64(cell as u64)));
                let sites: Vec<Site> = cells.sites[cell].iter().flatten().copied().collect();
                (direct(scene, choice, &sites, &mut rng), links(scene, choice, &cells, &sites, &mut rng))
            })
            .collect();

        let mut indirect = vec![Rgb::BLACK; cells.len()];
        let total = |indirect: &[Rgb]| -> Vec<Rgb> { gathered.iter().zip(indirect).map(|((direct, _), &i)| *direct + i).collect() };
        for _ in 0..SWEEPS {
            let total = total(&indirect);
            indirect = gathered.par_iter().map(|(_, links)| links.iter().map(|l| l.radiance(&total)).sum::<Rgb>() / BINS as f32).collect();
        }
        let total = total(&indirect);
        let lights = gathered
            .par_iter()
            .zip(&indirect)
            .map(|((_, links), &indirect)| {
                let values: [f32; BINS] = std::array::from_fn(|bin| links[bin].emitted + links[bin].radiance(&total).luminance());
                let emitted = links.iter().map(|link| link.emitted).sum::<f32>() / BINS as f32;
                CellLight { density: SquareDensity::new(&blurred(&values)), found: indirect + Rgb::splat(emitted) }
            })
            .collect();
        Some(Self { cells, lights })
    }

    /// The cells of the sites. The area of surfaces says how the number of cells depends on their size.
    fn cells(bounds: Bounds3, sites: &[Site], most: usize) -> Cells {
        let size = (bounds.extent().length() / CELLS_ACROSS).max(MIN_CELL);
        let cells = Cells::new(bounds.min, size, sites);
        if cells.len() <= most {
            return cells;
        }
        Cells::new(bounds.min, size * (cells.len() as f32 / most as f32).sqrt(), sites)
    }

    /// What is known at a surface point; nothing where no path has been.
    #[inline]
    pub fn at(&self, p: Vec3, n: Vec3) -> Option<&CellLight> {
        self.lights.get(self.cells.find(p, n) as usize)
    }
}

impl CellLight {
    /// A direction in the space of `onb`'s axes, for `u` uniform on [0,1)², and its density per solid angle: in proportion to
    /// indirect radiance times cosine.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> (Vec3, f32) {
        let (v, density) = self.density.sample(u);
        let wi = warp::cosine_hemisphere(v);
        (wi, density * warp::cosine_hemisphere_pdf(wi.z))
    }

    /// Density of [`CellLight::sample`].
    #[inline]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        self.density.density(warp::square_from_cosine_hemisphere(wi)) * warp::cosine_hemisphere_pdf(wi.z)
    }
}

/// Direct irradiance over π, the mean over the sites.
fn direct(scene: &RenderScene<'_>, choice: &LightChoice, sites: &[Site], rng: &mut Rng) -> Rgb {
    sites.iter().map(|site| scene.lights.irradiance(scene, choice, site.p, site.n, rng)).sum::<Rgb>() / sites.len() as f32
}

/// What is met through each bin, from the sites in turn.
fn links(scene: &RenderScene<'_>, choice: &LightChoice, cells: &Cells, sites: &[Site], rng: &mut Rng) -> Vec<Link> {
    (0..BINS)
        .map(|bin| {
            let site = sites[(bin + bin / SIDE) % sites.len()];
            let u = [((bin % SIDE) as f32 + rng.next_f32()) / SIDE as f32, ((bin / SIDE) as f32 + rng.next_f32()) / SIDE as f32];
            let wi = warp::cosine_hemisphere(u);
            let ray = Ray::new(offset_origin(site.p, site.n), Onb::from_z(site.n).to_world(wi));
            link(scene, choice, cells, &LightPoint { p: site.p, n: site.n }, ray, warp::cosine_hemisphere_pdf(wi.z), rng)
        })
        .collect()
}

/// What a ray meets, beyond panes, and what is reflected there. It was sampled at `from` with density `pdf`.
fn link(scene: &RenderScene<'_>, choice: &LightChoice, cells: &Cells, from: &LightPoint, ray: Ray, pdf: f32, rng: &mut Rng) -> Link {
    let mut link = Link { diffuse: (NONE, Rgb::BLACK), mirrored: (NONE, Rgb::BLACK), emitted: 0.0 };
    let Some((surface, through)) = first_surface(scene, choice, ray, Some((*from, pdf)), &mut link.emitted) else { return link };
    let mut bsdf = surface.bsdf(scene);
    let mut albedo = bsdf.albedo(surface.wo.dot(surface.ns));
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

/// A little of each bin's neighbours.
fn blurred(values: &[f32; BINS]) -> [f32; BINS] {
    std::array::from_fn(|bin| {
        let (x, y) = (bin % SIDE, bin / SIDE);
        let mut sum = 0.0;
        let mut weights = 0.0;
        for ny in y.saturating_sub(1)..SIDE.min(y + 2) {
            for nx in x.saturating_sub(1)..SIDE.min(x + 2) {
                let weight = if (nx, ny) == (x, y) { 4.0 } else { 1.0 };
                sum += weight * values[ny * SIDE + nx];
                weights += weight;
            }
        }
        sum / weights
    })
}
