//! Contents of the files of surfaces along rays, of planes and of sensors: tables with the names and descriptions of their pictures.

use enfilade_frame::Layer;

/// A file of surfaces along rays.
pub struct SurfaceFile {
    /// Name of the layer, as in `frame.IIII.<name>.hdf5`.
    pub name: &'static str,
    /// Title on the page.
    pub title: &'static str,
    /// The layer that has the same numbers of the surface that is seen; `None`: the side.
    pub like: Option<Layer>,
    /// Its meaning for a surface.
    pub description: &'static str,
}

/// Files with some numbers for each surface, of which a picture shows one.
pub const SURFACES: [SurfaceFile; 5] = [
    SurfaceFile {
        name: "surface_distance_meters",
        title: "distance",
        like: Some(Layer::DepthMeters),
        description: "Distance from the camera centre along the pixel's ray, which goes straight on through all surfaces.",
    },
    SurfaceFile {
        name: "surface_normal_world",
        title: "normal",
        like: Some(Layer::NormalWorld),
        description: "Unit normal of the flat triangle, facing the camera.",
    },
    SurfaceFile {
        name: "surface_entity_id",
        title: "part",
        like: Some(Layer::RenderEntityId),
        description: "Part number from 1, as in render_entity_id.",
    },
    SurfaceFile {
        name: "surface_semantic",
        title: "class",
        like: Some(Layer::Semantic),
        description: "Class of the part; -1 without one.",
    },
    SurfaceFile {
        name: "surface_side",
        title: "side",
        like: None,
        description: "1: the front is seen, to which outward normals point; 2: the back; 0 beyond the last surface.",
    },
];

/// The file with the number of surfaces per pixel of a frame.
pub const FIRST_SURFACES: &str = SURFACES[0].name;
/// No more surfaces per pixel are listed.
pub const MOST_SURFACES: usize = 64;

/// Files of the first surface that lets no light through, on the way that glass bends.
pub const REFRACTED: [SurfaceFile; 3] = [
    SurfaceFile {
        name: "refracted_distance_meters",
        title: "distance",
        like: Some(Layer::DepthMeters),
        description: "Length of the way to the first surface that lets no light through, as glass bends it.",
    },
    SurfaceFile { name: "refracted_position", title: "position", like: Some(Layer::Position), description: "Where that way ends." },
    SurfaceFile {
        name: "refracted_entity_id",
        title: "part",
        like: Some(Layer::RenderEntityId),
        description: "The part that the way ends on.",
    },
];

/// The file of the planes of rooms that pixels show.
pub const PLANE: &str = "plane_id";

/// A reading of a sensor that is shown as a picture.
pub struct Reading {
    /// Name in addresses.
    pub name: &'static str,
    /// Name in files, as in `frame.IIII.<file>`.
    pub file: &'static str,
    /// Kind of its contents.
    pub kind: ReadingKind,
}

/// Contents of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadingKind {
    /// The numbers of a layer.
    Layer(Layer),
    /// A picture for people, 8 bits a channel.
    Display,
    /// The mosaic of a camera, 16 bits.
    Raw,
    /// Distances of a lidar, beam by beam.
    BeamDistances,
    /// Shares of a lidar's light that returned, beam by beam.
    BeamIntensities,
    /// Parts that a lidar's beams met.
    BeamParts,
}

/// The readings that are shown.
pub const READINGS: [Reading; 9] = [
    Reading { name: "color", file: "color.hdf5", kind: ReadingKind::Layer(Layer::Color) },
    Reading { name: "color_jpg", file: "color.jpg", kind: ReadingKind::Display },
    Reading { name: "color_png", file: "color.png", kind: ReadingKind::Display },
    Reading { name: "raw", file: "raw.png", kind: ReadingKind::Raw },
    Reading { name: "depth_meters", file: "depth_meters.hdf5", kind: ReadingKind::Layer(Layer::DepthMeters) },
    Reading { name: "depth_z_meters", file: "depth_z_meters.hdf5", kind: ReadingKind::Layer(Layer::DepthZMeters) },
    Reading { name: "scan_distances", file: SCAN, kind: ReadingKind::BeamDistances },
    Reading { name: "scan_intensities", file: SCAN, kind: ReadingKind::BeamIntensities },
    Reading { name: "scan_parts", file: SCAN, kind: ReadingKind::BeamParts },
];

/// All that a lidar has seen of a frame.
pub const SCAN: &str = "scan.npz";
/// Readings of an inertial unit from one frame to the next: a table, which the page links to.
pub const INERTIAL: &str = "imu.csv";
