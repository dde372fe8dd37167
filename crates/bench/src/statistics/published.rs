//! Numbers that others have published, with their sources.

/// Instances of each NYU40 class, by id from 1, that at least one of Hypersim's images shows: `metadata_unique_objects_per_class_hist`
/// of its statistics, all volumes together. 58,094 in 460 scenes.
pub const HYPERSIM_INSTANCES: [u32; 40] = [
    1, 0, 472, 63, 4903, 288, 1326, 339, 742, 170, 680, 135, 426, 228, 151, 29, 10, 976, 108, 186, 666, 0, 17863, 30, 80, 1298, 101, 0,
    428, 1, 50, 42, 19, 130, 3379, 27, 0, 1412, 347, 20988,
];

/// Scenes of Hypersim that have something of the class, by its label files `mesh_objects_si.hdf5`.
pub const HYPERSIM_SCENES_WITH: [u32; 40] = [
    447, 461, 205, 55, 332, 183, 301, 173, 273, 86, 189, 99, 135, 70, 92, 12, 10, 164, 90, 143, 24, 297, 214, 30, 72, 41, 31, 0, 53, 1, 5,
    26, 16, 103, 356, 29, 0, 336, 109, 388,
];

/// Scenes that those were counted in.
pub const HYPERSIM_SCENES: u32 = 482;

/// Volumes of the boxes of Hypersim's instances in m³: 5 %, median and 95 % (`metadata_object_volume_hist_log`).
pub const HYPERSIM_VOLUMES_M3: [f64; 3] = [1.1e-4, 2.1e-3, 1.14];

/// A kind of room in housing statistics.
pub struct PublishedRoom {
    pub kind: &'static str,
    /// The published area, and its source.
    pub area: &'static str,
    /// Why ours differ.
    pub comment: &'static str,
}

/// Kinds of rooms in the order of the programme.
pub const ROOMS: [PublishedRoom; 10] = [
    PublishedRoom {
        kind: "living",
        area: "mean 17.1 m² built since 2010, 24.9 m² of the 1970s [1]",
        comment: "Like the larger ones, since the smaller homes have no dining room and people eat here too.",
    },
    PublishedRoom {
        kind: "kitchen",
        area: "mean 12.3 m² of the 1930s, larger in all later decades [1]",
        comment: "Smaller: the published ones often contain the dining table, which in our homes is in a dining or living room.",
    },
    PublishedRoom { kind: "dining", area: "none found", comment: "By the furniture plans of Neufert." },
    PublishedRoom {
        kind: "bedroom",
        area: "mean 13.4 m² built since 2010, 14.7 m² of the 1970s [1]; at least 11.5 m² [2]",
        comment: "As published.",
    },
    PublishedRoom {
        kind: "childrens",
        area: "at least 7.5 m² for one person [2]",
        comment: "Above the minimum, so that there is room for a desk and toys.",
    },
    PublishedRoom { kind: "study", area: "at least 7.5 m² as a single bedroom [2]", comment: "As a single bedroom." },
    PublishedRoom {
        kind: "bathroom",
        area: "mean 9.1 m², 21 % below 6 m², 53 % between 6 and 10 m² [3]",
        comment: "Smaller: the bathrooms of houses raise the published mean (10.3 m²; rented flats 8.2 m²), and ours are in flats.",
    },
    PublishedRoom {
        kind: "toilet",
        area: "mean 3.4 m² [3]",
        comment: "Smaller: the smallest of Neufert's plans; not in the usual programmes.",
    },
    PublishedRoom { kind: "hall", area: "none found", comment: "What the plan leaves between the rooms." },
    PublishedRoom { kind: "laundry", area: "none found", comment: "Not in the usual programmes." },
];

/// Sources of [`ROOMS`].
pub const ROOM_SOURCES: &str = "\
[1] LABC Warranty, \"What is the average house size in the UK?\" (10,000 houses of each decade), labc.co.uk.
[2] Nationally described space standard, England 2015: double (twin) and single bedrooms.
[3] VDS and forsa, *Grundlagenstudie Bad* 2017 (3,000 people), as reported by diyonline.de and baustoffwissen.de.
[4] Statistisches Bundesamt: dwellings at the end of 2018, as reported by tga-fachplaner.de.";

/// Mean floor area of a dwelling in Germany at the end of 2018, m² (source 4).
pub const DWELLING_M2: f64 = 91.8;

