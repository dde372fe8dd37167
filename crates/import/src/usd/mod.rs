//! Universal Scene Description: `.usda` (text), `.usdc` (binary), `.usd` (either) and `.usdz` (archive), with UsdPreviewSurface.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | units and axes | `metersPerUnit` (0.01 where none is stated) and `upAxis` (y) of the scene file; [`ImportOptions::meters_per_unit`](crate::ImportOptions::meters_per_unit) multiplies the former, [`ImportOptions::up_axis`](crate::ImportOptions::up_axis) replaces the latter |
//! | composition | sublayers, references, payloads (all are loaded), variants, inherits, specializes, over, class, `active`, list edits; references that lead back are left out with a warning; layers that are not there or on servers (`omniverse://`, `https://`) are left out with a warning; circles of sublayers and a depth of 64 are errors. Relocates, value clips and classes overridden from outside of a reference are not applied |
//! | time | time samples of `xformOp`s move prims with all that is below them, from `startTimeCode` on (else from their first sample), with the layer's `timeCodesPerSecond` (else `framesPerSecond`, else 24) and the offsets of sublayers and references; between two samples as USD has it, but matrices turn the shortest way. Samples of the points and normals of meshes, and of skeletons, change shapes, so that no vertex is more than 0.1 mm from the file's halfway between two states, while the faces stay the same. Scales and shears stay those of the first sample; of all else the first sample is taken (else the value without time), each with a warning |
//! | placement | every `xformOp`, `!invert!`, `!resetXformStack!` |
//! | parts | one for each gprim and subset that binds a material, named by its path; prims of the same opinions, such as instances, share their meshes. Prims that are invisible or of the purpose `guide` or `proxy` are left out, and with a warning meshes, instancers and primvars whose numbers do not fit each other |
//! | meshes | polygons with holes, both orientations, normals and texture coordinates of every interpolation with or without indices. Subdivision surfaces are taken as their cages, with smooth normals where none are stated |
//! | other shapes | cubes, spheres, cylinders, cones, capsules, planes; point instancers. Points, curves, patches and volumes are left out |
//! | skeletons | below a `SkelRoot`, meshes are bent by blended matrices as the first samples of the animation have the joints, or their rest, and over time; blend shapes by the animation's weights, without those in between. What makes no sense is left out with a warning |
//! | binding | direct, by purpose (`full`, all, `preview`), inherited, `strongerThanDescendants`, by collections with what they include and exclude by path. Without a material, the display colour and opacity, or their means, inherited where they are constant |
//! | UsdPreviewSurface | as `Bsdf::Principled`. Opacity passes light straight, with the share of the reflection that remains; above `opacityThreshold` 0 it is a mask. In the specular workflow a bright specular colour is a metal. Displacement is left out, and so is occlusion, which light transport computes |
//! | textures | UsdUVTexture with wrap modes (`black` is continued, `useMetadata` repeats), scale, bias, fallback and colour space (`auto`: sRGB for colours, raw for numbers), UsdTransform2d, UsdPrimvarReader, through node graphs and inputs of materials; of UDIMs the first tile. One set of texture coordinates a material |
//! | other surfaces | MaterialX, MDL, RenderMan: a UsdPreviewSurface of another context is preferred, and takes transmission and strength of emission from a MaterialX surface beside it, unless it is only a placeholder for that one (it has no textures where the other's base colour has one, or is that of Blender's viewport); else base colour, opacity, roughness, metallic, coat, emission and transmission are guessed by the names of inputs. MaterialX's node of the preview surface is one. Pictures of MaterialX are read where an input leads to one by itself, tiled ones too; documents of MaterialX (`.mtlx`) are not |
//! | lights | rectangles, disks, spheres and cylinders as emitting parts; spheres as points where they are to be one, or have a cone or a profile (IES); distant lights, domes, meshes that are lights. 6500 K is white. Suns of Blender, which writes a quarter of their strength and half their angle, are as in Blender. Light linking, filters and portals are left out |
//! | cameras | perspective; shifted apertures are centred; clipping is left out, and focus is the renderer's configuration |
//! | physics | joints of `UsdPhysics` are bodies that move, with axis and limits: see `joints`; all else is without effect |
//! | labels | `semantics:labels:*` and `semantic:*:params:semanticData` where they name a class of NYU40, and `customData.Category` (Apple's RoomPlan); each prim with a label is an instance, together with everything below it without one, and so is each instance of a point instancer. Walls, floors and ceilings are not counted |
//!
//! # Why the reader is our own
//!
//! The crate `openusd` reads all encodings and composes, but its releases either need a newer Rust than this workspace (0.7, 0.8) or
//! reserve memory by counts that a damaged file states and end in `todo!()` for old ones (0.6). LZ4 and zip are read by crates.

mod animation;
mod archive;
mod arrays;
mod binary;
mod bind;
mod camera;
mod collection;
mod compose;
mod constants;
mod curve;
mod deform;
mod files;
mod foreign;
mod inputs;
mod instancer;
mod joints;
mod label;
mod layer;
mod light;
mod material;
mod mtlx;
mod node;
mod operation;
mod parts;
mod polygons;
mod primvar;
mod shader;
mod shapes;
mod skeleton;
mod skin;
mod stage;
mod state;
mod stretch;
mod surface;
mod text;
mod texture;
mod things;
mod time;
mod value;
mod walk;
mod xform;

use crate::assembly::Assembly;
use crate::{ImportError, Imported, UpAxis};
use stage::Stage;
use value::Value;
use walk::Walk;

/// Metres per unit where a scene file states none.
const DEFAULT_METERS_PER_UNIT: f64 = 0.01;

/// Imports a USD file.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let mut stage = Stage::open(&file, &mut assembly)?;
    let root = stage.root();
    let metres = root.field("metersPerUnit").and_then(Value::as_number).filter(|m| m.is_finite() && *m > 0.0);
    let stated = root.field("upAxis").and_then(Value::as_text);
    if stated.is_none() {
        assembly.leaves_up_to_rules();
    }
    let up = if stated == Some("Z") { UpAxis::Z } else { UpAxis::Y };
    assembly.set_units(metres.unwrap_or(DEFAULT_METERS_PER_UNIT), up);
    Walk::new(&mut stage, up == UpAxis::Z).all(&mut assembly)?;
    assembly.finish()
}
