//! The pixels of each instance in the frames of a camera.

use crate::colors::{NAMES, color_name};
use enfilade_dataset::{Dataset, DatasetError, counted};
use enfilade_frame::{Layer, Values};
use enfilade_scene::{Counted, Cx, Warning};
use std::collections::BTreeMap;

/// Reflectance below this is none: what mirrors, metals and glass have.
const NO_DIFFUSE: f32 = 0.002;
/// A colour prevails when this share of all pixels has it.
const PREVAILS: f64 = 0.5;

/// The visible part of an instance in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// Number of pixels.
    pub pixels: u64,
    /// First and last column of them.
    pub columns: [u32; 2],
    /// Distances from the camera centre, metres: of the nearest pixel, and of the median one.
    pub nearest_m: f32,
    pub median_m: f32,
    /// Number of pixels of each of the colours of [`NAMES`].
    colors: [u64; NAMES.len()],
}

/// The visible instances of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenFrame {
    /// Number of the frame.
    pub frame: u32,
    /// Pixels of the image.
    pub pixels: u64,
    /// By instance.
    pub sights: BTreeMap<i16, Sight>,
}

impl SeenFrame {
    /// Whether a sight covers at least this share of the image.
    pub fn covers(&self, sight: &Sight, share: f64) -> bool {
        sight.pixels as f64 >= share * self.pixels as f64
    }
}

/// Looks at these frames of a camera. Frames without instances or distances are left out, which `cx` hears of; without reflectance things have
/// no colour.
///
/// # Errors
/// When a layer cannot be read.
pub fn look(dataset: &Dataset, [scene, camera]: [&str; 2], frames: &[u32], cx: &dyn Cx) -> Result<Vec<SeenFrame>, DatasetError> {
    let has = |number: u32, layer: Layer| dataset.gives_layer(scene, camera, number, layer);
    let (whole, others): (Vec<u32>, Vec<u32>) =
        frames.iter().partition(|&&number| has(number, Layer::SemanticInstance) && has(number, Layer::DepthMeters));
    if let Some(first) = others.first() {
        let message =
            format!("{} without semantic_instance or depth_meters left out, the first of them {first}", counted(others.len(), "frame"));
        cx.warn(Warning { place: format!("{scene}/{camera}"), message });
    }
    let frames = Counted::new(cx, "frames", whole.len());
    let one = |&number: &u32| frames.unit(|| look_at(dataset, [scene, camera], number, has(number, Layer::DiffuseReflectance)));
    enfilade_parallel::try_map(&whole, one)
}

fn look_at(dataset: &Dataset, [scene, camera]: [&str; 2], number: u32, colored: bool) -> Result<SeenFrame, DatasetError> {
    let layers = [Layer::SemanticInstance, Layer::DepthMeters, Layer::DiffuseReflectance];
    let frame = dataset.read_frame(scene, camera, number, &layers[..if colored { 3 } else { 2 }])?;
    let [instances, distances, reflectance] = layers.map(|layer| frame.get(layer));
    let (Some(Values::I16(instances)), Some(distances)) = (instances, distances) else { unreachable!("instances are read as int16") };
    let mut sights: BTreeMap<i16, (Sight, Vec<f32>)> = BTreeMap::new();
    for (pixel, &instance) in instances.iter().enumerate().filter(|(_, instance)| **instance >= 1) {
        let column = pixel as u32 % frame.width;
        let distance = distances.get(pixel) as f32;
        let new = || (Sight::at(column), Vec::new());
        let (sight, of_pixels) = sights.entry(instance).or_insert_with(new);
        let color = reflectance.map_or([0.0; 3], |layer| [0, 1, 2].map(|channel| layer.get(3 * pixel + channel) as f32));
        sight.add(column, color);
        of_pixels.push(distance);
    }
    let sights = sights.into_iter().map(|(instance, (mut sight, mut distances))| {
        distances.retain(|distance| distance.is_finite());
        let middle = distances.len() / 2;
        if let Some(nearest) = distances.iter().copied().reduce(f32::min) {
            sight.nearest_m = nearest;
            sight.median_m = *distances.select_nth_unstable_by(middle, f32::total_cmp).1;
        }
        (instance, sight)
    });
    Ok(SeenFrame { frame: number, pixels: instances.len() as u64, sights: sights.collect() })
}

impl Sight {
    fn at(column: u32) -> Self {
        let colors = [0; NAMES.len()];
        Self { pixels: 0, columns: [column; 2], nearest_m: f32::NAN, median_m: f32::NAN, colors }
    }

    fn add(&mut self, column: u32, reflectance: [f32; 3]) {
        self.pixels += 1;
        self.columns = [self.columns[0].min(column), self.columns[1].max(column)];
        if reflectance.iter().any(|&v| v > NO_DIFFUSE) {
            let name = color_name(reflectance);
            self.colors[NAMES.iter().position(|known| *known == name).unwrap_or_default()] += 1;
        }
    }

    /// The share of its pixels that have the colour of this name.
    pub fn color_share(&self, name: &str) -> f64 {
        let index = NAMES.iter().position(|known| *known == name);
        index.map_or(0.0, |index| self.colors[index] as f64 / self.pixels.max(1) as f64)
    }
}

/// The colour that prevails on an instance in all of these sights, if any does.
pub fn color<'s>(sights: impl Iterator<Item = &'s Sight>) -> Option<&'static str> {
    let (mut pixels, mut colors) = (0, [0; NAMES.len()]);
    for sight in sights {
        pixels += sight.pixels;
        colors.iter_mut().zip(sight.colors).for_each(|(sum, more)| *sum += more);
    }
    let prevails = |&count: &u64| count as f64 > PREVAILS * pixels as f64;
    colors.iter().position(prevails).map(|index| NAMES[index])
}
