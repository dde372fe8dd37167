//! Bright patches, such as the inside of a lamp's shade: found once for the whole scene, and looked for from every cell.
//!
//! A patch may fill little of a cell's bin, and neighbouring cells see it in other bins; a sphere around it is the same for all of them.
//! Parallax-aware mixtures do the same (Ruppert et al. 2020, "Robust Fitting of Parallax-Aware Mixtures for Path Guiding").

use super::aim::{Aim, MAX_AIMS};
use super::bright::BRIGHT;
use super::cells::Site;
use super::rays::{GatherHit, LOOKING, Rays, mean, site_of};
use super::spots::Spot;
use super::square::BINS;
use enfilade_math::{Bounds3, Rgb, Rng, Vec3};
use std::f32::consts::PI;

/// The most bright places that patches are made of.
const MAX_PLACES: usize = 4096;
/// Places within this many cell sizes are of one patch, if they send at least this fraction of the light of the brightest of them.
const REACH: f32 = 0.25;
const ALIKE: f32 = 0.1;
/// Patches become one where they fill at least this fraction of a sphere around both.
const FILL: f32 = 0.35;
/// The most patches that a cell looks for.
const CANDIDATES: usize = 16;
/// How often it looks for one, the second time in the part that it saw the first time, and rays each time.
const STEPS: usize = 2;
const RAYS: usize = 16;
/// A place that a ray meets belongs to a patch if it sends at least this fraction of the patch's light and is within this many radii.
const DIMMEST: f32 = 0.25;
const WITHIN: f32 = 1.2;
/// A cell looks for a patch and aims at it if that sends it at least this fraction of what it receives from places that are not bright.
const MIN_FRACTION: f32 = 0.005;
/// The largest fraction of the directions that are aimed.
const MAX_AIMED: f32 = 0.8;
/// Cosine of a patch on the horizon.
const HORIZON: f32 = 0.1;
/// Turns around the axis from one ray to the next: the golden section spreads them evenly.
const TURNS: f32 = 0.618_034;

/// A sphere around bright places that are close together.
#[derive(Clone, Copy, Debug)]
pub(super) struct BrightPatch {
    /// World position.
    center: Vec3,
    /// Metres.
    radius: f32,
    /// Mean luminance of the places' radiance.
    radiance: f32,
}

/// A sphere to aim at, and the irradiance over π that comes from it.
pub(super) type Aimed = (Aim, Rgb);

/// The bright patches among the places that the rays of all cells met and among `spots`, given the light of the cells and spots. `size` is
/// the size of the smallest cells, metres.
pub(super) fn patches<'a>(cells: impl Iterator<Item = &'a [GatherHit]>, spots: &[Spot], total: &[Rgb], size: f32) -> Vec<BrightPatch> {
    let mut left: Vec<(Vec3, f32)> = cells
        .flat_map(|hits| {
            let min = BRIGHT * mean(hits, total);
            hits.iter().map(|hit| (hit.p, hit.unmirrored(total).luminance())).filter(move |&(_, radiance)| radiance > min)
        })
        .collect();
    let of_cells = &total[..total.len() - spots.len()];
    let min = BRIGHT * of_cells.iter().map(|light| light.luminance()).sum::<f32>() / of_cells.len() as f32;
    left.extend(spots.iter().map(|spot| (spot.p, spot.radiance.luminance())).filter(|&(_, radiance)| radiance > min));
    left.sort_by(|a, b| b.1.total_cmp(&a.1));
    left.truncate(MAX_PLACES);
    let reach = REACH * size;
    let mut patches = Vec::new();
    while let Some(&(brightest, max)) = left.first() {
        let of_it = |&(p, radiance): &(Vec3, f32)| p.distance(brightest) <= reach && radiance > ALIKE * max;
        let (places, others): (Vec<_>, Vec<_>) = left.into_iter().partition(of_it);
        left = others;
        let sum: f32 = places.iter().map(|(_, radiance)| radiance).sum();
        let center: Vec3 = places.iter().map(|(p, radiance)| *p * (radiance / sum)).sum();
        let radius = places.iter().map(|(p, _)| p.distance(center)).fold(0.0, f32::max);
        // The fewer places are known, the farther the patch may reach beyond them.
        let count = places.len() as f32;
        patches.push(BrightPatch { center, radius: radius.max(0.5 * reach / count.sqrt()), radiance: sum / count });
    }
    merged(patches)
}

/// Patches without those that together fill a sphere: the inside of a shade is one, and the cups of a chandelier's bulbs are several.
fn merged(patches: Vec<BrightPatch>) -> Vec<BrightPatch> {
    // Each with its area over π.
    let mut left: Vec<(BrightPatch, f32)> = patches.into_iter().map(|patch| (patch, patch.radius.powi(2))).collect();
    let mut first = 0;
    while first < left.len() {
        let fills = |second: usize| {
            let patch = left[first].0.around(&left[second].0);
            let fill = (left[first].1 + left[second].1) / patch.radius.powi(2);
            (left[first].0.is_like(&left[second].0) && fill > FILL).then_some((second, fill))
        };
        // Take in the one that fills best, until none does.
        let Some((second, _)) = (first + 1..left.len()).filter_map(fills).max_by(|a, b| a.1.total_cmp(&b.1)) else {
            first += 1;
            continue;
        };
        let (taken, area) = left.remove(second);
        let (patch, own) = &mut left[first];
        let radiance = (patch.radiance * *own + taken.radiance * area) / (*own + area);
        *patch = BrightPatch { radiance, ..patch.around(&taken) };
        *own += area;
    }
    left.into_iter().map(|(patch, _)| patch).collect()
}

