//! Every surface along the ray of each pixel of a frame, with the class of its part.

use crate::{Filmed, MultiviewError, ScenePackage};
use enfilade_dataset::{DatasetError, Surfaces};
use enfilade_render::RaySurfaces;
use enfilade_scene::{Cx, PartLabel};

/// Writes the first `count` surfaces along the rays of each of these frames. Scenes without label tables have no classes.
///
/// # Errors
/// When the scene or its labels cannot be used, or a file cannot be written.
pub fn write_surfaces(
    filmed: &Filmed<'_>,
    package: &ScenePackage,
    frames: &[usize],
    count: u32,
    cx: &dyn Cx,
) -> Result<(), MultiviewError> {
    let classes = classes(filmed, package.scene.parts.len())?;
    let still = package.scene.is_still().then(|| package.lookout_through_surfaces()).transpose()?;
    let total = frames.len() as u64;
    for (done, &frame) in frames.iter().enumerate() {
        cx.progress("frames", done as u64, total);
        let view = filmed.view(frame);
        let [width, height] = view.camera().size().map(|side| side as usize);
        let found = match &still {
            Some(lookout) => lookout.surfaces(&view, count as usize),
            None => package.ready_through_surfaces(&filmed.moments(&package.scene, frame))?.surfaces(&view, count as usize),
        };
        let RaySurfaces { count, distance_m, entity, side, normal_world, bent } = found;
        let class = |&entity: &i16| usize::try_from(entity - 1).ok().and_then(|part| classes.get(part)).copied().unwrap_or(-1);
        let surfaces = Surfaces {
            size: [height, width],
            count,
            semantic: entity.iter().map(class).collect(),
            distance_m,
            entity,
            side,
            normal_world: normal_world.into_iter().flatten().collect(),
            bent_distance_m: bent.iter().map(|bent| bent.way_m).collect(),
            bent_position: bent.iter().flat_map(|bent| bent.position).collect(),
            bent_entity: bent.iter().map(|bent| bent.entity).collect(),
        };
        let (camera, number) = filmed.name(frame);
        filmed.dataset.write_surfaces(&filmed.scene, camera, number, surfaces)?;
    }
    cx.progress("frames", total, total);
    Ok(())
}

/// The class of each part.
fn classes(filmed: &Filmed<'_>, parts: usize) -> Result<Vec<i16>, DatasetError> {
    let labels = match filmed.dataset.mesh_files(&filmed.scene).read_labels() {
        Err(error) if error.is_not_found() => return Ok(vec![-1; parts]),
        labels => labels?,
    };
    let nodes = filmed.dataset.read_nodes(&filmed.scene)?;
    let label = |object: Option<u32>| object.and_then(|id| labels.parts.get(id as usize)).unwrap_or(&PartLabel::NONE);
    Ok(nodes.iter().map(|node| label(node.object_id).semantic).collect())
}
