//! Making products: requested ones, or those that are out of date.

use super::adopt::adopt;
use super::lists::{make_covisible, make_listed};
use super::pairs::{listed, scenes_of};
use super::record::{Place, Record, has_records};
use super::sources::Subject;
use super::stale::specs_in;
use super::table::{PRODUCTS, ProductSpec, When};
use super::update::{Made, MakeOptions, Updated, update};
use super::{flow, relit, rooms, words};
use crate::error::Error;
use crate::report::{Event, ProductCx, ProductOutcome, Reporter, Stopwatch};
use crate::request::{PairsRequest, Product, Request, Scope};
use crate::workdir::Workdir;
use enfilade_dataset::{Dataset, PairRow, WORKDIR};
use enfilade_scene::{Cx, Quiet};

/// Makes the requested products of these scenes, after the products that they need. Products that are up to date are not made again.
/// Requests are stored, and used to make products again once they are out of date.
///
/// # Errors
/// If none of the requests can be fulfilled for these scenes, another process works on the dataset, or a file cannot be read or written.
pub fn make(dataset: &Dataset, scenes: &[String], requests: &[Request], options: MakeOptions, cx: &dyn Cx) -> Result<Vec<Made>, Error> {
    let _lock = locked(dataset)?;
    scenes.iter().try_for_each(|scene| adopt(dataset, scene))?;
    take_over_settings(dataset, scenes, requests)?;
    let mut all = Vec::new();
    for spec in &PRODUCTS {
        let asked: Vec<Request> = requests.iter().filter(|request| request.product() == spec.product).cloned().collect();
        if asked.is_empty() {
            continue;
        }
        let done = if spec.scope == Scope::Dataset {
            make_listed(dataset, scenes, &asked, options, cx)?
        } else {
            make_in_scenes(dataset, scenes, spec, &asked, options, cx)?
        };
        if done.iter().all(|made| made.made + made.kept == 0) {
            return Err(nothing_to_make(dataset, spec.product));
        }
        all.extend(done);
    }
    Ok(all)
}

/// Makes again the products that are out of date in these scenes and in the dataset as a whole, as requested before; only the products in
/// `only` if any are named.
///
/// # Errors
/// As [`make`].
pub fn make_stale(dataset: &Dataset, scenes: &[String], only: &[Product], cx: &dyn Cx) -> Result<Vec<Made>, Error> {
    let _lock = locked(dataset)?;
    let is_meant = |spec: &ProductSpec| only.is_empty() || only.contains(&spec.product);
    let mut all = Vec::new();
    for late in [false, true] {
        for scene in scenes {
            let place = Place::Scene(scene);
            for spec in specs_in(place).filter(|spec| spec.is_late() == late && is_meant(spec)) {
                all.push(made(spec.product, place, update(dataset, place, spec.product, &[], MakeOptions::default(), cx)?));
            }
        }
        for spec in specs_in(Place::Dataset).filter(|spec| !late && is_meant(spec)) {
            all.push(made(spec.product, Place::Dataset, update(dataset, Place::Dataset, spec.product, &[], MakeOptions::default(), cx)?));
        }
    }
    all.retain(|made| made.made > 0);
    Ok(all)
}

/// The dataset's lock, where it has a work folder.
fn locked(dataset: &Dataset) -> Result<Option<Workdir>, Error> {
    if dataset.root().join(WORKDIR).is_dir() { Workdir::open(dataset.root()).map(Some) } else { Ok(None) }
}

/// A sensor or a mix has one setting in all scenes: what other scenes have of it is out of date from now on.
fn take_over_settings(dataset: &Dataset, scenes: &[String], requests: &[Request]) -> Result<(), Error> {
    for product in [Product::Sensors, Product::Relit] {
        let newer: Vec<&Request> = requests.iter().filter(|request| request.product() == product).collect();
        if newer.is_empty() {
            continue;
        }
        for scene in dataset.scenes().map_err(Error::stage)?.iter().filter(|scene| !scenes.contains(scene)) {
            let place = Place::Scene(scene);
            let Some(mut record) = Record::read(dataset, place, product) else { continue };
            let before = record.requests.clone();
            for request in &mut record.requests {
                if let Some(changed) = newer.iter().find_map(|newer| request.with_settings_of(newer)) {
                    *request = changed;
                }
            }
            if record.requests != before {
                record.write(dataset, place, product)?;
            }
        }
    }
    Ok(())
}

fn make_in_scenes(
    dataset: &Dataset,
    scenes: &[String],
    spec: &ProductSpec,
    asked: &[Request],
    options: MakeOptions,
    cx: &dyn Cx,
) -> Result<Vec<Made>, Error> {
    let subjects: Vec<Subject> = scenes.iter().map(|scene| Subject::new(dataset, Place::Scene(scene))).collect();
    // Before the first of many scenes costs time.
    for request in asked {
        match request {
            Request::Flow { .. } => flow::check(&subjects, request)?,
            Request::Mix { .. } => relit::check(&subjects, cx)?,
            _ => {}
        }
    }
    let mut done = Vec::new();
    for scene in scenes {
        let place = Place::Scene(scene);
        done.push(made(spec.product, place, update(dataset, place, spec.product, asked, options, cx)?));
    }
    match spec.product {
        Product::Rooms => rooms::refuse_none(&subjects)?,
        Product::Words => words::refuse_none(&subjects)?,
        _ => {}
    }
    Ok(done)
}

