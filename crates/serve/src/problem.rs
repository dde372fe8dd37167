//! The answer to a request that fails: status, what is wrong, what to do.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde_json::json;

/// A failed request. Sent as `{"error": …, "help": …}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ApiProblem {
    /// 4xx where the request must change, 5xx where something here failed.
    pub status: StatusCode,
    /// The problem found, and what was expected.
    pub error: String,
    /// What to do.
    pub help: String,
}

impl ApiProblem {
    /// The request is wrong: 400.
    pub fn bad_request(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::BAD_REQUEST, error: error.into(), help: help.into() }
    }

    /// The requested thing does not exist: 404.
    pub fn not_found(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::NOT_FOUND, error: error.into(), help: help.into() }
    }

    /// The request is not allowed: 403.
    pub fn forbidden(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::FORBIDDEN, error: error.into(), help: help.into() }
    }

    /// The request cannot be done in the current state: 409.
    pub fn conflict(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::CONFLICT, error: error.into(), help: help.into() }
    }

    /// Something here failed: 500.
    pub fn failed(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::INTERNAL_SERVER_ERROR, error: error.into(), help: help.into() }
    }
}

impl IntoResponse for ApiProblem {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "error": self.error, "help": self.help }))).into_response()
    }
}
