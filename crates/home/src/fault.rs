//! Faults of a home, in words for people and in families to be counted.

use enfilade_furniture::{family_of, object_of};
use std::fmt;

/// Something that is wrong with a home.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// Two objects run into each other deeper than they may.
    Meets(String, String),
    /// Nothing carries the object.
    Floats(String),
    /// The part has no class, or its object no instance.
    Nameless(String),
    /// Nobody can walk into the room, by its number in the plan.
    Unreachable(usize),
    /// A start camera is too near to a part.
    Camera(String),
    /// What moves by the joint runs into the object within its range.
    Blocked(String, String),
}

impl Fault {
    /// The fault in words that name families instead of objects, so that equal faults can be counted.
    pub fn kind(&self) -> String {
        match self {
            Self::Meets(a, b) => format!("{} runs into {}", family_of(a), family_of(b)),
            Self::Floats(a) => format!("{} floats", family_of(a)),
            Self::Blocked(joint, by) => format!("a joint of {} is blocked by {}", family_of(object_of(joint)), family_of(by)),
            other => other.to_string(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Meets(a, b) => write!(f, "{a} runs into {b}"),
            Self::Floats(a) => write!(f, "{a} floats"),
            Self::Nameless(part) => write!(f, "{part} has no label"),
            Self::Unreachable(room) => write!(f, "room {room} cannot be reached"),
            Self::Camera(name) => write!(f, "camera {name} is not in free space"),
            Self::Blocked(joint, by) => write!(f, "{joint} runs into {by} within its range"),
        }
    }
}
