//! The routes of the annotation page. Slow work runs on threads for blocking tasks.

use super::action::{Action, Look, Refusal};
use super::answer::{Answer, Shared};
use super::app::App;
use super::author::Author;
use super::camera::CameraRequest;
use super::carry;
use super::change::material_name;
use super::clock;
use super::face_colors::FaceColors;
use super::planned::PlannedFrame;
use super::progress::views;
use super::review::{ReviewState, Said};
use super::session::ActionError;
use super::surfaces;
use super::viewpoint::Viewpoint;
use axum::body::Bytes;
use axum::extract::{Query, State};
use axum::http::HeaderMap;
use axum::response::IntoResponse;
use axum::response::sse::{KeepAlive, Sse};
use axum::routing::{get, post};
use axum::{Json, Router};
use enfilade_serve::{ApiProblem, beside};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::sync::{Arc, Weak};
use std::time::Duration;

/// Files are written this long after an edit.
const SAVE_AFTER: Duration = Duration::from_secs(2);
/// The history that is sent has at most this many edits.
const MAX_HISTORY: usize = 300;
/// Longer notes are a mistake, characters.
const MAX_NOTE: usize = 2000;
/// Clients and edits are named by random ids; longer ones are a mistake.
const MAX_NAME: usize = 100;

/// All routes, under `/api/annotate`.
pub fn routes(app: Arc<App>) -> Router {
    Router::new()
        .route("/api/annotate/scene", get(scene))
        .route("/api/annotate/geometry", get(surfaces::geometry))
        .route("/api/annotate/instance_colors", get(surfaces::instance_colors_of_files))
        .route("/api/annotate/face_colors", get(surfaces::face_colors))
        .route("/api/annotate/photograph/{camera}/{frame}", get(surfaces::photograph))
        .route("/api/annotate/pieces", get(pieces))
        .route("/api/annotate/edit", post(edit))
        .route("/api/annotate/select", post(select))
        .route("/api/annotate/pick", post(pick))
        .route("/api/annotate/viewpoint", post(viewpoint))
        .route("/api/annotate/events", get(events))
        .route("/api/annotate/progress", get(progress))
        .route("/api/annotate/history", get(history))
        .route("/api/annotate/carried", get(carried))
        .route("/api/annotate/reviews", get(reviews))
        .route("/api/annotate/review", post(review))
        .route("/api/annotate/activity", post(activity))
        .route("/api/annotate/worklog", get(worklog))
        .route("/api/annotate/save", post(save))
        .with_state(app)
}

impl From<Refusal> for ApiProblem {
    fn from(refusal: Refusal) -> Self {
        let Refusal { conflict, error, help } = refusal;
        if conflict { Self::conflict(error, help) } else { Self::bad_request(error, help) }
    }
}

impl From<ActionError> for ApiProblem {
    fn from(error: ActionError) -> Self {
        let failed = |error: String| Self::failed(error, "nothing was changed; make room on the disk or check the folder");
        match error {
            ActionError::Refused(refusal) => refusal.into(),
            ActionError::Log(error) => failed(error.to_string()),
            ActionError::Review(error) => failed(error.to_string()),
        }
    }
}

/// Reads the JSON of a body.
fn parse<T: DeserializeOwned>(body: &Bytes) -> Result<T, ApiProblem> {
    let wrong =
        |e: serde_json::Error| ApiProblem::bad_request(format!("the request is not understood: {e}"), "see docs/annotate.md for the form");
    serde_json::from_slice(body).map_err(wrong)
}

async fn scene(State(app): Shared) -> Answer {
    beside(move || {
        let (scene, session) = (app.scene(), app.session());
        let standing = session.standing();
        let (bounds, start) = (app.order().bounds(), start_camera(&app));
        Ok(Json(json!({
            "name": scene.name,
            "source": scene.origin,
            "labels_folder": scene.labels_folder,
            "faces": scene.corners.len(),
            "vertices": scene.vertices,
            "pieces": session.pieces().list().len(),
            "bounds": { "min": bounds.min.to_array(), "max": bounds.max.to_array() },
            "meters_per_unit": scene.meters_per_unit,
            "classes": app.classes().list(),
            "cameras": scene.cameras,
            "start_camera": start,
            "revision": standing.revision,
            "can_undo": standing.all.undo.is_some(),
            "can_redo": standing.all.redo.is_some(),
            "undo_description": standing.all.undo,
            "redo_description": standing.all.redo,
            "people": standing.people,
            "next_instance": standing.next_instance,
            "has_face_colors": !matches!(scene.colors, FaceColors::Unknown),
            "has_suggestions": app.suggestions().iter().any(Option::is_some),
            "autosaved": true,
        }))
        .into_response())
    })
    .await
}

