//! Bounding boxes of semantic instances, in Hypersim's three kinds and by its rules.
//!
//! The points of an instance are the corners of all its triangles, each as often as it is a corner. Sides are ordered and directed as by
//! the toolkit's code; its README describes the second kind differently:
//!
//! | kind | sides | order | direction |
//! |---|---|---|---|
//! | `axis_aligned` | the world's axes | x, y, z | the world's |
//! | `object_aligned_2d` | the rectangle of least area in the ground plane, exactly; and up | long, short, up | long toward the mean of the points, up upward |
//! | `object_aligned_3d` | a box of nearly the least volume | by falling length | the first two toward the mean of the points |
//!
//! Every box is right-handed. The third kind is never larger than the other two.

mod hull;
mod least;
mod rectangle;

use enfilade_dataset::{BoxKind, Dataset, DatasetError};
use enfilade_math::{DMat3, DVec2, DVec3, OrientedBox};
use enfilade_scene::{Labels, Scene};
use std::path::PathBuf;

/// The boxes of an instance, by [`BoxKind`] as index.
pub type InstanceBoxes = [OrientedBox; 3];

/// The boxes of every instance: entry i is instance i; `None` for 0 and for numbers that no triangle has.
pub fn scene_boxes(scene: &Scene, labels: &Labels) -> Vec<Option<InstanceBoxes>> {
    enfilade_parallel::map(&instance_points(scene, labels), |points| boxes_around(points))
}

/// Writes the boxes of every instance of a scene, and returns the files and how many instances have boxes.
///
/// # Errors
/// When a file cannot be written.
pub fn write_boxes(dataset: &Dataset, name: &str, scene: &Scene, labels: &Labels) -> Result<(Vec<PathBuf>, usize), DatasetError> {
    let boxes = scene_boxes(scene, labels);
    let mut files = Vec::new();
    for kind in BoxKind::ALL {
        let rows: Vec<Option<OrientedBox>> = boxes.iter().map(|boxes| boxes.as_ref().map(|boxes| *of_kind(boxes, kind))).collect();
        dataset.write_boxes(name, kind, &rows)?;
        files.extend(dataset.box_files(name, kind));
    }
    Ok((files, boxes.iter().flatten().count()))
}

/// The points of every instance in the world: the corners of its triangles, in double precision, as in `mesh_vertices.hdf5`.
fn instance_points(scene: &Scene, labels: &Labels) -> Vec<Vec<DVec3>> {
    let instances = labels.parts.iter().map(|label| label.instance).max().unwrap_or(0).max(0) as usize;
    let mut points = vec![Vec::new(); instances + 1];
    for (part, label) in scene.parts.iter().zip(&labels.parts).filter(|(_, label)| label.instance >= 1) {
        let mesh = &scene.meshes[part.mesh as usize];
        let world: Vec<DVec3> = mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3())).collect();
        points[label.instance as usize].extend(mesh.triangles.iter().flatten().map(|&i| world[i as usize]));
    }
    points
}

/// The three boxes around the corners of triangles; `None` without points.
pub fn boxes_around(points: &[DVec3]) -> Option<InstanceBoxes> {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let axis_aligned = OrientedBox::around(points.iter().copied(), DMat3::IDENTITY)?;
    let upright = upright_box(points)?;
    let free = OrientedBox::around(points.iter().copied(), least::least_orientation(points))?;
    let least = [axis_aligned, upright, free].into_iter().min_by(|a, b| size(a).total_cmp(&size(b)))?;
    Some([axis_aligned, upright, ordered(&least, mean)])
}

/// The volume, of flat boxes as if they had a thickness: among those the one of least area is smallest.
fn size(b: &OrientedBox) -> f64 {
    let thickness = hull::TOLERANCE * b.extents.max_element();
    b.extents.max(DVec3::splat(thickness)).element_product()
}

/// The box of the kind `object_aligned_2d` around the corners of triangles; `None` without points.
pub fn upright_box(points: &[DVec3]) -> Option<OrientedBox> {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut ground: Vec<DVec2> = points.iter().map(|p| p.truncate()).collect();
    let (along, _) = rectangle::least_rectangle(&mut ground);
    let with_x = |x: DVec2| {
        let axes = DMat3::from_cols(x.extend(0.0), x.perp().extend(0.0), DVec3::Z);
        OrientedBox::around(points.iter().copied(), axes)
    };
    let found = with_x(along)?;
    let long = if found.extents.x < found.extents.y { along.perp() } else { along };
    let toward = if long.dot((mean - found.center).truncate()) < 0.0 { -long } else { long };
    with_x(toward)
}

/// The box with its sides in the order and directions of `object_aligned_3d`.
fn ordered(b: &OrientedBox, mean: DVec3) -> OrientedBox {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| b.extents[j].total_cmp(&b.extents[i]));
    let [x, y] = [0, 1].map(|i| {
        let axis = b.world_from_box.col(order[i]);
        if axis.dot(mean - b.center) < 0.0 { -axis } else { axis }
    });
    let extents = DVec3::from(order.map(|i| b.extents[i]));
    OrientedBox { center: b.center, world_from_box: DMat3::from_cols(x, y, x.cross(y)), extents }
}

/// The box of a kind.
pub fn of_kind(boxes: &InstanceBoxes, kind: BoxKind) -> &OrientedBox {
    &boxes[kind as usize]
}

#[cfg(test)]
mod tests;
