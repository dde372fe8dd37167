//! The table of layers: name, pass, type, channels, unit, space and meaning of each. Everything that knows layers follows it.

use serde::{Deserialize, Serialize};

/// Every layer a frame can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs, reason = "LAYERS documents each one")]
pub enum Layer {
    Color,
    DiffuseIllumination,
    DiffuseReflectance,
    Residual,
    DepthMeters,
    DepthZMeters,
    Position,
    NormalWorld,
    NormalCam,
    NormalBumpWorld,
    NormalBumpCam,
    TexCoord,
    RenderEntityId,
    Valid,
    Semantic,
    SemanticInstance,
    ColorRendered,
    DiffuseIlluminationRendered,
    ResidualRendered,
    NormalFilteredWorld,
    NormalBeyondWorld,
    ReflectanceBeyond,
    ColorStandardError,
    DiffuseDirect,
    DiffuseIndirect,
    Specular,
    Transmission,
    Emission,
    LightEnvironment,
    LightDistant,
    LightSurfaces,
    LightPoints,
    MaterialId,
    BaseColor,
    Metallic,
    Roughness,
    TransmissionWeight,
    EmittedRadiance,
    NormalGeometricWorld,
    SurfaceTraits,
    DepthBehindMeters,
    EntityBehindId,
    DepthBeyondMeters,
    OcclusionBoundary,
    OpticalFlow,
    SceneFlow,
    FlowVisibility,
}

/// The type in which values are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "plain words")]
pub enum Dtype {
    F16,
    F32,
    I16,
    U8,
}

/// Hypersim's folder that a layer is in, and how the layer is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pass {
    /// `scene_cam_XX_final_hdf5`: filtered over the pixel.
    Final,
    /// `scene_cam_XX_geometry_hdf5`: point samples at pixel centres.
    Geometry,
    /// Layers in the geometry folder that are joined from `render_entity_id` after rendering.
    Label,
    /// Layers in the final folder as they were rendered, of frames whose `color` is denoised, where they are kept.
    Rendered,
    /// Layers in the final folder that guide denoising; they stay where what was rendered is kept.
    Guides,
    /// Layers in the final folder, rendered with it only where that is asked for: the light of `color` by its way or its source.
    #[serde(rename = "split")]
    LightParts,
    /// Layers in the geometry folder, sampled like it, only where that is asked for.
    Extra,
}

impl Pass {
    /// True for layers that a frame has only where they were asked for, and then all of them.
    pub const fn is_optional(self) -> bool {
        matches!(self, Self::Rendered | Self::Guides | Self::LightParts | Self::Extra)
    }
}

/// Codes of the `valid` layer. Anything but zero has geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Validity {
    /// The ray through the pixel centre meets nothing: geometry layers hold their sentinels.
    Void = 0,
    /// Every layer is meaningful.
    Valid = 1,
    /// The pixel is valid, but a colour value exceeded the largest float16 (65504) and is stored as that.
    Saturated = 2,
    /// The pixel is valid but has no diffuse reflectance: `diffuse_illumination` is the demodulated irradiance.
    NoDiffuse = 3,
}

/// Bits of the `surface_traits` layer: what makes a pixel difficult.
pub mod traits {
    /// A smooth metal: what is seen is a reflection.
    pub const MIRROR: u8 = 1;
    /// Light passes through the surface.
    pub const GLASS: u8 = 2;
    /// The surface emits light.
    pub const EMITTER: u8 = 4;
    /// The pixel shows more than one part, or a part and nothing: the rays through its corners do not all meet the part at its centre.
    pub const PARTIAL: u8 = 8;
    /// The back of a surface that has only one side.
    pub const BACK: u8 = 16;
    /// The surface moves by itself: on the way to the next frame, or from the one before.
    pub const MOVES: u8 = 32;
}

/// The specification of a layer, for machines and people.
#[derive(Clone, Copy, Debug)]
pub struct LayerSpec {
    /// The layer.
    pub layer: Layer,
    /// Hypersim's name, as in `frame.0000.<name>.hdf5`.
    pub name: &'static str,
    /// Folder and sampling.
    pub pass: Pass,
    /// Values per pixel; layers of one channel are stored as height × width.
    pub channels: usize,
    /// Storage.
    pub dtype: Dtype,
    /// Unit of the values; empty for pure numbers.
    pub unit: &'static str,
    /// Coordinate or colour space; empty where there is none.
    pub space: &'static str,
    /// The value of pixels whose ray hits nothing.
    pub sentinel: &'static str,
    /// One sentence.
    pub description: &'static str,
}

macro_rules! layers {
    ($($layer:ident $name:literal $pass:ident $channels:literal $dtype:ident, $unit:literal, $space:literal, $sentinel:literal, $description:literal;)*) => {
        [$(LayerSpec { layer: Layer::$layer, name: $name, pass: Pass::$pass, channels: $channels, dtype: Dtype::$dtype, unit: $unit,
            space: $space, sentinel: $sentinel, description: $description }),*]
    };
}

