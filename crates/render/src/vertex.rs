//! The vertices of a path and the segments between them: where a path continues, and with which density.
//!
//! Directions are sampled from a mixture of the BSDF and, on diffuse surfaces, of what the guide has learned of the light there (Müller,
//! Gross & Novák 2017, "Practical Path Guiding", mix them in the same way).

use crate::bsdf::{Border, Bsdf, Event, Value};
use crate::glass::{Inside, are_parallel, refracted, repeated};
use crate::guide::{CellLight, Guide};
use crate::light::LightPoint;
use crate::surface::{MIN_COSINE, Surface};
use crate::texture::Cone;
use enfilade_math::{ONE_MINUS_EPSILON, Onb, Ray, Rgb, Vec3};
use enfilade_scene::Bsdf as Model;

/// Fraction of the directions of a diffuse surface that follow the guide; the rest follows the BSDF.
const GUIDED_FRACTION: f32 = 0.65;

/// A segment of a path: the ray that leaves a surface, and what is known of it.
pub(crate) struct Segment {
    pub ray: Ray,
    /// The point that light was last sampled from, and the density of the ray's direction there; `None` after the camera or a
    /// mirror, where light sampling has no chance.
    pub sampled: Option<(LightPoint, f32)>,
    /// The medium that it passes through.
    pub medium: Medium,
    /// True when the surface at its origin was passed through.
    pub crossed: bool,
    /// True when that was a pane, which leaves the direction as it was; the last border of a solid one counts too.
    pub straight: bool,
    /// True when it continues beside the line on which it was sampled, since it has gone through solid panes.
    pub shifted: bool,
    /// The way into the body that it is in, as long as it may leave it as through a pane.
    pub inside: Option<Inside>,
    /// If it has just left a solid pane: whether nothing had scattered the light before that.
    pub was_direct: Option<bool>,
    /// The last window that it has passed since its direction changed, if light is separated by fixture.
    pub window: Option<u16>,
    /// Weight of the sun's disk where the segment meets it, beside that of `sampled`: see [`crate::light::Lights::glint_weight`].
    pub sun: f32,
    /// How wide the ray is.
    pub cone: Cone,
}

/// The medium that a ray passes through.
#[derive(Clone, Copy)]
pub(crate) struct Medium {
    /// Absorption per metre.
    pub absorption: Rgb,
    /// Radiance here over the same radiance outside of all bodies: on entering a denser body it is compressed by 1/eta².
    pub compression: f32,
}

impl Medium {
    /// Outside of all bodies.
    pub const AIR: Self = Self { absorption: Rgb::BLACK, compression: 1.0 };

    /// True when nothing is absorbed.
    #[inline]
    pub fn is_clear(self) -> bool {
        self.absorption.is_black()
    }

    /// Fraction of the light that is left after `distance` metres (Beer and Lambert).
    #[inline]
    pub fn transmittance(self, distance: f32) -> Rgb {
        if self.is_clear() { Rgb::WHITE } else { self.absorption.map(|a| (-a * distance.min(f32::MAX)).exp()) }
    }

    /// The medium after a border, on its other side if the ray `crosses` it: the body's medium when entering, air when leaving.
    #[inline]
    pub fn after(self, border: &Surface<'_>, crosses: bool) -> Self {
        if crosses { self.beyond(border) } else { self }
    }

    fn beyond(self, border: &Surface<'_>) -> Self {
        let Some((eta, absorption)) = body(&border.material.bsdf) else { return self };
        if border.outside {
            Self { absorption, compression: self.compression / (eta * eta) }
        } else {
            Self { absorption: Rgb::BLACK, compression: self.compression * eta * eta }
        }
    }
}

/// Index and absorption of the body that a material is the border of, if it is one.
pub(crate) fn body(model: &Model) -> Option<(f32, Rgb)> {
    match model {
        Model::Dielectric { eta, absorption, .. } => Some((*eta, *absorption)),
        Model::Principled(p) if p.solid => Some((p.ior, p.absorption)),
        Model::Disney(p) if !p.thin && p.spec_trans.factor > 0.0 => Some((p.eta, Rgb::BLACK)),
        Model::Blend { first, second, .. } => body(first).or_else(|| body(second)),
        _ => None,
    }
}

/// A surface that a path has reached, with all that scattering there needs.
pub(crate) struct Vertex<'a, 's> {
    pub surface: Surface<'s>,
    pub bsdf: Bsdf<'a>,
    /// Shading space.
    pub onb: Onb,
    wo: Vec3,
    /// The guide's light here.
    guided: Option<Guided<'a>>,
}

/// The guide's light at a surface.
struct Guided<'a> {
    light: &'a CellLight,
    /// The axes that it is stored in.
    onb: Onb,
    /// Fraction of the directions that follow it.
    fraction: f32,
    /// Luminance of the light, found by directions, that is expected to be reflected.
    reflected: f32,
    /// Luminance of such light in the brightest place around.
    at_most: f32,
}

