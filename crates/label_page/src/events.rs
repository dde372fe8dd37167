//! Changes on their way to every page: each page gets each change once and in order, also after it lost the connection.

use super::change::Change;
use axum::response::sse::Event;
use futures_util::stream::{Stream, unfold};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::broadcast::{Receiver, Sender, channel, error::RecvError};

/// Changes that are kept for pages that lost the connection; a page that missed more loads the scene again.
const KEPT: usize = 256;

/// What is announced.
#[derive(Clone, Debug)]
enum Message {
    /// A change, as text.
    Change { revision: u64, text: Arc<str> },
    /// Pieces were reviewed.
    Reviews,
}

/// Channel on which changes are announced.
pub struct Events {
    kept: Mutex<Kept>,
    sender: Sender<Message>,
}

struct Kept {
    /// The revision before the first of the changes.
    since: u64,
    /// Revision and text of each.
    changes: VecDeque<(u64, Arc<str>)>,
}

impl Events {
    /// Begins at the revision that pages load.
    pub fn new(revision: u64) -> Self {
        Self { kept: Mutex::new(Kept { since: revision, changes: VecDeque::new() }), sender: channel(KEPT).0 }
    }

    /// Announces a change. The caller must announce changes in order.
    pub fn publish(&self, change: &Change) {
        let text: Arc<str> = serde_json::to_string(change).expect("plain data has a JSON text").into();
        let revision = change.revision;
        let mut kept = self.lock();
        kept.changes.push_back((revision, Arc::clone(&text)));
        if kept.changes.len() > KEPT
            && let Some((dropped, _)) = kept.changes.pop_front()
        {
            kept.since = dropped;
        }
        let _ = self.sender.send(Message::Change { revision, text }); // it fails if no page listens
    }

    /// Announces that pieces were reviewed.
    pub fn publish_reviews(&self) {
        let _ = self.sender.send(Message::Reviews); // it fails if no page listens
    }

    /// The changes after revision `since`, those to come included; without `since` those to come.
    pub fn after(&self, since: Option<u64>) -> impl Stream<Item = Result<Event, Infallible>> + Send + use<> {
        let kept = self.lock();
        let last = kept.changes.back().map_or(kept.since, |(revision, _)| *revision);
        let missed: VecDeque<Next> = match since {
            None => VecDeque::new(),
            Some(since) if (kept.since..=last).contains(&since) => {
                let change =
                    |(revision, text): &(u64, Arc<str>)| Next::Message(Message::Change { revision: *revision, text: Arc::clone(text) });
                kept.changes.iter().filter(|(revision, _)| *revision > since).map(change).collect()
            }
            Some(_) => VecDeque::from([Next::Reload]),
        };
        // Still under the lock, so that no change is published between the kept ones and the subscription.
        unfold((missed, self.sender.subscribe()), next)
    }

    fn lock(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The next event for a page.
enum Next {
    Message(Message),
    /// The page missed too much, and has to load the scene again.
    Reload,
}

type State = (VecDeque<Next>, Receiver<Message>);

async fn next((mut missed, mut receiver): State) -> Option<(Result<Event, Infallible>, State)> {
    let next = match missed.pop_front() {
        Some(next) => next,
        None => match receiver.recv().await {
            Ok(message) => Next::Message(message),
            Err(RecvError::Lagged(_)) => Next::Reload,
            Err(RecvError::Closed) => return None,
        },
    };
    let event = match next {
        Next::Message(Message::Change { revision, text }) => Event::default().id(revision.to_string()).data(text),
        Next::Message(Message::Reviews) => Event::default().event("reviews").data("{}"),
        Next::Reload => Event::default().event("reload").data("{}"),
    };
    Some((Ok(event), (missed, receiver)))
}
