//! Suspicions about unit and upward axis, shared by `import`, `look` and `run`.
//!
//! A file in feet, or one whose rooms lie on their side, satisfies every law of a dataset: all is consistent, and wrong. The evidence comes
//! from known things: the height of rooms ([`room`]), the size of things named chair or door ([`things`]), the positions of floors and
//! ceilings, the orientation of the file's cameras and the largest surfaces ([`upright`]), and what things rest on ([`support`]). [`units`] weighs the sizes. Nothing is changed; a suspicion names the
//! key and what to try.

mod names;
mod room;
mod support;
mod things;
mod units;
mod upright;

pub(super) use units::{Sizes, Suspicion, UNITS};

use super::seen::Look;
use crate::config::FileSource;
use enfilade_import::{Imported, UpAxis};
use enfilade_math::DVec3;
use names::Named;
use upright::{Lying, Witness};

/// The suspicions about a scene.
pub(super) struct Suspicions {
    /// Suspicion that it lies on its side or is upside down, in a sentence that names the key.
    pub axes: Option<String>,
    /// The judgement of its unit by the sizes of rooms and things.
    pub sizes: Sizes,
    /// Whether its names show that it is furniture or a similar thing, not a building.
    pub is_thing: bool,
}

/// Judges the axes and the unit of a scene.
pub(super) fn judge(source: &FileSource, imported: &Imported, look: &Look) -> Suspicions {
    if look.world.bounds.is_empty() {
        return Suspicions { axes: None, sizes: Sizes::Unknown, is_thing: false };
    }
    let scene = &imported.scene;
    let named = Named::of(source, imported);
    let lying = upright::suspected(scene, look, &named, imported.axes, imported.up);
    // Heights are along what is up in truth.
    let up = lying.as_ref().map_or(DVec3::Z, |lying| lying.up);
    let sizes = units::judge(scene, look, &named, up);
    Suspicions { axes: lying.map(|lying| of_axes(imported, &lying)), sizes, is_thing: named.is_thing() }
}

fn of_axes(imported: &Imported, lying: &Lying) -> String {
    let axis = UpAxis::nearest(imported.axes.transpose() * lying.up).name();
    let how = if lying.up == DVec3::NEG_Z { "it seems to stand on its head" } else { "it seems to lie on its side" };
    let witness = |witness: &Witness| match witness {
        Witness::Names => "the surfaces named floor and ceiling are oriented so",
        Witness::Cameras => "the upper sides of its cameras point so",
        Witness::Support => "nearly all of its things rest on something that way, and hardly any the other",
        Witness::Surfaces => "its largest surfaces are as far apart that way as floor and ceiling are",
    };
    let because = lying.witnesses.iter().map(witness).collect::<Vec<_>>().join(", and ");
    match imported.report.format {
        "package" => format!("{how}: {because}; if it does, import the file that it was made from with another up_axis"),
        _ => format!(
            "{how}, with {axis} upward in the file: {because}; if it does, up_axis = \"{axis}\" (or --up-axis {axis}) sets it upright"
        ),
    }
}

/// A suspicion about the unit, with the number to use in place of `source`'s.
pub(super) fn of_unit(source: &FileSource, format: &str, unit: &Suspicion) -> String {
    let number = plain(source.meters_per_unit * unit.factor);
    // Units are named only for files whose unit was not stated.
    let name = unit.name.filter(|_| source.meters_per_unit == 1.0);
    let called = name.map_or(String::new(), |name| format!(", for a file in {name}"));
    let (because, then) = (unit.because.join(", "), unit.then.join(", "));
    let key = match format {
        "package" => format!("importing the file that it was made from with {number} times its meters_per_unit"),
        _ => format!("meters_per_unit = {number} (or --meters-per-unit {number}){called}"),
    };
    format!("its unit seems to be another, for {because}; with {key}, {then}")
}

/// A number in as few digits as it has.
fn plain(number: f64) -> String {
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    rounded.to_string()
}
