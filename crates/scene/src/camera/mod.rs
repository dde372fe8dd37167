//! Cameras: which direction belongs to which image point, the lens, and the shutter.
//!
//! Camera space has x right, y up and z backward. Image coordinates have x to the right and y downward, and (0,0) is the upper left
//! *corner* of the image. One [`Projection`] serves the renderer, the files and their verification, so that pictures and
//! calibration cannot differ. [`CameraView`] is a camera at the moment of a frame.

mod error;
mod fisheye;
mod intrinsics;
mod lens;
mod projection;
mod radial_tangential;
mod ray_grid;
mod roots;
mod start;
mod tilted;
mod view;

pub use error::CameraError;
pub use fisheye::Fisheye;
pub use intrinsics::Intrinsics;
pub use lens::{Shutter, ThinLens};
pub use projection::Projection;
pub use radial_tangential::RadialTangential;
pub use ray_grid::RayGrid;
pub use start::StartCamera;
pub use tilted::TiltedPinhole;
pub use view::{CameraRay, CameraView, band_of_row};

/// A camera that frames are taken with.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Image size, and which direction belongs to which image point.
    pub projection: Projection,
    /// `None`: everything is in focus.
    pub lens: Option<ThinLens>,
    /// `None`: the camera stands still for each frame.
    pub shutter: Option<Shutter>,
}

impl From<Intrinsics> for Camera {
    /// A pinhole, in focus and at rest.
    fn from(intrinsics: Intrinsics) -> Self {
        Projection::Pinhole(intrinsics).into()
    }
}

impl From<Projection> for Camera {
    /// In focus and at rest.
    fn from(projection: Projection) -> Self {
        Self { projection, lens: None, shutter: None }
    }
}

impl Camera {
    /// Image width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.projection.size()
    }

    /// The calibration of a pinhole that is in focus and at rest: the cameras that K describes completely.
    pub fn plain_pinhole(&self) -> Option<&Intrinsics> {
        match (&self.projection, &self.lens, &self.shutter) {
            (Projection::Pinhole(intrinsics), None, None) => Some(intrinsics),
            _ => None,
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first one out of its domain.
    pub fn validate(&self) -> Result<(), CameraError> {
        self.projection.validate()?;
        self.lens.map_or(Ok(()), |lens| lens.validate(self.projection.has_image_plane()))?;
        self.shutter.map_or(Ok(()), |shutter| shutter.validate())
    }
}
