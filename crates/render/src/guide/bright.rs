//! Small bright places, such as the inside of a lamp's shade, that few of the rays by bin happen to meet.
//!
//! What one cell's rays met is looked for from the cells around it: each counts for all of them, where they see it. That is spatial
//! resampling, as of reservoirs of paths (Ouyang et al. 2021, "ReSTIR GI"), for a radiosity system.

use super::rays::{Link, Rays, mean, site_of};
use super::square::bin_of;
use crate::prepared::Cutout;
use crate::texture::Cone;
use enfilade_math::{Onb, Ray, Rgb, Vec3, offset_origin, warp};

/// How many times brighter than a cell's mean a place is to be shared.
pub(super) const BRIGHT: f32 = 8.0;
/// Places that a cell shares, at most.
const MOST: usize = 4;
/// No place fills so many times more of another cell's bins.
const MOST_GROWTH: f32 = 4.0;
/// A ray to a place ends there if it is this close, as a share of the distance.
const TOLERANCE: f32 = 0.01;

/// A bright place that a cell's ray met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bright {
    /// The bin that the ray went through.
    pub bin: usize,
    /// Radiance that the place sends.
    pub radiance: Rgb,
    /// Where it is.
    pub p: Vec3,
    /// From the cell's site to the place.
    way: Vec3,
    /// Cosine at the site.
    cosine: f32,
}

impl Rays<'_, '_> {
    /// The brightest places that a cell's `links` met, given the light of the cells.
    pub fn bright(&self, cell: usize, links: &[Link], total: &[Rgb]) -> Vec<Bright> {
        let sites = self.sites(cell);
        let mean = mean(links, total);
        let mut bright: Vec<Bright> = links
            .iter()
            .enumerate()
            .map(|(bin, link)| {
                let site = site_of(&sites, bin, 0);
                let way = link.p - site.p;
                Bright { bin, radiance: link.unmirrored(total), p: link.p, way, cosine: way.normalize().dot(site.n) }
            })
            .filter(|place| place.radiance.luminance() > BRIGHT * mean && place.cosine > 0.0)
            .collect();
        bright.sort_by(|a, b| b.radiance.luminance().total_cmp(&a.radiance.luminance()));
        bright.truncate(MOST);
        bright
    }

    /// A bright place of another cell as one of this cell's sites sees it: the bin that it lies in, and its radiance times how many times
    /// more of this bin it fills than of its own. `None` where it is not seen.
    pub fn seen(&self, cell: usize, number: usize, bright: &Bright) -> Option<(usize, Rgb)> {
        let sites = self.sites(cell);
        let site = sites[number % sites.len()];
        let way = bright.p - site.p;
        let direction = way.normalize();
        let local = Onb::from_z(site.n).to_local(direction);
        if local.z.is_nan() || local.z <= 0.0 {
            return None;
        }
        let distance = way.length();
        let hit = self.scene.closest(&Ray::new(offset_origin(site.p, site.n), direction), Cutout::Random)?;
        if (hit.t - distance).abs() > TOLERANCE * distance {
            return None;
        }
        let n = self.scene.surface(&hit, direction, &Cone::POINT).ng;
        let facing = |way: Vec3| n.dot(way.normalize()).abs() / way.length_squared();
        let growth = facing(way) * local.z / (facing(bright.way) * bright.cosine);
        growth.is_finite().then(|| (bin_of(warp::square_from_cosine_hemisphere(local)), bright.radiance * growth.min(MOST_GROWTH)))
    }
}
