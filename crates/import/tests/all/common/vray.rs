//! A small V-Ray scene and what tests ask of it.

use super::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::Rgb;
use enfilade_scene::Material;

/// A triangle in the plane z = 0 and its node.
pub const TRIANGLE: &str =
    "GeomStaticMesh mesh { vertices=ListVector(Vector(0,0,0), Vector(2,0,0), Vector(0,2,0)); faces=ListInt(0,1,2); }\n";
pub const NODE: &str = "Node chair@node_1 { geometry=mesh; material=mtl; }\nMtlSingleBRDF mtl { brdf=brdf; }\n";
pub const GREY: &str = "BRDFDiffuse brdf { color=Color(0.5, 0.5, 0.5); }\n";
pub const UNITS: &str = "SettingsUnitsInfo units { meters_scale=1; photometric_scale=0.002; }\n";

pub fn load_text(folder: &Folder, text: &str) -> Imported {
    folder.write("a.vrscene", text).load("a.vrscene").unwrap_or_else(|e| panic!("{e}"))
}

/// A scene of the triangle and something more.
pub fn load(folder: &Folder, more: &str) -> Imported {
    load_text(folder, &[TRIANGLE, NODE, GREY, UNITS, more].concat())
}

/// The material of a triangle with this BRDF, whose name is `brdf`.
pub fn material(folder: &Folder, brdf: &str) -> (Material, String) {
    let imported = load_text(folder, &[TRIANGLE, NODE, UNITS, brdf].concat());
    (imported.scene.materials[0].clone(), warnings(&imported))
}

/// Emission of the first part that emits.
pub fn emission(imported: &Imported) -> Rgb {
    let emits = |m: &&Material| !m.emission.factor.is_black();
    imported.scene.materials.iter().find(emits).expect("a light").emission.factor
}

pub fn near(a: Rgb, b: Rgb) -> bool {
    (a - b).map(f32::abs).max_component() < 1e-4 * b.max_component().max(1e-6)
}
