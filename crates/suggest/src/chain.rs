//! A name among the names above it: which of them decides what a part is.
//!
//! If a name names a thing, it decides, regardless of the names around it. Other names are mixed with those around them, from the outermost
//! inwards: with a share that depends on the inner name's [`Role`], a part has the class of the thing around it, else the class of its own
//! name. So nearer and more specific names count more: a *door* in a *Nightstand* is a night stand, in a *Wall* a door; a *Table* in a
//! *Living room* is a table. The shares were learned from Hypersim's names ([`crate::learn::learn_shares`]).

use crate::roles::Role;
use crate::table::{TableError, number, read};
use crate::weights::CLASSES;

const COLUMNS: [&str; 2] = ["inner", "share"];
/// Confidence above which a name counts as known although it is in no list.
pub(crate) const KNOWN: f32 = 0.6;

/// Kinds of inner names that name no thing; the share depends on the kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Inner {
    /// The name of a piece of a thing like the one around it.
    Piece,
    /// A form, side or material.
    Filler,
    /// Words of no list for which the model is confident.
    Known,
    /// Words about which little is known, or no words.
    Unknown,
}

impl Inner {
    /// Every kind, in the order of the table.
    pub const ALL: [Self; 4] = [Self::Piece, Self::Filler, Self::Known, Self::Unknown];

    /// The name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Piece => "piece",
            Self::Filler => "filler",
            Self::Known => "known",
            Self::Unknown => "unknown",
        }
    }

    /// The kind of a name of this role, whose own class has `confidence`, in a thing that is probably of class `around`; `None` for a
    /// thing.
    pub(crate) fn of(role: &Role, confidence: f32, around: i16) -> Option<Self> {
        match role {
            Role::Thing(_) => None,
            Role::Piece { wholes, .. } if wholes.is_empty() || wholes.contains(&around) => Some(Self::Piece),
            Role::Piece { alone: Some(_), .. } => None,
            Role::Filler | Role::Side => Some(Self::Filler),
            _ if confidence >= KNOWN => Some(Self::Known),
            _ => Some(Self::Unknown),
        }
    }
}

/// Shares of parts that have the class of the thing around them, by the kind of their own name.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares([f32; Inner::ALL.len()]);

impl Shares {
    /// Shares from one number per kind, in the order of [`Inner::ALL`], in thousandths.
    pub(crate) fn new(shares: [f32; Inner::ALL.len()]) -> Self {
        Self(shares.map(|share| (share * 1000.0).round() / 1000.0))
    }

    /// Reads `inner,share`. `file` is what errors call it.
    ///
    /// # Errors
    /// The first row that is not the next kind with a number from 0 to 1, or a kind that is missing.
    pub fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let rows = read(text, file, COLUMNS)?;
        let mut shares = [0.0; Inner::ALL.len()];
        for (i, kind) in Inner::ALL.iter().enumerate() {
            let line = rows.get(i).map_or(i as u64 + 2, |row| row.0);
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let expected = || format!("expected the row of {:?}; take the file as it was released", kind.name());
            let (_, [name, share]) = rows.get(i).ok_or_else(|| error(expected()))?;
            if name != kind.name() {
                return Err(error(format!("found {name:?}, {}", expected())));
            }
            let share = number(share, "share").map_err(error)?;
            if !(0.0..=1.0).contains(&share) {
                return Err(error(format!("{share} is out of range; expected a number from 0 to 1")));
            }
            shares[i] = share;
        }
        Ok(Self(shares))
    }

    /// The shares as text.
    pub fn to_csv(&self) -> String {
        let rows = Inner::ALL.iter().zip(self.0).map(|(kind, share)| format!("{},{share}\n", kind.name()));
        std::iter::once(format!("{}\n", COLUMNS.join(","))).chain(rows).collect()
    }

    /// The share of a kind.
    pub fn of(&self, kind: Inner) -> f32 {
        self.0[kind as usize]
    }
}

