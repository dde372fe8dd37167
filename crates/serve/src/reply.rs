//! Successful answers: JSON and arrays, compressed if the browser accepts it and it helps.

use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use axum::response::{IntoResponse, Response};
use libdeflater::{CompressionLvl, Compressor};
use serde::Serialize;

/// Smaller answers fit into one network packet, compressed or not.
const MIN_COMPRESSED_BYTES: usize = 1400;

/// True if the request accepts gzip.
pub fn takes_gzip(headers: &HeaderMap) -> bool {
    let accepted = headers.get(header::ACCEPT_ENCODING).and_then(|value| value.to_str().ok()).unwrap_or("");
    accepted.split(',').any(|one| {
        let mut words = one.split(';').map(str::trim);
        words.next() == Some("gzip") && !words.any(|word| matches!(word, "q=0" | "q=0.0" | "q=0.00" | "q=0.000"))
    })
}

/// A value as JSON.
pub fn json(gzip: bool, value: &impl Serialize) -> Response {
    let text = serde_json::to_vec(value).expect("plain data encodes");
    body(text, "application/json", gzip, 6)
}

/// The bytes of an array, with headers that describe it; `x-enfilade-bytes` is their number before they are compressed, at the fastest level.
pub fn array(bytes: Vec<u8>, gzip: bool, headers: &[(&'static str, String)]) -> Response {
    let length = bytes.len();
    let mut response = body(bytes, "application/octet-stream", gzip, 1);
    response.headers_mut().insert("x-enfilade-bytes", length.into());
    for (name, value) in headers {
        if let Ok(value) = HeaderValue::from_str(value) {
            response.headers_mut().insert(HeaderName::from_static(name), value);
        }
    }
    response
}

fn body(bytes: Vec<u8>, kind: &'static str, gzip: bool, level: i32) -> Response {
    let headers = [(header::CONTENT_TYPE, kind), (header::CACHE_CONTROL, "no-cache"), (header::VARY, "accept-encoding")];
    if gzip && let Some(packed) = pack(&bytes, level) {
        return (headers, [(header::CONTENT_ENCODING, "gzip")], packed).into_response();
    }
    (headers, bytes).into_response()
}

/// The bytes as gzip at a level of 1 to 12; `None` if that saves less than a twentieth, or if they fit into one packet anyway.
pub(super) fn pack(bytes: &[u8], level: i32) -> Option<Vec<u8>> {
    if bytes.len() < MIN_COMPRESSED_BYTES {
        return None;
    }
    let mut compressor = Compressor::new(CompressionLvl::new(level).expect("levels 1 to 12 exist"));
    let mut packed = vec![0; compressor.gzip_compress_bound(bytes.len())];
    let length = compressor.gzip_compress(bytes, &mut packed).ok()?;
    packed.truncate(length);
    (length < bytes.len() / 20 * 19).then_some(packed)
}

/// True for media types that compression makes much smaller.
pub fn is_text(kind: &str) -> bool {
    kind.starts_with("text/") || ["application/json", "application/javascript", "image/svg+xml"].iter().any(|text| kind.starts_with(text))
}

/// True if the tags of what the browser has include this one.
pub fn has(asked: &HeaderMap, tag: &HeaderValue) -> bool {
    let is_it = |one: &str| one == "*" || one.strip_prefix("W/").unwrap_or(one).as_bytes() == tag.as_bytes();
    let known = asked.get(header::IF_NONE_MATCH).and_then(|known| known.to_str().ok());
    known.is_some_and(|known| known.split(',').map(str::trim).any(is_it))
}

/// The entity tag of content that these bytes describe.
pub fn tag_of(bytes: &[u8]) -> HeaderValue {
    tag(&blake3::hash(bytes).to_hex()[..32])
}

/// A digest in hexadecimal digits as an entity tag.
pub fn tag(digest: &str) -> HeaderValue {
    HeaderValue::from_str(&format!("\"{digest}\"")).expect("digits are visible characters")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gzip_is_taken_only_by_those_who_say_so() {
        let takes = |value: &str| takes_gzip(&HeaderMap::from_iter([(header::ACCEPT_ENCODING, HeaderValue::from_str(value).unwrap())]));
        assert!(takes("gzip") && takes("deflate, gzip, br") && takes("br;q=1.0, gzip;q=0.8"));
        assert!(!takes("") && !takes("br") && !takes("gzip;q=0") && !takes("xgzip") && !takes_gzip(&HeaderMap::new()));
    }

    #[test]
    fn only_what_becomes_smaller_is_compressed() {
        let encoded = |bytes: Vec<u8>| array(bytes, true, &[]).headers().contains_key(header::CONTENT_ENCODING);
        assert!(encoded(vec![7; 100_000]));
        assert!(!encoded(vec![7; 100]));
        let mut state = 1u32;
        let noise = std::iter::from_fn(|| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Some((state >> 24) as u8)
        });
        assert!(!encoded(noise.take(100_000).collect()));
    }
}
