//! The table of products.

use super::record::{Asked, Part};
use super::sources::{Source, Subject};
use super::{flow, pairs, relit, rooms, sensors, surfaces, tracks, whole, words};
use crate::error::Error;
use crate::request::{Product, Request, Scope};
use enfilade_frame::Layer;
use enfilade_scene::Cx;
use std::path::PathBuf;

/// When a product is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// By every run that makes pictures.
    Always,
    /// On request: by a verb, in Python or by a key of `dataset.toml`.
    Asked,
}

/// The definition of a product.
pub struct ProductSpec {
    /// Which one.
    pub product: Product,
    /// The word for it on the command line, in `dataset.toml` and in the name of its record.
    pub name: &'static str,
    /// Description of the product.
    pub about: &'static str,
    /// When it is made.
    pub when: When,
    /// Scope of its parts.
    pub scope: Scope,
    /// Inputs of its parts, beside the options of the request.
    pub(crate) reads: &'static [Source],
    /// Changes whenever the same inputs give other files.
    pub(crate) version: u32,
    /// The layers that it reads of each frame of a part.
    pub(crate) layers: fn(&Request) -> Vec<Layer>,
    /// The parts of a request.
    pub(crate) parts: fn(&Subject, &Request) -> Result<Vec<Part>, Error>,
    /// Makes parts, and returns lines about what it made.
    pub(crate) make: Maker,
    /// The existing files of a part that was made.
    pub(crate) files: fn(&Subject, &Part) -> Result<Vec<PathBuf>, Error>,
}

/// Makes parts of a product, and returns lines about what it made.
type Maker = fn(&Subject, &[Asked], &dyn Cx) -> Result<Vec<String>, Error>;

