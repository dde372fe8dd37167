//! What is seen in mirrors and through glass: from the first surface of a camera ray, sharp ways are followed to the first surfaces that
//! blur. Nothing here is random: where light comes by two ways, both are followed, each with its part.

use crate::bsdf::{Bsdf, Sharp};
use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::{sides_agree, viewing};
use enfilade_math::{Ray, Rgb, Vec3};

/// Ways with a smaller part of the light are left out, unless there is no other.
const LEAST_PART: f32 = 0.1;
/// The most surfaces that are visited for one camera ray.
const MAX_SURFACES: usize = 16;

/// What is seen at the ends of the sharp ways from one surface, in proportion to their light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beyond {
    /// Shading normals with bump, towards where they are seen from; shorter than 1 where they differ, and 0 for the background.
    pub normal: Vec3,
    /// Reflectance, on [0,1]; 1 for the background, for what shines and where nothing is mirrored or seen through.
    pub reflectance: Rgb,
}

impl Beyond {
    /// The background.
    pub const NOTHING: Self = Self { normal: Vec3::ZERO, reflectance: Rgb::WHITE };

    /// From the first surface that a camera ray meets. The part of its light that is neither diffuse nor sharp has its own normal.
    pub fn first(scene: &RenderScene<'_>, surface: &Surface<'_>, bsdf: &Bsdf<'_>) -> Self {
        let itself = Self { normal: surface.ns, reflectance: Rgb::WHITE };
        let sharp = bsdf.sharp(viewing(&surface.onb(), surface.wo));
        if sharp.mirrored.is_black() && sharp.through.is_black() || !surface.emission(scene).is_black() {
            return itself;
        }
        let mut ends = Ends::default();
        let mut ways = Vec::new();
        split(surface, &sharp, 1.0, (sharp.blurred.luminance(), itself), &mut ways, &mut ends);
        for _ in 0..MAX_SURFACES {
            let Some(Way { ray, cone, part }) = ways.pop() else { break };
            let Some(hit) = scene.closest(&ray, AlphaTest::Half) else {
                ends.add(Self::NOTHING, part);
                continue;
            };
            let surface = scene.surface(&hit, ray.direction, &cone);
            let (sharp, own, seen) = seen_at(scene, &surface);
            split(&surface, &sharp, part, (own, seen), &mut ways, &mut ends);
        }
        ends.mean().unwrap_or(itself)
    }
}

/// Length of the way from a surface, seen at the distance `first_m`, to the first one that blurs, by the way of most of the light; NaN where
/// it meets none.
pub(crate) fn distance_beyond(scene: &RenderScene<'_>, first: &Surface<'_>, first_m: f32) -> f32 {
    let (mut surface, mut distance_m) = (first.clone(), first_m);
    for _ in 0..MAX_SURFACES {
        let (sharp, own, _) = seen_at(scene, &surface);
        let most = ways_of(&surface, &sharp).max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(light, _)| *light > own);
        let Some((_, ray)) = most else { return distance_m };
        let Some(hit) = scene.closest(&ray, AlphaTest::Half) else { break };
        let next = scene.surface(&hit, ray.direction, &Cone::POINT);
        distance_m += next.p.distance(surface.p);
        surface = next;
    }
    f32::NAN
}

/// A way that is still to be followed, with its part of the light.
struct Way {
    ray: Ray,
    cone: Cone,
    part: f32,
}

/// Sums over the ends of ways.
#[derive(Default)]
struct Ends {
    normal: Vec3,
    reflectance: Rgb,
    part: f32,
}

impl Ends {
    fn add(&mut self, seen: Beyond, part: f32) {
        self.normal += seen.normal * part;
        self.reflectance += seen.reflectance * part;
        self.part += part;
    }

    fn mean(&self) -> Option<Beyond> {
        let per = 1.0 / self.part;
        (self.part > 0.0).then(|| Beyond { normal: self.normal * per, reflectance: self.reflectance * per })
    }
}

/// What is sharp at a surface that is seen from another one, the fraction of light that is not, and what is seen if its way ends there.
fn seen_at(scene: &RenderScene<'_>, surface: &Surface<'_>) -> (Sharp, f32, Beyond) {
    let (normal, bsdf) = (surface.ns, surface.bsdf(scene));
    if !surface.emission(scene).is_black() {
        return (Sharp::default(), 1.0, Beyond { normal, reflectance: Rgb::WHITE });
    }
    let wo = viewing(&surface.onb(), surface.wo);
    let (sharp, albedo) = (bsdf.sharp(wo), bsdf.albedo(wo.z));
    let reflectance = (albedo.blurred() + albedo.sharp).map(|v| v.clamp(0.0, 1.0));
    (sharp, (albedo.diffuse + sharp.blurred).luminance(), Beyond { normal, reflectance })
}

/// Ends the way to a surface, of which `part` of the light has come, or continues it, or both.
fn split(surface: &Surface<'_>, sharp: &Sharp, part: f32, (own, seen): (f32, Beyond), ways: &mut Vec<Way>, ends: &mut Ends) {
    let further: Vec<(f32, Ray)> = ways_of(surface, sharp).collect();
    let lights = || further.iter().map(|(light, _)| *light).chain([own]);
    let (all, most) = (lights().sum::<f32>(), lights().fold(0.0, f32::max));
    let is_kept = |light: f32| light > 0.0 && (light == most || part * light >= LEAST_PART * all);
    let kept: f32 = lights().filter(|light| is_kept(*light)).sum();
    if kept == 0.0 {
        return ends.add(seen, part);
    }
    if is_kept(own) {
        ends.add(seen, part * own / kept);
    }
    let further = further.into_iter().filter(|(light, _)| is_kept(*light));
    ways.extend(further.map(|(light, ray)| Way { ray, cone: surface.cone, part: part * light / kept }));
}

/// The sharp ways onward from a surface, and the light of each.
fn ways_of<'a>(surface: &'a Surface<'_>, sharp: &'a Sharp) -> impl Iterator<Item = (f32, Ray)> + 'a {
    let onb = surface.onb();
    let wo = viewing(&onb, surface.wo);
    let toward = move |wi: Vec3| {
        let direction = onb.to_world(wi).normalize();
        sides_agree(wi.z, surface.side(direction)).then_some(direction)
    };
    let mirrored = toward(Vec3::new(-wo.x, -wo.y, wo.z));
    let through = sharp.bent.map_or(Some(-surface.wo), toward);
    [(sharp.mirrored, mirrored), (sharp.through, through)]
        .into_iter()
        .filter(|(light, _)| !light.is_black())
        .filter_map(|(light, direction)| Some((light.luminance(), surface.ray(direction?))))
}
