//! Files of the dataset that the browser shows by itself: the report card, statistics, pictures of rejected views.

use super::place::version;
use super::viewer::{Viewer, work};
use axum::body::Body;
use axum::extract::{Path, State};
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse, Response};
use enfilade_serve::ApiProblem;
use enfilade_serve::reply::{is_text, tag};
use futures_util::stream::{Stream, unfold};
use std::fs::File;
use std::io::{ErrorKind, Read, Take};
use std::path::Component;
use std::sync::Arc;

/// Files that may be sent: extensions and their media types.
const KINDS: [(&str, &str); 10] = [
    ("html", "text/html; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("jpg", "image/jpeg"),
    ("webp", "image/webp"),
    ("gif", "image/gif"),
    ("mp4", "video/mp4"),
    ("json", "application/json"),
    ("csv", "text/csv; charset=utf-8"),
];

/// Text is compressed, for which it is kept in memory; larger files are sent uncompressed.
const MOST_TEXT_BYTES: u64 = 64 << 20;
/// Bytes of a file that are in memory while it is sent.
const CHUNK_BYTES: u64 = 256 << 10;

/// A dataset may come from strangers, so its pages may run no scripts and load nothing from other machines. They count as of this server, so
/// that browsers send the token with their pictures and links.
const PAGE_POLICY: &str =
    "sandbox allow-same-origin; default-src 'none'; img-src 'self' data:; media-src 'self'; style-src 'unsafe-inline' 'self'";

/// `GET /api/view/file/{path}`: a page, picture or table of the dataset, by its path in the dataset's folder.
pub async fn file(State(viewer): State<Arc<Viewer>>, Path(path): Path<String>) -> Result<Response, ApiProblem> {
    let parts = std::path::Path::new(&path);
    let plain = |part: Component| matches!(part, Component::Normal(name) if !name.to_string_lossy().starts_with('.'));
    if path.contains(['\\', '\0']) || path.is_empty() || !parts.components().all(plain) {
        return Err(ApiProblem::bad_request(
            format!("{path:?} is no path within the dataset"),
            "give folders and a name, without dots in front",
        ));
    }
    let end = path.rsplit('.').next().unwrap_or("");
    let Some((_, kind)) = KINDS.iter().find(|(known, _)| *known == end) else {
        let known: Vec<&str> = KINDS.iter().map(|(end, _)| *end).collect();
        return Err(ApiProblem::bad_request(
            format!("{path:?} is no page or picture"),
            format!("only files in {} are sent", known.join(", ")),
        ));
    };
    let content = work(viewer, move |viewer| content(viewer, &path, kind)).await?;
    let headers = [(header::CONTENT_TYPE, *kind), (header::CACHE_CONTROL, "no-cache"), (header::CONTENT_SECURITY_POLICY, PAGE_POLICY)];
    Ok(match content {
        Content::Text(text) => (headers, text).into_response(),
        Content::File { file, length, tag } => {
            let told = [(header::CONTENT_LENGTH, length.into()), (header::ETAG, tag)];
            (headers, told, Body::from_stream(chunks(file.take(length)))).into_response()
        }
    })
}

/// Contents of a file to send: text is kept in memory to be compressed, anything else is read while it is sent.
enum Content {
    Text(Vec<u8>),
    File { file: File, length: u64, tag: HeaderValue },
}

fn content(viewer: &Viewer, path: &str, kind: &str) -> Result<Content, ApiProblem> {
    let full = viewer.dataset.root().join(path);
    viewer.allow(&full)?;
    let missing = || ApiProblem::not_found(format!("the dataset has no file {path:?}"), "run the stage that makes it");
    let wrong = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::IsADirectory | ErrorKind::InvalidFilename => missing(),
        _ => ApiProblem::failed(format!("cannot read {path:?}: {e}"), "make the file readable"),
    };
    let mut file = File::open(&full).map_err(wrong)?;
    let data = file.metadata().map_err(wrong)?;
    if !data.is_file() {
        return Err(missing());
    }
    if !is_text(kind) || data.len() > MOST_TEXT_BYTES {
        return Ok(Content::File { file, length: data.len(), tag: tag(&version(&full)) });
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(wrong)?;
    let is_page = kind.starts_with("text/html");
    Ok(Content::Text(if is_page { frames_open_the_page(&String::from_utf8_lossy(&bytes)).into_bytes() } else { bytes }))
}

/// The contents of a file, a chunk at a time.
fn chunks(file: Take<File>) -> impl Stream<Item = std::io::Result<Vec<u8>>> {
    unfold(Some(file), |file| async move {
        let mut file = file?;
        let read = move || {
            let mut bytes = Vec::new();
            file.by_ref().take(CHUNK_BYTES).read_to_end(&mut bytes).map(|_| (bytes, file))
        };
        match tokio::task::spawn_blocking(read).await.unwrap_or_else(|e| Err(std::io::Error::other(e))) {
            Ok((bytes, file)) => (!bytes.is_empty()).then_some((Ok(bytes), Some(file))),
            Err(e) => Some((Err(e), None)),
        }
    })
}

/// A report whose links to pictures of frames lead to the frames on our page instead.
fn frames_open_the_page(html: &str) -> String {
    let mut parts = html.split("href=\"");
    let mut text = parts.next().unwrap_or("").to_string();
    for part in parts {
        let (link, rest) = part.split_once('"').unwrap_or((part, ""));
        let link = frame_address(link).unwrap_or_else(|| link.to_string());
        text.push_str(&format!("href=\"{link}\"{rest}"));
    }
    text
}

/// The address of the frame whose picture a path is; `None` for other paths.
fn frame_address(path: &str) -> Option<String> {
    let (scene, file) = path.split_once("scenes/")?.1.split_once("/images/scene_")?;
    let (folder, name) = file.split_once('/')?;
    let camera = folder.strip_suffix("_final_preview").or_else(|| folder.strip_suffix("_geometry_preview"))?;
    let number: u32 = name.strip_prefix("frame.")?.split('.').next()?.parse().ok()?;
    let is_name = |word: &str| word.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-' | b'.'));
    (is_name(scene) && is_name(camera)).then(|| format!("/view/#scene={scene}&amp;camera={camera}&amp;frame={number}&amp;layer=color"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_a_report_lead_to_frames_and_other_links_stay() {
        let html = r##"<a href="scenes/home/images/scene_cam_00_final_preview/frame.0012.tonemap.jpg">x</a><a href="verify.json"><a href="#laws">"##;
        let told = frames_open_the_page(html);
        assert!(told.contains(r##"<a href="/view/#scene=home&amp;camera=cam_00&amp;frame=12&amp;layer=color">x</a>"##), "{told}");
        assert!(told.ends_with(r##"<a href="verify.json"><a href="#laws">"##), "{told}");
    }
}
