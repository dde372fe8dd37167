//! The table of formats: names, contents, and the layers that they need.

use enfilade_frame::Layer;

/// A layout that other programs load.
///
/// ```
/// use enfilade_export::Format;
/// use enfilade_frame::Layer;
/// let coco = Format::from_name("coco").unwrap();
/// assert!(coco.spec().needs.contains(&[Layer::SemanticInstance].as_slice()));
/// assert_eq!(Format::from_name("yolo"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "FORMATS documents each one")]
pub enum Format {
    Coco,
    Bop,
    Nerfstudio,
    Colmap,
    ColmapText,
    Scannet,
    Exr,
    DepthPng,
    Webdataset,
    Croissant,
    Opencv,
    Pix3d,
    Huggingface,
    Spatiallm,
    Structured3d,
    Tum,
    Euroc,
    Replica,
    Panoptic,
    Wai,
    Points,
    Dust3r,
    Marigold,
    Moge,
}

/// A row of the table of formats.
#[derive(Clone, Copy, Debug)]
pub struct FormatSpec {
    /// Which one.
    pub format: Format,
    /// Name on the command line.
    pub name: &'static str,
    /// One sentence: what is in it.
    pub about: &'static str,
    /// Groups of layers, of each of which one must be there.
    pub needs: &'static [&'static [Layer]],
    /// Layers that are written where they are there; `None`: any layer of the table can be.
    pub takes: Option<&'static [Layer]>,
    /// True if it has a mesh, points or models of the world, or poses of things in it, that hold for all frames: scenes that move have none.
    pub needs_still: bool,
    /// The page for people that goes with the files: contents and conventions.
    pub readme: &'static str,
}

const COLOR: &[Layer] = &[Layer::Color];
const DEPTH: &[Layer] = &[Layer::DepthMeters, Layer::DepthZMeters];
const DISTANCE: &[Layer] = &[Layer::DepthMeters];
const INSTANCE: &[Layer] = &[Layer::SemanticInstance];
const SEMANTIC: &[Layer] = &[Layer::Semantic];
const SHAPED: &[Layer] = &[Layer::Color, Layer::RenderEntityId, Layer::Semantic, Layer::SemanticInstance];
const LABELLED: &[Layer] =
    &[Layer::Color, Layer::RenderEntityId, Layer::DepthMeters, Layer::DepthZMeters, Layer::Semantic, Layer::SemanticInstance];
const POSED: &[Layer] = &[Layer::Color, Layer::RenderEntityId, Layer::DepthMeters, Layer::DepthZMeters];