/// All products in the order in which they are made: each after those that it reads.
pub const PRODUCTS: [ProductSpec; 11] = [
    ProductSpec {
        product: Product::Covisibility,
        name: Product::Covisibility.name(),
        about: "The share of each frame's surfaces that each other frame of the scene sees",
        when: When::Asked,
        scope: Product::Covisibility.scope(),
        reads: &[Source::Frames, Source::Poses, Source::Package],
        version: 1,
        layers: |_| vec![Layer::DepthMeters],
        parts: pairs::covisibility_parts,
        make: pairs::make_covisibility,
        files: pairs::covisibility_files,
    },
    ProductSpec {
        product: Product::Pairs,
        name: Product::Pairs.name(),
        about: "Which frames see the same surfaces: shares, baselines and angles of all view pairs of a scene",
        when: When::Asked,
        scope: Product::Pairs.scope(),
        reads: &[Source::Product(Product::Covisibility)],
        version: 1,
        layers: |_| Vec::new(),
        parts: pairs::parts,
        make: pairs::make,
        files: pairs::files,
    },
    ProductSpec {
        product: Product::Flow,
        name: Product::Flow.name(),
        about: "Flow between any two frames of a scene, also of different cameras, forward and backward",
        when: When::Asked,
        scope: Product::Flow.scope(),
        reads: &[Source::Frames, Source::Poses, Source::Package, Source::ListedBy(Product::Pairs)],
        version: 1,
        layers: |_| Vec::new(),
        parts: flow::parts,
        make: flow::make,
        files: flow::files,
    },
    ProductSpec {
        product: Product::Tracks,
        name: Product::Tracks.name(),
        about: "Points on surfaces, followed through the frames of each camera, in TAP-Vid's layout",
        when: When::Asked,
        scope: Product::Tracks.scope(),
        reads: &[Source::Frames, Source::Poses, Source::Package],
        version: 1,
        layers: |_| vec![Layer::DepthMeters],
        parts: tracks::parts,
        make: tracks::make,
        files: tracks::files,
    },
    ProductSpec {
        product: Product::Surfaces,
        name: Product::Surfaces.name(),
        about: "Every surface along the ray of each pixel, front and back, and what is behind glass with refraction",
        when: When::Asked,
        scope: Product::Surfaces.scope(),
        reads: &[Source::Frames, Source::Poses, Source::Package, Source::Labels],
        version: 1,
        layers: |_| Vec::new(),
        parts: surfaces::parts,
        make: surfaces::make,
        files: surfaces::files,
    },
    ProductSpec {
        product: Product::Rooms,
        name: Product::Rooms.name(),
        about: "Rooms, walls, doors and windows of scenes without a plan, and the plane that each pixel shows",
        when: When::Asked,
        scope: Product::Rooms.scope(),
        reads: &[Source::Frames, Source::Package, Source::Labels],
        version: 1,
        layers: |_| vec![Layer::Position, Layer::Semantic],
        parts: rooms::parts,
        make: rooms::make,
        files: rooms::files,
    },
    ProductSpec {
        product: Product::Words,
        name: Product::Words.name(),
        about: "Attributes and relations of things, captions, questions with answers",
        when: When::Asked,
        scope: Product::Words.scope(),
        reads: &[Source::Frames, Source::Poses, Source::Package, Source::Labels, Source::Product(Product::Rooms)],
        version: 1,
        layers: |_| vec![Layer::SemanticInstance, Layer::DepthMeters, Layer::DiffuseReflectance],
        parts: words::parts,
        make: words::make,
        files: words::files,
    },
    ProductSpec {
        product: Product::Sensors,
        name: Product::Sensors.name(),
        about: "Readings of simulated cameras and depth sensors",
        when: When::Asked,
        scope: Product::Sensors.scope(),
        reads: &[Source::Frames, Source::Poses],
        version: 1,
        layers: sensors::layers,
        parts: sensors::parts,
        make: sensors::make,
        files: sensors::files,
    },
    ProductSpec {
        product: Product::Relit,
        name: Product::Relit.name(),
        about: "Frames with lamps switched, dimmed and tinted",
        when: When::Asked,
        scope: Product::Relit.scope(),
        reads: &[Source::WholeFrames, Source::Exposures, Source::Fixtures],
        version: 1,
        layers: |_| Vec::new(),
        parts: relit::parts,
        make: relit::make,
        files: relit::files,
    },
    ProductSpec {
        product: Product::Sheet,
        name: Product::Sheet.name(),
        about: "One picture of each trajectory of the dataset",
        when: When::Always,
        scope: Product::Sheet.scope(),
        reads: &[Source::Pictures],
        version: 1,
        layers: |_| Vec::new(),
        parts: whole::parts,
        make: whole::make,
        files: whole::sheet_files,
    },
    ProductSpec {
        product: Product::Statistics,
        name: Product::Statistics.name(),
        about: "Numbers and charts of the dataset",
        when: When::Always,
        scope: Product::Statistics.scope(),
        reads: &[Source::Pictures],
        version: 1,
        layers: |_| Vec::new(),
        parts: whole::parts,
        make: whole::make,
        files: whole::statistics_files,
    },
];

impl Product {
    /// The product's row of the table.
    pub fn spec(self) -> &'static ProductSpec {
        &PRODUCTS[self as usize]
    }

    /// The product of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        PRODUCTS.iter().find(|spec| spec.name == name).map(|spec| spec.product)
    }
}

impl ProductSpec {
    /// The products whose files it reads.
    pub fn products(&self) -> impl Iterator<Item = Product> {
        self.reads.iter().filter_map(|source| if let Source::Product(product) = source { Some(*product) } else { None })
    }

    /// The products that are made before it: those that it reads, and those that may list its parts.
    pub fn after(&self) -> impl Iterator<Item = Product> {
        self.reads.iter().filter_map(|source| match source {
            Source::Product(product) | Source::ListedBy(product) => Some(*product),
            _ => None,
        })
    }

    /// True if it belongs to scenes, but is made after a product of the dataset as a whole.
    pub(crate) fn is_late(&self) -> bool {
        self.scope != Scope::Dataset && self.after().any(|product| product.spec().scope == Scope::Dataset)
    }
}
