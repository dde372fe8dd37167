//! Kinds of pictures by their texels: opaque, cut out, grey, or a map of normals.

use enfilade_math::DVec3;
use enfilade_scene::{Image, Pixels};

/// True when no texel of the picture is transparent at all.
pub(crate) fn is_opaque(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Rgba8 { texels, .. } => texels.iter().all(|t| t[3] == 255),
        Pixels::RgbF32(_) => true,
    }
}

/// True when a part of the picture is more transparent than not.
pub(crate) fn cuts_out(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Rgba8 { texels, .. } => texels.iter().any(|t| t[3] < 128),
        Pixels::RgbF32(_) => false,
    }
}

/// True when red, green and blue are the same everywhere.
pub(crate) fn is_grey(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Rgba8 { texels, .. } => texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]),
        Pixels::RgbF32(texels) => texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]),
    }
}

/// True when a picture of numbers looks like a map of tangent-space normals: on average they point out of the surface, less than 17°
/// aside, and most of them have lengths of 0.8 to 1.2. Greys and colour pictures, which serve as bump maps too, do not.
pub(crate) fn looks_like_normals(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Rgba8 { texels, .. } => are_normals(texels.iter().map(|t| [t[0], t[1], t[2]].map(|v| f64::from(v) / 255.0))),
        Pixels::RgbF32(texels) => are_normals(texels.iter().map(|t| t.map(f64::from))),
    }
}

fn are_normals(texels: impl ExactSizeIterator<Item = [f64; 3]>) -> bool {
    let total = texels.len();
    let (mut sum, mut unit) = (DVec3::ZERO, 0);
    for texel in texels {
        let normal = 2.0 * DVec3::from(texel) - 1.0;
        sum += normal;
        unit += usize::from((0.8..=1.2).contains(&normal.length()));
    }
    let mean = sum / total.max(1) as f64;
    mean.z > 0.5 && mean.truncate().length() < 0.3 * mean.z && 2 * unit > total
}
