//! How numbers, names and solids stand in files.

use enfilade_compose::Solid;
use enfilade_math::DVec3;
use std::fmt::Write;

/// Numbers with blanks between: metres to a hundredth of a micron, and nothing negative that is zero.
pub(crate) fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(" ")
}

/// A number with at most eight places.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.8}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// A vector.
pub(crate) fn vector(value: DVec3) -> String {
    numbers(&value.to_array())
}

/// A number that may be small, such as a mass: six significant digits.
pub(crate) fn small(value: f64) -> String {
    let digits = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    let places = (5.0 - digits).clamp(0.0, 20.0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// Text within an attribute of XML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// A solid as Wavefront OBJ.
pub(crate) fn solid_obj(solid: &Solid) -> Vec<u8> {
    let mut text = String::new();
    for corner in &solid.corners {
        _ = writeln!(text, "v {}", vector(*corner));
    }
    for triangle in &solid.triangles {
        let [a, b, c] = triangle.map(|corner| corner + 1);
        _ = writeln!(text, "f {a} {b} {c}");
    }
    text.into_bytes()
}
