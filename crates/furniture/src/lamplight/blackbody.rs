//! The colour of light that has a colour temperature: lamps, candles, the white that a camera adapts to.

use enfilade_math::Rgb;

/// Linear RGB of unit luminance of a black body of `kelvin`, by Planck's law at 612, 549 and 465 nm relative to 6500 K.
pub fn blackbody(kelvin: f32) -> Rgb {
    let planck = |wavelength_nm: f32, t: f32| 1.0 / ((1.438_777e7 / (wavelength_nm * t)).exp() - 1.0);
    let relative = Rgb::new(612.0, 549.0, 465.0).map(|w| planck(w, kelvin) / planck(w, 6500.0));
    relative / relative.luminance()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warm_white_is_orange_and_daylight_is_grey() {
        let lamp = blackbody(2800.0);
        assert!(lamp.r > 1.3 && lamp.b < 0.5 && (lamp.luminance() - 1.0).abs() < 1e-5, "{lamp:?}");
        let day = blackbody(6500.0);
        assert!((day.r - 1.0).abs() < 1e-5 && (day.b - 1.0).abs() < 1e-5);
    }
}
