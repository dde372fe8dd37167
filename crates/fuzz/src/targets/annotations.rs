//! Files that the annotation page writes, and requests of pages to the servers.

use crate::seeds::{dataset, room};
use crate::{Run, Seed};
use axum::Router;
use axum::body::Body;
use axum::http::{Request, Response, StatusCode};
use enfilade_label_page::{AnnotateOptions, App, PAGE, routes};
use enfilade_scene::Quiet;
use enfilade_serve::{Guard, guarded};
use enfilade_view_page::{Viewer, router};
use std::net::Ipv4Addr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio::runtime::Runtime;
use tower::ServiceExt;

const LOG: &str = "annotation_log.jsonl";

/// Opens a scene whose log, list of classes, working times or reviews are the bytes; the first byte decides which. Bytes that do not begin
/// like a log are put after the first line of one.
pub fn log(folder: &Path) -> Run {
    let (options, header) = fresh(folder);
    let labels = folder.join("labels");
    Box::new(move |bytes| {
        drop(std::fs::remove_dir_all(&labels));
        std::fs::create_dir(&labels).expect("a folder that can be written");
        let (name, content) = match bytes {
            [b's', ..] => ("semantic_label_descs.csv", bytes.to_vec()),
            [b't', ..] => ("annotation_time.csv", bytes.to_vec()),
            bytes if bytes.starts_with(b"{\"time") => ("annotation_review.jsonl", bytes.to_vec()),
            bytes if bytes.starts_with(b"{\"format") => (LOG, bytes.to_vec()),
            _ => (LOG, [&header, bytes].concat()),
        };
        std::fs::write(labels.join(name), content).expect("a folder that can be written");
        drop(App::open(&options, &Quiet));
    })
}

/// A scene that nobody has annotated yet, and the first line of its log.
fn fresh(folder: &Path) -> (AnnotateOptions, Vec<u8>) {
    let labels = folder.join("labels");
    let options = AnnotateOptions { path: room::package(folder), labels: Some(labels.clone()), ..AnnotateOptions::default() };
    drop(App::open(&options, &Quiet).expect("a scene that can be annotated"));
    (options, std::fs::read(labels.join(LOG)).expect("a log"))
}

/// Logs with every kind of edit, without their first lines.
pub fn logs() -> Vec<Seed> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (options, header) = fresh(folder.path());
    let asked = Asked::new(options, folder.path());
    for action in [
        r#"{"type":"assign","pieces":[1,3],"apply":{"layer":"semantic","value":5}}"#,
        r#"{"type":"split","piece":5,"by":"component"}"#,
        r#"{"type":"undo"}"#,
        r#"{"type":"redo"}"#,
        r#"{"type":"assign","pieces":[2],"apply":{"layer":"instance","new":true}}"#,
    ] {
        drop(asked.answer(format!("POST /api/annotate/edit\n{{\"client\":\"c\",\"action\":{action}}}").as_bytes()));
    }
    let log = std::fs::read(folder.path().join("labels").join(LOG)).expect("a log");
    vec![Seed { name: "edits".into(), bytes: log[header.len()..].to_vec() }]
}

/// Requests that change something go to a new program after this many, so that its log does not fill the memory.
const MAX_REQUESTS: usize = 400;

/// Answers requests: a line of method and address, then the body. Whatever is asked, nothing may fail within.
pub fn requests(folder: &Path) -> Run {
    let (options, _) = fresh(folder);
    dataset::write(&folder.join("dataset"));
    let (folder, mut count) = (folder.to_path_buf(), 0);
    let mut asked = Asked::new(options.clone(), &folder);
    Box::new(move |bytes| {
        count += usize::from(bytes.starts_with(b"POST"));
        if count > MAX_REQUESTS {
            count = 0;
            asked.close();
            asked = Asked::new(options.clone(), &folder);
        }
        if let Some(response) = asked.answer(bytes) {
            assert!(response.status() != StatusCode::INTERNAL_SERVER_ERROR, "a request made the server fail");
        }
    })
}

/// Both servers, ready to be asked.
struct Asked {
    runtime: Runtime,
    router: Router,
    labels: PathBuf,
}

impl Asked {
    fn new(options: AnnotateOptions, folder: &Path) -> Self {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
        let labels = options.labels.clone().unwrap_or_default();
        let mut pages = routes(Arc::new(App::open(&options, &Quiet).expect("a scene that can be annotated")));
        if let Ok(viewer) = Viewer::open(folder.join("dataset")) {
            pages = pages.merge(router(viewer));
        }
        let guard = Guard::new(Ipv4Addr::LOCALHOST.into(), false).expect("random numbers");
        Self { runtime, router: guarded(pages, PAGE, guard), labels }
    }

    /// The answer; `None` for what is no request.
    fn answer(&self, bytes: &[u8]) -> Option<Response<Body>> {
        let end = bytes.iter().position(|&b| b == b'\n').unwrap_or(bytes.len());
        let (method, address) = std::str::from_utf8(&bytes[..end]).ok()?.split_once(' ')?;
        let body = bytes.get(end + 1..).unwrap_or_default().to_vec();
        let request = Request::builder().method(method).uri(address).header("host", "localhost").body(Body::from(body)).ok()?;
        Some(self.runtime.block_on(self.router.clone().oneshot(request)).unwrap_or_else(|never| match never {}))
    }

    /// Forgets what was done, so that the next one begins again.
    fn close(&mut self) {
        self.router = Router::new();
        drop(std::fs::remove_dir_all(&self.labels));
    }
}
