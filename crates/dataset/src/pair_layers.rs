//! Layers that lead from one frame to another of the same scene, whichever two they are: `optical_flow`, `scene_flow` and
//! `flow_visibility`, in `_detail/<camera>/pairs/`.

use crate::frames::write_layer;
use crate::read::{read_image, sorted_names};
use crate::{Dataset, DatasetError, FramePair, check_name};
use enfilade_frame::{Frame, Layer, Values};

/// Layer by which a pair that has layers is known.
const FIRST: Layer = Layer::OpticalFlow;

impl Dataset {
    /// Writes layers that lead from the first frame of a pair to the second: images of the first.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or a file cannot be written.
    pub fn write_pair_layers(&self, pair: &FramePair, layers: &Frame) -> Result<(), DatasetError> {
        check_name("scene name", &pair.scene)?;
        check_name("camera name", &pair.first.0)?;
        check_name("camera name", &pair.second.0)?;
        let size = [layers.height as usize, layers.width as usize];
        let each: Vec<(Layer, &Values)> = layers.iter().collect();
        let write = |&(layer, values): &(Layer, &Values)| write_layer(&self.layout().pair_layer(pair, layer), size, layer, values);
        enfilade_parallel::try_map(&each, write).map(drop)
    }

    /// One layer that leads from the first frame of a pair to the second, with the first one's height and width.
    ///
    /// # Errors
    /// When the file is missing, damaged, or not an image of the layer's channels.
    pub fn read_pair_layer(&self, pair: &FramePair, layer: Layer) -> Result<([usize; 2], Values), DatasetError> {
        read_image(&self.layout().pair_layer(pair, layer), layer, None)
    }

    /// The pairs of a camera's frames with others that have such layers, sorted.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn pairs_with_layers(&self, scene: &str, camera: &str) -> Result<Vec<FramePair>, DatasetError> {
        let folder = self.layout().pair_layers_dir(scene, camera);
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let pair = |name: &String| {
            let (first, second) = frames_of(name)?;
            Some(FramePair { scene: scene.into(), first: (camera.into(), first), second })
        };
        let mut pairs: Vec<FramePair> = sorted_names(&folder)?.iter().filter_map(pair).collect();
        pairs.sort();
        Ok(pairs)
    }
}

/// The first frame's number, and the second frame, of the name of a file of flow; `None` for other names.
fn frames_of(name: &str) -> Option<(u32, (String, u32))> {
    let frames = name.strip_suffix(".hdf5")?.strip_suffix(FIRST.spec().name)?.strip_suffix('.')?;
    let (first, second) = frames.rsplit_once(".frame.")?;
    let (number, camera) = first.strip_prefix("frame.")?.split_once('.')?;
    Some((number.parse().ok()?, (camera.into(), second.parse().ok()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_of_pairs_come_back_and_pairs_are_found_by_them() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let pair = |first, second: (&str, u32)| FramePair {
            scene: "room".into(),
            first: ("cam_00".into(), first),
            second: (second.0.into(), second.1),
        };
        assert!(dataset.pairs_with_layers("room", "cam_00").unwrap().is_empty());
        let mut frame = Frame::new(2, 1);
        frame.insert(Layer::OpticalFlow, Values::F32(vec![1.0, 2.0, f32::NAN, f32::NAN]));
        frame.insert(Layer::FlowVisibility, Values::U8(vec![1, 0]));
        let pairs = [pair(2, ("cam_00", 12345)), pair(2, ("cam.01", 7))];
        for pair in &pairs {
            dataset.write_pair_layers(pair, &frame).unwrap();
        }
        let path = dataset.layout().pair_layer(&pairs[1], Layer::OpticalFlow);
        assert!(path.ends_with("_detail/cam_00/pairs/frame.0002.cam.01.frame.0007.optical_flow.hdf5"), "{}", path.display());
        let mut sorted = pairs.to_vec();
        sorted.sort();
        assert_eq!(dataset.pairs_with_layers("room", "cam_00").unwrap(), sorted);
        let (size, values) = dataset.read_pair_layer(&pairs[1], Layer::OpticalFlow).unwrap();
        assert_eq!((size, values.get(1)), ([1, 2], 2.0));
    }
}
