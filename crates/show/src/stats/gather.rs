//! From the frames of a dataset to statistics of images, scenes and the whole: with one frame in memory per thread, for any number of
//! frames.

use super::measure::{Counts, Image, WANTED, measure};
use enfilade_dataset::{BoxKind, Dataset, DatasetError};
use enfilade_frame::Layer;
use enfilade_scene::{Counted, Cx, Labels, PartLabel, Projection};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, PoisonError};

/// An image by its names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedImage {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// Mean samples per pixel, where they are recorded.
    pub samples_per_pixel: Option<f64>,
    /// The statistics.
    #[serde(flatten)]
    pub image: Image,
}

/// Everything that was counted.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// Scene by scene, camera by camera, frame by frame.
    pub images: Vec<NamedImage>,
    /// By scene.
    pub scenes: BTreeMap<String, Counts>,
    /// All scenes.
    pub all: Counts,
}

/// Counts the frames of `scenes`, each by the layers that it has; frames without any are left out.
///
/// # Errors
/// When a file that is there cannot be read.
pub fn gather(dataset: &Dataset, scenes: &[String], cx: &dyn Cx) -> Result<Gathered, DatasetError> {
    let mut filmed = Vec::new();
    for scene in scenes {
        for camera in dataset.cameras(scene)? {
            let frames = dataset.whole_frames([scene, &camera], None, cx)?;
            // Hypersim's table of cameras comes apart from its archives.
            let projection = dataset.read_camera(scene, &camera).ok().map(|camera| camera.projection);
            filmed.push(Filmed { scene, camera, frames, projection });
        }
    }
    let counted = Counted::new(cx, "frames", filmed.iter().map(|filmed| filmed.frames.len()).sum());
    let mut gathered = Gathered::default();
    for scene in scenes {
        // Counts are whole numbers, so the order in which threads add theirs changes nothing.
        let shared = Mutex::new((Counts::default(), BTreeSet::new()));
        let one = |&(filmed, frame): &(&Filmed<'_>, u32)| counted.unit(|| measure_frame(dataset, filmed, frame, &shared));
        let cameras = filmed.iter().filter(|filmed| filmed.scene == scene);
        let frames: Vec<(&Filmed<'_>, u32)> = cameras.flat_map(|filmed| filmed.frames.iter().map(move |&frame| (filmed, frame))).collect();
        let images: Vec<Option<NamedImage>> = enfilade_parallel::try_map(&frames, one)?;
        gathered.images.extend(images.into_iter().flatten());
        let (mut counts, shown) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        count_objects(dataset, scene, &shown, &mut counts);
        gathered.all.merge(&counts);
        gathered.scenes.insert(scene.clone(), counts);
    }
    Ok(gathered)
}

/// A camera whose frames are counted.
struct Filmed<'a> {
    scene: &'a str,
    camera: String,
    frames: Vec<u32>,
    /// `None` where the camera is not known.
    projection: Option<Projection>,
}

fn measure_frame(
    dataset: &Dataset,
    filmed: &Filmed<'_>,
    frame: u32,
    shared: &Mutex<(Counts, BTreeSet<i16>)>,
) -> Result<Option<NamedImage>, DatasetError> {
    let Filmed { scene, camera, projection, .. } = filmed;
    let there: Vec<Layer> = WANTED.into_iter().filter(|&layer| dataset.has_layer(scene, camera, frame, layer)).collect();
    if there.is_empty() {
        return Ok(None);
    }
    let (mut image, counts, instances) = measure(&dataset.read_frame(scene, camera, frame, &there)?, projection.as_ref());
    let sampling = dataset.frame_record(scene, camera, frame)?.and_then(|record| record.sampling);
    image.noise = sampling.and_then(|sampling| sampling.noise).or(image.noise);
    let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
    shared.0.merge(&counts);
    shared.1.extend(instances);
    let samples_per_pixel = sampling.map(|sampling| sampling.samples_taken);
    Ok(Some(NamedImage { scene: (*scene).into(), camera: camera.clone(), frame, samples_per_pixel, image }))
}

/// Counts the instances that a scene's images show, where it has the tables for that (Hypersim's archives have not).
fn count_objects(dataset: &Dataset, scene: &str, shown: &BTreeSet<i16>, counts: &mut Counts) {
    let labels = dataset.read_label_tables(scene).unwrap_or_default();
    let classes = classes_of(&labels);
    let boxes = dataset.read_boxes(scene, BoxKind::ObjectAligned2d).unwrap_or_default();
    for instance in shown {
        let found = usize::try_from(*instance).ok().and_then(|i| boxes.get(i)).copied().flatten();
        let class = classes.get(instance).copied().flatten().unwrap_or(-1);
        counts.add_object(class, found.map(|b| b.extents.element_product()));
    }
}

/// The class of each instance of which any part has one; `None` where its parts disagree.
fn classes_of(labels: &Labels) -> BTreeMap<i16, Option<i16>> {
    let mut classes: BTreeMap<i16, Option<i16>> = BTreeMap::new();
    for label in labels.parts.iter().filter(|label| label.instance > 0 && label.semantic != PartLabel::NONE.semantic) {
        let class = classes.entry(label.instance).or_insert(Some(label.semantic));
        if *class != Some(label.semantic) {
            *class = None;
        }
    }
    classes
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Heard, Quiet};
    use enfilade_testroom as testroom;

    #[test]
    fn the_whole_is_the_sum_of_its_images_on_any_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| gather(&dataset, &["room".into()], &Quiet).unwrap())
        };
        let (one, four) = (on(1), on(4));
        assert_eq!((&one.images, &one.all), (&four.images, &four.all));
        assert_eq!((one.all.images, one.images.len()), (2, 2));
        let by_image: u64 = one.images.iter().flat_map(|image| image.image.pixels_per_class.values()).sum();
        assert_eq!(one.all.pixels_per_class.iter().sum::<u64>(), by_image);
        assert_eq!(one.all.valid, by_image);
        // The mirror (class 19) is the one object.
        assert_eq!((one.all.objects_per_class[20], one.all.objects_per_class.iter().sum::<u64>()), (1, 1));
        assert_eq!(one.all.objects_per_image[1], 2);
    }

    #[test]
    fn a_frame_of_which_a_file_is_cut_short_is_left_out_with_a_warning() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        std::fs::write(dataset.layout().layer("room", "cam_00", 0, Layer::DepthMeters), [0u8; 100]).unwrap();
        let heard = Heard::default();
        assert_eq!(gather(&dataset, &["room".into()], &heard).unwrap().images.len(), 1);
        let warnings = heard.lines();
        assert!(warnings.len() == 1 && warnings[0].starts_with("room/cam_00: frame 0 is left out: "), "{warnings:?}");
        assert!(warnings[0].contains("frame.0000.depth_meters.hdf5: it has 100 bytes"), "{warnings:?}");
    }

    #[test]
    fn an_instance_of_two_classes_has_none_and_parts_without_one_do_not_count() {
        let label = |semantic, instance| PartLabel { semantic, instance };
        let labels = Labels { parts: vec![label(5, 1), label(5, 1), label(5, 2), label(7, 2), label(1, -1)] };
        assert_eq!(classes_of(&labels), BTreeMap::from([(1, Some(5)), (2, None)]));
        let labels = Labels { parts: vec![label(-1, 1), label(5, 1), label(7, 2), label(-1, 2), label(-1, 3)] };
        assert_eq!(classes_of(&labels), BTreeMap::from([(1, Some(5)), (2, Some(7))]));
    }
}
