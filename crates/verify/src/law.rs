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

/// What a law says.
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
    /// What a violation may mean, and what to do.
    pub meaning: &'static str,
}

macro_rules! laws {
    ($($law:ident $bound:literal $unit:literal, $statement:literal, $meaning:literal;)*) => {
        [$(LawSpec { law: Law::$law, statement: $statement, bound: $bound, unit: $unit, meaning: $meaning }),*]
    };
}

/// The table of laws; `LAWS[law as usize].law == law`.
pub const LAWS: [LawSpec; 73] = laws![
    Readable 0.0 "files", "every file can be read and has the shape and type its name promises",
        "the file is damaged or was cut short: copy it again, or run the stage that makes it with --force";
    Manifest 0.0 "", "the dataset has a manifest that lists the scene", "the run did not come to its end: run it again";
    FramesComplete 0.0 "frames", "every frame of a trajectory is complete", "a frame failed or was never rendered: run again";
    LayersPresent 0.0 "layers", "every frame has every layer, and of each optional kind (rendered beside denoised, parts of light, extra) all or none", "the frame was rendered or labelled by another version: render or label it again";
    Checksums 0.0 "files", "files are what the manifest says was written", "a file was changed or damaged after it was written: render again or restore it";
    Nodes 0.0 "tables", "metadata_nodes.csv can be read and numbers its nodes 1, 2, ...", "the table was edited or cut: import the scene again";
    Calibration 1e-6 "px", "size and calibration agree between metadata_camera_parameters.csv, cameras_opencv.json, records and images",
        "the images were rendered with other settings than the table states: render again";
    CameraFiles 1e-9 "", "camera_rays.hdf5 and the poses of rows are there where they are needed, and they and cameras_opencv.json are the camera's",
        "the camera's files are of another plan: plan again";
    Stereo 1e-9 "m", "the cameras of a stereo rig keep their baseline and look the same way", "one of the two was planned again or edited: plan again";
    LabelTables 0.0 "tables", "the label tables are there and have one row per part", "the scene was not labelled: run the label stage";
    HasFrames 0.0 "", "every scene has a trajectory with rendered frames", "a stage of the scene failed, or planning or rendering found nothing: see the run's summary";
    Lit 0.5 "share", "no more than half of a scene's frames are black (mean luminance of what is seen below 1e-5 W/(sr m^2))",
        "no light comes to what the frames show, as in a room without windows under a sky: light it from within (lamps = \"ceiling\"), or open it";
    Worthwhile 0.5 "share", "gates reject no more than half of a scene's planned views",
        "most cameras stand in things, outside, or before a wall: place them elsewhere, or set other limits in [gate]";
    FrameNumbers 0.0 "frames", "frames are numbered 0, 1, 2, ... without a gap", "the trajectory was cut or edited: plan it again";
    PosesFinite 0.0 "poses", "poses hold no NaN or infinity", "planning went wrong: plan again";
    Orthonormal 1e-9 "", "orientations are orthonormal (largest entry of |R R^T - 1|)", "an artist's camera with scale was passed through: plan again";
    RightHanded 1e-9 "", "orientations are right-handed (|det R - 1|)", "an axis is mirrored: check the importer's axes";
    LookAt 1e-6 "", "the look-at point lies on the viewing axis", "positions and orientations are not of one trajectory: plan again";
    Roll 1e-6 "degrees", "roll stays within the limit of the plan, where that has one (degrees beyond it)",
        "poses were edited after planning: plan again";
    StartPose 1e-12 "", "frame 0 is the start camera's pose, where the plan kept it (largest entry of the difference)",
        "poses were edited after planning, or the camera is another one: plan again";
    WalkBox 1e-9 "m", "positions and targets of a walk lie in the boxes around the last and the first ones (metres beyond)",
        "poses were edited after planning: plan again";
    WalkSight 0.0 "poses", "each position of a walk is seen from the last one, and each target from the last target",
        "poses were edited after planning, or the mesh is of another version of the scene: plan again";
    FreeTarget 0.0 "poses", "targets of a walk lie in free voxels of octomap.bt", "poses were edited after planning, or the scene was carved again: plan again";
    RenderedPose 1e-9 "", "frames were rendered from the poses that are stored", "the trajectory was planned again after rendering: render again";
    FreeCamera 0.0 "poses", "cameras stand in free voxels of octomap.bt", "the camera is in a wall or outside: plan again";
    SeesScene 0.0 "frames", "some pixel of every frame sees the scene", "the camera looks into the void: plan again";
    EntityIds 0.0 "pixels", "entity ids are -1 or the number of a part", "the frame is of another version of the scene: render again";
    VoidCode 0.0 "pixels", "valid is 0 exactly where render_entity_id is -1", "renderer defect: please report it";
    ReasonCodes 0.0 "pixels", "valid is 2 exactly where a colour is at the limit of float16, else 3 exactly where reflectance is 0",
        "renderer defect: please report it";
    GeometryFinite 0.0 "pixels", "distance, depth, position and normals are finite exactly where render_entity_id is not -1",
        "a degenerate triangle or a NaN in the mesh: import again and read its warnings";
    TexCoord 0.0 "pixels", "tex_coord is finite, (u, v, 0), and 0 where nothing was hit", "texture coordinates beyond 65504: rescale them in the scene";
    ColorFinite 0.0 "values", "colour layers hold no NaN or infinity", "a light or material with absurd values: check the scene's brightest lights";
    ColorNotNegative 0.0 "", "colour layers are not negative", "a negative light or texture: check the scene";
    Albedo 1.001 "", "diffuse_reflectance is at most 1", "a texture or factor above 1: check the material of that part";
    Recomposition 0.0 "values", "color = diffuse_reflectance * diffuse_illumination + residual, to the last bit, denoised and as rendered",
        "layers of different renderings are mixed: render the frame again";
    StandardError 2e-3 "relative", "color_standard_error is NaN everywhere (one sample per pixel), or from 0 to the luminance of color",
        "layers of different renderings are mixed: render the frame again";
    LightParts 2e-3 "relative", "light by path and light by source sum to color, and specular, transmission and emission to residual",
        "layers of different renderings are mixed: render the frame again";
    ExtraLayers 0.0 "pixels", "extra layers lie in their ranges and are of the same surfaces as the geometry layers, which what lies behind glass is beyond",
        "layers of different renderings are mixed: render the frame again";
    Distance 1e-4 "relative", "depth_meters = |position - camera|", "positions, distances and poses are not of one rendering: render again";
    PlanarDepth 1e-4 "relative", "depth_z_meters is depth_meters along the viewing axis", "calibration and rendering disagree: render again";
    Projection 0.02 "px", "position projects to the centre of its own pixel", "calibration or pose is not the one rendered with: render again";
    UnitNormals 2e-3 "", "normals have unit length", "a mesh with zero normals: import again and read its warnings";
    NormalFacing 2e-3 "", "normal_world faces the camera (n . view direction)", "renderer defect: please report it";
    BumpFacing 2e-3 "", "normal_bump_world faces the camera (n . view direction)", "renderer defect: please report it";
    NormalCamera 4e-3 "", "normal_cam is normal_world in camera axes", "pose and frame do not belong together: render again";
    BumpCamera 4e-3 "", "normal_bump_cam is normal_bump_world in camera axes", "pose and frame do not belong together: render again";
    Flatness 2e-2 "", "straight lines on surfaces of one normal lie in its plane (sine, 99th percentile)",
        "smooth normals over coarse facets, or normals in another space than positions: check the mesh's normals";
    SemanticRange 0.0 "pixels", "semantic is -1 or a class of the list, which is 1 to 40 of NYU40 unless metadata_semantic_colors.hdf5 is longer", "the label files are damaged: label again";
    InstanceRange 0.0 "pixels", "semantic_instance is -1 or at least 1", "the label files are damaged: label again";
    SemanticJoin 0.0 "pixels", "semantic is the class of the part in render_entity_id, or of one of its pieces if it was cut", "the label table changed: label again";
    InstanceJoin 0.0 "pixels", "semantic_instance is the instance of the part in render_entity_id, or of one of its pieces if it was cut", "the label table changed: label again";
    InstanceClass 0.0 "instances", "an instance has one class", "the label table gives one instance number to parts of several classes: correct it";
    BoxAxes 1e-9 "", "orientations of bounding boxes are orthonormal and right-handed", "the file was edited or damaged: run the boxes stage again";
    BoxExtents 0.0 "boxes", "bounding boxes are finite, no side is negative, and one is longer than 0",
        "the mesh has NaN, or an object is a single point: import again and read its warnings";
    BoxLeast 1e-6 "", "the object_aligned_3d box is not larger than the other two (difference over the longest side cubed)",
        "the three kinds are of different meshes: run the boxes stage again";
    BoxContains 1e-3 "", "positions of an instance lie in its boxes (distance beyond them over the distance from the camera, from 1 m on)",
        "boxes, labels and frames are of different versions of the scene: run the boxes stage again";
    InstanceCounts 0.0 "instances", "metadata_frame_instances.csv counts the pixels of semantic_instance",
        "the frame was labelled or rendered again since: run the boxes stage again";
    InstanceWhole 0.0 "", "an instance shows no more pixels than the whole object has in the image, and that no more than it has in all",
        "the frame was labelled or rendered again since: run the boxes stage again";
    LayoutPlanes 1e-2 "share", "walls, floors and ceilings are where layout.json has them (share of their pixels that are more than 2 cm off)",
        "the layout is of another version of the scene, or parts are labelled as walls that are none: import the scene again, or correct the labels";
    PartitionWhole 0.0 "scenes", "all images of a scene are on one side of the partition", "the file was edited: run enfilade partition";
    TwoViewDistance 1e-3 "share", "no frame looks through a surface that its neighbour sees (share of the pixels that both see and resolve)",
        "pose, calibration or unit of depth is not that of the rendering, or the scene is different in the two frames: render again";
    TwoViewIds 1e-3 "share", "neighbours see the same part and instance where they see the same point", "frames of different versions of the scene are mixed: render and label again";
    TwoViewReflectance 1e-2 "share", "neighbours see the same diffuse reflectance where they see the same part",
        "frames of different versions of the scene are mixed, or a texture is animated: render again";
    Covisibility 1e-2 "share", "covisibility.hdf5 agrees with what the frames' distances tell, lies on [0, 1] and is 1 on its diagonal (share of the grid beyond)",
        "frames were rendered again since: run enfilade make OUT pairs";
    PairFlow 2e-2 "relative", "flow and scene flow of a pair of frames lead to where the second camera has the surface point (off, over their length from 1 px and 1 m on)",
        "frames were rendered again since: run enfilade make OUT flow";
    PairVisibility 1e-2 "share", "flow_visibility of a pair of frames agrees with the second one's distances where they tell for sure",
        "frames were rendered again since: run enfilade make OUT flow";
    TrackPoints 0.02 "px", "points of tracks are where each frame's camera has them, up to an image beyond its borders, and begin at their pixels",
        "frames were rendered again since: run enfilade make OUT tracks";
    TrackOcclusion 1e-2 "share", "points of tracks are occluded where a frame's distances tell so for sure, and seen where those do (share of points in all frames)",
        "frames were rendered again since: run enfilade make OUT tracks";
    Sensed 0.0 "files", "readings of sensors are what their settings make of the stored frames, bit by bit",
        "frames were denoised or rendered again since, or this is another version: run enfilade make OUT sensors";
    LightFixtures 2e-3 "relative", "light by fixture sums to color as it was rendered: diffuse_reflectance * diffuse_illumination + residual of each",
        "layers of different renderings are mixed, or files of fixtures are missing: render the frame again";
    RaySurfaces 0.0 "pixels", "surfaces along rays go from near to far, begin with the frame's own, and have the classes of their parts",
        "frames were rendered or labelled again since: run enfilade make OUT surfaces";
    InstanceRelations 2e-2 "m", "instances that are said to touch or to be beside each other are no farther apart than said, those in others are in them, those under others below them",
        "labels or the scene were changed since: run enfilade make OUT words";
    PlaneIds 0.0 "pixels", "pixels of a plane of the layout are within 2 cm of it and of its class, and pixels of walls that are of none lie on none",
        "the layout, labels or frames were changed since: run enfilade make OUT rooms";
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
