//! Frames of a dataset as samples to train with.
//!
//! [`Samples`] is a list of frames, ours or those of Hypersim's release, with the requested layers. Frames are chosen by scene, camera and
//! side of the partition. Samples are cropped, resized and tone-mapped according to [`Options`], with mask, K and pose. A sample is a
//! function of (options, seed, epoch, index) and of nothing else. [`Stream`] decodes samples ahead on several threads and gives them in
//! order.
//!
//! ```
//! use enfilade_dataset::Dataset;
//! use enfilade_loader::{Choice, Crop, CropPlace, Options, Samples};
//! # use enfilade_dataset::{FrameInfo, FrameTime};
//! # use enfilade_frame::{Frame, Layer, Values};
//! # use enfilade_math::{DMat3, DVec3};
//! # use enfilade_scene::{Camera, Intrinsics, Pose, Projection, Trajectory};
//! # let folder = tempfile::tempdir()?;
//! # let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 20.0, cy: 15.0, skew: 0.0 };
//! # let camera: Camera = Projection::Pinhole(k).into();
//! # let pose = Pose { frame: 0, position: DVec3::ZERO, look_at: DVec3::NEG_Z, world_from_camera: DMat3::IDENTITY };
//! # let written = Dataset::create(folder.path())?;
//! # written.write_camera_parameters("room", &camera)?;
//! # written.write_trajectory("room", &Trajectory { name: "cam_00".into(), poses: vec![pose] }, &camera, None)?;
//! # let mut frame = Frame::new(40, 30);
//! # frame.insert(Layer::DepthMeters, Values::F32(vec![2.0; 1200]));
//! # let info = FrameInfo { seed: 1, samples: 1, config_hash: "x".into(), pose, camera, sampling: None, recipe: None };
//! # written.write_frame("room", "cam_00", &frame, &info, FrameTime::default())?;
//! let crop = Crop { size: [20, 20], place: CropPlace::Center };
//! let options = Options { crop: Some(crop), resize: Some([10, 10]), ..Options::default() };
//! let samples = Samples::open(Dataset::open(folder.path())?, &Choice::default(), options)?;
//! let sample = samples.sample(0, 0)?;
//! let (layer, depth) = &sample.layers[0];
//! assert_eq!((layer.spec().name, depth.height, depth.width), ("depth_meters", 10, 10));
//! // The camera's focal length is 33 pixels: a crop keeps it, and half the size halves it.
//! assert_eq!(sample.k.unwrap()[0][0], 16.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`NyuV2`] gives samples of the same kind from that dataset's published file.
//!
//! Only a [`Stream`] keeps threads between calls, so a process may be forked while it has [`Samples`].

pub mod confusion;
mod error;
mod in_memory;
mod nyuv2;
mod options;
mod order;
mod resize;
mod sample;
mod samples;
mod stream;
mod tone;

pub use error::LoaderError;
pub use in_memory::sample_of;
pub use nyuv2::{NYU_LAYERS, NyuChoice, NyuClasses, NyuSide, NyuV2, PUBLISHED_IMAGES, nyu13_of_nyu40, side_of};
pub use options::{Choice, Crop, CropPlace, Options};
pub use order::shuffled;
pub use sample::{Image, Matrix3, Matrix4, Sample, Values};
pub use samples::{FrameName, Samples};
pub use stream::Stream;
