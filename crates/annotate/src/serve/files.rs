//! The files of the pages, which are embedded in the binary.

use super::ApiProblem;
use axum::http::{Uri, header};
use axum::response::{IntoResponse, Response};

#[derive(rust_embed::RustEmbed)]
#[folder = "web"]
struct Files;

/// The file of a path such as `/annotate/main.js`; a path that ends in `/` is its `index.html`.
///
/// # Errors
/// 404 when the binary has no such file.
pub async fn page_files(uri: Uri) -> Result<Response, ApiProblem> {
    let path = uri.path().trim_start_matches('/');
    let path = if path.is_empty() || path.ends_with('/') { format!("{path}index.html") } else { path.to_string() };
    let Some(file) = Files::get(&path) else {
        return Err(ApiProblem::not_found(format!("there is no page {:?}", uri.path()), "open the address that the program printed"));
    };
    let headers = [(header::CONTENT_TYPE, file.metadata.mimetype()), (header::CACHE_CONTROL, "no-cache")];
    Ok((headers, file.data).into_response())
}
