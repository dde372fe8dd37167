//! Light found by one path, used by others (Bekaert, Sbert & Halton 2002, "Accelerating path tracing by re-using paths").
//!
//! Paths of pixels near each other meet surfaces side by side. What one of them learns at great cost at its second surface, the light
//! that this sends back, the others can have for a shadow ray: each first surface is joined to each second one. The sample of a second
//! surface could have come from any of the first ones that see it, so it is weighted by the balance heuristic (Veach 1997) over all
//! of these, which keeps every pixel's mean, and bounds what a short connection adds.
//!
//! First surfaces are those that a camera sees, and those that it sees by mirrors and glass. What is shared of the light at the second
//! surface depends on that surface alone: what it reflects diffusely; if it reflects nothing diffusely, what it reflects straight from
//! the sources. The rest is for the path that found it, which is the only one that samples it.

use crate::batch::{Batch, Head};
use crate::bsdf::{Outgoing, Value};
use crate::integrator::{Direct, Indirect, Integrator, Step};
use crate::light::power_heuristic;
use crate::split::Arriving;
use crate::surface::{MIN_COSINE, Surface, shadow_ray};
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex, sides_agree};
use enfilade_geometry::Hit;
use enfilade_math::{Ray, Rgb, Vec3};

/// How a path got from its first surface to its second.
pub(crate) struct Reach {
    /// The first surface's value over the density and over `survival`.
    weight: Value,
    /// Density of the direction.
    pdf: f32,
    /// Probability that the path went on in it.
    survival: f32,
}

/// The second surface of a path, and the light there that others may use.
pub(crate) struct Far<'a> {
    reach: Reach,
    p: Vec3,
    /// Where rays to it end: a little before.
    end: Vec3,
    /// Geometric and shading normal on the side that is seen.
    ng: Vec3,
    ns: Vec3,
    /// What is sent back along its own path.
    own: Arriving,
    sent: Sent<'a>,
}

/// What is sent to others.
enum Sent<'a> {
    /// In this proportion, of which its own path has so much.
    Share(Outgoing<'a>, f32),
    /// What the surface makes of the light that arrives.
    Anew(Box<Arrived>),
}

/// Light that arrives at a surface.
struct Arrived {
    /// The surface, at a distance of zero.
    hit: Hit,
    cone: Cone,
    direct: Option<Direct>,
    indirect: Option<Indirect>,
}

/// A first surface and a second one that see each other.
pub(crate) struct Link {
    /// Number of the first.
    head: usize,
    value: Value,
    /// From solid angle at the first to area at the second.
    jacobian: f32,
    /// From the second to the first.
    wo: Vec3,
}

impl Reach {
    /// Along a segment that left the first surface in this `step` and ends at `surface`. `None` when others cannot go to the same
    /// place: the segment's direction came from no density, it goes through something, or the surface lets light through.
    pub fn new(segment: &Segment, step: &Step, surface: &Surface<'_>) -> Option<Self> {
        let &(_, pdf) = segment.sampled.as_ref()?;
        let reflected = !segment.crossed && !segment.straight && segment.medium.is_clear() && !surface.material.bsdf.transmits();
        reflected.then_some(Self { weight: step.weight, pdf, survival: step.survival })
    }
}

impl<'a> Far<'a> {
    /// What can be shared of the light at a second surface; the rest of it is added to `own`. `None` when that is nothing.
    pub fn new(
        reach: Reach,
        vertex: &Vertex<'a, '_>,
        hit: &Hit,
        direct: Option<Direct>,
        indirect: Option<Indirect>,
        own: &mut Arriving,
    ) -> Option<Self> {
        let (surface, reflectance) = (&vertex.surface, vertex.bsdf.reflectance);
        let only_glossy = reflectance.is_black();
        let mut sent = Arriving::default();
        if let Some(Direct { weight, light, kind, .. }) = &direct {
            let glossy = if only_glossy { &mut sent } else { &mut *own };
            glossy.add(*kind, weight.specular * *light, false);
            sent.add(*kind, reflectance * weight.diffuse * *light, false);
        }
        if let Some(Indirect { weight, light, .. }) = &indirect {
            own.add_dimmed(light, weight.specular);
            sent.add_dimmed(light, reflectance * weight.diffuse);
        }
        let to_others = match vertex.bsdf.outgoing().filter(|_| !only_glossy) {
            _ if direct.is_none() && (only_glossy || indirect.is_none()) => return None,
            Some(_) if sent.total.is_black() => return None,
            Some(outgoing) => Sent::Share(outgoing, outgoing.share(surface.wo.dot(surface.ns))),
            None => Sent::Anew(Box::new(Arrived { hit: Hit { t: 0.0, ..*hit }, cone: surface.cone, direct, indirect })),
        };
        let end = surface.ray(surface.wo).origin;
        Some(Self { reach, p: surface.p, end, ng: surface.ng, ns: surface.ns, own: sent, sent: to_others })
    }
}

impl<'a, 's> Integrator<'a, 's> {
    /// Gathers, for every first surface, the light of all second surfaces that it sees.
    pub(crate) fn share(&self, batch: &mut Batch<'a, 's>) {
        let fars = std::mem::take(&mut batch.fars);
        let mut links = std::mem::take(&mut batch.links);
        for &(owner, ref far) in &fars {
            let owner_head = &batch.heads[owner];
            let Some(own) = self.own_link(owner, &owner_head.vertex, far) else {
                self.gather_shared(batch, owner, &far.reach.weight, far.own);
                continue;
            };
            let mut density = far.reach.pdf * own.jacobian;
            links.clear();
            links.push(own);
            let alike = |other: &Head<'_, 's>| other.shares && self.are_alike(owner_head, other);
            for (head, other) in batch.heads.iter().enumerate().filter(|(head, other)| *head != owner && alike(other)) {
                if let Some((link, pdf)) = self.link(head, &other.vertex, far) {
                    density += pdf * link.jacobian;
                    links.push(link);
                }
            }
            for link in &links {
                let weight = link.value * (link.jacobian / density);
                let light = if link.head == owner { far.own } else { self.sent(far, link.wo) };
                self.gather_shared(batch, link.head, &weight, light);
            }
        }
        (batch.fars, batch.links) = (fars, links);
    }

