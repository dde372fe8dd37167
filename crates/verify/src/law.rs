//! The table of laws.

use serde::{Deserialize, Serialize};

/// A statement that every dataset must satisfy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "LAWS states each one")]
pub enum Law {
    Readable,
    Manifest,
    FramesComplete,
    LayersPresent,
    Checksums,
    Nodes,
    Calibration,
    CameraFiles,
    Stereo,
    LabelTables,
    HasFrames,
    Lit,
    Worthwhile,
    FrameNumbers,
    PosesFinite,
    Orthonormal,
    RightHanded,
    LookAt,
    Roll,
    StartPose,
    WalkBox,
    WalkSight,
    FreeTarget,
    RenderedPose,
    FreeCamera,
    SeesScene,
    EntityIds,
    VoidCode,
    ReasonCodes,
    GeometryFinite,
    TexCoord,
    ColorFinite,
    ColorNotNegative,
    Albedo,
    Recomposition,
    StandardError,
    #[serde(rename = "light_splits")]
    LightParts,
    ExtraLayers,
    Distance,
    PlanarDepth,
    Projection,
    UnitNormals,
    NormalFacing,
    BumpFacing,
    NormalCamera,
    BumpCamera,
    Flatness,
    SemanticRange,
    InstanceRange,
    SemanticJoin,
    InstanceJoin,
    InstanceClass,
    BoxAxes,
    BoxExtents,
    BoxLeast,
    BoxContains,
    InstanceCounts,
    InstanceWhole,
    LayoutPlanes,
    #[serde(rename = "split_whole")]
    PartitionWhole,
    TwoViewDistance,
    TwoViewIds,
    TwoViewReflectance,
    Covisibility,
    PairFlow,
    PairVisibility,
    TrackPoints,
    TrackOcclusion,
    Sensed,
    LightFixtures,
    RaySurfaces,
    InstanceRelations,
    PlaneIds,
}

/// The definition of a law.
#[derive(Clone, Copy, Debug)]
pub struct LawSpec {
    /// Which one.
    pub law: Law,
    /// The statement.
    pub statement: &'static str,
    /// The largest value that satisfies it.
    pub bound: f64,
    /// Unit of value and bound; empty for pure numbers.
    pub unit: &'static str,
    /// Possible causes of a violation, and what to do.
    pub meaning: &'static str,
}

macro_rules! laws {
    ($($law:ident $bound:literal $unit:literal, $statement:literal, $meaning:literal;)*) => {
        [$(LawSpec { law: Law::$law, statement: $statement, bound: $bound, unit: $unit, meaning: $meaning }),*]
    };
}

