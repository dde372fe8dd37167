//! Laws that do not apply to Hypersim's own release, and its known defects.
//!
//! The numbers with # are issues of github.com/apple/ml-hypersim. Everything else is checked by the same laws as our datasets, within the
//! rounding of float16 ([`super::rounding`]).

use super::card::{Card, Finding};
use super::law::Law;
use serde::{Deserialize, Serialize};

/// Why a law does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Excuse {
    /// The law is about something that the data do not claim.
    NotApplicable,
    /// The law is broken in a way that is known.
    KnownDefect,
}

/// A law that does not count, with what was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Excused {
    /// Which one.
    pub law: Law,
    /// Whether it does not apply, or is broken in a way that is known.
    pub excuse: Excuse,
    /// The statement.
    pub statement: String,
    /// The worst value; `None` when it was not checked, is infinite or not a number.
    pub worst: Option<f64>,
    /// Place of the worst value; empty if the law was not checked.
    pub place: String,
    /// Why it does not count.
    pub reason: String,
}

/// Laws that do not apply to the release.
const NOT_APPLICABLE: [(Law, &str); 6] = [
    (Law::Manifest, "the release has no manifest"),
    (Law::Checksums, "the release has no checksums"),
    (Law::Roll, "Hypersim has no limit of roll: half of its views at 40 degrees down roll by more than 5 degrees"),
    (Law::TexCoord, "V-Ray's third texture coordinate is stored, and coordinates stand where nothing was hit"),
    (Law::Flatness, "positions are float16, too coarse for planes through neighbouring pixels"),
    (Law::TwoViewReflectance, "V-Ray filters reflectance over random samples that differ between frames"),
];

/// Laws with known defects in the release.
const KNOWN: [(Law, &str); 14] = [
    (
        Law::FramesComplete,
        "frames that show people or logos were removed, so there are more poses than images (#58); others were not downloaded",
    ),
    (Law::LayersPresent, "layers that were not downloaded"),
    (Law::LabelTables, "the archives have no label tables; they are in evermotion_dataset of the toolkit's repository"),
    (Law::HasFrames, "all frames of the trajectory were removed"),
    (Law::Orthonormal, "frame 0 has the artist's matrix, which may be stretched (#103); the nearest rotation stands for it"),
    (Law::RightHanded, "frame 0 has the artist's matrix, which may be stretched (#103); the nearest rotation stands for it"),
    (Law::LookAt, "the look-at point of frame 0 may lie beside the axis (#67)"),
    (Law::UnitNormals, "normals are the artist's: some are zero or not of unit length (#26)"),
    (Law::NormalFacing, "normals are the artist's: some face away from the camera (#26)"),
    (Law::BumpFacing, "normals are the artist's: some face away from the camera (#26)"),
    (Law::ColorFinite, "values beyond 65504 are infinite in float16"),
    (Law::Albedo, "V-Ray's diffuse filter leaves [0, 1] in few places"),
    (Law::Recomposition, "V-Ray filters each of the three parts over its own samples, and its residual is a sum of eight channels"),
    (Law::InstanceClass, "five instances of the release have parts of several classes"),
];

/// From here on an orientation is stretched, not merely rounded to single precision.
pub(super) const STRETCHED: f64 = 1e-6;

/// Laws about where the camera looks, which a frame that was rendered with a stretched orientation cannot keep.
pub(super) const POSE_LAWS: [Law; 8] = [
    Law::Projection,
    Law::NormalFacing,
    Law::BumpFacing,
    Law::NormalCamera,
    Law::BumpCamera,
    Law::TwoViewDistance,
    Law::TwoViewIds,
    Law::TwoViewReflectance,
];

/// Takes what does not count off the card of a released scene.
pub(super) fn excuse(card: &mut Card) -> Vec<Excused> {
    let mut excused: Vec<Excused> =
        NOT_APPLICABLE.iter().map(|&(law, reason)| Excused::new(law, Excuse::NotApplicable, card.take(law), reason)).collect();
    for (law, reason) in KNOWN {
        excused.extend(card.take_failure(law).map(|found| Excused::new(law, Excuse::KnownDefect, Some(found), reason)));
    }
    excused
}

/// Takes what a frame broke because its stored orientation is off a rotation by `off` off its card.
pub(super) fn excuse_stretched(card: &mut Card, off: f64) -> Vec<Excused> {
    let reason = format!("the stored orientation of the frame is no rotation (off by {off:.2e}); the nearest one stands for it (#103)");
    let excused = |law: Law| Some(Excused::new(law, Excuse::KnownDefect, Some(card.take_failure(law)?), &reason));
    POSE_LAWS.into_iter().filter_map(excused).collect()
}

/// One entry per law and excuse, with the worst value, in the order of the laws.
pub(super) fn worst_of(mut excused: Vec<Excused>) -> Vec<Excused> {
    // Checked before unchecked, infinite before finite, large before small.
    let weight = |e: &Excused| if e.place.is_empty() { -1.0 } else { e.worst.unwrap_or(f64::INFINITY) };
    excused.sort_by(|a, b| (a.law, a.excuse).cmp(&(b.law, b.excuse)).then(weight(b).total_cmp(&weight(a))));
    excused.dedup_by(|b, a| (a.law, a.excuse) == (b.law, b.excuse));
    excused
}

impl Excused {
    fn new(law: Law, excuse: Excuse, found: Option<Finding>, reason: &str) -> Self {
        Self {
            law,
            excuse,
            statement: law.spec().statement.into(),
            worst: found.as_ref().map(|found| found.value).filter(|v| v.is_finite()),
            place: found.map_or(String::new(), |found| found.place),
            reason: reason.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_defects_are_named_with_their_place_and_what_holds_stays() {
        let mut card = Card::default();
        card.observe(Law::UnitNormals, 1.0, || "frame pixel (3, 4)".into());
        card.observe(Law::Albedo, 0.9, || "frame".into());
        card.observe(Law::Roll, 12.0, || "frame".into());
        card.observe(Law::Distance, 1.0, || "frame".into());
        let excused = excuse(&mut card);
        assert_eq!(card.failures(), [Law::Distance], "what is not known of the release counts");
        assert!(card.finding(Law::Albedo).is_some());
        let normals = excused.iter().find(|e| e.law == Law::UnitNormals).unwrap();
        assert_eq!((normals.excuse, normals.worst, normals.place.as_str()), (Excuse::KnownDefect, Some(1.0), "frame pixel (3, 4)"));
        assert!(normals.reason.contains("#26"));
        assert!(excused.iter().any(|e| e.law == Law::Roll && e.excuse == Excuse::NotApplicable && e.worst == Some(12.0)));
        assert!(excused.iter().any(|e| e.law == Law::Manifest && e.place.is_empty()));
    }

    #[test]
    fn of_several_scenes_the_worst_is_told() {
        let of = |value: f64| {
            let mut card = Card::default();
            card.observe(Law::LookAt, value, || format!("at {value}"));
            excuse(&mut card)
        };
        let worst = worst_of([of(0.1), of(0.5), of(0.3)].concat());
        let look_at: Vec<&Excused> = worst.iter().filter(|e| e.law == Law::LookAt).collect();
        assert_eq!((look_at.len(), look_at[0].place.as_str()), (1, "at 0.5"));
        assert_eq!(worst.len(), NOT_APPLICABLE.len() + 1);
    }
}
