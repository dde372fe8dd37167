//! Pictures made of those of `KHR_materials_pbrSpecularGlossiness`, each once.

use std::collections::HashMap;

/// The pictures made so far.
#[derive(Default)]
pub(super) struct GlossPictures {
    pub known: HashMap<(u32, [u32; 4], bool), Made>,
    pub texels: usize,
}

/// The pictures made from a picture of specular colour and glossiness.
#[derive(Clone, Copy)]
pub(super) struct Made {
    /// Green is the roughness, blue the share of the dielectric.
    pub numbers: u32,
    /// f0/m, and f0/0.04 where m is below that; where the surface is of two kinds.
    pub tint: Option<u32>,
}
