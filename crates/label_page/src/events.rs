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

/// A change as text.
#[derive(Clone, Debug)]
struct Message {
    revision: u64,
    text: Arc<str>,
}

/// Channel on which changes are announced.
pub struct Events {
    kept: Mutex<Kept>,
    sender: Sender<Message>,
}

struct Kept {
    /// The revision before the first of the messages.
    since: u64,
    messages: VecDeque<Message>,
}

impl Events {
    /// Begins at the revision that pages load.
    pub fn new(revision: u64) -> Self {
        Self { kept: Mutex::new(Kept { since: revision, messages: VecDeque::new() }), sender: channel(KEPT).0 }
    }

    /// Announces a change. The caller must announce changes in order.
    pub fn publish(&self, change: &Change) {
        let text = serde_json::to_string(change).expect("plain data has a JSON text");
        let message = Message { revision: change.revision, text: text.into() };
        let mut kept = self.lock();
        kept.messages.push_back(message.clone());
        if kept.messages.len() > KEPT
            && let Some(dropped) = kept.messages.pop_front()
        {
            kept.since = dropped.revision;
        }
        let _ = self.sender.send(message); // it fails if no page listens
    }

    /// The changes after revision `since`, those to come included; without `since` those to come.
    pub fn after(&self, since: Option<u64>) -> impl Stream<Item = Result<Event, Infallible>> + Send + use<> {
        let kept = self.lock();
        let last = kept.messages.back().map_or(kept.since, |message| message.revision);
        let missed: VecDeque<Next> = match since {
            None => VecDeque::new(),
            Some(since) if (kept.since..=last).contains(&since) => {
                kept.messages.iter().filter(|message| message.revision > since).cloned().map(Next::Change).collect()
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
    Change(Message),
    /// The page missed too much, and has to load the scene again.
    Reload,
}

type State = (VecDeque<Next>, Receiver<Message>);

async fn next((mut missed, mut receiver): State) -> Option<(Result<Event, Infallible>, State)> {
    let next = match missed.pop_front() {
        Some(next) => next,
        None => match receiver.recv().await {
            Ok(message) => Next::Change(message),
            Err(RecvError::Lagged(_)) => Next::Reload,
            Err(RecvError::Closed) => return None,
        },
    };
    let event = match next {
        Next::Change(message) => Event::default().id(message.revision.to_string()).data(message.text),
        Next::Reload => Event::default().event("reload").data("{}"),
    };
    Some((Ok(event), (missed, receiver)))
}
