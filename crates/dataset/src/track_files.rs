//! `tracks.npz` of a camera: points on surfaces, followed through its frames, with the keys of TAP-Vid's samples (Doersch et al. 2022,
//! "TAP-Vid: A Benchmark for Tracking Any Point in a Video") and what those lack.

use crate::npz::{NpyArray, npz, read_npy};
use crate::{Dataset, DatasetError, check_name, write_bytes};
use enfilade_math::DVec3;

/// Points on surfaces, followed through frames of a camera: N points, T frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tracks {
    /// The numbers of the frames.
    pub frames: Vec<u32>,
    /// The points in the world, metres, in the frames that they were seeded in.
    pub positions: Vec<DVec3>,
    /// By point: the part that it stays on, as `render_entity_id` numbers it; empty where nothing in the scene moves.
    pub node_ids: Vec<i32>,
    /// By point: the frame (its place in `frames`) that it was seeded in, and the centre of the pixel (x, y) that shows it there, px.
    pub seeds: Vec<(u32, [f32; 2])>,
    /// By point, then frame: image point as a share of width and height, (0, 0) the upper left corner of the image and (1, 1) the lower
    /// right one; also outside of it. (-1, -1) where the camera has no image of the point.
    pub points: Vec<[f32; 2]>,
    /// By point, then frame: hidden, or outside of the image.
    pub occluded: Vec<bool>,
}

impl Dataset {
    /// Writes the tracks of a camera.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or the file cannot be written.
    pub fn write_tracks(&self, scene: &str, camera: &str, tracks: &Tracks) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let path = self.layout().tracks(scene, camera);
        let (n, t) = (tracks.positions.len(), tracks.frames.len());
        let queries = tracks.seeds.iter().flat_map(|&(frame, [x, y])| [frame as f32, y, x]);
        let mut arrays = vec![
            NpyArray::new("points", "<f4", &[n, t, 2], tracks.points.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect()),
            NpyArray::new("occluded", "|b1", &[n, t], tracks.occluded.iter().map(|&v| u8::from(v)).collect()),
            NpyArray::new("query_points", "<f4", &[n, 3], queries.flat_map(f32::to_le_bytes).collect()),
            NpyArray::new(
                "positions",
                "<f8",
                &[n, 3],
                tracks.positions.iter().flat_map(|p| p.to_array()).flat_map(f64::to_le_bytes).collect(),
            ),
            NpyArray::new("frame_ids", "<i8", &[t], tracks.frames.iter().flat_map(|&frame| i64::from(frame).to_le_bytes()).collect()),
        ];
        if !tracks.node_ids.is_empty() {
            arrays.push(NpyArray::new("node_ids", "<i4", &[n], tracks.node_ids.iter().flat_map(|id| id.to_le_bytes()).collect()));
        }
        write_bytes(&path, npz(&arrays).map_err(|error| DatasetError::io("write", &path, error))?)
    }

    /// The tracks of a camera.
    ///
    /// # Errors
    /// When the file is missing, or not what [`Dataset::write_tracks`] writes.
    pub fn read_tracks(&self, scene: &str, camera: &str) -> Result<Tracks, DatasetError> {
        let path = self.layout().tracks(scene, camera);
        let archive = std::fs::read(&path).map_err(DatasetError::at("read", &path))?;
        let read = |name, dtype, shape: &[usize]| read_npy(&path, &archive, NpyArray::new(name, dtype, shape, Vec::new()));
        let frames = read("frame_ids", "<i8", &[0])?;
        let positions = read("positions", "<f8", &[0, 3])?;
        let (n, t) = (positions.shape[0], frames.shape[0]);
        let (points, occluded) = (read("points", "<f4", &[n, t, 2])?, read("occluded", "|b1", &[n, t])?);
        let queries = read("query_points", "<f4", &[n, 3])?.floats();
        let node_ids = match read("node_ids", "<i4", &[n]) {
            Ok(ids) => ids.bytes.as_chunks().0.iter().map(|bytes| i32::from_le_bytes(*bytes)).collect(),
            Err(_) if !self.moves(scene)? => Vec::new(),
            Err(error) => return Err(error),
        };
        let number = |bytes: &[u8; 8]| u32::try_from(i64::from_le_bytes(*bytes));
        let frames: Result<Vec<u32>, _> = frames.bytes.as_chunks().0.iter().map(number).collect();
        let coordinates: Vec<f64> = positions.bytes.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        Ok(Tracks {
            frames: frames.map_err(|_| DatasetError::text(&path, "frame_ids: expected numbers from 0; run enfilade make OUT tracks"))?,
            positions: coordinates.as_chunks().0.iter().map(|p| DVec3::from_array(*p)).collect(),
            node_ids,
            seeds: queries.as_chunks().0.iter().map(|&[frame, y, x]| (frame as u32, [x, y])).collect(),
            points: points.floats().as_chunks().0.to_vec(),
            occluded: occluded.bytes.iter().map(|&v| v != 0).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracks_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let tracks = Tracks {
            frames: vec![0, 1, 5],
            positions: vec![DVec3::new(0.1, 2.0, -3.0), DVec3::ONE],
            node_ids: vec![3, -1],
            seeds: vec![(0, [10.5, 20.5]), (2, [3.5, 0.5])],
            points: vec![[0.5, 0.25], [-1.0, -1.0], [1.5, 0.0], [0.0, 0.0], [0.1, 0.2], [0.3, 0.4]],
            occluded: vec![false, true, true, false, true, false],
        };
        dataset.write_tracks("room", "cam_00", &tracks).unwrap();
        assert_eq!(dataset.read_tracks("room", "cam_00").unwrap(), tracks);
        dataset.write_tracks("room", "cam_00", &Tracks::default()).unwrap();
        assert_eq!(dataset.read_tracks("room", "cam_00").unwrap(), Tracks::default());
        write_bytes(&dataset.layout().tracks("room", "cam_00"), b"PK").unwrap();
        assert!(dataset.read_tracks("room", "cam_00").unwrap_err().to_string().contains("tracks.npz: frame_ids: "));
        assert!(dataset.read_tracks("room", "cam_01").unwrap_err().is_not_found());
    }
}
