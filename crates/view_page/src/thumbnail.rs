//! Small pictures of frames, for the strip below the picture.

use super::place::{FramePlace, stamp, version};
use super::viewer::{Viewer, work};
use axum::extract::rejection::QueryRejection;
use axum::extract::{Path, Query, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use enfilade_frame::Layer;
use enfilade_serve::{ApiProblem, reply};
use enfilade_show::palette::viridis;
use enfilade_show::picture::{Picture, jpeg};
use serde::Deserialize;
use std::sync::Arc;

/// Width of a thumbnail, pixels.
const WIDTH: usize = 160;

/// The query of a request for a thumbnail.
#[derive(Debug, Default, Deserialize)]
pub struct ThumbnailQuery {
    /// The version from the gallery: while the file has it, browsers keep the picture without asking again.
    v: Option<String>,
}

/// `GET /api/view/thumbnail/{scene}/{camera}/{frame}`: a JPEG of color, or of depth where there is no color.
pub async fn thumbnail(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera, frame)): Path<(String, String, String)>,
    query: Result<Query<ThumbnailQuery>, QueryRejection>,
) -> Result<Response, ApiProblem> {
    let place = FramePlace::parse([scene, camera, frame])?;
    let asked = query.map_err(|e| ApiProblem::bad_request(e.body_text(), "v is the version given by the gallery"))?.0.v;
    let (bytes, version, kept) = work(viewer, move |viewer| {
        let layer = viewer.color_layer(&place).unwrap_or(Layer::DepthMeters);
        let path = viewer.layout().layer(&place.scene, &place.camera, place.frame, layer);
        viewer.allow(&path)?;
        let picture = viewer.thumbnails.get(&place, stamp(&path), || viewer.small_picture(&place, layer))?;
        let version = version(&path);
        let kept = asked.is_some_and(|asked| asked == version);
        Ok((picture.to_vec(), version, kept))
    })
    .await?;
    let cached = if kept { "private, max-age=31536000, immutable" } else { "no-cache" };
    let told = [(header::CONTENT_TYPE, "image/jpeg"), (header::CACHE_CONTROL, cached)];
    Ok((told, [(header::ETAG, reply::tag(&version))], bytes).into_response())
}

impl Viewer {
    fn small_picture(&self, place: &FramePlace, layer: Layer) -> Result<Vec<u8>, ApiProblem> {
        let decoded = self.layer(place, layer)?;
        let [height, width, _] = decoded.shape;
        if width == 0 || height == 0 {
            return Err(ApiProblem::failed("the frame has no pixels", "make it again"));
        }
        let colors = match layer {
            Layer::Color | Layer::ColorRendered => self.tone_mapped(place, height * width)?.unwrap_or_default(),
            _ => {
                let [low, high] = [1, 5].map(|i| decoded.summary.percentiles.get(i).copied().unwrap_or_default());
                let share = |i: usize| (decoded.number(i) - low) / (high - low).max(1e-9);
                (0..height * width).map(|i| if share(i).is_nan() { [0; 3] } else { viridis(share(i)) }).collect()
            }
        };
        let step = width.div_ceil(WIDTH).max(1);
        let small = Picture::from_fn(width.div_ceil(step) as u32, height.div_ceil(step) as u32, |x, y| {
            let block = |side: usize, at: u32| at as usize * step..((at as usize + 1) * step).min(side);
            let (mut sum, mut count) = ([0u32; 3], 0);
            for (row, column) in block(height, y).flat_map(|row| block(width, x).map(move |column| (row, column))) {
                let color = colors[row * width + column];
                (0..3).for_each(|c| sum[c] += u32::from(color[c]));
                count += 1;
            }
            let [r, g, b] = sum.map(|channel| (channel / count) as u8);
            image::Rgba([r, g, b, 255])
        });
        Ok(jpeg(&small))
    }
}