/// A family of furniture whose usual measures are published.
pub struct PublishedSize {
    pub family: &'static str,
    /// Width, depth, height, metres: from and to, where known.
    pub size_m: [Option<[f64; 2]>; 3],
    /// Number of the source.
    pub source: &'static str,
    /// Why ours differ.
    pub comment: &'static str,
}

const fn size(
    family: &'static str,
    width: Option<[f64; 2]>,
    depth: Option<[f64; 2]>,
    height: Option<[f64; 2]>,
    source: &'static str,
    comment: &'static str,
) -> PublishedSize {
    PublishedSize { family, size_m: [width, depth, height], source, comment }
}

/// Furniture whose usual measures are published.
pub const SIZES: [PublishedSize; 17] = [
    size("sofa", Some([1.5, 2.29]), Some([0.84, 0.97]), None, "[1] [2] [3]", "As published, at the larger end."),
    size("armchair", Some([0.89, 0.9]), Some([0.89, 0.95]), None, "[1] [3]", "Narrower: slender easy chairs, no club chairs."),
    size(
        "coffee_table",
        Some([0.75, 1.22]),
        Some([0.46, 0.76]),
        Some([0.48, 0.48]),
        "[1] [2] [3]",
        "As published; lower, as is usual beside low sofas.",
    ),
    size(
        "side_table",
        Some([0.61, 0.71]),
        Some([0.61, 0.64]),
        Some([0.51, 0.51]),
        "[2] [3]",
        "Smaller: for a cup beside a chair, not for a lamp.",
    ),
    size(
        "dining_table",
        Some([0.75, 1.2]),
        Some([0.75, 1.2]),
        Some([0.71, 0.76]),
        "[1] [2]",
        "Round and square ones, for two to four; as published.",
    ),
    size("long_table", Some([1.5, 2.6]), Some([0.9, 0.91]), Some([0.71, 0.76]), "[1] [2]", "As published, up to eight seats."),
    size("chair", Some([0.45, 0.46]), Some([0.45, 0.46]), None, "[1] [2]", "As published."),
    size("upholstered_chair", Some([0.45, 0.46]), Some([0.45, 0.46]), None, "[1] [2]", "Deeper, because the back leans; wider with arms."),
    size("bookshelf", None, Some([0.23, 0.36]), Some([1.22, 2.13]), "[2]", "As published, the tall ones."),
    size("desk", Some([1.5, 1.5]), Some([0.75, 0.75]), None, "[1]", "Smaller ones too, for studies of 8 m²."),
    size(
        "bed",
        Some([0.99, 1.93]),
        Some([1.9, 2.03]),
        None,
        "[2], mattresses",
        "Larger by the frame and the headboard; published sizes are of mattresses.",
    ),
    size("nightstand", None, Some([0.46, 0.46]), None, "[2]", "Shallower, as is usual in Europe."),
    size("dresser", None, Some([0.46, 0.46]), None, "[2]", "As published."),
    size("wardrobe", None, Some([0.5, 0.6]), None, "[4]", "Deeper by the handles."),
    size(
        "kitchen_unit",
        Some([0.3, 1.2]),
        Some([0.6, 0.6]),
        Some([0.9, 0.9]),
        "[5]",
        "Without the worktop, so 0.04 m lower; fillers at the ends of a row also count as units.",
    ),
    size(
        "refrigerator",
        Some([0.5, 0.91]),
        None,
        Some([0.85, 1.76]),
        "[5]",
        "Built-in ones are tall units, 2 m high with their plinth; free-standing ones are as published.",
    ),
    size(
        "bathtub",
        Some([1.7, 1.7]),
        Some([0.7, 0.7]),
        Some([0.56, 0.56]),
        "[6]",
        "Higher by taps, hand shower and screen, which are part of it; up to 0.1 m to either side.",
    ),
];

/// Sources of [`SIZES`].
pub const SIZE_SOURCES: &str = "\
[1] First In Architecture, *Metric Data 08: Standard Furniture Sizes*. [2] The Furniture Domain, \"Guide to Standard Furniture
Measurements\". [3] The Spruce, \"Standard Sizes for Various Types of Furniture\". [4] hotelbedroomfurnituress.com, \"Standard
Stature of Furniture\". [5] First In Architecture, *Metric Data 09: Kitchen Standard Sizes*. [6] Post Digital Architecture,
\"Bathroom and Restroom Measurements and Standards Guide\".";
