//! A thing that somebody has modelled: what is known of it from its library, and its body, read when it is first used.

use super::Body;
use enfilade_math::Vec3;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Reads what a model looks like; the error names file, place, problem and remedy.
type Reader = Box<dyn Fn() -> Result<Arc<Body>, String> + Send + Sync>;

/// A thing that somebody has modelled.
pub struct Model {
    /// Name and author, for people.
    pub name: String,
    /// The file that it is in, as messages name it.
    pub file: String,
    /// Licence under which it may be used, if its library states one.
    pub licence: String,
    /// The families that it may replace if its size allows.
    pub families: Vec<&'static str>,
    /// Width, depth and height, metres.
    pub size: Vec3,
    /// Height of its lower end above the floor where it is fixed to a wall, metres.
    pub elevation: f32,
    /// True where it gives off light, as lamps must.
    pub shines: bool,
    /// Relative frequency with which it is chosen among the others of its family.
    pub weight: f32,
    reader: Reader,
    body: OnceLock<Result<Arc<Body>, String>>,
}

impl Model {
    /// A model that is read when it is first used.
    pub fn new(name: String, size: Vec3, families: Vec<&'static str>, reader: Reader) -> Self {
        let (file, licence) = (name.clone(), String::new());
        Self { name, file, licence, families, size, elevation: 0.0, shines: false, weight: 1.0, reader, body: OnceLock::new() }
    }

    /// The body of the model.
    ///
    /// # Errors
    /// When its file is broken.
    pub fn body(&self) -> Result<&Body, &str> {
        self.body.get_or_init(|| (self.reader)()).as_deref().map_err(String::as_str)
    }
}

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Model").field("name", &self.name).field("size", &self.size).field("families", &self.families).finish()
    }
}
