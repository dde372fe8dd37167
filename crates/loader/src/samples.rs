//! The frames that were chosen, each as a sample.

use crate::error::LoaderError;
use crate::options::{Choice, Crop, CropPlace, Options};
use crate::order::below;
use crate::resize::{averaged, nearest};
use crate::sample::{Image, Matrix3, Matrix4, Sample, Values, is_averaged, mask_out};
use crate::tone::{displayed, fit};
use enfilade_dataset::{Dataset, DatasetError, OpencvCalibration, Side, ToneMapRow, Window, turn_planar_depth};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{LAYERS, Layer};
use enfilade_math::{DVec3, hash_u64};
use enfilade_scene::{Pose, Projection};
use std::collections::{BTreeMap, HashSet};
use std::sync::OnceLock;

/// The frame of the dataset of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameName<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Name of the camera.
    pub camera: &'a str,
    /// Frame number.
    pub frame: u32,
}

/// A list of frames, by scene, camera and frame number.
pub struct Samples {
    dataset: Dataset,
    layers: Vec<Layer>,
    options: Options,
    cameras: Vec<Camera>,
    frames: Vec<Frame>,
}

/// A camera of a scene, and what was read of it.
struct Camera {
    scene: String,
    name: String,
    size: OnceLock<[usize; 2]>,
    calibration: OnceLock<(Projection, OpencvCalibration)>,
    poses: OnceLock<BTreeMap<u32, Pose>>,
    exposures: OnceLock<Vec<ToneMapRow>>,
}

struct Frame {
    /// Index of its camera.
    camera: usize,
    number: u32,
    exposure: OnceLock<ToneMap>,
}

impl Samples {
    /// The frames of a dataset that `choice` is about.
    ///
    /// # Errors
    /// When the dataset cannot be read, a name is not there, or no frame is left.
    pub fn open(dataset: Dataset, choice: &Choice, options: Options) -> Result<Self, LoaderError> {
        let mut samples = Self { dataset, layers: Vec::new(), options, cameras: Vec::new(), frames: Vec::new() };
        let side = choice.side.map(|side| samples.side(side)).transpose()?;
        let scenes = chosen("scene", samples.dataset.scenes()?, choice.scenes.as_deref())?;
        let mut layers = choice.layers.clone();
        let mut known = Vec::new();
        for scene in &scenes {
            for camera in samples.dataset.cameras(scene)? {
                known.push(camera.clone());
                if choice.cameras.as_ref().is_some_and(|names| !names.contains(&camera)) {
                    continue;
                }
                let wanted = |frame: &u32| side.as_ref().is_none_or(|side| side.contains(&(scene.clone(), camera.clone(), *frame)));
                let numbers: Vec<u32> = samples.dataset.frame_numbers(scene, &camera)?.into_iter().filter(wanted).collect();
                let Some(&first) = numbers.first() else { continue };
                samples.check_poses(scene, &camera)?;
                let layers = layers.get_or_insert_with(|| samples.stored_layers(scene, &camera, first));
                samples.add(scene, camera, &numbers, layers);
            }
        }
        known.sort_unstable();
        known.dedup();
        chosen("camera", known, choice.cameras.as_deref())?;
        samples.layers = layers.unwrap_or_default();
        samples.check(choice)?;
        Ok(samples)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Always false: [`Samples::open`] refuses a choice without frames.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// The layers of each sample.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// How each sample is processed.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The frame that sample `index` is.
    ///
    /// # Panics
    /// When there are fewer.
    pub fn place(&self, index: usize) -> FrameName<'_> {
        let frame = &self.frames[index];
        let camera = &self.cameras[frame.camera];
        FrameName { scene: &camera.scene, camera: &camera.name, frame: frame.number }
    }

