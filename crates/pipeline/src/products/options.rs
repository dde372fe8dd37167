//! Options of products as people give them, on the command line and in Python: words and files become requests.

use super::make::{choose_pairs_of, make};
use super::relit::read_mixes;
use super::update::{Made, MakeOptions};
use crate::config::read_sensors;
use crate::error::Error;
use crate::request::{FlowPairs, FrameChoice, PairsRequest, Product, ProductOptions, Request};
use enfilade_dataset::{Dataset, FramePair, read_pairs, write_pairs};
use enfilade_scene::Cx;
use std::path::Path;

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
    let mut ordered = products.to_vec();
    ordered.sort_unstable();
    ordered.dedup();
    let mut all = Vec::new();
    for product in ordered {
        if let (Product::Pairs, Some(list)) = (product, &options.pairs) {
            let (rows, lines) = choose_pairs_of(dataset, &pairs(options, dataset, scenes, of)?, cx)?;
            write_pairs(list, &rows)?;
            all.push(Made { product, scene: None, made: 1, kept: 0, lines });
            continue;
        }
        all.extend(make(dataset, scenes, &requests(options, product, dataset, scenes, of)?, how, cx)?);
    }
    Ok(all)
}

/// Requests of a product by these options.
fn requests(
    options: &ProductOptions,
    product: Product,
    dataset: &Dataset,
    scenes: &[String],
    of: &FrameChoice,
) -> Result<Vec<Request>, Error> {
    Ok(match (product, options.request(product, of)) {
        (Product::Pairs, _) => vec![Request::Pairs(pairs(options, dataset, scenes, of)?)],
        (Product::Flow, _) => vec![Request::Flow { pairs: flow(options, dataset, scenes)?, cameras: of.cameras.clone() }],
        (_, Some(request)) => vec![request],
        (Product::Sensors, None) => {
            let file =
                options.sensors.as_ref().ok_or_else(|| Error::usage("no sensors are named", "give --sensors examples/sensors.toml"))?;
            read_sensors(file)?.all().map(|sensor| Request::Sensor { sensor, of: of.clone() }).collect()
        }
        (Product::Relit, None) => {
            let file = options.mixes.as_ref().ok_or_else(|| Error::usage("no mixes are named", "give --mixes examples/mixes.csv"))?;
            read_mixes(file, dataset, scenes, of)?
        }
        (_, None) => {
            let message = format!("{} is made by every run", product.name());
            return Err(Error::usage(message, "enfilade run OUT makes it; enfilade stats OUT the statistics"));
        }
    })
}

fn pairs(options: &ProductOptions, dataset: &Dataset, scenes: &[String], of: &FrameChoice) -> Result<PairsRequest, Error> {
    let are_all = dataset.scenes().map_err(Error::stage)? == scenes;
    Ok(PairsRequest { scenes: if are_all { None } else { Some(scenes.to_vec()) }, ..options.pairs_request(of.cameras.clone()) })
}

fn flow(options: &ProductOptions, dataset: &Dataset, scenes: &[String]) -> Result<FlowPairs, Error> {
    if let Some(step) = options.step {
        return Ok(FlowPairs::Step(step));
    }
    if let Some([first, second]) = &options.between {
        let [scene] = scenes else {
            return Err(Error::usage("the dataset has several scenes", format!("name one with --scene: {}", scenes.join(", "))));
        };
        return Ok(FlowPairs::Between(vec![FramePair { scene: scene.clone(), first: first.clone(), second: second.clone() }]));
    }
    let own = dataset.layout().pairs();
    let list = options.pairs.as_deref().unwrap_or(&own);
    if !list.is_file() && options.pairs.is_none() {
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

fn is_same_file(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().ok().is_some_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}
