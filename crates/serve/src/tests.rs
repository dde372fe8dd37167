//! The server on real sockets: what it sends twice, and how it copes with silent clients.

use super::connections::{Limits, answer};
use super::{ApiProblem, Guard, Page, guarded};
use axum::body::Body;
use axum::response::sse::{Event, Sse};
use axum::routing::{get, post};
use axum::{Json, Router};
use std::convert::Infallible;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use tokio::net::TcpListener;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;
use tokio::time::timeout;

/// A page with one script.
#[derive(rust_embed::RustEmbed)]
#[folder = "tests/page"]
struct Trial;

pub const PAGE: Page = Page::new::<Trial>("/trial/");

const MOMENT: Duration = Duration::from_secs(5);

fn limits() -> Limits {
    Limits { most: 24, head: MOMENT, silence: MOMENT, ending: Duration::from_millis(250) }
}

struct Server {
    address: SocketAddr,
    end: Option<oneshot::Sender<()>>,
    ended: JoinHandle<()>,
}

/// Two answers in JSON, a silent stream, a body that is counted, and more bytes than socket buffers can take.
fn app() -> Router {
    let long = || async { Json(vec!["the same"; 1000]) };
    let silent = || async { Sse::new(futures_util::stream::pending::<Result<Event, Infallible>>()) };
    let large = || async { Body::from(vec![7; 64 << 20]) };
    Router::new()
        .route("/short", get(|| async { Json("short") }))
        .route("/long", get(long))
        .route("/silent", get(silent))
        .route("/large", get(large))
        .route("/count", post(|Json(text): Json<String>| async move { text.len().to_string() }))
        .route("/missing", get(|| async { ApiProblem::not_found("it is not there", "ask for something else") }))
}

async fn server(limits: Limits) -> Server {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.unwrap();
    let address = listener.local_addr().unwrap();
    let guard = Guard::new(address.ip(), false).unwrap();
    let (end, asked) = oneshot::channel();
    let asked = async {
        let _ = asked.await;
    };
    let ended = tokio::spawn(answer(listener, guarded(app(), PAGE, guard), limits, asked));
    Server { address, end: Some(end), ended }
}

impl Server {
    /// A connection; a read that takes too long fails. The server has threads of its own, so tests may wait for it.
    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(MOMENT)).unwrap();
        stream.set_write_timeout(Some(MOMENT)).unwrap();
        stream
    }

    /// Status, head and body of an answer. The connection ends with it.
    fn get(&self, path: &str, headers: &str) -> (u16, String, Vec<u8>) {
        let mut stream = self.connect();
        let request = format!("GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n{headers}\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("an answer");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap() + 4;
        let head = String::from_utf8(answer[..end].to_vec()).unwrap().to_lowercase();
        (head[9..12].parse().unwrap(), head, answer[end..].to_vec())
    }
}

