//! Light found by one path, used by others (Bekaert, Sbert & Halton 2002, "Accelerating path tracing by re-using paths").
//!
//! Paths of pixels near each other meet surfaces side by side. What one of them learns at great cost at its second surface, the light
//! that this sends back, the others can have for a shadow ray: each primary vertex is connected to each shared one. The sample of a
//! shared vertex could have come from any of the primary vertices that see it, so it is weighted by the balance heuristic (Veach 1997)
//! over all of these, which keeps every pixel's mean, and bounds what a short connection adds.
//!
//! Primary vertices are the surfaces that a camera sees, and those that it sees by mirrors and glass. [`SharedVertex`] says what is
//! shared of the light at a second surface.

use crate::batch::{Batch, PrimaryVertex};
use crate::integrator::Integrator;
use crate::light::power_heuristic;
use crate::shared_vertex::{Connection, Incident, SharedVertex, ToOthers};
use crate::split::Arriving;
use crate::surface::{MIN_COSINE, shadow_ray};
use crate::vertex::{Vertex, sides_agree};
use enfilade_math::{Ray, Rgb, Vec3};

impl<'a, 's> Integrator<'a, 's> {
    /// Gathers, for every primary vertex, the light of all shared vertices that it sees.
    pub(crate) fn share_light(&self, batch: &mut Batch<'a, 's>) {
        let shared_vertices = std::mem::take(&mut batch.shared);
        let mut connections = std::mem::take(&mut batch.connections);
        for &(owner, ref shared) in &shared_vertices {
            // Connect the shared vertex to the primary vertex of its own path. Where that fails, the light is for that path alone, with the
            // weight of an ordinary sample.
            let own_primary = &batch.primaries[owner];
            let Some(own) = self.own_connection(owner, &own_primary.vertex, shared) else {
                self.gather_shared(batch, owner, &shared.found_by.weight, shared.to_own);
                continue;
            };

            // Connect it to the other primary vertices that see it, and sum up the densities with which all of them would have found it,
            // per area: the denominator of the balance heuristic.
            let mut density = shared.found_by.pdf * own.jacobian;
            connections.clear();
            connections.push(own);
            let eligible = |other: &PrimaryVertex<'_, 's>| other.shares_light && self.may_connect(own_primary, other);
            for (primary, other) in batch.primaries.iter().enumerate().filter(|(primary, other)| *primary != owner && eligible(other)) {
                if let Some((connection, pdf)) = self.connect(primary, &other.vertex, shared) {
                    density += pdf * connection.jacobian;
                    connections.push(connection);
                }
            }

            // Send the light along every connection.
            for connection in &connections {
                let weight = connection.value * (connection.jacobian / density);
                let light = if connection.primary == owner { shared.to_own } else { self.sent(shared, connection.wo) };
                self.gather_shared(batch, connection.primary, &weight, light);
            }
        }
        (batch.shared, batch.connections) = (shared_vertices, connections);
    }

    /// True when what one of the primary vertices finds is for the other as well.
    ///
    /// A surface seen by a fork's mirror is there only where the fork found nothing itself, so that the two are no independent ways to
    /// a shared vertex: vertices are connected only after equally many forks. Where paths have a longest length, only primary vertices
    /// after equally many bounces go on in the same way, which keeps such surfaces apart too.
    fn may_connect(&self, a: &PrimaryVertex<'_, 's>, b: &PrimaryVertex<'_, 's>) -> bool {
        if self.config.max_bounces.is_some() { a.bounce == b.bounce } else { a.forks == b.forks }
    }

    /// The connection of a shared vertex to the primary vertex of its own path; `None` when that goes through something half transparent,
    /// or others would see the shared vertex in another way.
    fn own_connection(&self, primary: usize, vertex: &Vertex<'_, 's>, shared: &SharedVertex<'_>) -> Option<Connection> {
        let (direction, jacobian) = direction_and_jacobian(vertex, shared)?;
        if self.scene.has_partial_opacity && !self.scene.is_clear(&connection_ray(vertex, shared, direction)) {
            return None;
        }
        Some(Connection { primary, value: shared.found_by.weight * shared.found_by.pdf, jacobian, wo: -direction })
    }