fn nothing_to_make(dataset: &Dataset, product: Product) -> Error {
    match product {
        Product::Flow => Error::scene("no pair of existing frames was selected", "choose others, or render them: enfilade run"),
        Product::Covisibility | Product::Pairs => {
            let message = format!("no camera that was chosen has frames in {}", dataset.root().display());
            Error::scene(message, "make them with `enfilade run`, which also reports what failed")
        }
        _ => Error::scene("no existing frame was selected", "choose others, or render them: enfilade run"),
    }
}

fn made(product: Product, place: Place, updated: Updated) -> Made {
    Made { product, scene: place.scene().map(String::from), made: updated.made, kept: updated.kept, lines: updated.lines }
}

/// Brings the requested products of a place up to date, whether requested by the configuration (`configured`) or otherwise; either the
/// `late` ones or the others. If one cannot be made, the others are still made.
pub(crate) fn bring_up_to_date(
    dataset: &Dataset,
    place: Place,
    configured: &[Request],
    late: bool,
    reporter: &dyn Reporter,
) -> Vec<ProductOutcome> {
    if configured.is_empty() && !has_records(dataset, place) {
        return Vec::new();
    }
    let scene = place.scene();
    let one = |spec: &ProductSpec| {
        let own: Vec<Request> = configured.iter().filter(|request| request.product() == spec.product).cloned().collect();
        configure(dataset, place, spec.product, &own)?;
        let (cx, time) = (ProductCx::new(scene.unwrap_or_default(), spec.product, reporter), Stopwatch::start());
        let updated = update(dataset, place, spec.product, &[], MakeOptions::default(), &cx);
        match &updated {
            Ok(updated) if updated.made > 0 => cx.event(Event::Finished { summary: &updated.lines.join("; "), wall_s: time.wall_s() }),
            Ok(_) => {}
            Err(error) => cx.event(Event::Failed { message: &error.explain() }),
        }
        updated
    };
    let outcome = |spec: &ProductSpec| {
        let (updated, failure) = match one(spec) {
            Ok(updated) => (updated, None),
            Err(error) => (Updated::default(), Some((error.explain(), error.hint()))),
        };
        let is_known = updated.made + updated.kept > 0 || failure.is_some();
        let scene = scene.map(String::from);
        is_known.then_some(ProductOutcome { product: spec.product, scene, made: updated.made, lines: updated.lines, failure })
    };
    specs_in(place).filter(|spec| spec.when == When::Asked && spec.is_late() == late).filter_map(outcome).collect()
}

/// Makes the requested products of a scene in the dataset `aside`, which has one frame of it; the further cost of products of all frames is
/// not measured.
pub(crate) fn try_out(dataset: &Dataset, scene: &str, configured: &[Request], aside: &Dataset) -> Result<(), Error> {
    for spec in specs_in(Place::Scene(scene)) {
        let record = Record::read(dataset, Place::Scene(scene), spec.product).unwrap_or_default();
        let own = configured.iter().filter(|request| request.product() == spec.product);
        let asked: Vec<Request> = record.requests.iter().chain(own).cloned().collect();
        if !asked.is_empty() {
            update(aside, Place::Scene(scene), spec.product, &asked, MakeOptions::default(), &Quiet)?;
        }
    }
    Ok(())
}

/// Adds the requests of the configuration that it did not have when it was last read. A verb may have made other requests since.
fn configure(dataset: &Dataset, place: Place, product: Product, configured: &[Request]) -> Result<(), Error> {
    let found = Record::read(dataset, place, product);
    if found.as_ref().map_or(configured.is_empty(), |record| record.configured == configured) {
        return Ok(());
    }
    let mut record = found.unwrap_or_default();
    let last = std::mem::replace(&mut record.configured, configured.to_vec());
    configured.iter().filter(|request| !last.contains(request)).for_each(|request| record.ask(request));
    record.write(dataset, place, product)
}

/// The pairs that `request` chooses, with a line about each scene; their covisibility is made if it is missing. The dataset's own list is
/// not changed.
///
/// # Errors
/// When no scene has frames that are chosen, or a file cannot be read or written.
pub fn choose_pairs_of(dataset: &Dataset, request: &PairsRequest, cx: &dyn Cx) -> Result<(Vec<PairRow>, Vec<String>), Error> {
    let _lock = locked(dataset)?;
    if !make_covisible(dataset, &scenes_of(request, dataset)?, request, MakeOptions::default(), cx)? {
        return Err(nothing_to_make(dataset, Product::Pairs));
    }
    listed(dataset, request, cx)
}
