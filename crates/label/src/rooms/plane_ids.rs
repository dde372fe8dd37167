//! The plane of its scene's rooms that each pixel of a frame shows.

use enfilade_dataset::{Dataset, DatasetError};
use enfilade_frame::{Layer, vector};
use enfilade_math::DVec3;
use enfilade_scene::{Cx, Rooms};

/// Writes the table of the planes of rooms, and which of them each pixel of these frames of a camera shows.
///
/// # Errors
/// When a layer of a frame is missing or damaged, or a file cannot be written.
pub fn write_planes(dataset: &Dataset, [scene, camera]: [&str; 2], rooms: &Rooms, frames: &[u32], cx: &dyn Cx) -> Result<(), DatasetError> {
    let planes = rooms.planes();
    dataset.write_plane_table(scene, &planes)?;
    let total = frames.len() as u64;
    for (done, &number) in frames.iter().enumerate() {
        cx.progress("frames", done as u64, total);
        let wanted = [Layer::Position, Layer::Semantic];
        let frame = dataset.read_frame(scene, camera, number, &wanted)?;
        let (Some(positions), Some(classes)) = (frame.get(Layer::Position), frame.get(Layer::Semantic)) else {
            let problem = format!("frame {number} of {camera} lacks position or semantic; render or label it again");
            return Err(DatasetError::Hdf5 { path: dataset.layout().layer(scene, camera, number, Layer::Semantic), problem });
        };
        let plane = |pixel: usize| {
            let p: DVec3 = vector(positions, pixel);
            rooms.plane_at(classes.get(pixel) as i16, p).map_or(-1, |place| place as i16 + 1)
        };
        let ids = (0..frame.pixels()).map(plane).collect();
        dataset.write_plane_ids([scene, camera], number, [frame.height, frame.width].map(|side| side as usize), ids)?;
    }
    cx.progress("frames", total, total);
    Ok(())
}
