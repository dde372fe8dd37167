//! Glass and water. Indices: soda-lime glass 1.52, lead-free crystal 1.53, water 1.333.

use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, Material};

/// A pane without thickness that passes `transmittance` of what its two faces let through.
pub fn pane(name: &str, transmittance: Rgb) -> Material {
    Material::new(name, Bsdf::ThinDielectric { eta: 1.52, transmittance: transmittance.into() })
}

/// A pane of etched glass, as seen in thin films of scatterers: part of the light goes straight on, part is scattered back.
pub fn frosted() -> Material {
    let clear = Bsdf::ThinDielectric { eta: 1.52, transmittance: Rgb::new(0.93, 0.96, 0.95).into() };
    let white = Bsdf::Diffuse { reflectance: Rgb::new(0.74, 0.76, 0.755).into() };
    Material::new("frosted glass", Bsdf::Blend { first: Box::new(clear), second: Box::new(white), weight: 0.55.into() })
}

/// A solid body with an absorption per metre.
pub fn body(name: &str, eta: f32, absorption: Rgb) -> Material {
    Material::new(name, Bsdf::Dielectric { eta, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption })
}

/// Bottle glass, per metre: a wall of 3 mm of green glass passes about half of the red and blue.
pub const BOTTLES: [(&str, Rgb); 4] = [
    ("green bottle glass", Rgb::new(220.0, 70.0, 240.0)),
    ("brown bottle glass", Rgb::new(110.0, 300.0, 900.0)),
    ("clear bottle glass", Rgb::new(6.0, 3.0, 5.0)),
    ("blue bottle glass", Rgb::new(320.0, 140.0, 30.0)),
];
