//! Counts of an image. Bins, weights and rules are the same as in Hypersim's statistics, so that both can be compared.

use super::histogram::{Bins, Histogram, add_counts};
use enfilade_frame::tonemap::brightness;
use enfilade_frame::vector;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_math::quantile;
use enfilade_scene::Projection;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Side of the maps of hue and saturation, and of normals.
pub const SIDE: usize = 100;
/// Classes from −1 (unlabelled) to 40; 0 is never used.
pub const CLASSES: usize = 42;
/// Largest number of objects per image that are distinguished.
pub const MOST_OBJECTS: usize = 10_000;

/// Brightness, in four decades of 250 bins: 0.3 R + 0.59 G + 0.11 B.
const BRIGHTNESS_LOG: Bins = Bins::log(1e-3, 1e1, 1000);
const BRIGHTNESS: Bins = Bins::linear(0.0, 10.0, 1000);
const DEPTH_M_LOG: Bins = Bins::log(1e-2, 1e3, 1000);
const DEPTH_M: Bins = Bins::linear(0.0, 20.0, 1000);
const VOLUME_M3_LOG: Bins = Bins::log(1e-6, 1e3, 1000);
const VOLUME_M3: Bins = Bins::linear(0.0, 1000.0, 1000);

/// A layer of light or reflectance that is counted, with Hypersim's name for its histograms and ours for people.
pub struct Light {
    /// Which layer.
    pub layer: Layer,
    /// Stem of the file's name, as in `metadata_<stem>_brightness_hist_log.hdf5`.
    pub stem: &'static str,
    /// For people.
    pub title: &'static str,
}

/// The layers of light and reflectance.
pub const LIGHTS: [Light; 4] = [
    Light { layer: Layer::Color, stem: "rgb_color", title: "Colour" },
    Light { layer: Layer::DiffuseReflectance, stem: "diffuse_reflectance", title: "Diffuse reflectance" },
    Light { layer: Layer::DiffuseIllumination, stem: "diffuse_illumination", title: "Diffuse illumination" },
    Light { layer: Layer::Residual, stem: "residual", title: "Residual" },
];

/// Layers that statistics read, where a frame has them.
pub const WANTED: [Layer; 10] = [
    Layer::Color,
    Layer::DiffuseReflectance,
    Layer::DiffuseIllumination,
    Layer::Residual,
    Layer::DepthMeters,
    Layer::NormalCam,
    Layer::RenderEntityId,
    Layer::Semantic,
    Layer::SemanticInstance,
    Layer::ColorStandardError,
];

/// A square of counts, row by row: x from −1 to 1 to the right, y from −1 to 1 with the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// [`SIDE`] × [`SIDE`].
    pub counts: Vec<u64>,
}

impl Default for Map {
    fn default() -> Self {
        Self { counts: vec![0; SIDE * SIDE] }
    }
}

impl Map {
    fn add(&mut self, x: f64, y: f64) {
        let place = |v: f64| ((0.5 * (v + 1.0) * SIDE as f64) as usize).min(SIDE - 1);
        if x.is_finite() && y.is_finite() {
            self.counts[place(y) * SIDE + place(x)] += 1;
        }
    }
}

/// Counts of one layer of [`LIGHTS`].
#[derive(Clone, Debug, PartialEq)]
pub struct LightCounts {
    /// Brightness from 0 to 10.
    pub linear: Histogram,
    /// Brightness from 0.001 to 10.
    pub log: Histogram,
    /// At (saturation cos hue, saturation sin hue).
    pub hue_saturation: Map,
}

/// Counts of any number of images, which add up in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts {
    /// Images.
    pub images: u64,
    /// Pixels of all images.
    pub pixels: u64,
    /// Pixels that show the scene.
    pub valid: u64,
    /// By layer of [`LIGHTS`].
    pub lights: [LightCounts; 4],
    /// Distance in metres from 0 to 20.
    pub depth: Histogram,
    /// Distance in metres from 0.01 to 1000.
    pub depth_log: Histogram,
    /// Normals in camera axes, at (x, y), of unit length, turned towards the camera where its rays are known.
    pub normals: Map,
    /// Pixels by class, −1 first.
    pub pixels_per_class: Vec<u64>,
    /// Images by their number of classes.
    pub classes_per_image: Vec<u64>,
    /// Images by their number of objects.
    pub objects_per_image: Vec<u64>,
    /// Objects that any image shows, by class, −1 first.
    pub objects_per_class: Vec<u64>,
    /// Volumes of their boxes in cubic metres from 0 to 1000.
    pub volumes: Histogram,
    /// Volumes of their boxes in cubic metres from 10⁻⁶ to 1000.
    pub volumes_log: Histogram,
}

