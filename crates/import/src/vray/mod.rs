//! V-Ray scene descriptions (`.vrscene`), with the files that they include.
//!
//! | plugins | supported |
//! |---|---|
//! | geometry | `GeomStaticMesh` with its normals, texture channels and material ids, plain or packed; `GeomPlane`, `GeomInfinitePlane` (a square of 2000 units a side); `GeomDisplacedMesh`, `GeomStaticDisplacedMesh` and `GeomStaticSmoothedMesh` (their base mesh, with a warning) |
//! | nodes | `Node`: placement, geometry, material, `visible`. Nodes share meshes |
//! | cameras | `RenderView` with `SettingsOutput` and the field of view of `SettingsCamera`; `CameraPhysical`: field of view, film, focal length, zoom, shifts and offsets |
//! | lights | `LightRectangle`, `LightSphere`, `LightMesh`, `LightDome`, `LightDirect`, `LightDirectMax`, `MayaLightDirect`, `LightOmni`, `LightOmniMax`, `LightSpot`, `LightSpotMax`, `LightIES`, `SunLight`; `SettingsEnvironment` |
//! | materials | `MtlSingleBRDF`, `MtlMulti`; `Mtl2Sided`, `MtlDoubleSided`, `MtlOverride`, `MtlWrapper`, `MtlRenderStats`, `MtlMaterialID`, `MtlRoundEdges` as the material within; `BRDFVRayMtl`, `BRDFDiffuse`, `BRDFMirror`, `BRDFPhong`, `BRDFBlinn`, `BRDFGGX`, `BRDFWard`, `BRDFCookTorrance`, `BRDFGlass`, `BRDFGlassGlossy`, `BRDFLight`, `BRDFLayered`, `BRDFBump` |
//! | textures | `TexBitmap` with `BitmapBuffer` and its transfer function, `TexAColor`, `TexCombineColor`, `TexInvert`, `TexNormalBump`, and wrappers of one texture; `UVWGenChannel`, `UVWGenMayaPlace2dTexture`, `UVWGenEnvironment`; `TexSky` |
//! | units | `SettingsUnitsInfo`: metres per unit, the axis that points up, and the scale of photometric lights |
//! | skipped in silence | settings of sampling, caches and files; render elements: they are settings of rendering |
//! | dropped with a warning | every other plugin that a node, light or material leads to, or that would be seen: hair, proxies, volumes, instancers |
//!
//! # Units of light
//!
//! Radiance comes in V-Ray's own units: a light of intensity 1 in default units has radiance 1. Lights in lumens, candela per
//! square metre or watts are turned into these by `photometric_scale`, the radiance of 1 cd/m², with 683 lm/W. Point and distant lights
//! in default units light a white surface that faces them to a radiance of intensity × colour, at a distance of one unit where they
//! decay (3ds Max's convention). The exposure of a `CameraPhysical` multiplies all light, so that the picture is V-Ray's; vignetting and
//! white balance, which are no matter of light, are left out.
//!
//! # Names
//!
//! A part has the name of its node, `chair@node_12` (for Hypersim, the object is the text before `@`); with several materials
//! `chair@node_12_<material>`. Lights with a surface are parts of the light's name.
//!
//! # Animation
//!
//! Of animated parameters the first keyframe is used, and of a scene that is written moment by moment (`#time`) the first state of each
//! plugin, with a warning.

mod bake;
mod brdf;
mod camera;
mod daylight;
mod dome;
mod geometry;
mod light;
mod material;
mod node;
mod parameters;
mod physical;
mod plugins;
mod point_light;
mod principled;
mod reader;
mod texture;
mod transfer;
mod uvw;

use crate::assembly::Assembly;
use crate::{ImportError, Imported, UpAxis};
use enfilade_math::DVec3;
use plugins::Plugins;
use reader::Reader;
use std::collections::BTreeSet;

/// V-Ray's own metres per unit and radiance per cd/m² where a scene does not state them.
const DEFAULT_UNIT: (f64, f64) = (1.0, 0.002);

/// Kinds of plugins that are things to be seen or light, but not supported.
const UNSUPPORTED: [&str; 14] = [
    "Instancer",
    "Instancer2",
    "GeomParticleSystem",
    "LightAmbient",
    "LightAmbientMax",
    "LightLuminaire",
    "LightMeshLightLinking",
    "LightOmniPortal",
    "VolumeVRayToon",
    "EnvironmentFog",
    "VolumeScatterFog",
    "PhxShaderSim",
    "CameraDome",
    "CameraLensEffects",
];

/// Imports a V-Ray scene.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let plugins = Plugins::read(&mut assembly)?;
    let photometric_scale = units(&plugins, &mut assembly)?;
    let exposure = match plugins.settings("CameraPhysical") {
        Some(camera) => physical::exposure(camera, photometric_scale)? as f32,
        None => 1.0,
    };
    let mut reader = Reader::new(assembly, &plugins, photometric_scale, exposure);
    reader.nodes()?;
    reader.lights()?;
    reader.surroundings()?;
    reader.cameras()?;
    reader.report_unsupported();
    reader.a.finish()
}

/// Takes the scene's unit and up axis; returns the scale of photometric lights.
fn units(plugins: &Plugins, a: &mut Assembly) -> Result<f64, ImportError> {
    let Some(info) = plugins.settings("SettingsUnitsInfo") else {
        a.warn("SettingsUnitsInfo", "the scene does not state its unit, so a unit is a metre; the option meters_per_unit says otherwise");
        a.set_units(DEFAULT_UNIT.0, UpAxis::Z);
        return Ok(DEFAULT_UNIT.1);
    };
    let positive = |parameter: &str, default: f64| {
        let found = info.number(parameter, default)?;
        if found > 0.0 {
            return Ok(found);
        }
        Err(info.error(parameter, format!("found {found}, expected a number above zero; correct the value")))
    };
    let meters = positive("meters_scale", DEFAULT_UNIT.0)?;
    let photometric_scale = positive("photometric_scale", DEFAULT_UNIT.1)?;
    let up = info.vector("scene_upDir", DVec3::Z)?;
    a.set_units(meters, if up.y.abs() > up.z.abs() { UpAxis::Y } else { UpAxis::Z });
    Ok(photometric_scale)
}

impl Reader<'_, '_> {
    /// Warns of what would be seen in the picture and is not supported, once per kind.
    fn report_unsupported(&mut self) {
        let found: BTreeSet<&str> = self.plugins.all().map(|p| p.kind()).filter(|kind| UNSUPPORTED.contains(kind)).collect();
        for kind in found {
            let count = self.plugins.of_kind(kind).count();
            self.a.warn(kind, format!("{count} of this kind, which is not supported, were left out"));
        }
    }
}
