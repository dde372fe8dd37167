//! `states` of a home: what is open, and how far.

use enfilade_furniture::{JointKind, object_of};
use enfilade_math::Rng;
use enfilade_options::{Form, Given, Value, closest, words};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;
use wildmatch::WildMatch;

words! {
    /// States of what can be opened.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum StateWord {
        /// As the home is made without states: furniture is closed, doors stand as their rooms want them.
        Made = "made",
        /// Closed.
        Closed = "closed",
        /// As wide open as it goes.
        Open = "open",
        /// Closed in one of two cases, else open by any share of its range.
        Random = "random",
    }
}

/// The state that something has been asked to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// A state with a name.
    Word(StateWord),
    /// A share of the range, from closed (0) to open (1).
    Share(f64),
}

/// States of a home: of all that has joints, or by name. What is not named is as it is made.
#[derive(Clone, Debug, PartialEq)]
pub enum States {
    /// One for all.
    All(State),
    /// By names of joints (`dresser_1/drawer_2_1`), of objects (`door_1`), both also with `*` and `?`, or by kind (`drawer`). Whole names go
    /// before patterns, of these the longer ones first, and those before kinds.
    Each(BTreeMap<String, State>),
}

impl States {
    /// Everything as it is made.
    pub const MADE: Self = Self::All(State::Word(StateWord::Made));

    /// The state that is asked of a joint.
    pub(crate) fn of(&self, body: &str, kind: JointKind) -> State {
        let made = State::Word(StateWord::Made);
        match self {
            Self::All(state) => *state,
            Self::Each(named) => {
                let ranked = named.iter().filter_map(|(name, state)| Some((rank(name, body, kind)?, *state)));
                ranked.reduce(|best, other| if other.0 > best.0 { other } else { best }).map_or(made, |(_, state)| state)
            }
        }
    }

    /// What is said about names of nothing.
    pub(crate) fn unknown<'a>(&self, joints: impl Iterator<Item = (&'a str, JointKind)> + Clone) -> Vec<String> {
        let Self::Each(named) = self else { return Vec::new() };
        let is_unknown = |name: &&String| !joints.clone().any(|(body, kind)| rank(name, body, kind).is_some());
        let mut known: Vec<&str> = joints.clone().flat_map(|(body, kind)| [body, object_of(body), kind.name()]).collect();
        known.sort_unstable();
        known.dedup();
        let said = |name: &String| {
            let meant = closest(name, &known).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
            format!("nothing in this home is called {name:?}{meant}")
        };
        named.keys().filter(is_unknown).map(said).collect()
    }
}

/// How closely a name fits a joint, if it does.
fn rank(name: &str, body: &str, kind: JointKind) -> Option<usize> {
    let object = object_of(body);
    if name == body {
        return Some(usize::MAX);
    }
    if name == object {
        return Some(usize::MAX - 1);
    }
    let pattern = WildMatch::new(name);
    let fits = name.contains(['*', '?']) && (pattern.matches(body) || pattern.matches(object));
    if fits { Some(1 + name.len()) } else { (name == kind.name()).then_some(0) }
}

impl State {
    /// The share of the range that is meant; `None` as it is made. Chairs and other things that turn all around are never closed or open.
    pub(crate) fn share(self, kind: JointKind, rng: &mut Rng) -> Option<f64> {
        match self {
            Self::Share(share) => Some(share),
            Self::Word(StateWord::Random) if kind == JointKind::Chair => Some(f64::from(rng.next_f32())),
            Self::Word(StateWord::Random) => Some(if rng.below(2) == 0 { 0.0 } else { f64::from(rng.next_f32()) }),
            Self::Word(StateWord::Closed) if kind != JointKind::Chair => Some(0.0),
            Self::Word(StateWord::Open) if kind != JointKind::Chair => Some(1.0),
            Self::Word(_) => None,
        }
    }

    fn of_word<E: Error>(word: &str) -> Result<Self, E> {
        const WORDS: [&str; 4] = [StateWord::ALL[0].name(), StateWord::ALL[1].name(), StateWord::ALL[2].name(), StateWord::ALL[3].name()];
        let found = StateWord::ALL.into_iter().find(|known| known.name() == word);
        found.map(Self::Word).ok_or_else(|| E::unknown_variant(word, const { &WORDS }))
    }

    fn of_share<E: Error>(share: f64) -> Result<Self, E> {
        let wrong = || E::custom(format_args!("a state is a share from 0 (closed) to 1 (open) or a word, found {share}"));
        if (0.0..=1.0).contains(&share) { Ok(Self::Share(share)) } else { Err(wrong()) }
    }
}

/// Reads one state, and where `named` a table of them.
struct Reader {
    named: bool,
}

impl<'de> Visitor<'de> for Reader {
    type Value = States;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("made, closed, open, random, or a share from 0 to 1")?;
        if self.named { f.write_str(", or a table of these by name") } else { Ok(()) }
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<States, E> {
        State::of_word(word).map(States::All)
    }

