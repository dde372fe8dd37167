//! Bodies of requests, each read whole before anything is done with it.
//!
//! While a body is on its way, its connection counts as one without a request: if connections are scarce it may be closed, so that bodies
//! that drip keep nobody out. This runs behind the guard, so strangers send none.

use super::ApiProblem;
use super::line::Line;
use axum::body::{Body, Bytes};
use axum::extract::Request;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use http_body_util::{BodyExt, LengthLimitError, Limited};
use std::sync::Arc;

/// Largest body of a request, bytes: a stroke of a million pixels fits.
const MAX_BODY_BYTES: usize = 16 << 20;

/// Reads the body of a request, and passes the request on.
pub(super) async fn whole(request: Request, next: Next) -> Response {
    let (head, body) = request.into_parts();
    let arriving = head.extensions.get::<Arc<Line>>().map(Line::arriving);
    let read = read(body).await;
    drop(arriving);
    match read {
        Ok(bytes) => next.run(Request::from_parts(head, Body::from(bytes))).await,
        Err(problem) => problem.into_response(),
    }
}

async fn read(body: Body) -> Result<Bytes, ApiProblem> {
    match Limited::new(body, MAX_BODY_BYTES).collect().await {
        Ok(whole) => Ok(whole.to_bytes()),
        Err(error) if error.is::<LengthLimitError>() => {
            let error = format!("the body is longer than {} MB", MAX_BODY_BYTES >> 20);
            Err(ApiProblem::too_large(error, "send less at once"))
        }
        Err(error) => Err(ApiProblem::bad_request(format!("the body was cut short: {error}"), "send the request again")),
    }
}
