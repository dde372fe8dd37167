//! Small bright places, such as the inside of a lamp's shade, that few of the rays by bin happen to meet.
//!
//! Places that one cell's rays met are tested from the cells around it, and used by each cell that sees them. This is spatial resampling
//! for a radiosity system, like the resampling of reservoirs of paths (Ouyang et al. 2021, "ReSTIR GI").

use super::rays::{GatherHit, Rays, mean, site_of};
use super::square::bin_of;
use crate::prepared::AlphaTest;
use crate::texture::Cone;
use enfilade_math::{Onb, Ray, Rgb, Vec3, offset_origin, warp};

/// How many times brighter than a cell's mean a place must be to be passed on to its neighbours.
pub(super) const BRIGHT: f32 = 8.0;
/// The most places that a cell passes on.
const MAX_PLACES: usize = 4;
/// A place counts as filling at most this many times more of another cell's bin than of its own.
const MAX_GROWTH: f32 = 4.0;
/// A ray counts as having met a place within this fraction of the distance to it.
const TOLERANCE: f32 = 0.01;

/// A bright place that a cell's ray met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bright {
    /// The bin that the ray went through.
    pub bin: usize,
    /// Radiance that the place sends.
    pub radiance: Rgb,
    /// Position.
    pub p: Vec3,
    /// From the cell's site to the place, metres.
    way: Vec3,
    /// Cosine at the site.
    cosine: f32,
}

impl Rays<'_, '_> {
    /// The brightest places that a cell's `hits` met, given the light of the cells.
    pub fn bright(&self, cell: usize, hits: &[GatherHit], total: &[Rgb]) -> Vec<Bright> {
        let sites = self.sites(cell);
        let mean = mean(hits, total);
        let mut bright: Vec<Bright> = hits
            .iter()
            .enumerate()
            .map(|(bin, hit)| {
                let site = site_of(&sites, bin, 0);
                let way = hit.p - site.p;
                Bright { bin, radiance: hit.unmirrored(total), p: hit.p, way, cosine: way.normalize().dot(site.n) }
            })
            .filter(|place| place.radiance.luminance() > BRIGHT * mean && place.cosine > 0.0)
            .collect();
        bright.sort_by(|a, b| b.radiance.luminance().total_cmp(&a.radiance.luminance()));
        bright.truncate(MAX_PLACES);
        bright
    }

    /// A bright place of another cell as one of this cell's sites sees it: the bin that contains it, and its radiance times the ratio of
    /// the parts that it fills of this bin and of its own. `None` where it is not seen.
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
        let hit = self.scene.closest(&Ray::new(offset_origin(site.p, site.n), direction), AlphaTest::Stochastic)?;
        if (hit.t - distance).abs() > TOLERANCE * distance {
            return None;
        }
        let n = self.scene.surface(&hit, direction, &Cone::POINT).ng;
        let facing = |way: Vec3| n.dot(way.normalize()).abs() / way.length_squared();
        let growth = facing(way) * local.z / (facing(bright.way) * bright.cosine);
        growth.is_finite().then(|| (bin_of(warp::square_from_cosine_hemisphere(local)), bright.radiance * growth.min(MAX_GROWTH)))
    }
}