impl Default for Counts {
    fn default() -> Self {
        let light =
            || LightCounts { linear: Histogram::new(BRIGHTNESS), log: Histogram::new(BRIGHTNESS_LOG), hue_saturation: Map::default() };
        Self {
            images: 0,
            pixels: 0,
            valid: 0,
            lights: std::array::from_fn(|_| light()),
            depth: Histogram::new(DEPTH_M),
            depth_log: Histogram::new(DEPTH_M_LOG),
            normals: Map::default(),
            pixels_per_class: vec![0; CLASSES],
            classes_per_image: vec![0; CLASSES - 1],
            objects_per_image: vec![0; MOST_OBJECTS],
            objects_per_class: vec![0; CLASSES],
            volumes: Histogram::new(VOLUME_M3),
            volumes_log: Histogram::new(VOLUME_M3_LOG),
        }
    }
}

impl Counts {
    /// Adds the counts of other images.
    pub fn merge(&mut self, other: &Self) {
        self.images += other.images;
        self.pixels += other.pixels;
        self.valid += other.valid;
        for (to, from) in self.lights.iter_mut().zip(&other.lights) {
            to.linear.merge(&from.linear);
            to.log.merge(&from.log);
            add_counts(&mut to.hue_saturation.counts, &from.hue_saturation.counts);
        }
        self.depth.merge(&other.depth);
        self.depth_log.merge(&other.depth_log);
        add_counts(&mut self.normals.counts, &other.normals.counts);
        add_counts(&mut self.pixels_per_class, &other.pixels_per_class);
        add_counts(&mut self.classes_per_image, &other.classes_per_image);
        add_counts(&mut self.objects_per_image, &other.objects_per_image);
        add_counts(&mut self.objects_per_class, &other.objects_per_class);
        self.volumes.merge(&other.volumes);
        self.volumes_log.merge(&other.volumes_log);
    }

    /// Counts an object that some image shows: its class, and the volume of its box in cubic metres where it has one.
    pub fn add_object(&mut self, class: i16, volume_m3: Option<f64>) {
        if let Some(count) = self.objects_per_class.get_mut(class_bin(class)) {
            *count += 1;
        }
        if let Some(volume) = volume_m3 {
            self.volumes.add(volume);
            self.volumes_log.add(volume);
        }
    }
}

/// The bin of a class.
pub fn class_bin(class: i16) -> usize {
    usize::try_from(class + 1).unwrap_or(0)
}

/// Distribution of the values of an image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Mean of the values.
    pub mean: f64,
    /// Quantile 0.05.
    pub q05: f64,
    /// Median.
    pub median: f64,
    /// Quantile 0.95.
    pub q95: f64,
}

impl Spread {
    /// Spread of values without NaN, which are reordered; `None` when there are none.
    pub fn of(values: &mut [f64]) -> Option<Self> {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let [q05, median, q95] = [0.05, 0.5, 0.95].map(|q| quantile(values, q));
        Some(Self { mean, q05: q05?, median: median?, q95: q95? })
    }
}

