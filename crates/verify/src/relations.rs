//! The stored relations between frames of a scene: the matrix of covisibility, layers that lead from frame to frame, and tracks.

use super::boxes::there;
use super::card::Card;
use super::law::Law;
use super::many_views::{self, BETWEEN_SAMPLES, Listed};
use super::not_judged::NotJudged;
use super::pair_flow::{self, PairLayers};
use super::read::readable;
use super::tracks;
use enfilade_dataset::{BodyPlaces, Dataset, FramePair, Tracks};
use enfilade_frame::Layer;

/// Returns a frame by camera and number; `None` if it does not exist.
type Listing<'l, 'a> = &'l (dyn Fn(&str, u32) -> Option<Listed<'a>> + Sync);

/// Checks the relations that a scene has; only existing frames are compared. Unreadable files are added to the card.
pub(super) fn check(
    dataset: &Dataset,
    (scene, cameras): (&str, &[&str]),
    not_judged: &NotJudged,
    listed: Listing<'_, '_>,
    card: &mut Card,
) {
    let layout = dataset.layout();
    if !not_judged.has(&layout.covisibility(scene))
        && let Some(stored) = there(dataset.read_covisibility(scene)).and_then(|read| readable(card, read))
    {
        many_views::check(scene, &stored, |frame| listed(&frame.camera, frame.frame), card);
    }
    let pairs = cameras.iter().filter_map(|camera| readable(card, dataset.pairs_with_layers(scene, camera)));
    let is_judged = |pair: &FramePair| !not_judged.has(&layout.pair_layer(pair, Layer::OpticalFlow));
    let pairs: Vec<FramePair> = pairs.flatten().filter(is_judged).collect();
    let cards: Vec<Card> = enfilade_parallel::map(&pairs, |pair| check_pair(dataset, pair, listed));
    cards.into_iter().for_each(|found| card.merge(found));
    for camera in cameras.iter().filter(|camera| !not_judged.has(&layout.tracks(scene, camera))) {
        if let Some(stored) = there(dataset.read_tracks(scene, camera)).and_then(|read| readable(card, read)) {
            let bodies = readable(card, dataset.read_filmed_bodies(scene, camera)).flatten();
            let place = |&frame: &u32| bodies.as_ref().map_or_else(BodyPlaces::default, |bodies| bodies.at(frame));
            let places: Vec<BodyPlaces<'_>> = stored.frames.iter().map(place).collect();
            check_tracks(&format!("{scene}/{camera}"), (&stored, &places), &|number| listed(camera, number), card);
        }
    }
}

/// Checks the tracks of a camera in each of their frames.
fn check_tracks<'a>(
    name: &str,
    (stored, places): (&Tracks, &[BodyPlaces<'_>]),
    listed: &(dyn Fn(u32) -> Option<Listed<'a>> + Sync),
    card: &mut Card,
) {
    let check = |place: usize| {
        let mut card = Card::default();
        let contradictions = listed(stored.frames[place]).map(|frame| tracks::check(name, stored, (place, places), &frame, &mut card));
        (card, contradictions)
    };
    let found: Vec<(Card, Option<usize>)> = enfilade_parallel::map_up_to(stored.frames.len(), check);
    let there: Vec<usize> = found.iter().filter_map(|(_, contradictions)| *contradictions).collect();
    let (wrong, all) = (there.iter().sum::<usize>(), there.len() * stored.positions.len());
    let share = wrong.saturating_sub(BETWEEN_SAMPLES) as f64 / all.max(1) as f64;
    card.observe(Law::TrackOcclusion, share, || format!("{name}: {wrong} of {all} points in frames"));
    found.into_iter().for_each(|(found, _)| card.merge(found));
}

/// Checks the layers that lead from a frame to another one.
fn check_pair(dataset: &Dataset, pair: &FramePair, listed: Listing<'_, '_>) -> Card {
    let mut card = Card::default();
    let frames = [&pair.first, &pair.second].map(|(camera, number)| listed(camera, *number));
    let [Some(first), Some(second)] = &frames else { return card };
    let [width, height] = first.view.camera().size().map(|side| side as usize);
    let mut read = |layer: Layer| {
        let (size, values) = readable(&mut card, dataset.read_pair_layer(pair, layer))?;
        let fits = size == [height, width] && values.dtype() == layer.spec().dtype;
        let at = || format!("{}: expected {width}x{height} pixels", dataset.layout().pair_layer(pair, layer).display());
        card.observe(Law::Readable, if fits { 0.0 } else { 1.0 }, at);
        fits.then_some(values)
    };
    let layers = [read(Layer::OpticalFlow), read(Layer::SceneFlow), read(Layer::FlowVisibility)];
    if let [Some(flow), Some(moved), Some(seen)] = layers {
        pair_flow::check(pair, &PairLayers { flow, moved, seen }, [first, second], &mut card);
    }
    card
}
