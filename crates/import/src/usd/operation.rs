//! Operations on transforms (`xformOp`), and what their numbers mean.

use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};

/// What an operation's numbers mean.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Translate,
    /// Along one axis.
    TranslateAlong(DVec3),
    Scale,
    /// Along one axis.
    ScaleAlong(DVec3),
    /// About one axis.
    RotateAbout(DVec3),
    /// About three axes, the first one first.
    Rotate([DVec3; 3]),
    /// A quaternion, its real part first.
    Orient,
    /// A matrix for row vectors, row by row.
    Matrix,
}

impl Kind {
    /// The kind of an operation's attribute.
    pub(super) fn named(attribute: &str) -> Option<Self> {
        let kind = attribute.strip_prefix("xformOp:")?.split(':').next()?;
        let axis = |letter: &str| match letter {
            "X" => Some(DVec3::X),
            "Y" => Some(DVec3::Y),
            "Z" => Some(DVec3::Z),
            _ => None,
        };
        match kind {
            "translate" => return Some(Self::Translate),
            "scale" => return Some(Self::Scale),
            "orient" => return Some(Self::Orient),
            "transform" => return Some(Self::Matrix),
            _ => (),
        }
        if let Some(letter) = kind.strip_prefix("translate") {
            return Some(Self::TranslateAlong(axis(letter)?));
        }
        if let Some(letter) = kind.strip_prefix("scale") {
            return Some(Self::ScaleAlong(axis(letter)?));
        }
        let letters = kind.strip_prefix("rotate")?;
        if letters.len() == 1 {
            return Some(Self::RotateAbout(axis(letters)?));
        }
        let axes: Vec<DVec3> = letters.split("").filter(|l| !l.is_empty()).map(axis).collect::<Option<_>>()?;
        axes.try_into().ok().map(Self::Rotate)
    }

    /// Numbers that it takes.
    pub(super) fn width(self) -> usize {
        match self {
            Self::TranslateAlong(_) | Self::ScaleAlong(_) | Self::RotateAbout(_) => 1,
            Self::Translate | Self::Scale | Self::Rotate(_) => 3,
            Self::Orient => 4,
            Self::Matrix => 16,
        }
    }

    /// The transform of as many numbers as it takes.
    pub(super) fn matrix(self, v: &[f64]) -> DAffine3 {
        let vector = |at: usize| DVec3::new(v[at], v[at + 1], v[at + 2]);
        match self {
            Self::Translate => DAffine3::from_translation(vector(0)),
            Self::TranslateAlong(axis) => DAffine3::from_translation(axis * v[0]),
            Self::Scale => DAffine3::from_scale(vector(0)),
            Self::ScaleAlong(axis) => DAffine3::from_scale(DVec3::ONE - axis + axis * v[0]),
            Self::RotateAbout(axis) => DAffine3::from_axis_angle(axis, v[0].to_radians()),
            // The first letter turns first.
            Self::Rotate(axes) => axes
                .into_iter()
                .fold(DAffine3::IDENTITY, |matrix, about| DAffine3::from_axis_angle(about, vector(0).dot(about).to_radians()) * matrix),
            Self::Orient => DAffine3::from_mat3(rotation([v[0], v[1], v[2], v[3]])),
            Self::Matrix => DAffine3::from_mat3_translation(DMat3::from_cols(vector(0), vector(4), vector(8)), vector(12)),
        }
    }
}

/// The rotation of a quaternion, its real part first, which need not be of unit length; a zero one turns nothing.
pub(super) fn rotation(q: [f64; 4]) -> DMat3 {
    DMat3::from_quat(quaternion(q))
}

/// The quaternion of unit length that turns as one of any length does.
pub(super) fn quaternion([w, x, y, z]: [f64; 4]) -> DQuat {
    let q = DQuat::from_xyzw(x, y, z, w);
    if q.length_squared() > 0.0 && q.is_finite() { q.normalize() } else { DQuat::IDENTITY }
}