/// Measures of one image; `None` where it lacks the layers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Share of pixels that show the scene.
    pub valid: f64,
    /// Share of those that have a class.
    pub labelled: Option<f64>,
    /// Brightness by name of the layer.
    pub brightness: BTreeMap<&'static str, Spread>,
    /// Mean saturation of colour, 0 grey to 1.
    pub saturation: Option<f64>,
    /// Distance in metres.
    pub depth_m: Option<Spread>,
    /// Noise: root mean square over the image of the standard error over (luminance + 0.2 of its mean).
    pub noise: Option<f64>,
    /// Classes that it shows.
    pub classes: Option<usize>,
    /// Objects that it shows.
    pub objects: Option<usize>,
    /// Brightness of colour from 0.001 to 10 in 20 bins of equal ratio, shares of the pixels that show the scene.
    pub brightness_histogram: Vec<f64>,
    /// Distance from 0.01 m to 1000 m in 20 bins of equal ratio, shares likewise.
    pub depth_histogram: Vec<f64>,
    /// Pixels by class that it shows, −1 unlabelled.
    pub pixels_per_class: BTreeMap<i16, u64>,
}

/// Bins of the dataset's histograms in a bin of an image's own.
const COARSE: usize = 50;

/// Statistics of one image, its counts, and the instances that it shows. `projection` is its camera's, if known.
pub fn measure(frame: &Frame, projection: Option<&Projection>) -> (Image, Counts, BTreeSet<i16>) {
    let valid = valid_pixels(frame);
    let mut counts = Counts { images: 1, pixels: frame.pixels() as u64, valid: valid.len() as u64, ..Counts::default() };
    let mut image = Image {
        size: [frame.width, frame.height],
        valid: valid.len() as f64 / (frame.pixels() as f64).max(1.0),
        noise: frame.noise(),
        ..Image::default()
    };
    for (light, counts) in LIGHTS.iter().zip(&mut counts.lights) {
        let Some(values) = frame.get(light.layer) else { continue };
        let (spread, saturation) = count_light(values, &valid, counts);
        image.brightness.extend(spread.map(|spread| (light.layer.spec().name, spread)));
        if light.layer == Layer::Color {
            image.saturation = saturation;
            image.brightness_histogram = counts.log.coarser(COARSE).shares().map(|[_, _, share]| share).collect();
        }
    }
    if let Some(depth) = frame.get(Layer::DepthMeters) {
        let mut depths: Vec<f64> = valid.iter().map(|&i| depth.get(i)).collect();
        depths.iter().for_each(|&d| [&mut counts.depth, &mut counts.depth_log].into_iter().for_each(|h| h.add(d)));
        image.depth_m = Spread::of(&mut depths);
        image.depth_histogram = counts.depth_log.coarser(COARSE).shares().map(|[_, _, share]| share).collect();
    }
    if let Some(normals) = frame.get(Layer::NormalCam) {
        let projection = projection.filter(|projection| projection.size() == [frame.width, frame.height]);
        for &i in &valid {
            let [x, y] = [i % frame.width as usize, i / frame.width as usize].map(|at| at as f64 + 0.5);
            let normal = facing(vector(normals, i), projection.and_then(|projection| projection.ray(x, y)));
            counts.normals.add(normal.x, normal.y);
        }
    }
    let instances = count_labels(frame, &valid, &mut image, &mut counts);
    (image, counts, instances)
}

/// The unit vector of a normal that is not zero, turned against the ray that meets it: artists' normals may be of any length and face away.
fn facing(normal: DVec3, ray: Option<DVec3>) -> DVec3 {
    let away = ray.is_some_and(|ray| normal.dot(ray) > 0.0);
    if away { -normal.normalize() } else { normal.normalize() }
}

/// Pixels that show the scene, whose values are finite, and whose normals are not zero.
fn valid_pixels(frame: &Frame) -> Vec<usize> {
    let ids = frame.get(Layer::RenderEntityId);
    let normals = frame.get(Layer::NormalCam);
    let floats: Vec<&Values> = WANTED[..6].iter().filter_map(|&layer| frame.get(layer)).collect();
    let is_valid = |&i: &usize| {
        let finite = |values: &&Values| {
            let channels = values.len() / frame.pixels();
            (channels * i..channels * (i + 1)).all(|k| values.get(k).is_finite())
        };
        let has_normal = |normals: &Values| vector(normals, i) != DVec3::ZERO;
        ids.is_none_or(|ids| ids.get(i) != -1.0) && floats.iter().all(finite) && normals.is_none_or(has_normal)
    };
    (0..frame.pixels()).filter(is_valid).collect()
}

