//! A small picture of a view's geometry, for people to see why it was rejected.

use crate::picture::{Picture, byte, from_pixels};
use enfilade_frame::{Frame, Layer};

/// Distance at which surfaces are half as bright as at the camera, metres.
const HALF_BRIGHT_M: f64 = 3.0;

/// Side of the squares of the checkerboard that shows transparency, pixels.
const SQUARE: u32 = 8;

/// The geometry of a look: surfaces in the colours of their normals, darker with distance; backs of things that have a front red; a dark
/// chessboard where there is nothing.
///
/// # Panics
/// When a layer that `Look` has is missing, or `wrong_side` is not of the frame's size.
pub fn thumbnail(frame: &Frame, wrong_side: &[bool]) -> Picture {
    let distances = frame.get(Layer::DepthMeters).expect("a look has distances");
    let normals = frame.get(Layer::NormalWorld).expect("a look has normals");
    from_pixels(frame.width, frame.height, |i| {
        let distance_m = distances.get(i);
        if !distance_m.is_finite() {
            let (x, y) = (i as u32 % frame.width / SQUARE, i as u32 / frame.width / SQUARE);
            let grey = if (x + y) % 2 == 0 { 24 } else { 44 };
            return [grey, grey, grey, 255];
        }
        let light = 0.25 + 0.75 * (-distance_m * std::f64::consts::LN_2 / HALF_BRIGHT_M).exp();
        let shade = |axis: usize| light * (0.5 + 0.5 * normals.get(3 * i + axis));
        match wrong_side[i] {
            true => [byte(0.3 + 0.7 * light), byte(0.3 * shade(1)), byte(0.3 * shade(2)), 255],
            false => [byte(shade(0)), byte(shade(1)), byte(shade(2)), 255],
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_testroom as testroom;

    #[test]
    fn void_backs_and_surfaces_are_told_apart() {
        let frame = testroom::frame(&testroom::pose());
        let ids = frame.get(Layer::RenderEntityId).unwrap();
        let of = |id: f64| (0..ids.len()).find(|&i| ids.get(i) == id).unwrap();
        let (void, floor, wall) = (of(-1.0), of(1.0), of(2.0));
        let wrong: Vec<bool> = (0..ids.len()).map(|i| i == wall).collect();
        let picture = thumbnail(&frame, &wrong);
        let pixel = |i: usize| picture.get_pixel(i as u32 % frame.width, i as u32 / frame.width).0;
        assert!(pixel(void)[..3].iter().all(|v| *v == 24 || *v == 44));
        assert!(pixel(wall)[0] > 2 * pixel(wall)[1]);
        assert!(pixel(floor)[2] > pixel(floor)[0] && pixel(floor)[0] == pixel(floor)[1]);
    }
}