/// The table of layers; `LAYERS[layer as usize].layer == layer`.
pub const LAYERS: [LayerSpec; 47] = layers![
    Color "color" Final 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "Radiance, denoised or as rendered, which the record of the frame says; equals diffuse_reflectance * diffuse_illumination + residual to the last bit, evaluated in float32 and rounded to float16.";
    DiffuseIllumination "diffuse_illumination" Final 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Diffusely reflected light divided by the filtered reflectance; where that is zero, the demodulated irradiance (irradiance / pi).";
    DiffuseReflectance "diffuse_reflectance" Final 3 F16, "", "linear RGB, Rec. 709", "0", "Diffuse albedo, on [0,1].";
    Residual "residual" Final 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "Everything that is not diffuse reflection at the first surface: specular reflection, transmission, emission, background.";
    DepthMeters "depth_meters" Geometry 1 F32, "m", "", "NaN", "Euclidean distance from the camera centre to the surface.";
    DepthZMeters "depth_z_meters" Geometry 1 F32, "m", "", "NaN", "Planar depth: distance along the viewing axis.";
    Position "position" Geometry 3 F32, "m", "world", "NaN", "Surface point.";
    NormalWorld "normal_world" Geometry 3 F16, "", "world", "NaN", "Unit shading normal without bump, facing the camera.";
    NormalCam "normal_cam" Geometry 3 F16, "", "camera (x right, y up, z backward)", "NaN", "normal_world in camera axes.";
    NormalBumpWorld "normal_bump_world" Geometry 3 F16, "", "world", "NaN", "Unit shading normal with normal and bump maps, facing the camera.";
    NormalBumpCam "normal_bump_cam" Geometry 3 F16, "", "camera (x right, y up, z backward)", "NaN", "normal_bump_world in camera axes.";
    TexCoord "tex_coord" Geometry 3 F16, "", "texture (u right, v up)", "0", "Texture coordinates (u, v, 0).";
    RenderEntityId "render_entity_id" Geometry 1 I16, "", "", "-1", "Part number from 1: node_id of metadata_nodes.csv.";
    Valid "valid" Geometry 1 U8, "", "", "0", "Reason code: 0 nothing hit, 1 valid, 2 colour saturated at 65504, 3 no diffuse reflectance.";
    Semantic "semantic" Label 1 I16, "", "NYU40", "-1", "Class 1 to 40 of the visible part, -1 unlabelled.";
    SemanticInstance "semantic_instance" Label 1 I16, "", "", "-1", "Instance number from 1 within the scene, -1 none.";
    ColorRendered "color_rendered" Rendered 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "What was rendered where color is denoised: unbiased, noisy; equals diffuse_reflectance * diffuse_illumination_rendered + residual_rendered to the last bit.";
    DiffuseIlluminationRendered "diffuse_illumination_rendered" Rendered 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "What was rendered where diffuse_illumination is denoised.";
    ResidualRendered "residual_rendered" Rendered 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "What was rendered where residual is denoised.";
    NormalFilteredWorld "normal_filtered_world" Guides 3 F16, "", "world", "0",
        "Mean of the unit shading normals, with normal and bump maps, that the samples of color see; shorter where they differ. Guides denoising.";
    NormalBeyondWorld "normal_beyond_world" Guides 3 F16, "", "world", "0",
        "The same where a surface is smooth: mean of the normals of what is seen in it as in a mirror and through it as through glass, in proportion to that light; elsewhere the surface's own. Guides the denoising of residual.";
    ReflectanceBeyond "reflectance_beyond" Guides 3 F16, "", "linear RGB, Rec. 709", "1",
        "Mean reflectance, on [0,1], of what is seen in mirrors and through glass; 1 where nothing is. Guides the denoising of residual.";
    ColorStandardError "color_standard_error" Final 1 F16, "W/(sr m^2)", "luminance, Rec. 709", "as elsewhere",
        "Standard error of the luminance of color as it was rendered, from the spread of the pixel's samples as if they were independent; they are stratified, so the true one is smaller on average. NaN in a frame of one sample per pixel.";
    DiffuseDirect "diffuse_direct" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light that comes straight from a source and is reflected diffusely; with diffuse_indirect it is color - residual.";
    DiffuseIndirect "diffuse_indirect" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light that comes by way of other surfaces and is reflected diffusely.";
    Specular "specular" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light reflected otherwise than diffusely; specular + transmission + emission is residual.";
    Transmission "transmission" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light that passes through the first surface, panes included.";
    Emission "emission" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "Part of color as it was rendered, where asked for: light that the first surface emits, and the background.";
    LightEnvironment "light_environment" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the environment's radiance",
        "Part of color as it was rendered, where asked for: light of the sky or environment map; the four light_* layers sum to color.";
    LightDistant "light_distant" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "the sun's disk",
        "Part of color as it was rendered, where asked for: light of the sun and other directional lights.";
    LightSurfaces "light_surfaces" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light of emissive surfaces.";
    LightPoints "light_points" LightParts 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Part of color as it was rendered, where asked for: light of lights at a point, such as spots and measured lamps.";
    MaterialId "material_id" Extra 1 I16, "", "", "-1", "Material number from 1: material_id of metadata_materials.csv.";
    BaseColor "base_color" Extra 3 F16, "", "linear RGB, Rec. 709", "0",
        "Colour of the material, on [0,1]: diffuse reflectance, reflectance at normal incidence of metals, transmittance of glass.";
    Metallic "metallic" Extra 1 F16, "", "", "0", "Share of metal in the material, 0 to 1.";
    Roughness "roughness" Extra 1 F16, "", "", "0", "Perceptual roughness, 0 smooth to 1: the square root of GGX alpha; 1 for surfaces that only diffuse.";
    TransmissionWeight "transmission_weight" Extra 1 F16, "", "", "0", "Share of the material that lets light through, 0 to 1.";
    EmittedRadiance "emitted_radiance" Extra 3 F16, "W/(sr m^2)", "linear RGB, Rec. 709", "0",
        "Radiance that the surface emits towards the camera, at the pixel's centre.";
    NormalGeometricWorld "normal_geometric_world" Extra 3 F16, "", "world", "NaN", "Unit normal of the flat triangle, facing the camera.";
    SurfaceTraits "surface_traits" Extra 1 U8, "", "", "0",
        "Sum of: 1 smooth metal, 2 glass, 4 emitter, 8 the pixel shows more than one part, 16 back of a one-sided surface, 32 what moves by itself.";
    DepthBehindMeters "depth_behind_meters" Extra 1 F32, "m", "", "NaN",
        "Euclidean distance to the first surface that lets no light through, straight on through all glass; depth_meters where the first surface is that.";
    EntityBehindId "entity_behind_id" Extra 1 I16, "", "", "-1", "Part number of that surface, as render_entity_id.";
    DepthBeyondMeters "depth_beyond_meters" Extra 1 F32, "m", "", "NaN",
        "Length of the way from the camera to the first surface that is neither a mirror nor glass, mirrored and refracted as most of the light is; depth_meters where the first surface is that.";
    OcclusionBoundary "occlusion_boundary" Extra 1 U8, "", "", "0",
        "Next to a jump in depth among the four neighbours: 1 on the near side, 2 on the far side (where nothing is hit, too); 0 elsewhere.";
    OpticalFlow "optical_flow" Extra 2 F32, "px", "image (x right, y down)", "NaN",
        "From the pixel's centre to where the next frame shows the same surface point, inside the image or not; NaN in the last frame, and where the next camera has no image of the point.";
    SceneFlow "scene_flow" Extra 3 F32, "m", "camera (x right, y up, z backward)", "NaN",
        "Position of the surface point in the next frame's camera axes minus that in this frame's; NaN in the last frame.";
    FlowVisibility "flow_visibility" Extra 1 U8, "", "", "0", "1 where the next frame shows the same surface point, 0 where it is hidden or outside the image.";
];