/// The table of formats; `FORMATS[format as usize].format == format`.
pub const FORMATS: [FormatSpec; 24] = [
    FormatSpec {
        format: Format::Coco,
        name: "coco",
        about: "COCO instances: images, annotations with compressed RLE masks and boxes, the 40 classes of NYU40 or of the scenes' own list",
        needs: &[COLOR, INSTANCE, SEMANTIC],
        takes: Some(LABELLED),
        needs_still: false,
        readme: include_str!("readmes/coco.md"),
    },
    FormatSpec {
        format: Format::Bop,
        name: "bop",
        about: "BOP: colour, depth, masks, object poses, camera matrices, models of the objects",
        needs: &[COLOR, DEPTH, INSTANCE],
        takes: Some(LABELLED),
        needs_still: false,
        readme: include_str!("readmes/bop.md"),
    },
    FormatSpec {
        format: Format::Nerfstudio,
        name: "nerfstudio",
        about: "nerfstudio: transforms.json, images, depth, a coloured point cloud",
        needs: &[COLOR, DISTANCE],
        takes: Some(POSED),
        needs_still: true,
        readme: include_str!("readmes/nerfstudio.md"),
    },
    FormatSpec {
        format: Format::Colmap,
        name: "colmap",
        about: "COLMAP: a sparse model in binary files, and its images",
        needs: &[COLOR, DISTANCE],
        takes: Some(POSED),
        needs_still: true,
        readme: include_str!("readmes/colmap.md"),
    },
    FormatSpec {
        format: Format::ColmapText,
        name: "colmap-text",
        about: "COLMAP: a sparse model in text files, and its images",
        needs: &[COLOR, DISTANCE],
        takes: Some(POSED),
        needs_still: true,
        readme: include_str!("readmes/colmap.md"),
    },
    FormatSpec {
        format: Format::Scannet,
        name: "scannet",
        about: "ScanNet: colour, depth, poses, intrinsics, label and instance images, and the mesh with labels",
        needs: &[DEPTH],
        takes: Some(LABELLED),
        needs_still: true,
        readme: include_str!("readmes/scannet.md"),
    },
    FormatSpec {
        format: Format::Exr,
        name: "exr",
        about: "multi-layer OpenEXR with every layer of a frame, and Cryptomatte layers of instances and classes",
        needs: &[],
        takes: None,
        needs_still: false,
        readme: include_str!("readmes/openexr.md"),
    },
    FormatSpec {
        format: Format::DepthPng,
        name: "depth-png",
        about: "16-bit PNG depth in millimetres, with cameras in JSON",
        needs: &[DEPTH],
        takes: Some(&[Layer::DepthMeters, Layer::DepthZMeters]),
        needs_still: false,
        readme: include_str!("readmes/depth_png.md"),
    },
    FormatSpec {
        format: Format::Webdataset,
        name: "webdataset",
        about: "WebDataset: tar shards with a PNG of the colour, a numpy array per layer, and JSON",
        needs: &[],
        takes: None,
        needs_still: false,
        readme: include_str!("readmes/webdataset.md"),
    },
    FormatSpec {
        format: Format::Croissant,
        name: "croissant",
        about: "Croissant: a card of the dataset in JSON-LD, with tables of its frames, layers and classes",
        needs: &[],
        takes: None,
        needs_still: false,
        readme: include_str!("readmes/croissant.md"),
    },
    FormatSpec {
        format: Format::Opencv,
        name: "opencv",
        about: "cameras alone, in OpenCV's conventions: K and poses as JSON, and a table of K",
        needs: &[],
        takes: None,
        needs_still: false,
        readme: include_str!("readmes/opencv.md"),
    },
    FormatSpec {
        format: Format::Pix3d,
        name: "pix3d",
        about: "Pix3D as Mesh R-CNN reads it: images, masks, a model and voxels per instance, poses in camera space",
        needs: &[COLOR, INSTANCE, SEMANTIC],
        takes: Some(SHAPED),
        needs_still: true,
        readme: include_str!("readmes/pix3d.md"),
    },
    FormatSpec {
        format: Format::Huggingface,
        name: "huggingface",
        about: "Hugging Face: Parquet files for `datasets.load_dataset`, with pictures of colour, depth and labels, cameras, and a card",
        needs: &[],
        takes: Some(LABELLED),
        needs_still: false,
        readme: include_str!("readmes/huggingface.md"),
    },
    FormatSpec {
        format: Format::Spatiallm,
        name: "spatiallm",
        about: "SpatialLM: walls, doors, windows and boxes of objects in its layout language, and the point cloud that it reads",
        needs: &[COLOR, DISTANCE],
        takes: Some(POSED),
        needs_still: true,
        readme: include_str!("readmes/spatiallm.md"),
    },
    FormatSpec {
        format: Format::Structured3d,
        name: "structured3d",
        about: "Structured3D: rooms, walls and openings as junctions, lines and planes, boxes of things, and points",
        needs: &[],
        takes: None,
        needs_still: true,
        readme: include_str!("readmes/structured3d.md"),
    },
    FormatSpec {
        format: Format::Tum,
        name: "tum",
        about: "TUM RGB-D: colour and depth by time, and the trajectory",
        needs: &[COLOR, DEPTH],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/tum.md"),
    },
    FormatSpec {
        format: Format::Euroc,
        name: "euroc",
        about: "EuRoC: grey pictures of a video, inertial measurements and the true motion",
        needs: &[COLOR],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/euroc.md"),
    },
    FormatSpec {
        format: Format::Replica,
        name: "replica",
        about: "Replica as NICE-SLAM has it: colour, depth, traj.txt and cam_params.json",
        needs: &[COLOR, DEPTH],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/replica.md"),
    },
    FormatSpec {
        format: Format::Panoptic,
        name: "panoptic",
        about: "COCO panoptic: images, PNG files of segments, panoptic.json",
        needs: &[COLOR, INSTANCE, SEMANTIC],
        takes: Some(LABELLED),
        needs_still: false,
        readme: include_str!("readmes/panoptic.md"),
    },
    FormatSpec {
        format: Format::Wai,
        name: "wai",
        about: "WAI, the layout of MapAnything's data: images, depth, poses and covisibility of each scene",
        needs: &[COLOR, DEPTH],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/wai.md"),
    },
    FormatSpec {
        format: Format::Points,
        name: "points",
        about: "a labelled point cloud of each scene, fused from its frames, as PLY",
        needs: &[COLOR, DISTANCE],
        takes: Some(&[
            Layer::Color,
            Layer::RenderEntityId,
            Layer::DepthMeters,
            Layer::NormalWorld,
            Layer::Semantic,
            Layer::SemanticInstance,
        ]),
        needs_still: true,
        readme: include_str!("readmes/points.md"),
    },
    FormatSpec {
        format: Format::Dust3r,
        name: "dust3r",
        about: "pairs for DUSt3R and MASt3R: images, 16-bit depth, K, poses, and pairs.csv as a list",
        needs: &[COLOR, DEPTH],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/dust3r.md"),
    },
    FormatSpec {
        format: Format::Marigold,
        name: "marigold",
        about: "Hypersim as Marigold prepares it: colour, planar depth in millimetres, normals, and lists of them by side of the partition",
        needs: &[COLOR, DEPTH],
        takes: Some(&[Layer::Color, Layer::RenderEntityId, Layer::DepthMeters, Layer::DepthZMeters, Layer::NormalCam]),
        needs_still: false,
        readme: include_str!("readmes/marigold.md"),
    },
    FormatSpec {
        format: Format::Moge,
        name: "moge",
        about: "MoGe: a folder per frame with its image, depth by logarithm and K over the image's size",
        needs: &[COLOR, DEPTH],
        takes: Some(POSED),
        needs_still: false,
        readme: include_str!("readmes/moge.md"),
    },
];

impl Format {
    /// The format's row of the table.
    pub const fn spec(self) -> &'static FormatSpec {
        &FORMATS[self as usize]
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        FORMATS.iter().find(|spec| spec.name == name).map(|spec| spec.format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum_and_what_is_needed_is_taken() {
        for (i, spec) in FORMATS.iter().enumerate() {
            assert_eq!(spec.format as usize, i);
            assert_eq!(Format::from_name(spec.name), Some(spec.format));
            assert!(spec.takes.is_none_or(|takes| spec.needs.iter().all(|group| group.iter().all(|layer| takes.contains(layer)))));
        }
    }
}