    /// The connection of a shared vertex to another primary vertex, and the density with which that would have found it.
    ///
    /// As for its own path, what was found by a path that survived Russian roulette counts for those that did not.
    ///
    /// Each connection has a ray of its own. Walking the hierarchy once for all rays to a shared vertex was slower: the space between them
    /// meets four times as many nodes as the rays do, most of them near the primary vertices.
    #[inline]
    fn connect(&self, primary: usize, vertex: &Vertex<'_, 's>, shared: &SharedVertex<'_>) -> Option<(Connection, f32)> {
        let (direction, jacobian) = direction_and_jacobian(vertex, shared)?;
        let wi = vertex.onb.to_local(direction);
        let side = direction.dot(vertex.surface.ng);
        if side <= 0.0 || !sides_agree(wi.z, side) {
            return None;
        }
        let (value, pdf) = vertex.eval_pdf(wi, direction);
        if pdf <= 0.0 || !self.scene.is_clear(&connection_ray(vertex, shared, direction)) {
            return None;
        }
        Some((Connection { primary, value: value * (1.0 / shared.found_by.survival), jacobian, wo: -direction }, pdf))
    }

    /// What a shared vertex sends to others in the unit direction `wo`.
    #[inline]
    fn sent(&self, shared: &SharedVertex<'_>, wo: Vec3) -> Arriving {
        match &shared.to_others {
            ToOthers::InProportion(outgoing, own) => shared.to_own.scaled(outgoing.factor(wo.dot(shared.ns)) / own),
            ToOthers::Evaluated(incident) => self.scattered(incident, wo),
        }
    }

    /// What the surface makes of incident light in the unit direction `wo`.
    fn scattered(&self, incident: &Incident, wo: Vec3) -> Arriving {
        let surface = self.scene.surface(&incident.hit, -wo, &incident.cone);
        let bsdf = surface.bsdf(self.scene);
        let only_glossy = bsdf.reflectance.is_black();
        let vertex = Vertex::new(self.guide, surface, bsdf);
        let reflectance = vertex.bsdf.reflectance;
        let mut sent = Arriving::default();
        let seen = |wi: Vec3| {
            let local = vertex.onb.to_local(wi);
            sides_agree(local.z, wi.dot(vertex.surface.ng)).then(|| vertex.eval_pdf(local, wi))
        };
        if let Some(direct) = &incident.direct
            && let Some((value, pdf)) = seen(direct.wi)
        {
            // Sources that glossy reflection finds by chance are found by this viewer's own paths, so its density counts. What is
            // diffuse is found by the path that is shared, and keeps its weight.
            let glossy = direct.pdf.map_or(direct.factor, |of_light| power_heuristic(of_light, pdf) / of_light);
            let specular = if only_glossy { value.specular * glossy } else { Rgb::BLACK };
            sent.add(direct.kind, (reflectance * value.diffuse * direct.factor + specular) * direct.light, false);
        }
        if let Some(indirect) = &incident.indirect
            && let (Some(density), Some((value, _))) = (indirect.density, seen(indirect.wi))
        {
            sent.add_dimmed(&indirect.light, reflectance * value.diffuse * (1.0 / density));
        }
        sent
    }
}

/// The unit direction from a primary vertex to a shared one, on the side that is seen, and the Jacobian from solid angle to area.
#[inline]
fn direction_and_jacobian(vertex: &Vertex<'_, '_>, shared: &SharedVertex<'_>) -> Option<(Vec3, f32)> {
    let way = shared.p - vertex.surface.p;
    let square = way.length_squared();
    let direction = way / square.sqrt();
    let cosine = -direction.dot(shared.ng);
    let jacobian = cosine / square;
    // Beyond the horizon of the shading normal, the normal is bent towards each viewer in its own way.
    let seen = cosine > 0.0 && -direction.dot(shared.ns) > 2.0 * MIN_COSINE;
    (seen && jacobian.is_finite()).then_some((direction, jacobian))
}

fn connection_ray(vertex: &Vertex<'_, '_>, shared: &SharedVertex<'_>, direction: Vec3) -> Ray {
    shadow_ray(vertex.surface.ray(direction).origin, direction, Some(shared.end))
}
