//! Light transport: a [`Scene`](enfilade_scene::Scene) and a camera to a [`Frame`](enfilade_frame::Frame) with every layer.
//!
//! A unidirectional path tracer with next-event estimation and multiple importance sampling. Nothing is clamped, denoised or truncated
//! except by the fields of [`RenderConfig`]. A frame is made in three steps: [`RenderScene::new`] prepares rays and lights,
//! [`Guide::learn`] learns where light comes from, and [`render_frame`] renders the pixels. Per pixel, `camera_path` and `integrator`
//! follow light paths, `film` turns their sums into the stored colour layers, and `geometry_pass` finds the surface that the ray through
//! the pixel's centre meets. A [`Lookout`] does only the latter, before light is computed.
//!
//! ```
//! use enfilade_frame::Layer;
//! use enfilade_geometry::Mesh;
//! use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
//! use enfilade_render::{Guide, RenderConfig, RenderError, RenderScene, render_frame};
//! use enfilade_scene::{Camera, CameraView, Environment, Intrinsics, Material, Part, Pose, Quiet, Scene};
//!
//! // A grey wall across x = 2 m, under a white sky.
//! let corners = [[2.0, -9.0, -9.0], [2.0, -9.0, 9.0], [2.0, 9.0, 9.0], [2.0, 9.0, -9.0]];
//! let mesh = Mesh { positions: corners.map(Vec3::from).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
//! let scene = Scene {
//!     meshes: vec![mesh.into()],
//!     materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
//!     parts: vec![Part { name: "wall".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
//!     environment: Some(Environment::Constant { radiance: Rgb::WHITE }),
//!     ..Scene::default()
//! };
//!
//! // A camera at the origin that looks along x, with z up.
//! let camera = Camera::from(Intrinsics::from_fov_x(16, 12, 1.0));
//! let pose = Pose::look_at(0, DVec3::ZERO, DVec3::X, DVec3::Z).expect("x is not up");
//! let view = CameraView::still(&camera, &pose);
//!
//! let prepared = RenderScene::new(&scene, &Quiet)?;
//! let config = RenderConfig { samples: 8, ..RenderConfig::default() };
//! let guide = Guide::learn(&prepared, &[view], &config);
//! let frame = render_frame(&prepared, &guide, &view, &config, &Quiet)?;
//!
//! // Every pixel is 2 m deep, and reflects half of the sky's radiance of 1.
//! let depth_z_m = frame.get(Layer::DepthZMeters).expect("rendered");
//! assert!((0..frame.pixels()).all(|pixel| (depth_z_m.get(pixel) - 2.0).abs() < 1e-5));
//! let color = frame.get(Layer::Color).expect("rendered");
//! let mean = (0..color.len()).map(|i| color.get(i)).sum::<f64>() / color.len() as f64;
//! assert!((mean - 0.5).abs() < 0.05, "{mean}");
//! # Ok::<(), RenderError>(())
//! ```
//!
//! `examples/scene_to_frame.rs` renders a scene file to the files of a frame.
//!
//! `bsdf` scatters, `light` emits; both have the same `sample`/`pdf` shape, so that one statistical test serves both.

mod beyond;
mod bsdf;
mod budget;
mod camera_path;
mod config;
mod error;
mod extra;
mod film;
mod geometry_pass;
mod glass;
mod guide;
mod integrator;
mod layers;
mod light;
mod light_parts;
mod look;
mod opacity;
mod partial;
mod pixel_sample;
mod prepared;
mod probe;
mod render;
mod rows;
mod sampling;
mod surface;
mod texture;
mod tile_film;
mod tiles;
mod triangle;
mod triangle_point;
mod triangles;
mod vertex;
mod walk;

pub use config::{Filter, RenderConfig, RenderKeys};
pub use error::RenderError;
pub use extra::surfaces::{Bent, RaySurfaces};
pub use extra::{FlowTo, add_extra_layers};
pub use guide::Guide;
pub use light::{Fixture, FixtureKind};
pub use look::{Look, Lookout};
pub use partial::PartialError;
pub use prepared::RenderScene;
pub use probe::{Probe, samples_wanted};
pub use render::{FrameRender, render_frame};
pub use rows::{Moved, Rows, Ways};
pub use triangle_point::TrianglePoint;
