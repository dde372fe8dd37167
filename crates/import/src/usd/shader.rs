//! Networks of shaders: the connections of inputs, through node graphs and materials.

use super::layer::{field, split_property};
use super::stage::{Prim, Stage};
use super::value::Value;
use crate::ImportError;
use crate::assembly::Assembly;
use std::rc::Rc;

/// A longer way from an input to its output is taken for a circle.
const MAX_STEPS: usize = 64;

/// The source of an input's value.
#[derive(Debug)]
pub(super) enum Source {
    /// Nowhere: the shader's default is used.
    Default,
    /// A value, and the location of the layer that states it.
    Value(Value, String),
    /// The output of a shader, without `outputs:`.
    Shader(Rc<Prim>, String),
}

/// The source of an input (or of a material's output).
///
/// # Errors
/// When a layer on the way cannot be read, or connections form a cycle.
pub(super) fn source(stage: &mut Stage, prim: &Rc<Prim>, property: &str, a: &mut Assembly) -> Result<Source, ImportError> {
    let (mut prim, mut property) = (prim.clone(), property.to_string());
    for _ in 0..MAX_STEPS {
        let Some(target) = prim.targets(&property, field::CONNECTIONS).into_iter().next() else {
            return Ok(match prim.value_at(&property) {
                Some((value, site)) => Source::Value(value.clone(), site.layer.location.clone()),
                None => Source::Default,
            });
        };
        let (path, name) = split_property(&target);
        let Some(next) = stage.at(path, a)? else {
            a.warn(format!("{}.{property}", prim.path), format!("it is connected to {target}, which is not there; the default holds"));
            return Ok(Source::Default);
        };
        if let (Some(output), "Shader") = (name.strip_prefix("outputs:"), next.kind()) {
            return Ok(Source::Shader(next.clone(), output.to_string()));
        }
        (prim, property) = (next.clone(), name.to_string());
    }
    Err(a.malformed(format!("{}.{property}", prim.path), "its connections form a circle; remove one of them"))
}

/// The name of a shader's implementation: `info:id`, or an MDL module and what of it. MaterialX's nodes for the shaders of previews
/// have the names that these have.
pub(super) fn id(shader: &Prim) -> String {
    let mdl = || shader.text("info:mdl:sourceAsset:subIdentifier").or(shader.text("info:mdl:sourceAsset"));
    let id = shader.text("info:id").or_else(mdl).unwrap_or("");
    let twin = id.strip_prefix("ND_").filter(|name| name.starts_with("Usd"));
    let of_previews = ["UsdPreviewSurface", "UsdUVTexture", "UsdTransform2d"];
    twin.and_then(|name| of_previews.into_iter().find(|known| name.starts_with(known))).or(twin).unwrap_or(id).to_string()
}
