//! Radiance over the cells of a scene, solved once before rendering.
//!
//! From every cell one ray goes out through each bin of the cosine-weighted hemisphere; what it meets is remembered as a cell and a
//! reflectance. With the direct light of each cell this is a radiosity system (Goral et al. 1984), solved by a few sweeps without
//! tracing another ray. With the cells' light known, rays through the bins, those that are there and further ones where many samples pay
//! for them, say what rendering wants: where light comes from in each cell, and how much. What is small and bright is aimed at apart from
//! the bins (see [`super::patch`]), and looked for from the cells around as well (see [`super::bright`]).

use super::aim::Aims;
use super::bright::Bright;
use super::cells::{Cells, Site};
use super::patch::{Aimed, patches, shares};
use super::rays::{Link, Rays};
use super::square::{BINS, SIDE, SquareDensity};
use crate::light::LightChoice;
use crate::prepared::RenderScene;
use enfilade_math::{Bounds3, Onb, Rgb, Vec3, warp};
use rayon::prelude::*;

/// Sweeps of the radiosity system: each adds a bounce.
const SWEEPS: usize = 8;
/// Cells along the diagonal of the places that paths visited.
const CELLS_ACROSS: f32 = 48.0;
/// No cell is smaller, in metres.
const MIN_CELL: f32 = 0.05;

/// What is known of the light in a cell.
#[derive(Debug)]
pub(crate) struct CellLight {
    /// Of the directions that are not aimed.
    density: SquareDensity,
    aims: Aims,
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

/// How much may be done to know the light.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// About the most cells.
    pub cells: usize,
    /// Rays through each bin of each cell.
    pub rounds: usize,
}

/// Light that arrives in a cell from elsewhere than what it aims at.
struct Arriving {
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
        let cells = Self::cells(bounds, sites, effort.cells);
        let rays = Rays { scene, choice, cells: &cells, seed };
        let gathered: Vec<(Rgb, Vec<Link>)> =
            (0..cells.len()).into_par_iter().map(|cell| (rays.direct(cell), rays.links(cell, 0).collect())).collect();

        let mut indirect = vec![Rgb::BLACK; cells.len()];
        let total = |indirect: &[Rgb]| -> Vec<Rgb> { gathered.iter().zip(indirect).map(|((direct, _), &i)| *direct + i).collect() };
        for _ in 0..SWEEPS {
            let total = total(&indirect);
            indirect = gathered.par_iter().map(|(_, links)| links.iter().map(|l| l.radiance(&total)).sum::<Rgb>() / BINS as f32).collect();
        }
        let total = total(&indirect);
        let bright: Vec<Vec<Bright>> = gathered.par_iter().enumerate().map(|(cell, (_, links))| rays.bright(cell, links, &total)).collect();
        let patches = patches(gathered.iter().map(|(_, links)| &links[..]), &total, cells.size());
        let lights = gathered
            .par_iter()
            .enumerate()
            .map(|(cell, (_, links))| {
                let aimed = rays.aimed(cell, links, &patches, &total);
                let mut arriving = Arriving::beside(&aimed);
                links.iter().enumerate().for_each(|(bin, link)| arriving.add(bin, link, &total));
                for round in 1..effort.rounds {
                    rays.links(cell, round).enumerate().for_each(|(bin, link)| arriving.add(bin, &link, &total));
                }
                arriving.spread(&rays, cell, &bright);
                arriving.learned(&aimed)
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
    /// A unit direction in the world from `p`, for `u` uniform on [0,1)², and its density per solid angle: in proportion to the radiance
    /// that directions find, times cosine. `onb` holds the axes that the light is stored in.
    #[inline]
    pub fn sample(&self, u: [f32; 2], p: Vec3, onb: &Onb) -> (Vec3, f32) {
        match self.aims.sample(u, p) {
            Ok(direction) => (direction, self.pdf(direction, p, onb)),
            Err(rest) => {
                let (v, density) = self.density.sample(rest);
                let wi = warp::cosine_hemisphere(v);
                let direction = onb.to_world(wi);
                let (aimed, left) = self.aims.pdf(direction, p);
                (direction, aimed + left * density * warp::cosine_hemisphere_pdf(wi.z))
            }
        }
    }

    /// Density of [`CellLight::sample`]; 0 below the horizon, where directions are in vain.
    #[inline]
    pub fn pdf(&self, direction: Vec3, p: Vec3, onb: &Onb) -> f32 {
        let wi = onb.to_local(direction);
        if wi.z <= 0.0 {
            return 0.0;
        }
        let (aimed, left) = self.aims.pdf(direction, p);
        aimed + left * self.density.density(warp::square_from_cosine_hemisphere(wi)) * warp::cosine_hemisphere_pdf(wi.z)
    }
}

impl Arriving {
    /// None yet, beside what is aimed at.
    fn beside(aimed: &[Aimed]) -> Self {
        Self { bins: [0.0; BINS], sum: Rgb::BLACK, rays: 0, aims: Aims::new(aimed.iter().map(|(aim, _)| *aim)) }
    }

    /// Adds what a ray through a bin met, given the light of the cells.
    fn add(&mut self, bin: usize, link: &Link, total: &[Rgb]) {
        let sent = if self.aims.hold(link.p) { link.mirrored(total) } else { link.radiance(total) };
        self.bins[bin] += link.emitted + sent.luminance();
        self.sum += sent + Rgb::splat(link.emitted);
        self.rays += 1;
    }

    /// Spreads the bright places of a cell and of those around it over all of them.
    fn spread(&mut self, rays: &Rays<'_, '_>, cell: usize, bright: &[Vec<Bright>]) {
        let around: Vec<usize> = rays.cells.around(cell).collect();
        let share = 1.0 / around.len() as f32;
        for own in &bright[cell] {
            if !self.aims.hold(own.p) {
                self.change(own.bin, own.radiance * (share - 1.0));
            }
        }
        let of_others = around.iter().filter(|&&other| other != cell).flat_map(|&other| &bright[other]);
        for (number, place) in of_others.enumerate() {
            if !self.aims.hold(place.p)
                && let Some((bin, radiance)) = rays.seen(cell, number, place)
            {
                self.change(bin, radiance * share);
            }
        }
    }

    /// Changes what arrives through a bin.
    fn change(&mut self, bin: usize, by: Rgb) {
        self.bins[bin] = (self.bins[bin] + by.luminance()).max(0.0);
        self.sum += by;
    }

    fn learned(&self, aimed: &[Aimed]) -> CellLight {
        let found = self.sum.map(|v| v.max(0.0)) / self.rays as f32 + aimed.iter().map(|(_, light)| *light).sum::<Rgb>();
        let aims = Aims::new(shares(aimed, found.luminance()));
        CellLight { density: SquareDensity::new(&blurred(&self.bins)), aims, found }
    }
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
