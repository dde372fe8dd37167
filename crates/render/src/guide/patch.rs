//! Small bright places, such as the inside of a lamp's shade: found once for the whole scene, and looked for from every cell.
//!
//! What a cell sees of one may fill little of a bin, and stands elsewhere in the bins of its neighbours; a sphere around it stands still
//! in the world. That is what mixtures that are aware of parallax are for (Ruppert et al. 2020, "Robust Fitting of Parallax-Aware
//! Mixtures for Path Guiding").

use super::aim::{Aim, MOST};
use super::bright::BRIGHT;
use super::cells::Site;
use super::rays::{LOOKING, Link, Rays, mean, site_of};
use super::square::BINS;
use enfilade_math::{Bounds3, Rgb, Rng, Vec3};
use std::f32::consts::PI;

/// Bright places that patches are made of, at most.
const MOST_PLACES: usize = 4096;
/// Places this close, in cells, are of one patch, if they send at least this share of the light of the brightest of them.
const REACH: f32 = 0.25;
const ALIKE: f32 = 0.1;
/// Patches that a cell looks for, at most.
const CANDIDATES: usize = 6;
/// Times that it looks for one, the second time where it was seen the first time, and rays each time.
const STEPS: usize = 2;
const RAYS: usize = 16;
/// What a ray meets is of a patch if it sends at least this share of its light, within this many times its radius.
const DIMMEST: f32 = 0.25;
const WITHIN: f32 = 1.2;
/// A patch is looked for and aimed at where it sends at least this share of what comes from places that are not bright.
const LEAST_SHARE: f32 = 0.1;
/// Share of the directions that are aimed, at most.
const MOST_AIMED: f32 = 0.8;
/// Cosine of a patch that lies on the horizon.
const HORIZON: f32 = 0.1;
/// Turns around the axis between two rays: a golden section spreads them evenly.
const TURNS: f32 = 0.618_034;

/// A bright place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    center: Vec3,
    radius: f32,
    /// Luminance that it sends.
    radiance: f32,
}

/// A sphere to aim at, and the irradiance over π that comes from it.
pub(super) type Aimed = (Aim, Rgb);

/// The bright places among those that the rays of all cells met, given the light of the cells, which are `size` metres across.
pub(super) fn patches<'a>(cells: impl Iterator<Item = &'a [Link]>, total: &[Rgb], size: f32) -> Vec<Patch> {
    let mut left: Vec<(Vec3, f32)> = cells
        .flat_map(|links| {
            let least = BRIGHT * mean(links, total);
            links.iter().map(|link| (link.p, link.unmirrored(total).luminance())).filter(move |&(_, radiance)| radiance > least)
        })
        .collect();
    left.sort_by(|a, b| b.1.total_cmp(&a.1));
    left.truncate(MOST_PLACES);
    let reach = REACH * size;
    let mut patches = Vec::new();
    while let Some(&(brightest, most)) = left.first() {
        let of_it = |&(p, radiance): &(Vec3, f32)| p.distance(brightest) <= reach && radiance > ALIKE * most;
        let (places, others): (Vec<_>, Vec<_>) = left.into_iter().partition(of_it);
        left = others;
        let sum: f32 = places.iter().map(|(_, radiance)| radiance).sum();
        let center: Vec3 = places.iter().map(|(p, radiance)| *p * (radiance / sum)).sum();
        let radius = places.iter().map(|(p, _)| p.distance(center)).fold(0.0, f32::max);
        // Few places leave much of its borders unknown.
        let count = places.len() as f32;
        patches.push(Patch { center, radius: radius.max(0.5 * reach / count.sqrt()), radiance: sum / count });
    }
    patches
}

/// The mean luminance of a cell without the bins that meet a bright place.
fn dim_mean(links: &[Link], total: &[Rgb]) -> f32 {
    let most = BRIGHT * mean(links, total);
    links.iter().map(|link| link.luminance(total)).filter(|&luminance| luminance <= most).sum::<f32>() / BINS as f32
}

