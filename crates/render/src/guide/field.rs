//! Radiance over the cells of a scene, solved once before rendering.
//!
//! From every cell one ray goes out through each bin of the cosine-weighted hemisphere; what it meets is remembered as a cell and a
//! reflectance. With the direct light of each cell this is a radiosity system (Goral et al. 1984), solved by a few sweeps without
//! tracing another ray. With the cells' light known, rays through the bins (the existing ones, and more where many samples justify them)
//! give what rendering needs: where light comes from in each cell, and how much. Small bright places are also found by photons (see
//! [`super::spots`]), aimed at separately from the bins (see [`super::patch`]), and searched from the cells around (see [`super::bright`]).

use super::aim::Aims;
use super::bright::Bright;
use super::cells::{Cells, Site};
use super::patch::{Aimed, patches, with_fractions};
use super::rays::{GatherHit, Rays};
use super::spots::Spots;
use super::square::{BINS, SIDE, SquareDensity};
use crate::light::LightChoice;
use crate::prepared::RenderScene;
use enfilade_math::{Bounds3, Onb, Rgb, Vec3, warp};
use enfilade_parallel::{map, map_up_to};

/// Sweeps of the radiosity system: each adds a bounce.
const SWEEPS: usize = 8;
/// Cells along the diagonal of the places that paths visited.
const CELLS_ACROSS: f32 = 48.0;
/// No cell is smaller, in metres.
const MIN_CELL: f32 = 0.05;
/// Spots along the side of a cell of this smallest size.
const SPOTS_ACROSS: f32 = 8.0;

/// The light that arrives in a cell, as a density of directions and its irradiance.
#[derive(Debug)]
pub(crate) struct CellLight {
    /// Density of the directions that are not aimed.
    density: SquareDensity,
    aims: Aims,
    /// Irradiance over π of the light that sampled directions find, as opposed to light samples: all indirect light, and that part of
    /// direct light which multiple importance sampling leaves to them.
    pub found: Rgb,
    /// Luminance of the same, or of all light in the brightest place of the cell where lamps are near: a bulb's cup is brighter by far than
    /// the mean of its cell.
    pub brightest: f32,
}

/// The light in the cells of a scene.
#[derive(Debug)]
pub(crate) struct Field {
    cells: Cells,
    lights: Vec<CellLight>,
}

/// Effort for learning the light.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// About the largest number of cells.
    pub cells: usize,
    /// Photons that look for small bright places.
    pub photons: usize,
    /// Rays through each bin of each cell.
    pub rounds: usize,
}

/// Light that arrives in a cell by the bins of its hemisphere, from all but the spheres that it aims at.
struct BinnedLight {
    /// Luminance by bin.
    bins: [f32; BINS],
    sum: Rgb,
    rays: usize,
    aims: Aims,
}

impl Field {
    /// Solves for the light around `sites`. `None` without sites.
    pub(super) fn solve(scene: &RenderScene<'_>, choice: &LightChoice, sites: &[Site], effort: Effort, seed: u64) -> Option<Self> {
        let bounds = Bounds3::from_points(sites.iter().map(|s| s.p));
        if bounds.is_empty() {
            return None;
        }
        // Group the sites into cells, and find the spots that are too small and bright for these. Send a ray through each bin of each cell,
        // and sample the direct light there.
        let fine = (bounds.extent().length() / CELLS_ACROSS).max(MIN_CELL);
        let cells = Self::cells(bounds, sites, fine, effort.cells);
        let spots = Spots::find(scene, choice, bounds.min, fine / SPOTS_ACROSS, effort.photons, seed);
        let rays = Rays { scene, choice, cells: &cells, spots: &spots, seed };
        let gathered: Vec<(Rgb, Vec<GatherHit>)> = map_up_to(cells.len(), |cell| (rays.direct(cell), rays.gather(cell, 0).collect()));

        // Solve the radiosity system by Jacobi iteration: each sweep gathers the light of the one before, one bounce more. A spot has the
        // indirect light of the cell that contains it.
        let mut indirect = vec![Rgb::BLACK; cells.len()];
        let cells_of_spots: Vec<usize> = spots.spots.iter().map(|spot| cells.find(spot.site.p, spot.site.n) as usize).collect();
        let total = |indirect: &[Rgb]| -> Vec<Rgb> {
            let of_cells = gathered.iter().zip(indirect).map(|((direct, _), &i)| *direct + i);
            let around = cells_of_spots.iter().map(|&cell| indirect.get(cell).copied().unwrap_or_default());
            of_cells.chain(spots.spots.iter().zip(around).map(|(spot, around)| spot.light + around)).collect()
        };
        for _ in 0..SWEEPS {
            let total = total(&indirect);
            indirect = map(&gathered, |(_, hits)| hits.iter().map(|hit| hit.radiance(&total)).sum::<Rgb>() / BINS as f32);
        }

        // Find small bright places, in each cell and in the whole scene.
        let total = total(&indirect);
        let bright: Vec<Vec<Bright>> = map_up_to(cells.len(), |cell| rays.bright(cell, &gathered[cell].1, &total));
        let patches = patches(gathered.iter().map(|(_, hits)| &hits[..]), &spots.spots, &total, fine);

        // Find the cells in which lamps are so near that the light differs from place to place.
        let mut near = vec![0.0f32; cells.len()];
        for (spot, &cell) in spots.spots.iter().zip(&cells_of_spots) {
            if let Some(near) = near.get_mut(cell) {
                *near = near.max(spot.near);
            }
        }

        // Describe the light of each cell: the spheres to aim at, and the radiance through its bins beside them, from its own rays, further
        // rounds of rays, and the bright places that its neighbours found.
        let lights = map_up_to(cells.len(), |cell| {
            let (_, hits) = &gathered[cell];
            let aimed = rays.aimed(cell, hits, &patches, &total);
            let mut arriving = BinnedLight::beside(&aimed);
            hits.iter().enumerate().for_each(|(bin, hit)| arriving.add(bin, hit, &total));
            for round in 1..effort.rounds {
                rays.gather(cell, round).enumerate().for_each(|(bin, hit)| arriving.add(bin, &hit, &total));
            }
            arriving.spread(&rays, cell, &bright);
            arriving.learned(&aimed, near[cell])
        });
        Some(Self { cells, lights })
    }

