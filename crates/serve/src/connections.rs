//! Connections: their number, how long they may be silent, and how they end.
//!
//! Browsers keep unused connections open, and anybody can open one and send nothing. Neither may keep others out: a request head that does
//! not arrive in time ends its connection, and if there are too many connections, the one that has been silent longest is closed.

use super::line::{Answer, Line, Watched};
use axum::Router;
use axum::http::{HeaderValue, Request, header};
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use std::convert::Infallible;
use std::io::ErrorKind;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Weak};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;
use tokio::task::JoinSet;
use tokio::time::{interval, sleep, timeout};
use tower::ServiceExt;

/// Largest head of a request, bytes.
const MAX_HEAD_BYTES: usize = 64 << 10;
/// Pause after the system refused a connection, and between looks for one that may be closed.
const PAUSE: Duration = Duration::from_millis(50);
/// A connection that has just begun, or has just been answered, may be about to send a request.
const GRACE: Duration = Duration::from_millis(100);

/// Limits of connections.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Connections at a time.
    pub most: usize,
    /// From the beginning of a connection, or the end of an answer, to the end of the next request's head.
    pub head: Duration,
    /// Without a byte in either direction while a request or its answer is under way.
    pub silence: Duration,
    /// For requests that are being answered when the server is asked to end.
    pub ending: Duration,
}

impl Limits {
    /// The limits of this program: half of the descriptors that it may have are for the files of datasets.
    pub fn of_this_process() -> Self {
        let seconds = Duration::from_secs;
        Self { most: (descriptors() / 2).clamp(16, 512), head: seconds(15), silence: seconds(90), ending: Duration::from_millis(250) }
    }
}

#[cfg(unix)]
fn descriptors() -> usize {
    let limit = rustix::process::getrlimit(rustix::process::Resource::Nofile).current;
    limit.map_or(usize::MAX, |limit| usize::try_from(limit).unwrap_or(usize::MAX))
}

#[cfg(not(unix))]
fn descriptors() -> usize {
    usize::MAX
}

/// Answers requests by `app` until `end`. Requests that are being answered then have [`Limits::ending`] to finish.
pub(super) async fn answer(listener: TcpListener, app: Router, limits: Limits, end: impl Future<Output = ()>) {
    let (end_all, ending) = watch::channel(());
    let mut end = pin!(end);
    let mut open = Open::default();
    loop {
        let accepted = tokio::select! {
            accepted = open.accept(&listener, limits.most) => accepted,
            () = &mut end => break,
        };
        let Some(stream) = accepted else { continue };
        let line = Arc::new(Line::default());
        open.lines.push(Arc::downgrade(&line));
        open.is_crowded.store(open.talks.len() >= limits.most / 4 * 3, Relaxed);
        open.talks.spawn(talk(stream, app.clone(), (line, Arc::clone(&open.is_crowded)), limits, ending.clone()));
    }
    // From here on the port is free for a server that takes our place.
    drop(listener);
    let _ = end_all.send(()); // it fails if no connection is open
    let _ = timeout(limits.ending, async { while open.talks.join_next().await.is_some() {} }).await; // the others end now
}

/// The connections that are open.
#[derive(Default)]
struct Open {
    talks: JoinSet<()>,
    lines: Vec<Weak<Line>>,
    /// Connections are scarce: they end with their answers, so that waiting clients have a turn.
    is_crowded: Arc<AtomicBool>,
}

impl Open {
    /// The next connection, once there is room for it; `None` where it failed.
    async fn accept(&mut self, listener: &TcpListener, most: usize) -> Option<TcpStream> {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(error) => {
                if !matches!(error.kind(), ErrorKind::ConnectionRefused | ErrorKind::ConnectionAborted | ErrorKind::ConnectionReset) {
                    // No descriptors are left.
                    self.close_most_silent();
                    sleep(PAUSE).await;
                }
                return None;
            }
        };
        while self.talks.try_join_next().is_some() {}
        self.lines.retain(|line| line.strong_count() > 0);
        while self.talks.len() >= most {
            self.close_most_silent();
            let _ = timeout(PAUSE, self.talks.join_next()).await; // where all are busy, the new one waits
        }
        Some(stream)
    }

    /// Closes the connection that nothing has moved on for longest, of those that have no request.
    fn close_most_silent(&self) {
        let waits = |line: &Arc<Line>| !line.is_answering() && line.silent_for() >= GRACE;
        let lines = self.lines.iter().filter_map(Weak::upgrade).filter(waits);
        if let Some(line) = lines.max_by_key(|line| line.silent_for()) {
            line.close();
        }
    }
}

/// One connection, from its first request to its end.
async fn talk(
    stream: TcpStream,
    app: Router,
    (line, is_crowded): (Arc<Line>, Arc<AtomicBool>),
    limits: Limits,
    mut ending: watch::Receiver<()>,
) {
    let _ = stream.set_nodelay(true); // it fails where the connection is gone already
    let io = TokioIo::new(Watched::new(stream, Arc::clone(&line)));
    let respond = service_fn(|mut request: Request<Incoming>| {
        let (app, turn, is_crowded) = (app.clone(), line.turn(), Arc::clone(&is_crowded));
        request.extensions_mut().insert(Arc::clone(&line));
        async move {
            let mut response = app.oneshot(request).await?;
            if is_crowded.load(Relaxed) {
                response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
            }
            Ok::<_, Infallible>(response.map(|body| Answer::new(body, turn)))
        }
    });
    let mut server = http1::Builder::new();
    server.timer(TokioTimer::new()).header_read_timeout(limits.head).max_buf_size(MAX_HEAD_BYTES);
    let mut connection = pin!(server.serve_connection(io, respond));
    let mut looks = interval(limits.silence / 4);
    let mut is_ending = false;
    loop {
        tokio::select! {
            _ = connection.as_mut() => return,
            () = line.closed() => return,
            _ = looks.tick() => if line.silent_for() > limits.silence { return },
            _ = ending.changed(), if !is_ending => {
                is_ending = true;
                connection.as_mut().graceful_shutdown();
            }
        }
    }
}