/// The shares of spheres in proportion to what comes from them, where `found` comes in all.
pub(super) fn shares(aimed: &[Aimed], found: f32) -> impl Iterator<Item = Aim> {
    let sum: f32 = aimed.iter().map(|(_, light)| light.luminance()).sum();
    let scale = (MOST_AIMED / sum).min(1.0 / found);
    aimed.iter().map(move |(aim, light)| Aim { share: scale * light.luminance(), ..*aim })
}

impl Patch {
    /// Irradiance over π that would come to a site if all of it were seen.
    fn expected(&self, site: &Site) -> f32 {
        let way = self.center - site.p;
        let (square, height) = (way.length_squared(), way.dot(site.n));
        if square < (2.0 * self.radius).powi(2) || height < -self.radius {
            return 0.0;
        }
        self.radiance * self.radius.powi(2) / square * (height / square.sqrt()).max(HORIZON)
    }
}

impl Rays<'_, '_> {
    /// What a cell aims at, the brightest first.
    pub fn aimed(&self, cell: usize, links: &[Link], patches: &[Patch], total: &[Rgb]) -> Vec<Aimed> {
        let sites = self.sites(cell);
        let least = LEAST_SHARE * dim_mean(links, total);
        let expected = patches.iter().map(|patch| (patch.expected(&sites[0]), patch));
        let mut near: Vec<(f32, &Patch)> = expected.filter(|(expected, _)| *expected > least).collect();
        near.sort_by(|a, b| b.0.total_cmp(&a.0));
        near.truncate(CANDIDATES);
        let mut rng = self.rng(cell, LOOKING);
        let mut aimed: Vec<Aimed> = Vec::new();
        for (_, patch) in near {
            let found = self.look_for(patch, &sites, &aimed, total, &mut rng);
            aimed.extend(found.filter(|(_, light)| light.luminance() > least));
        }
        aimed.sort_by(|a, b| b.1.luminance().total_cmp(&a.1.luminance()));
        aimed.truncate(MOST);
        aimed
    }

    /// The part of a patch that is seen from a cell's sites and not `aimed` at yet.
    fn look_for(&self, patch: &Patch, sites: &[Site], aimed: &[Aimed], total: &[Rgb], rng: &mut Rng) -> Option<Aimed> {
        let of_it = |p: Vec3| p.distance(patch.center) < WITHIN * patch.radius && !aimed.iter().any(|(aim, _)| aim.holds(p));
        let mut aim = Aim { center: patch.center, radius: patch.radius, share: 0.0 };
        let mut light = Rgb::BLACK;
        for step in 0..STEPS {
            light = Rgb::BLACK;
            let mut places = Vec::with_capacity(RAYS);
            let turn = rng.next_f32();
            for ray in 0..RAYS {
                let site = site_of(sites, ray, step);
                let cone = aim.cone(site.p)?;
                let direction = cone.sample([(ray as f32 + rng.next_f32()) / RAYS as f32, (ray as f32 * TURNS + turn).fract()]);
                let cosine = direction.dot(site.n);
                if cosine <= 0.0 {
                    continue;
                }
                let met = self.link(&site, direction, 1.0 / cone.solid_angle(), rng);
                let sent = met.unmirrored(total);
                if sent.luminance() > DIMMEST * patch.radiance && of_it(met.p) {
                    light += sent * (cone.solid_angle() * cosine / (PI * RAYS as f32));
                    places.push(met.p);
                }
            }
            let count = places.len() as f32;
            let bounds = Bounds3::from_points(places);
            if bounds.is_empty() {
                return None;
            }
            // Few places leave much of its borders unknown.
            let radius = 0.5 * bounds.extent().length() * (1.0 + 1.0 / count);
            aim = Aim { center: bounds.center(), radius: radius.clamp(aim.radius / (1.0 + count.sqrt()), aim.radius), ..aim };
        }
        Some((aim, light))
    }
}