    /// The cells of the sites, of `size` metres, or larger where there would be more than about `max`. They are on surfaces, so their
    /// number is proportional to the inverse square of their size.
    fn cells(bounds: Bounds3, sites: &[Site], size: f32, max: usize) -> Cells {
        let cells = Cells::new(bounds.min, size, sites);
        if cells.len() <= max {
            return cells;
        }
        Cells::new(bounds.min, size * (cells.len() as f32 / max as f32).sqrt(), sites)
    }

    /// The light at a surface point; `None` where it is not known.
    #[inline]
    pub fn at(&self, p: Vec3, n: Vec3) -> Option<&CellLight> {
        self.lights.get(self.cells.find(p, n) as usize)
    }
}

impl CellLight {
    /// A unit direction in the world from `p`, for `u` uniform on [0,1)², about in proportion to radiance times cosine, and its density per
    /// solid angle. `onb` has the axes that the light is stored in.
    #[inline]
    pub fn sample(&self, u: [f32; 2], p: Vec3, onb: &Onb) -> (Vec3, f32) {
        match self.aims.sample(u, p) {
            Ok((direction, aim)) => (direction, self.density_of(direction, p, onb, Some(aim))),
            Err(rest) => {
                let (v, density) = self.density.sample(rest);
                let wi = warp::cosine_hemisphere(v);
                let direction = onb.to_world(wi);
                let (aimed, left) = self.aims.pdf(direction, p, None);
                (direction, aimed + left * density * warp::cosine_hemisphere_pdf(wi.z))
            }
        }
    }

    /// Density of [`CellLight::sample`]; 0 below the horizon, where no light is reflected from.
    #[inline]
    pub fn pdf(&self, direction: Vec3, p: Vec3, onb: &Onb) -> f32 {
        self.density_of(direction, p, onb, None)
    }

    /// Density of a direction that was sampled by a sphere's number, or is any; as [`CellLight::pdf`].
    #[inline]
    fn density_of(&self, direction: Vec3, p: Vec3, onb: &Onb, sampled: Option<usize>) -> f32 {
        let wi = onb.to_local(direction);
        if wi.z <= 0.0 {
            return 0.0;
        }
        let (aimed, left) = self.aims.pdf(direction, p, sampled);
        aimed + left * self.density.density(warp::square_from_cosine_hemisphere(wi)) * warp::cosine_hemisphere_pdf(wi.z)
    }
}

impl BinnedLight {
    /// No light yet, beside what is aimed at.
    fn beside(aimed: &[Aimed]) -> Self {
        Self { bins: [0.0; BINS], sum: Rgb::BLACK, rays: 0, aims: Aims::new(aimed.iter().map(|(aim, _)| *aim)) }
    }

    /// Adds what a ray through a bin met, given the light of the cells.
    fn add(&mut self, bin: usize, hit: &GatherHit, total: &[Rgb]) {
        let sent = if self.aims.contains(hit.p) { hit.mirrored(total) } else { hit.radiance(total) };
        self.bins[bin] += hit.emitted + sent.luminance();
        self.sum += sent + Rgb::splat(hit.emitted);
        self.rays += 1;
    }

    /// Averages the bright places of a cell and of those around it over all of these cells.
    fn spread(&mut self, rays: &Rays<'_, '_>, cell: usize, bright: &[Vec<Bright>]) {
        let around: Vec<usize> = rays.cells.around(cell).collect();
        let fraction = 1.0 / around.len() as f32;
        for own in &bright[cell] {
            if !self.aims.contains(own.p) {
                self.change(own.bin, own.radiance * (fraction - 1.0));
            }
        }
        let of_others = around.iter().filter(|&&other| other != cell).flat_map(|&other| &bright[other]);
        for (number, place) in of_others.enumerate() {
            if !self.aims.contains(place.p)
                && let Some((bin, radiance)) = rays.seen(cell, number, place)
            {
                self.change(bin, radiance * fraction);
            }
        }
    }

    /// Adds light to a bin, or takes it away.
    fn change(&mut self, bin: usize, by: Rgb) {
        self.bins[bin] = (self.bins[bin] + by.luminance()).max(0.0);
        self.sum += by;
    }

    /// The learned light of a cell; `near` is the luminance of the irradiance over π from near lamps in its brightest place.
    fn learned(&self, aimed: &[Aimed], near: f32) -> CellLight {
        let found = self.sum.map(|v| v.max(0.0)) / self.rays as f32 + aimed.iter().map(|(_, light)| *light).sum::<Rgb>();
        let aims = Aims::new(with_fractions(aimed, found.luminance()));
        let brightest = found.luminance().max(near);
        CellLight { density: SquareDensity::new(&blurred(&self.bins)), aims, found, brightest }
    }
}

/// Bins blended with a little of their neighbours: the few rays of a bin give little information about its borders.
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
