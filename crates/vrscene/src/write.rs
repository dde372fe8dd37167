//! Writes a document back to bytes: those that were read, except where something was edited.

use crate::document::{Document, Item};
use std::io::{self, Write};

impl Document {
    /// The bytes of the file: those that were read, but for what was edited.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.write_to(&mut out).expect("writing to memory cannot fail");
        out
    }

    /// Writes the file.
    ///
    /// # Errors
    /// The errors of `out`.
    pub fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        for item in &self.items {
            match item {
                Item::Include(include) => {
                    for text in [&include.before, &include.opening, &include.path, &include.closing] {
                        out.write_all(text.bytes())?;
                    }
                }
                Item::Time(time) => {
                    for text in [&time.before, &time.text] {
                        out.write_all(text.bytes())?;
                    }
                }
                Item::Plugin(plugin) => {
                    for text in [&plugin.before, &plugin.kind, &plugin.gap, &plugin.name, &plugin.opening] {
                        out.write_all(text.bytes())?;
                    }
                    for parameter in &plugin.parameters {
                        for text in [&parameter.before, &parameter.value, &parameter.after] {
                            out.write_all(text.bytes())?;
                        }
                    }
                    out.write_all(plugin.closing.bytes())?;
                }
            }
        }
        out.write_all(self.end.bytes())
    }
}
