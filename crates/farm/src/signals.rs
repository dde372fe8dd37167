//! Being asked to end: an engine that wants its node back sends SIGTERM and waits a little.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that rises when this process is asked to end by SIGTERM, SIGINT or SIGUSR1 (which Slurm's `--signal` and others can send
/// early); at once, where signals cannot be waited for, it never rises.
pub fn stop_on_signals() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = stop.clone();
    std::thread::spawn(move || {
        let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
        runtime.block_on(asked_to_end());
        flag.store(true, Ordering::Relaxed);
    });
    stop
}

#[cfg(unix)]
async fn asked_to_end() {
    use tokio::signal::unix::{SignalKind, signal};
    let signals = [SignalKind::terminate(), SignalKind::interrupt(), SignalKind::user_defined1()].map(signal);
    let [Ok(mut terminate), Ok(mut interrupt), Ok(mut user)] = signals else { return std::future::pending().await };
    tokio::select! {
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
        _ = user.recv() => {}
    }
}

#[cfg(not(unix))]
async fn asked_to_end() {
    if tokio::signal::ctrl_c().await.is_err() {
        std::future::pending().await
    }
}
