//! Being asked to end: an engine that wants its node back sends SIGTERM and waits a little.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};

/// A flag that rises when this process is asked to end by SIGTERM, SIGINT or SIGUSR1 (which Slurm's `--signal` and others can send
/// early). When this returns, these signals no longer end the process. Where they cannot be waited for, the flag never rises.
pub fn stop_on_signals() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = stop.clone();
    let (ready, is_ready) = channel();
    // Without a thread there is nothing to wait for.
    let _ = std::thread::Builder::new().spawn(move || {
        let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
        runtime.block_on(asked_to_end(ready));
        flag.store(true, Ordering::Relaxed);
    });
    // An error means that there is nothing to wait for.
    let _ = is_ready.recv();
    stop
}

#[cfg(unix)]
async fn asked_to_end(ready: Sender<()>) {
    use tokio::signal::unix::{SignalKind, signal};
    let signals = [SignalKind::terminate(), SignalKind::interrupt(), SignalKind::user_defined1()].map(signal);
    let [Ok(mut terminate), Ok(mut interrupt), Ok(mut user)] = signals else {
        drop(ready);
        return std::future::pending().await;
    };
    let _ = ready.send(());
    tokio::select! {
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
        _ = user.recv() => {}
    }
}

#[cfg(not(unix))]
async fn asked_to_end(ready: Sender<()>) {
    let _ = ready.send(());
    if tokio::signal::ctrl_c().await.is_err() {
        std::future::pending().await
    }
}
