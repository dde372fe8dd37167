//! Colours for numbers.

use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::mesh_names::{INSTANCE_COLORS, SEMANTIC_COLORS};
use enfilade_dataset::{Dataset, DatasetError, Elements, instance_colors, semantic_colors};
use enfilade_frame::{Validity, traits};
use enfilade_scene::NYU40;
use std::sync::LazyLock;

/// The viridis colour map (Smith & van der Walt, matplotlib 1.5, CC0) at tenths, sRGB.
const VIRIDIS: [[u8; 3]; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];

/// Viridis at `t` on `[0,1]`, within two steps of 255 of the original: linear between its tenths.
pub fn viridis(t: f64) -> [u8; 3] {
    let place = t.clamp(0.0, 1.0) * 10.0;
    let below = (place.floor() as usize).min(9);
    let fraction = place - below as f64;
    std::array::from_fn(|c| {
        let (low, high) = (f64::from(VIRIDIS[below][c]), f64::from(VIRIDIS[below + 1][c]));
        (low + (high - low) * fraction).round() as u8
    })
}

/// Colours of classes and instances, sRGB; row `i` is number `i`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelPalette {
    classes: Vec<[u8; 3]>,
    instances: Vec<[u8; 3]>,
}

impl LabelPalette {
    /// The palette of scenes without tables: NYU40's colours, and the first colours of our tables of instances.
    pub fn usual() -> &'static Self {
        static USUAL: LazyLock<LabelPalette> = LazyLock::new(|| LabelPalette {
            classes: semantic_colors().into_iter().map(rgb8).collect(),
            instances: instance_colors(i16::MAX as usize).into_iter().map(rgb8).collect(),
        });
        &USUAL
    }

    /// The colours that the tables of a scene's mesh folder have, or the usual ones where there is no table.
    ///
    /// # Errors
    /// When a table is damaged.
    pub fn of_scene(dataset: &Dataset, scene: &str) -> Result<Self, DatasetError> {
        let table = |name: &str, usual: &[[u8; 3]]| match read_array(&dataset.layout().mesh_file(scene, name)) {
            Ok(array) => match array.values {
                Elements::I64(values) => Ok(values.chunks_exact(3).map(|c| rgb8([c[0], c[1], c[2]])).collect()),
                _ => Ok(usual.to_vec()),
            },
            Err(error) if error.is_not_found() => Ok(usual.to_vec()),
            Err(error) => Err(error),
        };
        let usual = Self::usual();
        Ok(Self { classes: table(SEMANTIC_COLORS, &usual.classes)?, instances: table(INSTANCE_COLORS, &usual.instances)? })
    }

    /// The colour of a class; black for every number that is none.
    pub fn class(&self, semantic: i16) -> [u8; 3] {
        row(&self.classes, semantic)
    }

    /// The colour of an instance; black for every number that is none.
    pub fn instance(&self, instance: i16) -> [u8; 3] {
        row(&self.instances, instance)
    }
}

fn row(colors: &[[u8; 3]], number: i16) -> [u8; 3] {
    usize::try_from(number).ok().filter(|&i| i > 0).and_then(|i| colors.get(i)).copied().unwrap_or_default()
}

fn rgb8(color: [i64; 3]) -> [u8; 3] {
    color.map(|channel| channel.clamp(0, 255) as u8)
}

/// A colour for a part or instance number, the same in every image; numbers close to each other get colours far apart.
///
/// Black for numbers below 1. Hues advance by the golden ratio; lightness and saturation change with it at a slower beat.
pub fn id_color(id: i16) -> [u8; 3] {
    if id < 1 {
        return [0, 0, 0];
    }
    let n = f64::from(id);
    let hue = (n * 0.618_033_988_749_894_9).fract();
    let value = [0.95, 0.72, 0.84][id as usize % 3];
    let saturation = [0.62, 0.78, 0.46][id as usize / 3 % 3];
    hsv(hue, saturation, value)
}