/// The value of a header.
fn header<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    head.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(": "))
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn what_the_browser_has_is_not_sent_again() {
    let server = server(limits()).await;
    for path in ["/long", "/short", "/vendor/three.js", "/trial/"] {
        let (status, head, body) = server.get(path, "Accept-Encoding: gzip\r\n");
        let tag = header(&head, "etag").unwrap_or_else(|| panic!("{path} has no tag: {head}"));
        assert!(status == 200 && !body.is_empty() && !tag.starts_with("w/"), "{path}: {head}");
        let (status, head, body) = server.get(path, &format!("Accept-Encoding: gzip\r\nIf-None-Match: \"other\", {tag}\r\n"));
        assert_eq!((status, header(&head, "etag"), body.len()), (304, Some(tag), 0), "{path}");
        let (status, plain, _) = server.get(path, &format!("If-None-Match: {tag}\r\n"));
        let is_small = path == "/short" || path == "/trial/";
        assert_eq!((status, header(&plain, "content-encoding")), (if is_small { 304 } else { 200 }, None), "{path}");
    }
    let (status, head, _) = server.get("/missing", "");
    assert_eq!((status, header(&head, "etag")), (404, None));
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn text_is_compressed_for_those_who_take_it() {
    let server = server(limits()).await;
    for (path, share) in [("/long", 20), ("/vendor/three.js", 3), ("/shared/theme.css", 2)] {
        let (_, _, plain) = server.get(path, "");
        let (_, head, packed) = server.get(path, "Accept-Encoding: gzip, br\r\n");
        assert_eq!((header(&head, "content-encoding"), header(&head, "vary")), (Some("gzip"), Some("accept-encoding")), "{path}");
        assert!(packed.len() < plain.len() / share, "{path}: {} of {}", packed.len(), plain.len());
        let mut unpacked = vec![0; plain.len()];
        libdeflater::Decompressor::new().gzip_decompress(&packed, &mut unpacked).unwrap();
        assert_eq!(unpacked, plain, "{path}");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_page_names_its_files_by_a_digest_and_they_are_kept() {
    let server = server(limits()).await;
    let (_, head, page) = server.get("/trial/", "");
    assert_eq!(header(&head, "cache-control"), Some("no-cache"));
    let page = String::from_utf8(page).unwrap();
    let script = page.split("src=\"").nth(1).unwrap().split('"').next().unwrap();
    let (status, head, there) = server.get(script, "");
    assert!(status == 200 && header(&head, "cache-control").unwrap().contains("immutable"), "{script}: {head}");
    let (_, head, same) = server.get("/trial/main.js", "");
    assert_eq!((header(&head, "cache-control"), same), (Some("no-cache"), there));
    let (status, head, _) = server.get("/@0123456789abcdef/trial/main.js", "");
    assert_eq!((status, header(&head, "cache-control")), (200, Some("no-cache")), "a page of another version");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn many_who_say_nothing_keep_nobody_out() {
    let server = server(limits()).await;
    let mut silent = Vec::new();
    for i in 0..300 {
        let mut stream = server.connect();
        if i % 2 == 0 {
            stream.write_all(b"GET /short HTTP/1.1\r\nHost: loc").unwrap();
        }
        silent.push(stream);
    }
    let begin = Instant::now();
    assert_eq!(server.get("/short", "").0, 200);
    assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn bodies_that_drip_keep_nobody_out() {
    let server = server(limits()).await;
    let head = "POST /count HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 4000\r\n\r\n\"";
    let dripping: Vec<TcpStream> = (0..100)
        .map(|_| {
            let mut stream = server.connect();
            stream.write_all(head.as_bytes()).unwrap();
            stream
        })
        .collect();
    let begin = Instant::now();
    assert_eq!(server.get("/short", "").0, 200);
    assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
    drop(dripping);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_head_that_does_not_come_ends_the_connection() {
    let server = server(Limits { head: Duration::from_millis(200), ..limits() }).await;
    for beginning in ["", "GET /short HTTP/1.1\r\nHost: localhost\r\n", "GET /short HTTP/1.1\r\nHost: localhost\r\n\r\n"] {
        let mut stream = server.connect();
        stream.write_all(beginning.as_bytes()).unwrap();
        let mut rest = Vec::new();
        stream.read_to_end(&mut rest).expect("the server closes it");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn who_does_not_read_the_answer_is_let_go() {
    let server = server(Limits { most: 1, silence: Duration::from_millis(200), ..limits() }).await;
    let mut stream = server.connect();
    stream.write_all(b"GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n").unwrap();
    let begin = Instant::now();
    assert_eq!(server.get("/short", "").0, 200);
    assert!(begin.elapsed() < Duration::from_secs(3), "{:?}", begin.elapsed());
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn large_bodies_and_heads_are_refused() {
    let server = server(limits()).await;
    for (head, body, refused) in [("Content-Length: 300000000", 0, "413"), ("Content-Length: 40", 40, "200"), ("X-Long: ", 100_000, "431")]
    {
        let mut stream = server.connect();
        let kind = "Host: localhost\r\nContent-Type: application/json\r\nConnection: close";
        let end = if head.starts_with('X') { "" } else { "\r\n\r\n" };
        let text = if body == 40 { format!("\"{}\"", "x".repeat(38)) } else { "x".repeat(body) };
        stream.write_all(format!("POST /count HTTP/1.1\r\n{kind}\r\n{head}{end}{text}").as_bytes()).unwrap();
        if refused == "413" {
            // Until it is refused; the socket may be closed before all is written.
            for _ in 0..20 {
                let _ = stream.write_all(&[b'1'; 1 << 20]);
            }
        }
        let mut answer = [0; 12];
        if stream.read_exact(&mut answer).is_ok() {
            assert_eq!(String::from_utf8_lossy(&answer[9..]), refused, "{head}");
        }
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn the_end_does_not_wait_for_open_pages() {
    let mut server = server(limits()).await;
    let mut page = server.connect();
    page.write_all(b"GET /silent HTTP/1.1\r\nHost: localhost\r\n\r\n").unwrap();
    let mut head = [0; 15];
    page.read_exact(&mut head).unwrap();
    let _unused = server.connect();
    let begin = Instant::now();
    server.end.take().unwrap().send(()).unwrap();
    timeout(MOMENT, server.ended).await.unwrap().unwrap();
    assert!(begin.elapsed() < Duration::from_millis(500), "{:?}", begin.elapsed());
    assert!(TcpStream::connect(server.address).is_err(), "the port is free");
}
