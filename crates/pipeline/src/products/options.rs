//! Options of products as people give them, on the command line and in Python: words and files become requests.

use super::make::{choose_pairs_of, make};
use super::relit::read_mixes;
use super::update::{Made, MakeOptions};
use crate::config::read_sensors;
use crate::error::Error;
use crate::request::{FlowPairs, FrameChoice, MOST_SURFACES, PairsRequest, Product, Request, SURFACES, checked};
use enfilade_dataset::{Dataset, FramePair, read_pairs, write_pairs};
use enfilade_multiview::TracksConfig;
use enfilade_scene::Cx;
use std::path::{Path, PathBuf};

/// Options of all products; each reads its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProductOptions {
    /// Pixels of each frame that are carried into the others to tell which frames see the same, about.
    pub pixels: Option<u32>,
    /// Shares that both frames of a pair see of each other, at least and at most.
    pub overlap: Option<[f32; 2]>,
    /// Distance between the cameras of a pair, at least and at most, metres.
    pub baseline_m: Option<[f64; 2]>,
    /// Angle between the viewing axes of a pair, at least and at most, degrees.
    pub angle_deg: Option<[f64; 2]>,
    /// The list that pairs are written to, and that flow follows; `None`: that of the dataset.
    pub list: Option<PathBuf>,
    /// Flow leads from each frame to the one so many later, instead of following a list.
    pub step: Option<i64>,
    /// Flow leads from one frame to another, both by camera and number.
    pub between: Option<[(String, u32); 2]>,
    /// Points of each camera's tracks.
    pub points: Option<u32>,
    /// Decides which points are tracked.
    pub seed: Option<u64>,
    /// Surfaces per pixel at most.
    pub layers: Option<u32>,
    /// The file of sensors.
    pub sensors: Option<PathBuf>,
    /// The table of mixes of lamps.
    pub mixes: Option<PathBuf>,
}

/// Makes `products` of scenes of a dataset by `options`, of the frames `of` where they are made by frame, each after those that it needs.
///
/// # Errors
/// When a product lacks a file that it needs, and as [`make`].
pub fn make_products(
    dataset: &Dataset,
    scenes: &[String],
    products: &[Product],
    (options, of): (&ProductOptions, &FrameChoice),
    how: MakeOptions,
    cx: &dyn Cx,
) -> Result<Vec<Made>, Error> {
    options.check()?;
    let mut ordered = products.to_vec();
    ordered.sort_unstable();
    ordered.dedup();
    let mut all = Vec::new();
    for product in ordered {
        if let (Product::Pairs, Some(list)) = (product, &options.list) {
            let (rows, lines) = choose_pairs_of(dataset, &options.pairs(dataset, scenes, of)?, cx)?;
            write_pairs(list, &rows)?;
            all.push(Made { product, scene: None, made: 1, kept: 0, lines });
            continue;
        }
        all.extend(make(dataset, scenes, &options.requests(product, dataset, scenes, of)?, how, cx)?);
    }
    Ok(all)
}

impl ProductOptions {
    /// Refuses numbers that are out of their range.
    fn check(&self) -> Result<(), Error> {
        let numbers = [("pixels", self.pixels, u32::MAX), ("points", self.points, u32::MAX), ("layers", self.layers, MOST_SURFACES)];
        for (name, number, most) in numbers {
            checked(name, number.unwrap_or(1), most)?;
        }
        let widened = |range: Option<[f32; 2]>| range.map(|ends| ends.map(f64::from));
        for (name, range) in [("overlap", widened(self.overlap)), ("baseline", self.baseline_m), ("angle", self.angle_deg)] {
            if range.is_some_and(|[least, most]| !(0.0 <= least && least <= most)) {
                let message = format!("{name} is {:?}, expected two numbers from 0, the smaller one first", range.unwrap_or_default());
                return Err(Error::usage(message, "leave it out for any"));
            }
        }
        Ok(())
    }

