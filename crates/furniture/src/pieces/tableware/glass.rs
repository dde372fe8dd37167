//! Tumblers, wine glasses, flutes and carafes of clear glass, class other prop: turned forms 9.5 to 26 cm high, all of fixed size but for
//! the shoulder of a carafe.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{turned, vessel};
use crate::pieces::{CONTACT, Furniture};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec3};

/// Glasses and carafes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Drinkware {
    Tumbler,
    Wine,
    Flute,
    Carafe,
}

/// A foot and a stem below a bowl that begins at `height`.
fn stem(radius: f32, height: f32) -> Vec<[f32; 2]> {
    vec![
        [0.0, 0.0],
        [radius, 0.0],
        [radius, 0.0012],
        [0.5 * radius, 0.004],
        [0.0045, 0.012],
        [0.0036, 0.03],
        [0.0036, height - 0.012],
        [0.008, height - 0.002],
    ]
}

impl Furniture for Drinkware {
    fn random(rng: &mut Rng) -> Self {
        [Self::Tumbler, Self::Tumbler, Self::Wine, Self::Flute, Self::Carafe][rng.below(5)]
    }

    fn size(&self) -> Vec3 {
        match self {
            Self::Tumbler => Vec3::new(0.078, 0.078, 0.095),
            Self::Wine => Vec3::new(0.088, 0.088, 0.21),
            Self::Flute => Vec3::new(0.07, 0.07, 0.22),
            Self::Carafe => Vec3::new(0.11, 0.11, 0.26),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let name = if *self == Self::Carafe { "carafe" } else { "glass" };
        let object = b.object(name, Class::OtherProp, pose);
        let mesh = match self {
            Self::Tumbler => vessel(&[[0.029, 0.0], [0.031, 0.004], [0.034, 0.05], [0.0385, 0.095]], 0.0018, 36),
            Self::Wine => {
                let mut profile = stem(0.036, 0.09);
                profile.extend([[0.028, 0.103], [0.042, 0.128], [0.0435, 0.15], [0.036, 0.205]]);
                profile.extend([[0.0350, 0.2053], [0.0423, 0.15], [0.0408, 0.129], [0.027, 0.105], [0.0, 0.0945]]);
                turned(&profile, 40)
            }
            Self::Flute => {
                let mut profile = stem(0.033, 0.085);
                profile.extend([[0.016, 0.10], [0.024, 0.14], [0.0255, 0.17], [0.023, 0.218]]);
                profile.extend([[0.022, 0.2183], [0.0243, 0.17], [0.0228, 0.14], [0.015, 0.102], [0.0, 0.09]]);
                turned(&profile, 36)
            }
            Self::Carafe => {
                let shoulder = rng.range(0.05, 0.055);
                vessel(&[[0.046, 0.0], [shoulder, 0.02], [0.052, 0.08], [0.03, 0.15], [0.022, 0.2], [0.027, 0.255]], 0.0022, 44)
            }
        };
        b.part(&object, "body", mesh.moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::DrinkingGlass);
    }
}