impl Segment {
    /// Along a camera ray, or from nowhere.
    pub fn from_camera(ray: Ray, cone: Cone) -> Self {
        Self::new(ray, None, Medium::AIR, false, cone)
    }

    fn new(ray: Ray, sampled: Option<(LightPoint, f32)>, medium: Medium, crossed: bool, cone: Cone) -> Self {
        let (straight, shifted, inside, was_direct, window, sun) = (false, false, None, None, None, 1.0);
        Self { ray, sampled, medium, crossed, straight, shifted, inside, was_direct, window, sun, cone }
    }

    /// Adapts the next segment for a path into a body through a flat border and out through a parallel one: the result is unbent.
    fn through_body(&self, surface: &Surface<'_>, mut next: Self) -> Self {
        if !surface.flat {
            return next;
        }
        match (next.crossed, surface.outside, self.inside) {
            (true, true, None) => {
                let (normal, direction, sampled) = (surface.ns, self.ray.direction, self.sampled);
                next.inside = Some(Inside { normal, direction, sampled, window: self.window, sun: self.sun, direct: true });
                next
            }
            (false, false, Some(inside)) if are_parallel(inside.normal, surface.ns) => Self { inside: Some(inside), ..next },
            // On the far side: reflections within may bring it back to the near one, and it leaves there as if mirrored.
            (true, false, Some(inside)) if are_parallel(inside.normal, surface.ns) && inside.normal.dot(surface.ns) > 0.0 => {
                let Inside { direction, sampled, window, sun, direct, .. } = inside;
                let ray = surface.ray(direction);
                Self { ray, sampled, window, sun, straight: true, shifted: true, was_direct: Some(direct), ..next }
            }
            _ => next,
        }
    }

    /// The unit direction from where it was sampled to the place `p` at its end: its own, except for the shift by solid panes.
    #[inline]
    pub fn direction_to(&self, p: Vec3) -> Vec3 {
        match &self.sampled {
            Some((from, _)) if self.shifted => (p - from.p).normalize_or(self.ray.direction),
            _ => self.ray.direction,
        }
    }

    /// Whether nothing has scattered the light that comes along it, given the same for the segment `before` it. A segment that enters a
    /// body stores this for the point where the path leaves it.
    #[inline]
    pub fn is_direct(&mut self, before: &Self, direct: bool) -> bool {
        if let (None, Some(inside)) = (before.inside, &mut self.inside) {
            inside.direct = direct;
        }
        self.was_direct.unwrap_or(direct && self.straight)
    }

    /// The segment beyond the smooth `border` that this one ends at, and the fraction of radiance that comes through, with what parallel
    /// borders reflect to and fro. `None` where all light is reflected.
    pub fn beyond(&self, surface: &Surface<'_>, border: &Border) -> Option<(Rgb, Self)> {
        let direction = refracted(self.ray.direction, surface.ns, border.eta)?;
        let next = Self::new(surface.ray(direction), None, self.medium.after(surface, true), true, surface.cone);
        let next = self.through_body(surface, next);
        let inner = self.medium.transmittance(self.ray.origin.distance(surface.p));
        let again = if next.straight { repeated(border.reflected, inner) } else { Rgb::WHITE };
        Some((border.transmitted * again * (1.0 / (border.eta * border.eta)), next))
    }
}

impl<'a, 's> Vertex<'a, 's> {
    /// A surface with its BSDF and what `guide` knows of the light there.
    #[inline]
    pub fn new(guide: &'a Guide, surface: Surface<'s>, bsdf: Bsdf<'a>) -> Self {
        let onb = surface.onb();
        let wo = viewing(&onb, surface.wo);
        let guided = match &guide.field {
            Some(field) if !bsdf.reflectance.is_black() => field.at(surface.p, surface.ns_smooth).map(|light| {
                let albedo = bsdf.albedo(wo.z);
                let (fraction, reflected) = (GUIDED_FRACTION * albedo.blurred_fraction(), albedo.blurred() * light.found);
                let at_most = albedo.blurred().luminance() * light.brightest;
                let axes = if surface.ns_smooth == surface.ns { onb } else { Onb::from_z(surface.ns_smooth) };
                Guided { light, onb: axes, fraction, reflected: reflected.luminance(), at_most }
            }),
            _ => None,
        };
        Self { surface, bsdf, onb, wo, guided }
    }

    /// Luminance of the light, found by [`Vertex::scatter`]'s directions, that is expected to be reflected; 0 where nothing is known.
    #[inline]
    pub fn expected(&self) -> f32 {
        self.guided.as_ref().map_or(0.0, |guided| guided.reflected)
    }

