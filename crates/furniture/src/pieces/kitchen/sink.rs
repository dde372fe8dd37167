//! An inset kitchen sink of steel, ceramic or black composite, with its waste and a mixer tap 25 to 36 cm high, of class sink. The bowl is
//! as wide as its unit allows. The space's origin is on the worktop, in the middle of the unit: y is the distance from the wall, the bowl
//! is below z = 0.

use super::front::KitchenStyle;
use crate::builder::{Builder, Class};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::CONTACT;
use crate::pieces::bathroom::tap::{LIFT, stand};
use crate::pieces::form::{all, cylinder, loft, rod, turned, wire};
use crate::shape::{Reshape, rounded_box};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec3};

/// Opening that the worktop needs for a sink in a unit of this width, from its middle: half width, and depths from the wall.
pub fn cut_out(width: f32) -> [f32; 3] {
    [0.5 * width.min(0.8) - 0.07, 0.125, 0.515]
}

/// Adds an inset sink with its mixer. The pose is on the worktop, in the middle of the unit at the wall.
pub fn build(b: &mut Builder, pose: DAffine3, width: f32, style: &KitchenStyle, rng: &mut Rng) {
    let [half, back, front] = cut_out(width);
    let (w, d, drop) = (2.0 * half - 0.004, front - back - 0.004, 0.185);
    let middle = Vec3::new(0.0, 0.5 * (back + front), 0.0);
    let sink = b.object("sink", Class::Sink, pose);
    let stone = !style.steel && rng.below(3) == 0;
    let finish = if stone { [Finish::Porcelain, Finish::BlackPlastic][rng.below(2)] } else { Finish::Steel };
    let rim = if stone { 0.016 } else { 0.010 };
    let bowl = loft(
        &[
            [w - 0.05, d - 0.05, 0.05, -drop - 0.002],
            [w - 0.004, d - 0.004, 0.03, -drop + 0.03],
            [w, d, 0.03, -0.001],
            [w, d, 0.03, CONTACT],
            [w + 2.0 * rim, d + 2.0 * rim, 0.035, CONTACT],
            [w + 2.0 * rim, d + 2.0 * rim, 0.035, 0.0025],
            [w + 2.0 * rim - 0.003, d + 2.0 * rim - 0.003, 0.034, 0.0035],
            [w - 0.006, d - 0.006, 0.03, 0.0035],
            [w - 0.012, d - 0.012, 0.03, -0.002],
            [w - 0.02, d - 0.02, 0.035, -drop + 0.03],
            [w - 0.035, d - 0.035, 0.045, -drop + 0.008],
            [w - 0.08, d - 0.08, 0.05, -drop],
        ],
        5,
    );
    b.part(&sink, "bowl", bowl.moved(middle), finish);
    let waste = turned(&[[0.0, 0.0], [0.043, 0.0], [0.043, 0.002], [0.03, 0.0025], [0.026, 0.001], [0.0, 0.001]], 32);
    b.part(&sink, "waste", waste.moved(middle + Vec3::new(0.0, 0.0, CONTACT - drop)), Finish::Chrome);
    let metal = if style.metal == Finish::Steel { Finish::Chrome } else { style.metal };
    stand(b, &sink, "mixer", mixer(rng), Vec3::new(0.0, 0.075, 0.0), metal);
}

/// A mixer tap that stands on z = 0 and reaches to +y, a swan neck or a straight arm; its lever at +x, and how that moves.
fn mixer(rng: &mut Rng) -> (Mesh, Mesh, Joint) {
    let (height, reach) = (rng.range(0.25, 0.36), rng.range(0.18, 0.22));
    let base = cylinder(0.025, 0.008, 28).with(cylinder(0.019, 0.10, 24)).moved(Vec3::new(0.0, 0.0, CONTACT));
    let swan = rng.below(3) > 0;
    let spout = if swan {
        let top = height - 0.5 * reach;
        wire(
            &[
                [0.0, 0.0, 0.09],
                [0.0, 0.0, top],
                [0.0, 0.03, top + 0.4 * reach],
                [0.0, 0.5 * reach, height],
                [0.0, reach - 0.03, top + 0.4 * reach],
                [0.0, reach, top],
                [0.0, reach, top - 0.04],
            ],
            0.0115,
            14,
        )
    } else {
        all([
            rod([0.0, 0.0, 0.09], [0.0, 0.0, height - 0.06], 0.0125, 16),
            rounded_box(Vec3::new(0.025, reach + 0.015, 0.02), 0.006, 2).moved(Vec3::new(0.0, 0.5 * reach, height - 0.06)),
            cylinder(0.009, 0.02, 16).moved(Vec3::new(0.0, reach - 0.008, height - 0.085)),
        ])
    };
    let lever = rod([0.015, 0.0, 0.07], [0.045, 0.0, 0.07], 0.012, 14).with(rod([0.038, 0.0, 0.075], [0.052, 0.0, 0.155], 0.0045, 10));
    (all([base, spout]), lever, Joint::tap(0.0, 0.07, LIFT, false))
}