    /// What is asked of a product.
    fn requests(&self, product: Product, dataset: &Dataset, scenes: &[String], of: &FrameChoice) -> Result<Vec<Request>, Error> {
        let of = of.clone();
        Ok(match product {
            Product::Covisibility => vec![self.pairs(dataset, scenes, &of)?.covisibility()],
            Product::Pairs => vec![Request::Pairs(self.pairs(dataset, scenes, &of)?)],
            Product::Flow => vec![Request::Flow { pairs: self.flow(dataset, scenes)?, cameras: of.cameras }],
            Product::Tracks => {
                let usual = TracksConfig::default();
                vec![Request::Tracks { points: self.points.unwrap_or(usual.points), seed: self.seed.unwrap_or(usual.seed), of }]
            }
            Product::Surfaces => vec![Request::Surfaces { layers: self.layers.unwrap_or(SURFACES), of }],
            Product::Rooms => vec![Request::Rooms { of }],
            Product::Words => vec![Request::Words],
            Product::Sensors => {
                let file =
                    self.sensors.as_ref().ok_or_else(|| Error::usage("no sensors are named", "give --sensors examples/sensors.toml"))?;
                read_sensors(file)?.all().map(|sensor| Request::Sensor { sensor, of: of.clone() }).collect()
            }
            Product::Relit => {
                let file = self.mixes.as_ref().ok_or_else(|| Error::usage("no mixes are named", "give --mixes examples/mixes.csv"))?;
                read_mixes(file, dataset, scenes, &of)?
            }
            Product::Sheet | Product::Statistics => {
                let message = format!("{} is made by every run", product.name());
                return Err(Error::usage(message, "enfilade run OUT makes it; enfilade stats OUT the statistics"));
            }
        })
    }

    fn pairs(&self, dataset: &Dataset, scenes: &[String], of: &FrameChoice) -> Result<PairsRequest, Error> {
        let usual = PairsRequest::default();
        let are_all = dataset.scenes().map_err(Error::stage)? == scenes;
        Ok(PairsRequest {
            pixels: self.pixels.unwrap_or(usual.pixels),
            overlap: self.overlap,
            min_baseline_m: self.baseline_m.map_or(usual.min_baseline_m, |[least, _]| least),
            max_baseline_m: self.baseline_m.map(|[_, most]| most).filter(|most| most.is_finite()),
            // No angle is larger than 180 degrees, and infinity cannot be stored.
            angle_deg: self.angle_deg.map_or(usual.angle_deg, |[least, most]| [least, most.min(180.0)]),
            scenes: if are_all { None } else { Some(scenes.to_vec()) },
            cameras: of.cameras.clone(),
        })
    }

    fn flow(&self, dataset: &Dataset, scenes: &[String]) -> Result<FlowPairs, Error> {
        if let Some(step) = self.step {
            return Ok(FlowPairs::Step(step));
        }
        if let Some([first, second]) = &self.between {
            let [scene] = scenes else {
                return Err(Error::usage("the dataset has several scenes", format!("name one with --scene: {}", scenes.join(", "))));
            };
            return Ok(FlowPairs::Between(vec![FramePair { scene: scene.clone(), first: first.clone(), second: second.clone() }]));
        }
        let own = dataset.layout().pairs();
        let list = self.list.as_deref().unwrap_or(&own);
        if !list.is_file() && self.list.is_none() {
            let help = format!("list pairs first: enfilade make {} pairs; or give --step or --between", dataset.root().display());
            return Err(Error::usage(format!("flow follows a list of view pairs, but {} does not exist", list.display()), help));
        }
        if is_same_file(list, &own) {
            return Ok(FlowPairs::Listed);
        }
        let there_and_back = |pair: FramePair| {
            let back = FramePair { scene: pair.scene.clone(), first: pair.second.clone(), second: pair.first.clone() };
            [pair, back]
        };
        Ok(FlowPairs::Between(read_pairs(list)?.into_iter().flat_map(there_and_back).collect()))
    }
}

fn is_same_file(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().ok().is_some_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}