/// The layers that denoising replaces, each with the name under which what was rendered is kept; `color` is last.
pub const DENOISED: [(Layer, Layer); 3] = [
    (Layer::DiffuseIllumination, Layer::DiffuseIlluminationRendered),
    (Layer::Residual, Layer::ResidualRendered),
    (Layer::Color, Layer::ColorRendered),
];

/// Layers whose sum is `color`, up to the rounding of each: by the light's way from the first surface to the camera.
pub const LIGHT_BY_PATH: [Layer; 5] = [Layer::DiffuseDirect, Layer::DiffuseIndirect, Layer::Specular, Layer::Transmission, Layer::Emission];

/// Layers whose sum is `color`, up to the rounding of each: by what the light comes from.
pub const LIGHT_BY_SOURCE: [Layer; 4] = [Layer::LightEnvironment, Layer::LightDistant, Layer::LightSurfaces, Layer::LightPoints];

impl Layer {
    /// The layer's row of the table.
    pub const fn spec(self) -> &'static LayerSpec {
        &LAYERS[self as usize]
    }

    /// The layer of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        LAYERS.iter().find(|spec| spec.name == name).map(|spec| spec.layer)
    }

    /// The layer of a name that somebody gives.
    ///
    /// # Errors
    /// With the names of all layers, when it is none of them.
    pub fn named(name: &str) -> Result<Self, String> {
        let known = || LAYERS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ");
        Self::from_name(name).ok_or_else(|| format!("there is no layer {name:?}; the layers are: {}", known()))
    }
}

impl Dtype {
    /// Bytes per value.
    pub const fn size(self) -> usize {
        match self {
            Self::F16 | Self::I16 => 2,
            Self::F32 => 4,
            Self::U8 => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_in_the_order_of_the_enum_and_names_are_unique() {
        for (i, spec) in LAYERS.iter().enumerate() {
            assert_eq!(spec.layer as usize, i);
            assert_eq!(Layer::from_name(spec.name), Some(spec.layer));
        }
    }
}
