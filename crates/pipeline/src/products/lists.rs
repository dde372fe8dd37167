//! Making of the list of pairs, and first of the covisibility that it is chosen by.

use super::record::Place;
use super::update::{Made, MakeOptions, update};
use crate::error::Error;
use crate::request::{PairsRequest, Product, Request};
use enfilade_dataset::Dataset;
use enfilade_scene::Cx;

/// Makes the covisibility of the scenes, and then the list.
pub(super) fn make_listed(
    dataset: &Dataset,
    scenes: &[String],
    asked: &[Request],
    options: MakeOptions,
    cx: &dyn Cx,
) -> Result<Vec<Made>, Error> {
    let mut all = Vec::new();
    for request in asked {
        let Request::Pairs(pairs) = request else { continue };
        if !make_covisible(dataset, scenes, pairs, options, cx)? {
            continue;
        }
        let updated = update(dataset, Place::Dataset, Product::Pairs, std::slice::from_ref(request), options, cx)?;
        all.push(Made { product: Product::Pairs, scene: None, made: updated.made, kept: updated.kept, lines: updated.lines });
    }
    Ok(all)
}

/// Makes the covisibility that a request needs of scenes; false where none of them has a frame that is chosen.
pub(super) fn make_covisible(
    dataset: &Dataset,
    scenes: &[String],
    request: &PairsRequest,
    options: MakeOptions,
    cx: &dyn Cx,
) -> Result<bool, Error> {
    let mut any = false;
    for scene in scenes {
        let updated = update(dataset, Place::Scene(scene), Product::Covisibility, &[request.covisibility()], options, cx)?;
        any |= updated.made + updated.kept > 0;
    }
    Ok(any)
}