/// The view that the page begins with.
fn start_camera(app: &App) -> Option<PlannedFrame> {
    views(app.scene(), app.bvh()).1.into_iter().find_map(|camera| camera.frames.into_iter().next())
}

async fn pieces(State(app): Shared) -> Answer {
    beside(move || {
        let session = app.session();
        let (pieces, list) = (session.pieces(), session.pieces().list());
        let material = |measure: &super::pieces::Measure| material_name(pieces, measure.material);
        Ok(Json(json!({
            "revision": session.revision(),
            "names": list.iter().map(|p| &p.name).collect::<Vec<_>>(),
            "parents": list.iter().map(|p| p.part).collect::<Vec<_>>(),
            "materials": list.iter().map(|p| material(&p.measure)).collect::<Vec<_>>(),
            "faces": list.iter().map(|p| p.faces.len()).collect::<Vec<_>>(),
            "areas_m2": list.iter().map(|p| p.measure.area_m2).collect::<Vec<_>>(),
            "semantic": list.iter().map(|p| p.label.semantic).collect::<Vec<_>>(),
            "instance": list.iter().map(|p| p.label.instance).collect::<Vec<_>>(),
            "mins": list.iter().map(|p| p.measure.min).collect::<Vec<_>>(),
            "maxs": list.iter().map(|p| p.measure.max).collect::<Vec<_>>(),
            "geometry_keys": list.iter().map(|p| p.measure.geometry_key).collect::<Vec<_>>(),
            "objects": list.iter().map(|p| app.scene().object_of(p.part)).collect::<Vec<_>>(),
            "suggestions": list.iter().map(|p| &app.suggestions()[p.part as usize]).collect::<Vec<_>>(),
        }))
        .into_response())
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EditRequest {
    client: String,
    /// The name of the person, whose undo is their own.
    #[serde(default)]
    who: Option<String>,
    /// An id that was used before means that the client lost the answer to an edit that was done.
    #[serde(default)]
    id: Option<String>,
    action: Action,
}

async fn edit(State(app): Shared, body: Bytes) -> Answer {
    let EditRequest { client, who, id, action } = parse(&body)?;
    check_names(&[("client", Some(&client)), ("who", who.as_ref()), ("id", id.as_ref())])?;
    let change = beside(move || {
        let change = app.act(&action, &Author { client, who, id })?;
        // Spawned here: code after the `await` below does not run if the page disconnects meanwhile.
        tokio::spawn(save_later(Arc::downgrade(&app)));
        Ok(change)
    })
    .await?;
    Ok(Json(change).into_response())
}

/// Refuses what is no name of a page or an edit.
fn check_names(names: &[(&str, Option<&String>)]) -> Result<(), ApiProblem> {
    for (what, name) in names {
        if name.is_some_and(|name| name.is_empty() || name.chars().count() > MAX_NAME || name.chars().any(char::is_control)) {
            let error = format!("{what} is no name; expected 1 to {MAX_NAME} characters");
            return Err(ApiProblem::bad_request(error, "send a random id, one of the page as client, one of the edit as id"));
        }
    }
    Ok(())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReviewRequest {
    client: String,
    #[serde(default)]
    who: Option<String>,
    pieces: Vec<u32>,
    state: ReviewState,
    #[serde(default)]
    note: String,
}

async fn review(State(app): Shared, body: Bytes) -> Answer {
    let ReviewRequest { client, who, pieces, state, note } = parse(&body)?;
    check_names(&[("client", Some(&client)), ("who", who.as_ref())])?;
    if note.chars().count() > MAX_NOTE {
        return Err(ApiProblem::bad_request(format!("note is longer than {MAX_NOTE} characters"), "say it in fewer words"));
    }
    beside(move || {
        app.review(&Author { client, who, id: None }, &pieces, state, &note)?;
        Ok(Json(reviewed(&app)).into_response())
    })
    .await
}

async fn carried(State(app): Shared) -> Answer {
    beside(move || {
        let rows = carry::rows(app.labels_folder()).map_err(|e| ApiProblem::failed(e, "labels are not affected"))?;
        Ok(Json(rows).into_response())
    })
    .await
}

async fn reviews(State(app): Shared) -> Answer {
    beside(move || Ok(Json(reviewed(&app)).into_response())).await
}

/// The pieces that were reviewed.
fn reviewed(app: &App) -> Vec<Value> {
    let (session, reviews) = (app.session(), app.reviews());
    let row = |(number, piece): (usize, &super::pieces::Piece)| {
        let Said { state, note, who } = reviews.of(&piece.name)?;
        Some(json!({ "piece": number, "state": state, "note": note, "who": who }))
    };
    session.pieces().list().iter().enumerate().filter_map(row).collect()
}

/// Writes the files a moment after an edit. If that fails nothing is lost, because the edit is in the log; the next save reports it.
async fn save_later(app: Weak<App>) {
    tokio::time::sleep(SAVE_AFTER).await;
    let Some(app) = app.upgrade() else { return };
    let _ = beside(move || {
        if app.is_unsaved() {
            app.save().map_err(|e| ApiProblem::failed(e.to_string(), ""))?;
        }
        Ok(())
    })
    .await;
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SelectRequest {
    #[serde(flatten)]
    look: Look,
    /// True to get the visible faces too.
    #[serde(default)]
    faces: bool,
}

async fn select(State(app): Shared, body: Bytes) -> Answer {
    let SelectRequest { look, faces: with_faces } = parse(&body)?;
    beside(move || {
        let (faces, pieces) = app.select(&look)?;
        let answer = if with_faces { json!({ "pieces": pieces, "faces": faces }) } else { json!({ "pieces": pieces }) };
        Ok(Json(answer).into_response())
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PickRequest {
    camera: CameraRequest,
    pixel: [f64; 2],
    #[serde(default)]
    hidden: Vec<u32>,
}

async fn pick(State(app): Shared, body: Bytes) -> Answer {
    let PickRequest { camera, pixel, hidden } = parse(&body)?;
    beside(move || {
        let answer = match app.pick(&camera, pixel, &hidden)? {
            Some((piece, at)) => {
                json!({ "piece": piece, "face": at.face, "point": at.point.to_array(), "distance_m": at.distance_m })
            }
            None => json!({ "piece": -1 }),
        };
        Ok(Json(answer).into_response())
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewpointRequest {
    camera: CameraRequest,
    pieces: Vec<u32>,
    #[serde(default)]
    hidden: Vec<u32>,
}

async fn viewpoint(State(app): Shared, body: Bytes) -> Answer {
    let ViewpointRequest { camera, pieces, hidden } = parse(&body)?;
    beside(move || {
        let found = app.session().viewpoint(&camera, &pieces, &hidden)?;
        Ok(Json(found.map(|Viewpoint { from, to }| json!({ "from": from.to_array(), "to": to.to_array() }))).into_response())
    })
    .await
}

#[derive(Deserialize)]
struct Since {
    since: Option<String>,
}

async fn events(State(app): Shared, Query(Since { since }): Query<Since>, headers: HeaderMap) -> Answer {
    let last = headers.get("last-event-id").and_then(|value| value.to_str().ok()).map(Into::into);
    let since = match last.or(since) {
        None => None,
        Some(text) => {
            let wrong =
                |_| ApiProblem::bad_request(format!("{text:?} is no revision"), "name the last revision that the page knows, a number");
            Some(text.parse::<u64>().map_err(wrong)?)
        }
    };
    Ok(Sse::new(app.events().after(since)).keep_alive(KeepAlive::default()).into_response())
}

async fn progress(State(app): Shared) -> Answer {
    beside(move || {
        let seen = app.seen();
        let session = app.session();
        let mut progress: Value = seen.progress(session.pieces());
        progress["revision"] = json!(session.revision());
        drop(session);
        progress["reviews"] = json!(reviewed(&app));
        Ok(Json(progress).into_response())
    })
    .await
}

async fn history(State(app): Shared) -> Answer {
    beside(move || {
        let session = app.session();
        let [done, undone] = session.history(MAX_HISTORY);
        Ok(Json(json!({ "done": done, "undone": undone, "revision": session.revision() })).into_response())
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Activity {
    seconds_since_last_input: f64,
}

async fn activity(State(app): Shared, body: Bytes) -> Answer {
    let Activity { seconds_since_last_input: seconds } = parse(&body)?;
    if !(seconds.is_finite() && seconds >= 0.0) {
        let error = format!("seconds_since_last_input is {seconds}; expected zero or more");
        return Err(ApiProblem::bad_request(error, "send how long ago the last key or pointer event was"));
    }
    beside(move || {
        let failed = |e: enfilade_dataset::DatasetError| ApiProblem::failed(e.to_string(), "check the folder of labels");
        app.worked(clock::now_s() - seconds).map_err(failed)?;
        Ok(Json(json!({})).into_response())
    })
    .await
}

async fn worklog(State(app): Shared) -> Answer {
    let sessions = app.work_sessions();
    let active: f64 = sessions.iter().map(|session| session.active_seconds).sum();
    let actions: u64 = sessions.iter().map(|session| session.actions).sum();
    Ok(Json(json!({ "sessions": sessions, "active_seconds": active, "actions": actions })).into_response())
}

async fn save(State(app): Shared) -> Answer {
    beside(move || {
        let failed = |e: enfilade_dataset::DatasetError| {
            ApiProblem::failed(e.to_string(), "the edits are in the log; check the folder and save again")
        };
        let files = app.save().map_err(failed)?;
        Ok(Json(json!({ "files": files })).into_response())
    })
    .await
}
