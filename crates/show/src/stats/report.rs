//! `statistics.json`: the statistics of the dataset, each scene and each image, and the outliers among the images.

use super::costs::{Cost, CostReport};
use super::gather::{Gathered, NamedImage};
use super::histogram::{Histogram, Scale};
use super::measure::{Counts, LIGHTS};
use super::outlier::{LIMIT, Outlier, scores};
use enfilade_label::class_name;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name of the file's format.
const FORMAT: &str = "enfilade statistics 1";
/// Stored bins in a bin of the file's histograms.
const COARSE: usize = 10;

/// The file.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    format: &'static str,
    /// All images together.
    pub dataset: Summary,
    /// By scene.
    pub scenes: BTreeMap<String, Summary>,
    /// Images that are outliers by their contents, the farthest first.
    pub outliers: Vec<Outlier>,
    /// Images by name.
    pub images: Vec<NamedImage>,
}

/// True for the text of such a file.
pub fn is_report(text: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Head {
        format: String,
    }
    serde_json::from_slice(text).is_ok_and(|head: Head| head.format == FORMAT)
}

/// Any number of images together.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Images.
    pub images: u64,
    /// Pixels.
    pub pixels: u64,
    /// Share of pixels that show the scene.
    pub valid: f64,
    /// Share of those that have a class; `None` without labels.
    pub labelled: Option<f64>,
    /// Brightness by name of the layer.
    pub brightness: BTreeMap<&'static str, Quantity>,
    /// Distance in metres.
    pub depth_m: Option<Quantity>,
    /// Volumes of objects in cubic metres.
    pub volume_m3: Option<Quantity>,
    /// Mean number of classes per image.
    pub classes_per_image: Option<f64>,
    /// Mean number of objects per image.
    pub objects_per_image: Option<f64>,
    /// Pixels by class.
    pub pixels_per_class: BTreeMap<&'static str, u64>,
    /// Objects that any image shows, by class.
    pub objects_per_class: BTreeMap<&'static str, u64>,
}

/// Distribution of values, to within a bin (0.9 % of brightness, 1.2 % of depth), and how often they occur.
#[derive(Clone, Debug, Serialize)]
pub struct Quantity {
    /// Quantile 0.05.
    pub q05: f64,
    /// Median.
    pub median: f64,
    /// Quantile 0.95.
    pub q95: f64,
    low: f64,
    high: f64,
    scale: Scale,
    counts: Vec<u64>,
    below: u64,
    above: u64,
}

impl Quantity {
    fn of(histogram: &Histogram) -> Option<Self> {
        let [q05, median, q95] = [0.05, 0.5, 0.95].map(|q| histogram.quantile(q));
        let coarse = histogram.coarser(COARSE);
        Some(Self {
            q05: q05?,
            median: median?,
            q95: q95?,
            low: coarse.bins.low,
            high: coarse.bins.high,
            scale: coarse.bins.scale,
            counts: coarse.counts,
            below: coarse.below,
            above: coarse.above,
        })
    }
}

impl Summary {
    /// Summary of counts.
    pub fn of(counts: &Counts) -> Self {
        let classes = |counts: &[u64]| -> BTreeMap<&'static str, u64> {
            let there = counts.iter().enumerate().filter(|(_, count)| **count > 0);
            there.map(|(i, count)| (class_name(i as i16 - 1), *count)).collect()
        };
        let mean = |counts: &[u64]| {
            let images: u64 = counts.iter().sum();
            let things: u64 = counts.iter().enumerate().map(|(n, count)| n as u64 * count).sum();
            (images > 0).then(|| things as f64 / images as f64)
        };
        let with_class: u64 = counts.pixels_per_class.iter().sum();
        let brightness = LIGHTS.iter().zip(&counts.lights);
        Self {
            images: counts.images,
            pixels: counts.pixels,
            valid: counts.valid as f64 / counts.pixels.max(1) as f64,
            labelled: (with_class > 0).then(|| 1.0 - counts.pixels_per_class[0] as f64 / with_class as f64),
            brightness: brightness.filter_map(|(light, counts)| Some((light.layer.spec().name, Quantity::of(&counts.log)?))).collect(),
            depth_m: Quantity::of(&counts.depth_log),
            volume_m3: Quantity::of(&counts.volumes_log),
            classes_per_image: mean(&counts.classes_per_image),
            objects_per_image: mean(&counts.objects_per_image),
            pixels_per_class: classes(&counts.pixels_per_class),
            objects_per_class: classes(&counts.objects_per_class),
        }
    }
}

impl Report {
    /// Report on everything that was counted.
    pub fn new(gathered: Gathered) -> Self {
        Self {
            format: FORMAT,
            dataset: Summary::of(&gathered.all),
            scenes: gathered.scenes.iter().map(|(scene, counts)| (scene.clone(), Summary::of(counts))).collect(),
            outliers: outliers(&gathered.images),
            images: gathered.images,
        }
    }
}

