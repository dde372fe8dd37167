//! All light sources of a scene, behind one `sample`/`pdf` pair.
//!
//! Emissive surfaces, cut into patches, and point lights are the leaves of a hierarchy ([`tree`]). Its upper end is a few dozen clusters.
//! Clusters, distant lights, the sky, and portals in the windows through which the sky is seen are the *sources* that [`LightChoice`]
//! chooses from; it has learned where the light of each arrives. Within a cluster the hierarchy chooses by distance, power and orientation.
//!
//! Glossy surfaces that the sun reaches are sources as well ([`glint`]), in a separate hierarchy.
//!
//! *Fixtures* ([`fixtures`]) are what people would call a lamp or a window; their light can be stored separately. Windows among them are
//! made of panes ([`panes`]) and are the same in every picture of a scene, unlike portals.
//!
//! A point light is one without a surface: point, spot and profile lights. A distant light is directional, and may have a disk.

mod bounds;
mod choice;
mod delta;
mod emissive_surfaces;
mod emitter;
mod environment;
mod fixtures;
mod glint;
mod learn;
mod lights;
mod panes;
mod photons;
mod sample;
mod sampling;
mod spherical;
mod sunlit;
#[cfg(test)]
mod tests;
mod tree;
mod window;

pub(crate) use choice::LightChoice;
pub(crate) use fixtures::Fixtures;
pub use fixtures::{Fixture, FixtureKind};
pub(crate) use lights::Lights;
pub(crate) use photons::PhotonSources;
pub(crate) use sample::{Background, LightKind, LightPoint, LightSample, power_heuristic};
