//! Values of fields and attributes, as in both encodings.

use super::time::Retiming;
use std::collections::BTreeMap;
use std::rc::Rc;

/// A value. Arrays are shared, because binary files store equal ones once.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// `None`: weaker opinions do not count either.
    Block,
    /// Numbers, tuples of them, matrices, and arrays of those.
    Numbers(Numbers),
    /// Strings, tokens, asset paths and paths; also an empty array of anything in text files.
    Texts {
        /// The texts; one for a scalar.
        data: Rc<Vec<Rc<str>>>,
        /// True for arrays.
        array: bool,
    },
    /// A dictionary.
    Dictionary(Rc<BTreeMap<String, Value>>),
    /// An edit of a list: of names, paths or references.
    List(Rc<ListEdit>),
    /// Time samples.
    Samples(Rc<Samples>),
    /// Something that no importer of rooms needs; its type's name.
    Other(&'static str),
}

/// Numbers as doubles, which represent all of the format's numbers that rooms use.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbers {
    /// Numbers per element: 1 for scalars, 2 to 4 for vectors, 4 for quaternions (real part first), 4, 9 or 16 for matrices (row by
    /// row).
    pub width: usize,
    /// The numbers of all elements.
    pub data: Rc<Vec<f64>>,
    /// True for arrays.
    pub array: bool,
}

/// Values at times, at least one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Samples {
    /// Time codes of the layer, ascending.
    pub codes: Vec<f64>,
    /// The value at each; only the first where they are arrays that are too large together.
    pub values: Vec<Value>,
}

/// An edit of the list that weaker opinions give.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ListEdit {
    /// Replaces the list.
    pub explicit: Option<Vec<Item>>,
    /// Goes to the front.
    pub prepended: Vec<Item>,
    /// Goes to the end.
    pub appended: Vec<Item>,
    /// Is taken out.
    pub deleted: Vec<Item>,
}

/// A name, a path, or a reference to a prim of another layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Item {
    /// Asset path of a reference or payload; empty for the own layer, and for names and paths.
    pub asset: String,
    /// The name, or the path, which may be empty in references.
    pub path: String,
    /// How a reference or payload shifts time.
    pub retiming: Retiming,
}

impl Item {
    /// A name or path.
    pub(super) fn name(path: impl Into<String>) -> Self {
        Self { path: path.into(), ..Self::default() }
    }
}

impl Samples {
    /// Samples in any order; of two at one time, the later one. `None` for none.
    pub(super) fn of(mut all: Vec<(f64, Value)>) -> Option<Self> {
        all.retain(|(code, _)| code.is_finite());
        all.reverse();
        all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        all.dedup_by(|(later, _), (code, _)| later == code);
        let (codes, values): (Vec<f64>, Vec<Value>) = all.into_iter().unzip();
        (!codes.is_empty()).then_some(Self { codes, values })
    }

    /// False where all values are known to be the same.
    pub(super) fn vary(&self) -> bool {
        self.values.len() < self.codes.len() || self.values.windows(2).any(|pair| pair[0] != pair[1])
    }
}

impl ListEdit {
    /// Applies the edit to the list of weaker opinions.
    pub(super) fn apply(&self, list: &mut Vec<Item>) {
        if let Some(explicit) = &self.explicit {
            list.clone_from(explicit);
        }
        list.retain(|i| !self.deleted.contains(i) && !self.prepended.contains(i) && !self.appended.contains(i));
        list.splice(0..0, self.prepended.iter().cloned());
        list.extend(self.appended.iter().cloned());
    }
}

impl Value {
    /// One text.
    pub(super) fn text(text: &str) -> Self {
        Self::Texts { data: Rc::new(vec![Rc::from(text)]), array: false }
    }

    /// An array of texts.
    pub(super) fn texts(texts: impl IntoIterator<Item = Rc<str>>) -> Self {
        Self::Texts { data: Rc::new(texts.into_iter().collect()), array: true }
    }

    /// One number.
    pub(super) fn number(value: f64) -> Self {
        Self::Numbers(Numbers { width: 1, data: Rc::new(vec![value]), array: false })
    }

    /// The first text.
    pub(super) fn as_text(&self) -> Option<&str> {
        self.as_texts().first().map(|t| &**t)
    }

    /// All texts; none for other values.
    pub(super) fn as_texts(&self) -> &[Rc<str>] {
        match self {
            Self::Texts { data, .. } => data,
            _ => &[],
        }
    }

    /// The first number.
    pub(super) fn as_number(&self) -> Option<f64> {
        self.as_numbers(1)?.first().copied()
    }

    /// The numbers of elements of `width`; those of an empty array whatever its width.
    pub(super) fn as_numbers(&self, width: usize) -> Option<&[f64]> {
        match self {
            Self::Numbers(n) if n.width == width || n.data.is_empty() => Some(&n.data),
            Self::Texts { data, array: true } if data.is_empty() => Some(&[]),
            _ => None,
        }
    }

    /// The first element of `N` numbers.
    pub(super) fn as_tuple<const N: usize>(&self) -> Option<[f64; N]> {
        self.as_numbers(N)?.first_chunk::<N>().copied()
    }

    /// True or false; numbers count as in C.
    pub(super) fn as_bool(&self) -> Option<bool> {
        self.as_number().map(|n| n != 0.0)
    }

    /// The list edit of a value of a list field: a plain value replaces the list.
    pub(super) fn as_list(&self) -> ListEdit {
        match self {
            Self::List(list) => (**list).clone(),
            Self::Texts { data, .. } => ListEdit { explicit: Some(data.iter().map(|t| Item::name(&**t)).collect()), ..ListEdit::default() },
            Self::Block => ListEdit { explicit: Some(Vec::new()), ..ListEdit::default() },
            _ => ListEdit::default(),
        }
    }

    /// About how many bytes the value takes.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Numbers(n) => 64 + 8 * n.data.len() as u64,
            Self::Texts { data, .. } => 64 + 16 * data.len() as u64,
            Self::Samples(samples) => 64 + 80 * samples.codes.len() as u64,
            _ => 64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_edited_as_the_glossary_says() {
        let items = |names: &[&str]| names.iter().map(|n| Item::name(*n)).collect::<Vec<_>>();
        let edit = ListEdit { explicit: None, prepended: items(&["c", "x"]), appended: items(&["a"]), deleted: items(&["b"]) };
        let mut list = items(&["a", "b", "c", "d"]);
        edit.apply(&mut list);
        assert_eq!(list, items(&["c", "x", "d", "a"]));
        ListEdit { explicit: Some(Vec::new()), ..ListEdit::default() }.apply(&mut list);
        assert!(list.is_empty());
    }
}
