//! What every handler of the page gets and gives.

use super::app::App;
use axum::extract::State;
use axum::response::Response;
use enfilade_serve::ApiProblem;
use std::sync::Arc;

/// What a handler gets.
pub type Shared = State<Arc<App>>;
/// What a handler answers.
pub type Answer = Result<Response, ApiProblem>;
