//! The interface of the verbs to the program that includes them.

use enfilade_scene::Cx;

/// Receives the results and the progress of the verbs.
pub trait Console {
    /// Prints a line of the result.
    fn say(&self, line: &str);

    /// Begins long work on `name`, which is reported as work of `verb` while the value lives.
    fn begin(&self, name: &str, verb: &'static str) -> Box<dyn Cx + '_>;
}
