//! The server behind the pages in the browser, and what the pages share.
//!
//! [`serve()`] binds an address, refuses strangers, serves the routes of a program with its [`Page`], and shuts down in order. Pages are
//! plain modules for the browser: nothing is built, so the files in `web/` are what runs. Here are those that every page has, at
//! `/shared/` and `/vendor/`; the crate of each page embeds its own. [`DisplayOrder`] is a scene as `web/shared/stage3d` draws it.

mod addresses;
mod bodies;
mod connections;
mod display_order;
mod files;
mod guard;
mod jobs;
mod line;
mod problem;
pub mod reply;
#[cfg(test)]
mod tests;
mod transfer;

pub use addresses::Addresses;
pub use display_order::{DisplayOrder, area_m2};
pub use files::Page;
pub use guard::{Guard, Token};
pub use jobs::beside;
pub use problem::ApiProblem;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderMap, Uri};
use axum::response::Redirect;
use axum::routing::get;
use files::PageFiles;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

/// When the program is asked to end, jobs have this long after the last connection has ended.
const PATIENCE: Duration = Duration::from_millis(100);

/// The address to listen at, and what to do then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listen {
    /// Address of the interface: loopback unless somebody asks for more.
    pub address: IpAddr,
    /// Port; 0 takes any that is free.
    pub port: u16,
    /// Require a token on loopback too, for machines that several people share. On other interfaces it is always required.
    pub token: bool,
    /// Open the page in the user's browser.
    pub open: bool,
}

impl Default for Listen {
    /// Listens on this machine only, at any free port, without a token, and opens the page.
    fn default() -> Self {
        Self { address: Ipv4Addr::LOCALHOST.into(), port: 0, token: false, open: true }
    }
}

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The address cannot be bound.
    #[error("cannot listen on {address}: {source}; choose another port with --port, or 0 for any that is free")]
    Bind {
        /// The requested address.
        address: SocketAddr,
        /// Error of the system.
        source: std::io::Error,
    },
    /// No threads, no randomness, or the network has gone.
    #[error("the server cannot run: {0}")]
    Run(String),
}

/// Serves `app` and its page until the process is asked to end (Ctrl-C or SIGTERM); requests in progress are finished if that does not take
/// long.
///
/// `started` receives the addresses of the page once they can be opened.
///
/// # Errors
/// When the address cannot be bound or the server cannot run.
pub fn serve(app: Router, page: Page, listen: &Listen, started: impl FnOnce(&Addresses)) -> Result<(), ServeError> {
    let run = |e: std::io::Error| ServeError::Run(e.to_string());
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(run)?;
    let outcome = runtime.block_on(async {
        let address = SocketAddr::new(listen.address, listen.port);
        let listener = tokio::net::TcpListener::bind(address).await.map_err(|source| ServeError::Bind { address, source })?;
        let bound = listener.local_addr().map_err(run)?;
        let guard = Guard::new(bound.ip(), listen.token).map_err(|e| ServeError::Run(format!("no random numbers for a token: {e}")))?;
        // Before the addresses are announced, so that no request to end is missed.
        let end = asked_to_end();
        let addresses = Addresses::of(bound, |host| guard.url(host, page.address));
        started(&addresses);
        if listen.open && open::that_detached(&addresses.here).is_err() {
            // A machine without a browser. The address was printed already.
        }
        connections::answer(listener, guarded(app, page, guard), connections::Limits::of_this_process(), end).await;
        Ok(())
    });
    runtime.shutdown_timeout(PATIENCE);
    outcome
}

/// `app` with the files of its page, behind the guard; `/` leads to the page.
pub fn guarded(app: Router, page: Page, guard: Guard) -> Router {
    let files = Arc::new(PageFiles::of(page));
    app.route("/", get(move || async move { Redirect::temporary(page.address) }))
        .fallback(move |uri: Uri, headers: HeaderMap| files.clone().answer(uri, headers))
        .layer(DefaultBodyLimit::disable())
        .layer(axum::middleware::from_fn(bodies::whole))
        .layer(axum::middleware::from_fn(transfer::compress_and_tag))
        .layer(axum::middleware::from_fn_with_state(Arc::new(guard), guard::check))
}

/// A future that completes when the process is asked to end. Signals are received from this call on.
fn asked_to_end() -> impl Future<Output = ()> {
    #[cfg(unix)]
    let terminate = tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate());
    async {
        let interrupt = async { tokio::signal::ctrl_c().await.unwrap_or(()) };
        #[cfg(unix)]
        let terminate = async {
            match terminate {
                Ok(mut signal) => signal.recv().await.unwrap_or(()),
                Err(_) => std::future::pending().await,
            }
        };
        #[cfg(not(unix))]
        let terminate = std::future::pending::<()>();
        tokio::select! { () = interrupt => {}, () = terminate => {} }
    }
}
