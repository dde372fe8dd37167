//! The files of a page, which are embedded in the binary; each is compressed once, at the best level.
//!
//! Pages name their scripts and styles below `/@DIGEST/`, where DIGEST is the digest of all files: files there never change, so browsers
//! keep them without asking. Modules import each other by relative addresses, so their addresses have the digest too. Without a digest the
//! same files are served with a tag.

use super::ApiProblem;
use super::jobs::beside;
use super::reply::{is_text, pack, tag, takes_gzip};
use axum::body::Bytes;
use axum::http::{HeaderMap, HeaderValue, Uri, header};
use axum::response::{IntoResponse, Response};
use rust_embed::{EmbeddedFile, RustEmbed};
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Files that every page has.
#[derive(RustEmbed)]
#[folder = "web"]
struct Shared;

/// Level of compression, the best.
const LEVEL: i32 = 12;

/// A page: its address, and the files that its crate embeds.
#[derive(Clone, Copy)]
pub struct Page {
    /// The path of the page, such as `/annotate/`.
    pub address: &'static str,
    get: fn(&str) -> Option<EmbeddedFile>,
    names: fn() -> Vec<String>,
}

impl Page {
    /// The page at `address` with the files of `E`, whose paths begin as the address does: `annotate/main.js`.
    pub const fn new<E: RustEmbed>(address: &'static str) -> Self {
        Self { address, get: E::get, names: names::<E> }
    }

    /// The file of a path of this page, or of those that every page has.
    fn file(&self, path: &str) -> Option<EmbeddedFile> {
        (self.get)(path).or_else(|| Shared::get(path))
    }

    /// The digest of all files.
    fn digest(&self) -> String {
        let mut names = [(self.names)(), names::<Shared>()].concat();
        names.sort_unstable();
        let mut hasher = blake3::Hasher::new();
        for name in names {
            let hash = self.file(&name).map(|file| file.metadata.sha256_hash()).unwrap_or_default();
            hasher.update(name.as_bytes()).update(&hash);
        }
        hasher.finalize().to_hex()[..16].to_string()
    }
}

/// The paths of all files of `E`.
fn names<E: RustEmbed>() -> Vec<String> {
    E::iter().map(Cow::into_owned).collect()
}

/// A file as it is sent.
struct Sent {
    /// Digest of what it was made from.
    digest: String,
    kind: String,
    plain: Bytes,
    packed: Option<Bytes>,
}

impl Sent {
    fn answer(&self, takes_gzip: bool, kept: bool) -> Response {
        let cached = if kept { "public, max-age=31536000, immutable" } else { "no-cache" };
        let packed = self.packed.as_ref().filter(|_| takes_gzip);
        let end = if packed.is_some() { "-gzip" } else { "" };
        let mut response = packed.unwrap_or(&self.plain).clone().into_response();
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_str(&self.kind).expect("media types are plain text"));
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(cached));
        headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
        headers.insert(header::ETAG, tag(&format!("{}{end}", self.digest)));
        if packed.is_some() {
            headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
        }
        response
    }
}

/// The files of one page as they are sent, each made on the first request.
pub struct PageFiles {
    page: Page,
    sent: Mutex<HashMap<String, Arc<Sent>>>,
    /// The digest of all files, once it is known.
    digest: Mutex<Option<String>>,
}

impl PageFiles {
    /// The files of a page.
    pub fn of(page: Page) -> Self {
        Self { page, sent: Mutex::default(), digest: Mutex::default() }
    }

    /// The file of a path such as `/annotate/main.js`, or `/@DIGEST/annotate/main.js`; a path that ends in `/` is its `index.html`.
    ///
    /// # Errors
    /// 404 when the binary has no such file.
    pub async fn answer(self: Arc<Self>, uri: Uri, headers: HeaderMap) -> Result<Response, ApiProblem> {
        beside(move || {
            let (kept, path) = match uri.path().strip_prefix("/@").and_then(|rest| rest.split_once('/')) {
                Some((digest, path)) => (digest == self.digest(false), path),
                None => (false, uri.path().trim_start_matches('/')),
            };
            let path = if path.is_empty() || path.ends_with('/') { format!("{path}index.html") } else { path.to_string() };
            let Some(file) = self.sent(&path) else {
                return Err(ApiProblem::not_found(
                    format!("there is no page {:?}", uri.path()),
                    "open the address that the program printed",
                ));
            };
            Ok(file.answer(takes_gzip(&headers), kept))
        })
        .await
    }

    /// The file of a path; `None` if the binary has none. In debug builds, which read the files from the disk, it is made again when it
    /// changed.
    fn sent(&self, path: &str) -> Option<Arc<Sent>> {
        let file = self.page.file(path)?;
        let is_html = path.ends_with(".html");
        let digest = if is_html { self.digest(cfg!(debug_assertions)) } else { hex(&file.metadata.sha256_hash()) };
        let known = self.sent.lock().unwrap_or_else(PoisonError::into_inner).get(path).cloned();
        if let Some(sent) = known.filter(|sent| sent.digest == digest) {
            return Some(sent);
        }
        let plain: Bytes = match is_html {
            true => with_digest(&String::from_utf8_lossy(&file.data), path, &digest).into(),
            false => file.data.into_owned().into(),
        };
        let kind = file.metadata.mimetype().to_string();
        let packed = is_text(&kind).then(|| pack(&plain, LEVEL)).flatten().map(Bytes::from);
        let sent = Arc::new(Sent { digest, kind, plain, packed });
        self.sent.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_string(), Arc::clone(&sent));
        Some(sent)
    }

    /// The digest of all files: the last one, or `anew`, since debug builds read them from the disk.
    fn digest(&self, anew: bool) -> String {
        let mut last = self.digest.lock().unwrap_or_else(PoisonError::into_inner);
        if anew {
            *last = None;
        }
        last.get_or_insert_with(|| self.page.digest()).clone()
    }
}

/// The text of a page whose relative addresses begin with the digest.
fn with_digest(html: &str, path: &str, digest: &str) -> String {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut text = html.to_string();
    for name in ["src=\"", "href=\""] {
        let mut parts = text.split(name);
        let mut moved = parts.next().unwrap_or("").to_string();
        for part in parts {
            let is_relative = !part.starts_with(['/', '#']) && !part.split('"').next().unwrap_or("").contains(':');
            let front = if is_relative { format!("/@{digest}/{folder}/") } else { String::new() };
            moved.push_str(&format!("{name}{front}{part}"));
        }
        text = moved;
    }
    text
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().take(16).map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_addresses_of_a_page_get_the_digest_and_others_do_not() {
        let html = r##"<link href="data:,"><link href="../shared/theme.css"><script src="main.js"></script><a href="/x"><a href="#y">"##;
        let told = with_digest(html, "view/index.html", "d1");
        assert!(told.contains(r#"href="/@d1/view/../shared/theme.css""#) && told.contains(r#"src="/@d1/view/main.js""#), "{told}");
        assert!(told.contains(r#"href="data:,""#) && told.contains(r#"href="/x""#), "{told}");
    }
}
