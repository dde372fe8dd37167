//! Light through solid glass, found from the point where it arrives.
//!
//! Glass bends light, so a straight shadow ray finds no light behind it. A *shot* ([`shot`]) passes smooth borders by the law of refraction
//! and carries the derivatives of its end by its first direction (Igehy 1999, "Tracing Ray Differentials"). It is used in two ways:
//!
//! - **Panes**: a ray that enters a body and leaves it through flat parallel borders keeps its direction ([`inside`]). Light
//!   samples of every light reach through them, and the power heuristic weights these against sampled directions as it does in the open: a
//!   path that leaves a body so continues as if it had not been bent. The reflections between both borders are added up with the ray that
//!   passes at once, a few millimetres beside where they leave: exact where the light and the pane are wide. For a light at a point the
//!   direction is corrected until the shot meets it, and the spread of the light follows from the derivatives of the shot's end, so the
//!   shift by thick glass is exact.
//! - **Other glass** (globes, bulbs, bottles, blocks seen through two sides): lights without a surface, which no sampled direction meets, are
//!   aimed at by Newton's method on the first direction ([`connect`]; Hanika, Droske & Fascione 2015, "Manifold Next Event Estimation"). It
//!   begins at random directions towards the light and towards bodies ([`bodies`]), and how often another random one ends on the same way
//!   estimates how many ways there are, without bias (Zeltner, Georgiev & Jakob 2020, "Specular Manifold Sampling"). Places that see the
//!   light past the glass look for such ways too, with a chance by how large the bodies seem from there. Ways that are reflected inside of
//!   glass are not found. Lights with a surface are left to sampled directions there.

mod bodies;
mod connect;
mod inside;
mod shot;

pub(crate) use bodies::Bodies;
pub(crate) use connect::Connection;
pub(crate) use inside::{Inside, are_parallel, refracted, repeated};