/// NYU40's colour of a class; black for every number that is none.
pub fn semantic_color(semantic: i16) -> [u8; 3] {
    NYU40.iter().find(|class| class.id == semantic).map_or([0, 0, 0], |class| class.color)
}

/// A colour for a reason code of the `valid` layer: black for void, green for valid, red for saturated, blue for no diffuse
/// reflectance, magenta for every other number.
pub fn validity_color(code: u8) -> [u8; 3] {
    match code {
        c if c == Validity::Void as u8 => [0, 0, 0],
        c if c == Validity::Valid as u8 => [102, 168, 106],
        c if c == Validity::Saturated as u8 => [222, 74, 60],
        c if c == Validity::NoDiffuse as u8 => [70, 118, 190],
        _ => [255, 0, 255],
    }
}

/// A colour for the bits of the `surface_traits` layer: grey for none, else blue for mirrors, cyan for glass, yellow for emitters, magenta for
/// backs; what shows more than one part is lighter.
pub fn traits_color(bits: u8) -> [u8; 3] {
    let base: [u8; 3] = match bits {
        b if b & traits::EMITTER != 0 => [230, 190, 60],
        b if b & traits::GLASS != 0 => [60, 170, 180],
        b if b & traits::MIRROR != 0 => [60, 90, 190],
        b if b & traits::BACK != 0 => [190, 60, 160],
        b if b & traits::MOVES != 0 => [230, 120, 50],
        _ => [90, 90, 90],
    };
    if bits & traits::PARTIAL == 0 { base } else { base.map(|v| v / 2 + 127) }
}

/// The colour of a direction in the image (radians, from x towards y) and a length in `[0,1]`: hue and saturation.
pub fn direction_color(angle_rad: f64, share: f64) -> [u8; 3] {
    hsv((angle_rad / std::f64::consts::TAU).rem_euclid(1.0), share.clamp(0.0, 1.0), 1.0)
}

fn hsv(hue: f64, saturation: f64, value: f64) -> [u8; 3] {
    // Foley et al., "Computer Graphics", in the form f(n) = v − v·s·max(0, min(k, 4 − k, 1)), k = (n + 6h) mod 6.
    [5.0, 3.0, 1.0].map(|n: f64| {
        let k = (n + 6.0 * hue) % 6.0;
        (255.0 * (value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0))).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viridis_meets_known_values_of_the_original() {
        assert_eq!(viridis(0.0), [68, 1, 84]);
        assert_eq!(viridis(1.0), [253, 231, 37]);
        assert_eq!(viridis(f64::NEG_INFINITY), [68, 1, 84]);
        // matplotlib: viridis(0.25) = (0.229739, 0.322361, 0.545706), viridis(0.75) = (0.369214, 0.788888, 0.382914)
        for (t, original) in [(0.25, [58.6, 82.2, 139.2]), (0.75, [94.1, 201.2, 97.6])] {
            assert!((0..3).all(|c| (f64::from(viridis(t)[c]) - original[c]).abs() < 2.5), "{t}: {:?}", viridis(t));
        }
    }

    #[test]
    fn neighbouring_ids_have_clearly_different_colours() {
        for id in 1..300i16 {
            for next in id + 1..id + 5 {
                let distance: i32 = (0..3).map(|c| (i32::from(id_color(id)[c]) - i32::from(id_color(next)[c])).abs()).sum();
                assert!(distance > 40, "{id} {next}: {distance}");
            }
        }
        assert_eq!([id_color(-1), semantic_color(-1), semantic_color(41)], [[0; 3]; 3]);
    }

    #[test]
    fn hsv_gives_primaries() {
        assert_eq!([hsv(0.0, 1.0, 1.0), hsv(1.0 / 3.0, 1.0, 1.0), hsv(2.0 / 3.0, 1.0, 0.8)], [[255, 0, 0], [0, 255, 0], [0, 0, 204]]);
    }
}