/// The table of laws; `LAWS[law as usize].law == law`.
pub const LAWS: [LawSpec; 73] = laws![
    Readable 0.0 "files", "every file can be read, and has the shape and type that its name implies",
        "the file is damaged or truncated: copy it again, or run the stage that makes it with --force";
    Manifest 0.0 "", "the dataset has a manifest that lists the scene", "the run was not finished: run it again";
    FramesComplete 0.0 "frames", "every frame of a trajectory is complete", "a frame failed or was never rendered: run it again";
    LayersPresent 0.0 "layers",
        "every frame has every layer, and of each optional kind (as rendered, parts of light, extra) all layers or none",
        "the frame was rendered or labelled by another version: render or label it again";
    Checksums 0.0 "files", "files have the size and checksum that the manifest gives",
        "a file was changed or damaged after it was written: render again or restore it";
    Nodes 0.0 "tables", "metadata_nodes.csv can be read, and numbers its nodes 1, 2, ...",
        "the table was edited or truncated: import the scene again";
    Calibration 1e-6 "px", "metadata_camera_parameters.csv, cameras_opencv.json, records and images agree on size and calibration",
        "the images were rendered with settings other than those in the table: render again";
    CameraFiles 1e-9 "",
        "camera_rays.hdf5 and the poses of rows exist where they are needed, and they and cameras_opencv.json agree with the camera",
        "the camera's files belong to another plan: plan again";
    Stereo 1e-9 "m", "the cameras of a stereo rig keep their baseline and look in the same direction",
        "one of the two was planned again or edited: plan again";
    LabelTables 0.0 "tables", "the label tables exist and have one row per part", "the scene was not labelled: run the label stage";
    HasFrames 0.0 "", "every scene has a trajectory with rendered frames",
        "a stage of the scene failed, or planning or rendering found nothing: see the run's summary";
    Lit 0.5 "share", "at most half of a scene's frames are black (mean luminance of what they show below 1e-5 W/(sr m^2))",
        "no light reaches what the frames show, as in a windowless room under a sky: add lamps inside (lamps = \"ceiling\"), or openings";
    Worthwhile 0.5 "share", "gates reject at most half of a scene's planned views",
        "most cameras are inside objects, outdoors, or close to a wall: place them elsewhere, or set other limits in [gate]";
    FrameNumbers 0.0 "frames", "frames are numbered 0, 1, 2, ... without a gap", "the trajectory was truncated or edited: plan it again";
    PosesFinite 0.0 "poses", "poses contain no NaN or infinity", "planning went wrong: plan again";
    Orthonormal 1e-9 "", "orientations are orthonormal (largest entry of |R R^T - 1|)",
        "the scale of an artist's camera was not removed: plan again";
    RightHanded 1e-9 "", "orientations are right-handed (|det R - 1|)", "an axis is mirrored: check the importer's axes";
    LookAt 1e-6 "", "the look-at point is on the viewing axis", "positions and orientations belong to different trajectories: plan again";
    Roll 1e-6 "degrees", "roll is within the limit of the plan, if it has one (degrees beyond it)",
        "poses were edited after planning: plan again";
    StartPose 1e-12 "", "frame 0 has the start camera's pose, if the plan kept it (largest entry of the difference)",
        "poses were edited after planning, or the camera is a different one: plan again";
    WalkBox 1e-9 "m", "positions and targets of a walk are in the boxes around the last and the first ones (metres outside)",
        "poses were edited after planning: plan again";
    WalkSight 0.0 "poses", "each position of a walk is visible from the last one, and each target from the last target",
        "poses were edited after planning, or the mesh belongs to another version of the scene: plan again";
    FreeTarget 0.0 "poses", "targets of a walk are in free voxels of octomap.bt",
        "poses were edited after planning, or the scene was carved again: plan again";
    RenderedPose 1e-9 "", "frames were rendered from the stored poses", "the trajectory was planned again after rendering: render again";
    FreeCamera 0.0 "poses", "cameras are in free voxels of octomap.bt", "the camera is in a wall or outside: plan again";
    SeesScene 0.0 "frames", "at least one pixel of every frame sees the scene", "the camera looks into the void: plan again";
    EntityIds 0.0 "pixels", "entity ids are -1 or the number of a part", "the frame belongs to another version of the scene: render again";
    VoidCode 0.0 "pixels", "valid is 0 exactly where render_entity_id is -1", "renderer defect: please report it";
    ReasonCodes 0.0 "pixels",
        "valid is 2 exactly where a colour is at the limit of float16, and elsewhere 3 exactly where reflectance is 0",
        "renderer defect: please report it";
    GeometryFinite 0.0 "pixels", "distance, depth, position and normals are finite exactly where render_entity_id is not -1",
        "a degenerate triangle or a NaN in the mesh: import again and read its warnings";
    TexCoord 0.0 "pixels", "tex_coord is finite, of the form (u, v, 0), and 0 where nothing was hit",
        "texture coordinates beyond 65504: rescale them in the scene";
    ColorFinite 0.0 "values", "colour layers contain no NaN or infinity",
        "a light or material with extreme values: check the scene's brightest lights";
    ColorNotNegative 0.0 "", "colour layers are not negative", "a negative light or texture: check the scene";
    Albedo 1.001 "", "diffuse_reflectance is at most 1", "a texture or factor above 1: check the material of that part";
    Recomposition 0.0 "values",
        "color = diffuse_reflectance * diffuse_illumination + residual, to the last bit, both denoised and as rendered",
        "layers of different renderings are mixed: render the frame again";
    StandardError 2e-3 "relative", "color_standard_error is NaN everywhere (one sample per pixel), or between 0 and the luminance of color",
        "layers of different renderings are mixed: render the frame again";
    LightParts 2e-3 "relative",
        "light by path and light by source each sum to color, and specular, transmission and emission sum to residual",
        "layers of different renderings are mixed: render the frame again";
    ExtraLayers 0.0 "pixels",
        "extra layers are within their ranges and agree with the geometry layers; what is behind glass is not nearer than the glass",
        "layers of different renderings are mixed: render the frame again";
    Distance 1e-4 "relative", "depth_meters = |position - camera|",
        "positions, distances and poses belong to different renderings: render again";
    PlanarDepth 1e-4 "relative", "depth_z_meters is depth_meters along the viewing axis",
        "calibration and rendering disagree: render again";
    Projection 0.02 "px", "position projects to the centre of its own pixel",
        "calibration or pose is not that of the rendering: render again";
    UnitNormals 2e-3 "", "normals have unit length", "a mesh with zero normals: import again and read its warnings";
    NormalFacing 2e-3 "", "normal_world faces the camera (n . view direction)", "renderer defect: please report it";
    BumpFacing 2e-3 "", "normal_bump_world faces the camera (n . view direction)", "renderer defect: please report it";
    NormalCamera 4e-3 "", "normal_cam is normal_world in camera axes", "pose and frame do not belong together: render again";
    BumpCamera 4e-3 "", "normal_bump_cam is normal_bump_world in camera axes", "pose and frame do not belong together: render again";
    Flatness 2e-2 "", "straight lines on surfaces with one normal are perpendicular to it (99th percentile of the sine of their deviation)",
        "smooth normals over coarse facets, or normals and positions in different spaces: check the mesh's normals";
    SemanticRange 0.0 "pixels",
        "semantic is -1 or a class of the list, which is NYU40 (1 to 40) unless metadata_semantic_colors.hdf5 is longer",
        "the label files are damaged: label again";
    InstanceRange 0.0 "pixels", "semantic_instance is -1 or at least 1", "the label files are damaged: label again";
    SemanticJoin 0.0 "pixels", "semantic is the class of the part in render_entity_id, or of one of its pieces if the part was split",
        "the label table changed: label again";
    InstanceJoin 0.0 "pixels",
        "semantic_instance is the instance of the part in render_entity_id, or of one of its pieces if the part was split",
        "the label table changed: label again";
    InstanceClass 0.0 "instances", "an instance has one class",
        "the label table gives parts of several classes the same instance number: correct it";
    BoxAxes 1e-9 "", "orientations of bounding boxes are orthonormal and right-handed",
        "the file was edited or damaged: run the boxes stage again";
    BoxExtents 0.0 "boxes", "bounding boxes are finite, no side is negative, and at least one is longer than 0",
        "the mesh has NaN, or an object is a single point: import again and read its warnings";
    BoxLeast 1e-6 "", "the object_aligned_3d box is not larger than the other two (difference in volume over the cube of the longest side)",
        "the three kinds were made from different meshes: run the boxes stage again";
    BoxContains 1e-3 "",
        "positions of an instance are in its boxes (distance outside over the distance from the camera, which counts as at least 1 m)",
        "boxes, labels and frames belong to different versions of the scene: run the boxes stage again";
    InstanceCounts 0.0 "instances", "metadata_frame_instances.csv gives the pixel counts of semantic_instance",
        "the frame was labelled or rendered again afterwards: run the boxes stage again";
    InstanceWhole 0.0 "",
        "an instance has no more visible pixels than the whole object has in the image, and the object no more in the image than in all",
        "the frame was labelled or rendered again afterwards: run the boxes stage again";
    LayoutPlanes 1e-2 "share", "walls, floors and ceilings are where layout.json has them (share of their pixels more than 2 cm off)",
        "the rooms belong to another version of the scene, or other parts are labelled as walls: import it again, or correct the labels";
    PartitionWhole 0.0 "scenes", "all images of a scene are on one side of the partition", "the file was edited: run enfilade partition";
    TwoViewDistance 1e-3 "share",
        "no frame looks through a surface that its neighbour sees (share of the pixels that both see and resolve)",
        "pose, calibration or unit of depth is not that of the rendering, or the scene differs between the two frames: render again";
    TwoViewIds 1e-3 "share", "neighbours see the same part and instance where they see the same point",
        "frames of different versions of the scene are mixed: render and label again";
    TwoViewReflectance 1e-2 "share", "neighbours see the same diffuse reflectance where they see the same part",
        "frames of different versions of the scene are mixed, or a texture is animated: render again";
    Covisibility 1e-2 "share",
        "covisibility.hdf5 is within what the frames' distances allow and within [0, 1], and 1 on its diagonal (share of the grid beyond)",
        "frames were rendered again afterwards: run enfilade make OUT pairs";
    PairFlow 2e-2 "relative",
        "flow and scene flow of a pair lead to where the second camera has the point (error over their length, at least 1 px and 1 m)",
        "frames were rendered again afterwards: run enfilade make OUT flow";
    PairVisibility 1e-2 "share", "flow_visibility of a pair of frames agrees with the second frame's distances where these are conclusive",
        "frames were rendered again afterwards: run enfilade make OUT flow";
    TrackPoints 0.02 "px",
        "points of tracks are where each frame's camera has them, up to one image size beyond its borders, and begin at their pixels",
        "frames were rendered again afterwards: run enfilade make OUT tracks";
    TrackOcclusion 1e-2 "share",
        "occluded flags of tracks agree with the frames' distances where these are conclusive (share of points in all frames)",
        "frames were rendered again afterwards: run enfilade make OUT tracks";
    Sensed 0.0 "files", "readings of sensors are, to the last bit, what their settings give for the stored frames",
        "frames were denoised or rendered again afterwards, or by another version of enfilade: run enfilade make OUT sensors";
    LightFixtures 2e-3 "relative",
        "light by fixture sums to color as rendered; each is diffuse_reflectance * diffuse_illumination + residual",
        "layers of different renderings are mixed, or files of fixtures are missing: render the frame again";
    RaySurfaces 0.0 "pixels",
        "surfaces along a ray are ordered from near to far, begin with the frame's own, and have the classes of their parts",
        "frames were rendered or labelled again afterwards: run enfilade make OUT surfaces";
    InstanceRelations 2e-2 "m",
        "instances that touch or are beside each other are no farther apart than recorded; those in others are inside, those under below",
        "labels or the scene were changed afterwards: run enfilade make OUT words";
    PlaneIds 0.0 "pixels",
        "pixels with a plane of the rooms are within 2 cm of it and have its class, and wall pixels without one are on none",
        "the rooms, labels or frames were changed afterwards: run enfilade make OUT rooms";
];

impl Law {
    /// The law's row of the table.
    pub const fn spec(self) -> &'static LawSpec {
        &LAWS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_in_the_order_of_the_enum_and_speaks_ascii() {
        for (i, spec) in LAWS.iter().enumerate() {
            assert_eq!(spec.law as usize, i);
            assert!(spec.statement.is_ascii() && spec.meaning.is_ascii());
        }
    }
}
