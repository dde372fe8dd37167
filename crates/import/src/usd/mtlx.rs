//! The supported part of MaterialX: the surface beside a `UsdPreviewSurface`, and the pictures of its network.

use super::shader::{Source, id, source};
use super::stage::Prim;
use super::texture::{Texture, Textures};
use super::value::Value;
use crate::ImportError;
use crate::images::Use;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, TextureRef};
use std::rc::Rc;

/// Blender's name for the surface of its viewport, which has none of the material's textures. It is written when MaterialX is exported
/// without preview surfaces.
const BLENDERS_STAND_IN: &str = "previewShader";

/// A longer way from an input to its picture is taken for a circle.
const MAX_STEPS: usize = 64;

/// Inputs of surfaces of other renderers by what they mean, in the order in which they are looked for.
pub(super) mod named {
    pub const BASE: &[&str] =
        &["inputs:base_color", "inputs:diffuse_color_constant", "inputs:diffuseColor", "inputs:baseColor", "inputs:diffuse_tint"];
    pub const TRANSMISSION: &[&str] = &["inputs:transmission", "inputs:transmission_weight"];
    pub const GLOW_STRENGTH: &[&str] =
        &["inputs:emission", "inputs:emission_luminance", "inputs:emissive_intensity", "inputs:emissive_strength"];
}

