//! Definitions of directives by name, converted when a shape or material first uses them.

use super::made::Texture;
use super::params::Params;
use super::version::Version;

/// A `Material` or `MakeNamedMaterial` directive.
#[derive(Clone)]
pub(super) struct MaterialDefinition {
    pub name: Option<String>,
    pub class: String,
    pub params: Params,
}

impl MaterialDefinition {
    pub(super) fn new(name: Option<String>, class: String, params: Params) -> Self {
        Self { name, class, params }
    }

    /// The material of shapes before the first material directive.
    pub(super) fn default_of(version: Version) -> Self {
        let class = if version == Version::V3 { "matte" } else { "diffuse" };
        Self::new(None, class.to_string(), Params::none("default material"))
    }
}

/// A `Texture` directive.
pub(super) struct TextureDefinition {
    pub name: String,
    /// True for textures of numbers.
    pub number: bool,
    pub class: String,
    pub params: Params,
    /// The converted texture, once converted.
    pub made: Option<Texture>,
}

impl TextureDefinition {
    pub(super) fn new(name: String, kind: &str, class: String, params: Params) -> Self {
        Self { name, number: kind == "float", class, params, made: None }
    }
}
