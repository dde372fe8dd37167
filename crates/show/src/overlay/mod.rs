//! Boxes drawn over a picture, with true occlusion.
//!
//! Every edge is followed in small steps through the camera that took the picture, for every camera model, and compared with the frame's
//! `depth_meters`: parts behind the visible surface are dashed and faint. Hypersim's toolkit draws its overlays with a centred pinhole of
//! 60 degrees for every camera.

use stencil::Stencil;
mod stencil;

use crate::picture::Picture;
use crate::sheet::canvas::{Canvas, Color};
use crate::sheet::lettering::{self, Style};
use enfilade_frame::Values;
use enfilade_math::{DVec3, OrientedBox};
use enfilade_scene::CameraView;

/// An edge counts as hidden when the surface seen is nearer than this share of its distance, and [`SLACK_M`].
const SLACK: f64 = 0.01;
/// Sides that are on a surface count as visible, metres.
const SLACK_M: f64 = 0.01;
/// Length of a dash and of the gap after it, in widths of the line.
const DASH: f32 = 3.0;
const HIDDEN_OPACITY: f32 = 0.5;
/// Pieces that an edge has at least; those that are still long in the image are halved, so often at most.
const PIECES: u32 = 16;
const HALVINGS: u32 = 10;
/// Pieces are straight where they are this short, pixels.
const STRAIGHT_PX: f64 = 3.0;

/// A box to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnBox {
    /// Position, orientation and size.
    pub shape: OrientedBox,
    /// Colour of the edges.
    pub color: Color,
    /// Text at its upper corner; empty for none.
    pub text: String,
}

/// A piece of an edge in the image.
struct Piece {
    from: [f32; 2],
    to: [f32; 2],
    hidden: bool,
    /// Length of the edge up to here, pixels.
    start: f32,
}

/// `picture` with `boxes` drawn over it, nearer ones over farther ones.
///
/// `depth` is the frame's `depth_meters`, in pixels like the picture's.
pub fn draw_boxes(picture: &Picture, depth: &Values, view: &CameraView<'_>, boxes: &[DrawnBox]) -> Picture {
    let mut canvas = Canvas::over(picture.clone());
    let radius = (picture.height() as f32 / 420.0).max(0.8);
    let mut order: Vec<&DrawnBox> = boxes.iter().collect();
    order.sort_by(|a, b| distance(view, b.shape.center).total_cmp(&distance(view, a.shape.center)));
    let mut stencil = Stencil::new(picture.width(), picture.height());
    let traced: Vec<Vec<Piece>> = order.iter().map(|b| trace_box(depth, view, &b.shape)).collect();
    for (drawn, pieces) in order.iter().zip(&traced) {
        for piece in pieces.iter().filter(|piece| piece.hidden && piece.start % (4.0 * DASH * radius) < 2.0 * DASH * radius) {
            stencil.stroke(piece.from, piece.to, 0.75 * radius);
        }
        stencil.blend(&mut canvas, drawn.color, HIDDEN_OPACITY);
    }
    for (drawn, pieces) in order.iter().zip(&traced) {
        let visible = || pieces.iter().filter(|piece| !piece.hidden);
        visible().for_each(|piece| stencil.stroke(piece.from, piece.to, radius + 1.0));
        stencil.blend(&mut canvas, [16, 16, 18], 0.55);
        visible().for_each(|piece| stencil.stroke(piece.from, piece.to, radius));
        stencil.blend(&mut canvas, drawn.color, 1.0);
    }
    let mut taken: Vec<[f32; 4]> = Vec::new();
    for (drawn, pieces) in order.iter().zip(&traced).rev() {
        write_text(&mut canvas, drawn, pieces, &mut taken);
    }
    canvas.into_picture()
}

fn distance(view: &CameraView<'_>, p: DVec3) -> f64 {
    view.pose().position.distance(p)
}

/// The pieces of all edges that have a place in the image.
fn trace_box(depth: &Values, view: &CameraView<'_>, shape: &OrientedBox) -> Vec<Piece> {
    let corners = shape.corners();
    let mut pieces = Vec::new();
    for [a, b] in OrientedBox::EDGES {
        let mut length = 0.0;
        for i in 0..PIECES {
            let at = |i: u32| corners[a].lerp(corners[b], f64::from(i) / f64::from(PIECES));
            trace(depth, view, [at(i), at(i + 1)], HALVINGS, &mut length, &mut pieces);
        }
    }
    pieces
}

/// Follows a piece of an edge; halves it where it is long.
fn trace(depth: &Values, view: &CameraView<'_>, [a, b]: [DVec3; 2], halvings: u32, length: &mut f32, pieces: &mut Vec<Piece>) {
    let [width, height] = view.camera().size().map(f64::from);
    let ends = view.project(a).zip(view.project(b));
    let middle = a.midpoint(b);
    let short = ends.is_some_and(|(p, q)| (p.0 - q.0).hypot(p.1 - q.1) < STRAIGHT_PX);
    // Far beyond one side of the image nothing comes back into it.
    let beyond = ends.is_some_and(|(p, q)| {
        let out = |v: f64, w: f64, size: f64| (v < -size && w < -size) || (v > 2.0 * size && w > 2.0 * size);
        out(p.0, q.0, width) || out(p.1, q.1, height)
    });
    if beyond || (halvings == 0 && !short) {
        return;
    }
    if !short {
        trace(depth, view, [a, middle], halvings - 1, length, pieces);
        return trace(depth, view, [middle, b], halvings - 1, length, pieces);
    }
    let Some((p, q)) = ends else { return };
    let point = |(x, y): (f64, f64)| [x as f32, y as f32];
    let at = [0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1)];
    let far = view.row_placement(at[1]).0.distance(middle);
    if let Some(surface) = seen_depth(depth, [width, height], at) {
        pieces.push(Piece { from: point(p), to: point(q), hidden: surface < far * (1.0 - SLACK) - SLACK_M, start: *length });
    }
    *length += (p.0 - q.0).hypot(p.1 - q.1) as f32;
}

