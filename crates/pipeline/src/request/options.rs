//! Options of products, declared once: flags of `make`, keywords of Python's, and keys of the products in `dataset.toml`.

use super::choice::FrameChoice;
use super::product::Product;
use super::requests::{FlowPairs, PairsRequest, Request};
use enfilade_options::{DEGREES, Interval, METERS, SHARES, Whole, named, options};
use std::path::PathBuf;

/// No angle is larger, and a bound that is infinite cannot be stored.
const MOST_DEGREES: f64 = 180.0;

options! {
    /// Options of all products; each reads its own, those of [`Product::options`].
    #[derive(Clone, Debug, PartialEq)]
    pub struct ProductOptions keys pub(crate) ProductKeys {
        /// The list of view pairs: `pairs` writes it, `flow` follows it there and back; pairs.csv in the dataset unless given.
        pub pairs: Option<PathBuf> = None => named("CSV"),
        /// Only pairs that see this share of each other.
        pub overlap: Option<Interval<1>> = None => SHARES,
        /// Only pairs with this distance of the cameras, metres.
        pub baseline_m: Option<Interval> = None => METERS,
        /// Only pairs with this angle between the viewing axes, degrees.
        pub angle_deg: Option<Interval> = None => DEGREES,
        /// Approximate number of pixels of each frame that are projected into the others.
        pub pixels: Whole<1> = Whole::new(3000),
        /// Instead of a list: from each frame to the one N later in its trajectory; -1 is the one before.
        pub step: Option<i64> = None,
        /// Instead of a list: from one frame to another, as in cam_00/3 cam_01/7.
        pub between: Option<[(String, u32); 2]> = None,
        /// Points per camera, seeded evenly over its frames and over the image.
        pub points: Whole<1> = Whole::new(256),
        /// Another seed gives other points.
        pub seed: u64 = 0 => named("SEED"),
        /// Surfaces per pixel at most, from near to far.
        pub layers: Whole<1, 64> = Whole::new(8),
        /// The sensors; docs/sensors.md has the kinds and their keys.
        pub sensors: Option<PathBuf> = None => named("TOML"),
        /// The mixes: a table of mix, fixture, r, g, b.
        pub mixes: Option<PathBuf> = None => named("CSV"),
    }
}

impl ProductOptions {
    /// The options that a table of `dataset.toml` gives.
    pub(crate) fn of_keys(keys: &ProductKeys) -> Self {
        let mut options = Self::default();
        keys.apply(&mut options);
        options
    }

    /// The request for a product of the frames `of`; `None` if a file defines it, and for products that every run makes.
    pub(crate) fn request(&self, product: Product, of: &FrameChoice) -> Option<Request> {
        let (of, cameras) = (of.clone(), of.cameras.clone());
        Some(match product {
            Product::Covisibility => self.pairs_request(cameras).covisibility(),
            Product::Pairs => Request::Pairs(self.pairs_request(cameras)),
            Product::Flow => Request::Flow { pairs: self.step.map_or(FlowPairs::Listed, FlowPairs::Step), cameras },
            Product::Tracks => Request::Tracks { points: self.points.get(), seed: self.seed, of },
            Product::Surfaces => Request::Surfaces { layers: self.layers.get(), of },
            Product::Rooms => Request::Rooms { of },
            Product::Words => Request::Words,
            Product::Sensors | Product::Relit | Product::Sheet | Product::Statistics => return None,
        })
    }

    /// Which pairs are chosen, of all scenes.
    pub(crate) fn pairs_request(&self, cameras: Option<Vec<String>>) -> PairsRequest {
        let usual = PairsRequest::default();
        let [min_baseline_m, max_baseline_m] = self.baseline_m.map_or([usual.min_baseline_m, f64::INFINITY], Interval::ends);
        PairsRequest {
            pixels: self.pixels.get(),
            overlap: self.overlap.map(|shares| shares.ends().map(|share| share as f32)),
            min_baseline_m,
            max_baseline_m: Some(max_baseline_m).filter(|most| most.is_finite()),
            angle_deg: self.angle_deg.map_or(usual.angle_deg, |angles| angles.ends().map(|angle| angle.min(MOST_DEGREES))),
            cameras,
            ..usual
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_multiview::TracksConfig;
    use enfilade_options::{Keys, Options};
    use std::collections::BTreeSet;

    #[test]
    fn every_option_is_of_some_product_and_every_key_is_an_option() {
        let of_products: BTreeSet<&str> = Product::ON_REQUEST.iter().flat_map(|product| product.options()).collect();
        let declared: BTreeSet<&str> = ProductOptions::OPTIONS.iter().map(|spec| spec.name).collect();
        assert_eq!(of_products, declared);
        let mut keys = Vec::new();
        ProductKeys::names(&mut keys);
        assert!(Product::ON_REQUEST.iter().flat_map(|product| product.keys()).all(|key| keys.contains(key)));
    }

    #[test]
    fn what_is_not_given_is_as_the_methods_have_it() {
        let (options, of) = (ProductOptions::default(), FrameChoice::default());
        assert_eq!(options.pairs_request(None), PairsRequest::default());
        let TracksConfig { points, seed } = TracksConfig::default();
        assert_eq!(options.request(Product::Tracks, &of), Some(Request::Tracks { points, seed, of }));
    }

    #[test]
    fn bounds_that_are_infinite_are_not_stored() {
        let options = ProductOptions {
            overlap: Interval::of([0.2, 0.7]),
            baseline_m: Interval::of([0.3, f64::INFINITY]),
            angle_deg: Interval::of([10.0, f64::INFINITY]),
            ..ProductOptions::default()
        };
        let request = options.pairs_request(None);
        assert_eq!((request.min_baseline_m, request.max_baseline_m, request.angle_deg), (0.3, None, [10.0, 180.0]));
        assert_eq!(request.overlap, Some([0.2, 0.7]));
    }
}
