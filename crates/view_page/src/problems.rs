//! Files that cannot be read, where the rest of an answer can be had: each costs the panel that needs it, and nothing else.

use enfilade_serve::ApiProblem;
use serde::Serialize;

/// Files that could not be read.
#[derive(Debug, Default, Serialize)]
pub struct Problems(Vec<Loss>);

/// A panel that lacks something, and why.
#[derive(Debug, Serialize)]
struct Loss {
    panel: &'static str,
    error: String,
    help: String,
}

impl Problems {
    /// The value read, or the default on failure; the problem is kept for the panel that needs it.
    pub fn or_nothing<T: Default>(&mut self, panel: &'static str, read: Result<T, ApiProblem>) -> T {
        read.unwrap_or_else(|problem| {
            self.0.push(Loss { panel, error: problem.error, help: problem.help });
            T::default()
        })
    }
}