    /// Decodes a sample. Random crops are elsewhere in each `epoch`.
    ///
    /// # Errors
    /// When a file is missing or damaged, the crop larger than the image, or the image of another size than the camera whose K or
    /// rays it takes.
    ///
    /// # Panics
    /// If `index` is not below the number of samples.
    pub fn sample(&self, index: usize, epoch: u64) -> Result<Sample, LoaderError> {
        let (FrameName { scene, camera, frame }, options) = (self.place(index), &self.options);
        // Decode the layers, or the part of them that the crop shows
        let part = options.crop.map(|crop| self.window(index, crop, epoch)).transpose()?;
        let mut layers = Vec::with_capacity(self.layers.len());
        for &layer in &self.layers {
            layers.push((layer, self.image(index, layer, part)?));
        }
        let (_, first) = &layers[0];
        let [height, width] = [first.height, first.width];
        if let Some((layer, other)) = layers.iter().find(|(_, image)| [image.height, image.width] != [height, width]) {
            let path = self.dataset.layer_source(scene, camera, frame, *layer);
            let sizes = format!("{}x{} pixels, but other layers of the frame have {height}x{width}", other.height, other.width);
            return Err(LoaderError::Request(format!("{}: {sizes}; choose layers of one size, or replace the file", path.display())));
        }

        // Find the pixels that have values, and the exposure, before anything is resized
        let mut mask = options.mask.then(|| Image { height, width, channels: 1, values: Values::U8(mask_of(&layers, height * width)) });
        let window = part.unwrap_or(Window { top: 0, left: 0, height, width });
        let tone = self.tone(index, &layers, part.is_none())?;

        // Resize layers and mask
        if let Some([height, width]) = options.resize {
            for (layer, image) in &mut layers {
                *image = if is_averaged(*layer) { averaged(image, height, width) } else { nearest(image, height, width) };
                if *layer == Layer::OpticalFlow && !options.stored {
                    scale_flow(image, [width as f32 / window.width as f32, height as f32 / window.height as f32]);
                }
            }
            mask = mask.map(|mask| {
                let mut mask = nearest(&mask, height, width);
                // A mean over an area in which a value is missing is missing too.
                if let Values::U8(kept) = &mut mask.values {
                    layers.iter().filter(|(layer, _)| is_averaged(*layer)).for_each(|(layer, image)| mask_out(kept, *layer, image));
                }
                mask
            });
        }

        // Tone-map the colour, and bring K to the pixels of the sample
        if let (Some(tone), Some((_, color))) = (tone, layers.iter_mut().find(|(layer, _)| *layer == Layer::Color)) {
            *color = displayed(color, tone);
        }
        let (k, world_from_camera) = if options.cameras { self.calibration(index, window)? } else { (None, None) };
        Ok(Sample { scene: scene.into(), camera: camera.into(), frame, window, layers, mask, k, world_from_camera })
    }

    /// The images of a side of the partition.
    fn side(&self, side: Side) -> Result<HashSet<(String, String, u32)>, LoaderError> {
        let rows = self.dataset.read_partition().map_err(|error| match error.is_not_found() {
            true => LoaderError::NoPartition { path: self.dataset.layout().partition() },
            false => error.into(),
        })?;
        let rows = rows.into_iter().filter(|row| row.side == Ok(side));
        Ok(rows.map(|row| (row.scene, row.camera, row.frame)).collect())
    }

    fn stored_layers(&self, scene: &str, camera: &str, frame: u32) -> Vec<Layer> {
        LAYERS.iter().map(|spec| spec.layer).filter(|&layer| self.dataset.has_layer(scene, camera, frame, layer)).collect()
    }

    /// Refuses a camera without poses if these are requested: there are none if only Hypersim's images were downloaded.
    fn check_poses(&self, scene: &str, camera: &str) -> Result<(), LoaderError> {
        let poses = self.dataset.layout().keyframes(scene, camera, "positions");
        if !self.options.cameras || poses.is_file() {
            return Ok(());
        }
        let remedy = "unpack the scene's folder _detail beside its images, choose other scenes, or ask for no poses (poses=False)";
        Err(LoaderError::Request(format!("{scene}/{camera} has images but no poses: {} is not there; {remedy}", poses.display())))
    }

    /// Adds a camera with the frames that have all layers.
    fn add(&mut self, scene: &str, name: String, numbers: &[u32], layers: &[Layer]) {
        let has = |frame, layer| self.dataset.layer_source(scene, &name, frame, layer).is_file();
        let whole = numbers.iter().filter(|&&frame| layers.iter().all(|&layer| has(frame, layer)));
        let camera = self.cameras.len();
        self.frames.extend(whole.map(|&number| Frame { camera, number, exposure: OnceLock::new() }));
        let (size, calibration, poses, exposures) = Default::default();
        self.cameras.push(Camera { scene: scene.into(), name, size, calibration, poses, exposures });
    }