/// How values of a quantity are compared, with the standard deviation below which differences are trifles.
#[derive(Clone, Copy)]
enum By {
    /// Ratios of the values: 5 % are a trifle.
    Ratio,
    /// Differences of the values.
    Difference(f64),
}

impl By {
    fn scores(self, values: &[f64]) -> Vec<Option<f64>> {
        match self {
            Self::Ratio => scores(&values.iter().map(|v| v.max(1e-12).ln()).collect::<Vec<_>>(), 0.05),
            Self::Difference(least) => scores(values, least),
        }
    }
}

/// A quantity by which images are compared.
type Compared = (&'static str, By, fn(&NamedImage) -> Option<f64>);

const COMPARED: [Compared; 8] = [
    ("brightness", By::Ratio, |i| i.image.brightness.get("color").map(|s| s.median)),
    ("saturation", By::Difference(0.02), |i| i.image.saturation),
    ("depth (m)", By::Ratio, |i| i.image.depth_m.map(|s| s.median)),
    ("noise", By::Ratio, |i| i.image.noise),
    ("share that shows the scene", By::Difference(0.02), |i| Some(i.image.valid)),
    ("labelled share", By::Difference(0.02), |i| i.image.labelled),
    ("classes", By::Difference(1.0), |i| i.image.classes.map(|n| n as f64)),
    ("objects", By::Difference(2.0), |i| i.image.objects.map(|n| n as f64)),
];

/// Images that are outliers by their contents.
fn outliers(images: &[NamedImage]) -> Vec<Outlier> {
    let mut found = Vec::new();
    for (quantity, by, of) in COMPARED {
        let values: Vec<f64> = images.iter().map(|image| of(image).unwrap_or(f64::NAN)).collect();
        let names = images.iter().map(|image| (image.scene.as_str(), image.camera.as_str(), image.frame));
        found.extend(standing_apart(quantity, by, &values, names));
    }
    sorted(found)
}

/// A quantity by which the costs of frames are compared, by its ratios.
type ComparedCost = (&'static str, fn(&Cost) -> Option<f64>);

const COMPARED_COSTS: [ComparedCost; 3] = [
    ("processor time (s)", |cost| Some(cost.cpu_s)),
    ("samples per pixel", |cost| cost.samples_per_pixel),
    ("utilization", |cost| Some(cost.utilization())),
];

/// Frames that are outliers by their cost.
pub fn cost_outliers(report: &CostReport) -> Vec<Outlier> {
    let mut found = Vec::new();
    for (quantity, of) in COMPARED_COSTS {
        let values: Vec<f64> = report.frames.iter().map(|frame| of(&frame.cost).unwrap_or(f64::NAN)).collect();
        let names = report.frames.iter().map(|frame| (frame.scene.as_str(), frame.camera.as_str(), frame.frame));
        found.extend(standing_apart(quantity, By::Ratio, &values, names));
    }
    sorted(found)
}

fn standing_apart<'a>(
    quantity: &'static str,
    by: By,
    values: &[f64],
    names: impl Iterator<Item = (&'a str, &'a str, u32)>,
) -> Vec<Outlier> {
    let mut there: Vec<f64> = values.iter().copied().filter(|v| !v.is_nan()).collect();
    let Some(median) = enfilade_math::quantile(&mut there, 0.5) else { return Vec::new() };
    let names_and_scores = names.zip(values).zip(by.scores(values));
    let far = names_and_scores.filter_map(|(named, score)| Some((named, score.filter(|score| score.abs() > LIMIT)?)));
    far.map(|(((scene, camera, frame), &value), score)| Outlier {
        scene: scene.into(),
        camera: camera.into(),
        frame,
        quantity,
        value,
        median,
        score,
    })
    .collect()
}

/// The farthest first.
fn sorted(mut outliers: Vec<Outlier>) -> Vec<Outlier> {
    outliers.sort_by(|a, b| {
        let names = |o: &Outlier| (o.scene.clone(), o.camera.clone(), o.frame, o.quantity);
        b.score.abs().total_cmp(&a.score.abs()).then_with(|| names(a).cmp(&names(b)))
    });
    outliers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::measure::{Image, Spread};

    fn image(frame: u32, brightness: f64) -> NamedImage {
        let spread = Spread { mean: brightness, q05: brightness, median: brightness, q95: brightness };
        let image = Image { valid: 1.0, brightness: BTreeMap::from([("color", spread)]), ..Image::default() };
        NamedImage { scene: "room".into(), camera: "cam_00".into(), frame, samples_per_pixel: None, image }
    }

    #[test]
    fn a_dark_frame_among_bright_ones_is_told() {
        let images: Vec<NamedImage> = (0..10).map(|i| image(i, if i == 4 { 1e-3 } else { 0.5 + 0.01 * f64::from(i) })).collect();
        let found = outliers(&images);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].frame, found[0].quantity, found[0].value), (4, "brightness", 1e-3));
        assert!(found[0].score < -LIMIT);
    }
}
