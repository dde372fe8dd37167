//! The pictures of a frame: a layer, or an array that was derived from the frame later or is stored separately. Each has a name in
//! addresses, a file, and a description in the terms of the table of layers, so that the page can treat it like a layer.

use super::derived_files::{PLANE, READINGS, REFRACTED, SURFACES};
use enfilade_dataset::check_name;
use enfilade_frame::Layer;

/// The layers of which a fixture has a part, with what the page calls them.
pub const FIXTURE_PARTS: [(Layer, &str); 2] = [(Layer::DiffuseIllumination, "illumination"), (Layer::Residual, "residual")];
/// The layers that a mix of fixtures has of its own.
pub const MIXED: [Layer; 3] = [Layer::Color, Layer::DiffuseIllumination, Layer::Residual];
/// The layers that lead from a frame to any other, with what the page calls them.
pub const LEADING: [(Layer, &str); 3] =
    [(Layer::OpticalFlow, "optical flow"), (Layer::SceneFlow, "scene flow"), (Layer::FlowVisibility, "visibility")];

/// A picture of a frame; in the order in which the page lists pictures of one kind.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FramePicture {
    /// A layer.
    Layer(Layer),
    /// The part of a layer that comes from one fixture, from 1 on.
    Fixture { fixture: u32, part: Layer },
    /// A layer as a mix of fixtures makes it.
    Mix { mix: String, layer: Layer },
    /// One of [`SURFACES`], of the first, second, … surface along the ray.
    Surface { nth: usize, what: usize },
    /// One of [`REFRACTED`].
    Refracted { what: usize },
    /// The visible plane of the scene's rooms.
    Plane,
    /// A layer that leads to another frame of the scene.
    To { camera: String, frame: u32, layer: Layer },
    /// One of [`READINGS`] of a sensor.
    Sensed { sensor: String, what: usize },
}

impl FramePicture {
    /// Name of the picture in addresses. It has no colon, which divides words there.
    pub fn name(&self) -> String {
        match self {
            Self::Layer(layer) => layer.spec().name.into(),
            Self::Fixture { fixture, part } => format!("fixture_{fixture:02}_{}", part.spec().name),
            Self::Mix { mix, layer } => format!("mix.{mix}.{}", layer.spec().name),
            Self::Surface { nth, what } => format!("{}.{nth}", SURFACES[*what].name),
            Self::Refracted { what } => REFRACTED[*what].name.into(),
            Self::Plane => PLANE.into(),
            Self::To { camera, frame, layer } => format!("to.{camera}.{frame}.{}", layer.spec().name),
            Self::Sensed { sensor, what } => format!("sensor.{sensor}.{}", READINGS[*what].name),
        }
    }

    /// The picture of this name; `None` where there can be none. The names in it are safe as parts of paths.
    pub fn from_name(name: &str) -> Option<Self> {
        let named = |what: &'static str, name: &str| check_name(what, name).is_ok().then(|| name.to_string());
        let picture = if let Some(layer) = Layer::from_name(name) {
            Self::Layer(layer)
        } else if let Some(rest) = name.strip_prefix("fixture_") {
            let (fixture, part) = rest.split_once('_')?;
            let part = FIXTURE_PARTS.iter().find(|(layer, _)| layer.spec().name == part)?.0;
            Self::Fixture { fixture: fixture.parse().ok()?, part }
        } else if let Some(rest) = name.strip_prefix("mix.") {
            let (mix, layer) = rest.rsplit_once('.')?;
            let layer = MIXED.into_iter().find(|known| known.spec().name == layer)?;
            Self::Mix { mix: named("mix", mix)?, layer }
        } else if let Some(rest) = name.strip_prefix("to.") {
            let (frame, layer) = rest.rsplit_once('.')?;
            let (camera, frame) = frame.rsplit_once('.')?;
            let layer = LEADING.iter().find(|(known, _)| known.spec().name == layer)?.0;
            Self::To { camera: named("camera name", camera)?, frame: frame.parse().ok()?, layer }
        } else if let Some(rest) = name.strip_prefix("sensor.") {
            let (sensor, reading) = rest.rsplit_once('.')?;
            let what = READINGS.iter().position(|known| known.name == reading)?;
            Self::Sensed { sensor: named("sensor name", sensor)?, what }
        } else if name == PLANE {
            Self::Plane
        } else if let Some((what, nth)) = name.rsplit_once('.') {
            let what = SURFACES.iter().position(|known| known.name == what)?;
            Self::Surface { nth: nth.parse().ok().filter(|&nth| nth > 0)?, what }
        } else {
            Self::Refracted { what: REFRACTED.iter().position(|known| known.name == name)? }
        };
        // `parse` accepts signs and zeros in front, which would give one picture several names.
        (picture.name() == name).then_some(picture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_pictures() {
        for picture in [
            FramePicture::Layer(Layer::SurfaceTraits),
            FramePicture::Fixture { fixture: 3, part: Layer::Residual },
            FramePicture::Mix { mix: "late.evening".into(), layer: Layer::Color },
            FramePicture::Surface { nth: 12, what: 1 },
            FramePicture::Refracted { what: 0 },
            FramePicture::Plane,
            FramePicture::To { camera: "cam.left".into(), frame: 7, layer: Layer::OpticalFlow },
            FramePicture::Sensed { sensor: "kinect-v1.5".into(), what: 0 },
        ] {
            assert_eq!(FramePicture::from_name(&picture.name()), Some(picture.clone()), "{}", picture.name());
        }
    }

    #[test]
    fn what_is_no_name_of_a_picture_is_none() {
        for name in [
            "",
            "colour",
            "fixture_3_residual",
            "fixture_+3_residual",
            "fixture_03_color",
            "fixture_99999999999_residual",
            "surface_side",
            "surface_side.0",
            "surface_side.01",
            "refracted_side",
            "mix...color",
            "mix.a/b.color",
            "to.cam_00.optical_flow",
            "to..1.optical_flow",
            "to.cam_00.01.optical_flow",
            "to.cam_00.1.color",
            "sensor...color",
            "sensor.phone",
        ] {
            assert_eq!(FramePicture::from_name(name), None, "{name:?}");
        }
    }
}