/// The mean luminance of a cell without the bins that meet a bright place.
fn dim_mean(hits: &[GatherHit], total: &[Rgb]) -> f32 {
    let max = BRIGHT * mean(hits, total);
    hits.iter().map(|hit| hit.luminance(total)).filter(|&luminance| luminance <= max).sum::<f32>() / BINS as f32
}

/// Spheres with the fractions of the directions that go to them: in proportion to the light that comes from them, where `found` comes in
/// all.
pub(super) fn with_fractions(aimed: &[Aimed], found: f32) -> impl Iterator<Item = Aim> {
    let sum: f32 = aimed.iter().map(|(_, light)| light.luminance()).sum();
    let scale = (MAX_AIMED / sum).min(1.0 / found);
    aimed.iter().map(move |(aim, light)| Aim { fraction: scale * light.luminance(), ..*aim })
}

impl BrightPatch {
    /// A patch with the sphere around it and another one.
    fn around(&self, other: &Self) -> Self {
        let way = other.center - self.center;
        let distance = way.length();
        if distance + other.radius <= self.radius {
            return *self;
        }
        if distance + self.radius <= other.radius {
            return Self { radiance: self.radiance, ..*other };
        }
        let radius = 0.5 * (self.radius + other.radius + distance);
        Self { center: self.center + way * ((radius - self.radius) / distance), radius, ..*self }
    }

    /// True when neither is much brighter than the other.
    fn is_like(&self, other: &Self) -> bool {
        self.radiance.min(other.radiance) > ALIKE * self.radiance.max(other.radiance)
    }

    /// Irradiance over π at a site if all of the patch were visible from there.
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
    /// The patches that a cell aims at, the brightest first.
    pub fn aimed(&self, cell: usize, hits: &[GatherHit], patches: &[BrightPatch], total: &[Rgb]) -> Vec<Aimed> {
        let sites = self.sites(cell);
        let min = MIN_FRACTION * dim_mean(hits, total);
        let expected = patches.iter().map(|patch| (patch.expected(&sites[0]), patch));
        let mut near: Vec<(f32, &BrightPatch)> = expected.filter(|(expected, _)| *expected > min).collect();
        near.sort_by(|a, b| b.0.total_cmp(&a.0));
        near.truncate(CANDIDATES);
        let mut rng = self.rng(cell, LOOKING);
        let mut aimed: Vec<Aimed> = Vec::new();
        for (_, patch) in near {
            let found = self.look_for(patch, &sites, &aimed, total, &mut rng);
            aimed.extend(found.filter(|(_, light)| light.luminance() > min));
        }
        aimed.sort_by(|a, b| b.1.luminance().total_cmp(&a.1.luminance()));
        aimed.truncate(MAX_AIMS);
        aimed
    }

    /// The part of a patch that is visible from a cell's sites and not `aimed` at yet.
    fn look_for(&self, patch: &BrightPatch, sites: &[Site], aimed: &[Aimed], total: &[Rgb], rng: &mut Rng) -> Option<Aimed> {
        let of_it = |p: Vec3| p.distance(patch.center) < WITHIN * patch.radius && !aimed.iter().any(|(aim, _)| aim.contains(p));
        let mut aim = Aim { center: patch.center, radius: patch.radius, fraction: 0.0 };
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
                let met = self.gather_one(&site, direction, 1.0 / cone.solid_angle(), rng);
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
            // The fewer places are known, the farther the patch may reach beyond them.
            let radius = 0.5 * bounds.extent().length() * (1.0 + 1.0 / count);
            aim = Aim { center: bounds.center(), radius: radius.clamp(aim.radius / (1.0 + count.sqrt()), aim.radius), ..aim };
        }
        Some((aim, light))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_that_fill_a_sphere_become_one() {
        let patch = |x: f32, radius: f32, radiance: f32| BrightPatch { center: Vec3::new(x, 0.0, 0.0), radius, radiance };
        // Two that touch, one within the first, one far away, and one that is much dimmer.
        let merged =
            merged(vec![patch(0.0, 0.1, 9.0), patch(0.2, 0.1, 3.0), patch(0.01, 0.02, 9.0), patch(2.0, 0.1, 9.0), patch(0.1, 0.1, 0.2)]);
        assert_eq!(merged.len(), 3);
        let [one, far, dim] = merged[..] else { unreachable!("three") };
        assert!((one.center.x - 0.1).abs() < 1e-6 && (one.radius - 0.2).abs() < 1e-6, "{one:?}");
        assert!((5.9..6.5).contains(&one.radiance), "{one:?}");
        assert_eq!((far.center.x, far.radius, dim.radiance), (2.0, 0.1, 0.2));
    }

    #[test]
    fn a_sphere_around_two_holds_both() {
        let patch = |x: f32, radius: f32| BrightPatch { center: Vec3::new(x, 0.0, 0.0), radius, radiance: 1.0 };
        for (a, b) in [
            (patch(0.0, 0.1), patch(0.5, 0.3)),
            (patch(0.0, 0.5), patch(0.1, 0.2)),
            (patch(0.1, 0.2), patch(0.0, 0.5)),
            (patch(1.0, 0.1), patch(1.0, 0.1)),
        ] {
            let around = a.around(&b);
            for inner in [a, b] {
                assert!(around.center.distance(inner.center) + inner.radius <= around.radius + 1e-6, "{around:?} around {inner:?}");
            }
        }
    }
}
