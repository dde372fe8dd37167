//! Linear colour with Rec. 709 primaries, componentwise arithmetic on it, and the sRGB encoding.

use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Sub};

/// Linear RGB with Rec. 709 (sRGB) primaries: radiance, irradiance, reflectance or throughput.
///
/// ```
/// use enfilade_math::Rgb;
///
/// let irradiance = Rgb::new(3.0, 2.0, 1.0);
/// let reflectance = Rgb::splat(0.5);
/// assert_eq!(irradiance * reflectance, Rgb::new(1.5, 1.0, 0.5));
/// assert_eq!(Rgb::WHITE.luminance(), 1.0);
///
/// // Middle grey of a screen is a fifth of the light of white.
/// let grey = Rgb::from_srgb8([127; 3]);
/// assert!((grey.g - 0.2122).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// (0, 0, 0).
    pub const BLACK: Self = Self::splat(0.0);
    /// (1, 1, 1).
    pub const WHITE: Self = Self::splat(1.0);

    /// From three components.
    #[inline]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// A grey.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// From sRGB-encoded bytes.
    pub fn from_srgb8(rgb: [u8; 3]) -> Self {
        let [r, g, b] = rgb.map(|c| linear_from_srgb(f32::from(c) / 255.0));
        Self::new(r, g, b)
    }

    /// Linear Rec. 709 of CIE XYZ with Y = 1 for white; what is out of gamut is cut to zero.
    pub fn from_xyz([x, y, z]: [f64; 3]) -> Self {
        let channel = |a: f64, b: f64, c: f64| (a * x + b * y + c * z).max(0.0) as f32;
        Self::new(channel(3.240_97, -1.537_38, -0.498_61), channel(-0.969_24, 1.875_97, 0.041_56), channel(0.055_63, -0.203_98, 1.056_97))
    }

    /// Relative luminance, Rec. 709 weights.
    #[inline]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// The largest component.
    #[inline]
    pub fn max_component(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// True when every component is exactly zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self == Self::BLACK
    }

    /// True when no component is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// Applies `f` to each component.
    #[inline]
    #[must_use]
    pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// Linear interpolation: `self` at t = 0, `other` at t = 1.
    #[inline]
    #[must_use]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self * (1.0 - t) + other * t
    }

    /// The channels as an array: red, green, blue.
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }
}

impl From<[f32; 3]> for Rgb {
    #[inline]
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self::new(r, g, b)
    }
}

impl Index<usize> for Rgb {
    type Output = f32;
    #[inline]
    fn index(&self, channel: usize) -> &f32 {
        match channel {
            0 => &self.r,
            1 => &self.g,
            2 => &self.b,
            _ => panic!("an Rgb has channels 0 to 2, asked for {channel}"),
        }
    }
}

macro_rules! componentwise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Rgb {
            type Output = Self;
            #[inline]
            fn $method(self, o: Self) -> Self {
                Self::new(self.r $op o.r, self.g $op o.g, self.b $op o.b)
            }
        }
    };
}
componentwise!(Add, add, +);
componentwise!(Sub, sub, -);
componentwise!(Mul, mul, *);
componentwise!(Div, div, /);

impl Mul<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, s: f32) -> Self {
        Self::new(self.r * s, self.g * s, self.b * s)
    }
}

impl Mul<Rgb> for f32 {
    type Output = Rgb;
    #[inline]
    fn mul(self, c: Rgb) -> Rgb {
        c * self
    }
}

impl Div<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn div(self, s: f32) -> Self {
        self * (1.0 / s)
    }
}

impl AddAssign for Rgb {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl MulAssign for Rgb {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl MulAssign<f32> for Rgb {
    #[inline]
    fn mul_assign(&mut self, s: f32) {
        *self = *self * s;
    }
}

impl std::iter::Sum for Rgb {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::BLACK, Add::add)
    }
}

/// Linear value of an sRGB-encoded one (IEC 61966-2-1), both on `[0,1]`.
pub fn linear_from_srgb(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// sRGB encoding of a linear value (IEC 61966-2-1), both on `[0,1]`.
pub fn srgb_from_linear(v: f32) -> f32 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_encoding_round_trips() {
        for i in 0..=255u8 {
            let v = f32::from(i) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(v)) - v).abs() < 1e-5);
        }
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-5);
    }
}