/// The farthest surface seen in the pixel at `at` or next to it, so that edges on an outline count as visible; infinite where
/// nothing is seen, `None` outside of the image.
fn seen_depth(depth: &Values, [width, height]: [f64; 2], at: [f64; 2]) -> Option<f64> {
    if !((0.0..width).contains(&at[0]) && (0.0..height).contains(&at[1])) {
        return None;
    }
    let range = |v: f64, size: f64| (v as usize).saturating_sub(1)..=(v as usize + 1).min(size as usize - 1);
    let pixels = range(at[1], height).flat_map(|y| range(at[0], width).map(move |x| y * width as usize + x));
    let seen = pixels.map(|i| depth.get(i)).map(|d| if d.is_nan() { f64::INFINITY } else { d });
    Some(seen.fold(0.0, f64::max))
}

/// Writes the text of a box beside its highest visible point, unless that place is taken.
fn write_text(canvas: &mut Canvas, drawn: &DrawnBox, pieces: &[Piece], taken: &mut Vec<[f32; 4]>) {
    let highest = pieces.iter().filter(|piece| !piece.hidden).min_by(|a, b| a.from[1].total_cmp(&b.from[1]));
    let Some(Piece { from: [x, y], .. }) = highest.filter(|_| !drawn.text.is_empty()) else { return };
    let bright = 0.299 * f32::from(drawn.color[0]) + 0.587 * f32::from(drawn.color[1]) + 0.114 * f32::from(drawn.color[2]) > 140.0;
    let [width, height] = canvas.size().map(|side| side as f32);
    let style =
        Style { height: (height / 64.0).clamp(6.0, 18.0), weight: 0.12, color: if bright { [16, 16, 18] } else { [250, 250, 248] } };
    let pad = 0.45 * style.height;
    let (w, h) = (lettering::width(&drawn.text, style) + 2.0 * pad, style.height + 2.0 * pad);
    if w > width || h > height {
        return;
    }
    let (left, top) = ((x - 0.5 * w).clamp(0.0, width - w), (y - h - 2.0).clamp(0.0, height - h));
    let overlaps = |o: &[f32; 4]| left < o[2] && o[0] < left + w && top < o[3] && o[1] < top + h;
    if taken.iter().any(overlaps) {
        return;
    }
    taken.push([left, top, left + w, top + h]);
    canvas.fill(left as u32, top as u32, w.ceil() as u32, h.ceil() as u32, drawn.color);
    lettering::draw(canvas, left.floor() + pad, top.floor() + pad + style.height, &drawn.text, style);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::from_pixels;
    use enfilade_math::DMat3;
    use enfilade_scene::{Camera, Intrinsics, Pose, Projection};

    const WALL_M: f64 = 3.0;

    /// A box whose front face is before a wall that fills the picture, and whose back face is behind it.
    fn drawn(camera: &Camera) -> Picture {
        let pose = Pose::look_at(0, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
        let view = CameraView::still(camera, &pose);
        let [width, height] = camera.size();
        let depth = (0..width * height).map(|i| {
            let ray = view.centre_ray(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5).unwrap().direction;
            if ray.y > 0.0 { (WALL_M / ray.y) as f32 } else { f32::NAN }
        });
        let depth = Values::F32(depth.collect());
        let shape = OrientedBox { center: DVec3::Y * 3.0, world_from_box: DMat3::IDENTITY, extents: DVec3::new(1.0, 2.0, 1.0) };
        let black = from_pixels(width, height, |_| [0, 0, 0, 255]);
        draw_boxes(&black, &depth, &view, &[DrawnBox { shape, color: [200, 100, 50], text: "box".into() }])
    }

    #[test]
    fn edges_before_the_wall_are_full_and_edges_behind_it_are_dashed() {
        let camera: Camera = Intrinsics { width: 320, height: 240, fx: 320.0, fy: 320.0, cx: 160.0, cy: 120.0, skew: 0.0 }.into();
        let picture = drawn(&camera);
        // The front face is 160 px wide, the back face 80 px.
        let red = |x: u32, y: u32| picture.get_pixel(x, y).0[0];
        assert!((90..230).all(|x| red(x, 200) > 150), "the lower front edge is drawn through");
        let behind: Vec<u8> = (125..195).map(|x| red(x, 160)).collect();
        assert!(behind.contains(&0) && behind.iter().max().is_some_and(|&m| (60..150).contains(&m)), "{behind:?}");
        assert_eq!(red(160, 120), 0);
    }

    #[test]
    fn panoramas_show_what_is_in_every_direction() {
        let picture = drawn(&Projection::Equirectangular { width: 320, height: 160 }.into());
        assert!(picture.pixels().filter(|p| p.0[0] > 150).count() > 100);
    }
}