fn count_light(values: &Values, valid: &[usize], counts: &mut LightCounts) -> (Option<Spread>, Option<f64>) {
    let mut all = Vec::with_capacity(valid.len());
    let mut saturations = 0.0;
    for &i in valid {
        let rgb = [0, 1, 2].map(|c| values.get(3 * i + c));
        let bright = brightness(rgb);
        counts.linear.add(bright);
        counts.log.add(bright);
        let (hue_rad, saturation) = hue_saturation(rgb);
        let (sin, cos) = hue_rad.sin_cos();
        counts.hue_saturation.add(saturation * cos, saturation * sin);
        saturations += saturation;
        all.push(bright);
    }
    (Spread::of(&mut all), (!valid.is_empty()).then(|| saturations / valid.len() as f64))
}

/// Hue in radians (0 red, 2π/3 green) and saturation from 0 to 1, independent of brightness.
fn hue_saturation([r, g, b]: [f64; 3]) -> (f64, f64) {
    let (high, low) = (r.max(g).max(b), r.min(g).min(b).max(0.0));
    let range = high - low;
    if high <= 0.0 || range <= 0.0 {
        return (0.0, 0.0);
    }
    let sixth = if high == r {
        (g - b) / range
    } else if high == g {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    (sixth.rem_euclid(6.0) * std::f64::consts::FRAC_PI_3, range / high)
}

fn count_labels(frame: &Frame, valid: &[usize], image: &mut Image, counts: &mut Counts) -> BTreeSet<i16> {
    if let Some(semantic) = frame.get(Layer::Semantic) {
        for &i in valid {
            let class = semantic.get(i) as i16;
            *image.pixels_per_class.entry(class).or_default() += 1;
            if let Some(count) = counts.pixels_per_class.get_mut(class_bin(class)) {
                *count += 1;
            }
        }
        let classes = image.pixels_per_class.keys().filter(|class| **class > 0).count();
        let unlabelled = image.pixels_per_class.get(&-1).copied().unwrap_or(0);
        image.labelled = (!valid.is_empty()).then(|| (valid.len() as u64 - unlabelled) as f64 / valid.len() as f64);
        image.classes = Some(classes);
        counts.classes_per_image[classes.min(CLASSES - 2)] += 1;
    }
    let Some(instance) = frame.get(Layer::SemanticInstance) else { return BTreeSet::new() };
    let instances: BTreeSet<i16> = valid.iter().map(|&i| instance.get(i) as i16).filter(|id| *id > 0).collect();
    image.objects = Some(instances.len());
    counts.objects_per_image[instances.len().min(MOST_OBJECTS - 1)] += 1;
    instances
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::f16;
    use enfilade_scene::Intrinsics;

    /// Four pixels: the last shows nothing.
    fn frame() -> Frame {
        let mut frame = Frame::new(2, 2);
        let half = |values: &[f64]| Values::F16(values.iter().map(|v| f16::from_f64(*v)).collect());
        // Away from the borders of bins, which rounding may cross.
        let grey = [[0.503_906_25; 3], [2.003_906_25; 3], [0.0625, 0.0, 0.0], [9.0; 3]].concat();
        frame.insert(Layer::Color, half(&grey));
        frame.insert(Layer::DepthMeters, Values::F32(vec![1.0, 2.0, 30.0, f32::NAN]));
        let normals = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [f64::NAN; 3]].concat();
        frame.insert(Layer::NormalCam, half(&normals));
        frame.insert(Layer::RenderEntityId, Values::I16(vec![1, 2, 2, -1]));
        frame.insert(Layer::Semantic, Values::I16(vec![2, 5, -1, -1]));
        frame.insert(Layer::SemanticInstance, Values::I16(vec![-1, 3, 3, -1]));
        frame
    }

    #[test]
    fn a_frame_of_known_pixels_has_the_counts_that_it_should() {
        let (image, counts, instances) = measure(&frame(), None);
        assert_eq!((counts.pixels, counts.valid, image.valid), (4, 3, 0.75));
        let light = &counts.lights[0];
        // 0.504, 2.004 and 0.3 × 0.0625, in bins of 0.01.
        assert_eq!([50, 200, 1].map(|bin| light.linear.counts[bin]), [1, 1, 1]);
        assert_eq!((light.log.total(), light.log.below + light.log.above), (3, 0));
        let bin_of = |brightness: f64| (250.0 * (brightness.log10() + 3.0)).floor() as usize;
        assert_eq!(light.log.counts[bin_of(0.0625 * 0.3)], 1);
        // Two greys in the middle, one pure red at the right.
        assert_eq!((light.hue_saturation.counts[50 * SIDE + 50], light.hue_saturation.counts[50 * SIDE + 99]), (2, 1));
        assert_eq!((counts.depth.counts[50], counts.depth.above, counts.depth_log.total()), (1, 1, 3));
        assert_eq!([99 * SIDE + 50, 50 * SIDE + 50, 50 * SIDE].map(|place| counts.normals.counts[place]), [1, 1, 1]);
        assert_eq!([0, 3, 6].map(|bin| counts.pixels_per_class[bin]), [1, 1, 1]);
        assert_eq!((image.classes, image.objects), (Some(2), Some(1)));
        assert!((image.labelled.unwrap() - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!((counts.classes_per_image[2], counts.objects_per_image[1], instances), (1, 1, BTreeSet::from([3])));
        let depth = image.depth_m.unwrap();
        assert_eq!((depth.mean, depth.median), (11.0, 2.0));
        assert!((image.brightness["color"].median - 0.503_906_25).abs() < 1e-9);
    }

    #[test]
    fn normals_are_of_unit_length_and_turned_towards_the_camera_and_pixels_without_one_do_not_count() {
        let mut frame = frame();
        let [away, half, zero] = [[0.61, 0.0, -0.79], [0.305, 0.0, 0.395], [0.0; 3]];
        let normals = [away, half, zero, [f64::NAN; 3]].concat();
        frame.insert(Layer::NormalCam, Values::F16(normals.into_iter().map(f16::from_f64).collect()));
        let projection = Projection::Pinhole(Intrinsics::from_fov_x(2, 2, 1.0));
        let (_, counts, instances) = measure(&frame, Some(&projection));
        assert_eq!([19, 80].map(|column| counts.normals.counts[50 * SIDE + column]), [1, 1]);
        assert_eq!((counts.valid, counts.depth.total(), instances), (2, 2, BTreeSet::from([3])));
        // Without a camera it is not known which surfaces face it.
        assert_eq!(measure(&frame, None).1.normals.counts[50 * SIDE + 80], 2);
    }

    #[test]
    fn layers_that_are_missing_are_left_out() {
        let mut frame = Frame::new(2, 1);
        frame.insert(Layer::DepthMeters, Values::F32(vec![1.0, 3.0]));
        let (image, counts, instances) = measure(&frame, None);
        assert_eq!((counts.valid, image.depth_m.unwrap().median), (2, 2.0));
        assert!(image.brightness.is_empty() && image.objects.is_none() && image.noise.is_none() && instances.is_empty());
    }

    #[test]
    fn hues_lie_at_their_angles_and_brightness_changes_nothing() {
        for (rgb, angle_deg) in [([1.0, 0.0, 0.0], 0.0), ([1.0, 1.0, 0.0], 60.0), ([0.0, 1.0, 0.0], 120.0), ([0.0, 0.0, 7.0], 240.0)] {
            let (hue, saturation) = hue_saturation(rgb);
            assert!((hue.to_degrees() - angle_deg).abs() < 1e-9 && saturation == 1.0, "{rgb:?}");
        }
        assert_eq!(hue_saturation([3.0, 1.5, 1.5]), hue_saturation([0.5, 0.25, 0.25]));
        assert_eq!(hue_saturation([0.0; 3]), (0.0, 0.0));
    }

    #[test]
    fn objects_are_counted_by_class_and_volume() {
        let mut counts = Counts::default();
        counts.add_object(5, Some(2.5));
        counts.add_object(-1, None);
        assert_eq!((counts.objects_per_class[6], counts.objects_per_class[0]), (1, 1));
        assert_eq!((counts.volumes.counts[2], counts.volumes_log.total()), (1, 1));
    }
}
