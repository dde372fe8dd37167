//! The scene as validated plain data.
//!
//! World space is right-handed, z up, metres. A [`Scene`] that exists is valid: every index points at something and every
//! number is finite. Labels are kept apart from the scene ([`Labels`]), because they never enter the renderer.

mod atmosphere;
mod bodies;
mod body;
mod camera;
mod contrast;
mod cx;
mod deform;
mod drawn_plan;
mod edit;
mod environment;
mod git_lfs;
mod labels;
mod light;
mod lineage;
mod material;
mod motion;
mod nesting;
mod object;
mod package;
mod photometry;
mod picture_files;
mod pictures;
mod repictured;
mod room_ceilings;
mod room_planes;
mod rooms;
mod scene;
mod scene_files;
pub mod sky;
mod slope;
mod text;
mod texture;
mod trajectory;
mod world;

pub use body::{Body, BodyId, BodyMotion, BodyStates, DEFORM, RigidPose};
pub use camera::{
    Camera, CameraError, CameraRay, CameraView, Fisheye, Intrinsics, Projection, RadialTangential, RayGrid, Shutter, StartCamera, ThinLens,
    TiltedPinhole, band_of_row,
};
pub use cx::{Counted, Cx, Heard, Quiet, Warning};
pub use deform::Shape;
pub use drawn_plan::{DrawnOpening, DrawnPlan, DrawnRoom};
pub use edit::{EditError, LabelledScene, MaterialChoice, NewPart, NewThing, printable};
pub use environment::{Environment, MapRows, direction_from_uv, uv_from_direction};
pub use git_lfs::{GIT_LFS_POINTER, is_git_lfs_pointer};
pub use labels::{CEILING, FLOOR, Labels, NYU40, PartLabel, SemanticClass, WALL, is_stuff};
pub use light::{Light, SpotFalloff};
pub use material::{Alpha, Bsdf, ColorParam, Disney, Distribution, Material, NormalMap, Parameter, Principled, Roughness, ScalarParam};
pub use motion::{GRAVITY_M_S2, Motion, MotionSample, OPENCV};
pub use object::{Object, ObjectId};
pub use package::{
    FIRST_PACKAGE, PACKAGE_HEAD_BYTES, PackageError, from_bytes, from_bytes_beside, from_bytes_with_labels, is_current_package,
    is_jointed_package, is_moving_package, to_bytes, to_bytes_beside, to_bytes_with_labels,
};
pub use photometry::PhotometricWeb;
pub use picture_files::{PictureFile, PictureFiles};
pub use pictures::{PngEffort, smallest_png};
pub use room_planes::{PLANE_NEAR_M, PlaneKind, RoomPlane};
pub use rooms::{DoorLeaf, Hinge, OpeningKind, RoomJoint, RoomOutline, RoomThing, Rooms, RoomsFit, WallFace, WallOpening};
pub use scene::{Part, PartId, Scene, SceneError};
pub use scene_files::{EncodedScene, SceneFiles};
pub use slope::{CeilingSlope, Slope};
pub use text::{decoded_text, without_padding};
pub use texture::{Filter, Image, Pixels, TextureRef, Wrap};
pub use trajectory::{Pose, Trajectory};
pub use world::{TriangleSource, WorldMesh};
