//! Who asks for an edit.

/// The author of an edit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Author {
    /// The client: a random id of the page.
    pub client: String,
    /// The name of the person, whose undo is their own; none for programs that give none.
    pub who: Option<String>,
    /// The client's name for the edit; one that was used before means that the client lost the answer to an edit that was done.
    pub id: Option<String>,
}
