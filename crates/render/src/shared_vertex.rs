//! The second surface of a path, with the light found there that the paths of other pixels may use, and its connections to them.
//!
//! What is shared of the light depends on the surface alone: what it reflects diffusely; if it reflects nothing diffusely, what it
//! reflects straight from the sources. The rest is for the path that found it, which is the only one that samples it.

use crate::bsdf::{Outgoing, Value};
use crate::integrator::{Direct, Indirect, Step};
use crate::split::Arriving;
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::{Segment, Vertex};
use enfilade_geometry::Hit;
use enfilade_math::Vec3;

/// The sampled direction in which a path left its primary vertex and found a shared one.
pub(crate) struct DirectionSample {
    /// The primary vertex's BSDF value over the density and over `survival`.
    pub weight: Value,
    /// Density per solid angle.
    pub pdf: f32,
    /// Probability with which Russian roulette let the path go on.
    pub survival: f32,
}

/// The second surface of a path, and the light there that others may use.
pub(crate) struct SharedVertex<'a> {
    /// How its own path found it.
    pub found_by: DirectionSample,
    /// World position.
    pub p: Vec3,
    /// Where rays to it end: a little before the surface.
    pub end: Vec3,
    /// Unit geometric normal on the side that is seen.
    pub ng: Vec3,
    /// Unit shading normal on the side that is seen.
    pub ns: Vec3,
    /// The shared light, as it is sent back along its own path.
    pub to_own: Arriving,
    /// How that becomes what is sent in other directions.
    pub to_others: ToOthers<'a>,
}

/// What a shared vertex sends in directions other than that of its own path.
pub(crate) enum ToOthers<'a> {
    /// The same light, in proportion to this; the number is the factor of its own path.
    InProportion(Outgoing<'a>, f32),
    /// What the BSDF makes of the incident light, evaluated again for each direction.
    Evaluated(Box<Incident>),
}

/// Light that arrives at a shared vertex, and what the surface is made again from.
pub(crate) struct Incident {
    /// The surface, at a distance of zero.
    pub hit: Hit,
    pub cone: Cone,
    pub direct: Option<Direct>,
    pub indirect: Option<Indirect>,
}

/// A primary vertex and a shared one that see each other.
pub(crate) struct Connection {
    /// Number of the primary vertex in the batch.
    pub primary: usize,
    /// Value of the primary vertex's BSDF for the direction of the shared one, cosine included.
    pub value: Value,
    /// From solid angle at the primary vertex to area at the shared one, 1/m².
    pub jacobian: f32,
    /// Unit direction from the shared vertex to the primary one.
    pub wo: Vec3,
}

impl DirectionSample {
    /// Of a segment that left the primary vertex in this `step` and ends at `surface`. `None` when others cannot go to the same
    /// place: the segment's direction came from no density, it goes through something, or the surface lets light through.
    pub fn new(segment: &Segment, step: &Step, surface: &Surface<'_>) -> Option<Self> {
        let &(_, pdf) = segment.sampled.as_ref()?;
        let reflected = !segment.crossed && !segment.straight && segment.medium.is_clear() && !surface.material.bsdf.transmits();
        reflected.then_some(Self { weight: step.weight, pdf, survival: step.survival })
    }
}

impl<'a> SharedVertex<'a> {
    /// What can be shared of the light at a second surface; the rest of it is added to `own`. `None` when that is nothing.
    pub fn new(
        found_by: DirectionSample,
        vertex: &Vertex<'a, '_>,
        hit: &Hit,
        direct: Option<Direct>,
        indirect: Option<Indirect>,
        own: &mut Arriving,
    ) -> Option<Self> {
        let (surface, reflectance) = (&vertex.surface, vertex.bsdf.reflectance);
        let only_glossy = reflectance.is_black();
        let mut to_own = Arriving::default();
        if let Some(Direct { weight, light, kind, .. }) = &direct {
            let glossy = if only_glossy { &mut to_own } else { &mut *own };
            glossy.add(*kind, weight.specular * *light, false);
            to_own.add(*kind, reflectance * weight.diffuse * *light, false);
        }
        if let Some(Indirect { weight, light, .. }) = &indirect {
            own.add_dimmed(light, weight.specular);
            to_own.add_dimmed(light, reflectance * weight.diffuse);
        }
        let to_others = match vertex.bsdf.outgoing().filter(|_| !only_glossy) {
            _ if direct.is_none() && (only_glossy || indirect.is_none()) => return None,
            Some(_) if to_own.total.is_black() => return None,
            Some(outgoing) => ToOthers::InProportion(outgoing, outgoing.factor(surface.wo.dot(surface.ns))),
            None => ToOthers::Evaluated(Box::new(Incident { hit: Hit { t: 0.0, ..*hit }, cone: surface.cone, direct, indirect })),
        };
        let end = surface.ray(surface.wo).origin;
        Some(Self { found_by, p: surface.p, end, ng: surface.ng, ns: surface.ns, to_own, to_others })
    }
}
