//! A summary of the dataset: its scenes, its layers, and the result of the last verification.

use super::picture_spec::PictureSpec;
use super::place::problem;
use super::viewer::{Viewer, work};
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::check_name;
use enfilade_frame::LAYERS;
use enfilade_serve::{ApiProblem, reply};
use serde_json::{Value, json};
use std::sync::Arc;

/// `GET /api/view/dataset`.
pub async fn dataset(State(viewer): State<Arc<Viewer>>, headers: HeaderMap) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    work(viewer, move |viewer| Ok(reply::json(gzip, &viewer.catalogue()?))).await
}

impl Viewer {
    fn catalogue(&self) -> Result<Value, ApiProblem> {
        let scenes = match self.dataset.scenes() {
            // A run that has just begun has made none yet.
            Err(error) if error.is_not_found() && self.root.is_dir() => Vec::new(),
            scenes => scenes.map_err(problem)?,
        };
        // A scene whose folder has an unsafe name cannot be requested; the page reports it instead of hiding it.
        let (named, unnamed): (Vec<String>, Vec<String>) = scenes.into_iter().partition(|name| check_name("scene name", name).is_ok());
        let name = self.root.file_name().map_or_else(|| self.root.display().to_string(), |name| name.to_string_lossy().into_owned());
        let layers = LAYERS.iter().map(|spec| PictureSpec::from(spec.layer));
        let pages = [
            ("Report card", self.layout().verify_page()),
            ("Statistics", self.layout().statistics_dir().join("statistics.html")),
            ("Contact sheet", self.layout().overview()),
        ];
        let pages =
            pages.iter().filter(|(_, path)| path.is_file()).map(|(title, path)| json!({ "title": title, "path": self.in_dataset(path) }));
        Ok(json!({
            "name": name,
            "scenes": named,
            "scenes_with_other_names": unnamed,
            "layers": layers.collect::<Vec<_>>(),
            "pages": pages.collect::<Vec<_>>(),
            "verify": self.verify_summary()?,
            "verify_problem": self.report_file()?.and_then(Result::err),
        }))
    }

    /// The result of the last verification; null without one.
    fn verify_summary(&self) -> Result<Value, ApiProblem> {
        let Some(report) = self.report()? else { return Ok(Value::Null) };
        let report = &report.report;
        let failures: Vec<Value> = report
            .failures()
            .map(|law| json!({ "law": law.law, "statement": law.statement, "place": law.place, "meaning": law.meaning }))
            .collect();
        Ok(json!({
            "passed": report.passed, "accepted": report.accepted, "verdict": report.verdict(), "gate_verdict": report.gate_verdict(),
            "laws": report.laws.len(), "failures": failures, "frames": report.frames, "rejected": report.rejected().count(),
        }))
    }
}