    /// True when what one of the first surfaces finds is for the other as well.
    ///
    /// A surface seen by a fork's mirror is there only where the fork found nothing itself, so that the two are no independent ways to
    /// a second surface: each is joined to its like alone. Where paths have a longest length, only those go on in the same way that are
    /// equally long, which keeps such surfaces apart too.
    fn are_alike(&self, a: &Head<'_, 's>, b: &Head<'_, 's>) -> bool {
        if self.config.max_bounces.is_some() { a.bounce == b.bounce } else { a.forks == b.forks }
    }

    /// The link of a second surface to the first surface of its own path; `None` when that goes through something half transparent, or
    /// others would see the second surface in another way.
    fn own_link(&self, head: usize, vertex: &Vertex<'_, 's>, far: &Far<'_>) -> Option<Link> {
        let (direction, jacobian) = joined(vertex, far)?;
        if self.scene.has_veils && !self.scene.is_clear(&joining_ray(vertex, far, direction)) {
            return None;
        }
        Some(Link { head, value: far.reach.weight * far.reach.pdf, jacobian, wo: -direction })
    }

    /// The link of a second surface to another first one, and the density with which that would have found it.
    ///
    /// As for its own path, what a path found that went on by chance counts for those that did not.
    ///
    /// Each link has a ray of its own. The space between all rays to a second surface meets four times the blocks that the rays meet,
    /// most of them where it stands on the first surfaces: to walk the tree once for all was slower.
    #[inline]
    fn link(&self, head: usize, vertex: &Vertex<'_, 's>, far: &Far<'_>) -> Option<(Link, f32)> {
        let (direction, jacobian) = joined(vertex, far)?;
        let wi = vertex.onb.to_local(direction);
        let side = direction.dot(vertex.surface.ng);
        if side <= 0.0 || !sides_agree(wi.z, side) {
            return None;
        }
        let (value, pdf) = vertex.eval_pdf(wi, direction);
        if pdf <= 0.0 || !self.scene.is_clear(&joining_ray(vertex, far, direction)) {
            return None;
        }
        Some((Link { head, value: value * (1.0 / far.reach.survival), jacobian, wo: -direction }, pdf))
    }

    /// What a second surface sends to others in the unit direction `wo`.
    #[inline]
    fn sent(&self, far: &Far<'_>, wo: Vec3) -> Arriving {
        match &far.sent {
            Sent::Share(outgoing, own) => far.own.scaled(outgoing.share(wo.dot(far.ns)) / own),
            Sent::Anew(arrived) => self.sent_anew(arrived, wo),
        }
    }

    fn sent_anew(&self, arrived: &Arrived, wo: Vec3) -> Arriving {
        let surface = self.scene.surface(&arrived.hit, -wo, &arrived.cone);
        let bsdf = surface.bsdf(self.scene);
        let only_glossy = bsdf.reflectance.is_black();
        let vertex = Vertex::new(self.guide, surface, bsdf);
        let reflectance = vertex.bsdf.reflectance;
        let mut sent = Arriving::default();
        let seen = |wi: Vec3| {
            let local = vertex.onb.to_local(wi);
            sides_agree(local.z, wi.dot(vertex.surface.ng)).then(|| vertex.eval_pdf(local, wi))
        };
        if let Some(direct) = &arrived.direct
            && let Some((value, pdf)) = seen(direct.wi)
        {
            // Sources that glossy reflection finds by chance are found by this viewer's own paths, so its density counts. What is
            // diffuse is found by the path that is shared, and keeps its weight.
            let glossy = direct.pdf.map_or(direct.factor, |of_light| power_heuristic(of_light, pdf) / of_light);
            let specular = if only_glossy { value.specular * glossy } else { Rgb::BLACK };
            sent.add(direct.kind, (reflectance * value.diffuse * direct.factor + specular) * direct.light, false);
        }
        if let Some(indirect) = &arrived.indirect
            && let (Some(density), Some((value, _))) = (indirect.density, seen(indirect.wi))
        {
            sent.add_dimmed(&indirect.light, reflectance * value.diffuse * (1.0 / density));
        }
        sent
    }
}

/// The unit direction from a first surface to a second one, on the side that is seen, and the Jacobian from solid angle to area.
#[inline]
fn joined(vertex: &Vertex<'_, '_>, far: &Far<'_>) -> Option<(Vec3, f32)> {
    let way = far.p - vertex.surface.p;
    let square = way.length_squared();
    let direction = way / square.sqrt();
    let cosine = -direction.dot(far.ng);
    let jacobian = cosine / square;
    // Beyond the horizon of the shading normal every viewer finds it bent in its own way.
    let seen = cosine > 0.0 && -direction.dot(far.ns) > 2.0 * MIN_COSINE;
    (seen && jacobian.is_finite()).then_some((direction, jacobian))
}

fn joining_ray(vertex: &Vertex<'_, '_>, far: &Far<'_>, direction: Vec3) -> Ray {
    shadow_ray(vertex.surface.ray(direction).origin, direction, Some(far.end))
}