    fn visit_f64<E: Error>(self, share: f64) -> Result<States, E> {
        State::of_share(share).map(States::All)
    }

    fn visit_i64<E: Error>(self, share: i64) -> Result<States, E> {
        self.visit_f64(share as f64)
    }

    fn visit_u64<E: Error>(self, share: u64) -> Result<States, E> {
        self.visit_f64(share as f64)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<States, A::Error> {
        if !self.named {
            return Err(A::Error::invalid_type(serde::de::Unexpected::Map, &self));
        }
        let mut named = BTreeMap::new();
        while let Some((name, state)) = map.next_entry::<String, State>()? {
            named.insert(name, state);
        }
        Ok(States::Each(named))
    }
}

impl<'de> Deserialize<'de> for States {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader { named: true })
    }
}

impl<'de> Deserialize<'de> for State {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let one = deserializer.deserialize_any(Reader { named: false })?;
        Ok(if let States::All(state) = one { state } else { Self::Word(StateWord::Made) })
    }
}

impl Serialize for State {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Word(word) => serializer.serialize_str(word.name()),
            Self::Share(share) => serializer.serialize_f64(*share),
        }
    }
}

impl Serialize for States {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(state) => state.serialize(serializer),
            Self::Each(named) => named.serialize(serializer),
        }
    }
}

/// On the command line and in Python one word is for all.
impl Value for States {
    const FORM: Form = StateWord::FORM;

    fn read(given: &Given) -> Option<Self> {
        StateWord::read(given).map(|word| Self::All(State::Word(word)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(json: &str) -> Result<States, String> {
        serde_json::from_str(json).map_err(|error| error.to_string())
    }

    #[test]
    fn names_go_before_patterns_and_patterns_before_kinds() {
        let states = read(
            r#"{"dresser_1/drawer_2": 0.25, "dresser_1": "closed", "dresser_*": "open", "*": 0.5, "drawer": "random", "door": "open"}"#,
        );
        let states = states.unwrap();
        let of = |body| states.of(body, JointKind::Drawer);
        assert_eq!(of("dresser_1/drawer_2"), State::Share(0.25));
        assert_eq!(of("dresser_1/drawer_1"), State::Word(StateWord::Closed));
        assert_eq!(of("dresser_2/drawer_1"), State::Word(StateWord::Open));
        assert_eq!(of("desk_1/drawer_1"), State::Share(0.5));
        let kinds = read(r#"{"door": 1, "nightstand_?": "open"}"#).unwrap();
        assert_eq!(kinds.of("door_3/leaf", JointKind::Door), State::Share(1.0));
        assert_eq!(kinds.of("wardrobe_1/door_1", JointKind::Cupboard), State::Word(StateWord::Made));
        assert_eq!(kinds.of("nightstand_2/drawer_1", JointKind::Drawer), State::Word(StateWord::Open));
        let joints = [("door_3/leaf", JointKind::Door), ("desk_1/drawer_1", JointKind::Drawer)].into_iter();
        assert_eq!(kinds.unknown(joints), ["nothing in this home is called \"nightstand_?\""]);
        let near = read(r#"{"dor_3": 1}"#).unwrap().unknown([("door_3/leaf", JointKind::Door)].into_iter());
        assert_eq!(near, ["nothing in this home is called \"dor_3\"; did you mean \"door_3\"?"]);
    }

    #[test]
    fn bad_states_are_refused_and_good_ones_come_back() {
        assert!(read(r#""opn""#).unwrap_err().starts_with("unknown variant `opn`, expected one of `made`, `closed`, `open`, `random`"));
        assert!(read("1.5").unwrap_err().starts_with("a state is a share from 0 (closed) to 1 (open) or a word, found 1.5"));
        assert!(read(r#"{"door_1": {"a": 1}}"#).unwrap_err().contains("expected made, closed, open, random, or a share from 0 to 1"));
        for text in [r#""random""#, "0.25", r#"{"door_1":0.5,"drawer":"open"}"#] {
            assert_eq!(serde_json::to_string(&read(text).unwrap()).unwrap(), text);
        }
    }

    #[test]
    fn words_mean_shares_and_chairs_are_neither_open_nor_closed() {
        let share = |word, kind| State::Word(word).share(kind, &mut Rng::new(3));
        assert_eq!(share(StateWord::Open, JointKind::Drawer), Some(1.0));
        assert_eq!(share(StateWord::Closed, JointKind::Door), Some(0.0));
        assert_eq!(share(StateWord::Made, JointKind::Door), None);
        assert_eq!([StateWord::Open, StateWord::Closed].map(|word| share(word, JointKind::Chair)), [None, None]);
        let mut rng = Rng::new(5);
        let shares: Vec<f64> = (0..400).filter_map(|_| State::Word(StateWord::Random).share(JointKind::Drawer, &mut rng)).collect();
        let closed = shares.iter().filter(|&&share| share == 0.0).count();
        assert!((160..240).contains(&closed) && shares.iter().all(|share| (0.0..1.0).contains(share)), "{closed}");
    }
}
