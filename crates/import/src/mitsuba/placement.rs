//! Placement of a shape by its own parameters.

use super::emitter;
use super::reader::{Reader, spelling};
use super::xml::Node;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec3};

impl<'n> Reader<'n, '_> {
    /// The placement that centre, radius and end points add to a unit shape. `None`, with a warning, for unknown shapes.
    pub(super) fn shape_parameters(&mut self, node: &'n Node) -> Result<Option<DAffine3>, ImportError> {
        let point = |name: &str, default: DVec3| node.child(name).map_or(Ok(default), emitter::vector);
        let radius = node.float_or("radius", 1.0)?;
        Ok(match node.plugin.as_str() {
            "obj" | "ply" | "serialized" | "rectangle" | "disk" | "cube" => Some(DAffine3::IDENTITY),
            "sphere" => {
                let center = point("center", DVec3::ZERO)?;
                Some(DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(radius)), center))
            }
            "cylinder" => {
                let (p0, p1) = (point("p0", DVec3::ZERO)?, point("p1", DVec3::Z)?);
                let axis = p1 - p0;
                let z = axis.try_normalize().ok_or_else(|| node.error("both ends of the cylinder coincide"))?;
                let x = tangent(z, self.version);
                Some(DAffine3::from_mat3_translation(DMat3::from_cols(x * radius, z.cross(x) * radius, axis), p0))
            }
            other => {
                self.warn(node, format!("{other} shapes are not supported{}; it was left out", spelling(other)));
                None
            }
        })
    }
}

/// Direction of u = 0 around the unit vector `z`: the first tangent of Duff et al. 2017 since version 2, of Mitsuba's own basis before.
fn tangent(z: DVec3, version: u32) -> DVec3 {
    if version >= 2 {
        return z.any_orthonormal_pair().0;
    }
    let second = if z.x.abs() > z.y.abs() { DVec3::new(z.z, 0.0, -z.x) } else { DVec3::new(0.0, z.z, -z.y) };
    second.cross(z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cylinders_begin_where_those_of_the_version_do() {
        for (z, old, new) in [(DVec3::X, -DVec3::Y, -DVec3::Z), (DVec3::Y, DVec3::X, DVec3::X), (DVec3::Z, DVec3::X, DVec3::X)] {
            assert!(tangent(z, 0).abs_diff_eq(old, 1e-12), "{z}: {}", tangent(z, 0));
            assert!(tangent(z, 3).abs_diff_eq(new, 1e-12), "{z}: {}", tangent(z, 3));
        }
    }
}