    /// Refuses what can give no sample.
    fn check(&self, choice: &Choice) -> Result<(), LoaderError> {
        let root = self.dataset.root().display();
        let refuse = |problem: String| Err(LoaderError::Request(problem));
        let sizes = [self.options.crop.map(|crop| crop.size), self.options.resize];
        if sizes.iter().flatten().flatten().any(|&side| side == 0) {
            return refuse("crops and sizes must have at least one row and one column".into());
        }
        if choice.layers.as_ref().is_some_and(Vec::is_empty) {
            return refuse("no layers were asked for; name at least one".into());
        }
        if !self.frames.is_empty() {
            return Ok(());
        }
        match self.cameras.first() {
            None => refuse(format!("{root} has no complete frame among the scenes, cameras and side of the partition that were asked for")),
            Some(camera) => {
                let first = self.dataset.frame_numbers(&camera.scene, &camera.name)?.first().copied().unwrap_or_default();
                let name = |layer: &Layer| layer.spec().name;
                let asked: Vec<&str> = self.layers.iter().map(name).collect();
                let there: Vec<&str> = self.stored_layers(&camera.scene, &camera.name, first).iter().map(name).collect();
                let (asked, there) = (asked.join(", "), there.join(", "));
                refuse(format!("no frame of {root} has all of {asked}; frame {first} of {}/{} has {there}", camera.scene, camera.name))
            }
        }
    }

