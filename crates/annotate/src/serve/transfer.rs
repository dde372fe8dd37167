//! What every answer gets on its way to the browser: compression, and a tag by which it is not sent twice.
//!
//! The tag is a digest of the bytes that are sent and of what describes them, so a page that asks again for what it has is answered by 304.

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

/// Compresses text, and answers 304 to whom has the same already. Streams and answers that are no success pass as they are.
pub(super) async fn compress_and_tag(request: Request, next: Next) -> Response {
    let reads = request.method() == Method::GET;
    let takes_gzip = reply::takes_gzip(request.headers());
    let known = request.headers().get(header::IF_NONE_MATCH).cloned();
    let response = next.run(request).await;
    if !reads || response.status() != StatusCode::OK || response.body().size_hint().exact().is_none() {
        return response;
    }
    let (mut head, body) = response.into_parts();
    let Ok(bytes) = to_bytes(body, usize::MAX).await else {
        return ApiProblem::failed("the answer was cut short", "ask again").into_response();
    };
    let bytes = if head.headers.contains_key(header::ETAG) {
        bytes
    } else {
        let mut headers = std::mem::take(&mut head.headers);
        let finished = beside(move || {
            let bytes = packed(&mut headers, bytes, takes_gzip);
            let tag = tag_of_answer(&headers, &bytes);
            headers.insert(header::ETAG, tag);
            Ok((headers, bytes))
        });
        match finished.await {
            Ok((headers, bytes)) => {
                head.headers = headers;
                bytes
            }
            Err(problem) => return problem.into_response(),
        }
    };
    if known.zip(head.headers.get(header::ETAG)).is_some_and(|(known, tag)| lists(&known, tag)) {
        head.status = StatusCode::NOT_MODIFIED;
        for name in [header::CONTENT_LENGTH, header::CONTENT_ENCODING, header::CONTENT_TYPE] {
            head.headers.remove(name);
        }
        return Response::from_parts(head, Body::empty());
    }
    head.headers.remove(header::CONTENT_LENGTH);
    Response::from_parts(head, Body::from(bytes))
}

/// The bytes, as gzip where they are text and that makes them smaller; the headers say which.
fn packed(headers: &mut HeaderMap, bytes: Bytes, takes_gzip: bool) -> Bytes {
    let kind = headers.get(header::CONTENT_TYPE).and_then(|kind| kind.to_str().ok()).unwrap_or("");
    if headers.contains_key(header::CONTENT_ENCODING) || !is_text(kind) {
        return bytes;
    }
    headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
    let Some(packed) = takes_gzip.then(|| pack(&bytes, LEVEL)).flatten() else { return bytes };
    headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    packed.into()
}

/// True for media types that compression makes much smaller.
pub(super) fn is_text(kind: &str) -> bool {
    kind.starts_with("text/") || ["application/json", "application/javascript", "image/svg+xml"].iter().any(|text| kind.starts_with(text))
}

/// The tag of what is sent and of what describes it.
fn tag_of_answer(headers: &HeaderMap, bytes: &[u8]) -> HeaderValue {
    let mut hasher = blake3::Hasher::new();
    for (name, value) in headers.iter().filter(|(name, _)| name.as_str().starts_with("x-enfilade") || *name == header::CONTENT_ENCODING) {
        hasher.update(name.as_str().as_bytes()).update(value.as_bytes()).update(b"\n");
    }
    reply::tag(&hasher.update(bytes).finalize().to_hex()[..32])
}

/// True if the tags that a browser has include this one.
fn lists(known: &HeaderValue, tag: &HeaderValue) -> bool {
    let has = |one: &str| one == "*" || one.strip_prefix("W/").unwrap_or(one).as_bytes() == tag.as_bytes();
    known.to_str().is_ok_and(|known| known.split(',').map(str::trim).any(has))
}
