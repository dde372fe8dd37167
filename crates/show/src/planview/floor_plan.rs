//! The plan of a scene without cameras: its outlines at one height, as SVG.

use super::cut::{Cut, Look, joined};
use enfilade_math::{Bounds3, DVec3, Vec3};
use enfilade_scene::WorldMesh;
use std::fmt::Write;

/// Height of the cut, as a share of the scene's height: above tables and seats, through windows, below things that hang from ceilings.
const CUT: f64 = 0.4;

/// Draws the lines in which surfaces meet a level plane at two fifths of the scene's height, seen from above: x to the right, y up. The
/// drawing is `width` pixels across, and at most twice as high; it is in the reader's text colour.
pub fn floor_plan_svg(world: &WorldMesh, width: u32) -> String {
    let bounds = if world.bounds.is_empty() { Bounds3::from_points([Vec3::ZERO]) } else { world.bounds };
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let extent = (high - low).max(DVec3::splat(1e-6));
    let scale = f64::from(width) / extent.x.max(0.5 * extent.y);
    let cut = Cut { look: Look::Down, through: low + CUT * extent };
    let mut path = String::new();
    for run in joined(&cut.lines(world)) {
        for (i, p) in run.iter().enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{command}{:.1} {:.1}", (p.x - low.x) * scale, (high.y - p.y) * scale);
        }
    }
    let [across, down] = [extent.x, extent.y].map(|length| (length * scale).ceil());
    let title = cut.name();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{across}\" height=\"{down}\" viewBox=\"0 0 {across} {down}\"><title>plan at {title}\
         </title><path d=\"{path}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1\"/></svg>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb, Vec3};
    use enfilade_scene::{Material, Part, Scene};

    #[test]
    fn a_wall_is_a_line_where_it_stands() {
        // Along x at y = 1, four metres long and three high, over a floor of four by two.
        let wall = [[0.0, 1.0, 0.0], [4.0, 1.0, 0.0], [4.0, 1.0, 3.0], [0.0, 1.0, 3.0]];
        let floor = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        let mesh = |corners: [[f32; 3]; 4]| Mesh {
            positions: corners.map(Vec3::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let part = |name: &str, mesh| Part { name: name.into(), object: None, mesh, material: 0, world_from_mesh: DAffine3::IDENTITY };
        let scene = Scene {
            meshes: vec![mesh(wall).into(), mesh(floor).into()],
            materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
            parts: vec![part("wall", 0), part("floor", 1)],
            ..Scene::default()
        };
        let svg = floor_plan_svg(&WorldMesh::new(&scene), 400);
        assert!(svg.contains("width=\"400\" height=\"200\"") && svg.contains("z = 1.20 m"), "{svg}");
        let path = svg.split("d=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        assert!(path.contains("0.0 100.0") && path.contains("400.0 100.0"), "{path}");
    }
}