/// A level: the role of its names and the probabilities of the classes by these alone.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub(crate) role: Role,
    pub(crate) probabilities: [f32; CLASSES],
}

impl Level {
    /// The likeliest class and its probability.
    pub(crate) fn best(&self) -> (i16, f32) {
        best(&self.probabilities)
    }

    /// Whether a name around others gives information about its contents.
    pub(crate) fn speaks(&self) -> bool {
        match self.role {
            Role::Thing(_) | Role::Piece { alone: Some(_), .. } => true,
            Role::Place | Role::Filler | Role::Side | Role::Piece { .. } => false,
            Role::Unlisted => self.best().1 >= KNOWN,
        }
    }
}

/// The likeliest class and its probability; the first of equals.
pub(crate) fn best(probabilities: &[f32; CLASSES]) -> (i16, f32) {
    let likelier = |best: (i16, f32), (i, &p): (usize, &f32)| if p > best.1 { (i as i16 + 1, p) } else { best };
    probabilities.iter().enumerate().fold((1, f32::MIN), likelier)
}

/// The probabilities of the innermost level among those around it, which come from the innermost outwards, and the share of each level in
/// them.
pub(crate) fn mix(levels: &[Level], shares: &Shares) -> ([f32; CLASSES], Vec<f32>) {
    let Some((inner, outer)) = levels.split_first() else { return ([0.0; CLASSES], Vec::new()) };
    if outer.is_empty() {
        return (inner.probabilities, vec![1.0]);
    }
    let (around, rest) = mix(outer, shares);
    let share = Inner::of(&inner.role, inner.best().1, best(&around).0).map_or(0.0, |kind| shares.of(kind));
    let mixed = std::array::from_fn(|i| (1.0 - share) * inner.probabilities[i] + share * around[i]);
    (mixed, std::iter::once(1.0 - share).chain(rest.iter().map(|one| share * one)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(role: Role, class: i16, p: f32) -> Level {
        let mut probabilities = [(1.0 - p) / 39.0; CLASSES];
        probabilities[class as usize - 1] = p;
        Level { role, probabilities }
    }

    #[test]
    fn levels_are_mixed_by_the_shares_of_the_inner_ones() {
        let shares = Shares::new([0.9, 0.8, 0.5, 0.7]);
        let door = || level(Role::Piece { wholes: vec![32], alone: Some(8) }, 8, 0.9);
        let (p, by) = mix(&[door(), level(Role::Thing(32), 32, 0.8)], &shares);
        assert!((p[31] - (0.1 * 0.1 / 39.0 + 0.9 * 0.8)).abs() < 1e-6, "{}", p[31]);
        assert!((by[0] - 0.1).abs() < 1e-6 && (by[1] - 0.9).abs() < 1e-6, "{by:?}");
        // Walls have no such pieces, so this door is a thing.
        let (p, _) = mix(&[door(), level(Role::Thing(1), 1, 0.8)], &shares);
        assert!((p[7] - 0.9).abs() < 1e-6, "{}", p[7]);
        assert_eq!(mix(&[door()], &shares).0, door().probabilities);
    }

    #[test]
    fn what_is_written_is_read_and_damage_is_told() {
        let shares = Shares::new([0.9, 0.8, 0.5, 0.25]);
        assert_eq!(Shares::parse(&shares.to_csv(), "s.csv"), Ok(shares.clone()));
        let message = |text: &str| Shares::parse(text, "s.csv").unwrap_err().to_string();
        assert!(message("inner,share\npiece,2\n").starts_with("s.csv:2: 2 is out of range"));
        assert!(message("inner,share\nfiller,0.5\n").starts_with("s.csv:2: found \"filler\", expected the row of \"piece\""));
        assert!(message("inner,share\npiece,0.5\n").starts_with("s.csv:3: expected the row of \"filler\""));
    }
}
