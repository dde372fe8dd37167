//! Added to every answer on its way to the browser: compression, and a tag so that it is not sent twice.
//!
//! An answer made of files already has a tag, of their lengths and times ([`reply::tag_of`]), and passes unchanged. The tag of any other is
//! a digest of the bytes sent and of their headers. A page that asks again for content that it has is answered by 304.

use super::ApiProblem;
use super::jobs::beside;
use super::reply::{self, pack};
use axum::body::{Body, Bytes, HttpBody, to_bytes};
use axum::extract::Request;
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// Text is compressed at this level of 12: a few milliseconds for a megabyte.
const LEVEL: i32 = 6;

/// Compresses text, and answers 304 to whom has the same already. Streams without a tag and answers that are no success pass as they are.
pub(super) async fn compress_and_tag(request: Request, next: Next) -> Response {
    let reads = request.method() == Method::GET;
    let asked = request.headers().clone();
    let mut response = next.run(request).await;
    if !reads || response.status() != StatusCode::OK {
        return response;
    }
    if !response.headers().contains_key(header::ETAG) {
        if response.body().size_hint().exact().is_none() {
            return response;
        }
        response = match packed_and_tagged(response, reply::takes_gzip(&asked)).await {
            Ok(response) => response,
            Err(problem) => return problem.into_response(),
        };
    }
    if response.headers().get(header::ETAG).is_some_and(|tag| reply::has(&asked, tag)) {
        return unchanged(response);
    }
    response
}

/// An answer that is in memory, packed where that helps, with the digest of its bytes as its tag.
async fn packed_and_tagged(response: Response, takes_gzip: bool) -> Result<Response, ApiProblem> {
    let (mut head, body) = response.into_parts();
    let bytes = to_bytes(body, usize::MAX).await.map_err(|_| ApiProblem::failed("the answer was cut short", "ask again"))?;
    beside(move || {
        let bytes = packed(&mut head.headers, bytes, takes_gzip);
        let tag = tag_of_answer(&head.headers, &bytes);
        head.headers.insert(header::ETAG, tag);
        head.headers.remove(header::CONTENT_LENGTH);
        Ok(Response::from_parts(head, Body::from(bytes)))
    })
    .await
}

/// The answer to whom has the same already.
fn unchanged(response: Response) -> Response {
    let (mut head, _) = response.into_parts();
    head.status = StatusCode::NOT_MODIFIED;
    for name in [header::CONTENT_LENGTH, header::CONTENT_ENCODING, header::CONTENT_TYPE] {
        head.headers.remove(name);
    }
    Response::from_parts(head, Body::empty())
}

/// The bytes, as gzip if they are text and that makes them smaller; the headers state which.
fn packed(headers: &mut HeaderMap, bytes: Bytes, takes_gzip: bool) -> Bytes {
    let kind = headers.get(header::CONTENT_TYPE).and_then(|kind| kind.to_str().ok()).unwrap_or("");
    if headers.contains_key(header::CONTENT_ENCODING) || !reply::is_text(kind) {
        return bytes;
    }
    headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
    let Some(packed) = takes_gzip.then(|| pack(&bytes, LEVEL)).flatten() else { return bytes };
    headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    packed.into()
}

/// The tag of what is sent and of what describes it.
fn tag_of_answer(headers: &HeaderMap, bytes: &[u8]) -> HeaderValue {
    let mut hasher = blake3::Hasher::new();
    for (name, value) in headers.iter().filter(|(name, _)| name.as_str().starts_with("x-enfilade") || *name == header::CONTENT_ENCODING) {
        hasher.update(name.as_str().as_bytes()).update(value.as_bytes()).update(b"\n");
    }
    reply::tag(&hasher.update(bytes).finalize().to_hex()[..32])
}
