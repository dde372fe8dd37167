//! The laws of tracks: points are at their projections by the cameras, and occlusion agrees with distances where these decide it.

use super::card::Card;
use super::law::Law;
use super::many_views::Listed;
use enfilade_dataset::{BodyPlaces, Tracks};
use enfilade_math::DVec2;

/// Points are compared if they are at most this many image sizes beyond the borders: farther out, float32 is coarser than the bound.
const BEYOND: f64 = 1.0;

/// Checks the points of a camera's tracks in one of their frames, the `place`-th. Returns the number of points whose occlusion certainly
/// contradicts the distances.
///
/// `places` has the places of what moves in each of the frames.
pub(super) fn check(
    name: &str,
    tracks: &Tracks,
    (place, places): (usize, &[BodyPlaces<'_>]),
    frame: &Listed<'_>,
    card: &mut Card,
) -> usize {
    let [width, height] = frame.view.camera().size().map(f64::from);
    let mut contradictions = 0;
    let number = tracks.frames[place];
    for (point, &seeded) in tracks.positions.iter().enumerate() {
        let part = tracks.node_ids.get(point).map_or(0, |&part| i64::from(part));
        let (own, seed) = tracks.seeds[point];
        let carried = places[own as usize].carry_to(f64::from(seed[1]), (&places[place], &frame.view), part, seeded);
        let Some(p) = carried else { continue };
        let at = point * tracks.frames.len() + place;
        let [x, y] = tracks.points[at].map(f64::from);
        let stored = DVec2::new(x * width, y * height);
        let is_near = |at: &DVec2| {
            (at.x / width).abs().max((at.y / height).abs()) < 1.0 + BEYOND && at.x > -BEYOND * width && at.y > -BEYOND * height
        };
        let expected = frame.view.project(p).map(DVec2::from).filter(is_near);
        let off = match expected {
            Some(expected) if own as usize == place => expected.distance(stored).max(stored.distance(DVec2::from(seed.map(f64::from)))),
            Some(expected) => expected.distance(stored),
            None => 0.0,
        };
        card.observe(Law::TrackPoints, off, || format!("{name}, point {point} in frame {number}"));
        contradictions += usize::from(frame.contradicts(p, !tracks.occluded[at]));
    }
    contradictions
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    fn failures(change: impl Fn(&mut Tracks)) -> Vec<Law> {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let mut tracks = dataset.read_tracks("room", "cam_00").unwrap();
        change(&mut tracks);
        dataset.write_tracks("room", "cam_00", &tracks).unwrap();
        let report = crate::verify_scene(&dataset, "room", &Quiet).unwrap();
        report.failures().map(|law| law.law).collect()
    }

    #[test]
    fn points_that_are_elsewhere_or_wrongly_occluded_are_found_and_nothing_else() {
        assert_eq!(failures(|_| ()), []);
        assert_eq!(failures(|tracks| tracks.points[1][0] += 0.001), [Law::TrackPoints]);
        assert_eq!(failures(|tracks| tracks.seeds[0].1[1] += 1.0), [Law::TrackPoints]);
        assert_eq!(failures(|tracks| tracks.occluded.iter_mut().for_each(|occluded| *occluded = true)), [Law::TrackOcclusion]);
        assert_eq!(failures(|tracks| tracks.frames[1] = 9), [], "frames that are gone are not compared");
    }
}
