//! The colour of every vertex: the mean of the pixels that show it, over all frames.
//!
//! A frame shows a vertex when it projects into the image and the depth that is stored at that pixel is the vertex's. Pixels are larger
//! than points: depth may differ by what the surface's own slope changes within half a pixel.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, planar_m};
use crate::picture::{SHOWN, tone_mapped};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::Layer;
use enfilade_math::DVec3;

/// Colour of vertices that no frame shows: grey, and an alpha of 0.
pub(super) const UNSEEN: [u8; 4] = [128, 128, 128, 0];

/// Relative difference of depth that rounding and smooth normals make, on any surface.
const SAME_DEPTH: f64 = 0.002;

/// Largest relative difference of depth, whatever the slope is.
const SAME_SLOPE: f64 = 0.02;

/// Frames that are read before their colours are added: what bounds the memory.
const AT_ONCE: usize = 16;

/// Red, green, blue and 255 for every vertex, or [`UNSEEN`].
pub(crate) fn colors(selected: &SelectedFrames<'_>, views: &[View<'_>], vertices: &[DVec3]) -> Result<Vec<[u8; 4]>, ExportError> {
    // Red, green, blue and the number of pixels.
    let (mut sums, counted) = (vec![[0u32; 4]; vertices.len()], selected.counted(views.len()));
    for views in views.chunks(AT_ONCE) {
        for shown in selected.each_counted(&counted, views, |view| shown(selected, view, vertices))? {
            for (vertex, [red, green, blue]) in shown {
                let sum = &mut sums[vertex];
                [red, green, blue, 1].into_iter().zip(sum).for_each(|(value, sum)| *sum += u32::from(value));
            }
        }
    }
    let mean = |[red, green, blue, pixels]: [u32; 4]| match pixels {
        0 => UNSEEN,
        _ => {
            let [red, green, blue] = [red, green, blue].map(|sum| ((sum + pixels / 2) / pixels) as u8);
            [red, green, blue, 255]
        }
    };
    Ok(sums.into_iter().map(mean).collect())
}

/// The vertices that a frame shows, and the colours of their pixels; none where the frame has no colour.
fn shown(selected: &SelectedFrames<'_>, view: View<'_>, vertices: &[DVec3]) -> Result<Vec<(usize, [u8; 3])>, ExportError> {
    let calibration = Calibration::of_pinhole(selected, view.track)?;
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH].concat())?;
    if frame.get(Layer::Color).is_none() {
        return Ok(Vec::new());
    }
    let (width, height) = (frame.width as usize, frame.height as usize);
    let depth = Depth { values: planar_m(selected, view, &calibration, &frame)?, width };
    let (picture, camera) = (tone_mapped(selected, view, &frame)?, view.camera());
    let pixel = |vertex: DVec3| {
        let (x, y) = camera.project(vertex)?;
        if !(x >= 0.0 && x < width as f64 && y >= 0.0 && y < height as f64) {
            return None;
        }
        let (origin, world_from_camera) = camera.row_placement(y);
        let to_vertex = world_from_camera.transpose() * (vertex - origin);
        let own = calibration.forward(to_vertex) * to_vertex.length();
        depth.is_of_surface(x as usize, y as usize, own).then_some((x as u32, y as u32))
    };
    let color = |(x, y): (u32, u32)| {
        let [red, green, blue, _] = picture.get_pixel(x, y).0;
        [red, green, blue]
    };
    Ok(vertices.iter().enumerate().filter_map(|(i, &vertex)| Some((i, color(pixel(vertex)?)))).collect())
}

/// Planar depth of a frame, metres.
struct Depth {
    values: Vec<f64>,
    width: usize,
}

impl Depth {
    /// True when the surface that a pixel shows may have this depth within the pixel.
    fn is_of_surface(&self, x: usize, y: usize, own: f64) -> bool {
        let at = x + y * self.width;
        let here = self.values[at];
        // Of the steps to both sides the smaller one is the surface's own; the other may lead to what is before or behind it.
        let step = |before: Option<usize>, after: Option<usize>| {
            let change = |at: Option<usize>| at.and_then(|at| self.values.get(at)).map_or(f64::INFINITY, |there| (there - here).abs());
            let smaller = change(before).min(change(after));
            if smaller.is_finite() { smaller } else { 0.0 }
        };
        let across = step(at.checked_sub(1).filter(|_| x > 0), Some(at + 1).filter(|_| x + 1 < self.width));
        let down = step(at.checked_sub(self.width), Some(at + self.width));
        (own - here).abs() <= (SAME_DEPTH * own + 0.5 * (across + down)).min(SAME_SLOPE * own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_widen_what_a_pixel_shows_and_edges_do_not() {
        // A wall at 2 m, 4 cm before another; a floor that recedes by 3 cm a pixel, in the last row of pixels on.
        let values = vec![2.0, 2.0, 2.04, 2.04, 2.0, 2.0, 2.04, 2.04, 2.03, 2.03, 2.07, 2.07, f64::NAN, f64::NAN, 2.10, 2.10];
        let depth = Depth { values, width: 4 };
        assert!(depth.is_of_surface(0, 0, 2.003) && !depth.is_of_surface(0, 0, 2.01), "a wall seen straight on");
        assert!(!depth.is_of_surface(1, 0, 2.03), "what lies between a wall and the one before it");
        assert!(depth.is_of_surface(2, 2, 2.08) && !depth.is_of_surface(2, 2, 2.1), "a floor");
        assert!(!depth.is_of_surface(0, 3, 2.0), "nothing was hit");
    }
}