    /// A layer of a sample, or a part of it.
    fn image(&self, index: usize, layer: Layer, part: Option<Window>) -> Result<Image, LoaderError> {
        let FrameName { scene, camera, frame } = self.place(index);
        let projection = || Ok(self.camera_calibration(index)?.0.clone());
        let is_there = self.dataset.stored_layer(scene, camera, frame, layer) == layer;
        let ([height, width], mut values) = if self.options.stored && is_there {
            self.dataset.read_layer_window(scene, camera, frame, layer, part)?
        } else {
            self.dataset.read_specified(scene, camera, frame, layer, part, &projection)?
        };
        if layer == Layer::DepthZMeters && is_there && !self.options.stored {
            let part = part.unwrap_or(Window { top: 0, left: 0, height, width });
            match self.camera_calibration(index) {
                Ok((projection, _)) if projection.image_axis() == DVec3::NEG_Z => {}
                Ok((projection, _)) => {
                    self.check_size(index, projection, part)?;
                    turn_planar_depth(projection, part, &mut values);
                }
                // Images without `_detail`, and no table has a matrix of their camera.
                Err(_) if !self.dataset.layout().camera_model(scene, camera).is_file() => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(Image { height, width, channels: layer.spec().channels, values })
    }

    /// Height and width of a sample's image before it is cropped.
    fn image_size(&self, index: usize) -> Result<[usize; 2], DatasetError> {
        let FrameName { scene, camera, frame } = self.place(index);
        let known = &self.cameras[self.frames[index].camera].size;
        get_or_try(known, || self.dataset.image_size(scene, camera, frame, self.layers[0])).copied()
    }

    /// Refuses images of another size than their camera's: its rays and K would not fit. `window` is the part of them that was read.
    fn check_size(&self, index: usize, projection: &Projection, window: Window) -> Result<(), LoaderError> {
        let whole = [window.height, window.width];
        let [height, width] = if self.options.crop.is_some() { self.image_size(index)? } else { whole };
        let [w, h] = projection.size().map(|side| side as usize);
        if [width, height] == [w, h] {
            return Ok(());
        }
        let FrameName { scene, camera, .. } = self.place(index);
        let found = format!("the images of {scene}/{camera} have {width}x{height} pixels, but its camera {w}x{h}");
        let remedy = "take the images as they were rendered and let `resize` shrink them, name a table of cameras of their size, or ask \
            for neither poses (poses=False) nor planar depth";
        Err(LoaderError::Request(format!("{found}: K and rays are not theirs; {remedy}")))
    }

    /// The part of the image that a crop shows.
    fn window(&self, index: usize, crop: Crop, epoch: u64) -> Result<Window, LoaderError> {
        let [rows, columns] = self.image_size(index)?;
        let [height, width] = crop.size;
        let random = |purpose: u64, free: usize| {
            let mixed = [epoch, index as u64, purpose].iter().fold(hash_u64(self.options.seed), |hash, &v| hash_u64(hash ^ v));
            below(mixed, free + 1)
        };
        let free = [rows.saturating_sub(height), columns.saturating_sub(width)];
        let [top, left] = match crop.place {
            CropPlace::Center => free.map(|free| free / 2),
            CropPlace::Random => [random(0, free[0]), random(1, free[1])],
            CropPlace::At(first) => first,
        };
        let window = Window { top, left, height, width };
        if window.fits(rows, columns) {
            return Ok(window);
        }
        let FrameName { scene, camera, frame } = self.place(index);
        let path = self.dataset.layer_source(scene, camera, frame, self.layers[0]);
        let crop = format!("a crop of {height}x{width} pixels from row {top}, column {left}");
        Err(LoaderError::Request(format!("{}: {crop} leaves the image of {rows}x{columns}", path.display())))
    }

    /// The exposure of the sample's frame, if colour is to be displayed. `whole` means that the layers are of the whole frame.
    fn tone(&self, index: usize, layers: &[(Layer, Image)], whole: bool) -> Result<Option<ToneMap>, LoaderError> {
        let color = layers.iter().find(|(layer, _)| *layer == Layer::Color).map(|(_, image)| image);
        let (true, Some(color)) = (self.options.tone_map, color) else { return Ok(None) };
        let (frame, FrameName { scene, camera, .. }) = (&self.frames[index], self.place(index));
        if let Some(known) = frame.exposure.get() {
            return Ok(Some(*known));
        }
        let rows = get_or_try(&self.cameras[frame.camera].exposures, || self.dataset.read_tone_maps(scene, camera))?;
        let found = match rows.iter().find(|row| row.frame == frame.number) {
            Some(row) => ToneMap { scale: row.scale },
            None if whole => self.fitted(index, color)?,
            None => self.fitted(index, &self.image(index, Layer::Color, None)?)?,
        };
        Ok(Some(*frame.exposure.get_or_init(|| found)))
    }

    /// The exposure of a frame's whole colour, by the pixels that show the scene if the frame identifies them.
    fn fitted(&self, index: usize, color: &Image) -> Result<ToneMap, LoaderError> {
        let (FrameName { scene, camera, frame }, layer) = (self.place(index), Layer::RenderEntityId);
        if !self.dataset.has_layer(scene, camera, frame, layer) {
            return Ok(fit(color, None));
        }
        let ([height, width], ids) = self.dataset.read_layer_window(scene, camera, frame, layer, None)?;
        if [height, width] == [color.height, color.width] {
            return Ok(fit(color, Some(&ids)));
        }
        let path = self.dataset.layout().layer(scene, camera, frame, layer);
        let sizes = format!("{height}x{width} pixels, but color has {}x{}", color.height, color.width);
        let remedy = "the tone map goes by the pixels with an id; replace the file, move it away, or ask for no tone map (tone_map=False)";
        Err(LoaderError::Request(format!("{}: {sizes}: {remedy}", path.display())))
    }

    /// K of the sample's pixels, and its pose.
    fn calibration(&self, index: usize, window: Window) -> Result<(Option<Matrix3>, Option<Matrix4>), LoaderError> {
        let (projection, calibration) = self.camera_calibration(index)?;
        if calibration.intrinsics.is_some() {
            self.check_size(index, projection, window)?;
        }
        let FrameName { scene, camera, frame } = self.place(index);
        let poses = get_or_try(&self.cameras[self.frames[index].camera].poses, || {
            let trajectory = self.dataset.read_trajectory(scene, camera)?;
            Ok::<_, DatasetError>(trajectory.poses.into_iter().map(|pose| (pose.frame, pose)).collect())
        })?;
        let unknown = || LoaderError::Request(format!("{scene}/{camera} has images of frame {frame}, but no pose for it; plan it again"));
        let pose = poses.get(&frame).ok_or_else(unknown)?;
        let k = calibration.intrinsics.map(|mut k| {
            let [height, width] = self.options.resize.unwrap_or([window.height, window.width]);
            let (x, y) = (width as f64 / window.width as f64, height as f64 / window.height as f64);
            (k.cx, k.cy) = ((k.cx - window.left as f64) * x, (k.cy - window.top as f64) * y);
            (k.fx, k.fy, k.skew) = (k.fx * x, k.fy * y, k.skew * x);
            k.opencv_k()
        });
        Ok((k, Some(calibration.world_from_camera(pose))))
    }

    fn camera_calibration(&self, index: usize) -> Result<&(Projection, OpencvCalibration), DatasetError> {
        let FrameName { scene, camera, .. } = self.place(index);
        get_or_try(&self.cameras[self.frames[index].camera].calibration, || {
            let projection = self.dataset.read_camera(scene, camera)?.projection;
            let calibration = OpencvCalibration::of(&projection);
            Ok((projection, calibration))
        })
    }
}

pub(crate) fn mask_of(layers: &[(Layer, Image)], pixels: usize) -> Vec<u8> {
    let mut mask = vec![1; pixels];
    layers.iter().for_each(|(layer, image)| mask_out(&mut mask, *layer, image));
    mask
}

/// Scales flow, which is in pixels, as its image was scaled along x and y.
fn scale_flow(flow: &mut Image, scale: [f32; 2]) {
    if let Values::F32(values) = &mut flow.values {
        values.chunks_exact_mut(2).for_each(|pixel| pixel.iter_mut().zip(scale).for_each(|(value, scale)| *value *= scale));
    }
}

/// The cell's value, made on the first call. An error leaves the cell empty.
fn get_or_try<T, E>(cell: &OnceLock<T>, make: impl FnOnce() -> Result<T, E>) -> Result<&T, E> {
    if let Some(value) = cell.get() {
        return Ok(value);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}

/// The `names` that are `wanted`, or all.
fn chosen(what: &str, names: Vec<String>, wanted: Option<&[String]>) -> Result<Vec<String>, LoaderError> {
    let Some(wanted) = wanted else { return Ok(names) };
    if let Some(unknown) = wanted.iter().find(|name| !names.contains(name)) {
        return Err(LoaderError::Request(format!("there is no {what} {unknown:?}; the {what}s are: {}", names.join(", "))));
    }
    Ok(names.into_iter().filter(|name| wanted.contains(name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::hdf5::{Storage, write_array};
    use enfilade_dataset::{Array, Elements, FrameInfo, FrameTime};
    use enfilade_frame::{Frame, f16};
    use enfilade_math::DMat3;
    use enfilade_scene::{Camera, Intrinsics, TiltedPinhole, Trajectory};

    const K: Intrinsics = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 19.0, cy: 16.0, skew: 0.0 };

    fn tilted() -> Projection {
        Projection::TiltedPinhole(TiltedPinhole::new(40, 30, DMat3::from_rotation_x(0.15) * K.cam_from_uv()).unwrap())
    }

    /// A frame of planar depth 2 m, taken with a tilted image plane, without a partition.
    fn write_tilted(root: &std::path::Path) -> Dataset {
        write(root, tilted(), [40, 30], &[Layer::DepthZMeters])
    }

    /// A frame of this size in which the layers are 2 m everywhere.
    fn write(root: &std::path::Path, projection: Projection, [width, height]: [u32; 2], layers: &[Layer]) -> Dataset {
        let camera: Camera = projection.into();
        let pose = Pose { frame: 0, position: DVec3::ZERO, look_at: DVec3::NEG_Z, world_from_camera: DMat3::IDENTITY };
        let dataset = Dataset::create(root).unwrap();
        dataset.write_camera_parameters("room", &camera).unwrap();
        dataset.write_trajectory("room", &Trajectory { name: "cam_00".into(), poses: vec![pose] }, &camera, None).unwrap();
        let mut frame = Frame::new(width, height);
        layers.iter().for_each(|&layer| frame.insert(layer, Values::F32(vec![2.0; (width * height) as usize])));
        let info = FrameInfo { seed: 1, samples: 1, config_hash: "test".into(), pose, camera, sampling: None, recipe: None };
        dataset.write_frame("room", "cam_00", &frame, &info, FrameTime::default()).unwrap();
        dataset
    }

    #[test]
    fn planar_depth_of_a_tilted_camera_is_the_same_with_and_without_poses() {
        let folder = tempfile::tempdir().unwrap();
        let layout = write_tilted(folder.path()).layout().clone();
        let depth_z = |cameras, crop| {
            let options = Options { crop, cameras, ..Options::default() };
            let samples = Samples::open(Dataset::open(folder.path()).unwrap(), &Choice::default(), options).unwrap();
            samples.sample(0, 0).unwrap().layers.remove(0).1.values
        };
        let stored = Values::F32(vec![2.0; 40 * 30]);
        for crop in [None, Some(Crop { size: [20, 30], place: CropPlace::At([3, 7]) })] {
            assert_eq!(depth_z(false, crop), depth_z(true, crop));
        }
        assert_ne!(depth_z(false, None), stored);
        // Only images, whose camera is not known.
        std::fs::remove_dir_all(layout.detail_dir("room")).unwrap();
        std::fs::remove_file(layout.camera_parameters()).unwrap();
        assert_eq!(depth_z(false, None), stored);
    }

    #[test]
    fn images_of_another_size_than_their_camera_get_neither_k_nor_depth_by_its_rays() {
        let error = |root: &std::path::Path, layer: Layer, cameras: bool, crop: Option<Crop>| {
            let options = Options { crop, cameras, ..Options::default() };
            let choice = Choice { layers: Some(vec![layer]), ..Choice::default() };
            let samples = Samples::open(Dataset::open(root).unwrap(), &choice, options).unwrap();
            samples.sample(0, 0).err().map(|error| error.to_string())
        };
        let crops = [None, Some(Crop { size: [10, 10], place: CropPlace::At([0, 0]) })];
        for size in [[20, 15], [40, 30], [80, 60]] {
            let (straight, turned) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
            write(straight.path(), Projection::Pinhole(K), size, &[Layer::DepthMeters]);
            write(turned.path(), tilted(), size, &[Layer::DepthZMeters]);
            for crop in crops {
                assert_eq!(error(straight.path(), Layer::DepthMeters, false, crop), None, "distances have no need of a camera");
                let asked = [
                    error(straight.path(), Layer::DepthMeters, true, crop),
                    error(straight.path(), Layer::DepthZMeters, false, crop),
                    error(turned.path(), Layer::DepthZMeters, false, crop),
                ];
                for message in asked {
                    let expected = format!("room/cam_00 have {}x{} pixels, but its camera 40x30", size[0], size[1]);
                    assert_eq!(message.is_some_and(|message| message.contains(&expected)), size != [40, 30], "{size:?} {crop:?}");
                }
            }
        }
    }

    #[test]
    fn ids_of_another_size_than_color_are_refused_by_the_tone_map() {
        let error = |color: [usize; 2], ids: [usize; 2], crop: Option<Crop>| {
            let folder = tempfile::tempdir().unwrap();
            let dataset = write(folder.path(), Projection::Pinhole(K), [40, 30], &[Layer::DepthMeters]);
            let put = |layer: Layer, shape: &[usize], values: Elements| {
                let path = dataset.layout().layer("room", "cam_00", 0, layer);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                write_array(&path, &Array::new(shape, values), Storage::Contiguous, &[]).unwrap();
            };
            put(Layer::Color, &[color[0], color[1], 3], Elements::F16(vec![f16::ONE; 3 * color[0] * color[1]]));
            put(Layer::RenderEntityId, &ids, Elements::I16(vec![1; ids[0] * ids[1]]));
            let options = Options { tone_map: true, cameras: false, crop, ..Options::default() };
            let choice = Choice { layers: Some(vec![Layer::Color]), ..Choice::default() };
            let samples = Samples::open(Dataset::open(folder.path()).unwrap(), &choice, options).unwrap();
            samples.sample(0, 0).err().map(|error| error.to_string())
        };
        for crop in [None, Some(Crop { size: [10, 10], place: CropPlace::At([0, 0]) })] {
            assert_eq!(error([30, 40], [30, 40], crop), None);
            for (color, ids) in [([60, 80], [30, 40]), ([30, 40], [60, 80])] {
                let message = error(color, ids, crop).unwrap();
                let sizes = format!("{}x{} pixels, but color has {}x{}", ids[0], ids[1], color[0], color[1]);
                assert!(message.contains(&format!("frame.0000.render_entity_id.hdf5: {sizes}")), "{message}");
            }
        }
    }

    #[test]
    fn a_split_that_is_not_there_is_told_with_where_hypersims_is() {
        let folder = tempfile::tempdir().unwrap();
        let choice = Choice { side: Some(Side::Train), ..Choice::default() };
        let error = Samples::open(write_tilted(folder.path()), &choice, Options::default()).err().unwrap();
        assert!(matches!(&error, LoaderError::NoPartition { path } if path.ends_with("metadata_images_split_scene_v1.csv")), "{error}");
        assert!(error.to_string().contains("evermotion_dataset/analysis"), "{error}");
    }

    #[test]
    fn flow_is_in_pixels_of_the_resized_image() {
        let mut flow = Image { height: 1, width: 2, channels: 2, values: Values::F32(vec![10.0, 4.0, f32::NAN, -2.0]) };
        scale_flow(&mut flow, [0.5, 0.25]);
        let Values::F32(values) = flow.values else { panic!("flow is float32") };
        assert_eq!((values[0], values[1], values[2].is_nan(), values[3]), (5.0, 1.0, true, -0.5));
    }
}