    /// Luminance of such light in the brightest place around: paths that are given up here may miss as much.
    #[inline]
    pub fn expected_at_most(&self) -> f32 {
        self.guided.as_ref().map_or(0.0, |guided| guided.at_most)
    }

    /// The BSDF's value for a direction, given in shading space and in the world, and the density with which [`Vertex::scatter`]
    /// finds it.
    #[inline]
    pub fn eval_pdf(&self, wi: Vec3, wi_world: Vec3) -> (Value, f32) {
        let (value, pdf) = self.bsdf.eval_pdf(self.wo, wi);
        match &self.guided {
            None => (value, pdf),
            Some(k) => (value, k.fraction * k.light.pdf(wi_world, self.surface.p, &k.onb) + (1.0 - k.fraction) * pdf),
        }
    }

    /// Samples a direction and begins the next segment. `None` ends the path.
    #[inline]
    pub fn scatter(&self, u: [f32; 3], before: &Segment) -> Option<(Value, Segment)> {
        // Choose between the BSDF and the guide, and renew the random number that chose.
        let surface = &self.surface;
        let Some(Guided { light, onb, fraction, .. }) = &self.guided else { return self.scatter_by_bsdf(u, 1.0, before) };
        if u[2] >= *fraction {
            let renewed = ((u[2] - fraction) / (1.0 - fraction)).min(ONE_MINUS_EPSILON);
            return self.scatter_by_bsdf([u[0], u[1], renewed], 1.0 - fraction, before);
        }

        // Sample a direction from the guide; its density is the density of the mixture of both.
        let (direction, light_pdf) = light.sample([u[0], u[1]], surface.p, onb);
        let wi = self.onb.to_local(direction);
        let side = surface.side(direction);
        if light_pdf <= 0.0 || !sides_agree(wi.z, side) {
            return None;
        }
        let (value, bsdf_pdf) = self.bsdf.eval_pdf(self.wo, wi);
        let pdf = fraction * light_pdf + (1.0 - fraction) * bsdf_pdf;
        let medium = before.medium.after(surface, side < 0.0);
        Some((value * (1.0 / pdf), self.segment(direction, side, Some((surface.light_point(), pdf)), medium)))
    }

    /// Samples the BSDF, which `fraction` of the directions are left to.
    fn scatter_by_bsdf(&self, u: [f32; 3], fraction: f32, before: &Segment) -> Option<(Value, Segment)> {
        let surface = &self.surface;
        let sample = self.bsdf.sample(self.wo, u)?;
        let direction = if sample.event == Event::Straight { before.ray.direction } else { self.onb.to_world(sample.wi).normalize() };
        let side = surface.side(direction);
        if sample.event != Event::Straight && !sides_agree(sample.wi.z, side) {
            return None;
        }
        let mut weight = sample.weight * (1.0 / fraction);
        let sampled = match sample.event {
            Event::Finite => {
                let mut pdf = fraction * sample.pdf;
                if let Some(k) = &self.guided {
                    pdf += k.fraction * k.light.pdf(direction, surface.p, &k.onb);
                    weight = sample.weight * (sample.pdf / pdf);
                }
                Some((surface.light_point(), pdf))
            }
            Event::Delta => None,
            // A pane samples no direction: the light sample that was taken at the vertex before it reaches through the pane.
            Event::Straight => before.sampled,
        };
        let straight = sample.event == Event::Straight;
        let medium = before.medium.after(surface, side < 0.0 && !straight);
        let next = self.segment(direction, side, sampled, medium);
        let next = match sample.event {
            Event::Finite => next,
            Event::Delta => before.through_body(surface, next),
            Event::Straight => {
                let Segment { shifted, inside, window, sun, .. } = *before;
                Segment { straight, shifted, inside, window, sun, ..next }
            }
        };
        Some((weight, next))
    }

    fn segment(&self, direction: Vec3, side: f32, sampled: Option<(LightPoint, f32)>, medium: Medium) -> Segment {
        let cone = sampled.map_or(self.surface.cone, |(_, pdf)| self.surface.cone.scattered(pdf));
        Segment::new(self.surface.ray(direction), sampled, medium, side < 0.0, cone)
    }
}

/// `wo` in shading space, with its cosine kept off zero.
#[inline]
pub(crate) fn viewing(onb: &Onb, wo: Vec3) -> Vec3 {
    let local = onb.to_local(wo);
    Vec3::new(local.x, local.y, local.z.max(MIN_COSINE)).normalize()
}

/// True when a direction is on the same side of the shading and of the geometric surface: no light leaks through bumps.
#[inline]
pub(crate) fn sides_agree(shading_cosine: f32, geometric_cosine: f32) -> bool {
    shading_cosine * geometric_cosine > 0.0
}
