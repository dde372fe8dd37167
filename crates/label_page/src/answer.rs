//! Types of arguments and results of the page's handlers.

use super::app::App;
use axum::extract::State;
use axum::response::Response;
use enfilade_serve::ApiProblem;
use std::sync::Arc;

/// The argument of a handler.
pub type Shared = State<Arc<App>>;
/// The result of a handler.
pub type Answer = Result<Response, ApiProblem>;
