//! The description of a picture: its name, and its numbers in the terms of the table of layers.

use super::derived_files::{READINGS, REFRACTED, ReadingKind, SURFACES, SurfaceFile};
use super::picture::{FIXTURE_PARTS, FramePicture, LEADING};
use enfilade_dataset::Fixture;
use enfilade_frame::{Dtype, Layer, Pass};
use serde::Serialize;

/// The description of a picture that is sent to the page.
#[derive(Clone, Debug, Serialize)]
pub struct PictureSpec {
    /// Name of the picture in addresses.
    name: String,
    /// For people.
    title: String,
    /// Group in the page's list.
    pass: Group,
    /// The layer, or kind of number that no layer has, that has the colours and names of its numbers.
    like: &'static str,
    /// Numbers per pixel.
    pub channels: usize,
    dtype: Dtype,
    /// Unit of the numbers; empty for pure ones.
    pub unit: &'static str,
    /// Coordinate or colour space; empty where there is none.
    pub space: &'static str,
    sentinel: &'static str,
    description: String,
}

/// Group of a picture in the page's list: the layers of a pass, or the pictures derived in one way.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
enum Group {
    Pass(Pass),
    Derived(&'static str),
}

impl From<Layer> for PictureSpec {
    fn from(layer: Layer) -> Self {
        let spec = layer.spec();
        Self {
            name: spec.name.into(),
            title: spec.name.into(),
            pass: Group::Pass(spec.pass),
            like: spec.name,
            channels: spec.channels,
            dtype: spec.dtype,
            unit: spec.unit,
            space: spec.space,
            sentinel: spec.sentinel,
            description: spec.description.into(),
        }
    }
}

impl FramePicture {
    /// The description of the picture; `fixtures` are the scene's, as far as they are known.
    pub fn spec(&self, fixtures: &[Fixture]) -> PictureSpec {
        let derived = |group, title: String, description: String, spec: PictureSpec| PictureSpec {
            name: self.name(),
            title,
            pass: Group::Derived(group),
            description,
            ..spec
        };
        match self {
            Self::Layer(layer) => (*layer).into(),
            Self::Fixture { fixture, part } => {
                let of_it = fixtures.iter().find(|known| known.id == *fixture);
                let name = of_it.map_or_else(|| "fixture".into(), |known| known.name.clone());
                let kind = of_it.map_or("", |known| &known.kind);
                let whole = part.spec().name;
                let title = format!("{fixture} {name}, {}", title_in(&FIXTURE_PARTS, *part));
                let thing = if kind == name || kind.is_empty() { name } else { format!("the {kind} {name}") };
                let description = format!("Part of {whole}, as it was rendered, that comes from {thing} (fixture {fixture}).");
                derived("fixtures", title, description, (*part).into())
            }
            Self::Mix { mix, layer } => {
                let name = layer.spec().name;
                derived("mixes", format!("{mix}, {name}"), format!("{name} with the fixtures as the mix {mix} has them."), (*layer).into())
            }
            Self::Surface { nth, what } => {
                let file = &SURFACES[*what];
                let spec = of_surface(file);
                derived(
                    "surfaces",
                    format!("surface {nth}, {}", file.title),
                    format!("Surface {nth} of each ray. {}", file.description),
                    spec,
                )
            }
            Self::Refracted { what } => {
                let file = &REFRACTED[*what];
                derived("surfaces", format!("behind glass, {}", file.title), file.description.into(), of_surface(file))
            }
            Self::Plane => {
                let what = "Floor, ceiling or wall of layout.json that the pixel shows, by its row in metadata_planes.csv; -1: none.";
                derived("rooms", "plane".into(), what.into(), number("plane", Dtype::I16, "-1"))
            }
            Self::To { camera, frame, layer } => {
                let (description, like) = match layer {
                    Layer::OpticalFlow => ("From the pixel's centre to where that frame shows the same surface point.", layer.spec().name),
                    Layer::SceneFlow => {
                        ("Position of the surface point in that camera's axes minus that in this one's.", layer.spec().name)
                    }
                    _ => ("1 where that frame shows the same surface point, 0 where it is hidden or outside the image.", "pair_visibility"),
                };
                let title = format!("to {camera} {frame}, {}", title_in(&LEADING, *layer));
                let spec = PictureSpec { like, ..(*layer).into() };
                derived("pairs", title, format!("To frame {frame} of {camera}. {description}"), spec)
            }
            Self::Sensed { sensor, what } => {
                let reading = &READINGS[*what];
                let (title, description, spec) = of_reading(reading.kind);
                derived("sensors", format!("{sensor}, {title}"), format!("What the sensor {sensor} reads. {description}"), spec)
            }
        }
    }
}

fn title_in(table: &[(Layer, &'static str)], layer: Layer) -> &'static str {
    table.iter().find(|(known, _)| *known == layer).map_or(layer.spec().name, |(_, title)| title)
}

fn of_surface(file: &SurfaceFile) -> PictureSpec {
    match file.like {
        Some(layer) => PictureSpec { sentinel: if layer.spec().dtype == Dtype::I16 { "-1" } else { "NaN" }, ..layer.into() },
        None => number("surface_side", Dtype::U8, "0"),
    }
}

/// Title, description and numbers of a reading.
fn of_reading(kind: ReadingKind) -> (&'static str, &'static str, PictureSpec) {
    match kind {
        ReadingKind::Layer(layer) => {
            let nothing = if layer == Layer::Color { "" } else { "NaN" };
            (layer.spec().name, layer.spec().description, PictureSpec { sentinel: nothing, ..layer.into() })
        }
        ReadingKind::Display => {
            let spec = PictureSpec { channels: 3, space: "sRGB", ..number("display", Dtype::U8, "") };
            ("picture", "A picture for people, 8 bits per channel.", spec)
        }
        ReadingKind::Raw => {
            let what = "The mosaic's values before white balance, whole numbers: red at even rows and columns, blue at odd ones.";
            ("raw", what, number("raw", Dtype::F32, ""))
        }
        ReadingKind::BeamDistances => {
            let spec = Layer::DepthMeters.into();
            ("distance of beams", "Distance along each beam: a row for each elevation, a column for each azimuth.", spec)
        }
        ReadingKind::BeamIntensities => {
            let what = "Diffuse reflectance times the cosine to the normal: a row for each elevation, a column for each azimuth.";
            ("intensity of beams", what, number("intensity", Dtype::F32, "0"))
        }
        ReadingKind::BeamParts => {
            let spec = Layer::RenderEntityId.into();
            ("part of beams", "The part that each beam meets: a row for each elevation, a column for each azimuth.", spec)
        }
    }
}

/// One number per pixel of a kind that no layer has.
fn number(like: &'static str, dtype: Dtype, sentinel: &'static str) -> PictureSpec {
    PictureSpec { like, channels: 1, dtype, unit: "", space: "", sentinel, ..Layer::DepthMeters.into() }
}