/// The first of these inputs that a shader has; empty where it has none.
pub(super) fn first(shader: &Prim, names: &[&'static str]) -> &'static str {
    let known = shader.properties();
    names.iter().copied().find(|n| known.iter().any(|k| &**k == *n)).unwrap_or("")
}

/// True for MaterialX surfaces that are the border of a body, not a thin wall: the default of OpenPBR and of the Standard Surface.
pub(super) fn is_solid(shader: &Prim) -> bool {
    let is_thin = |name| shader.value(name).and_then(Value::as_bool) == Some(true);
    id(shader).starts_with("ND_") && !is_thin("inputs:geometry_thin_walled") && !is_thin("inputs:thin_walled")
}

/// The strength of emission where its input has no value: none by the definitions of the standard surface and of OpenPBR.
pub(super) fn default_strength(shader: &Prim, input: &str) -> f32 {
    let is_dark = matches!(input, "inputs:emission" | "inputs:emission_luminance") && !id(shader).contains("unlit");
    if is_dark { 0.0 } else { 1.0 }
}

impl Textures<'_, '_, '_> {
    /// The MaterialX surface of a material, where it has one beside its preview surface.
    pub(super) fn mtlx_surface(&mut self, material: &Rc<Prim>) -> Result<Option<Rc<Prim>>, ImportError> {
        Ok(match source(self.stage, material, "outputs:mtlx:surface", self.a)? {
            Source::Shader(shader, _) if id(&shader) != "UsdPreviewSurface" => Some(shader),
            _ => None,
        })
    }

    /// True if a preview surface is only a placeholder for the MaterialX surface beside it, which has the textures.
    pub(super) fn stands_in(&mut self, preview: &Rc<Prim>, mtlx: &Rc<Prim>) -> Result<bool, ImportError> {
        if preview.name() == BLENDERS_STAND_IN {
            return Ok(true);
        }
        for input in preview.properties().iter().filter(|p| p.starts_with("inputs:")) {
            if let Source::Shader(..) = source(self.stage, preview, input, self.a)? {
                return Ok(false);
            }
        }
        match source(self.stage, mtlx, first(mtlx, named::BASE), self.a)? {
            Source::Shader(node, _) => Ok(self.mtlx_image(&node)?.is_some()),
            _ => Ok(false),
        }
    }

    /// Adds to a preview surface the properties that only the MaterialX surface beside it can express: glass, and the strength of a
    /// texture's emission.
    pub(super) fn complete(&mut self, material: &mut Material, mtlx: &Rc<Prim>) -> Result<(), ImportError> {
        let transmission = self.scalar(mtlx, first(mtlx, named::TRANSMISSION), 0.0)?;
        if let Bsdf::Principled(p) = &mut material.bsdf
            && transmission.factor > 0.0
        {
            (p.transmission, p.solid) = (transmission, is_solid(mtlx));
            // It only approximated the glass.
            material.alpha = Alpha::Opaque;
        }
        let emission = &mut material.emission;
        if emission.texture.is_some() && emission.factor == Rgb::WHITE {
            let strength = first(mtlx, named::GLOW_STRENGTH);
            emission.factor *= self.factor(mtlx, strength, default_strength(mtlx, strength))?;
        }
        let kind = id(mtlx);
        self.warn(format!(
            "beside its UsdPreviewSurface it has a {kind:?}, of which only transmission and strength of emission were taken"
        ));
        Ok(())
    }

    /// The picture that an output of a MaterialX network is; `None`, with a warning, for other networks.
    pub(super) fn mtlx_texture(&mut self, shader: &Rc<Prim>, usage: Use) -> Result<Option<Texture>, ImportError> {
        let Some((node, output)) = self.mtlx_image(shader)? else {
            let kind = id(shader);
            self.warn(format!("{} is a {kind:?}, which does not lead to a picture by itself; the default holds", shader.path));
            return Ok(None);
        };
        let usage = match node.property("inputs:file", "colorSpace").and_then(Value::as_text) {
            Some("srgb_texture" | "sRGB") => Use::Color,
            Some("raw" | "Raw" | "lin_rec709") => Use::Data,
            _ => usage,
        };
        let mut texture = self.image(&node, usage)?.map(TextureRef::new);
        let wrap = [self.wrap(&node, "inputs:uaddressmode")?, self.wrap(&node, "inputs:vaddressmode")?];
        self.mtlx_coordinates(&node)?;
        let tiles = self.mtlx_tiles(&node)?;
        if let Some(texture) = &mut texture {
            texture.wrap = wrap;
            texture.uv_transform = tiles;
        }
        Ok(Some(Texture { texture, scale: [1.0; 4], bias: [0.0; 4], fallback: None, output: output.to_string() }))
    }

    /// The image node that a node leads to, and what of it is read: all, or r, g, b, a.
    fn mtlx_image(&mut self, shader: &Rc<Prim>) -> Result<Option<(Rc<Prim>, &'static str)>, ImportError> {
        let (mut node, mut output) = (shader.clone(), "out");
        for _ in 0..MAX_STEPS {
            let kind = id(&node);
            if kind.starts_with("ND_image_") || kind.starts_with("ND_tiledimage_") {
                return Ok(Some((node, output)));
            }
            if kind.starts_with("ND_extract_") {
                let index = node.number("inputs:index").unwrap_or(0.0);
                output = ["r", "g", "b", "a"].get(index as usize).copied().unwrap_or("r");
            } else if !kind.starts_with("ND_convert_") {
                return Ok(None);
            }
            let Source::Shader(next, _) = source(self.stage, &node, "inputs:in", self.a)? else { return Ok(None) };
            node = next;
        }
        Ok(None)
    }

    /// The transform of texture coordinates of a tiled image: (uv · tiling − offset) · size of a tile / size of the image.
    fn mtlx_tiles(&mut self, node: &Rc<Prim>) -> Result<[[f32; 3]; 2], ImportError> {
        let mut pair = |name: &str, default: f32| -> Result<[f32; 2], ImportError> {
            Ok(match source(self.stage, node, name, self.a)? {
                Source::Value(v, _) => v.as_tuple::<2>().map_or([default; 2], |v| v.map(|c| c as f32)),
                _ => [default; 2],
            })
        };
        if !id(node).starts_with("ND_tiledimage_") {
            return Ok(TextureRef::new(0).uv_transform);
        }
        let (tiling, offset) = (pair("inputs:uvtiling", 1.0)?, pair("inputs:uvoffset", 0.0)?);
        let (image, tile) = (pair("inputs:realworldimagesize", 1.0)?, pair("inputs:realworldtilesize", 1.0)?);
        let size = |i: usize| if image[i] == 0.0 { 1.0 } else { tile[i] / image[i] };
        let (x, y) = (size(0), size(1));
        Ok([[tiling[0] * x, 0.0, -offset[0] * x], [0.0, tiling[1] * y, -offset[1] * y]])
    }

    /// Notes the primvar that an image node is read at.
    fn mtlx_coordinates(&mut self, node: &Rc<Prim>) -> Result<(), ImportError> {
        let Source::Shader(reader, _) = source(self.stage, node, "inputs:texcoord", self.a)? else { return Ok(()) };
        match id(&reader).as_str() {
            "ND_texcoord_vector2" => (),
            "ND_geompropvalue_vector2" => {
                let name = self.token(&reader, "inputs:geomprop")?;
                self.read_at(name);
            }
            other => self.warn(format!("texture coordinates from a {other:?} are not supported; the mesh's own are used")),
        }
        Ok(())
    }
}
