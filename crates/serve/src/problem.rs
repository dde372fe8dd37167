//! The answer to a request that fails: status, what is wrong, what to do.

use axum::Json;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{Html, IntoResponse, Response};
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

    /// The body of the request is too long: 413.
    pub fn too_large(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::PAYLOAD_TOO_LARGE, error: error.into(), help: help.into() }
    }

    /// Something here failed: 500.
    pub fn failed(error: impl Into<String>, help: impl Into<String>) -> Self {
        Self { status: StatusCode::INTERNAL_SERVER_ERROR, error: error.into(), help: help.into() }
    }
}

impl ApiProblem {
    /// The answer to a request with these headers: a page where a browser shows it to somebody, else JSON.
    pub fn answer_to(self, headers: &HeaderMap) -> Response {
        let accepted = headers.get(header::ACCEPT).and_then(|value| value.to_str().ok()).unwrap_or("");
        if !accepted.contains("text/html") {
            return self.into_response();
        }
        let [error, help] = [&self.error, &self.help].map(|text| escaped(text));
        let page = format!(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>{}</title><style>body {{ font: 16px system-ui, sans-serif; \
             margin: 15vh auto; max-width: 36em; padding: 0 1em; color-scheme: light dark }}</style><main><h1>{error}</h1><p>{help}</p></main></html>",
            self.status
        );
        (self.status, Html(page)).into_response()
    }
}

/// Text within a page.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

impl IntoResponse for ApiProblem {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "error": self.error, "help": self.help }))).into_response()
    }
}
