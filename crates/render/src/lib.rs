//! Light transport: a [`Scene`](enfilade_scene::Scene) and a camera to a [`Frame`](enfilade_frame::Frame) with every layer.
//!
//! A unidirectional path tracer with next-event estimation and multiple importance sampling. Nothing is clamped, denoised or
//! cut short but by the fields of [`RenderConfig`]. The way of a frame: [`RenderScene::new`] prepares rays and lights,
//! [`render_frame`] walks the pixels; per pixel, `integrator` samples light paths, `film` turns their sums into the stored
//! colour layers, and `geometry_pass` finds what the ray through the pixel's centre meets. A [`Lookout`] sees the latter alone, before
//! light is computed.
//!
//! `bsdf` scatters, `light` emits; both have the same `sample`/`pdf` shape, so that one statistical test serves both.

mod batch;
mod bsdf;
mod budget;
mod config;
mod error;
mod extra;
mod film;
mod geometry_pass;
mod guide;
mod integrator;
mod layers;
mod light;
mod look;
mod partial;
mod prepared;
mod probe;
mod render;
mod reuse;
mod sampling;
mod split;
mod surface;
mod texture;
mod tiles;
mod triangle;
mod triangles;
mod vertex;
mod walk;

pub use config::{Filter, RenderConfig};
pub use error::RenderError;
pub use extra::add_extra_layers;
pub use guide::Guide;
pub use look::{Look, Lookout};
pub use partial::PartialError;
pub use prepared::RenderScene;
pub use probe::{Probe, samples_wanted};
pub use render::{FrameRender, render_frame};
