//! What the verbs need of the program that has them.

use enfilade_scene::Cx;

/// Where the verbs say what they did, and how far they are.
pub trait Console {
    /// Says a line of the result.
    fn say(&self, line: &str);

    /// Begins long work on `name`, which is told as that of `verb` while the value lives.
    fn begin(&self, name: &str, verb: &'static str) -> Box<dyn Cx + '_>;
}
