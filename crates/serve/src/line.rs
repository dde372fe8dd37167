//! State of one connection: when a byte last moved on it, and whether a request is being answered.

use axum::body::{Body, Bytes};
use hyper::body::{Body as HttpBody, Frame, SizeHint};
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::sync::Notify;

/// One connection.
pub(super) struct Line {
    begun: Instant,
    /// When a byte last moved, milliseconds from the beginning.
    moved_ms: AtomicU64,
    /// Requests whose answers are not written yet.
    turns: AtomicUsize,
    /// True while the body of a request is on its way.
    is_arriving: AtomicBool,
    close: Notify,
}

impl Default for Line {
    /// A connection that has just begun.
    fn default() -> Self {
        Self {
            begun: Instant::now(),
            moved_ms: AtomicU64::new(0),
            turns: AtomicUsize::new(0),
            is_arriving: AtomicBool::new(false),
            close: Notify::new(),
        }
    }
}

impl Line {
    /// Since when no byte has moved.
    pub fn silent_for(&self) -> Duration {
        self.begun.elapsed().saturating_sub(Duration::from_millis(self.moved_ms.load(Relaxed)))
    }

    /// True while a request that has come whole is being answered.
    pub fn is_answering(&self) -> bool {
        self.turns.load(Relaxed) > 0 && !self.is_arriving.load(Relaxed)
    }

    /// The body of a request is on its way, until what is returned is dropped.
    pub fn arriving(self: &Arc<Self>) -> Arriving {
        self.is_arriving.store(true, Relaxed);
        Arriving(Arc::clone(self))
    }

    /// Asks for the end of the connection.
    pub fn close(&self) {
        self.close.notify_one();
    }

    /// Returns when the end was requested.
    pub async fn closed(&self) {
        self.close.notified().await;
    }

    /// A request begins; it ends when what is returned is dropped.
    pub fn turn(self: &Arc<Self>) -> Turn {
        self.turns.fetch_add(1, Relaxed);
        Turn(Arc::clone(self))
    }

    fn moved(&self) {
        self.moved_ms.store(self.begun.elapsed().as_millis() as u64, Relaxed);
    }
}

/// A body that is on its way.
pub(super) struct Arriving(Arc<Line>);

impl Drop for Arriving {
    fn drop(&mut self) {
        self.0.is_arriving.store(false, Relaxed);
    }
}

/// A request that is being answered.
pub(super) struct Turn(Arc<Line>);

impl Drop for Turn {
    fn drop(&mut self) {
        self.0.turns.fetch_sub(1, Relaxed);
    }
}

/// The body of an answer, which ends its turn.
pub(super) struct Answer {
    body: Body,
    _turn: Turn,
}

impl Answer {
    pub fn new(body: Body, turn: Turn) -> Self {
        Self { body, _turn: turn }
    }
}

impl HttpBody for Answer {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(cx)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// A stream that notifies its line when bytes move.
pub(super) struct Watched {
    stream: TcpStream,
    line: Arc<Line>,
}

impl Watched {
    pub fn new(stream: TcpStream, line: Arc<Line>) -> Self {
        Self { stream, line }
    }

    fn wrote(&self, written: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        if matches!(written, Poll::Ready(Ok(bytes)) if bytes > 0) {
            self.line.moved();
        }
        written
    }
}

impl AsyncRead for Watched {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let read = Pin::new(&mut self.stream).poll_read(cx, buffer);
        if buffer.filled().len() > before {
            self.line.moved();
        }
        read
    }
}

impl AsyncWrite for Watched {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.wrote(written)
    }

    fn poll_write_vectored(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[io::IoSlice<'_>]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(cx, bytes);
        self.wrote(written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
