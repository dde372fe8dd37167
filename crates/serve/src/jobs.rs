//! Work that would delay other requests, on separate threads, with a limit on how much runs at a time.

use super::ApiProblem;
use std::num::NonZero;
use std::sync::LazyLock;
use tokio::sync::Semaphore;

/// Jobs at a time: more would only take memory, since a layer is tens of megabytes.
static JOBS: LazyLock<Semaphore> = LazyLock::new(|| Semaphore::new(2 * std::thread::available_parallelism().map_or(2, NonZero::get)));

/// Runs `job` on a thread for blocking work.
///
/// # Errors
/// When the job fails or panics.
pub async fn beside<T: Send + 'static>(job: impl FnOnce() -> Result<T, ApiProblem> + Send + 'static) -> Result<T, ApiProblem> {
    // A request that its browser gives up waits no longer and begins no work.
    let _turn = JOBS.acquire().await;
    let done = tokio::task::spawn_blocking(job).await;
    done.unwrap_or_else(|_| Err(ApiProblem::failed("the program has a mistake and gave up on this request", "report what you opened")))
}
